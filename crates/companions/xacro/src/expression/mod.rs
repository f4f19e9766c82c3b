//! The expressions in `${...}`: the part of Python that robot descriptions use.
//!
//! ```text
//! text -> tokens -> Expression -> Value
//! ```

mod evaluate;
mod functions;
mod parser;
mod tokens;

pub(crate) use evaluate::insert;

use crate::error::Fault;
use crate::limits::Budget;
use crate::value::Value;

#[derive(Debug)]
pub(crate) enum Expression {
    Constant(Value),
    Name(String),
    List(Vec<Expression>),
    Dict(Vec<(Expression, Expression)>),
    /// An operator before its operand: `not`, `-` or `+`.
    Unary(&'static str, Box<Expression>),
    Binary(&'static str, Box<Expression>, Box<Expression>),
    /// A chain of comparisons, such as `a < b < c`.
    Comparison(Box<Expression>, Vec<(&'static str, Expression)>),
    And(Box<Expression>, Box<Expression>),
    Or(Box<Expression>, Box<Expression>),
    /// A choice `a if b else c`, stored in the order `b`, `a`, `c`.
    Choice(Box<[Expression; 3]>),
    Index(Box<Expression>, Box<Expression>),
    /// A slice `a[b:c]`.
    Slice(Box<Expression>, [Option<Box<Expression>>; 2]),
    Member(Box<Expression>, String),
    Call(Box<Expression>, Vec<Expression>, Vec<(String, Expression)>),
}

/// The names that an expression can use.
pub(crate) trait Names {
    /// Returns the value of a property, or `None` if it does not exist.
    fn property(&mut self, name: &str) -> Result<Option<Value>, Fault>;
    /// Returns the value of an argument (`xacro.arg`).
    fn argument(&mut self, name: &str) -> Result<Value, Fault>;
    /// Returns the content of a YAML file (`xacro.load_yaml`).
    fn yaml(&mut self, name: &str) -> Result<Value, Fault>;
    /// Returns the budget that counts computations.
    fn budget(&mut self) -> &mut Budget;
}

/// Evaluates an expression.
///
/// # Errors
/// If the syntax is wrong or not supported, a name is not defined, types do not match, or a result is too large.
pub(crate) fn evaluate(text: &str, names: &mut dyn Names) -> Result<Value, Fault> {
    let tokens = tokens::tokens(text)?;
    let expression = parser::parse(&tokens)?;
    evaluate::Evaluator { names }.value(&expression)
}
