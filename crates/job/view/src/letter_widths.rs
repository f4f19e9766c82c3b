//! Widths of letters in the built-in font Inter. With them, layouts do not depend on the presence of the font. The table has
//! ASCII, letters up to U+017F, dashes, apostrophe, bullet, ellipsis, minus sign and arrow.

use std::collections::HashMap;
use std::sync::LazyLock;

/// Units of the font per its height.
const UNITS_PER_EM: f64 = 2048.0;

/// Widths of letters in Inter Regular and in Inter SemiBold, as fractions of the font's height. Each line of the file has a
/// letter's number and its two widths in units of the font.
static WIDTHS: LazyLock<HashMap<char, [f64; 2]>> = LazyLock::new(|| {
    let width = |text: &str| text.parse::<f64>().ok().map(|units| units / UNITS_PER_EM);
    let known = include_str!("letter_widths.txt").lines().filter_map(|line| {
        let mut words = line.split(' ');
        let letter = char::from_u32(u32::from_str_radix(words.next()?, 16).ok()?)?;
        Some((letter, [width(words.next()?)?, width(words.next()?)?]))
    });
    known.collect()
});

/// Returns the width of a letter as a fraction of the font's height. `None` if the letter is not listed.
pub fn letter_width(letter: char, is_bold: bool) -> Option<f64> {
    Some(WIDTHS.get(&letter)?[usize::from(is_bold)])
}

#[cfg(all(test, feature = "png"))]
mod tests {
    use super::*;
    use crate::letters::Fonts;

    #[test]
    fn widths_are_those_of_the_font() {
        let fonts = Fonts::built_in();
        for is_bold in [false, true] {
            let mut count = 0;
            for letter in (' '..='\u{2212}').filter(|&letter| letter_width(letter, is_bold).is_some()) {
                assert_eq!(letter_width(letter, is_bold), fonts.of(is_bold).letter_width(letter), "{letter}");
                count += 1;
            }
            assert_eq!(count, 95 + 222 + 7);
        }
    }
}
