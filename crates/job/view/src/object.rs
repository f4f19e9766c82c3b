//! JSON objects in the documents that pages read.

use serde::ser::{Error, SerializeMap};
use serde::{Serialize, Serializer};
use serde_json::value::RawValue;

/// A JSON object: names in this order, with serialised values.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Object(Vec<(&'static str, String)>);

impl Object {
    /// Adds a value, unless it is missing.
    ///
    /// # Panics
    /// If the value has keys that are no strings.
    #[must_use]
    pub fn with(mut self, name: &'static str, value: &impl Serialize) -> Self {
        let value = serde_json::to_string(value).expect("the keys are strings");
        self.0.extend((value != "null").then_some((name, value)));
        self
    }

    /// Adds a value, unless it is missing, empty or false.
    #[must_use]
    pub fn with_any(self, name: &'static str, value: &impl Serialize) -> Self {
        let mut object = self.with(name, value);
        object.0.pop_if(|(last, value)| *last == name && ["\"\"", "[]", "false"].contains(&value.as_str()));
        object
    }
}

impl Serialize for Object {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let value = |text| serde_json::from_str::<&RawValue>(text).map_err(S::Error::custom);
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, text) in &self.0 {
            map.serialize_entry(name, value(text)?)?;
        }
        map.end()
    }
}

/// Returns an [`Object`] of names and values.
#[macro_export]
macro_rules! object {
    ($($name:literal: $value:expr),* $(,)?) => { $crate::Object::default()$(.with($name, &$value))* };
}
