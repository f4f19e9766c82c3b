//! Splits the text of a DXF into tags, and the tags into records. A tag is a pair of lines with a code and a value. A
//! record begins with a tag of code 0.

use crate::{Error, Point};
use std::borrow::Cow;

/// A pair of lines: a code and a value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tag<'a> {
    pub code: i32,
    pub value: &'a str,
    /// Line number of the value, from 1.
    pub line: usize,
}

impl Tag<'_> {
    /// Returns the value as a finite number.
    pub fn number(&self) -> Result<f64, Error> {
        self.value.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(|| {
            let message = format!("group {} needs a number, found \"{}\"", self.code, self.value);
            Error::new(self.line, message, "export the drawing again, as an ASCII DXF")
        })
    }

    fn integer(&self) -> Result<i64, Error> {
        self.value.parse().map_err(|_| {
            let message = format!("group {} needs a whole number, found \"{}\"", self.code, self.value);
            Error::new(self.line, message, "export the drawing again, as an ASCII DXF")
        })
    }
}

/// A tag with code 0, and the tags up to the next tag with code 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Record<'a> {
    pub kind: &'a str,
    pub line: usize,
    pub tags: &'a [Tag<'a>],
}

impl<'a> Record<'a> {
    pub fn text(&self, code: i32) -> Option<&'a str> {
        self.tag(code).map(|tag| tag.value)
    }

    pub fn number(&self, code: i32) -> Result<Option<f64>, Error> {
        self.tag(code).map(Tag::number).transpose()
    }

    pub fn number_or(&self, code: i32, default: f64) -> Result<f64, Error> {
        Ok(self.number(code)?.unwrap_or(default))
    }

    pub fn integer_or(&self, code: i32, default: i64) -> Result<i64, Error> {
        Ok(self.tag(code).map(Tag::integer).transpose()?.unwrap_or(default))
    }

    /// Returns true if a bit of the value with code 70 is set.
    pub fn flag(&self, bit: i64) -> Result<bool, Error> {
        Ok(self.integer_or(70, 0)? & bit != 0)
    }

    /// Returns the number with this code, which the record must have.
    pub fn needed(&self, code: i32) -> Result<f64, Error> {
        self.number(code)?.ok_or_else(|| {
            let message = format!("{} has no group {code}", self.kind);
            Error::new(self.line, message, "the file seems truncated: export the drawing again")
        })
    }

    /// Returns the point whose x coordinate has this code, and whose y coordinate has this code plus 10.
    pub fn point(&self, code: i32) -> Result<Point, Error> {
        Ok([self.needed(code)?, self.needed(code + 10)?])
    }

    /// Returns all points whose x coordinates have this code, in order.
    pub fn points(&self, code: i32) -> Result<Vec<Point>, Error> {
        let x = self.numbers(code)?;
        let y = self.numbers(code + 10)?;
        if x.len() != y.len() {
            let message = format!("{} has {} coordinates x and {} coordinates y", self.kind, x.len(), y.len());
            return Err(Error::new(self.line, message, "the file seems truncated: export the drawing again"));
        }
        Ok(x.into_iter().zip(y).map(|(x, y)| [x, y]).collect())
    }

    pub fn numbers(&self, code: i32) -> Result<Vec<f64>, Error> {
        self.tags.iter().filter(|tag| tag.code == code).map(Tag::number).collect()
    }

    fn tag(&self, code: i32) -> Option<&'a Tag<'a>> {
        self.tags.iter().find(|tag| tag.code == code)
    }
}

/// Decodes the text: UTF-8 or, in files of older programs, one byte per character.
pub(super) fn decoded(bytes: &[u8]) -> Result<Cow<'_, str>, Error> {
    if bytes.starts_with(b"AC10") {
        let message = "this is a DWG, AutoCAD's own format, not a DXF";
        return Err(Error::new(None, message, "save it as an ASCII DXF, e.g. with `dwg2dxf` or ODA File Converter"));
    }
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(Error::new(None, "the file is empty", "export the drawing again, as an ASCII DXF"));
    }
    Ok(match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text.trim_start_matches('\u{feff}')),
        Err(_) => Cow::Owned(bytes.iter().copied().map(char::from).collect()),
    })
}

/// Splits the text into tags up to EOF, without comments. Also returns the line of any text after EOF.
pub(super) fn tags(text: &str) -> Result<(Vec<Tag<'_>>, Option<usize>), Error> {
    let mut tags = Vec::new();
    let mut lines = text.lines().zip(1..);
    while let Some((code, line)) = lines.next() {
        if tags.last().is_some_and(is_end) {
            // Mail programs and editors may leave blanks and a Ctrl-Z at the end.
            if code.trim_matches(|c: char| c.is_whitespace() || c == '\u{1a}').is_empty() {
                continue;
            }
            return Ok((tags, Some(line)));
        }
        let Ok(code) = code.trim().parse() else {
            let message = match tags.is_empty() {
                true => "this is not a DXF file: it does not begin with the code of a group".into(),
                false => format!("expected the code of a group, found \"{}\"", code.trim()),
            };
            return Err(Error::new(line, message, "export the drawing again, as an ASCII DXF"));
        };
        let Some((value, line)) = lines.next() else { return Err(cut(line)) };
        if code != 999 {
            tags.push(Tag { code, value: value.trim(), line });
        }
    }
    match tags.last() {
        Some(tag) if is_end(tag) => Ok((tags, None)),
        last => Err(cut(last.map_or(1, |tag| tag.line))),
    }
}

fn is_end(tag: &Tag) -> bool {
    tag.code == 0 && tag.value == "EOF"
}

pub(super) fn cut(line: usize) -> Error {
    let message = "the file ends in the middle: there is no EOF, and shapes may be missing";
    Error::new(line, message, "copy or export the drawing again")
}

pub(super) fn records<'a>(tags: &'a [Tag<'a>]) -> Vec<Record<'a>> {
    let begins: Vec<usize> = (0..tags.len()).filter(|&i| tags[i].code == 0).collect();
    let ends = begins.iter().skip(1).copied().chain([tags.len()]);
    let record = |(from, to): (usize, usize)| Record {
        kind: tags[from].value,
        line: tags[from].line,
        tags: &tags[from + 1..to],
    };
    begins.iter().copied().zip(ends).map(record).collect()
}
