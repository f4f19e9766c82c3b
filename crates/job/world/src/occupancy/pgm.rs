//! Grey pictures in the format PGM: as text (P2) or bytes (P5), with 8 or 16 bits.
//!
//! Format: <https://netpbm.sourceforge.net/doc/pgm.html>. A `#` in the header begins a comment up to the end of the line.

use super::picture::{Judge, Picture, Shade, UnusablePicture, checked_size};

/// The hint of most diagnostics.
const SAVE_HINT: &str = "save the picture again";

pub(super) fn read(bytes: &[u8], judge: Judge) -> Result<Picture, UnusablePicture> {
    let in_text = bytes[1] == b'2';
    let mut header = Words { bytes, at: 2 };
    let [width, height, most] =
        [header.number(&"width")?, header.number(&"height")?, header.number(&"greatest value (maxval)")?];
    let count = checked_size(width, height)?;
    if !(1..=65535).contains(&most) {
        return Err(UnusablePicture::new(format!("maxval is {most}, but must be from 1 to 65535"), SAVE_HINT));
    }
    // Computes each shade once, instead of once per pixel.
    let shade = |value: usize| Shade { value: value as f64, white: most as f64 };
    let occupancies: Vec<_> = (0..=most).map(|value| judge(Some(shade(value)))).collect();
    let checked = |value: usize, index: usize| {
        occupancies.get(value).copied().ok_or_else(|| {
            let place = format!("row {}, column {}", index / width + 1, index % width + 1);
            UnusablePicture::new(format!("{place}: {value} exceeds the maxval, {most}"), SAVE_HINT)
        })
    };
    let cells = if in_text {
        let mut cells = Vec::with_capacity(count.min(bytes.len()));
        for index in 0..count {
            let value = header.number(&format_args!("value {} of {count}", index + 1))?;
            cells.push(checked(value, index)?);
        }
        header.skip();
        check_end_of_file(header.at, bytes)?;
        cells
    } else {
        // A single white space ends the header; it may be the end of a comment's line.
        header.skip_comment();
        let start = header.at + 1;
        let raster = bytes.get(start..).unwrap_or_default();
        let wide = most > 255;
        let needed = count * if wide { 2 } else { 1 };
        if raster.len() < needed {
            let message =
                format!("ends early: {width} x {height} pixels take {needed} bytes, but the file has {}", raster.len());
            return Err(UnusablePicture::new(message, SAVE_HINT));
        }
        check_end_of_file(start + needed, bytes)?;
        let value = |index: usize| match wide {
            true => usize::from(u16::from_be_bytes([raster[2 * index], raster[2 * index + 1]])),
            false => usize::from(raster[index]),
        };
        (0..count).map(|index| checked(value(index), index)).collect::<Result<_, _>>()?
    };
    Ok(Picture { width, height, cells })
}

fn check_end_of_file(at: usize, bytes: &[u8]) -> Result<(), UnusablePicture> {
    if at >= bytes.len() {
        return Ok(());
    }
    let message = format!("continues after the last pixel, at byte {}", at + 1);
    Err(UnusablePicture::new(
        message,
        "correct width, height and maxval in the header, end its lines by one character, or save the picture again",
    ))
}

/// Reads words from a file that consists of white space, comments and whole numbers.
struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Words<'_> {
    fn skip(&mut self) {
        loop {
            self.skip_comment();
            match self.bytes.get(self.at) {
                Some(byte) if byte.is_ascii_whitespace() => self.at += 1,
                _ => break,
            }
        }
    }

    /// Skips the rest of the line if a comment begins here.
    fn skip_comment(&mut self) {
        let rest = &self.bytes[self.at..];
        if rest.first() == Some(&b'#') {
            self.at += rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(rest.len());
        }
    }

    /// Reads the next number and the white space around it.
    fn number(&mut self, what: &dyn std::fmt::Display) -> Result<usize, UnusablePicture> {
        let before = self.at;
        self.skip();
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|b| b.is_ascii_whitespace() || *b == b'#').unwrap_or(rest.len());
        let word = &rest[..length];
        if word.is_empty() {
            return Err(UnusablePicture::new(format!("ends early: there is no {what}"), SAVE_HINT));
        }
        let value = std::str::from_utf8(word).ok().filter(|w| w.bytes().all(|b| b.is_ascii_digit()));
        match value.and_then(|w| w.parse().ok()) {
            Some(value) if self.at > before => {
                self.at += length;
                Ok(value)
            }
            _ => {
                // The beginning of a long word suffices for the message.
                let shown: String = String::from_utf8_lossy(word).chars().take(20).collect();
                Err(UnusablePicture::new(
                    format!("{what}: {shown:?} is not a whole number (byte {})", self.at + 1),
                    SAVE_HINT,
                ))
            }
        }
    }
}
