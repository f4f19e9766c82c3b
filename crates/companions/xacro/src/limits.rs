//! Limits on the size of an expansion.

use crate::error::Fault;

/// Largest depth of nested elements, macro calls, includes and properties. Descriptions of robots need about 20 levels.
/// A macro that calls itself needs two levels per call.
pub(crate) const MAX_DEPTH: usize = 320;

/// Largest depth of nested parentheses and operators in one expression.
pub(crate) const MAX_EXPRESSION_DEPTH: usize = 40;

/// Largest number of steps of an expansion: elements, attributes and parts of expressions. The largest public robots
/// need some 100 000 steps.
pub(crate) const MAX_STEPS: usize = 3_000_000;

/// Largest size of the expanded text and all computed values together, in bytes.
pub(crate) const MAX_TEXT_BYTES: usize = 64 << 20;

/// Largest number of items in a list.
pub(crate) const MAX_LIST_ITEMS: usize = 100_000;

/// The resources used so far.
#[derive(Debug, Default)]
pub(crate) struct Budget {
    steps: usize,
    bytes: usize,
    depth: usize,
}

const RECURSION_HINT: &str =
    "a macro or an included file may call itself without end; add a condition that ends this (xacro:if)";

impl Budget {
    /// Counts a step whose result is a text of this many bytes.
    pub fn spend(&mut self, bytes: usize) -> Result<(), Fault> {
        self.steps += 1;
        self.bytes = self.bytes.saturating_add(bytes);
        if self.steps > MAX_STEPS {
            return Err(Fault::with_hint(format!("the expansion needs more than {MAX_STEPS} steps"), RECURSION_HINT));
        }
        if self.bytes > MAX_TEXT_BYTES {
            return Err(Fault::with_hint(
                format!("the expanded file is larger than {} MiB", MAX_TEXT_BYTES >> 20),
                RECURSION_HINT,
            ));
        }
        Ok(())
    }

    /// Enters a level of nesting.
    pub fn enter(&mut self) -> Result<(), Fault> {
        if self.depth >= MAX_DEPTH {
            let message =
                format!("elements, macros, includes and properties are nested more than {MAX_DEPTH} deep here");
            return Err(Fault::with_hint(message, RECURSION_HINT));
        }
        self.depth += 1;
        Ok(())
    }

    /// Leaves a level of nesting.
    pub fn leave(&mut self) {
        self.depth -= 1;
    }
}
