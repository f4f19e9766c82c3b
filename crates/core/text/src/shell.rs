//! Words for a shell.

/// Returns a word for a shell, in quotes if it needs them.
pub fn for_a_shell(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_=,./:+%@".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_where_a_shell_would_part_them() {
        let words = ["--start=-0.6,1.2", "a b.toml", "it's", ""];
        assert_eq!(words.map(for_a_shell), ["--start=-0.6,1.2", "'a b.toml'", "'it'\\''s'", "''"]);
    }
}
