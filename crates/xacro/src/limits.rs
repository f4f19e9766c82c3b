//! Bounds on the size of an expansion.

use crate::error::Fault;

/// Levels of elements, macros, includes and properties within one another. Robots need about 20; a macro that calls itself needs two a
/// turn.
pub(crate) const MAX_DEPTH: usize = 320;

/// Levels of parentheses and operators in one expression.
pub(crate) const MAX_EXPRESSION_DEPTH: usize = 40;

/// Steps of an expansion: elements, attributes and parts of expressions. The largest public robots need some 100 000.
pub(crate) const MAX_STEPS: usize = 3_000_000;

/// Bytes of the expanded text, and of all values that are computed on the way.
pub(crate) const MAX_TEXT_BYTES: usize = 64 << 20;

/// Items of a list.
pub(crate) const MAX_LIST_ITEMS: usize = 100_000;

/// The resources that an expansion has used so far.
#[derive(Debug, Default)]
pub(crate) struct Budget {
    steps: usize,
    bytes: usize,
    depth: usize,
}

const RECURSION_HINT: &str = "a macro or include may repeat without end; end it by a condition (xacro:if)";

impl Budget {
    /// Counts a step that makes a text of so many bytes.
    pub fn spend(&mut self, bytes: usize) -> Result<(), Fault> {
        self.steps += 1;
        self.bytes = self.bytes.saturating_add(bytes);
        if self.steps > MAX_STEPS {
            return Err(Fault::with_hint(format!("the expansion needs more than {MAX_STEPS} steps"), RECURSION_HINT));
        }
        if self.bytes > MAX_TEXT_BYTES {
            return Err(Fault::with_hint(
                format!("the expansion makes more than {} MiB", MAX_TEXT_BYTES >> 20),
                RECURSION_HINT,
            ));
        }
        Ok(())
    }

    /// Goes one level down.
    pub fn enter(&mut self) -> Result<(), Fault> {
        if self.depth >= MAX_DEPTH {
            let message =
                format!("elements, macros, includes and properties are nested more than {MAX_DEPTH} deep here");
            return Err(Fault::with_hint(message, RECURSION_HINT));
        }
        self.depth += 1;
        Ok(())
    }

    /// Comes back up.
    pub fn leave(&mut self) {
        self.depth -= 1;
    }
}
