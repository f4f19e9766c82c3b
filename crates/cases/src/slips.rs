//! Texts with random typing mistakes.

use super::dice::Dice;

/// Texts that replace a number: extreme, invalid or of another type.
const NUMBER_REPLACEMENTS: [&str; 16] = [
    "0",
    "-0",
    "1",
    "-1",
    "1e308",
    "-1e308",
    "1e-320",
    "nan",
    "inf",
    "-inf",
    "1e16",
    "\"30deg\"",
    "[]",
    "{}",
    "0x7f",
    "",
];
/// Texts of one or two characters that are inserted at random places.
const INSERTED_TEXTS: [&str; 18] =
    ["[", "]", "{", "}", "\"", "<", ">", "/", "=", ",", "#", "\n", "\0", "\u{e4}", "[[", "]]", ";", "\t"];

/// Returns the text after one to three random edits, some of which may change nothing. An edit replaces a number,
/// inserts or deletes characters, repeats or deletes a line, swaps two lines or words, or cuts off the rest.
pub fn slipped(dice: &mut Dice, text: &str) -> String {
    let mut text: Vec<char> = text.chars().collect();
    for _ in 0..1 + dice.below(3) {
        let n = text.len().max(1);
        let at = dice.below(n).min(text.len());
        let insert = |text: &mut Vec<char>, at: usize, bit: &str| {
            text.splice(at..at, bit.chars());
        };
        match dice.below(9) {
            // Replace a number.
            0 | 1 => {
                let is_number_char = |c: &char| c.is_ascii_digit() || matches!(c, '.' | '-');
                let starts: Vec<usize> = (0..text.len())
                    .filter(|&i| is_number_char(&text[i]) && (i == 0 || !is_number_char(&text[i - 1])))
                    .collect();
                if let Some(&start) = starts.get(dice.below(starts.len().max(1))) {
                    let end = start + text[start..].iter().take_while(|c| is_number_char(c)).count();
                    let bit = NUMBER_REPLACEMENTS[dice.below(NUMBER_REPLACEMENTS.len())];
                    text.splice(start..end, bit.chars());
                }
            }
            2 => insert(&mut text, at, INSERTED_TEXTS[dice.below(INSERTED_TEXTS.len())]),
            3 => {
                let end = (at + 1 + dice.below(8)).min(text.len());
                text.drain(at..end);
            }
            // Repeat a line, or delete it.
            4 | 5 => {
                let lines: Vec<String> = text.iter().collect::<String>().lines().map(str::to_owned).collect();
                let k = dice.below(lines.len().max(1));
                let copies = 2 * dice.below(2);
                let again =
                    lines.iter().enumerate().flat_map(|(i, line)| vec![line.clone(); if i == k { copies } else { 1 }]);
                text = again.collect::<Vec<_>>().join("\n").chars().collect();
            }
            // Swap two lines, or two words.
            6 => text = swapped(dice, &text, '\n'),
            7 => text = swapped(dice, &text, ' '),
            _ => text.truncate(at.max(1)),
        }
    }
    text.into_iter().collect()
}

/// Returns the text after a swap of two random pieces. Pieces are separated by `separator`. The two may be the same
/// piece.
fn swapped(dice: &mut Dice, text: &[char], separator: char) -> Vec<char> {
    let mut pieces: Vec<&[char]> = text.split(|c| *c == separator).collect();
    let (a, b) = (dice.below(pieces.len()), dice.below(pieces.len()));
    pieces.swap(a, b);
    pieces.join(&separator)
}
