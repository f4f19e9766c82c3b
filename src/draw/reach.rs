//! Where the tip can get: cells of the workspace, and the solutions in the configuration space.

use super::axes::Frame;
use super::chart::Chart;
use super::color::Rgb;
use super::figure::{Item, Raster, Rect, Style};
use super::legend::{Key, Sign};
use crate::engine::{Access, Reach};

/// With one solution, with several, proven that none can be reached, blocked, unknown.
const LOOKS: [(Rgb, &str); 5] = [
    (Rgb(0xb5, 0xd9, 0xc2), "the tip can get there, one way"),
    (Rgb(0x5f, 0xae, 0x83), "with several solutions"),
    (Rgb(0xe8, 0xa1, 0x6b), "free, but proven out of reach"),
    (Rgb(0xe1, 0xe4, 0xe8), "not free"),
    (Rgb(0xc9, 0xa7, 0xdc), "unknown"),
];

fn look(access: Access, count: usize) -> usize {
    match (access, count) {
        (Access::Reachable, 1) => 0,
        (Access::Reachable, _) => 1,
        (Access::Unreachable, _) => 2,
        (Access::Blocked, _) => 3,
        (Access::Unknown, _) => 4,
    }
}

/// The cells of the workspace.
#[must_use]
pub fn in_workspace(reach: &Reach, frame: &Frame) -> Item {
    let [columns, rows] = reach.size;
    let mut levels = vec![None; columns * rows];
    for (place, access, count) in reach.best() {
        levels[place % columns * rows + place / columns] = Some(look(access, count));
    }
    let [left, bottom] = frame.at(reach.corner[0], reach.corner[1]);
    let [right, top] =
        frame.at(reach.corner[0] + reach.cell * columns as f64, reach.corner[1] + reach.cell * rows as f64);
    let rect = Rect { x: left, y: top, width: right - left, height: bottom - top };
    Item::Raster(Raster { rect, cells: reach.size, palette: LOOKS.map(|(color, _)| color).to_vec(), levels })
}

/// The solutions that are free, as dots.
#[must_use]
pub fn in_cspace(reach: &Reach, chart: &Chart) -> Vec<Item> {
    let free = reach.places.iter().flatten().filter(|solution| solution.access != Access::Blocked);
    let dot = |solution: &crate::engine::Solution| {
        let (color, _) = LOOKS[look(solution.access, 2)];
        Item::Disc(chart.place(solution.joints), 1.1, Style::fill(color))
    };
    free.map(dot).collect()
}

/// What the colours mean.
#[must_use]
pub fn keys(reach: &Reach) -> Vec<Key> {
    let is_there = |which: &usize| reach.best().any(|(_, access, count)| look(access, count) == *which);
    (0..LOOKS.len()).filter(is_there).map(|which| (Sign::Swatch(LOOKS[which].0), LOOKS[which].1.to_owned())).collect()
}
