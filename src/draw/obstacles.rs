//! Obstacles alone, before there is an arm.

use super::axes::{Frame, Range, Unit};
use super::figure::Item;
use super::legend;
use super::view::{Grain, ObstacleView, around};
use super::{page, shapes, svg_writer};
use crate::model::Obstacle;
use crate::text::markup;

/// Share of the extent that is left free on each side.
const MARGIN: f64 = 0.04;

/// Obstacles as an SVG document, named while they are few. The first line is the title.
#[must_use]
pub fn obstacles(title: &[String], obstacles: &[Obstacle]) -> String {
    let sides = extent(obstacles);
    let size = sides.iter().map(|(low, high)| high - low).fold(f64::MIN_POSITIVE, f64::max);
    let [x, y] = sides.map(|(low, high)| (low - MARGIN * size, high + MARGIN * size));
    let views = obstacles.iter().enumerate().map(|(i, obstacle)| ObstacleView::new(obstacle, i, Grain::within(size)));
    let views: Vec<ObstacleView> = views.collect();
    svg_writer::write(&page::alone(title, legend::obstacles(views.iter()), |area| {
        let frame = Frame::filling(area, x, y);
        let mut items = frame.grid([Unit::Meters; 2]);
        items.extend(views.iter().map(|obstacle| shapes::solid(&frame, obstacle)));
        let mut items = vec![Item::Clip(frame.rect, items)];
        items.extend(frame.border([Unit::Meters; 2], ["x (m)", "y (m)"].map(str::to_owned), [false; 2]));
        items
    }))
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
