//! Names made safe to print.

use std::borrow::Cow;

/// Returns true if a character has an effect on the terminal or on the text around it, instead of being visible. Such
/// characters are control characters, and those that change the direction of writing or break lines (Unicode 16, 23.2;
/// UAX 9).
fn affects_terminal(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

fn escape_characters(text: &str, spared: impl Fn(char) -> bool, escape: impl Fn(&mut String, char)) -> Cow<'_, str> {
    let is_escaped = |c: char| affects_terminal(c) && !spared(c);
    if !text.contains(is_escaped) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_escaped(c) { escape(&mut shown, c) } else { shown.push(c) }
    }
    Cow::Owned(shown)
}

/// Escapes characters that would have an effect on a terminal, as in `\u{1b}`. Line breaks remain.
pub fn plain(text: &str) -> Cow<'_, str> {
    escape_characters(text, |c| matches!(c, '\n' | '\t'), |shown, c| shown.extend(c.escape_default()))
}

/// Escapes the same characters as [`plain`], and line breaks.
pub fn plain_line(text: &str) -> Cow<'_, str> {
    escape_characters(text, |_| false, |shown, c| shown.extend(c.escape_default()))
}

/// Escapes within JSON the same characters as [`plain`]. Parsing the result gives the same value.
pub fn plain_json(json: &str) -> Cow<'_, str> {
    use std::fmt::Write;
    let escape = |shown: &mut String, c: char| {
        // Four digits are enough, because all these characters are in the basic plane. Writing to a string cannot fail.
        let _ = write!(shown, "\\u{:04x}", u32::from(c));
    };
    escape_characters(json, |c| matches!(c, '\n' | '\t' | '\r'), escape)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_escaped() {
        assert_eq!(plain("a\u{1b}[31m\tb\nc\u{9b}d\u{202e}e\r"), "a\\u{1b}[31m\tb\nc\\u{9b}d\\u{202e}e\\r");
        assert_eq!(plain_line("a\nb\tc"), "a\\nb\\tc");
        let usual = "shoulder \u{2192} \u{e4}\u{f6}\u{fc} \u{5d0}\u{1f916}";
        assert!(matches!(plain_line(usual), Cow::Borrowed(text) if text == usual));
        let json = serde_json::to_string("a\u{1b}\u{9b}\u{202e}\"").unwrap();
        assert!(plain_json(&json).is_ascii());
        assert_eq!(serde_json::from_str::<String>(&plain_json(&json)).unwrap(), "a\u{1b}\u{9b}\u{202e}\"");
    }
}
