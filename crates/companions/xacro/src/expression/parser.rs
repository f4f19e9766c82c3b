//! Parses expressions, with Python's precedence of operators.

use super::Expression;
use super::tokens::Token;
use crate::error::Fault;
use crate::limits::MAX_EXPRESSION_DEPTH;
use crate::value::Value;

/// Largest number of words in an expression.
const MAX_WORDS: usize = 1_000;

/// Binary operators of each precedence, the weakest first.
const PRECEDENCE_LEVELS: [&[&str]; 2] = [&["+", "-"], &["*", "/", "//", "%"]];

const COMPARISONS: [&str; 6] = ["==", "!=", "<=", ">=", "<", ">"];

/// Words that start Python expressions which are not supported.
const UNKNOWN_WORDS: [&str; 4] = ["lambda", "for", "is", "yield"];

pub(super) fn parse(tokens: &[Token]) -> Result<Expression, Fault> {
    if tokens.len() > MAX_WORDS {
        return Err(format!("the expression has more than {MAX_WORDS} words").into());
    }
    let mut parser = Parser { tokens, at: 0, depth: 0 };
    let expression = parser.choice()?;
    match parser.peek() {
        None => Ok(expression),
        Some(token) => Err(parser.unexpected(token)),
    }
}

struct Parser<'t> {
    tokens: &'t [Token],
    at: usize,
    depth: usize,
}

fn boxed(expression: Expression) -> Box<Expression> {
    Box::new(expression)
}

impl<'t> Parser<'t> {
    fn peek(&self) -> Option<&'t Token> {
        self.tokens.get(self.at)
    }

    fn takes_sign(&mut self, sign: &str) -> bool {
        let is_next = matches!(self.peek(), Some(Token::Sign(next)) if *next == sign);
        self.at += usize::from(is_next);
        is_next
    }

    fn takes_word(&mut self, word: &str) -> bool {
        let is_next = matches!(self.peek(), Some(Token::Name(next)) if next == word);
        self.at += usize::from(is_next);
        is_next
    }

    fn takes_one_of(&mut self, signs: &[&'static str]) -> Option<&'static str> {
        let Some(Token::Sign(next)) = self.peek() else { return None };
        let sign = signs.iter().copied().find(|sign| sign == next)?;
        self.at += 1;
        Some(sign)
    }

    fn expects(&mut self, sign: &str) -> Result<(), Fault> {
        match self.takes_sign(sign) {
            true => Ok(()),
            false => Err(self.peek().map_or_else(
                || format!("\"{sign}\" is missing at the end of the expression").into(),
                |t| self.unexpected(t),
            )),
        }
    }

    fn unexpected(&self, token: &Token) -> Fault {
        match token {
            Token::Name(word) if UNKNOWN_WORDS.contains(&word.as_str()) => Fault::with_hint(
                format!("\"{word}\" is not supported: cplan does not read comprehensions, lambdas and \"is\""),
                "write the expression without it, or expand the file with ROS's own xacro",
            ),
            Token::Name(word) => format!("\"{word}\" is not expected there").into(),
            Token::Sign(sign) => format!("\"{sign}\" is not expected there").into(),
            Token::Int(x) => format!("{x} is not expected there").into(),
            Token::Float(x) => format!("{x} is not expected there").into(),
            Token::Text(text) => format!("'{text}' is not expected there").into(),
        }
    }

    /// Parses an expression one level deeper, beginning with the weakest operator.
    fn choice(&mut self) -> Result<Expression, Fault> {
        self.depth += 1;
        if self.depth > MAX_EXPRESSION_DEPTH {
            return Err(format!("the expression is nested more than {MAX_EXPRESSION_DEPTH} deep").into());
        }
        let mut value = self.or()?;
        if self.takes_word("if") {
            let condition = self.or()?;
            if !self.takes_word("else") {
                return Err("an \"if\" in an expression needs an \"else\"".into());
            }
            let otherwise = self.choice()?;
            value = Expression::Choice(Box::new([condition, value, otherwise]));
        }
        self.depth -= 1;
        Ok(value)
    }

    fn or(&mut self) -> Result<Expression, Fault> {
        let mut value = self.and()?;
        while self.takes_word("or") {
            value = Expression::Or(boxed(value), boxed(self.and()?));
        }
        Ok(value)
    }

    fn and(&mut self) -> Result<Expression, Fault> {
        let mut value = self.not()?;
        while self.takes_word("and") {
            value = Expression::And(boxed(value), boxed(self.not()?));
        }
        Ok(value)
    }

    fn not(&mut self) -> Result<Expression, Fault> {
        let mut count = 0;
        while self.takes_word("not") {
            count += 1;
        }
        let mut value = self.comparison()?;
        // Two `not` cancel each other, but the result is a truth value.
        for _ in 0..if count == 0 { 0 } else { 2 - count % 2 } {
            value = Expression::Unary("not", boxed(value));
        }
        Ok(value)
    }

    fn comparison(&mut self) -> Result<Expression, Fault> {
        let first = self.sum(0)?;
        let mut others = Vec::new();
        loop {
            let operator = match self.takes_one_of(&COMPARISONS) {
                Some(sign) => sign,
                None if self.takes_word("in") => "in",
                None if matches!(self.tokens.get(self.at + 1), Some(Token::Name(word)) if word == "in")
                    && self.takes_word("not") =>
                {
                    self.at += 1;
                    "not in"
                }
                None => break,
            };
            others.push((operator, self.sum(0)?));
        }
        Ok(if others.is_empty() { first } else { Expression::Comparison(boxed(first), others) })
    }

    /// Parses sums and products: binary operators of this level of precedence, or a stronger one.
    fn sum(&mut self, level: usize) -> Result<Expression, Fault> {
        let Some(operators) = PRECEDENCE_LEVELS.get(level) else { return self.signed() };
        let mut value = self.sum(level + 1)?;
        while let Some(operator) = self.takes_one_of(operators) {
            value = Expression::Binary(operator, boxed(value), boxed(self.sum(level + 1)?));
        }
        Ok(value)
    }

    fn signed(&mut self) -> Result<Expression, Fault> {
        let mut signs = Vec::new();
        while let Some(sign) = self.takes_one_of(&["-", "+"]) {
            signs.push(sign);
        }
        let mut value = self.power()?;
        let is_negative = signs.iter().filter(|sign| **sign == "-").count() % 2 == 1;
        if !signs.is_empty() {
            value = Expression::Unary(if is_negative { "-" } else { "+" }, boxed(value));
        }
        Ok(value)
    }

    fn power(&mut self) -> Result<Expression, Fault> {
        let base = self.postfix()?;
        if !self.takes_sign("**") {
            return Ok(base);
        }
        self.depth += 1;
        if self.depth > MAX_EXPRESSION_DEPTH {
            return Err(format!("the expression is nested more than {MAX_EXPRESSION_DEPTH} deep").into());
        }
        let exponent = self.signed()?;
        self.depth -= 1;
        Ok(Expression::Binary("**", boxed(base), boxed(exponent)))
    }

    fn postfix(&mut self) -> Result<Expression, Fault> {
        let mut value = self.atom()?;
        for count in 0.. {
            if count > MAX_EXPRESSION_DEPTH {
                return Err(format!("the expression is nested more than {MAX_EXPRESSION_DEPTH} deep").into());
            }
            if self.takes_sign(".") {
                let Some(Token::Name(name)) = self.peek() else { return Err("a name is missing after \".\"".into()) };
                self.at += 1;
                value = Expression::Member(boxed(value), name.clone());
            } else if self.takes_sign("[") {
                value = self.index(value)?;
            } else if self.takes_sign("(") {
                let (values, named) = self.arguments()?;
                value = Expression::Call(boxed(value), values, named);
            } else {
                break;
            }
        }
        Ok(value)
    }

    /// Parses the index after `[`.
    fn index(&mut self, of: Expression) -> Result<Expression, Fault> {
        let is_open = |parser: &Self| matches!(parser.peek(), Some(Token::Sign(":" | "]")));
        let from = if is_open(self) { None } else { Some(boxed(self.choice()?)) };
        if self.takes_sign(":") {
            let to = if is_open(self) { None } else { Some(boxed(self.choice()?)) };
            self.expects("]")?;
            return Ok(Expression::Slice(boxed(of), [from, to]));
        }
        self.expects("]")?;
        Ok(Expression::Index(boxed(of), from.ok_or("an index is missing between [ and ]")?))
    }

    /// Parses the arguments after `(` in a call.
    #[allow(clippy::type_complexity)]
    fn arguments(&mut self) -> Result<(Vec<Expression>, Vec<(String, Expression)>), Fault> {
        let (mut values, mut named) = (Vec::new(), Vec::new());
        while !self.takes_sign(")") {
            match (self.peek(), self.tokens.get(self.at + 1)) {
                (Some(Token::Name(name)), Some(Token::Sign("="))) => {
                    self.at += 2;
                    named.push((name.clone(), self.choice()?));
                }
                _ => values.push(self.choice()?),
            }
            if !self.takes_sign(",") {
                self.expects(")")?;
                break;
            }
        }
        Ok((values, named))
    }

    fn atom(&mut self) -> Result<Expression, Fault> {
        let token = self.peek().ok_or("the expression is incomplete")?;
        self.at += 1;
        Ok(match token {
            Token::Int(x) => Expression::Constant(Value::Int(*x)),
            Token::Float(x) => Expression::Constant(Value::Float(*x)),
            Token::Text(text) => {
                // Adjacent texts are joined.
                let mut text = text.clone();
                while let Some(Token::Text(more)) = self.peek() {
                    text += more;
                    self.at += 1;
                }
                Expression::Constant(Value::text(text))
            }
            Token::Name(name) if UNKNOWN_WORDS.contains(&name.as_str()) => return Err(self.unexpected(token)),
            Token::Name(name) => match name.as_str() {
                "True" => Expression::Constant(Value::Bool(true)),
                "False" => Expression::Constant(Value::Bool(false)),
                "None" => Expression::Constant(Value::None),
                _ => Expression::Name(name.clone()),
            },
            Token::Sign("(") => {
                let (mut items, is_tuple) = self.items(")")?;
                match items.pop() {
                    Some(only) if items.is_empty() && !is_tuple => only,
                    last => {
                        items.extend(last);
                        Expression::List(items)
                    }
                }
            }
            Token::Sign("[") => Expression::List(self.items("]")?.0),
            Token::Sign("{") => self.dict()?,
            token => return Err(self.unexpected(token)),
        })
    }

    /// Parses items up to a closing sign. The second result is true for a tuple: there is a comma, or no item.
    fn items(&mut self, close: &str) -> Result<(Vec<Expression>, bool), Fault> {
        let (mut items, mut has_comma) = (Vec::new(), false);
        while !self.takes_sign(close) {
            items.push(self.choice()?);
            if !self.takes_sign(",") {
                self.expects(close)?;
                break;
            }
            has_comma = true;
        }
        let is_tuple = has_comma || items.is_empty();
        Ok((items, is_tuple))
    }

    fn dict(&mut self) -> Result<Expression, Fault> {
        let mut items = Vec::new();
        while !self.takes_sign("}") {
            let key = self.choice()?;
            self.expects(":")?;
            items.push((key, self.choice()?));
            if !self.takes_sign(",") {
                self.expects("}")?;
                break;
            }
        }
        Ok(Expression::Dict(items))
    }
}
