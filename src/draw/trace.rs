//! What the planner saw on its way.

use super::axes::Frame;
use super::boxes;
use super::color::{self, GREY, INK, PALE, Rgb};
use super::copies::Window;
use super::figure::{Anchor, Item, Label, Pen, Raster, Rect, Style, chain};
use super::isolines::Samples;
use super::legend::{Key, Sign};
use crate::planner::Trace;
use crate::space::{Configuration, Topology};
use std::borrow::Cow;

/// Cells along an axis that a wavefront is coarsened to: nearly a pixel and a half each.
const CELLS: usize = 192;
/// Colours of a wavefront.
const SHADES: usize = 32;
/// How many equipotentials are drawn.
const LINES: usize = 20;
/// Part of the cells that may lie below the lowest equipotential: the field goes on falling in dead ends that no one
/// asks about, and would leave no lines for the rest.
const TAIL: f64 = 0.02;
/// The same for a potential that grows without bound towards obstacles.
const SLOPES: f64 = 0.15;

const EDGE: Rgb = Rgb(0x7d, 0x8f, 0xa6);
/// Part of white in the colours of surfaces, on which lines must stay legible.
const SOFT: f64 = 0.22;
const CHANNEL: Rgb = Rgb(0xf6, 0xe3, 0xa1);

/// What lies under the C-obstacles: surfaces.
#[must_use]
pub fn below(trace: &Trace, frame: &Frame, window: &Window) -> Vec<Item> {
    match trace {
        Trace::Channel { cells, channel } => {
            let steps = channel.iter().filter_map(|&i| cells.get(i)).flat_map(|c| polygon(c, frame, window)).collect();
            vec![Item::Outline(steps, Style::fill(CHANNEL).faded(0.75))]
        }
        Trace::Boxes { free, mixed, .. } => boxes::surfaces(free, mixed, frame),
        Trace::Wavefront { cells, labels } => {
            Waves::new(*cells, labels).map(|waves| Item::Raster(shades(&waves, frame))).into_iter().collect()
        }
        _ => Vec::new(),
    }
}

/// What lies over the C-obstacles: lines.
#[must_use]
pub fn above(trace: &Trace, frame: &Frame, topology: &Topology, window: &Window) -> Vec<Item> {
    match trace {
        Trace::Roadmap { edges, .. } | Trace::Slices { free: edges } => {
            let pieces = edges.iter().flat_map(|edge| window.pieces(edge));
            let steps = pieces.flat_map(|p| chain(p.iter().map(|q| frame.at(q[0], q[1])), false)).collect();
            vec![Item::Outline(steps, Style::line(EDGE, 0.7).faded(0.6))]
        }
        Trace::Channel { cells, .. } => {
            let steps = cells.iter().flat_map(|c| polygon(c, frame, window)).collect();
            vec![Item::Outline(steps, Style::line(EDGE, 0.7).faded(0.7))]
        }
        Trace::Boxes { free, stuck, mixed } => [free, stuck, mixed].map(|b| boxes::sides(b, frame)).into(),
        Trace::Field { .. } | Trace::Harmonic { .. } | Trace::Potential { .. } => {
            Slope::new(trace, topology).map_or_else(Vec::new, |slope| equipotentials(&slope, frame))
        }
        Trace::Wavefront { .. } => Vec::new(),
    }
}

/// Legend of the trace.
#[must_use]
pub fn keys(trace: &Trace) -> Vec<Key> {
    let line = |color| Sign::Line(Pen { color, width: 1.0, dash: &[] });
    match trace {
        Trace::Roadmap { whole, .. } => {
            let extent = if *whole { "" } else { ", as far as searched" };
            vec![(line(EDGE), format!("visibility graph{extent}"))]
        }
        Trace::Slices { .. } => vec![(line(EDGE), "slices that the path passes".to_owned())],
        Trace::Channel { channel, .. } => {
            let found = (!channel.is_empty()).then(|| (Sign::Swatch(CHANNEL), "channel".to_owned()));
            [(line(EDGE), "cells".to_owned())].into_iter().chain(found).collect()
        }
        Trace::Boxes { .. } => boxes::keys(),
        Trace::Wavefront { .. } => Vec::new(),
        Trace::Field { .. } | Trace::Harmonic { .. } | Trace::Potential { .. } => {
            vec![(line(color::scale(0.5)), "equipotentials".to_owned())]
        }
    }
}

/// The scale of colours, to the right of the frame.
#[must_use]
pub fn color_bar(trace: &Trace, frame: &Frame) -> Vec<Item> {
    let (title, top, bottom) = match trace {
        Trace::Wavefront { labels, .. } => match farthest(labels) {
            Some(steps) => ("steps to the goal", steps.to_string(), "0".to_owned()),
            None => return Vec::new(),
        },
        Trace::Field { .. } | Trace::Harmonic { .. } => match trace.logarithms().and_then(|(_, ln)| span(&ln, TAIL)) {
            Some((low, high)) => ("ln of the potential", short(low), short(high)),
            None => return Vec::new(),
        },
        Trace::Potential { heights, .. } => match span(&depths(heights), SLOPES) {
            Some((low, high)) => ("potential", format!("{:.2}", -low), format!("{:.2}", -high)),
            None => return Vec::new(),
        },
        Trace::Roadmap { .. } | Trace::Slices { .. } | Trace::Channel { .. } | Trace::Boxes { .. } => {
            return Vec::new();
        }
    };
    let (x, height) = (frame.rect.right() + 16.0, frame.rect.height.min(200.0));
    let rect = Rect { x, y: frame.rect.bottom() - height, width: 12.0, height };
    let palette = palette(if matches!(trace, Trace::Wavefront { .. }) { SOFT } else { 0.0 });
    let label = |at, text, upwards| {
        let (anchor, color) = if upwards { (Anchor::Middle, INK) } else { (Anchor::Start, GREY) };
        Item::Text(Label { at, text, size: 13.0, anchor, upwards, color })
    };
    vec![
        Item::Raster(Raster { rect, cells: [1, SHADES], palette, levels: (0..SHADES).map(Some).collect() }),
        label([x + 18.0, rect.y + 10.0], top, false),
        label([x + 18.0, rect.bottom()], bottom, false),
        label([x + 30.0, rect.y + height / 2.0], title.to_owned(), true),
    ]
}

fn palette(white: f64) -> Vec<Rgb> {
    (0..SHADES).map(|k| color::scale(k as f64 / (SHADES - 1) as f64).lighter(white)).collect()
}

fn short(value: f64) -> String {
    format!("{value:.0}").replace('-', "\u{2212}").replace("\u{2212}0", "0")
}

fn polygon(corners: &[Configuration], frame: &Frame, window: &Window) -> Vec<super::figure::Step> {
    let copy = |s: Configuration| chain(corners.iter().map(move |q| frame.at(q[0] + s[0], q[1] + s[1])), true);
    window.shifts(corners).into_iter().flat_map(copy).collect()
}

fn farthest(labels: &[u32]) -> Option<u32> {
    labels.iter().copied().filter(|&l| l != u32::MAX).max()
}

/// A wavefront coarse enough to be drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Waves {
    /// Number of blocks of cells along each axis.
    pub blocks: [usize; 2],
    /// How much of the axis they cover: blocks may stick out beyond the last cell.
    pub extent: [f64; 2],
    /// Of each block its least label, as a part of the greatest of all; none where the wave did not come.
    pub parts: Vec<Option<f64>>,
    /// The greatest label.
    pub farthest: u32,
}

impl Waves {
    /// The wavefront with these labels; none where there are no labels.
    pub fn new(cells: [usize; 2], labels: &[u32]) -> Option<Self> {
        if labels.is_empty() || labels.len() != cells[0] * cells[1] {
            return None;
        }
        let farthest = farthest(labels).unwrap_or(0);
        let block = cells.map(|n| n.div_ceil(CELLS).max(1));
        let blocks = [0, 1].map(|k| cells[k].div_ceil(block[k]));
        let mut least = vec![u32::MAX; blocks[0] * blocks[1]];
        for (index, &label) in labels.iter().enumerate() {
            let at = index / cells[1] / block[0] * blocks[1] + index % cells[1] / block[1];
            least[at] = least[at].min(label);
        }
        let part = |label: u32| (label != u32::MAX).then(|| f64::from(label) / f64::from(farthest.max(1)));
        Some(Self {
            blocks,
            extent: [0, 1].map(|k| (blocks[k] * block[k]) as f64 / cells[k] as f64),
            parts: least.into_iter().map(part).collect(),
            farthest,
        })
    }
}

fn shades(waves: &Waves, frame: &Frame) -> Raster {
    let [width, height] = waves.extent;
    let rect = Rect {
        x: frame.rect.x,
        y: frame.rect.bottom() - height * frame.rect.height,
        width: width * frame.rect.width,
        height: height * frame.rect.height,
    };
    let shade = |part: f64| (part * (SHADES - 1) as f64).round() as usize;
    let levels = waves.parts.iter().map(|part| part.map(shade)).collect();
    Raster { rect, cells: waves.blocks, palette: palette(SOFT), levels }
}

/// What rises towards the goal where `heights` fall.
fn depths(heights: &[f64]) -> Vec<f64> {
    heights.iter().map(|height| -height).collect()
}

/// The values between which equipotentials are drawn; `tail` is the part of the cells below them.
fn span(potential: &[f64], tail: f64) -> Option<(f64, f64)> {
    let mut known: Vec<f64> = potential.iter().copied().filter(|v| v.is_finite()).collect();
    known.sort_by(f64::total_cmp);
    let low = *known.get((known.len() as f64 * tail) as usize)?;
    Some((low, *known.last()?))
}

/// A field that paths follow upwards, coarse enough to be drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Slope {
    /// The values at the points of a coarse grid.
    pub samples: Samples,
    /// The values between which equipotentials are drawn.
    pub span: (f64, f64),
}

impl Slope {
    /// The slope that a field planner followed; none of other planners, and where the field has no values.
    pub fn new(trace: &Trace, topology: &Topology) -> Option<Self> {
        let (cells, values, tail) = match trace {
            Trace::Potential { cells, heights } => (*cells, Cow::Owned(depths(heights)), SLOPES),
            _ => {
                let (cells, ln) = trace.logarithms()?;
                (cells, ln, TAIL)
            }
        };
        if values.len() != cells[0] * cells[1] {
            return None;
        }
        Some(Self { span: span(&values, tail)?, samples: samples(cells, &values, topology) })
    }

    /// Lines at equal distances of values, each set with its place in the span: 0 at the goal, 1 at the far end.
    pub fn equipotentials(&self) -> impl Iterator<Item = (f64, Vec<Vec<[f64; 2]>>)> + '_ {
        let (low, high) = self.span;
        let part = |k: usize| (k as f64 + 0.5) / LINES as f64;
        (0..LINES).map(part).map(move |part| (part, self.samples.isolines(high + (low - high) * part)))
    }
}

fn equipotentials(slope: &Slope, frame: &Frame) -> Vec<Item> {
    let set = |(part, lines): (f64, Vec<Vec<[f64; 2]>>)| {
        let steps = lines.iter().flat_map(|l| chain(l.iter().map(|p| frame.at(p[0], p[1])), false)).collect();
        Item::Outline(steps, Style::line(color::scale(part).mixed(PALE.darker(0.4), 0.15), 1.1))
    };
    slope.equipotentials().map(set).collect()
}

/// The potential at the centres of every cell, or of some on a fine grid; on a circle once more beyond each seam, so
/// that lines go on across it.
fn samples(cells: [usize; 2], potential: &[f64], topology: &Topology) -> Samples {
    const MOST: usize = 256;
    let [x, y] = [0, 1].map(|k| {
        let axis = topology.ranges[k];
        let (n, extent) = (cells[k], axis.extent());
        let place = |i: usize| axis.domain().0 + (i as f64 + 0.5) / n as f64 * extent;
        let mut all: Vec<(usize, f64)> = (0..n).step_by(n.div_ceil(MOST).max(1)).map(|i| (i, place(i))).collect();
        if let (true, Some(&first), Some(&last)) = (axis.is_circle(), all.first(), all.last()) {
            all.insert(0, (last.0, last.1 - extent));
            all.push((first.0, first.1 + extent));
        }
        all
    });
    Samples {
        values: x.iter().flat_map(|a| y.iter().map(move |b| potential[a.0 * cells[1] + b.0])).collect(),
        x: x.into_iter().map(|a| a.1).collect(),
        y: y.into_iter().map(|b| b.1).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::JointRange;

    fn frame() -> Frame {
        Frame::filling(Rect { x: 0.0, y: 0.0, width: 100.0, height: 100.0 }, (0.0, 1.0), (0.0, 1.0))
    }

    #[test]
    fn a_fine_wavefront_is_coarsened_and_keeps_narrow_passages() {
        let cells = [401, 390];
        // Only one row of cells was reached.
        let labels: Vec<u32> = (0..cells[0] * cells[1])
            .map(|k| if k % cells[1] == 200 { (k / cells[1]) as u32 } else { u32::MAX })
            .collect();
        let raster = shades(&Waves::new(cells, &labels).unwrap(), &frame());
        assert_eq!(raster.cells, [134, 130]);
        assert_eq!(raster.levels.iter().flatten().count(), 134);
        assert_eq!(raster.levels[200 / 3], Some(0));
        assert_eq!(raster.levels[133 * 130 + 200 / 3], Some(SHADES - 1));
    }

    #[test]
    fn lines_cross_the_seam_of_a_circle() {
        let topology = Topology { ranges: [JointRange::Circle, JointRange::Interval { lower: 0.0, upper: 1.0 }] };
        let cells = [8, 4];
        let potential: Vec<f64> = (0..32).map(|k| f64::from(k % 4)).collect();
        let all = samples(cells, &potential, &topology);
        assert_eq!((all.x.len(), all.y.len()), (10, 4));
        let lines = all.isolines(1.5);
        assert_eq!(lines.len(), 1);
        let [from, to] = [lines[0][0][0], lines[0][lines[0].len() - 1][0]];
        assert!(from.min(to) < -std::f64::consts::PI && from.max(to) > std::f64::consts::PI);
    }

    #[test]
    fn a_channel_is_explained_only_where_there_is_one() {
        let names = |channel: Vec<usize>| -> Vec<String> {
            keys(&Trace::Channel { cells: [].into(), channel }).into_iter().map(|key| key.1).collect()
        };
        assert_eq!(names(vec![0]), ["cells", "channel"]);
        assert_eq!(names(Vec::new()), ["cells"]);
    }

    #[test]
    fn a_field_without_values_has_no_lines() {
        let topology = Topology { ranges: [JointRange::Circle; 2] };
        let trace = Trace::Field { cells: [4, 4], potential: vec![f64::NEG_INFINITY; 16] };
        assert_eq!(Slope::new(&trace, &topology), None);
        assert_eq!(span(&[f64::NEG_INFINITY, -3.0, 0.0], TAIL), Some((-3.0, 0.0)));
    }
}
