//! A picture of either format, and what makes one unusable.

use super::{MOST_CELLS, Occupancy, pgm, png};

/// A picture's pixels, judged.
pub(super) struct Picture {
    pub width: usize,
    pub height: usize,
    /// Cells from the top, from the left.
    pub cells: Vec<Occupancy>,
}

/// Why a picture cannot be used, and what to do about it.
#[derive(Debug)]
pub(super) struct Broken {
    pub message: String,
    pub help: String,
}

impl Broken {
    pub fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { message: message.into(), help: help.into() }
    }
}

/// Brightness of a pixel, from 0 for black, as integers.
#[derive(Clone, Copy)]
pub(super) struct Shade {
    pub value: f64,
    pub white: f64,
}

/// A function from shades to occupancy. A pixel that is not opaque has no shade.
pub(super) type Judge<'a> = &'a dyn Fn(Option<Shade>) -> Occupancy;

/// Reads a picture, whose format its first bytes tell.
pub(super) fn read(bytes: &[u8], judge: Judge) -> Result<Picture, Broken> {
    const SAVE: &str = "save it as PGM or PNG";
    match bytes {
        [b'P', b'2' | b'5', ..] => pgm::read(bytes, judge),
        [0x89, b'P', b'N', b'G', ..] => png::read(bytes, judge),
        [b'P', kind @ b'1'..=b'7', ..] => {
            let format = match kind {
                b'1' | b'4' => "a bitmap of single bits (PBM)",
                b'7' => "a PAM",
                _ => "in colour (PPM)",
            };
            Err(Broken::new(format!("is {format}, not a greymap (PGM)"), SAVE))
        }
        [0xff, 0xd8, ..] => Err(Broken::new("is a JPEG, whose shades are not those that were drawn", SAVE)),
        [] => Err(Broken::new("is empty", SAVE)),
        _ => Err(Broken::new("is neither PGM nor PNG", SAVE)),
    }
}

/// Returns the number of pixels, or an error if there are too many, before any memory is allocated.
pub(super) fn checked_size(width: usize, height: usize) -> Result<usize, Broken> {
    if width == 0 || height == 0 {
        return Err(Broken::new(format!("has no pixels: {width} x {height}"), "draw the map anew"));
    }
    match width.checked_mul(height) {
        Some(count) if count <= MOST_CELLS => Ok(count),
        _ => Err(Broken::new(
            format!("{width} x {height} pixels are too many (at most {MOST_CELLS})"),
            "cut the map to the arm's surroundings, or make its pixels larger",
        )),
    }
}
