//! Numbers beside places. As far as there is room, no number covers another.

use super::figure::{Anchor, Item, Rect, Style, label, rectangle, shortened, text_width};
use super::view::ranges;
use cplan_theme::{INK, WHITE};

const TEXT_SIZE: f64 = 12.0;
/// Greatest width of a text, in pixels.
const MAX_TEXT_WIDTH: f64 = 96.0;
/// Height of a number's box, in pixels.
const LINE_HEIGHT: f64 = 15.0;
/// Distance in pixels below which places have one box for their numbers.
const SHARED_BOX_DISTANCE: f64 = 4.0;
/// Distance from a place to the nearest side of its number's box, in pixels. It leaves room for the marker at the
/// place.
const BOX_GAP: f64 = 9.0;

/// Directions from a place to its number's box, in the order of preference.
const BOX_DIRECTIONS: [[f64; 2]; 8] =
    [[1.0, -1.0], [-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [1.0, 0.0], [-1.0, 0.0], [0.0, -1.0], [0.0, 1.0]];

/// Possible distances of the box as multiples of [`BOX_GAP`], each with its extra cost. All costs are in square pixels
/// of covered shapes. The extra cost of the wider gap is less than that of covering two square pixels of a number.
const GAP_CHOICES: [(f64, f64); 2] = [(1.0, 0.0), (2.6, 12.0)];
/// Extra cost of each direction compared with the one before it. Any small value works. It only makes the numbers in a
/// row of places take the same side.
const SIDE_COST: f64 = 1.0;
/// Cost of covering a square pixel of a number or a place, or of leaving the page by one.
const HIDING_COST: f64 = 8.0;
/// Cost of covering one sampled point of a line. The points are some pixels apart.
const LINE_SPOT_COST: f64 = 4.0;

/// Steps that end at one place.
#[derive(Debug, Clone, PartialEq)]
pub struct Tag {
    /// The place at which the steps end.
    pub at: [f64; 2],
    /// Their numbers, each once.
    pub numbers: Vec<usize>,
}

/// Adds the number of a step at a place. A number that is already there is not added again.
pub fn add(tags: &mut Vec<Tag>, at: [f64; 2], number: usize) {
    match tags.iter_mut().find(|tag| (tag.at[0] - at[0]).hypot(tag.at[1] - at[1]) < SHARED_BOX_DISTANCE) {
        Some(tag) if tag.numbers.contains(&number) => {}
        Some(tag) => tag.numbers.push(number),
        None => tags.push(Tag { at, numbers: vec![number] }),
    }
}

/// Draws the numbers in boxes. Each box lies on the side of its place where it covers the least. Covering other numbers
/// or places, or leaving the page, counts more than covering `shapes`, or lines through the points `spots`.
#[must_use]
pub fn items(tags: &[Tag], within: Rect, shapes: &[Rect], spots: &[[f64; 2]]) -> Vec<Item> {
    let mut taken: Vec<Rect> = tags.iter().map(|tag| centered_rect(tag.at, [8.0, 8.0])).collect();
    let mut items = Vec::new();
    for tag in tags {
        let text = shortened(&ranges(&tag.numbers), TEXT_SIZE, MAX_TEXT_WIDTH);
        let size = [text_width(&text, TEXT_SIZE) + 6.0, LINE_HEIGHT];
        let boxes = GAP_CHOICES.iter().flat_map(|&(ring, extra)| {
            BOX_DIRECTIONS.iter().zip(0..).map(move |(side, index)| {
                // Diagonal boxes may come nearer, because only their corner faces the place.
                let gap = ring * if side[0] != 0.0 && side[1] != 0.0 { 0.6 * BOX_GAP } else { BOX_GAP };
                let middle = [0, 1].map(|k| tag.at[k] + side[k] * (size[k] / 2.0 + gap));
                (centered_rect(middle, size), extra + SIDE_COST * f64::from(index))
            })
        });
        let covered = |b: &Rect, others: &[Rect]| others.iter().map(|other| overlap(b, other)).sum::<f64>();
        let cost = |(b, extra): &(Rect, f64)| {
            let outside = b.width * b.height - overlap(b, &within);
            let lines = spots.iter().filter(|s| (b.x..b.right()).contains(&s[0]) && (b.y..b.bottom()).contains(&s[1]));
            HIDING_COST * (covered(b, &taken) + outside)
                + covered(b, shapes)
                + LINE_SPOT_COST * lines.count() as f64
                + extra
        };
        let best = boxes.min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let Some((place, _)) = best else { continue };
        items.push(Item::Outline(rectangle(place), Style::fill(WHITE).faded(0.8)));
        let at = [place.x + place.width / 2.0, place.bottom() - 3.5];
        items.push(label(at, text, TEXT_SIZE, Anchor::Middle, INK));
        taken.push(place);
    }
    items
}

fn centered_rect([x, y]: [f64; 2], [width, height]: [f64; 2]) -> Rect {
    Rect { x: x - width / 2.0, y: y - height / 2.0, width, height }
}

/// Returns the common area in square pixels.
pub fn overlap(a: &Rect, b: &Rect) -> f64 {
    let width = a.right().min(b.right()) - a.x.max(b.x);
    let height = a.bottom().min(b.bottom()) - a.y.max(b.y);
    width.max(0.0) * height.max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxes(items: &[Item]) -> Vec<Rect> {
        let texts = items.iter().filter_map(|item| match item {
            Item::Text(label) => Some((label.at, text_width(&label.text, TEXT_SIZE))),
            _ => None,
        });
        texts.map(|([x, y], width)| Rect { x: x - width / 2.0, y: y - 10.0, width, height: 11.0 }).collect()
    }

    #[test]
    fn each_place_has_a_single_box() {
        let mut tags = Vec::new();
        for (x, number) in [(50.0, 1), (51.0, 2), (50.0, 1), (90.0, 3), (50.5, 7)] {
            add(&mut tags, [x, 50.0], number);
        }
        assert_eq!(tags.iter().map(|tag| tag.numbers.clone()).collect::<Vec<_>>(), [vec![1, 2, 7], vec![3]]);
    }

    #[test]
    fn boxes_of_crowded_places_keep_apart_and_inside() {
        let page = Rect { x: 0.0, y: 0.0, width: 300.0, height: 300.0 };
        let mut tags = Vec::new();
        for number in 0..12 {
            add(&mut tags, [2.0 + 34.0 * (number % 4) as f64, 4.0 + 30.0 * (number / 4) as f64], number);
        }
        let boxes = boxes(&items(&tags, page, &[], &[]));
        assert_eq!(boxes.len(), 12);
        for (i, a) in boxes.iter().enumerate() {
            assert!((overlap(a, &page) - a.width * a.height).abs() < 1e-9, "{a:?} sticks out");
            assert!(boxes[i + 1..].iter().all(|b| overlap(a, b) == 0.0), "{a:?} is covered");
        }
    }

    #[test]
    fn boxes_stay_off_shapes_where_there_is_room() {
        let page = Rect { x: 0.0, y: 0.0, width: 300.0, height: 300.0 };
        let shape = centered_rect([100.0, 100.0], [26.0, 26.0]);
        let tags = [Tag { at: [100.0, 100.0], numbers: vec![3] }];
        let beside = |shapes: &[Rect]| boxes(&items(&tags, page, shapes, &[]))[0];
        assert!(overlap(&beside(&[]), &shape) > 0.0);
        assert_eq!(overlap(&beside(&[shape]), &shape), 0.0);
    }
}
