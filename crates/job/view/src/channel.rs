//! The channel of a cell decomposition: its cells, their centres, and the middles of the portals.

use super::axes::span;
use super::chart::Chart;
use super::figure::{Anchor, Item, Rect, Style, label, text_width};
use super::key::{Key, Sign};
use super::labels::{centered_rect, is_within, overlap};
use super::view::Chain;
use cplan_theme::{CHANNEL, EDGE, INK, WHITE};

/// Cells narrower than this, in pixels, are drawn with finer sides. Many normal sides would make a moiré pattern.
const NARROW_CELL: f64 = 5.0;
/// Radius of a point, in pixels.
const POINT_RADIUS: f64 = 3.0;
/// Height of the names of points, in pixels.
const NAME_SIZE: f64 = 11.0;
/// Largest number of cells of a channel whose points are named.
const MAX_NAMED_CELLS: usize = 24;

/// Draws the surface of the channel.
pub fn surface(cells: &[Chain], channel: &[usize], chart: &Chart) -> Item {
    let steps = channel.iter().filter_map(|&i| cells.get(i)).flat_map(|cell| chart.polygon(cell)).collect();
    Item::Outline(steps, Style::fill(CHANNEL).faded(0.75))
}

/// Draws the sides of all cells, and those of the channel over them.
pub fn sides(cells: &[Chain], channel: &[usize], chart: &Chart) -> Vec<Item> {
    let of = |cells: &[&Chain]| cells.iter().flat_map(|cell| chart.polygon(cell)).collect();
    let (wide, narrow): (Vec<&Chain>, Vec<&Chain>) = cells.iter().partition(|cell| is_wide(cell, chart));
    let passed: Vec<&Chain> =
        channel.iter().filter_map(|&i| cells.get(i)).filter(|cell| is_wide(cell, chart)).collect();
    vec![
        Item::Outline(of(&narrow), Style::line(EDGE, 0.3).faded(0.7)),
        Item::Outline(of(&wide), Style::line(EDGE, 0.7).faded(0.7)),
        Item::Outline(of(&passed), Style::line(EDGE.darker(0.3), 1.1)),
    ]
}

fn is_wide(Chain(corners): &Chain, chart: &Chart) -> bool {
    let (low, high) = span(corners.iter().map(|q| chart.frame.at(q[0], q[1])[0]));
    high - low >= NARROW_CELL
}

/// Draws centres of cells as discs, and middles of portals as rings. In a channel of at most [`MAX_NAMED_CELLS`] cells, they are
/// named `C1`, `Q1`, `C2` and so on; names that would cover a marker are omitted.
pub fn points([centers, middles]: [&Chain; 2], chart: &Chart) -> Vec<Item> {
    let places = |points: &Chain| points.0.iter().map(|&q| chart.place(q)).collect::<Vec<[f64; 2]>>();
    let (centers, middles) = (places(centers), places(middles));
    let mut items: Vec<Item> = centers.iter().map(|&at| disc(at)).chain(middles.iter().map(|&at| ring(at))).collect();
    if centers.len() > MAX_NAMED_CELLS {
        return items;
    }
    let mut taken: Vec<Rect> =
        centers.iter().chain(&middles).map(|&at| centered_rect(at, [2.0 * POINT_RADIUS; 2])).collect();
    let named = |letter: char, places: &[[f64; 2]]| -> Vec<(String, [f64; 2])> {
        places.iter().enumerate().map(|(k, &at)| (format!("{letter}{}", k + 1), at)).collect()
    };
    for (name, at) in named('Q', &middles).into_iter().chain(named('C', &centers)) {
        let size = [text_width(&name, NAME_SIZE) + 2.0, NAME_SIZE + 1.0];
        let around = [[1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [-1.0, 1.0]];
        let beside = |[x, y]: [f64; 2]| {
            centered_rect(
                [at[0] + x * (size[0] / 2.0 + POINT_RADIUS), at[1] + y * (size[1] / 2.0 + POINT_RADIUS)],
                size,
            )
        };
        let is_free = |place: &Rect| {
            is_within(place, &chart.frame.rect) && taken.iter().all(|other| overlap(place, other) == 0.0)
        };
        let Some(place) = around.map(beside).into_iter().find(is_free) else { continue };
        items.push(label([place.x + 1.0, place.bottom() - 2.0], name, NAME_SIZE, Anchor::Start, INK));
        taken.push(place);
    }
    items
}

fn disc(at: [f64; 2]) -> Item {
    Item::Disc(at, POINT_RADIUS, Style::line(WHITE, 0.8).filled(INK))
}

fn ring(at: [f64; 2]) -> Item {
    Item::Disc(at, POINT_RADIUS, Style::line(INK, 1.4).filled(WHITE))
}

/// Returns the sign in the legend for the middle of a portal if `is_middle`, otherwise for the centre of a cell.
pub fn sign(at: [f64; 2], is_middle: bool) -> Item {
    if is_middle { ring(at) } else { disc(at) }
}

/// Returns the legend of the points.
pub fn keys([centers, middles]: [&Chain; 2]) -> Vec<Key> {
    let center = (!centers.is_empty()).then(|| (Sign::Point { middle: false }, "centres of cells (C)".to_owned()));
    let middle = (!middles.is_empty()).then(|| (Sign::Point { middle: true }, "middles of doors (Q)".to_owned()));
    center.into_iter().chain(middle).collect()
}
