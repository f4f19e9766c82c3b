//! Numbers that may be infinite, for `#[serde(with = "crate::number")]`. JSON cannot represent infinity, so it is
//! written as `"inf"` or `"-inf"`. NaN is refused.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A finite number, or the word for an infinite one.
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

/// Reads a number written by [`serialize`].
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    match Number::deserialize(deserializer)? {
        Number::Finite(value) if value.is_nan() => Err(D::Error::custom("this is not a number")),
        Number::Finite(value) => Ok(value),
        Number::Infinite(Sign::Plus) => Ok(f64::INFINITY),
        Number::Infinite(Sign::Minus) => Ok(f64::NEG_INFINITY),
    }
}
