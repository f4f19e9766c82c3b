//! Splits lines of a program into words.

use crate::{Error, Source};

/// A letter and its number.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Word {
    /// The letter, in upper case; `#` for parameters, `O` for keywords such as `WHILE`.
    pub letter: char,
    /// The number; `None` if it is missing or computed.
    pub value: Option<f64>,
    /// True if the number is an expression or a parameter.
    pub is_computed: bool,
    /// The word as written in the file.
    pub text: String,
    /// Place of the word's first character.
    pub source: Source,
    /// Index of the character after the word in its line.
    pub end: usize,
}

/// A line of a program.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Line {
    /// Words, perhaps none.
    Words(Vec<Word>),
    /// The mark at the beginning or the end of a program (%).
    Percent,
    /// A line that the operator may skip (/).
    Optional(Source),
    /// A command of a firmware, such as `SET_VELOCITY_LIMIT ACCEL=500` or `$H`, by its name.
    Command(String, Source),
}

/// Keywords with which programs repeat, skip or call lines.
const KEYWORDS: [&str; 6] = ["IF", "WHILE", "GOTO", "END", "DO", "THEN"];

impl Word {
    /// Returns an error about the word. `message` follows the word's name.
    pub fn error(&self, message: &str, hint: impl Into<String>) -> Error {
        Error::new(self.source.line, self.source.column, format!("{} {message}", self.text), hint)
    }

    /// Returns true if the word has a letter and one of these numbers.
    pub fn is(&self, letter: char, values: &[f64]) -> bool {
        self.letter == letter && self.value.is_some_and(|value| values.contains(&value))
    }

    /// Returns true if the rest of the line belongs to this command, such as the text after M117. The commands of machine tools,
    /// in contrast, share lines with moves.
    fn takes_rest(&self) -> bool {
        let shares = |value: f64| value < 16.0 || value == 30.0 || (40.0..61.0).contains(&value);
        self.letter == 'M' && self.value.is_some_and(|value| !shares(value))
    }
}

/// Splits a line into its parts, without comments and checksum.
///
/// # Errors
/// If a comment is not closed, or if something is not a word.
pub(super) fn line(text: &str, number: usize) -> Result<Line, Error> {
    let trimmed = text.trim();
    if trimmed.contains('\r') {
        let message = "this line contains a carriage return, at which some machines end the line";
        return Err(Error::new(number, None, message, "save the file with line ends of one kind"));
    }
    let source = Source { line: number, column: Some(text.chars().take_while(|c| c.is_whitespace()).count() + 1) };
    let name = trimmed.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).next().unwrap_or_default();
    let rest = trimmed[name.len()..].trim_start();
    let is_name = name.chars().take(2).filter(|c| c.is_ascii_alphabetic() || *c == '_').count() == 2;
    let has_pairs = rest.is_empty() || rest.starts_with([';', '#']) || has_pair(rest);
    Ok(match trimmed.chars().next() {
        Some('%') => Line::Percent,
        Some('/') => Line::Optional(source),
        Some('$') => Line::Command(trimmed.chars().take(2).collect::<String>().to_uppercase(), source),
        Some(sign @ ('?' | '!' | '~')) => Line::Command(sign.to_string(), source),
        _ if is_keyword(trimmed) => Line::Words(vec![computed('O', name, source)]),
        _ if is_name && has_pairs => Line::Command(name.to_owned(), source),
        _ => Line::Words(words(text, number)?),
    })
}

/// Returns true if a text begins with a name, an equals sign and a value.
fn has_pair(text: &str) -> bool {
    let name = text.split('=').next().unwrap_or_default().trim_end();
    text.contains('=') && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') && !name.is_empty()
}

fn is_keyword(text: &str) -> bool {
    let name = text.split(|c: char| !(c.is_ascii_alphabetic() || c == '_')).next().unwrap_or_default();
    KEYWORDS.iter().any(|keyword| name.eq_ignore_ascii_case(keyword))
}

fn computed(letter: char, text: &str, source: Source) -> Word {
    Word { letter, value: None, is_computed: true, text: text.to_owned(), source, end: 0 }
}

fn words(line: &str, number: usize) -> Result<Vec<Word>, Error> {
    let mut words: Vec<Word> = Vec::new();
    let letters: Vec<char> = line.chars().collect();
    let mut at = 0;
    while at < letters.len() {
        let column = at + 1;
        let source = Source { line: number, column: Some(column) };
        match letters[at] {
            ';' => break,
            '*' if is_checksum(&letters[at + 1..]) => break,
            '(' => match comment_end(&letters[at..]) {
                Some(length) => at += length,
                None => return Err(Error::new(number, column, "this comment is not closed", "close it with )")),
            },
            c if c.is_whitespace() => at += 1,
            '#' => {
                words.push(computed('#', "#", source));
                break;
            }
            c if c.is_ascii_alphabetic() => {
                let (word, end) = word(&letters, at, source)?;
                let is_last = word.is_computed || word.takes_rest();
                words.push(word);
                if is_last {
                    break;
                }
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

/// Returns the word that begins at an index, and the index after it.
fn word(letters: &[char], at: usize, source: Source) -> Result<(Word, usize), Error> {
    let letter = letters[at].to_ascii_uppercase();
    let end = number_end(letters, at + 1);
    let digits: String = letters[at + 1..end].iter().filter(|c| !c.is_whitespace()).collect();
    let next = letters[at + 1..].iter().find(|c| !c.is_whitespace());
    // A program number is alone on its line; the number of a subroutine is not.
    let calls = letter == 'O' && letters[end..].iter().find(|c| !c.is_whitespace()).is_some_and(|c| !";(".contains(*c));
    if calls || (digits.is_empty() && next.is_some_and(|c| "#[".contains(*c))) {
        return Ok((computed(letter, &letter.to_string(), source), letters.len()));
    }
    let text = format!("{letter}{digits}");
    if has_exponent(&letters[end..]) && !digits.is_empty() {
        let message = format!("{text} has an exponent, and numbers of G-code have none");
        let hint = "write the number out, such as 0.00001";
        return Err(Error::new(source.line, source.column, message, hint));
    }
    let value = digits.parse::<f64>().ok().filter(|value| value.is_finite());
    if value.is_none() && !digits.is_empty() {
        let message = format!("{text} has no valid number");
        return Err(Error::new(source.line, source.column, message, "write a number such as 12.5"));
    }
    Ok((Word { letter, value, is_computed: false, text, source, end }, end))
}

/// Returns true if the text directly after a number is an exponent, as in 1e-05. A capital E is an exponent only before a sign
/// and whole digits; otherwise it is the word of an extruder.
fn has_exponent(rest: &[char]) -> bool {
    let digits = |from: usize| rest[from.min(rest.len())..].iter().take_while(|c| c.is_ascii_digit()).count();
    let is_signed =
        rest.get(1).is_some_and(|c| "+-".contains(*c)) && digits(2) > 0 && rest.get(2 + digits(2)) != Some(&'.');
    match rest.first() {
        Some('e') => is_signed || digits(1) > 0,
        Some('E') => is_signed,
        _ => false,
    }
}

/// Returns the length of the comment at the beginning of a text. It ends with the parenthesis that closes its first one. If that
/// is missing, it ends with the first closing parenthesis.
fn comment_end(text: &[char]) -> Option<usize> {
    let mut depth = 0_usize;
    let closes = |c: &char| {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        depth == 0
    };
    let balanced = text.iter().position(closes);
    balanced.or_else(|| text.iter().position(|c| *c == ')')).map(|last| last + 1)
}

/// Returns true if a text is a number, perhaps with a comment after it.
fn is_checksum(rest: &[char]) -> bool {
    let mut rest = rest.iter().skip_while(|c| c.is_ascii_digit()).skip_while(|c| c.is_whitespace());
    rest.next().is_none_or(|c| *c == ';')
}

/// Returns the index after a number, which may follow spaces: sign, digits and point.
fn number_end(letters: &[char], from: usize) -> usize {
    let spaces = letters[from..].iter().take_while(|c| c.is_whitespace()).count();
    let number = letters[from + spaces..].iter().enumerate();
    let length =
        number.take_while(|(k, c)| c.is_ascii_digit() || **c == '.' || (*k == 0 && "+-".contains(**c))).count();
    if length == 0 { from } else { from + spaces + length }
}
