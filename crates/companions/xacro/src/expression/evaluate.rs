//! Evaluates expressions.

use super::{Expression, Names, functions};
use crate::error::Fault;
use crate::limits::MAX_LIST_ITEMS;
use crate::value::{Number, Value};
use std::cmp::Ordering;

pub(super) struct Evaluator<'n> {
    pub names: &'n mut dyn Names,
}

impl Evaluator<'_> {
    /// Evaluates an expression one level deeper.
    pub fn value(&mut self, expression: &Expression) -> Result<Value, Fault> {
        self.names.budget().enter()?;
        let value = self.inner(expression)?;
        self.names.budget().leave();
        self.spend(&value)?;
        Ok(value)
    }

    /// Adds the size of a computed value to the budget.
    fn spend(&mut self, value: &Value) -> Result<(), Fault> {
        let size = match value {
            Value::Text(text) => text.len(),
            Value::List(items) if items.len() > MAX_LIST_ITEMS => {
                return Err(format!("the list is too long: it has more than {MAX_LIST_ITEMS} items").into());
            }
            _ => 0,
        };
        self.names.budget().spend(size)
    }

    fn inner(&mut self, expression: &Expression) -> Result<Value, Fault> {
        match expression {
            Expression::Constant(value) => Ok(value.clone()),
            Expression::Name(name) => self.name(name),
            Expression::List(items) => self.values(items).map(Value::list),
            Expression::Dict(items) => {
                let mut dict = Vec::new();
                for (key, value) in items {
                    insert(&mut dict, self.value(key)?, self.value(value)?);
                }
                Ok(Value::Dict(dict.into()))
            }
            Expression::Unary(sign, of) => {
                let value = self.value(of)?;
                unary(sign, &value)
            }
            Expression::Binary(..) => self.chain(expression),
            Expression::Comparison(first, others) => self.comparison(first, others),
            Expression::And(..) | Expression::Or(..) => self.logic(expression),
            Expression::Choice(parts) => {
                let [condition, then, otherwise] = &**parts;
                let is_true = self.value(condition)?.is_true();
                self.value(if is_true { then } else { otherwise })
            }
            Expression::Index(of, index) => {
                let (of, index) = (self.value(of)?, self.value(index)?);
                item(&of, &index)
            }
            Expression::Slice(of, [from, to]) => {
                let of = self.value(of)?;
                let mut bound = |bound: &Option<Box<Expression>>| bound.as_deref().map(|b| self.value(b)).transpose();
                let bounds = [bound(from)?, bound(to)?];
                slice(&of, bounds)
            }
            Expression::Member(of, name) => self.member(of, name),
            Expression::Call(of, values, named) => self.call(of, values, named),
        }
    }

    fn values(&mut self, items: &[Expression]) -> Result<Vec<Value>, Fault> {
        items.iter().map(|item| self.value(item)).collect()
    }

    /// Evaluates a chain of operators of the same precedence from left to right, without recursion.
    fn chain(&mut self, expression: &Expression) -> Result<Value, Fault> {
        let (mut others, mut first) = (Vec::new(), expression);
        while let Expression::Binary(sign, left, right) = first {
            others.push((*sign, &**right));
            first = left;
        }
        let mut value = self.value(first)?;
        for (sign, right) in others.into_iter().rev() {
            let right = self.value(right)?;
            value = binary(sign, &value, &right)?;
            self.spend(&value)?;
        }
        Ok(value)
    }

    fn logic(&mut self, expression: &Expression) -> Result<Value, Fault> {
        let (mut others, mut first) = (Vec::new(), expression);
        while let Expression::And(left, right) | Expression::Or(left, right) = first {
            others.push((matches!(first, Expression::Or(..)), &**right));
            first = left;
        }
        let mut value = self.value(first)?;
        for (is_or, right) in others.into_iter().rev() {
            if value.is_true() != is_or {
                value = self.value(right)?;
            }
        }
        Ok(value)
    }

    fn comparison(&mut self, first: &Expression, others: &[(&'static str, Expression)]) -> Result<Value, Fault> {
        let mut left = self.value(first)?;
        for (sign, right) in others {
            let right = self.value(right)?;
            if !compare(&left, sign, &right)? {
                return Ok(Value::Bool(false));
            }
            left = right;
        }
        Ok(Value::Bool(true))
    }

    fn name(&mut self, name: &str) -> Result<Value, Fault> {
        if let Some(value) = self.names.property(name)? {
            return Ok(value);
        }
        functions::constant(name).ok_or_else(|| {
            let hint = match functions::is_function(name) {
                true => "this is the name of a function: write ( ) after it".to_owned(),
                false => "define the property before this use: <xacro:property name=\"...\" value=\"...\"/>, here or in an included file".into(),
            };
            Fault::with_hint(format!("there is no property \"{name}\""), hint)
        })
    }

    /// Evaluates `a.b`: a member of a namespace, a dict, or Python's `math`.
    fn member(&mut self, of: &Expression, name: &str) -> Result<Value, Fault> {
        if let Some(path) = path(of) {
            if let Some(value) = self.names.property(&format!("{path}.{name}"))? {
                return Ok(value);
            }
            if path == "math" {
                return self.name(name);
            }
        }
        let of = self.value(of)?;
        of.item(&Value::text(name)).cloned().ok_or_else(|| format!("a {} has no \"{name}\"", of.kind()).into())
    }

    fn call(&mut self, of: &Expression, values: &[Expression], named: &[(String, Expression)]) -> Result<Value, Fault> {
        let arguments = self.values(values)?;
        let named = named.iter().map(|(name, value)| Ok((name.clone(), self.value(value)?)));
        let named = named.collect::<Result<Vec<_>, Fault>>()?;
        let name = match of {
            Expression::Name(name) => name.as_str(),
            Expression::Member(module, name)
                if matches!(path(module).as_deref(), Some("math" | "xacro" | "python")) =>
            {
                name
            }
            Expression::Member(of, name) if named.is_empty() => {
                let of = self.value(of)?;
                return functions::method(&of, name, &arguments);
            }
            _ => return Err("only functions can be called".into()),
        };
        match (name, &arguments[..], &named[..]) {
            ("load_yaml", [Value::Text(path)], []) => self.names.yaml(path),
            ("arg", [Value::Text(name)], []) => self.names.argument(name).map(Value::literal),
            ("dict", [], _) => Ok(Value::Dict(
                named.into_iter().map(|(name, value)| (Value::text(name), value)).collect::<Vec<_>>().into(),
            )),
            (_, _, [(wrong, _), ..]) => Err(format!("{name}() takes no argument called \"{wrong}\"").into()),
            _ => functions::call(name, &arguments),
        }
    }
}

/// Returns a dotted name as written.
fn path(expression: &Expression) -> Option<String> {
    match expression {
        Expression::Name(name) => Some(name.clone()),
        Expression::Member(of, name) => Some(format!("{}.{name}", path(of)?)),
        _ => None,
    }
}

/// Sets the value of a key. An earlier value is replaced in its position.
pub(crate) fn insert(dict: &mut Vec<(Value, Value)>, key: Value, value: Value) {
    match dict.iter_mut().find(|(known, _)| known.equals(&key)) {
        Some(known) => known.1 = value,
        None => dict.push((key, value)),
    }
}

fn unary(sign: &str, value: &Value) -> Result<Value, Fault> {
    if sign == "not" {
        return Ok(Value::Bool(!value.is_true()));
    }
    match (sign, value.number()) {
        ("-", Some(Number::Int(x))) => x.checked_neg().map(Value::Int).ok_or_else(|| too_large(sign)),
        ("-", Some(Number::Float(x))) => Ok(Value::Float(-x)),
        (_, Some(number)) => Ok(number.into()),
        (_, None) => Err(format!("\"{sign}\" needs a number; '{}' is a {}", short(value), value.kind()).into()),
    }
}

fn too_large(sign: &str) -> Fault {
    format!("the result of \"{sign}\" is too large").into()
}

/// Formats a value for messages.
fn short(value: &Value) -> String {
    value.printed().chars().take(40).collect()
}

fn binary(sign: &str, a: &Value, b: &Value) -> Result<Value, Fault> {
    if let (Some(a), Some(b)) = (a.number(), b.number()) {
        return arithmetic(sign, a, b);
    }
    let repeated = |length: usize, times: i64| {
        let times = usize::try_from(times).unwrap_or(0);
        (length.saturating_mul(times) <= MAX_LIST_ITEMS).then_some(times).ok_or_else(|| too_large(sign))
    };
    match (sign, a, b) {
        ("+", Value::Text(a), Value::Text(b)) => Ok(Value::text(format!("{a}{b}"))),
        ("+", Value::List(a), Value::List(b)) => Ok(Value::list(a.iter().chain(&**b).cloned().collect())),
        ("*", Value::Text(text), Value::Int(n)) | ("*", Value::Int(n), Value::Text(text)) => {
            Ok(Value::text(text.repeat(repeated(text.len(), *n)?)))
        }
        ("*", Value::List(items), Value::Int(n)) | ("*", Value::Int(n), Value::List(items)) => {
            let times = repeated(items.len(), *n)?;
            Ok(Value::list((0..times).flat_map(|_| items.iter().cloned()).collect()))
        }
        _ => {
            let message =
                format!("\"{sign}\" cannot combine '{}' ({}) and '{}' ({})", short(a), a.kind(), short(b), b.kind());
            Err(Fault::with_hint(message, "use two numbers, or two texts by str(...)"))
        }
    }
}

fn arithmetic(sign: &str, a: Number, b: Number) -> Result<Value, Fault> {
    let (x, y) = (a.as_f64(), b.as_f64());
    if y == 0.0 && matches!(sign, "/" | "//" | "%") {
        return Err(format!("\"{sign}\" divides by zero").into());
    }
    if let (Number::Int(a), Number::Int(b)) = (a, b) {
        let whole = match sign {
            "+" => a.checked_add(b),
            "-" => a.checked_sub(b),
            "*" => a.checked_mul(b),
            "//" => a.checked_div_euclid(b).map(|q| if b < 0 && a.rem_euclid(b) != 0 { q - 1 } else { q }),
            "%" => a.checked_rem(b).map(|r| if r != 0 && (r < 0) != (b < 0) { r + b } else { r }),
            "**" if b >= 0 => u32::try_from(b).ok().and_then(|b| a.checked_pow(b)),
            _ => None,
        };
        if let Some(whole) = whole {
            return Ok(Value::Int(whole));
        }
        if sign != "/" && !(sign == "**" && b < 0) {
            return Err(too_large(sign));
        }
    }
    let value = match sign {
        "+" => x + y,
        "-" => x - y,
        "*" => x * y,
        "/" => x / y,
        "//" => (x / y).floor(),
        "%" => x - y * (x / y).floor(),
        _ => x.powf(y),
    };
    match value.is_nan() && !x.is_nan() && !y.is_nan() {
        true => Err(format!("{x} {sign} {y} is not a real number").into()),
        false => Ok(Value::Float(value)),
    }
}

fn compare(a: &Value, sign: &str, b: &Value) -> Result<bool, Fault> {
    let is_in = || match (a, b) {
        (Value::Text(a), Value::Text(b)) => Ok(b.contains(&**a)),
        (_, Value::List(items)) => Ok(items.iter().any(|item| item.equals(a))),
        (_, Value::Dict(items)) => Ok(items.iter().any(|(key, _)| key.equals(a))),
        _ => Err(Fault::from(format!("\"in\" does not apply to a {}", b.kind()))),
    };
    match sign {
        "==" => return Ok(a.equals(b)),
        "!=" => return Ok(!a.equals(b)),
        "in" => return is_in(),
        "not in" => return is_in().map(|is| !is),
        _ => {}
    }
    let is_number = |value: &Value| value.number().is_some();
    let order = a.compare(b);
    if order.is_none() && !(is_number(a) && is_number(b)) {
        return Err(format!("\"{sign}\" cannot compare a {} with a {}", a.kind(), b.kind()).into());
    }
    Ok(match sign {
        "<" => order == Some(Ordering::Less),
        ">" => order == Some(Ordering::Greater),
        "<=" => matches!(order, Some(Ordering::Less | Ordering::Equal)),
        _ => matches!(order, Some(Ordering::Greater | Ordering::Equal)),
    })
}

/// Converts an index to a position in a sequence. Negative indices count from the end.
fn position(index: i64, length: usize) -> Option<usize> {
    let length = i64::try_from(length).ok()?;
    let at = if index < 0 { index.checked_add(length)? } else { index };
    (0..length).contains(&at).then(|| usize::try_from(at).ok()).flatten()
}

fn item(of: &Value, index: &Value) -> Result<Value, Fault> {
    let beyond =
        |length: usize| Fault::from(format!("index {} is out of range: the sequence has {length} items", short(index)));
    match (of, index) {
        (Value::Dict(items), key) => of.item(key).cloned().ok_or_else(|| {
            let keys: Vec<String> = items.iter().take(12).map(|(key, _)| key.printed()).collect();
            Fault::with_hint(format!("there is no key '{}'", short(key)), format!("its keys are {}", keys.join(", ")))
        }),
        (Value::List(items), Value::Int(at)) => {
            position(*at, items.len()).map(|at| items[at].clone()).ok_or_else(|| beyond(items.len()))
        }
        (Value::Text(text), Value::Int(at)) => {
            let letters: Vec<char> = text.chars().collect();
            position(*at, letters.len())
                .map(|at| Value::text(letters[at].to_string()))
                .ok_or_else(|| beyond(letters.len()))
        }
        _ => Err(format!("a {} has no item of a {}", of.kind(), index.kind()).into()),
    }
}

fn slice(of: &Value, bounds: [Option<Value>; 2]) -> Result<Value, Fault> {
    let range = |length: usize| -> Result<(usize, usize), Fault> {
        let bound = |bound: &Option<Value>, open: usize| match bound {
            None => Ok(open),
            Some(Value::Int(at)) => {
                let length = i64::try_from(length).unwrap_or(i64::MAX);
                let at = if *at < 0 { at.saturating_add(length) } else { *at };
                Ok(usize::try_from(at.clamp(0, length)).unwrap_or(open))
            }
            Some(other) => Err(Fault::from(format!("a {} is not a position", other.kind()))),
        };
        let (from, to) = (bound(&bounds[0], 0)?, bound(&bounds[1], length)?);
        Ok((from, to.max(from)))
    };
    match of {
        Value::List(items) => range(items.len()).map(|(from, to)| Value::list(items[from..to].to_vec())),
        Value::Text(text) => {
            let letters: Vec<char> = text.chars().collect();
            range(letters.len()).map(|(from, to)| Value::text(letters[from..to].iter().collect::<String>()))
        }
        _ => Err(format!("a {} has no parts", of.kind()).into()),
    }
}
