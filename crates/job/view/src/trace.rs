//! The planner's trace: the part of the configuration space that it examined.

use super::chart::Chart;
use super::figure::{Anchor, Item, Pen, Raster, Rect, Style, chain, label, upwards};
use super::flow::FieldLines;
use super::key::{Key, Sign};
use super::view::{Chain, LEVELS, ScaleView, TraceView, Waves};
use super::{boxes, channel, wave_numbers};
use cplan_theme::{ACCENT, CHANNEL, EDGE, GRAY, INK, Rgb};

/// Number of colours of a wavefront; each stands for several levels.
const WAVE_SHADES: usize = 32;

/// Fraction of white that is mixed into the colours of surfaces, so that lines on them stay legible.
const WHITE_SHARE: f64 = 0.22;

/// Draws the surfaces, which lie under the C-obstacles.
pub fn items_below_obstacles(trace: &TraceView, chart: &Chart) -> Vec<Item> {
    match trace {
        TraceView::Channel { cells, channel, .. } => vec![channel::surface(cells, channel, chart)],
        TraceView::Boxes { free, mixed, rest, .. } => boxes::surfaces(free, [mixed, rest], &chart.frame),
        TraceView::Wavefront(waves) | TraceView::Field { values: Some(waves), .. } => {
            vec![Item::Raster(shades(waves, &chart.frame.rect))]
        }
        _ => Vec::new(),
    }
}

/// Draws lines and numbers, which lie over the C-obstacles. For a field, `field_lines` selects the lines.
pub fn items_above_obstacles(trace: &TraceView, field_lines: FieldLines, chart: &Chart) -> Vec<Item> {
    match trace {
        TraceView::Roadmap { edges: lines, .. } => vec![edges(lines, chart)],
        // There are many slices side by side, so each is faint.
        TraceView::Slices { free } => vec![faint_edges(free, chart, 0.5, 0.3)],
        TraceView::Roads { edges: lines, expanded, .. } => {
            [edges(lines, chart)].into_iter().chain(places(expanded, chart)).collect()
        }
        TraceView::Channel { cells, channel, expanded, sweep, .. } => {
            let [bottom, top] = [chart.frame.y.0, chart.frame.y.1];
            let line = sweep.map(|x| chain([chart.frame.at(x, bottom), chart.frame.at(x, top)], false));
            let line = line.map(|steps| Item::Outline(steps, Style::line(ACCENT, 2.0)));
            let sides = channel::sides(cells, channel, chart).into_iter();
            sides.chain(line).chain(places(expanded, chart)).collect()
        }
        TraceView::Boxes { free, stuck, mixed, .. } => {
            [free, stuck, mixed].map(|b| boxes::sides(b, &chart.frame)).into()
        }
        TraceView::Field { levels, flow, .. } => field_lines.items(levels, flow, chart),
        TraceView::Wavefront(waves) => wave_numbers::items(waves, &chart.frame.rect),
    }
}

/// Draws the centres of a channel's cells and the middles of its portals, which lie over the path.
pub fn items_above_path(trace: &TraceView, chart: &Chart) -> Vec<Item> {
    match trace {
        TraceView::Channel { centers, middles, .. } => channel::points([centers, middles], chart),
        _ => Vec::new(),
    }
}

fn edges(lines: &Chain, chart: &Chart) -> Item {
    faint_edges(lines, chart, 0.7, 0.6)
}

/// Draws lines of this width in pixels and this opacity.
fn faint_edges(lines: &Chain, chart: &Chart, width: f64, opacity: f64) -> Item {
    let steps = lines.pairs().flat_map(|line| chart.outline(&line)).collect();
    Item::Outline(steps, Style::line(EDGE, width).faded(opacity))
}

/// Draws the places that a search expanded: the earlier, the darker.
fn places(expanded: &Chain, chart: &Chart) -> impl Iterator<Item = Item> {
    let last = expanded.0.len().saturating_sub(1).max(1) as f64;
    let shade = move |k: usize| cplan_theme::scale(k as f64 / last);
    expanded.0.iter().enumerate().map(move |(k, &q)| Item::Disc(chart.place(q), 2.2, Style::fill(shade(k)).faded(0.8)))
}

/// Returns the legend of the trace. For a field, it explains the selected lines.
pub fn keys(trace: &TraceView, field_lines: FieldLines) -> Vec<Key> {
    let line = |color| Sign::Line(Pen { color, width: 1.0, dash: &[] });
    match trace {
        TraceView::Roadmap { whole, .. } => {
            let extent = if *whole { "" } else { ", as far as searched" };
            vec![(line(EDGE), format!("reduced visibility graph{extent}"))]
        }
        TraceView::Slices { free } if free.is_empty() => Vec::new(),
        TraceView::Slices { .. } => vec![(line(EDGE), "slices that the path passes".to_owned())],
        TraceView::Channel { channel, expanded, centers, middles, .. } => {
            let found = (!channel.is_empty()).then(|| (Sign::Swatch(CHANNEL), "channel".to_owned()));
            let cells = [(line(EDGE), "cells".to_owned())].into_iter().chain(found);
            cells.chain(channel::keys([centers, middles])).chain(order(expanded)).collect()
        }
        TraceView::Roads { expanded, visibility, .. } => {
            let name = visibility.map_or_else(|| "roadmap".to_owned(), |graph| format!("{graph} visibility graph"));
            [(line(EDGE), name)].into_iter().chain(order(expanded)).collect()
        }
        TraceView::Boxes { .. } => boxes::keys(),
        TraceView::Wavefront(_) => Vec::new(),
        TraceView::Field { .. } => field_lines.keys(),
    }
}

/// Returns the legend of the colours of expanded places.
fn order(expanded: &Chain) -> Vec<Key> {
    let key = |part, text: &str| (Sign::Shade(part), text.to_owned());
    if expanded.is_empty() { Vec::new() } else { vec![key(0.0, "expanded first"), key(1.0, "expanded last")] }
}

/// Draws the scale of colours, to the right of the frame.
pub fn color_bar(scale: &ScaleView, frame: &Rect) -> Vec<Item> {
    let ScaleView { title, ends: [top, bottom], soft } = scale;
    let white = if *soft { WHITE_SHARE } else { 0.0 };
    let (x, height) = (frame.right() + 16.0, frame.height.min(200.0));
    let rect = Rect { x, y: frame.bottom() - height, width: 12.0, height };
    vec![
        Item::Raster(Raster {
            rect,
            cells: [1, WAVE_SHADES],
            palette: palette(white),
            levels: (0..WAVE_SHADES).map(Some).collect(),
        }),
        label([x + 18.0, rect.y + 10.0], top.as_str(), 13.0, Anchor::Start, GRAY),
        label([x + 18.0, rect.bottom()], bottom.as_str(), 13.0, Anchor::Start, GRAY),
        upwards([x + 30.0, rect.y + height / 2.0], *title, 13.0, INK),
    ]
}

fn palette(white: f64) -> Vec<Rgb> {
    (0..WAVE_SHADES).map(|k| cplan_theme::scale(k as f64 / (WAVE_SHADES - 1) as f64).lighter(white)).collect()
}

fn shades(waves: &Waves, frame: &Rect) -> Raster {
    let [width, height] = [waves.extent[0] * frame.width, waves.extent[1] * frame.height];
    let rect = Rect { x: frame.x, y: frame.bottom() - height, width, height };
    let levels = waves.levels().map(|level| level.map(|level| level * WAVE_SHADES / LEVELS)).collect();
    Raster { rect, cells: waves.blocks, palette: palette(WHITE_SHARE), levels }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_channel_is_explained_only_where_there_is_one() {
        let names = |channel: Vec<usize>| -> Vec<String> {
            let trace = TraceView::Channel {
                cells: Vec::new(),
                channel,
                centers: Chain::default(),
                middles: Chain::default(),
                expanded: Chain::default(),
                sweep: None,
            };
            keys(&trace, FieldLines::default()).into_iter().map(|key| key.1).collect()
        };
        assert_eq!(names(vec![0]), ["cells", "channel"]);
        assert_eq!(names(Vec::new()), ["cells"]);
    }
}
