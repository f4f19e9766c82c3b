//! Reads YAML files, which often contain the dimensions of robots.

use crate::document;
use crate::error::Fault;
use crate::expression::insert;
use crate::value::Value;
use serde::de::{Deserialize, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use std::path::Path;
use std::{fmt, io};

/// Reads a YAML file as a value.
pub(crate) fn load(path: &Path, read: fn(&Path) -> io::Result<Vec<u8>>) -> Result<Value, Fault> {
    let text = document::text(path, read).map_err(|why| {
        Fault::with_hint(
            format!("the YAML file {} {why}", path.display()),
            "correct the path, which is relative to this file",
        )
    })?;
    let Yaml(value) = serde_saphyr::from_str(&text).map_err(|error| {
        let why = error.to_string();
        format!("the YAML file {}: {}", path.display(), why.lines().next().unwrap_or_default())
    })?;
    Ok(value)
}

struct Yaml(Value);

impl<'de> Deserialize<'de> for Yaml {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader).map(Self)
    }
}

struct Reader;

impl<'de> Visitor<'de> for Reader {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_bool<E>(self, x: bool) -> Result<Value, E> {
        Ok(Value::Bool(x))
    }

    fn visit_i64<E>(self, x: i64) -> Result<Value, E> {
        Ok(Value::Int(x))
    }

    fn visit_u64<E: serde::de::Error>(self, x: u64) -> Result<Value, E> {
        i64::try_from(x).map(Value::Int).map_err(|_| E::custom(format!("the number {x} is too large")))
    }

    fn visit_f64<E>(self, x: f64) -> Result<Value, E> {
        Ok(Value::Float(x))
    }

    fn visit_str<E>(self, text: &str) -> Result<Value, E> {
        Ok(Value::text(text))
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::None)
    }

    fn visit_none<E>(self) -> Result<Value, E> {
        Ok(Value::None)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<Value, A::Error> {
        let mut items = Vec::new();
        while let Some(Yaml(item)) = access.next_element()? {
            items.push(item);
        }
        Ok(Value::list(items))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Value, A::Error> {
        let mut items = Vec::new();
        while let Some((Yaml(key), Yaml(value))) = access.next_entry()? {
            if items.len() >= crate::limits::MAX_LIST_ITEMS {
                return Err(A::Error::custom("the file has too many keys"));
            }
            insert(&mut items, key, value);
        }
        Ok(Value::Dict(items.into()))
    }
}
