//! JSON schemas of TOML files, derived from the types that read these files. Only tests need them, to compare them with the files
//! in `docs`.

pub use super::quantity::{Metres, Quantity};
use super::spanned::Spanned;
pub use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use schemars::transform::{Transform, transform_subschemas};
use schemars::{Schema, SchemaGenerator};
use serde_json::Value;
use std::borrow::Cow;
pub use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Returns a generator of JSON schemas of TOML files, in draft 7, which TOML editors support.
pub fn toml_schemas() -> SchemaGenerator {
    let mut settings = SchemaSettings::draft07();
    // This transform comes first, because those of the draft may apply to its result.
    settings.transforms.insert(0, Box::new(TomlSchema));
    settings.into_generator()
}

/// Compares a schema with its file in `docs`. If the environment has `CPLAN_WRITE_SCHEMAS`, writes the file instead.
///
/// # Panics
/// A schema that differs from its file.
pub fn compare_with_file(schema: Schema, name: &str) {
    let mut schema = schema.to_value();
    // The order of keys depends on features of serde_json that other crates may enable.
    schema.sort_all_objects();
    let text = format!("{schema:#}\n");
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs").join(name);
    if std::env::var_os("CPLAN_WRITE_SCHEMAS").is_some() {
        fs::write(&file, &text).unwrap();
    }
    assert_eq!(text, fs::read_to_string(file).unwrap(), "run `just docs`");
}

/// Adapts a schema to TOML. Removes `null` from the types of optional keys, which TOML does not have, and number formats of Rust
/// such as `double`.
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

/// The schema is that of the value.
impl<T: JsonSchema> JsonSchema for Spanned<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

/// Two numbers.
pub type NumberPair = [f64; 2];

/// Two lengths.
pub type LengthPair = [Metres; 2];

/// Defines a type that stands for a field's values in a schema: its documentation, its name and its schema.
#[macro_export]
macro_rules! stands_for {
    ($(#[$doc:meta])* $name:ident, $schema:tt) => {
        $(#[$doc])*
        pub struct $name;

        $crate::has_schema! { $name, $schema }
    };
}

/// Gives a type a schema. The calling crate must depend on `schemars`.
#[macro_export]
macro_rules! has_schema {
    ($name:ident, $schema:tt) => {
        impl ::schemars::JsonSchema for $name {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> ::std::borrow::Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut ::schemars::SchemaGenerator) -> ::schemars::Schema {
                ::schemars::json_schema!($schema)
            }
        }
    };
}

stands_for! {
    /// A number above 0.
    Positive, { "type": "number", "exclusiveMinimum": 0 }
}
has_schema! {
    Metres, { "type": ["number", "string"], "pattern": "^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)? *(mm|cm|dm|m|km|um|mil|in|ft|yd) *$" }
}
stands_for! {
    /// A length above 0.
    PositiveLength, { "type": ["number", "string"], "pattern": "^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)? *(mm|cm|dm|m|km|um|mil|in|ft|yd) *$", "exclusiveMinimum": 0 }
}
stands_for! {
    /// A length of 0 or more.
    NotNegativeLength, { "type": ["number", "string"], "pattern": "^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)? *(mm|cm|dm|m|km|um|mil|in|ft|yd) *$", "minimum": 0 }
}
has_schema! {
    Quantity, { "type": ["number", "string"], "pattern": "^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)? *deg *$" }
}
stands_for! {
    /// The greatest error of a length, of an angle, or of both.
    StatedError, { "type": ["number", "string"], "minimum": 0, "pattern": "^ *[0-9.]+([eE][-+]?[0-9]+)? *(mm|cm|dm|m|km|um|mil|in|ft|yd|deg|rad) *(, *[0-9.]+([eE][-+]?[0-9]+)? *(mm|cm|dm|m|km|um|mil|in|ft|yd|deg|rad) *)?$" }
}
stands_for! {
    /// Grip of objects.
    HeldAs, { "type": "string", "enum": ["rigid", "level"] }
}
