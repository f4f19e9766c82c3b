//! Parts of a TOML file as the text of another one. The place of each part in the original file is known, so errors about
//! the new text have lines of the original file.

use cplan_robot::{FromToml, Origins, Source, TomlError, TomlValue};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;
use toml::de::DeValue;

/// A part of a TOML file.
#[derive(Debug, Clone)]
pub(crate) struct Excerpt {
    /// Its place in the file.
    place: Range<usize>,
    value: Value,
}

/// The value of an excerpt.
#[derive(Debug, Clone)]
enum Value {
    Text(String),
    /// A number, a boolean or a time, as an inline value.
    Other(String),
    Array(Vec<Excerpt>),
    /// The keys with their places and values.
    Table(Vec<(String, Range<usize>, Excerpt)>),
}

impl FromToml for Excerpt {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        let all = |items: &toml::de::DeArray| items.iter().map(Self::read).collect::<Result<_, _>>();
        let entry = |(key, item): (&toml::Spanned<toml::de::DeString>, &TomlValue)| {
            Ok((key.get_ref().to_string(), key.span(), Self::read(item)?))
        };
        let read = match value.get_ref() {
            DeValue::String(text) => Value::Text(text.to_string()),
            DeValue::Integer(number) => {
                let prefix = match number.radix() {
                    2 => "0b",
                    8 => "0o",
                    16 => "0x",
                    _ => "",
                };
                Value::Other(format!("{prefix}{}", number.as_str()))
            }
            DeValue::Float(number) => Value::Other(number.as_str().to_owned()),
            DeValue::Boolean(is_true) => Value::Other(is_true.to_string()),
            DeValue::Datetime(time) => Value::Other(time.to_string()),
            DeValue::Array(items) => Value::Array(all(items)?),
            DeValue::Table(table) => Value::Table(table.iter().map(entry).collect::<Result<_, TomlError>>()?),
        };
        Ok(Self { place: value.span(), value: read })
    }
}

impl Excerpt {
    /// Creates a text at a place of the file.
    pub fn of_text(text: &str, place: Range<usize>) -> Self {
        Self { place, value: Value::Text(text.to_owned()) }
    }

    /// Creates a number at a place of the file.
    pub fn of_number(number: f64, place: Range<usize>) -> Self {
        Self { place, value: Value::Other(format!("{number:?}")) }
    }

    /// Creates an array at a place of the file.
    pub fn of_items(items: Vec<Self>, place: Range<usize>) -> Self {
        Self { place, value: Value::Array(items) }
    }

    /// Creates a table without keys at a place of the file.
    pub fn empty_table(place: Range<usize>) -> Self {
        Self { place, value: Value::Table(Vec::new()) }
    }

    /// Returns the place in the file.
    pub fn place(&self) -> Range<usize> {
        self.place.clone()
    }

    /// Returns the place of a key in the file. `None` if the excerpt is no table, or has no such key.
    pub fn key(&self, name: &str) -> Option<Range<usize>> {
        self.entries().iter().find(|(key, ..)| key == name).map(|(_, place, _)| place.clone())
    }

    /// Returns the value of a key. `None` if the excerpt is no table, or has no such key.
    pub fn get(&self, name: &str) -> Option<&Self> {
        self.entries().iter().find(|(key, ..)| key == name).map(|(.., value)| value)
    }

    /// Returns true if the excerpt is a table.
    pub fn is_table(&self) -> bool {
        matches!(self.value, Value::Table(_))
    }

    /// Returns the text of a string. `None` for other values.
    pub fn as_text(&self) -> Option<&str> {
        if let Value::Text(text) = &self.value { Some(text) } else { None }
    }

    /// Returns the items of an array. Empty for other values.
    pub fn items(&self) -> &[Self] {
        if let Value::Array(items) = &self.value { items } else { &[] }
    }

    /// Returns the table with this value of a key, instead of any other value.
    #[must_use]
    pub fn with(self, key: &str, value: Self) -> Self {
        let mut table = self.without(key);
        if let Value::Table(entries) = &mut table.value {
            entries.push((key.to_owned(), value.place(), value));
        }
        table
    }

    /// Returns the table without a key.
    #[must_use]
    pub fn without(mut self, key: &str) -> Self {
        if let Value::Table(entries) = &mut self.value {
            entries.retain(|(known, ..)| known != key);
        }
        self
    }

    /// Returns the excerpt as an inline value.
    pub fn text(&self) -> String {
        let mut written = Composition::default();
        written.push(self);
        written.text
    }

    fn entries(&self) -> &[(String, Range<usize>, Self)] {
        if let Value::Table(entries) = &self.value { entries } else { &[] }
    }
}

/// Returns a basic string of TOML.
fn quoted(text: &str) -> String {
    // The escapes of JSON are among those of TOML.
    serde_json::to_string(text).expect("a text is valid JSON")
}

/// A text that is composed of excerpts.
#[derive(Debug, Default)]
pub(crate) struct Composition {
    text: String,
    /// Offsets in the text, each with the range of the original file from which the text up to the next offset was copied.
    places: Vec<(usize, Range<usize>)>,
}

impl Composition {
    /// Appends a key with an excerpt as its value.
    pub fn value(&mut self, key: &str, excerpt: &Excerpt) {
        self.places.push((self.text.len(), excerpt.place()));
        self.text += &format!("{key} = ");
        self.push(excerpt);
        self.text.push('\n');
    }

    /// Appends an inline value.
    fn push(&mut self, excerpt: &Excerpt) {
        self.places.push((self.text.len(), excerpt.place()));
        match &excerpt.value {
            Value::Text(text) => self.text += &quoted(text),
            Value::Other(text) => self.text += text,
            Value::Array(items) => {
                self.text.push('[');
                for item in items {
                    self.push(item);
                    self.text.push(',');
                }
                self.text.push(']');
            }
            Value::Table(entries) => {
                self.text.push('{');
                for (k, (key, place, item)) in entries.iter().enumerate() {
                    self.text += if k > 0 { "," } else { "" };
                    self.places.push((self.text.len(), place.clone()));
                    self.text += &quoted(key);
                    self.text.push('=');
                    self.push(item);
                }
                self.places.push((self.text.len(), excerpt.place()));
                self.text.push('}');
            }
        }
    }

    /// Returns the text as a source. Messages about it show the original file.
    pub fn source(self, original: &Source) -> Source {
        let Self { text, places } = self;
        original.converted(text, Arc::new(Places { original: original.clone(), places }))
    }
}

/// The original places of the parts of a composition, in the order of the text.
#[derive(Debug)]
struct Places {
    original: Source,
    places: Vec<(usize, Range<usize>)>,
}

impl Origins for Places {
    fn files(&self) -> Vec<PathBuf> {
        self.original.files()
    }

    fn place(&self, offset: usize) -> Option<(Source, Range<usize>)> {
        let next = self.places.partition_point(|(begin, _)| *begin <= offset);
        let (_, at) = self.places.get(next.checked_sub(1)?)?;
        Some((self.original.clone(), at.clone()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_robot::toml_table;

    toml_table! {
        struct Both {
            one: Excerpt,
            two: Option<Excerpt>,
        }
    }

    #[test]
    fn a_composition_has_the_values_and_the_places_of_its_parts() {
        let text = "one = { \"a b\" = 'x\"y', n = [1, 0x1F, -2.5e3], t = { on = true } }\n[two]\nk = \"5deg\"\n";
        let source = Source::in_memory("cell.toml", text);
        let Both { one, two } = source.toml(&|_, _| "").unwrap();
        let two = two.unwrap();
        let mut composed = Composition::default();
        composed.value("all", &one.clone().with("two", two.clone()));
        composed.value("again", &two);
        composed.value("none", &two.clone().without("k"));
        let composed = composed.source(&source);
        let read: toml::Table = composed.text().parse().unwrap();
        let expected = "all = { \"a b\" = 'x\"y', n = [1, 31, -2500.0], t = { on = true }, two = { k = '5deg' } }\n\
                        again = { k = '5deg' }\nnone = {}";
        assert_eq!(read, expected.parse().unwrap());
        for part in ["31", "0x1F", "-2.5e3", "true", "5deg"] {
            let Some(offset) = composed.text().find(part) else { continue };
            let shown = composed.diagnostic_at(offset..offset + 1, "here").to_string();
            let begins = text.find(part).unwrap();
            let line = text[..begins].matches('\n').count() + 1;
            assert!(shown.starts_with(&format!("cell.toml: line {line}, ")), "{part}: {shown}");
        }
        assert!(one.key("n").is_some() && one.key("k").is_none() && two.is_table());
    }
}
