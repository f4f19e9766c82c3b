//! Types that represent fields in the JSON schema of files in TOML.

/// Two numbers.
pub type NumberPair = [f64; 2];

/// Defines a type that represents the values of a field in a schema: its documentation, its name and its own schema.
/// The calling crate must depend on `schemars`.
#[macro_export]
macro_rules! stands_for {
    ($(#[$doc:meta])* $name:ident, $schema:tt) => {
        $(#[$doc])*
        pub struct $name;

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
stands_for! {
    /// An angle or a length.
    AngleOrLength, { "type": ["number", "string"], "pattern": "^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)? *deg *$" }
}
stands_for! {
    /// Grip of objects.
    HeldAs, { "type": "string", "enum": ["rigid", "level"] }
}
