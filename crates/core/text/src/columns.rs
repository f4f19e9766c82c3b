//! Text in two columns.

use super::plain_line;
use std::fmt::Write;

/// Column in which the second column starts.
pub const SECOND_COLUMN: usize = 11;

/// Lines with a key in a first column. A key that equals the key of the line before is left blank.
#[derive(Debug, Default)]
pub struct Columns {
    text: String,
    before: String,
}

impl Columns {
    /// Adds a line.
    pub fn add(&mut self, key: &str, line: &str) {
        let shown = if key == self.before { "" } else { key };
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "{shown:<width$} {}", plain_line(line), width = SECOND_COLUMN - 1);
        key.clone_into(&mut self.before);
    }

    /// Returns all lines.
    pub fn into_text(self) -> String {
        self.text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_is_written_once() {
        let mut columns = Columns::default();
        [("arm", "a"), ("joint", "b"), ("joint", "c\u{1b}"), ("arm", "d")].iter().for_each(|(k, l)| columns.add(k, l));
        assert_eq!(columns.into_text(), "arm        a\njoint      b\n           c\\u{1b}\narm        d\n");
    }
}
