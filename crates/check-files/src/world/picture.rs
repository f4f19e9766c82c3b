//! Reads pictures in shades of grey: PGM and PNG.

use png::{BitDepth, ColorType, Decoder, DecodingError, Transformations};
use std::io::Cursor;

/// Maximum number of pixels of a picture.
const MAX_PIXELS: usize = 1 << 26;

/// The brightness of pixels.
pub struct Picture {
    pub size: [usize; 2],
    /// Shade of white. The shade of black is 0.
    pub white: u32,
    /// Shade of each pixel, row by row from above; `None` for a pixel that is not opaque.
    pub shades: Vec<Option<u32>>,
}

/// Reads a picture in PNG or PGM.
pub fn read(bytes: &[u8]) -> Result<Picture, String> {
    match bytes {
        [b'P', kind @ (b'2' | b'5'), rest @ ..] => greymap(rest, *kind == b'2'),
        [0x89, b'P', b'N', b'G', ..] => in_png(bytes),
        _ => Err("the checker reads only PGM (P2, P5) and PNG pictures: save it as one of these".into()),
    }
}

fn pixels([width, height]: [usize; 2]) -> Result<usize, String> {
    let count = width.checked_mul(height).filter(|count| (1..=MAX_PIXELS).contains(count));
    count.ok_or_else(|| "the picture is empty or too large".into())
}

/// Reads a PNG of any kind. Colours are averaged.
fn in_png(bytes: &[u8]) -> Result<Picture, String> {
    let wrong = |error: DecodingError| error.to_string();
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND);
    let header = decoder.read_header_info().map_err(wrong)?;
    let size = [header.width as usize, header.height as usize];
    let count = pixels(size)?;
    if !is_in_palette(bytes).map_err(wrong)? {
        return Err("a pixel has a colour that is not in the palette".into());
    }
    let mut reader = decoder.read_info().map_err(wrong)?;
    let mut samples = vec![0; reader.output_buffer_size().ok_or("it is too large")?];
    let frame = reader.next_frame(&mut samples).map_err(wrong)?;
    let channels = frame.color_type.samples();
    let (colors, bytes_each) =
        (if channels < 3 { 1 } else { 3 }, if frame.bit_depth == BitDepth::Sixteen { 2 } else { 1 });
    let most = if bytes_each == 2 { 65_535 } else { 255 };
    let shade = |pixel: &[u8]| {
        let mut values =
            pixel.chunks(bytes_each).map(|bytes| bytes.iter().fold(0, |sum, byte| 256 * sum + u32::from(*byte)));
        let sum = values.by_ref().take(colors).sum();
        values.next().is_none_or(|opacity| opacity == most).then_some(sum)
    };
    let shades: Vec<Option<u32>> = samples.chunks_exact(channels * bytes_each).take(count).map(shade).collect();
    match shades.len() == count {
        true => Ok(Picture { size, white: colors as u32 * most, shades }),
        false => Err("pixels are missing".into()),
    }
}

/// Returns true if all colours of a PNG are in its palette, or if there is no palette.
fn is_in_palette(bytes: &[u8]) -> Result<bool, DecodingError> {
    let mut reader = Decoder::new(Cursor::new(bytes)).read_info()?;
    let (color, depth, width) =
        (reader.info().color_type, reader.info().bit_depth as usize, reader.info().width as usize);
    let colors = reader.info().palette.as_ref().map_or(0, |palette| palette.len() / 3);
    if color != ColorType::Indexed {
        return Ok(true);
    }
    let mut rows = vec![0; reader.output_buffer_size().ok_or(DecodingError::LimitsExceeded)?];
    let length = reader.next_frame(&mut rows)?.line_size;
    let each = 8 / depth;
    let is_known = |row: &[u8]| {
        let parts = row.iter().flat_map(|byte| (0..each).map(move |k| *byte >> (depth * (each - 1 - k))));
        parts.take(width).all(|part| usize::from(part) % (1 << depth) < colors)
    };
    Ok(rows.chunks(length).all(is_known))
}

/// Reads a PGM, in text or binary form, after its first two bytes.
fn greymap(mut rest: &[u8], is_text: bool) -> Result<Picture, String> {
    if !rest.first().is_some_and(|byte| byte.is_ascii_whitespace() || *byte == b'#') {
        return Err("the header of the picture is not valid".into());
    }
    let [width, height, white] = [number(&mut rest)?, number(&mut rest)?, number(&mut rest)?];
    let count = pixels([width, height])?;
    if !(1..=65535).contains(&white) {
        return Err(format!("maxval is {white}, but must be from 1 to 65535"));
    }
    let shades: Vec<usize> = if is_text {
        let shades = (0..count).map(|_| number(&mut rest)).collect::<Result<_, _>>()?;
        skip(&mut rest);
        shades
    } else {
        // A single white space character ends the header.
        comment(&mut rest);
        let bytes_each = if white > 255 { 2 } else { 1 };
        let (raster, after) =
            rest.get(1..).unwrap_or_default().split_at_checked(bytes_each * count).ok_or("it ends early")?;
        rest = after;
        let shade = |bytes: &[u8]| bytes.iter().fold(0, |sum, byte| 256 * sum + usize::from(*byte));
        raster.chunks(bytes_each).map(shade).collect()
    };
    match shades.iter().all(|shade| *shade <= white) && rest.is_empty() {
        true => Ok(Picture {
            size: [width, height],
            white: white as u32,
            shades: shades.into_iter().map(|shade| Some(shade as u32)).collect(),
        }),
        false => Err("a pixel's value is above maxval, or the file continues after the last pixel".into()),
    }
}

/// Skips a comment, up to the end of its line.
fn comment(rest: &mut &[u8]) {
    if rest.first() == Some(&b'#') {
        *rest = &rest[rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(rest.len())..];
    }
}

/// Skips white space and comments.
fn skip(rest: &mut &[u8]) {
    comment(rest);
    while rest.first().is_some_and(u8::is_ascii_whitespace) {
        *rest = &rest[1..];
        comment(rest);
    }
}

/// Reads the next number of a PGM.
fn number(rest: &mut &[u8]) -> Result<usize, String> {
    skip(rest);
    let length = rest.iter().position(|byte| !byte.is_ascii_digit()).unwrap_or(rest.len());
    let (digits, after) = rest.split_at(length);
    *rest = after;
    let text = std::str::from_utf8(digits).unwrap_or_default();
    text.parse().map_err(|_| format!("\"{text}\" is not a number, or the file ends early"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use png::Encoder;

    /// Returns a picture with two pixels per row and two bits per pixel. A reader must ignore the padding of the rows.
    fn indexed(rows: &[u8]) -> Result<Picture, String> {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, 2, rows.len() as u32);
        encoder.set_color(ColorType::Indexed);
        encoder.set_depth(BitDepth::Two);
        encoder.set_palette(vec![0, 0, 0, 10, 20, 30, 255, 255, 255]);
        encoder.write_header().unwrap().write_image_data(rows).unwrap();
        read(&bytes)
    }

    #[test]
    fn missing_palette_entries_have_no_shade() {
        let Picture { size, white, shades } = indexed(&[0b0110_1111, 0b1000_1100]).unwrap();
        assert_eq!((size, white), ([2, 2], 765));
        assert_eq!(shades, [60, 765, 765, 0].map(Some));
        assert!(indexed(&[0b0110_0000, 0b1011_0000]).is_err_and(|why| why.contains("not in the palette")));
    }
}
