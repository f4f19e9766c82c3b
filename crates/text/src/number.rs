//! Numbers that may be infinite, as data: for `#[serde(with = "crate::number")]`. JSON has no word for what is infinite, so
//! that is written as `"inf"` and `"-inf"`. What is no number is refused.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Finite, or in a word.
#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "a number, \"inf\" or \"-inf\"")]
enum Number {
    Finite(f64),
    Infinite(Sign),
}

#[derive(Serialize, Deserialize)]
enum Sign {
    #[serde(rename = "inf")]
    Plus,
    #[serde(rename = "-inf")]
    Minus,
}

/// Writes a number that may be infinite.
pub fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    let number = match *value {
        f64::INFINITY => Number::Infinite(Sign::Plus),
        f64::NEG_INFINITY => Number::Infinite(Sign::Minus),
        finite => Number::Finite(finite),
    };
    number.serialize(serializer)
}

/// Reads what [`serialize`] has written.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    match Number::deserialize(deserializer)? {
        Number::Finite(value) if value.is_nan() => Err(D::Error::custom("this is not a number")),
        Number::Finite(value) => Ok(value),
        Number::Infinite(Sign::Plus) => Ok(f64::INFINITY),
        Number::Infinite(Sign::Minus) => Ok(f64::NEG_INFINITY),
    }
}
