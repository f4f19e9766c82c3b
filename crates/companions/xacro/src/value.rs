//! Values of expressions, as in Python.

use std::cmp::Ordering;
use std::rc::Rc;

#[derive(Debug, Clone)]
pub(crate) enum Value {
    None,
    Bool(bool),
    Int(i64),
    Float(f64),
    Text(Rc<str>),
    List(Rc<Vec<Value>>),
    /// A dict in the order of insertion.
    Dict(Rc<Vec<(Value, Value)>>),
}

/// A number in arithmetic: an integer or a float.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Number {
    Int(i64),
    Float(f64),
}

impl Number {
    pub fn as_f64(self) -> f64 {
        match self {
            Self::Int(x) => x as f64,
            Self::Float(x) => x,
        }
    }
}

impl From<Number> for Value {
    fn from(number: Number) -> Self {
        match number {
            Number::Int(x) => Self::Int(x),
            Number::Float(x) => Self::Float(x),
        }
    }
}

impl Value {
    pub fn text(text: impl Into<Rc<str>>) -> Self {
        Self::Text(text.into())
    }

    pub fn list(items: Vec<Value>) -> Self {
        Self::List(Rc::new(items))
    }

    /// Returns the name of the type in Python.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::None => "None",
            Self::Bool(_) => "bool",
            Self::Int(_) => "int",
            Self::Float(_) => "float",
            Self::Text(_) => "text",
            Self::List(_) => "list",
            Self::Dict(_) => "dict",
        }
    }

    /// Returns the value as a number; `True` counts as 1.
    pub fn number(&self) -> Option<Number> {
        match self {
            Self::Bool(x) => Some(Number::Int(i64::from(*x))),
            Self::Int(x) => Some(Number::Int(*x)),
            Self::Float(x) => Some(Number::Float(*x)),
            _ => None,
        }
    }

    /// Returns the truth value by Python's rules.
    pub fn is_true(&self) -> bool {
        match self {
            Self::None => false,
            Self::Bool(x) => *x,
            Self::Int(x) => *x != 0,
            Self::Float(x) => *x != 0.0,
            Self::Text(text) => !text.is_empty(),
            Self::List(items) => !items.is_empty(),
            Self::Dict(items) => !items.is_empty(),
        }
    }

    /// Converts a text that looks like a number or a truth value to that value, as xacro does for properties and
    /// parameters.
    pub fn literal(self) -> Self {
        let Self::Text(text) = &self else { return self };
        if text.len() >= 2 && text.starts_with('\'') && text.ends_with('\'') {
            return Self::text(&text[1..text.len() - 1]);
        }
        let plain = text.trim();
        if text.contains('_') {
            return self;
        }
        if let Ok(x) = plain.parse::<i64>() {
            return Self::Int(x);
        }
        if let Some(x) = float(plain) {
            return Self::Float(x);
        }
        match &**text {
            "true" | "True" => Self::Bool(true),
            "false" | "False" => Self::Bool(false),
            _ => self,
        }
    }

    /// Returns the truth value of a condition. A text must be `true` or `false`, or a number. Returns `None` for other
    /// values.
    pub fn condition(&self) -> Option<bool> {
        let Self::Text(text) = self else { return Some(self.is_true()) };
        match text.trim() {
            "true" | "True" => Some(true),
            "false" | "False" => Some(false),
            number => number.parse::<i64>().ok().map(|x| x != 0),
        }
    }

    /// Compares two values by Python's `==`.
    pub fn equals(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Text(a), Self::Text(b)) => a == b,
            (Self::None, Self::None) => true,
            (Self::List(a), Self::List(b)) => a.len() == b.len() && a.iter().zip(&**b).all(|(a, b)| a.equals(b)),
            (Self::Dict(a), Self::Dict(b)) => {
                a.len() == b.len()
                    && a.iter().all(|(key, value)| other.item(key).is_some_and(|other| other.equals(value)))
            }
            _ => self.compare(other) == Some(Ordering::Equal),
        }
    }

    /// Compares two numbers or two texts. Returns `None` for other values.
    pub fn compare(&self, other: &Self) -> Option<Ordering> {
        match (self, other) {
            (Self::Text(a), Self::Text(b)) => Some(a.cmp(b)),
            _ => match (self.number()?, other.number()?) {
                (Number::Int(a), Number::Int(b)) => Some(a.cmp(&b)),
                (a, b) => a.as_f64().partial_cmp(&b.as_f64()),
            },
        }
    }

    /// Returns the value for a key of a dict.
    pub fn item(&self, key: &Self) -> Option<&Self> {
        let Self::Dict(items) = self else { return None };
        items.iter().find(|(known, _)| known.equals(key)).map(|(_, value)| value)
    }

    /// Formats the value as Python prints it.
    pub fn printed(&self) -> String {
        match self {
            Self::Text(text) => text.to_string(),
            other => other.written(),
        }
    }

    /// Formats the value as Python prints it within a list.
    fn written(&self) -> String {
        let joined = |parts: Vec<String>| parts.join(", ");
        match self {
            Self::None => "None".into(),
            Self::Bool(true) => "True".into(),
            Self::Bool(false) => "False".into(),
            Self::Int(x) => x.to_string(),
            Self::Float(x) => float_text(*x),
            Self::Text(text) => format!("'{text}'"),
            Self::List(items) => format!("[{}]", joined(items.iter().map(Self::written).collect())),
            Self::Dict(items) => {
                let item = |(key, value): &(Self, Self)| format!("{}: {}", key.written(), value.written());
                format!("{{{}}}", joined(items.iter().map(item).collect()))
            }
        }
    }
}

/// Parses a number as Python's `float` does, without underscores.
pub(crate) fn float(text: &str) -> Option<f64> {
    // Rust and Python accept the same words, in any case, also "infinity" with a sign.
    text.trim().parse().ok()
}

/// Formats a number as Python does: the shortest text with the same value, with an exponent beyond 16 digits.
fn float_text(x: f64) -> String {
    let size = x.abs();
    if !x.is_finite() {
        return if x.is_nan() {
            "nan".into()
        } else if x > 0.0 {
            "inf".into()
        } else {
            "-inf".into()
        };
    }
    if size != 0.0 && !(1e-4..1e16).contains(&size) {
        let text = format!("{x:e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let (sign, exponent) = exponent.strip_prefix('-').map_or(('+', exponent), |e| ('-', e));
        return format!("{digits}e{sign}{exponent:0>2}");
    }
    if x == x.trunc() { format!("{x:.1}") } else { format!("{x}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_python_writes_them() {
        for (x, text) in [
            (0.1 + 0.2, "0.30000000000000004"),
            (2.0, "2.0"),
            (-0.0, "-0.0"),
            (1e-5, "1e-05"),
            (1.5e-7, "1.5e-07"),
            (0.0001, "0.0001"),
            (1e16, "1e+16"),
            (123_456_789.0, "123456789.0"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(float_text(x), text);
        }
    }

    #[test]
    fn a_text_that_reads_like_a_number_is_one() {
        let literal = |text: &str| Value::text(text).literal();
        assert!(matches!(literal("12"), Value::Int(12)));
        assert!(matches!(literal(" 1.5 "), Value::Float(1.5)));
        assert!(matches!(literal("true"), Value::Bool(true)));
        assert!(matches!(literal("1_2"), Value::Text(_)));
        assert_eq!(literal("'12'").printed(), "12");
        assert!(matches!(literal("0 0 1"), Value::Text(_)));
    }
}
