//! Lines that a firmware reads otherwise than a machine tool. Marlin and Klipper run one command per line, require a
//! command in each line, and know no comments in parentheses.

use super::Dialect;
use cplan_toolpath::Error;

/// Commands that set defaults. A firmware may lack them if the program never leaves these modes.
const DEFAULTS: [&str; 8] = ["G17", "G21", "G40", "G49", "G54", "G80", "G90", "G94"];

/// A letter with its number, and its column from 1.
struct Word {
    text: String,
    column: usize,
}

/// Checks that a firmware runs all commands of a program.
///
/// # Errors
/// The first wrong checksum or line number. Otherwise, the first word that the firmware ignores or reads otherwise,
/// with line and column.
pub(crate) fn check(text: &str, dialect: Dialect) -> Result<(), Error> {
    check_numbers(text, dialect)?;
    if !matches!(dialect, Dialect::Marlin | Dialect::Klipper) {
        return Ok(());
    }
    let (mut is_relative, mut is_inch) = (false, false);
    for (line, number) in text.lines().zip(1..) {
        let code = line.split(';').next().unwrap_or_default();
        let (code, comment) = code.split_at(code.find('(').unwrap_or(code.len()));
        let words = words(code);
        if misreads(&words, comment) {
            let message = format!(
                "{dialect} does not know comments in parentheses, and would read the words in or after this one"
            );
            return Err(Error::new(number, code.chars().count() + 1, message, "write the comment after ;"));
        }
        let error = |word: &Word, message: String, hint: &str| {
            Err(Error::new(number, word.column, format!("{} {message}", word.text), hint))
        };
        let lower_case = words.iter().find(|word| word.text.starts_with(|c: char| c.is_ascii_lowercase()));
        if let Some(word) = lower_case.filter(|_| dialect == Dialect::Marlin) {
            return error(
                word,
                format!("is in lower case, but {dialect} reads only upper case"),
                "write it in upper case",
            );
        }
        let mut commands = words.iter().filter(|word| word.has_letter("GM"));
        match commands.next() {
            Some(word) if word.is("G90") || word.is("G91") => is_relative = word.is("G91"),
            Some(word) if word.is("G20") || word.is("G21") => is_inch = word.is("G20"),
            Some(_) => {}
            None => {
                if let Some(word) = words.iter().find(|word| word.has_letter("XYIJR")) {
                    let message = format!("is in a line without a command, but {dialect} runs only lines with one");
                    let hint = "begin the line with G0, G1, G2 or G3, or name another firmware by --dialect";
                    return error(word, message, hint);
                }
            }
        }
        let holds = |word: &&Word| {
            let is_left = (is_relative && word.is("G90")) || (is_inch && word.is("G21"));
            !is_left && DEFAULTS.iter().any(|name| word.is(name))
        };
        if let Some(word) = commands.find(|word| !holds(word)) {
            let message = format!("is not the first command of the line, but {dialect} runs only the first");
            return error(
                word,
                message,
                "write the command into a line of its own, or name another firmware by --dialect",
            );
        }
    }
    Ok(())
}

/// Checks the checksums of lines. For Marlin, the numbers of lines must also increase, in lines with a checksum by one.
fn check_numbers(text: &str, dialect: Dialect) -> Result<(), Error> {
    let mut last = None;
    for (line, number) in text.trim_start_matches('\u{feff}').lines().zip(1..) {
        let code = line.split(';').next().unwrap_or_default();
        let sum = code.rfind('*').map(|at| (at, code[at + 1..].trim()));
        let sum = sum.filter(|(_, digits)| digits.chars().all(|c| c.is_ascii_digit()));
        if let Some((at, stated)) = sum {
            let own = code[..at].trim_start().bytes().fold(0, |sum, byte| sum ^ byte);
            if stated.parse() != Ok(own) {
                let message = format!("the checksum is *{stated}, but that of this line is *{own}");
                let hint = "write the line again; it may have been damaged or edited";
                return Err(Error::new(number, code[..at].chars().count() + 1, message, hint));
            }
        }
        let words = words(code);
        let first = words.iter().find(|word| word.has_letter("N"));
        let Some((first, named)) = first.and_then(|word| Some((word, word.text[1..].parse::<u64>().ok()?))) else {
            continue;
        };
        if let Some((_, rest)) = code.split_once("M110") {
            // A second N is the number that the command sets.
            let set = rest.split_once('N').map(|(_, set)| set.trim_start());
            let set = set.and_then(|set| set.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok());
            last = Some(set.unwrap_or(named));
            continue;
        }
        let is_next = |last: u64| if sum.is_some() { named == last + 1 } else { named > last };
        if let Some(last) = last.filter(|last| dialect == Dialect::Marlin && !is_next(*last)) {
            let message = format!("{} comes after N{last}, and {dialect} refuses numbers out of order", first.text);
            let hint = "number the lines again, or leave out the numbers and the checksums";
            return Err(Error::new(number, first.column, message, hint));
        }
        last = Some(named);
    }
    Ok(())
}

impl Word {
    fn is(&self, name: &str) -> bool {
        self.text.eq_ignore_ascii_case(name)
    }

    fn has_letter(&self, letters: &str) -> bool {
        self.text.chars().next().is_some_and(|letter| letters.contains(letter.to_ascii_uppercase()))
    }

    /// Returns true if the rest of the line belongs to the command, such as the text after M117.
    fn takes_rest(&self) -> bool {
        self.has_letter("M") && self.text[1..].parse::<u32>().is_ok_and(|number| number > 15)
    }
}

/// Returns the words at the beginning of a line, up to a command that takes the rest.
fn words(code: &str) -> Vec<Word> {
    let letters: Vec<char> = code.chars().collect();
    let mut words: Vec<Word> = Vec::new();
    for (at, letter) in letters.iter().enumerate().filter(|(_, letter)| letter.is_ascii_alphabetic()) {
        let number = letters[at + 1..].iter().skip_while(|c| c.is_whitespace());
        let digits: String = number.take_while(|c| c.is_ascii_digit() || "+-.".contains(**c)).collect();
        if !digits.is_empty() && !words.last().is_some_and(Word::takes_rest) {
            words.push(Word { text: format!("{letter}{digits}"), column: at + 1 });
        }
    }
    words
}

/// Returns true if the firmware reads words in a comment in parentheses, or in the text after it.
fn misreads(before: &[Word], comment: &str) -> bool {
    if before.last().is_some_and(Word::takes_rest) {
        return false;
    }
    let (inside, after) = comment.split_at(comment.rfind(')').unwrap_or(comment.len()));
    let is_parameter = |word: &Word| word.text.starts_with(|c: char| c.is_ascii_uppercase());
    !words(after).is_empty() || (!before.is_empty() && words(inside).iter().any(is_parameter))
}
