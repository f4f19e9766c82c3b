//! Names on their shapes, or beside shapes that are too small. No name covers another.

use super::axes::Frame;
use super::figure::{Anchor, Item, Rect, Style, label, rectangle, shortened, text_width};
use super::tags::overlap;
use super::view::bounding_box;
use cplan_core::model::Shape;
use cplan_geometry::Convex;
use cplan_theme::{INK, WHITE};

const NAME_SIZE: f64 = 12.0;
/// Greatest width of a name, in pixels.
const MAX_NAME_WIDTH: f64 = 160.0;
/// Height of a name's box, in pixels.
const NAME_HEIGHT: f64 = 15.0;
/// Distance between a name's box and the shape beside it, in pixels.
const NAME_GAP: f64 = 4.0;
/// Side of the square in the middle of a wall that the wall's name refers to, in pixels.
const WALL_SPOT_SIDE: f64 = 10.0;
/// Largest fraction of a named area that its name may cover.
const MAX_COVERED_SHARE: f64 = 0.5;

/// Places for a name relative to its object, in the order of preference: on it, above, below, beside it, at its
/// corners.
const NAME_PLACES: [[f64; 2]; 9] =
    [[0.0, 0.0], [0.0, -1.0], [0.0, 1.0], [1.0, 0.0], [-1.0, 0.0], [1.0, -1.0], [-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// A name, and the box of the shape that it names.
pub type Named = (String, Rect);

/// Draws the names within `page` for which there is room. Earlier names choose their places first.
#[must_use]
pub fn items(page: &Rect, names: &[Named]) -> Vec<Item> {
    let mut taken: Vec<Rect> = Vec::new();
    let mut items = Vec::new();
    for (name, of) in names {
        let name = shortened(name, NAME_SIZE, MAX_NAME_WIDTH);
        let size = size(&name);
        let middle = [of.x + of.width / 2.0, of.y + of.height / 2.0];
        let fits = size[0] <= of.width && size[1] <= of.height;
        let boxes = NAME_PLACES.into_iter().skip(usize::from(!fits)).map(|side: [f64; 2]| {
            let away = [0, 1].map(|k| side[k] * (size[k] / 2.0 + NAME_GAP + [of.width, of.height][k] / 2.0));
            centered_rect([middle[0] + away[0], middle[1] + away[1]], size)
        });
        let is_free = |b: &Rect| is_free(b, &taken, page);
        // It is better to hide a part of a large shape than the whole of a small one.
        let share =
            |b: &Rect, other: &Rect| overlap(b, other) / (other.width * other.height).max(NAME_HEIGHT * NAME_HEIGHT);
        let hidden = |b: &Rect| {
            let others = names.iter().map(|(_, place)| place).filter(|place| *place != of);
            others.map(|place| share(b, place)).sum::<f64>()
        };
        let Some(best) = boxes.filter(is_free).min_by(|a, b| hidden(a).total_cmp(&hidden(b))) else { continue };
        items.extend(text(name, best));
        taken.push(best);
    }
    items
}

/// Draws names centred at places, each with the area of the named shape in square pixels. Leaves out a name that would
/// cover its own shape, another name, or one of the `markers`.
#[must_use]
pub fn shape_labels(
    page: &Rect,
    markers: Vec<Rect>,
    names: impl IntoIterator<Item = (String, [f64; 2], f64)>,
) -> Vec<Item> {
    let mut taken = markers;
    let mut items = Vec::new();
    for (name, at, area) in names {
        let name = shortened(&name, NAME_SIZE, MAX_NAME_WIDTH);
        let size = size(&name);
        let place = moved_into_page(centered_rect(at, size), page);
        if size[0] * size[1] <= MAX_COVERED_SHARE * area && is_free(&place, &taken, page) {
            items.extend(text(name, place));
            taken.push(place);
        }
    }
    items
}

/// Returns the box to which the name of a shape refers. It is the box around the whole shape, or for a wall a square in
/// the middle of its longest stretch.
pub fn place<'a>(frame: &Frame, shape: &Shape, pieces: impl IntoIterator<Item = &'a Convex>) -> Rect {
    if let Shape::Polyline(points) = shape {
        let longest = points.windows(2).max_by(|a, b| (a[1] - a[0]).norm().total_cmp(&(b[1] - b[0]).norm()));
        if let Some([a, b]) = longest {
            return centered_rect(frame.at((a.x + b.x) / 2.0, (a.y + b.y) / 2.0), [WALL_SPOT_SIDE; 2]);
        }
    }
    let [x, y] = bounding_box(pieces);
    let ([left, bottom], [right, top]) = (frame.at(x.0, y.0), frame.at(x.1, y.1));
    Rect { x: left, y: top, width: right - left, height: bottom - top }
}

/// Returns a rectangle of this size, centred at a place.
pub fn centered_rect([x, y]: [f64; 2], [width, height]: [f64; 2]) -> Rect {
    Rect { x: x - width / 2.0, y: y - height / 2.0, width, height }
}

/// Returns the box for the name of a line that comes from `from` and ends at `tip`. The box lies beyond that end.
pub fn label_box_beyond(name: &str, tip: [f64; 2], from: [f64; 2]) -> Rect {
    let away = [tip[0] - from[0], tip[1] - from[1]];
    let length = away[0].hypot(away[1]).max(f64::MIN_POSITIVE);
    let size = size(name);
    centered_rect([0, 1].map(|k| tip[k] + away[k] / length * (size[k] / 2.0 + 2.0 * NAME_GAP)), size)
}

/// Moves a box by the least distance that brings it into the page.
fn moved_into_page(place: Rect, page: &Rect) -> Rect {
    let x = place.x.min(page.right() - place.width).max(page.x);
    let y = place.y.min(page.bottom() - place.height).max(page.y);
    Rect { x, y, ..place }
}

fn size(name: &str) -> [f64; 2] {
    [text_width(name, NAME_SIZE) + 6.0, NAME_HEIGHT]
}

fn is_free(place: &Rect, taken: &[Rect], page: &Rect) -> bool {
    taken.iter().all(|other| overlap(place, other) == 0.0) && overlap(place, page) > 0.999 * place.width * place.height
}

fn text(name: String, place: Rect) -> [Item; 2] {
    let at = [place.x + place.width / 2.0, place.bottom() - 3.5];
    let paper = Item::Outline(rectangle(place), Style::fill(WHITE).faded(0.7));
    [paper, label(at, name, NAME_SIZE, Anchor::Middle, INK)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: Rect = Rect { x: 0.0, y: 0.0, width: 300.0, height: 300.0 };

    fn texts(items: &[Item]) -> Vec<String> {
        let text = |item: &'_ Item| if let Item::Text(label) = item { Some(label.text.clone()) } else { None };
        items.iter().filter_map(text).collect()
    }

    #[test]
    fn names_that_cover_what_they_name_or_each_other_are_left_out() {
        let names = [
            ("wide".to_owned(), [100.0, 100.0], 5000.0),
            ("over it".to_owned(), [110.0, 104.0], 5000.0),
            ("small".to_owned(), [200.0, 200.0], 300.0),
            ("pushed".to_owned(), [299.0, 20.0], 5000.0),
            ("marked".to_owned(), [50.0, 250.0], 5000.0),
        ];
        let marker = centered_rect([60.0, 252.0], [14.0; 2]);
        assert_eq!(texts(&shape_labels(&PAGE, vec![marker], names)), ["wide", "pushed"]);
    }

    #[test]
    fn the_name_of_an_arm_lies_beyond_its_tip() {
        for from in [[100.0, 150.0], [150.0, 250.0], [190.0, 100.0]] {
            let place = label_box_beyond("start", [150.0, 150.0], from);
            let middle = [place.x + place.width / 2.0, place.y + place.height / 2.0];
            let toward = (middle[0] - 150.0) * (150.0 - from[0]) + (middle[1] - 150.0) * (150.0 - from[1]);
            assert!(toward > 0.0 && overlap(&place, &centered_rect([150.0, 150.0], [1.0, 1.0])) == 0.0, "{place:?}");
        }
    }

    #[test]
    fn names_are_placed_beside_smaller_shapes() {
        let place = centered_rect([150.0, 150.0], [10.0, 10.0]);
        let items = items(&PAGE, &[("bottle".to_owned(), place)]);
        let Some(Item::Outline(steps, _)) = items.first() else { panic!("no paper") };
        let paper = centered_rect([150.0, 150.0 - 5.0 - NAME_GAP - NAME_HEIGHT / 2.0], size("bottle"));
        assert_eq!(*steps, rectangle(paper));
    }
}
