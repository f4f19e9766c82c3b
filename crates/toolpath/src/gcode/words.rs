//! Splits lines of G-code into words.

use crate::{Error, Source};

/// A letter with its number.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Word {
    /// The letter, in upper case.
    pub letter: char,
    /// The number.
    pub value: f64,
    /// The word as the file has it.
    pub text: String,
    /// Place of the word's first character.
    pub source: Source,
}

impl Word {
    /// Returns an error about the word, which follows its name.
    pub fn error(&self, message: &str, hint: impl Into<String>) -> Error {
        Error::new(self.source.line, self.source.column, format!("{} {message}", self.text), hint)
    }
}

/// Returns the words of a line, without comments.
///
/// # Errors
/// If a comment is not closed, or if something is not a word.
pub(super) fn block(line: &str, number: usize) -> Result<Vec<Word>, Error> {
    let mut words = Vec::new();
    let letters: Vec<char> = line.chars().collect();
    let mut at = 0;
    while at < letters.len() {
        let column = at + 1;
        match letters[at] {
            ';' => break,
            '(' => match letters[at..].iter().position(|c| *c == ')') {
                Some(length) => at += length + 1,
                None => {
                    return Err(Error::new(number, column, "this comment is not closed", "close it with )"));
                }
            },
            c if c.is_whitespace() => at += 1,
            // Some programs begin and end with this sign, alone on a line.
            '%' if line.trim() == "%" => at += 1,
            c if c.is_ascii_alphabetic() => {
                let end = number_end(&letters, at + 1);
                let digits: String = letters[at + 1..end].iter().filter(|c| !c.is_whitespace()).collect();
                let text = format!("{}{digits}", c.to_ascii_uppercase());
                let source = Source { line: number, column: Some(column) };
                let value = digits.parse::<f64>().ok().filter(|value| value.is_finite());
                let Some(value) = value else {
                    let message = format!("the letter {c} has no number");
                    return Err(Error::new(number, column, message, "write a number after it, such as X12.5"));
                };
                words.push(Word { letter: c.to_ascii_uppercase(), value, text, source });
                at = end;
            }
            c => {
                let message = format!("\"{c}\" is not a word of G-code that cplan reads");
                let hint = "write words of a letter and a number, and comments in ( ) or after ;";
                return Err(Error::new(number, column, message, hint));
            }
        }
    }
    Ok(words)
}

/// Returns the index after a number that may follow spaces: a sign, digits and a point.
fn number_end(letters: &[char], from: usize) -> usize {
    let spaces = letters[from..].iter().take_while(|c| c.is_whitespace()).count();
    let number = letters[from + spaces..].iter().enumerate();
    let length = number.take_while(|(k, c)| c.is_ascii_digit() || **c == '.' || (*k == 0 && "+-".contains(**c)));
    from + spaces + length.count()
}
