//! The JSON schema of world files, for editors: derived from the types that read them.

use cplan_robot::stands_for;
use schemars::generate::SchemaSettings;
use schemars::transform::{Transform, transform_subschemas};
use schemars::{JsonSchema, Schema};
use serde_json::Value;

/// Returns the JSON schema of a file that is written in TOML.
pub fn toml_schema<T: JsonSchema>() -> Value {
    let mut settings = SchemaSettings::draft07();
    // First, because the draft's own transforms may apply to its result.
    settings.transforms.insert(0, Box::new(TomlSchema));
    let mut schema = settings.into_generator().into_root_schema_for::<T>().to_value();
    // In any order of serde_json's maps, which other crates may choose.
    schema.sort_all_objects();
    schema
}

/// Takes back that optional keys may be null, as TOML has no null, and the formats of numbers, which are Rust's.
#[derive(Debug, Clone)]
struct TomlSchema;

impl Transform for TomlSchema {
    fn transform(&mut self, schema: &mut Schema) {
        transform_subschemas(self, schema);
        let Some(object) = schema.as_object_mut() else { return };
        object.remove("format");
        if let Some(Value::Array(types)) = object.get_mut("type") {
            types.retain(|name| name != "null");
            if let [only] = &types[..] {
                let only = only.clone();
                object.insert("type".into(), only);
            }
        }
        if let Some(Value::Array(choices)) = object.get_mut("anyOf") {
            choices.retain(|choice| choice.get("type").is_none_or(|name| name != "null"));
            if let [Value::Object(only)] = &choices[..] {
                let only = only.clone();
                object.remove("anyOf");
                object.extend(only);
            }
        }
    }
}

stands_for! {
    /// A number of 0 or more.
    NotNegative, { "type": "number", "minimum": 0 }
}
stands_for! {
    /// A number above 0 and at most 1.
    Share, { "type": "number", "exclusiveMinimum": 0, "maximum": 1 }
}
stands_for! {
    /// Corners of a polygon.
    Corners, {
        "type": "array",
        "minItems": 3,
        "items": { "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 }
    }
}
stands_for! {
    /// Corners of a polygon, or of an outer ring and its holes.
    Rings, {
        "type": "array",
        "anyOf": [
            {
                "minItems": 3,
                "items": { "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 }
            },
            {
                "minItems": 1,
                "items": {
                    "type": "array",
                    "minItems": 3,
                    "items": { "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 }
                }
            }
        ]
    }
}
stands_for! {
    /// Kind of the unknown cells of an image.
    UnknownAs, { "type": "string", "enum": ["solid", "free"] }
}
stands_for! {
    /// The link to which a sensor is attached.
    SensorOn, { "type": "string", "enum": ["tip", "base"] }
}
stands_for! {
    /// Order of steps.
    DoneIn, { "type": "string", "enum": ["fixed", "free"] }
}
