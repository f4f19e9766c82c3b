//! TOML tables that cannot be written as arrays.

use cplan_robot::{FromToml, TomlError, TomlValue};
use toml::de::DeValue;

/// A table that must not be written as an array. Other tables may be arrays of their values in the order of the keys. As such an
/// array, `place = [0.5, 0.6]` would be refused with a confusing message about its first number.
pub(super) struct Table<T>(pub T);

impl<T: FromToml> FromToml for Table<T> {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        match value.get_ref() {
            DeValue::Table(_) => T::read(value).map(Self),
            _ => Err(TomlError::wrong_type(value, "a table: { key = value }")),
        }
    }
}
