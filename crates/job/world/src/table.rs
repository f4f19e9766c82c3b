//! TOML tables that cannot be written as arrays.

use cplan_robot::{FromToml, TomlError, TomlValue};
use toml::de::DeValue;

/// A table that refuses arrays. Other tables may be arrays of their values in the order of the keys. Then `place = [0.5, 0.6]` would be refused because of its first number, with a confusing message.
pub(super) struct Table<T>(pub T);

impl<T: FromToml> FromToml for Table<T> {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        match value.get_ref() {
            DeValue::Table(_) => T::read(value).map(Self),
            _ => Err(TomlError::wrong_type(value, "a table: { key = value }")),
        }
    }
}
