//! Renders a JSON schema as a page of tables. `tests/input/world_schema.rs` checks that the committed page is up to date.

use serde_json::{Map, Value};

const HEAD: &str = "\
# Every key of the world file

This page is generated from [the schema](world.schema.json) by `cargo run --example world_reference`. [The world file](world_file.md)
explains the keys by examples. cplan refuses keys that it does not know. An angle may be written `\"30deg\"`, a length `\"20 mm\"` (units: mm, cm, dm, m, km, um, mil, in, ft, yd).
";

/// Returns the whole page. It describes the file itself first, and then all its tables, sorted by name.
pub fn page(schema: &Value) -> String {
    let tables = schema["definitions"].as_object().expect("a schema with definitions");
    let mut page = format!("{HEAD}\n## The file\n\n{}", table(schema, tables));
    for (name, definition) in tables {
        page.push_str(&format!("\n## {name}\n\n{}", table(definition, tables)));
    }
    page
}

/// Describes a table, its keys, and their dependencies.
fn table(schema: &Value, tables: &Map<String, Value>) -> String {
    let required: Vec<&str> = names(&schema["required"]);
    let mut text = format!("{}\n\n| key | holds | meaning |\n|---|---|---|\n", described(schema));
    for (key, value) in schema["properties"].as_object().into_iter().flatten() {
        let needed = if required.contains(&key.as_str()) { " (required)" } else { "" };
        let meaning = match (described(value), refers_to(value)) {
            (own, Some(name)) if own.is_empty() => described(&tables[name]),
            (own, _) => own,
        };
        text.push_str(&format!("| `{key}`{needed} | {} | {meaning} |\n", kind(value, Number::One)));
    }
    let rules = rules(schema);
    if !rules.is_empty() {
        text.push_str(&format!("\n{}\n", rules.join(" ")));
    }
    text
}

/// Describes which keys exclude or require each other.
fn rules(schema: &Value) -> Vec<String> {
    let mut rules = Vec::new();
    let all = schema["allOf"].as_array().into_iter().flatten();
    for choices in std::iter::once(schema).chain(all).filter_map(|part| part["oneOf"].as_array()) {
        let keys: Vec<String> = choices.iter().flat_map(|c| names(&c["required"])).map(code).collect();
        rules.push(format!("Exactly one of {}.", listed(&keys, "and")));
    }
    for (key, needs) in schema["dependencies"].as_object().into_iter().flatten() {
        let excluded = names(&needs["not"]["required"]);
        rules.push(match names(needs)[..] {
            [] => format!("`{key}` excludes {}.", listed(&excluded.into_iter().map(code).collect::<Vec<_>>(), "and")),
            ref needed => {
                format!("`{key}` requires {}.", listed(&needed.iter().copied().map(code).collect::<Vec<_>>(), "and"))
            }
        });
    }
    rules
}

#[derive(Clone, Copy, PartialEq)]
enum Number {
    One,
    Many,
}

/// Describes the type of a value.
fn kind(value: &Value, number: Number) -> String {
    let noun = |one: &str, many: &str| if number == Number::One { one.to_owned() } else { many.to_owned() };
    if let Some(name) = refers_to(value) {
        return noun(&format!("a table: [{name}](#{name})"), &format!("tables: [{name}](#{name})"));
    }
    if let Some(choices) = value["enum"].as_array() {
        let words: Vec<String> = choices.iter().filter_map(Value::as_str).map(|w| code(&format!("\"{w}\""))).collect();
        return listed(&words, "or");
    }
    match &value["type"] {
        Value::Array(_) => {
            let unit = |unit: &str| value["pattern"].as_str().is_some_and(|pattern| pattern.contains(unit));
            match (unit("deg"), unit("rad")) {
                (true, true) => noun("a length, an angle, or both", "errors"),
                (true, false) => noun("an angle or a length", "angles or lengths"),
                (false, _) => noun("a length", "lengths"),
            }
        }
        Value::String(name) => match name.as_str() {
            "number" => noun("a number", "numbers") + &range(value),
            "integer" => noun("a whole number", "whole numbers") + &range(value),
            "boolean" => "`true` or `false`".into(),
            "string" => noun("a text", "texts"),
            "object" => format!("for each joint, by name, {}", kind(&value["additionalProperties"], Number::One)),
            _ => match value["anyOf"].as_array() {
                Some(forms) => forms.iter().map(|form| list(form, number)).collect::<Vec<_>>().join(", or "),
                None => list(value, number),
            },
        },
        Value::Null if value["anyOf"].is_array() => {
            let forms = value["anyOf"].as_array().into_iter().flatten();
            forms.map(|form| kind(form, number)).collect::<Vec<_>>().join(", or ")
        }
        other => panic!("a type that the reference has no words for: {other}"),
    }
}

/// Returns the name of the table to which a value refers. `None` if it refers to none.
fn refers_to(value: &Value) -> Option<&str> {
    let reference = [&value["$ref"], &value["allOf"][0]["$ref"]].into_iter().find_map(Value::as_str);
    reference.and_then(|path| path.strip_prefix("#/definitions/"))
}

/// Describes an array.
fn list(value: &Value, number: Number) -> String {
    let items = kind(&value["items"], Number::Many);
    let (least, most) = (value["minItems"].as_u64(), value["maxItems"].as_u64());
    match (number, least, most) {
        (Number::One, Some(2), Some(2)) => format!("two {items}"),
        (Number::Many, Some(2), Some(2)) => format!("pairs of {items}"),
        (Number::One, Some(3), Some(3)) => format!("three {items}"),
        (Number::One, Some(least), _) if least > 1 => format!("a list of {items}, {least} or more"),
        (Number::One, ..) => format!("a list of {items}"),
        (Number::Many, ..) => format!("lists of {items}"),
    }
}

/// Describes the bounds of a number.
fn range(value: &Value) -> String {
    let above = value["exclusiveMinimum"].as_f64().map(|bound| format!(" above {bound}"));
    let from = value["minimum"].as_f64().map(|bound| format!(" of {bound} or more"));
    let to = value["maximum"].as_f64().map(|bound| format!(", at most {bound}"));
    [above, from, to].into_iter().flatten().collect()
}

/// Returns the description on one line. Escapes bars, which would otherwise end a cell of the table.
fn described(value: &Value) -> String {
    let own = value["description"].as_str().unwrap_or_default();
    own.replace('\n', " ").replace('|', "\\|")
}

fn names(value: &Value) -> Vec<&str> {
    value.as_array().into_iter().flatten().filter_map(Value::as_str).collect()
}

fn code(word: &str) -> String {
    format!("`{word}`")
}

fn listed(words: &[String], last: &str) -> String {
    match words {
        [] => String::new(),
        [only] => only.clone(),
        [most @ .., end] => format!("{} {last} {end}", most.join(", ")),
    }
}
