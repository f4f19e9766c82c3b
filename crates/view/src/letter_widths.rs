//! Widths of letters in the built-in font, Ubuntu Light, so that layouts are the same with and without it.

/// Units of the font per its height.
const UNITS_PER_EM: f64 = 1000.0;

/// Widths of the letters from space to tilde, in units of the font.
#[rustfmt::skip]
const ASCII_WIDTHS: [u16; 95] = [
    228, 274, 392, 653, 564, 831, 648, 240, 310, 310, 472, 564, 246, 282, 246, 359,
    564, 564, 564, 564, 564, 564, 564, 564, 564, 564, 246, 246, 564, 564, 564, 380,
    940, 641, 630, 609, 702, 555, 520, 658, 692, 248, 487, 599, 502, 865, 709, 774,
    592, 774, 618, 517, 548, 680, 624, 921, 608, 569, 560, 310, 359, 310, 564, 490,
    376, 509, 583, 460, 583, 548, 376, 573, 569, 237, 237, 495, 255, 863, 569, 582,
    583, 583, 374, 428, 387, 569, 480, 775, 499, 474, 455, 319, 262, 319, 564,
];

/// Widths of the letters from no-break space to U+017F, in units of the font.
#[rustfmt::skip]
const LATIN_WIDTHS: [u16; 224] = [
    228, 274, 564, 564, 564, 564, 262, 482, 376, 826, 386, 452, 564, 282, 826, 376,
    318, 564, 359, 359, 376, 575, 616, 246, 376, 359, 437, 452, 874, 874, 874, 380,
    641, 641, 641, 641, 641, 641, 915, 609, 555, 555, 555, 555, 248, 248, 248, 248,
    716, 709, 774, 774, 774, 774, 774, 564, 774, 680, 680, 680, 680, 569, 593, 596,
    509, 509, 509, 509, 509, 509, 854, 460, 548, 548, 548, 548, 237, 237, 237, 237,
    578, 569, 582, 582, 582, 582, 582, 564, 582, 569, 569, 569, 569, 474, 583, 474,
    641, 509, 641, 509, 641, 509, 609, 460, 609, 460, 609, 460, 609, 460, 702, 615,
    716, 583, 555, 548, 555, 548, 555, 548, 555, 548, 555, 548, 658, 573, 658, 573,
    658, 573, 658, 573, 692, 569, 720, 569, 248, 237, 248, 237, 248, 237, 248, 237,
    248, 237, 735, 474, 487, 237, 599, 495, 506, 502, 255, 502, 255, 502, 268, 502,
    309, 516, 255, 709, 569, 709, 569, 709, 569, 569, 709, 569, 774, 582, 774, 582,
    774, 582, 990, 944, 618, 374, 618, 374, 618, 374, 517, 428, 517, 428, 517, 428,
    517, 428, 548, 387, 548, 387, 548, 387, 680, 569, 680, 569, 680, 569, 680, 569,
    680, 569, 680, 569, 921, 775, 569, 474, 569, 560, 455, 560, 455, 560, 455, 247,
];

/// Returns the width of a letter as a fraction of the font's height. `None` if the letter is not listed here.
#[must_use]
pub fn letter_width(letter: char) -> Option<f64> {
    let code = letter as usize;
    let units = match letter {
        ' '..='~' => ASCII_WIDTHS[code - 0x20],
        '\u{a0}'..='\u{17f}' => LATIN_WIDTHS[code - 0xa0],
        '\u{2013}' => 496,
        '\u{2014}' | '\u{2026}' => 996,
        '\u{2212}' => 564,
        _ => return None,
    };
    Some(f64::from(units) / UNITS_PER_EM)
}

#[cfg(all(test, feature = "png"))]
mod tests {
    use super::*;
    use crate::letters::Font;

    /// Compares with the font itself.
    #[test]
    fn widths_are_those_of_the_font() {
        let font = Font::built_in();
        let mut count = 0;
        for letter in (' '..='\u{2212}').filter(|&letter| letter_width(letter).is_some()) {
            assert_eq!(letter_width(letter), font.letter_width(letter), "{letter}");
            count += 1;
        }
        assert_eq!(count, 95 + 224 + 4);
    }
}
