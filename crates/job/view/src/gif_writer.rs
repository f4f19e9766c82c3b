//! A sequence of figures as an animated GIF.
//!
//! The items that two figures share are rasterised once, as layers that are laid over one another. Of each picture,
//! only the part that has changed is written. All pictures share one palette of the most frequent colours, so that flat
//! colours stay unchanged.

use super::DrawError;
use super::figure::{Figure, Item, Rect};
use super::rasterizer::{Rasterizer, ground};
use cplan_interrupt::checkpoint;
use gif::{DisposalMethod, Encoder, Frame, Repeat};
use std::borrow::Cow;
use std::collections::HashMap;
use tiny_skia::{Pixmap, PixmapPaint, Transform};

/// Number of colours in the palette. The index after the last colour (`UNCHANGED_INDEX`) marks unchanged pixels.
const PALETTE_COLORS: usize = 255;
const UNCHANGED_INDEX: u8 = PALETTE_COLORS as u8;

/// Distance below which colours are merged: the sum of the squared differences of the three channels (0 to 255).
const COLOR_DISTANCE: i32 = 48;

/// Number of layers that are kept in memory, because the next picture may use them as well.
const KEPT_LAYERS: usize = 8;

/// Limit on the search for the next item that two figures have in common. At most `2 * MAX_SHIFT - 1` items of both
/// figures together are skipped.
const MAX_SHIFT: usize = 12;

type Color = [u8; 3];

/// A part of a picture that differs from the previous picture: left, top, width and height, and the pixels.
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
    let mut painter = Painter { rasteriser: Rasterizer::new(), width, before: Vec::new(), layers: Vec::new() };
    let mut patches: Vec<Patch> = Vec::new();
    let mut last: Option<Vec<Color>> = None;
    let mut size = [0; 2];
    for (figure, delay) in figures {
        checkpoint();
        let picture = painter.paint(&figure)?;
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

/// Returns the smallest rectangle in which two pictures differ, or the whole picture if there is no previous one.
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

/// A painter that reuses the layers that a figure has in common with the figures before it.
struct Painter {
    rasteriser: Rasterizer,
    width: f64,
    before: Vec<Unit>,
    layers: Vec<(Vec<Unit>, Pixmap)>,
}

/// An item, and the rectangle to which it is cut.
#[derive(Clone, PartialEq)]
struct Unit {
    within: Option<Rect>,
    item: Item,
}

impl Painter {
    /// Draws the figure on its background.
    fn paint(&mut self, figure: &Figure) -> Result<Pixmap, DrawError> {
        let units = units(figure);
        let mut picture = ground(figure, self.width / figure.width)?;
        let mut begin = 0;
        for (end, is_same) in runs(&self.before, &units) {
            let run = &units[begin..end];
            begin = end;
            let layer = match self.layers.iter().position(|(kept, _)| kept == run) {
                Some(at) => self.layers.remove(at).1,
                None => self.layer(figure, run)?,
            };
            picture.draw_pixmap(0, 0, layer.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
            if is_same {
                self.layers.push((run.to_vec(), layer));
            }
        }
        let superfluous = self.layers.len().saturating_sub(KEPT_LAYERS);
        self.layers.drain(..superfluous);
        self.before = units;
        Ok(picture)
    }

    /// Draws some items on a transparent ground.
    fn layer(&self, figure: &Figure, run: &[Unit]) -> Result<Pixmap, DrawError> {
        let chunks = run.chunk_by(|a, b| a.within == b.within);
        let items = chunks.flat_map(|chunk| {
            let items: Vec<Item> = chunk.iter().map(|unit| unit.item.clone()).collect();
            chunk[0].within.map_or_else(|| items.clone(), |rect| vec![Item::Clip(rect, items.clone())])
        });
        let part = Figure { items: items.collect(), ..*figure };
        self.rasteriser.layer(&part, self.width / figure.width)
    }
}

/// Splits a figure into its single items.
fn units(figure: &Figure) -> Vec<Unit> {
    let mut units = Vec::new();
    for item in &figure.items {
        match item {
            Item::Clip(rect, items) => {
                units.extend(items.iter().map(|item| Unit { within: Some(*rect), item: item.clone() }));
            }
            item => units.push(Unit { within: None, item: item.clone() }),
        }
    }
    units
}

/// Splits the items into runs: runs of items that the previous figure also has, and runs of new items. Returns the end
/// of each run, and true if the previous figure has its items.
fn runs(before: &[Unit], now: &[Unit]) -> Vec<(usize, bool)> {
    let same = before.iter().zip(now).take_while(|(a, b)| a == b).count();
    let (old, new) = (&before[same..], &now[same..]);
    let tail = old.iter().rev().zip(new.iter().rev()).take_while(|(a, b)| a == b).count();
    let (old, new) = (&old[..old.len() - tail], &new[..new.len() - tail]);
    let mut is_same = vec![true; same];
    let (mut i, mut j) = (0, 0);
    while j < new.len() {
        let skips = (0..2 * MAX_SHIFT).flat_map(|sum| (0..=sum).map(move |a| (a, sum - a)));
        let meets = |&(a, b): &(usize, usize)| old.get(i + a).is_some_and(|unit| new.get(j + b) == Some(unit));
        let (a, b) = skips.into_iter().find(meets).unwrap_or((0, new.len() - j));
        is_same.extend(vec![false; b]);
        (i, j) = (i + a + 1, j + b + 1);
        if j <= new.len() {
            is_same.push(true);
        }
    }
    is_same.extend(vec![true; tail]);
    let mut end = 0;
    let chunks = is_same.chunk_by(|a, b| a == b);
    chunks
        .map(|chunk| {
            end += chunk.len();
            (end, chunk[0])
        })
        .collect()
}

fn distance(a: Color, b: Color) -> i32 {
    (0..3).map(|k| (i32::from(a[k]) - i32::from(b[k])).pow(2)).sum()
}

/// Returns the most frequent colours. Of similar colours, only one is included.
fn palette(patches: &[Patch]) -> Vec<Color> {
    let mut counts: HashMap<Color, usize> = HashMap::new();
    for color in patches.iter().flat_map(|patch| &patch.pixels) {
        *counts.entry(*color).or_default() += 1;
    }
    let mut colors: Vec<(usize, Color)> = counts.into_iter().map(|(color, count)| (count, color)).collect();
    // By frequency. Equally frequent colours are ordered by their values, since the order of the map is undefined.
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
    use crate::figure::Style;
    use cplan_theme::Rgb;

    fn unit(x: f64) -> Unit {
        Unit { within: None, item: Item::Disc([x, 0.0], 1.0, Style::fill(Rgb(0, 0, 0))) }
    }

    #[test]
    fn runs_restore_the_previous_picture() {
        let units = |all: &[f64]| -> Vec<Unit> { all.iter().map(|&x| unit(x)).collect() };
        let before = units(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(runs(&[], &before), [(6, false)]);
        assert_eq!(runs(&before, &before), [(6, true)]);
        assert_eq!(
            runs(&before, &units(&[1.0, 9.0, 3.0, 4.0, 8.0, 6.0])),
            [(1, true), (2, false), (4, true), (5, false), (6, true)]
        );
        assert_eq!(runs(&before, &units(&[1.0, 2.0, 7.0, 7.5, 3.0, 6.0])), [(2, true), (4, false), (6, true)]);
    }

    #[test]
    fn pictures_differ_where_they_differ() {
        let white = vec![[255; 3]; 12];
        let mut other = white.clone();
        (other[5], other[10]) = ([0; 3], [9; 3]);
        assert_eq!(differing_rectangle(Some(&white), &other, [4, 3]), Some([1, 1, 2, 2]));
        assert_eq!(differing_rectangle(Some(&white), &white, [4, 3]), None);
    }
}
