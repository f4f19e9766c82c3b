//! A picture of either format, and what makes one unusable.

/// What a map says of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Occupancy {
    /// Nothing is there.
    Free,
    /// Something is there.
    Occupied,
    /// Nobody has looked, or the picture does not say.
    Unknown,
}

/// Cells of the largest picture that is read.
pub const MAX_CELLS: usize = 1 << 26;

/// A picture's pixels, judged.
pub(super) struct Picture {
    pub width: usize,
    pub height: usize,
    /// Cells from the top, from the left.
    pub cells: Vec<Occupancy>,
}

/// Why a picture cannot be used, and what to do about it.
#[derive(Debug)]
pub(super) struct UnusablePicture {
    pub message: String,
    pub help: String,
}

impl UnusablePicture {
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

/// The number of pixels, if the program takes so many: before any memory is asked for.
pub(super) fn checked_size(width: usize, height: usize) -> Result<usize, UnusablePicture> {
    if width == 0 || height == 0 {
        return Err(UnusablePicture::new(format!("has no pixels: {width} x {height}"), "save the map again"));
    }
    match width.checked_mul(height) {
        Some(count) if count <= MAX_CELLS => Ok(count),
        _ => Err(UnusablePicture::new(
            format!("{width} x {height} pixels are too many (at most {MAX_CELLS})"),
            "cut the map to the arm's surroundings, or make its pixels larger",
        )),
    }
}
