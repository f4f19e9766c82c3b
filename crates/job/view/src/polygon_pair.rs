//! Pictures of two polygons and their Minkowski difference.

use super::axes::{Frame, Unit, span};
use super::figure::{Anchor, Figure, Item, Rect, Style, bold, chain, label};
use super::key::{Key, Sign};
use super::page;
use cplan_geometry::Point;
use cplan_theme::{INK, Rgb, obstacle};

/// Ratio of height to width of both panels together.
const PROPORTION: f64 = 0.48;
/// Height of the titles of the panels, pixels.
const TITLE_HEIGHT: f64 = 18.0;
/// Distance between the panels, pixels.
const PANEL_GAP: f64 = 70.0;
/// Margin on each side of the polygons, as a fraction of their extent.
const MARGIN_SHARE: f64 = 0.08;
/// Largest number of corners of a polygon that are drawn with their names.
const MAX_NAMED_CORNERS: usize = 24;

/// Two polygons and their Minkowski difference.
#[derive(Debug, Clone, PartialEq)]
pub struct PolygonPair<'a> {
    /// The first line is the title; the others follow in smaller type.
    pub title: Vec<String>,
    /// Corners of the polygon that moves.
    pub a: &'a [Point],
    /// Corners of the obstacle.
    pub b: &'a [Point],
    /// Polygons whose union is `b - a`.
    pub difference: &'a [Vec<Point>],
}

/// Draws two polygons on the left, and their difference with the origin on the right.
pub fn polygon_pair(pair: &PolygonPair) -> Figure {
    let [a, b, difference] = [0, 1, 2].map(obstacle);
    let keys: Vec<Key> = [(a, "A"), (b, "B"), (difference, "B \u{2212} A")]
        .map(|(color, name)| (Sign::Swatch(color), name.to_owned()))
        .to_vec();
    page::single_panel_page(&pair.title, keys, PROPORTION, |area| {
        let area = Rect { y: area.y + TITLE_HEIGHT, height: area.height - TITLE_HEIGHT, ..area };
        let width = (area.width - PANEL_GAP) / 2.0;
        let [left, right] = [area.x, area.x + width + PANEL_GAP].map(|x| Rect { x, width, ..area });
        let mut items = panel(left, "A and B", &[(pair.b, b), (pair.a, a)], &[]);
        let frame = frame(left, &[pair.a, pair.b]);
        items.extend(
            [("a", pair.a), ("b", pair.b)].into_iter().flat_map(|(name, corners)| names(&frame, name, corners)),
        );
        let parts: Vec<(&[Point], Rgb)> = pair.difference.iter().map(|part| (part.as_slice(), difference)).collect();
        items.extend(panel(
            right,
            "B \u{2212} A: A meets B if A\u{2019}s origin is in this area",
            &parts,
            &[Point::zeros()],
        ));
        items
    })
}

/// Returns a frame around all points.
fn frame(area: Rect, polygons: &[&[Point]]) -> Frame {
    let sides = [0, 1].map(|k| span(polygons.iter().flat_map(|polygon| polygon.iter()).map(|p| p[k])));
    let size = sides.iter().map(|side| side.1 - side.0).fold(f64::MIN_POSITIVE, f64::max);
    let [x, y] = sides.map(|(low, high)| (low - MARGIN_SHARE * size, high + MARGIN_SHARE * size));
    Frame::filling(area, x, y)
}

/// Draws a titled panel with coloured polygons and points.
fn panel(area: Rect, title: &str, polygons: &[(&[Point], Rgb)], points: &[Point]) -> Vec<Item> {
    let outlines: Vec<&[Point]> = polygons.iter().map(|(corners, _)| *corners).chain([points]).collect();
    let frame = frame(area, &outlines);
    let mut items = frame.grid([Unit::Meters; 2]);
    let place = |p: &Point| frame.at(p.x, p.y);
    for (corners, color) in polygons {
        let outline = chain(corners.iter().map(place), true);
        items.push(Item::Outline(outline.clone(), Style::fill(*color).faded(0.45)));
        items.push(Item::Outline(outline, Style::line(*color, 1.6)));
    }
    for point in points {
        let at = place(point);
        items.push(Item::Disc(at, 4.0, Style::fill(INK)));
        items.push(label([at[0] + 7.0, at[1] - 6.0], "origin", 13.0, Anchor::Start, INK));
    }
    let mut items = vec![Item::Clip(frame.rect, items)];
    items.extend(frame.border([Unit::Meters; 2], ["x", "y"].map(str::to_owned), [false; 2]));
    items.push(bold([frame.rect.x, frame.rect.y - 8.0], title, 13.0, Anchor::Start, INK));
    items
}

fn names(frame: &Frame, name: &str, corners: &[Point]) -> Vec<Item> {
    let text = |(i, p): (usize, &Point)| {
        let [x, y] = frame.at(p.x, p.y);
        label([x + 4.0, y - 4.0], format!("{name}{}", i + 1), 12.0, Anchor::Start, INK)
    };
    let is_few = corners.len() <= MAX_NAMED_CORNERS;
    corners.iter().enumerate().filter(|_| is_few).map(text).collect()
}
