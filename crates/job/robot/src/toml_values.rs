//! Reads TOML into types. Each type has a function that takes its value from the parser's tree, which has all positions. Messages
//! are the same as serde's.

use super::error::Diagnostic;
use super::source::Source;
use super::spanned::Spanned;
use cplan_text::nearest_word;
use serde::de::value::Error as Message;
use serde::de::{Error as _, IntoDeserializer, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::fmt;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// A value in a TOML file, with its position.
pub type TomlValue<'a> = toml::Spanned<DeValue<'a>>;

/// A type that can be read from TOML files.
pub trait FromToml: Sized {
    /// Reads a value.
    ///
    /// # Errors
    /// Values of wrong types, and unknown and missing keys.
    fn read(value: &TomlValue) -> Result<Self, TomlError>;

    /// Returns the value if the key, or the element of a table that is written as a list, is missing. `None` if it is required.
    fn missing(_in_list: bool) -> Option<Self> {
        None
    }
}

/// An error in a TOML file.
#[derive(Debug)]
pub struct TomlError {
    message: String,
    at: Range<usize>,
    /// Hint that precedes that of the file's reader.
    hint: Option<String>,
}

impl TomlError {
    /// Creates an error about a value.
    pub fn new(value: &TomlValue, message: impl ToString) -> Self {
        Self { message: message.to_string(), at: value.span(), hint: None }
    }

    /// Creates an error about a value of a wrong type.
    pub fn wrong_type(value: &TomlValue, expected: &str) -> Self {
        let Err(error) = value.clone().into_deserializer().deserialize_any(Refusal(expected));
        error.into()
    }
}

impl From<toml::de::Error> for TomlError {
    fn from(error: toml::de::Error) -> Self {
        Self { message: error.message().to_owned(), at: error.span().unwrap_or_default(), hint: None }
    }
}

/// Refuses every value.
struct Refusal<'a>(&'a str);

impl Visitor<'_> for Refusal<'_> {
    type Value = Infallible;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.0)
    }
}

impl Source {
    /// Reads the text as TOML. `hint` returns the hint, given the message and the offset of the value or key.
    ///
    /// # Errors
    /// Malformed TOML, values of wrong types, and unknown and missing keys.
    pub fn toml<T: FromToml>(&self, hint: &dyn Fn(&str, usize) -> &'static str) -> Result<T, Diagnostic> {
        let tree = DeTable::parse(self.text()).map_err(TomlError::from);
        let read = tree.and_then(|tree| T::read(&toml::Spanned::new(tree.span(), DeValue::Table(tree.into_inner()))));
        read.map_err(|TomlError { message, at, hint: nearest }| {
            let hint = nearest.unwrap_or_else(|| hint(&message, at.start).to_owned());
            self.diagnostic_at(at, in_toml_words(&message)).help(hint)
        })
    }
}

/// Replaces Rust's words for keys and numbers in a message by those of TOML.
fn in_toml_words(message: &str) -> String {
    message
        .replace("unknown field", "unknown key")
        .replace("missing field", "missing key")
        .replace("expected f64", "expected a number")
        .replace("map, expected a sequence", "one table, expected a list of tables: [[...]]")
        .replace("expected i64", "expected a whole number")
}

/// Returns a number.
///
/// # Errors
/// Any other value. The message states what is `expected`.
pub fn number(value: &TomlValue, expected: &str) -> Result<f64, TomlError> {
    Ok(value.clone().into_deserializer().deserialize_any(NumberVisitor(expected))?)
}

struct NumberVisitor<'a>(&'a str);

impl Visitor<'_> for NumberVisitor<'_> {
    type Value = f64;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.0)
    }

    fn visit_f64<E>(self, value: f64) -> Result<f64, E> {
        Ok(value)
    }

    fn visit_i64<E>(self, value: i64) -> Result<f64, E> {
        Ok(value as f64)
    }
}

/// Reads scalars with serde.
macro_rules! scalars {
    ($($type:ty: $missing:expr,)*) => {
        $(impl FromToml for $type {
            fn read(value: &TomlValue) -> Result<Self, TomlError> {
                Ok(Self::deserialize(value.clone().into_deserializer())?)
            }

            fn missing(_in_list: bool) -> Option<Self> {
                $missing
            }
        })*
    };
}

scalars! { f64: None, i64: None, u64: None, String: None, bool: Some(false), }

impl<T: FromToml> FromToml for Option<T> {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        T::read(value).map(Some)
    }

    fn missing(in_list: bool) -> Option<Self> {
        (!in_list).then_some(None)
    }
}

impl<T: FromToml> FromToml for Vec<T> {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        let items = value.get_ref().as_array().ok_or_else(|| TomlError::wrong_type(value, "a sequence"))?;
        let mut list = Vec::with_capacity(items.len());
        for item in items.iter() {
            list.push(T::read(item)?);
        }
        Ok(list)
    }

    fn missing(_in_list: bool) -> Option<Self> {
        Some(Vec::new())
    }
}

impl<T: FromToml> FromToml for BTreeMap<Spanned<String>, T> {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        let table = value.get_ref().as_table().ok_or_else(|| TomlError::wrong_type(value, "a map"))?;
        let mut map = BTreeMap::new();
        for (key, item) in table {
            map.insert(Spanned::new(key.span(), key.get_ref().to_string()), T::read(item)?);
        }
        Ok(map)
    }

    fn missing(_in_list: bool) -> Option<Self> {
        Some(BTreeMap::new())
    }
}

/// The fields of a table, which may also be written as a list of their values. Used by the macro
/// [`toml_table`](crate::toml_table).
#[derive(Debug)]
pub struct Fields<'a> {
    value: &'a TomlValue<'a>,
    name: &'static str,
    keys: &'static [&'static str],
}

impl<'a> Fields<'a> {
    /// Creates the fields of a table with these keys.
    pub fn new(value: &'a TomlValue<'a>, name: &'static str, keys: &'static [&'static str]) -> Self {
        Self { value, name, keys }
    }

    /// Returns the keys and values that the file states, in the order of reading.
    ///
    /// # Errors
    /// A value that is neither a table nor a list.
    pub fn given(&self) -> Result<Vec<(&'a str, &'a TomlValue<'a>)>, TomlError> {
        match self.value.get_ref() {
            DeValue::Array(items) => Ok(self.keys.iter().copied().zip(items.iter()).collect()),
            DeValue::Table(table) => Ok(table.iter().map(|(key, item)| (&**key.get_ref(), item)).collect()),
            _ => Err(TomlError::wrong_type(self.value, &format!("struct {}", self.name))),
        }
    }

    /// Returns the error about an unknown key.
    pub fn unknown(&self, key: &str) -> TomlError {
        let known = self.value.get_ref().as_table().and_then(|table| table.get_key_value(key));
        let at = known.map_or(self.value.span(), |(key, _)| key.span());
        let hint = nearest_word(key, self.keys.iter().copied()).map(|key| format!("did you mean `{key}`?"));
        TomlError { message: Message::unknown_field(key, self.keys).to_string(), at, hint }
    }

    /// Returns the value of a field that the file does not state.
    ///
    /// # Errors
    /// A required field.
    pub fn missing<T: FromToml>(&self, key: &'static str) -> Result<T, TomlError> {
        T::missing(self.value.get_ref().is_array()).ok_or_else(|| self.missing_error(key))
    }

    fn missing_error(&self, key: &'static str) -> TomlError {
        let message = if self.value.get_ref().is_array() {
            let count = self.keys.len();
            let elements = if count == 1 { "element" } else { "elements" };
            let index = self.keys.iter().position(|known| *known == key).unwrap_or(count);
            Message::invalid_length(index, &&*format!("struct {} with {count} {elements}", self.name))
        } else {
            Message::missing_field(key)
        };
        TomlError::new(self.value, message)
    }
}

/// Returns the key of a field: its name, without the `r#` of names that are reserved in Rust.
pub const fn key_of(field: &'static str) -> &'static str {
    match field.as_bytes() {
        [b'r', b'#', ..] => field.split_at(2).1,
        _ => field,
    }
}

/// Defines the type of a table in TOML files, and reads it. Refuses unknown keys.
#[macro_export]
macro_rules! toml_table {
    ($(
        $(#[$attribute:meta])*
        $visibility:vis struct $name:ident {
            $($(#[$of_field:meta])* $visible:vis $field:ident: $type:ty,)*
        }
    )*) => {$(
        $(#[$attribute])*
        $visibility struct $name {
            $($(#[$of_field])* $visible $field: $type,)*
        }

        impl $crate::FromToml for $name {
            fn read(value: &$crate::TomlValue) -> Result<Self, $crate::TomlError> {
                let fields = $crate::Fields::new(
                    value,
                    stringify!($name),
                    const { &[$($crate::key_of(stringify!($field)),)*] },
                );
                $(let mut $field: Option<$type> = None;)*
                for (key, value) in fields.given()? {
                    $(if key == const { $crate::key_of(stringify!($field)) } {
                        $field = Some($crate::FromToml::read(value)?);
                        continue;
                    })*
                    return Err(fields.unknown(key));
                }
                Ok(Self {
                    $($field: match $field {
                        Some(given) => given,
                        None => fields.missing(const { $crate::key_of(stringify!($field)) })?,
                    },)*
                })
            }
        }
    )*};
}
