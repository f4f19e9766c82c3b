//! Evaluates texts that contain `${...}` and `$(...)`.

use crate::document::Place;
use crate::error::Fault;
use crate::expander::Expander;
use crate::expression::{self, Names};
use crate::limits::Budget;
use crate::scope::Slot;
use crate::value::Value;
use crate::{packages, path_beside, yaml};
use std::path::Path;

/// The scope and the file in which a text is evaluated.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Context {
    /// Index of the scope whose names the text can use.
    pub scope: usize,
    /// Index of the file that contains the text.
    pub file: usize,
}

enum Part<'t> {
    Text(&'t str),
    /// The expression in `${...}`.
    Expression(&'t str),
    /// The substitution in `$(...)`.
    Extension(&'t str),
}

/// Splits a text into parts. `$${` and `$$(` are escapes for `${` and `$(`.
fn parts(text: &str) -> Result<Vec<Part<'_>>, Fault> {
    let mut parts = Vec::new();
    let mut rest = text;
    while !rest.is_empty() {
        let at = rest.find('$').unwrap_or(rest.len());
        if at > 0 {
            parts.push(Part::Text(&rest[..at]));
            rest = &rest[at..];
            continue;
        }
        let dollars = rest.bytes().take_while(|byte| *byte == b'$').count();
        let opens = rest[dollars..].starts_with(['{', '(']);
        if dollars > 1 || !opens {
            let end = if opens { dollars + 1 } else { dollars };
            // The first sign is the escape: omit it.
            parts.push(Part::Text(&rest[usize::from(opens)..end]));
            rest = &rest[end..];
            continue;
        }
        let (close, name) = if rest.starts_with("${") { ('}', "${") } else { (')', "$(") };
        let end = rest.find(close).ok_or_else(|| format!("\"{name}\" has no closing {close}"))?;
        let inside = &rest[2..end];
        parts.push(if close == '}' { Part::Expression(inside) } else { Part::Extension(inside) });
        rest = &rest[end + 1..];
    }
    Ok(parts)
}

impl Expander<'_> {
    /// Evaluates a text. If the text is a single expression, the value has the type of that expression. Otherwise it is
    /// a string.
    pub fn text(&mut self, text: &str, context: Context) -> Result<Value, Fault> {
        if !text.contains('$') {
            self.budget.spend(text.len())?;
            return Ok(Value::text(text));
        }
        self.budget.enter()?;
        let mut values = Vec::new();
        for part in parts(text)? {
            values.push(match part {
                Part::Text(text) => Value::text(text),
                Part::Expression(inside) => {
                    let inside = self.text(inside, context)?.printed();
                    expression::evaluate(&inside, &mut ContextNames { expander: self, context })
                        .map_err(|fault| with_expression(&inside, fault))?
                }
                Part::Extension(inside) => {
                    let inside = self.text(inside, context)?.printed();
                    self.extension(&inside, context)?
                }
            });
        }
        self.budget.leave();
        if values.len() == 1 {
            return Ok(values.remove(0));
        }
        let whole: String = values.iter().map(Value::printed).collect();
        self.budget.spend(whole.len())?;
        Ok(Value::text(whole))
    }

    fn extension(&mut self, text: &str, context: Context) -> Result<Value, Fault> {
        let (command, rest) = text.trim().split_once(char::is_whitespace).unwrap_or((text.trim(), ""));
        let rest = rest.trim();
        match (command, rest) {
            ("arg", name) if !name.is_empty() => self.argument(name),
            ("find", name) if !name.is_empty() => self.package(name, context.file).map(Value::text),
            ("env", name) => std::env::var(name).map(Value::text).map_err(|_| {
                let message = format!("$(env {name}): the environment variable {name} is not set");
                Fault::with_hint(message, format!("write {name}=... in front of the command"))
            }),
            ("optenv", rest) => {
                let (name, default) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
                Ok(Value::text(std::env::var(name).unwrap_or_else(|_| default.trim().to_owned())))
            }
            ("dirname", "") => {
                let folder = self.files[context.file].path.with_file_name("");
                let folder = folder.canonicalize().unwrap_or(folder);
                Ok(Value::text(folder.to_string_lossy().trim_end_matches('/').to_owned()))
            }
            ("eval", text) => expression::evaluate(text, &mut ContextNames { expander: self, context })
                .map_err(|fault| with_expression(text, fault)),
            _ => Err(Fault::with_hint(
                format!("\"$({text})\" is not known"),
                "known extensions: $(arg NAME), $(find PACKAGE), $(env NAME), $(optenv NAME DEFAULT), $(eval EXPRESSION), $(dirname)",
            )),
        }
    }

    fn argument(&mut self, name: &str) -> Result<Value, Fault> {
        self.asked_arguments.insert(name.to_owned());
        let value = self.arguments.get(name).or_else(|| self.given.get(name));
        value.map(|value| Value::text(value.as_str())).ok_or_else(|| {
            Fault::with_hint(
                format!("the argument \"{name}\" has no value"),
                format!("give the argument a value: --xacro-arg {name}=VALUE"),
            )
        })
    }

    /// Returns the folder of a package.
    pub fn package(&mut self, name: &str, file: usize) -> Result<String, Fault> {
        if let Some(known) = self.packages.get(&(name.to_owned(), file)) {
            return Ok(known.clone());
        }
        let found = packages(name, &self.files[file].path).next().ok_or_else(|| {
            let message = format!("package \"{name}\" was not found: no package.xml near this file has this name");
            Fault::with_hint(
                message,
                "put the package's folder beside that of this file, or add its parent folder to ROS_PACKAGE_PATH",
            )
        })?;
        let found = found.to_string_lossy().into_owned();
        self.packages.insert((name.to_owned(), file), found.clone());
        Ok(found)
    }

    /// Evaluates a property in the scope of its definition.
    fn property(&mut self, scope: usize, name: &str) -> Result<Option<Value>, Fault> {
        let Some((scope, name)) = self.scopes.find(scope, name) else { return Ok(None) };
        match self.scopes.slot(scope, name).cloned() {
            None => Ok(None),
            Some(Slot::Value(value)) => Ok(Some(value)),
            Some(Slot::Evaluating) => {
                let message = format!("the property \"{name}\" depends on itself");
                Err(Fault::with_hint(message, "give one of the two another name, or write lazy_eval=\"false\""))
            }
            Some(Slot::Unevaluated(text, place)) => {
                self.scopes.set(scope, name, Slot::Evaluating);
                let value = self.text(&text, Context { scope, file: place.file });
                let value = value.map_err(|fault| Fault::Elsewhere(Box::new(self.error(&place, fault))))?.literal();
                self.scopes.set(scope, name, Slot::Value(value.clone()));
                Ok(Some(value))
            }
        }
    }
}

/// Adds the text of the expression to the message of a fault.
fn with_expression(expression: &str, fault: Fault) -> Fault {
    match fault {
        Fault::Here(message, hint) => {
            let shown: String = expression.trim().chars().take(60).collect();
            Fault::Here(format!("${{{shown}}}: {message}"), hint)
        }
        elsewhere => elsewhere,
    }
}

/// The names that an expression can use in a context.
struct ContextNames<'e, 's> {
    expander: &'e mut Expander<'s>,
    context: Context,
}

impl Names for ContextNames<'_, '_> {
    fn property(&mut self, name: &str) -> Result<Option<Value>, Fault> {
        self.expander.property(self.context.scope, name)
    }

    fn argument(&mut self, name: &str) -> Result<Value, Fault> {
        self.expander.argument(name)
    }

    fn yaml(&mut self, name: &str) -> Result<Value, Fault> {
        let path =
            path_beside(&self.expander.files[self.context.file].path, Path::new(name).to_string_lossy().as_ref());
        self.expander.yaml.push(path.clone());
        let value = yaml::load(&path, self.expander.settings.read)?;
        self.expander.budget.spend(value.printed().len())?;
        Ok(value)
    }

    fn budget(&mut self) -> &mut Budget {
        &mut self.expander.budget
    }
}

impl Expander<'_> {
    /// Returns the property of the caller that is a parameter's default.
    pub fn forwarded(&mut self, scope: usize, name: &str) -> Result<Option<Value>, Fault> {
        self.property(scope, name)
    }

    /// Returns the context of an attribute's text.
    pub fn context(scope: usize, place: &Place) -> Context {
        Context { scope, file: place.file }
    }
}
