//! Templates: they write programs, and the written text is certified.

use crate::data::identifier;
use crate::error::ProgramError;
use crate::joint_value::{digits, negated, plus};
use crate::program::Program;
use crate::written::Written;
use cplan_robot::{Diagnostic, InputError, Source};
use minijinja::syntax::SyntaxConfig;
use minijinja::{AutoEscape, Environment, Error, ErrorKind, UndefinedBehavior};
use std::path::Path;

/// The shipped templates: names and texts.
pub const SHIPPED: [(&str, &str); 3] = [
    ("epson", include_str!("../templates/epson.j2")),
    ("rapid", include_str!("../templates/rapid.j2")),
    ("list", include_str!("../templates/list.j2")),
];

/// Greatest number of instructions of a template, so that loops end. A target takes about a hundred.
const MAX_INSTRUCTIONS: u64 = 50_000_000;

/// The hint for all defects of templates.
const HINT: &str = "docs/programs.md lists the data and the filters of templates";

/// The hint for templates that do not write all targets.
const HINT_FOR_TARGETS: &str = "write each joint of each move exactly once, in the order of `moves`, and then its signals, if it has any: {% for move in moves %}{{ move.joints | join(\", \") }}{% endfor %}";

/// A template for programs.
#[derive(Debug, Clone)]
pub struct Template {
    source: Source,
}

impl Template {
    /// Reads a template: the name of a shipped one, or the path of a file.
    ///
    /// # Errors
    /// A file that cannot be read, and a defect of its syntax, with the line.
    pub fn load(name: &str) -> Result<Self, InputError> {
        let source = match SHIPPED.iter().find(|(shipped, _)| *shipped == name) {
            Some((_, text)) => Source::in_memory(format!("template {name}"), *text),
            None if !Path::new(name).exists() => {
                let names = SHIPPED.map(|(name, _)| name).join(", ");
                let help = format!("give the file of a template, or the name of a shipped one: {names}");
                return Err(Diagnostic::new(name, "there is no such template").help(help).into());
            }
            None => Source::read(Path::new(name))?,
        };
        let template = Self { source };
        let environment = template.environment();
        environment.template_from_str(template.source.text()).map_err(|error| template.defect(&error))?;
        Ok(template)
    }

    /// Returns the file of the template. Empty for a shipped one.
    pub fn files(&self) -> Vec<std::path::PathBuf> {
        self.source.files()
    }

    /// Writes a program, reads the targets back from the text, and certifies them.
    ///
    /// # Errors
    /// A defect of the template, a text without all targets in order, and targets that are not certified as written.
    pub fn write(&self, program: &Program) -> Result<Written, ProgramError> {
        let environment = self.environment();
        let template = environment.template_from_str(self.source.text()).map_err(|error| self.defect(&error))?;
        let rendered = template.render(program.data()).map_err(|error| self.defect(&error))?;
        let incomplete = |why: String| InputError::from(self.source.diagnostic(why).help(HINT_FOR_TARGETS));
        let written = Written::read(program, &rendered).map_err(incomplete)?;
        program.certify(&written.targets)?;
        Ok(written)
    }

    fn environment(&self) -> Environment<'_> {
        let mut environment = Environment::new();
        environment.set_debug(true);
        environment.set_fuel(Some(MAX_INSTRUCTIONS));
        environment.set_undefined_behavior(UndefinedBehavior::Strict);
        environment.set_auto_escape_callback(|_| AutoEscape::None);
        // Lines that hold only a block leave no empty line.
        let syntax = SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).keep_trailing_newline(true).build();
        environment.set_syntax(syntax.unwrap_or_default());
        environment.add_filter("digits", |value: minijinja::Value, decimals: usize| digits(&value, decimals));
        environment.add_filter("negated", |value: minijinja::Value| negated(&value));
        environment.add_filter("plus", |value: minijinja::Value, zero: f64| plus(&value, zero));
        environment.add_filter("identifier", |name: String| identifier(&name));
        environment
    }

    /// Describes a defect, with its place in the template.
    fn defect(&self, error: &Error) -> InputError {
        let message = match error.kind() {
            ErrorKind::OutOfFuel => format!("the template takes more than {MAX_INSTRUCTIONS} instructions"),
            kind => error.detail().map_or_else(|| kind.to_string(), str::to_owned),
        };
        let diagnostic = match (error.range(), error.line()) {
            (Some(range), _) => self.source.diagnostic_at(range, message),
            (None, Some(line)) => self.source.diagnostic_at_position(line, 1, message),
            (None, None) => self.source.diagnostic(message),
        };
        diagnostic.help(HINT).into()
    }
}
