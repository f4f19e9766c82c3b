//! Pictures of obstacles alone, without an arm.

use super::axes::{Frame, Range, Unit};
use super::figure::{Figure, Item};
use super::key::{Key, Sign};
use super::labels::Placer;
use super::named::Named;
use super::view::{ObstacleView, RoundingSteps, bounding_box};
use super::{page, shapes};
use cplan_model::Obstacle;
use cplan_text::markup;

/// Margin on each side of the obstacles, as a fraction of their extent.
const MARGIN_SHARE: f64 = 0.04;

/// Draws obstacles, the largest first, with their names if there is room. Obstacles of the same group have the same colour;
/// `groups` has the group of each. The first line of `title` is the title.
pub fn obstacles(title: &[String], obstacles: &[Obstacle], groups: &[&str]) -> Figure {
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
    let [x, y] = sides.map(|(low, high)| (low - MARGIN_SHARE * size, high + MARGIN_SHARE * size));
    let mut order: Vec<usize> = (0..obstacles.len()).collect();
    let areas: Vec<f64> =
        obstacles.iter().map(|obstacle| obstacle.pieces.iter().map(|piece| piece.area()).sum()).collect();
    order.sort_by(|&i, &j| areas[j].total_cmp(&areas[i]));
    let keys = known.iter().enumerate().map(|(i, name)| (Sign::Swatch(cplan_theme::obstacle(i)), (*name).to_owned()));
    let keys: Vec<Key> = keys.take(MAX_KEYS).collect();
    page::single_panel_page(title, keys, (y.1 - y.0) / (x.1 - x.0), |area| {
        let frame = Frame::filling(area, x, y);
        let view = |&i: &usize| ObstacleView::new(&obstacles[i], colors[i], RoundingSteps::within(size));
        let mut items = frame.grid([Unit::Meters; 2]);
        items.extend(order.iter().map(|i| shapes::solid(&frame, &view(i))));
        items.extend(names(&frame, obstacles));
        let mut items = vec![Item::Clip(frame.rect, items)];
        items.extend(frame.border([Unit::Meters; 2], ["x (m)", "y (m)"].map(str::to_owned), [false; 2]));
        items
    })
}

/// Largest number of entries of the legend.
const MAX_KEYS: usize = 32;
/// Largest number of obstacles whose names are drawn. More names could not be told apart.
const MAX_NAMES: usize = 200;
/// Draws names on their obstacles or beside them.
fn names(frame: &Frame, obstacles: &[Obstacle]) -> Vec<Item> {
    if obstacles.len() > MAX_NAMES {
        return Vec::new();
    }
    let named = |o: &Obstacle| Named::of_shape(o.name.clone(), frame, &o.shape, &o.pieces);
    let mut placer = Placer::new(frame.rect);
    placer.beside(&obstacles.iter().map(named).collect::<Vec<_>>());
    placer.into_items()
}

/// Returns the least and greatest coordinates of obstacles.
pub fn extent(obstacles: &[Obstacle]) -> [Range; 2] {
    bounding_box(obstacles.iter().flat_map(|obstacle| &obstacle.pieces))
}

/// Returns a page that shows a figure.
pub fn still_page(title: &str, figure: &Figure) -> String {
    let (title, svg) = (markup(title), figure.svg());
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{title}</title>\n</head>\n\
         <body>\n{svg}\n</body>\n</html>\n"
    )
}
