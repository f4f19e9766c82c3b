//! Word wrapping.

/// Wraps a line to at most `width` characters, or more if a single word is longer. Continuation lines begin with
/// `indent` spaces. Spaces before the first word and between the words of a line remain.
pub fn wrapped(line: &str, width: usize, indent: usize) -> String {
    let mut text = String::with_capacity(line.len());
    let (mut column, mut gap) = (0, 0);
    for word in line.split(' ') {
        let length = word.chars().count();
        // Between two consecutive spaces there is an empty word.
        if !word.is_empty() && column > indent && column + gap + length > width {
            text.push('\n');
            text.extend(std::iter::repeat_n(' ', indent));
            (column, gap) = (indent, 0);
        }
        if !word.is_empty() {
            text.extend(std::iter::repeat_n(' ', gap));
            text.push_str(word);
            (column, gap) = (column + gap + length, 0);
        }
        gap += 1;
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_go_on_below_the_second_column() {
        assert_eq!(wrapped("key   one two three", 13, 6), "key   one two\n      three");
        assert_eq!(wrapped("one two three", 7, 0), "one two\nthree");
        assert_eq!(wrapped("one two three", 80, 0), "one two three");
    }

    #[test]
    fn blanks_stay_and_long_words_stand_out() {
        assert_eq!(wrapped("  a  b   c", 80, 2), "  a  b   c");
        assert_eq!(wrapped("  abcdefgh ij", 6, 2), "  abcdefgh\n  ij");
        assert_eq!(wrapped("", 6, 2), "");
    }
}
