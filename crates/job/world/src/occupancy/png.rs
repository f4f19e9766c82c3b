//! PNG pictures of any kind: grey, colour, palette; 1 to 16 bits; with or without opacity.

use super::picture::{Judge, Picture, Shade, UnusablePicture, checked_size};
use ::png::{BitDepth, ColorType, Decoder, DecodingError, Transformations};
use std::io::Cursor;

pub(super) fn read(bytes: &[u8], judge: Judge) -> Result<Picture, UnusablePicture> {
    let broken =
        |error: DecodingError| UnusablePicture::new(format!("is a broken PNG: {error}"), "save the picture again");
    let mut decoder = Decoder::new(Cursor::new(bytes));
    // The decoder converts palettes to colours, expands pixels to eight bits, and makes a transparent colour an opacity.
    decoder.set_transformations(Transformations::EXPAND);
    let header = decoder.read_header_info().map_err(broken)?;
    let (width, height) = (header.width as usize, header.height as usize);
    let count = checked_size(width, height)?;
    if lacks_colors(bytes).map_err(broken)? {
        return Err(UnusablePicture::new(
            "is a broken PNG: a pixel has a colour that is not in the palette",
            "save the picture again",
        ));
    }
    let mut reader = decoder.read_info().map_err(broken)?;
    let size = reader.output_buffer_size().ok_or_else(|| broken(DecodingError::LimitsExceeded))?;
    let mut samples = vec![0; size];
    let frame = reader.next_frame(&mut samples).map_err(broken)?;
    let channels = frame.color_type.samples();
    // A pixel has one channel for grey or three for a colour, and another one for its opacity if the picture has it.
    let (shades, has_opacity) = (if channels < 3 { 1 } else { 3 }, channels % 2 == 0);
    let (bytes_each, most) = if frame.bit_depth == BitDepth::Sixteen { (2, 65535.0) } else { (1, 255.0) };
    let value = |sample: &[u8]| sample.iter().fold(0.0, |value, byte| 256.0 * value + f64::from(*byte));
    let cell = |pixel: &[u8]| {
        let (colors, opacity) = pixel.split_at(shades * bytes_each);
        let opaque = !has_opacity || value(opacity) == most;
        let sum: f64 = colors.chunks_exact(bytes_each).map(value).sum();
        judge(opaque.then_some(Shade { value: sum, white: shades as f64 * most }))
    };
    let cells: Vec<_> = samples.chunks_exact(channels * bytes_each).take(count).map(cell).collect();
    if cells.len() < count {
        return Err(UnusablePicture::new("is a broken PNG: pixels are missing", "save the picture again"));
    }
    Ok(Picture { width, height, cells })
}

/// Returns true if a pixel's colour is missing in the palette. The decoder would make this pixel black.
fn lacks_colors(bytes: &[u8]) -> Result<bool, DecodingError> {
    let mut reader = Decoder::new(Cursor::new(bytes)).read_info()?;
    let info = reader.info();
    if info.color_type != ColorType::Indexed {
        return Ok(false);
    }
    let colors = info.palette.as_ref().map_or(0, |palette| palette.len() / 3);
    let (width, bits) = (info.width as usize, info.bit_depth as usize);
    let mut lines = vec![0; reader.output_buffer_size().ok_or(DecodingError::LimitsExceeded)?];
    let frame = reader.next_frame(&mut lines)?;
    let number =
        |line: &[u8], x: usize| usize::from(line[x * bits / 8] >> (8 - bits - x * bits % 8)) & ((1 << bits) - 1);
    Ok(lines.chunks(frame.line_size).any(|line| (0..width).any(|x| number(line, x) >= colors)))
}
