//! Records of comma-separated values (RFC 4180), with the position of every field. Semicolons or tabs may separate
//! fields instead.

use std::borrow::Cow;
use std::ops::Range;

/// A field of a record, and its position in the text, including quotation marks.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Field<'a> {
    pub text: Cow<'a, str>,
    pub range: Range<usize>,
}

/// An iterator over the records of a text, without blank lines. A quotation that is never closed extends to the end of the text,
/// and is later refused because it is not a number.
pub(super) struct Records<'a> {
    text: &'a str,
    at: usize,
    separator: char,
}

impl<'a> Records<'a> {
    /// Creates the iterator. `separator` separates fields.
    pub fn new(text: &'a str, separator: char) -> Self {
        Self { text, at: 0, separator }
    }

    /// Returns the next field, and true if it is the last one of its record.
    fn field(&mut self) -> (Field<'a>, bool) {
        let start = self.at;
        let rest = &self.text[start..];
        let quoted = rest.starts_with('"').then(|| closing_quote(rest));
        let begin = quoted.unwrap_or(0);
        let length = rest[begin..].find([self.separator, '\n']).map_or(rest.len(), |i| begin + i);
        let ends = !rest[length..].starts_with(self.separator);
        self.at = start + (length + 1).min(rest.len());
        let raw = rest[..length].trim();
        let text = match quoted {
            Some(_) => {
                let inner = raw.strip_prefix('"').unwrap_or(raw);
                Cow::Owned(inner.strip_suffix('"').unwrap_or(inner).replace("\"\"", "\""))
            }
            None => Cow::Borrowed(raw),
        };
        (Field { text, range: start..start + length }, ends)
    }
}

/// Returns the position after the quotation that begins the text, or the end of the text if the quotation is never closed.
fn closing_quote(text: &str) -> usize {
    let mut from = 1;
    while let Some(i) = text[from..].find('"') {
        from += i + 1;
        if !text[from..].starts_with('"') {
            return from;
        }
        from += 1;
    }
    text.len()
}

impl<'a> Iterator for Records<'a> {
    type Item = Vec<Field<'a>>;

    fn next(&mut self) -> Option<Self::Item> {
        while self.at < self.text.len() {
            let mut record = Vec::new();
            loop {
                let (field, ends) = self.field();
                record.push(field);
                if ends {
                    break;
                }
            }
            if record.len() > 1 || !record[0].text.is_empty() {
                return Some(record);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<Vec<String>> {
        Records::new(text, ',').map(|r| r.into_iter().map(|f| f.text.into_owned()).collect()).collect()
    }

    #[test]
    fn fields_and_records_are_split() {
        assert_eq!(read("a,b\r\n\n 1 ,2\n"), [["a", "b"], ["1", "2"]]);
        assert_eq!(read("a,\n,b"), [["a", ""], ["", "b"]]);
        assert_eq!(read("\"a,\"\"b\"\"\",c\n1,2"), [["a,\"b\"", "c"], ["1", "2"]]);
        assert_eq!(read("\"a\nb\",c"), [["a\nb", "c"]]);
        assert_eq!(read(""), Vec::<Vec<String>>::new());
        assert_eq!(read("\"never closed, 1\n2"), [["never closed, 1\n2"]]);
        assert_eq!(read("\"\",1"), [["", "1"]]);
    }

    #[test]
    fn semicolons_tabs_and_blanks_separate_fields() {
        let read = |text, separator| -> Vec<Vec<String>> {
            Records::new(text, separator).map(|r| r.into_iter().map(|f| f.text.into_owned()).collect()).collect()
        };
        assert_eq!(read("a;b\n1,5;2\n", ';'), [["a", "b"], ["1,5", "2"]]);
        assert_eq!(read("a\tb\n\t2\n", '\t'), [["a", "b"], ["", "2"]]);
    }

    #[test]
    fn fields_have_their_places_in_the_text() {
        let text = "a,\"b,\"\nç, d";
        let fields: Vec<&str> = Records::new(text, ',')
            .flatten()
            .map(|f| f.range)
            .collect::<Vec<_>>()
            .into_iter()
            .map(|r| &text[r])
            .collect();
        assert_eq!(fields, ["a", "\"b,\"", "ç", " d"]);
    }
}
