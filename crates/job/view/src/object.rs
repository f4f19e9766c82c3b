//! Objects of the documents that pages read.

use serde::{Serialize, Serializer};
use serde_json::value::{RawValue, to_raw_value};

/// An object of a document: names in this order, with values that are already text.
#[derive(Debug, Default)]
pub struct Object(Vec<(&'static str, Box<RawValue>)>);

impl Object {
    /// Returns the object with another value. A missing value is left out.
    ///
    /// # Panics
    /// If the value has keys that are no strings.
    #[must_use]
    pub fn with(mut self, name: &'static str, value: &impl Serialize) -> Self {
        let value = to_raw_value(value).expect("the keys are strings");
        self.0.extend((value.get() != "null").then_some((name, value)));
        self
    }
}

impl Serialize for Object {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

/// Returns an [`Object`] of names and values.
#[macro_export]
macro_rules! object {
    ($($name:literal: $value:expr),* $(,)?) => { $crate::Object::default()$(.with($name, &$value))* };
}
