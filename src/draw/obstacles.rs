//! Obstacles alone, before there is an arm.

use super::axes::{Frame, Range, Unit};
use super::color::{self, INK, WHITE};
use super::figure::{Anchor, Item, Rect, Spot, Style, label, rectangle, shortened, text_width};
use super::legend::{Key, Sign};
use super::tags::overlap;
use super::view::{Grain, ObstacleView, around};
use super::{page, shapes, svg_writer};
use crate::model::{Obstacle, Shape};
use crate::text::markup;

/// Share of the extent that is left free on each side.
const MARGIN: f64 = 0.04;

/// Obstacles as an SVG document, the largest drawn first, each named where there is room. Those of a group, as `groups` says for each,
/// share a colour. The first line is the title.
#[must_use]
pub fn obstacles(title: &[String], obstacles: &[Obstacle], groups: &[&str]) -> String {
    let mut known: Vec<&str> = Vec::new();
    let mut colors = Vec::with_capacity(obstacles.len());
    for group in groups {
        colors.push(known.iter().position(|name| name == group).unwrap_or_else(|| {
            known.push(group);
            known.len() - 1
        }));
    }
    let sides = extent(obstacles);
    let lengths = sides.map(|(low, high)| high - low);
    let size = lengths.into_iter().fold(f64::MIN_POSITIVE, f64::max);
    let [x, y] = sides.map(|(low, high)| (low - MARGIN * size, high + MARGIN * size));
    let mut order: Vec<usize> = (0..obstacles.len()).collect();
    let areas: Vec<f64> =
        obstacles.iter().map(|obstacle| obstacle.pieces.iter().map(|piece| piece.area()).sum()).collect();
    order.sort_by(|&i, &j| areas[j].total_cmp(&areas[i]));
    let keys = known.iter().enumerate().map(|(i, name)| (Sign::Swatch(color::obstacle(i)), (*name).to_owned()));
    let keys: Vec<Key> = keys.take(MOST_KEYS).collect();
    svg_writer::write(&page::alone(title, keys, (y.1 - y.0) / (x.1 - x.0), |area| {
        let frame = Frame::filling(area, x, y);
        let view = |&i: &usize| ObstacleView::new(&obstacles[i], colors[i], Grain::within(size));
        let mut items = frame.grid([Unit::Meters; 2]);
        items.extend(order.iter().map(|i| shapes::solid(&frame, &view(i))));
        items.extend(names(&frame, obstacles));
        let mut items = vec![Item::Clip(frame.rect, items)];
        items.extend(frame.border([Unit::Meters; 2], ["x (m)", "y (m)"].map(str::to_owned), [false; 2]));
        items
    }))
}

/// More colours than this are not explained.
const MOST_KEYS: usize = 32;
/// More obstacles than this are not named: nobody could tell whose the names are.
const MOST_NAMES: usize = 200;
const SIZE: f64 = 12.0;
/// Widest name, pixels.
const WIDEST: f64 = 160.0;
/// Height of a name's box, and its distance from the obstacle that it stands beside, pixels.
const LINE: f64 = 15.0;
const GAP: f64 = 4.0;

/// Names on their obstacles or, where those are smaller, beside them; none over another.
fn names(frame: &Frame, obstacles: &[Obstacle]) -> Vec<Item> {
    if obstacles.len() > MOST_NAMES {
        return Vec::new();
    }
    let places: Vec<Rect> = obstacles.iter().map(|obstacle| place(frame, obstacle)).collect();
    let mut taken: Vec<Rect> = Vec::new();
    let mut items = Vec::new();
    for (obstacle, of) in obstacles.iter().zip(&places) {
        let name = shortened(&obstacle.name, SIZE, WIDEST);
        let size = [text_width(&name, SIZE) + 6.0, LINE];
        let middle = [of.x + of.width / 2.0, of.y + of.height / 2.0];
        let beside = [
            [0.0, 0.0],
            [0.0, -1.0],
            [0.0, 1.0],
            [1.0, 0.0],
            [-1.0, 0.0],
            [1.0, -1.0],
            [-1.0, -1.0],
            [1.0, 1.0],
            [-1.0, 1.0],
        ];
        let fits = size[0] <= of.width && size[1] <= of.height;
        let boxes = beside.into_iter().skip(usize::from(!fits)).map(|side: Spot| {
            let away = [0, 1].map(|k| side[k] * (size[k] / 2.0 + GAP + [of.width, of.height][k] / 2.0));
            Rect {
                x: middle[0] + away[0] - size[0] / 2.0,
                y: middle[1] + away[1] - size[1] / 2.0,
                width: size[0],
                height: size[1],
            }
        });
        let is_free = |b: &Rect| {
            taken.iter().all(|other| overlap(b, other) == 0.0) && overlap(b, &frame.rect) > 0.999 * b.width * b.height
        };
        // What is smaller than the obstacle is hidden last.
        let hidden = |b: &Rect| {
            places.iter().filter(|place| *place != of).map(|place| overlap(b, place).min(400.0)).sum::<f64>()
        };
        let Some(best) = boxes.filter(is_free).min_by(|a, b| hidden(a).total_cmp(&hidden(b))) else { continue };
        items.push(Item::Outline(rectangle(best), Style::fill(WHITE).faded(0.7)));
        let at = [best.x + best.width / 2.0, best.bottom() - 3.5];
        items.push(label(at, name, SIZE, Anchor::Middle, INK));
        taken.push(best);
    }
    items
}

/// What an obstacle's name belongs to, pixels: all of it, or the middle of a wall's longest stretch.
fn place(frame: &Frame, obstacle: &Obstacle) -> Rect {
    if let Shape::Polyline(points) = &obstacle.shape {
        let longest = points.windows(2).max_by(|a, b| (a[1] - a[0]).norm().total_cmp(&(b[1] - b[0]).norm()));
        if let Some([a, b]) = longest {
            let [x, y] = frame.at((a.x + b.x) / 2.0, (a.y + b.y) / 2.0);
            return Rect { x, y, width: 0.0, height: 0.0 };
        }
    }
    let [x, y] = around(&obstacle.pieces);
    let ([left, bottom], [right, top]) = (frame.at(x.0, y.0), frame.at(x.1, y.1));
    Rect { x: left, y: top, width: right - left, height: bottom - top }
}

/// Least and greatest coordinates of obstacles.
#[must_use]
pub fn extent(obstacles: &[Obstacle]) -> [Range; 2] {
    around(obstacles.iter().flat_map(|obstacle| &obstacle.pieces))
}

/// A page that shows an SVG document.
#[must_use]
pub fn still_page(title: &str, svg: &str) -> String {
    let title = markup(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{title}</title>\n</head>\n\
         <body>\n{svg}\n</body>\n</html>\n"
    )
}
