//! A sequence of figures as an animated GIF.
//!
//! Only the part of a picture that has changed is written. All pictures share one palette of the most frequent colours, so that
//! areas of one colour stay unchanged.

use super::DrawError;
use super::figure::Figure;
use super::rasterizer::Rasterizer;
use cplan_interrupt::checkpoint;
use gif::{DisposalMethod, Encoder, Frame, Repeat};
use std::borrow::Cow;
use std::collections::HashMap;
use tiny_skia::Pixmap;

/// Number of colours in the palette. `UNCHANGED_INDEX`, the index after the last colour, marks unchanged pixels.
const PALETTE_COLORS: usize = 255;
const UNCHANGED_INDEX: u8 = PALETTE_COLORS as u8;

/// Colours nearer than this are merged. The distance is the sum of the squared differences of the three channels (0 to 255).
const COLOR_DISTANCE: i32 = 48;

type Color = [u8; 3];

/// A part of a picture that differs from the previous picture: its left side, top, width, height and pixels.
struct Patch {
    place: [usize; 4],
    pixels: Vec<Color>,
    /// Time for which the picture is shown, in hundredths of a second.
    delay: u16,
}

/// Writes an animated GIF that repeats for ever, `width` pixels wide. Calls `done` after each figure.
pub fn write(
    figures: impl Iterator<Item = (Figure, u16)>,
    width: f64,
    done: &mut dyn FnMut(),
) -> Result<Vec<u8>, DrawError> {
    let rasterizer = Rasterizer::new();
    let mut patches: Vec<Patch> = Vec::new();
    let mut last: Option<Vec<Color>> = None;
    let mut size = [0; 2];
    for (figure, delay) in figures {
        checkpoint();
        let picture = rasterizer.picture(&figure, width / figure.width)?;
        size = [picture.width() as usize, picture.height() as usize];
        let pixels = colors(&picture);
        match (differing_rectangle(last.as_deref(), &pixels, size), patches.last_mut()) {
            (None, Some(before)) => before.delay = before.delay.saturating_add(delay),
            (place, _) => patches.push(cut(&pixels, size, place.unwrap_or([0, 0, size[0], size[1]]), delay)),
        }
        last = Some(pixels);
        done();
    }
    encode(&patches, size).map_err(|error| DrawError::Gif(error.to_string()))
}

/// Writes a figure as a GIF with a single picture, `width` pixels wide.
pub fn still(figure: &Figure, width: f64) -> Result<Vec<u8>, DrawError> {
    let picture = Rasterizer::new().picture(figure, width / figure.width)?;
    let size = [picture.width(), picture.height()].map(|side| side as usize);
    let pixels = colors(&picture);
    encode(&[cut(&pixels, size, [0, 0, size[0], size[1]], 0)], size).map_err(|error| DrawError::Gif(error.to_string()))
}

/// Returns the colours of an opaque picture.
fn colors(picture: &Pixmap) -> Vec<Color> {
    picture.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect()
}

/// Returns the smallest rectangle that contains all differences between two pictures; the whole picture if there is no previous
/// one.
fn differing_rectangle(before: Option<&[Color]>, now: &[Color], [width, height]: [usize; 2]) -> Option<[usize; 4]> {
    let Some(before) = before else { return Some([0, 0, width, height]) };
    let differs = |y: usize| before[y * width..][..width] != now[y * width..][..width];
    let top = (0..height).find(|&y| differs(y))?;
    let bottom = (top..height).rev().find(|&y| differs(y))?;
    let column = |x: usize| (top..=bottom).any(|y| before[y * width + x] != now[y * width + x]);
    let left = (0..width).find(|&x| column(x))?;
    let right = (left..width).rev().find(|&x| column(x))?;
    Some([left, top, right + 1 - left, bottom + 1 - top])
}

fn cut(pixels: &[Color], [width, _]: [usize; 2], place: [usize; 4], delay: u16) -> Patch {
    let [left, top, across, down] = place;
    let rows = (top..top + down).flat_map(|y| pixels[y * width + left..][..across].iter().copied());
    Patch { place, pixels: rows.collect(), delay }
}

fn distance(a: Color, b: Color) -> i32 {
    (0..3).map(|k| (i32::from(a[k]) - i32::from(b[k])).pow(2)).sum()
}

/// Returns the most frequent colours, only one of those that are similar.
fn palette(patches: &[Patch]) -> Vec<Color> {
    let mut counts: HashMap<Color, usize> = HashMap::new();
    for color in patches.iter().flat_map(|patch| &patch.pixels) {
        *counts.entry(*color).or_default() += 1;
    }
    let mut colors: Vec<(usize, Color)> = counts.into_iter().map(|(color, count)| (count, color)).collect();
    // Equally frequent colours are ordered by their values, because the order of the map is undefined.
    colors.sort_unstable_by_key(|&(count, color)| (std::cmp::Reverse(count), color));
    let mut palette: Vec<Color> = Vec::new();
    for (_, color) in colors {
        if palette.len() < PALETTE_COLORS && palette.iter().all(|&taken| distance(taken, color) > COLOR_DISTANCE) {
            palette.push(color);
        }
    }
    palette
}

fn encode(patches: &[Patch], [width, height]: [usize; 2]) -> Result<Vec<u8>, gif::EncodingError> {
    let palette = palette(patches);
    let mut known: HashMap<Color, u8> = HashMap::new();
    let nearest = |color: Color| (0..palette.len()).min_by_key(|&k| distance(palette[k], color)).unwrap_or(0) as u8;
    let mut table: Vec<u8> = palette.concat();
    table.resize(3 * (PALETTE_COLORS + 1), 0);
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width as u16, height as u16, &table)?;
    encoder.set_repeat(Repeat::Infinite)?;
    let mut canvas = vec![UNCHANGED_INDEX; width * height];
    for Patch { place: [left, top, across, down], pixels, delay } in patches {
        let mut buffer = Vec::with_capacity(pixels.len());
        for (k, &color) in pixels.iter().enumerate() {
            let index = *known.entry(color).or_insert_with(|| nearest(color));
            let there = &mut canvas[(top + k / across) * width + left + k % across];
            buffer.push(if *there == index { UNCHANGED_INDEX } else { index });
            *there = index;
        }
        encoder.write_frame(&Frame {
            delay: *delay,
            dispose: DisposalMethod::Keep,
            transparent: Some(UNCHANGED_INDEX),
            left: *left as u16,
            top: *top as u16,
            width: *across as u16,
            height: *down as u16,
            buffer: Cow::Owned(buffer),
            ..Frame::default()
        })?;
    }
    drop(encoder);
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_differ_where_they_differ() {
        let white = vec![[255; 3]; 12];
        let mut other = white.clone();
        (other[5], other[10]) = ([0; 3], [9; 3]);
        assert_eq!(differing_rectangle(Some(&white), &other, [4, 3]), Some([1, 1, 2, 2]));
        assert_eq!(differing_rectangle(Some(&white), &white, [4, 3]), None);
    }
}
