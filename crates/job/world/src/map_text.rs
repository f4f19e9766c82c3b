//! The text of line maps and preference files: the header `2D-Map`, bounds, and counted lists of numbers.

use cplan_geometry::Point;
use cplan_robot::{Diagnostic, InputError, Source};
use std::ops::Range;
use std::path::Path;

/// First word of a map file.
const MAP_HEADER: &str = "2D-Map";

/// The lines of a file that begins with `2D-Map`. Blank lines and lines that begin with `#` are skipped. White space of
/// any kind separates words.
pub(super) struct MapText {
    pub source: Source,
    /// Positions of the lines that are not skipped.
    lines: Vec<Range<usize>>,
    next: usize,
}

/// The numbers on a line, with the line's position.
pub(super) struct Numbers<const N: usize> {
    pub values: [f64; N],
    pub at: Range<usize>,
}

impl MapText {
    /// Reads a file up to and including its header.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let source = Source::read(path)?;
        let mut lines = Vec::new();
        let mut start = 0;
        for line in source.text().split_inclusive('\n') {
            let content = line.trim();
            if !content.is_empty() && !content.starts_with('#') {
                let from = start + (line.len() - line.trim_start().len());
                lines.push(from..from + content.len());
            }
            start += line.len();
        }
        let mut text = Self { source, lines, next: 0 };
        text.word(MAP_HEADER)
            .map_err(|diagnostic| diagnostic.help(format!("a map begins with a line \"{MAP_HEADER}\"")))?;
        Ok(text)
    }

    fn line(&self) -> Option<(&str, Range<usize>)> {
        let at = self.lines.get(self.next)?;
        Some((&self.source.text()[at.clone()], at.clone()))
    }

    /// Returns the next line. `what` names the line in error messages.
    ///
    /// # Errors
    /// The file has ended.
    fn next_line(&self, what: &str) -> Result<(&str, Range<usize>), Diagnostic> {
        self.line().ok_or_else(|| {
            let end = self.source.text().trim_end().len();
            let message = format!("the file ends too early: {what} is expected here");
            self.source.diagnostic_at(end..end, message).help("add the missing part, or export the map again")
        })
    }

    /// Skips a line that consists of the single word `word`.
    pub fn word(&mut self, word: &str) -> Result<(), Diagnostic> {
        let what = format!("\"{word}\"");
        let (found, at) = self.next_line(&what)?;
        if found != word {
            return Err(self.unexpected(at, &what));
        }
        self.next += 1;
        Ok(())
    }

    fn unexpected(&self, at: Range<usize>, what: &str) -> Diagnostic {
        self.source.diagnostic_at(at, format!("expected {what}")).help(format!("write {what} on this line"))
    }

    /// Reads the numbers of a line `key: n n ...`.
    pub fn keyed<const N: usize>(&mut self, key: &str) -> Result<Numbers<N>, Diagnostic> {
        let what = format!("\"{key}:\" and {}", counted(N));
        let (found, at) = self.next_line(&what)?;
        let Some(rest) = found.strip_prefix(key).and_then(|rest| rest.trim_start().strip_prefix(':')) else {
            return Err(self.unexpected(at, &what));
        };
        let from = at.end - rest.len();
        let values = self.parsed(from..at.end, &what)?;
        self.next += 1;
        Ok(Numbers { values, at })
    }

    /// Reads the integer of a line `key: n`.
    pub fn count(&mut self, key: &str) -> Result<(usize, Range<usize>), Diagnostic> {
        let Numbers { values: [value], at } = self.keyed::<1>(key)?;
        if value < 0.0 || value.fract() != 0.0 || value > MAX_COUNT {
            let message = format!("{key}: {value} is not a number of lines");
            return Err(self.source.diagnostic_at(at, message).help("count the lines that follow"));
        }
        Ok((value as usize, at))
    }

    /// Reads the numbers of a line that contains nothing else.
    pub fn numbers<const N: usize>(&mut self, what: &str) -> Result<Numbers<N>, Diagnostic> {
        let (_, at) = self.next_line(&format!("{what} ({})", counted(N)))?;
        let values = self.parsed(at.clone(), what)?;
        self.next += 1;
        Ok(Numbers { values, at })
    }

    /// Reads lines of numbers, then the line `end`. The file has announced `count` lines.
    pub fn list<const N: usize>(
        &mut self,
        announced: (usize, Range<usize>),
        key: &str,
        item: &str,
        end: &str,
    ) -> Result<Vec<Numbers<N>>, Diagnostic> {
        let list = self.list_before(announced, key, item, end)?;
        self.word(end)?;
        Ok(list)
    }

    /// Reads lines of numbers, up to but excluding a line that begins with `end`. The file has announced `count` lines.
    pub fn list_before<const N: usize>(
        &mut self,
        (count, at): (usize, Range<usize>),
        key: &str,
        item: &str,
        end: &str,
    ) -> Result<Vec<Numbers<N>>, Diagnostic> {
        let what = format!("{item} or \"{end}\"");
        let mut list = Vec::new();
        while !self.next_line(&what)?.0.starts_with(end) {
            list.push(self.numbers(&what)?);
        }
        if count != list.len() {
            let message = format!("{key} says {count}, but {} follow", list.len());
            return Err(self.source.diagnostic_at(at, message).help("correct the number, or add the missing lines"));
        }
        Ok(list)
    }

    /// Reads `LineMinPos` and `LineMaxPos`.
    pub fn bounds(&mut self) -> Result<[Point; 2], Diagnostic> {
        let Numbers { values: lower, .. } = self.keyed::<2>("LineMinPos")?;
        let Numbers { values: upper, at } = self.keyed::<2>("LineMaxPos")?;
        if (0..2).any(|k| lower[k] >= upper[k]) {
            let message = format!("LineMaxPos {upper:?} is not above LineMinPos {lower:?} in both coordinates");
            return Err(self.source.diagnostic_at(at, message).help("write the lower left corner first"));
        }
        Ok([lower.into(), upper.into()])
    }

    /// Returns the two points on a line, which must lie within the bounds.
    pub fn corners(&self, values: &[f64], at: &Range<usize>, bounds: &[Point; 2]) -> Result<[Point; 2], Diagnostic> {
        let corners = [Point::new(values[0], values[1]), Point::new(values[2], values[3])];
        let [lower, upper] = bounds;
        match corners.iter().find(|p| (0..2).any(|k| p[k] < lower[k] || p[k] > upper[k])) {
            None => Ok(corners),
            Some(p) => {
                let message = format!("({}, {}) lies outside the bounds of the map", p.x, p.y);
                let help = "correct the point, or widen LineMinPos and LineMaxPos";
                Err(self.source.diagnostic_at(at.clone(), message).help(help))
            }
        }
    }

    /// Checks that no further line follows.
    pub fn end(&self) -> Result<(), Diagnostic> {
        match self.line() {
            None => Ok(()),
            Some((_, at)) => {
                let message = "text follows the end of the map";
                Err(self
                    .source
                    .diagnostic_at(at, message)
                    .help("remove the text, or move it before the last word of the map"))
            }
        }
    }

    /// Parses exactly `N` finite numbers.
    fn parsed<const N: usize>(&self, at: Range<usize>, what: &str) -> Result<[f64; N], Diagnostic> {
        let text = &self.source.text()[at.clone()];
        let mut values = [0.0; N];
        let mut found = 0;
        for word in text.split_whitespace() {
            let from = at.start + (word.as_ptr() as usize - text.as_ptr() as usize);
            let place = from..from + word.len();
            let Some(value) = word.parse().ok().filter(|value: &f64| value.is_finite()) else {
                let message = format!("{what}: \"{word}\" is not a finite number");
                return Err(self.source.diagnostic_at(place, message).help("write numbers, such as 1500 or -0.5"));
            };
            if let Some(slot) = values.get_mut(found) {
                *slot = value;
            }
            found += 1;
        }
        if found != N {
            let message = format!("{what}: expected {}, found {found}", counted(N));
            return Err(self.source.diagnostic_at(at, message).help("separate numbers by blanks, one item per line"));
        }
        Ok(values)
    }
}

/// Limit on the number of lines that a file may announce. No file that can be read has more.
const MAX_COUNT: f64 = 1e9;

fn counted(n: usize) -> String {
    if n == 1 { "a number".to_owned() } else { format!("{n} numbers") }
}
