//! Notes about input that was corrected while reading. Each kind of correction gives one line, so a drawing with a thousand
//! shapes does not give a thousand.

use std::borrow::Cow;
use std::cell::RefCell;

/// Largest number of shapes that a note names. A note about more shapes states only how many.
const MAX_NAMED_SHAPES: usize = 3;

/// Corrections of the input by kind, each with the names of the corrected shapes.
#[derive(Debug, Default)]
pub(super) struct Corrections(RefCell<Vec<(Cow<'static, str>, Vec<String>)>>);

impl Corrections {
    /// Records that the shape `whom` was corrected; `what` describes the correction.
    pub fn note(&self, whom: &str, what: impl Into<Cow<'static, str>>) {
        let what = what.into();
        let mut kinds = self.0.borrow_mut();
        let kind = kinds.iter().position(|(kind, _)| *kind == what).unwrap_or_else(|| {
            kinds.push((what, Vec::new()));
            kinds.len() - 1
        });
        if kinds[kind].1.iter().all(|name| name != whom) {
            kinds[kind].1.push(whom.to_owned());
        }
    }

    /// Returns one line for each kind of correction, in order of first occurrence.
    pub fn lines(self) -> Vec<String> {
        let line = |(what, names): (Cow<str>, Vec<String>)| {
            let more = names.len().saturating_sub(MAX_NAMED_SHAPES);
            let names: Vec<String> = names.into_iter().take(MAX_NAMED_SHAPES).collect();
            let names = names.join(", ");
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            format!("{names}{more}: {what}")
        };
        self.0.into_inner().into_iter().map(line).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_of_a_kind_are_one_line() {
        let taken = Corrections::default();
        for k in 0..5 {
            taken.note(&format!("o{k}"), "taken once");
            taken.note(&format!("o{k}"), "taken once");
        }
        taken.note("x", "something else");
        let lines = taken.lines();
        assert_eq!(lines, ["o0, o1, o2 and 2 more: taken once", "x: something else"]);
    }
}
