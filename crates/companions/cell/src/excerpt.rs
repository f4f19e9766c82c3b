//! Parts of a TOML file as the text of another one. The place of each part in the original file is known, so errors about
//! the new text have lines of the original file.

use cplan_robot::{FromToml, Origins, Source, TomlError, TomlValue};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;
use toml::de::DeValue;

/// A part of a TOML file, written as an inline value.
#[derive(Debug, Clone, Default)]
pub(crate) struct Excerpt {
    text: String,
    /// Offsets in the text, each with the range of the original file from which the text up to the next offset was copied.
    places: Vec<(usize, Range<usize>)>,
    /// The keys of a table, with their places in the file. `None` for another value.
    keys: Option<Vec<(String, Range<usize>)>>,
}

impl FromToml for Excerpt {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        let mut excerpt = Self::default();
        excerpt.push(value);
        let keys =
            |table: &toml::de::DeTable| table.keys().map(|key| (key.get_ref().to_string(), key.span())).collect();
        excerpt.keys = value.get_ref().as_table().map(keys);
        Ok(excerpt)
    }
}

impl Excerpt {
    /// Returns the place of a key in the file. `None` if the excerpt is no table, or has no such key.
    pub fn key(&self, name: &str) -> Option<Range<usize>> {
        self.keys.iter().flatten().find(|(key, _)| key == name).map(|(_, place)| place.clone())
    }

    /// Returns true if the excerpt is a table.
    pub fn is_table(&self) -> bool {
        self.keys.is_some()
    }

    /// Returns the text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Appends a value.
    fn push(&mut self, value: &TomlValue) {
        self.places.push((self.text.len(), value.span()));
        match value.get_ref() {
            DeValue::String(text) => self.text += &quoted(text),
            DeValue::Integer(number) => {
                let prefix = match number.radix() {
                    2 => "0b",
                    8 => "0o",
                    16 => "0x",
                    _ => "",
                };
                self.text += prefix;
                self.text += number.as_str();
            }
            DeValue::Float(number) => self.text += number.as_str(),
            DeValue::Boolean(is_true) => self.text += if *is_true { "true" } else { "false" },
            DeValue::Datetime(time) => self.text += &time.to_string(),
            DeValue::Array(items) => {
                self.text.push('[');
                for item in items.iter() {
                    self.push(item);
                    self.text.push(',');
                }
                self.text.push(']');
            }
            DeValue::Table(table) => {
                self.text.push('{');
                for (k, (key, item)) in table.iter().enumerate() {
                    self.text += if k > 0 { "," } else { "" };
                    self.places.push((self.text.len(), key.span()));
                    self.text += &quoted(key.get_ref());
                    self.text.push('=');
                    self.push(item);
                }
                self.places.push((self.text.len(), value.span()));
                self.text.push('}');
            }
        }
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
    places: Vec<(usize, Range<usize>)>,
}

impl Composition {
    /// Appends a key with a text as its value. `at` is the place in the file that messages show.
    pub fn text(&mut self, key: &str, value: &str, at: Range<usize>) {
        self.places.push((self.text.len(), at));
        self.text += &format!("{key} = {}\n", quoted(value));
    }

    /// Appends a key with an excerpt as its value.
    pub fn value(&mut self, key: &str, excerpt: &Excerpt) {
        self.places.extend(excerpt.places.first().map(|(_, at)| (self.text.len(), at.clone())));
        self.text += &format!("{key} = ");
        self.append(excerpt);
        self.text.push('\n');
    }

    /// Appends a key with a table as its value: the entries of a table, if there is one, and more of them.
    pub fn table(&mut self, key: &str, table: Option<&Excerpt>, more: &[(&str, &Excerpt)]) {
        self.text += &format!("{key} = {{");
        let mut is_first = true;
        if let Some(table) = table.filter(|table| table.keys.as_ref().is_some_and(|keys| !keys.is_empty())) {
            // Without the braces, which are the first and the last byte.
            let inner = table.text.len() - 1;
            let places = table.places.iter().filter(|(offset, _)| *offset < inner);
            self.places.extend(places.map(|(offset, at)| (self.text.len() + offset.saturating_sub(1), at.clone())));
            self.text += &table.text[1..inner];
            is_first = false;
        }
        for (name, value) in more {
            self.text += if is_first { "" } else { "," };
            self.places.extend(value.places.first().map(|(_, at)| (self.text.len(), at.clone())));
            self.text += &format!("{name} = ");
            self.append(value);
            is_first = false;
        }
        self.text += "}\n";
    }

    fn append(&mut self, excerpt: &Excerpt) {
        self.places.extend(excerpt.places.iter().map(|(offset, at)| (self.text.len() + offset, at.clone())));
        self.text += &excerpt.text;
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
        composed.table("all", Some(&one), &[("two", &two)]);
        composed.value("again", &two);
        composed.table("none", None, &[]);
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
