//! The pixels of a picture in any format, and the reasons why a picture cannot be used.

/// The state of a cell of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Occupancy {
    /// There is no obstacle in the cell.
    Free,
    /// There is an obstacle in the cell.
    Occupied,
    /// Nobody has seen the cell, or the picture does not show its state.
    Unknown,
}

/// Largest number of cells of a picture.
pub const MAX_CELLS: usize = 1 << 26;

/// The pixels of a picture, converted to cells.
pub(super) struct Picture {
    pub width: usize,
    pub height: usize,
    /// Cells row by row, from the top, and from the left in each row.
    pub cells: Vec<Occupancy>,
}

/// The reason why a picture cannot be used, and a hint.
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

/// Brightness of a pixel: 0 for black, `white` for white.
#[derive(Clone, Copy)]
pub(super) struct Shade {
    pub value: f64,
    pub white: f64,
}

/// Converts a shade to the state of a cell; `None` stands for a pixel that is not opaque.
pub(super) type Judge<'a> = &'a dyn Fn(Option<Shade>) -> Occupancy;

/// Returns the number of pixels. To be called before memory is allocated for them.
///
/// # Errors
/// No pixels, or more than [`MAX_CELLS`].
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
