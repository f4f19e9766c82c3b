//! The functions and constants of expressions: those of Python's `math`, and some of Python's own.

use crate::error::Fault;
use crate::limits::MAX_LIST_ITEMS;
use crate::value::{Number, Value, float};
use std::cmp::Ordering;
use std::f64::consts;

/// A function of one number, with its name.
type OfOne = (&'static str, fn(f64) -> f64);

const UNARY_FUNCTIONS: [OfOne; 25] = [
    ("acos", f64::acos),
    ("acosh", f64::acosh),
    ("asin", f64::asin),
    ("asinh", f64::asinh),
    ("atan", f64::atan),
    ("atanh", f64::atanh),
    ("cbrt", f64::cbrt),
    ("cos", f64::cos),
    ("cosh", f64::cosh),
    ("degrees", f64::to_degrees),
    ("exp", f64::exp),
    ("expm1", f64::exp_m1),
    ("fabs", f64::abs),
    ("log", f64::ln),
    ("log10", f64::log10),
    ("log1p", f64::ln_1p),
    ("log2", f64::log2),
    ("radians", f64::to_radians),
    ("sin", f64::sin),
    ("sinh", f64::sinh),
    ("sqrt", f64::sqrt),
    ("tan", f64::tan),
    ("tanh", f64::tanh),
    ("ceil", f64::ceil),
    ("floor", f64::floor),
];

type OfTwo = (&'static str, fn(f64, f64) -> f64);

const BINARY_FUNCTIONS: [OfTwo; 6] = [
    ("atan2", f64::atan2),
    ("copysign", f64::copysign),
    ("fmod", |x, y| x % y),
    ("hypot", f64::hypot),
    ("log", |x, base| x.ln() / base.ln()),
    ("pow", f64::powf),
];

/// Names of all other functions.
const OTHER_FUNCTIONS: [&str; 19] = [
    "abs", "all", "any", "bool", "dict", "float", "int", "isinf", "isnan", "len", "list", "max", "min", "range",
    "round", "sorted", "str", "sum", "trunc",
];

/// Returns a constant of Python's `math`.
pub(super) fn constant(name: &str) -> Option<Value> {
    let value = match name {
        "pi" => consts::PI,
        "tau" => consts::TAU,
        "e" => consts::E,
        "inf" => f64::INFINITY,
        "nan" => f64::NAN,
        _ => return None,
    };
    Some(Value::Float(value))
}

pub(super) fn is_function(name: &str) -> bool {
    OTHER_FUNCTIONS.contains(&name)
        || ["load_yaml", "arg", "tuple"].contains(&name)
        || UNARY_FUNCTIONS.iter().any(|(known, _)| *known == name)
        || BINARY_FUNCTIONS.iter().any(|(known, _)| *known == name)
}

pub(super) fn call(name: &str, arguments: &[Value]) -> Result<Value, Fault> {
    if !is_function(name) {
        let known: Vec<&str> = UNARY_FUNCTIONS
            .iter()
            .map(|f| f.0)
            .chain(BINARY_FUNCTIONS.iter().map(|f| f.0))
            .chain(OTHER_FUNCTIONS)
            .collect();
        return Err(Fault::with_hint(
            format!("the function {name}() is unknown"),
            format!("known functions: {}", known.join(", ")),
        ));
    }
    let numbers: Option<Vec<Number>> = arguments.iter().map(Value::number).collect();
    let result = match numbers.as_deref() {
        Some([x]) => of_one(name, *x),
        Some([x, y]) => BINARY_FUNCTIONS
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(_, f)| finite(name, f(x.as_f64(), y.as_f64()))),
        _ => None,
    };
    if let Some(result) = result {
        return result;
    }
    more(name, arguments)?.ok_or_else(|| {
        let kinds: Vec<&str> = arguments.iter().map(Value::kind).collect();
        format!("{name}() does not accept ({})", kinds.join(", ")).into()
    })
}

fn finite(name: &str, value: f64) -> Result<Value, Fault> {
    match value.is_nan() {
        true => Err(format!("{name}() is not defined for this value").into()),
        false => Ok(Value::Float(value)),
    }
}

fn of_one(name: &str, x: Number) -> Option<Result<Value, Fault>> {
    let (_, f) = UNARY_FUNCTIONS.iter().find(|(known, _)| *known == name)?;
    let value = finite(name, f(x.as_f64()));
    Some(match (name, value) {
        ("ceil" | "floor", Ok(Value::Float(x))) => to_integer(name, x),
        (_, value) => value,
    })
}

/// Converts a float without a fraction to an integer.
fn to_integer(name: &str, x: f64) -> Result<Value, Fault> {
    /// Least power of two that exceeds 64-bit integers.
    const INTEGER_OVERFLOW: f64 = 9_223_372_036_854_775_808.0;
    match x.abs() < INTEGER_OVERFLOW {
        true => Ok(Value::Int(x as i64)),
        false => Err(format!("the result of {name}() is too large").into()),
    }
}

fn more(name: &str, arguments: &[Value]) -> Result<Option<Value>, Fault> {
    let value = match (name, arguments) {
        ("abs", [Value::Int(x)]) => Value::Int(x.checked_abs().ok_or("the result of abs() is too large")?),
        ("abs", [Value::Float(x)]) => Value::Float(x.abs()),
        ("bool", [x]) => Value::Bool(x.is_true()),
        ("str", [x]) => Value::text(x.printed()),
        ("float", [Value::Text(text)]) => Value::Float(float(text).ok_or_else(|| format!("'{text}' is not a number"))?),
        ("float", [x]) if x.number().is_some() => Value::Float(x.number().map_or(0.0, Number::as_f64)),
        ("int", [Value::Text(text)]) => {
            Value::Int(text.trim().parse().map_err(|_| format!("'{text}' is not a whole number"))?)
        }
        ("int" | "trunc", [Value::Float(x)]) => to_integer(name, x.trunc())?,
        ("int" | "trunc", [Value::Int(x)]) => Value::Int(*x),
        ("int", [Value::Bool(x)]) => Value::Int(i64::from(*x)),
        ("isnan", [x]) if x.number().is_some() => Value::Bool(x.number().is_some_and(|x| x.as_f64().is_nan())),
        ("isinf", [x]) if x.number().is_some() => Value::Bool(x.number().is_some_and(|x| x.as_f64().is_infinite())),
        ("round", [Value::Int(x)]) => Value::Int(*x),
        ("round", [Value::Float(x)]) => to_integer(name, x.round_ties_even())?,
        ("round", [x, Value::Int(digits)]) if x.number().is_some() => {
            let x = x.number().map_or(0.0, Number::as_f64);
            let digits =
                usize::try_from(*digits).ok().filter(|digits| *digits <= 20).ok_or("round() takes 0 to 20 digits")?;
            Value::Float(format!("{x:.digits$}").parse().unwrap_or(x))
        }
        ("len", [Value::Text(text)]) => Value::Int(text.chars().count() as i64),
        ("len", [Value::List(items)]) => Value::Int(items.len() as i64),
        ("len", [Value::Dict(items)]) => Value::Int(items.len() as i64),
        ("list" | "tuple", [of]) => Value::list(items(of).ok_or_else(|| format!("a {} has no items", of.kind()))?),
        ("range", [Value::Int(to)]) => range(0, *to)?,
        ("range", [Value::Int(from), Value::Int(to)]) => range(*from, *to)?,
        ("any" | "all", [Value::List(items)]) => Value::Bool(match name {
            "any" => items.iter().any(Value::is_true),
            _ => items.iter().all(Value::is_true),
        }),
        ("sum", [Value::List(items)]) => {
            let numbers: Option<Vec<Number>> = items.iter().map(Value::number).collect();
            let numbers = numbers.ok_or("sum() needs numbers")?;
            let total = numbers.iter().try_fold(0_i64, |sum, x| match x {
                Number::Int(x) => sum.checked_add(*x),
                Number::Float(_) => None,
            });
            total.map_or_else(|| Value::Float(numbers.iter().map(|x| x.as_f64()).sum()), Value::Int)
        }
        ("max" | "min", [Value::List(items)]) => extreme(name, items)?,
        ("max" | "min", [_, _, ..]) => extreme(name, arguments)?,
        ("sorted", [Value::List(items)]) => {
            let mut items = items.to_vec();
            if items.windows(2).any(|pair| pair[0].compare(&pair[1]).is_none()) {
                return Err("sorted(): the items cannot be compared with each other".into());
            }
            items.sort_by(|a, b| a.compare(b).unwrap_or(Ordering::Equal));
            Value::list(items)
        }
        _ => return Ok(None),
    };
    Ok(Some(value))
}

fn range(from: i64, to: i64) -> Result<Value, Fault> {
    if to.saturating_sub(from) > MAX_LIST_ITEMS as i64 {
        return Err(format!("the list is too long: it has more than {MAX_LIST_ITEMS} items").into());
    }
    Ok(Value::list((from..to).map(Value::Int).collect()))
}

fn items(of: &Value) -> Option<Vec<Value>> {
    match of {
        Value::List(items) => Some(items.to_vec()),
        Value::Dict(items) => Some(items.iter().map(|(key, _)| key.clone()).collect()),
        Value::Text(text) => Some(text.chars().map(|c| Value::text(c.to_string())).collect()),
        _ => None,
    }
}

fn extreme(name: &str, items: &[Value]) -> Result<Value, Fault> {
    let wanted = if name == "max" { Ordering::Greater } else { Ordering::Less };
    let (first, others) = items.split_first().ok_or_else(|| format!("{name}() needs an item"))?;
    let mut best = first;
    for item in others {
        let order =
            item.compare(best).ok_or_else(|| format!("{name}(): the items cannot be compared with each other"))?;
        if order == wanted {
            best = item;
        }
    }
    Ok(best.clone())
}

/// Calls a method of a text or a dict.
pub(super) fn method(of: &Value, name: &str, arguments: &[Value]) -> Result<Value, Fault> {
    let text_list = |parts: Vec<&str>| Value::list(parts.into_iter().map(Value::text).collect());
    let unknown = || Fault::from(format!("a {} has no method {name}()", of.kind()));
    let value = match (of, name, arguments) {
        (Value::Text(text), "lower", []) => Value::text(text.to_lowercase()),
        (Value::Text(text), "upper", []) => Value::text(text.to_uppercase()),
        (Value::Text(text), "strip", []) => Value::text(text.trim()),
        (Value::Text(text), "split", []) => text_list(text.split_whitespace().collect()),
        (Value::Text(text), "split", [Value::Text(by)]) if !by.is_empty() => text_list(text.split(&**by).collect()),
        (Value::Text(text), "startswith", [Value::Text(part)]) => Value::Bool(text.starts_with(&**part)),
        (Value::Text(text), "endswith", [Value::Text(part)]) => Value::Bool(text.ends_with(&**part)),
        (Value::Text(text), "replace", [Value::Text(from), Value::Text(to)])
            if !from.is_empty() && text.len().saturating_mul(to.len().max(1)) <= MAX_LIST_ITEMS * 10 =>
        {
            Value::text(text.replace(&**from, to))
        }
        (Value::Dict(items), "keys", []) => Value::list(items.iter().map(|(key, _)| key.clone()).collect()),
        (Value::Dict(items), "values", []) => Value::list(items.iter().map(|(_, value)| value.clone()).collect()),
        (Value::Dict(_), "get", [key]) => of.item(key).cloned().unwrap_or(Value::None),
        (Value::Dict(_), "get", [key, default]) => of.item(key).unwrap_or(default).clone(),
        _ => return Err(unknown()),
    };
    Ok(value)
}
