//! Boxes of configurations, of a subdivision or of a proof.

use super::axes::Frame;
use super::figure::{Item, Rect, Step, Style, rectangle};
use super::key::{Key, Sign};
use super::view::Chain;
use cplan_model::space::Configuration;
use cplan_theme::{EDGE, FREE, PROOF, UNDECIDED, WHITE};

/// Boxes narrower than this, in pixels, are drawn without sides, which would hide their colours.
const MIN_OUTLINED_WIDTH: f64 = 2.0;

fn rect([lower, upper]: [Configuration; 2], frame: &Frame) -> Rect {
    let ([x0, y0], [x1, y1]) = (frame.at(lower[0], lower[1]), frame.at(upper[0], upper[1]));
    Rect { x: x0.min(x1), y: y0.min(y1), width: (x1 - x0).abs(), height: (y1 - y0).abs() }
}

fn surface(boxes: &Chain, frame: &Frame, style: Style) -> Item {
    Item::Outline(boxes.pairs().flat_map(|b| rectangle(rect(b, frame))).collect(), style)
}

/// Draws free and undecided boxes as surfaces.
pub fn surfaces(free: &Chain, mixed: [&Chain; 2], frame: &Frame) -> Vec<Item> {
    let [mixed, rest] = mixed;
    let all = [(free, FREE), (mixed, UNDECIDED), (rest, UNDECIDED)];
    all.map(|(boxes, color)| surface(boxes, frame, Style::fill(color))).into()
}

/// Draws the sides of boxes.
pub fn sides(boxes: &Chain, frame: &Frame) -> Item {
    let rects = boxes
        .pairs()
        .map(|b| rect(b, frame))
        .filter(|r| r.width >= MIN_OUTLINED_WIDTH && r.height >= MIN_OUTLINED_WIDTH);
    Item::Outline(rects.flat_map(rectangle).collect(), Style::line(EDGE, 0.5))
}

/// Returns the legend of a subdivision.
pub fn keys() -> Vec<Key> {
    vec![(Sign::Swatch(FREE), "free boxes".to_owned()), (Sign::Swatch(UNDECIDED), "undecided boxes".to_owned())]
}

/// Horizontal distance between neighbouring lines of a hatch, in pixels.
const HATCH_DISTANCE: f64 = 7.0;

/// Draws the boxes of a proof over the C-obstacles. Only such boxes are hatched.
pub fn proof(boxes: &Chain, frame: &Frame) -> Vec<Item> {
    hatched(&boxes.pairs().map(|b| rect(b, frame)).collect::<Vec<_>>())
}

/// Draws hatched rectangles with their sides. The hatch lies on a translucent ground, which keeps it visible over any colour.
pub fn hatched(rects: &[Rect]) -> Vec<Item> {
    let sides: Vec<Step> = rects.iter().copied().flat_map(rectangle).collect();
    let lines: Vec<Step> = rects.iter().copied().flat_map(hatch).collect();
    vec![
        Item::Outline(sides.clone(), Style::fill(WHITE).faded(0.45)),
        Item::Outline(lines, Style::line(PROOF, 1.6)),
        Item::Outline(sides, Style::line(PROOF, 1.1)),
    ]
}

/// Returns lines that rise to the right, cut to a rectangle. They lie on the same lines for all rectangles, so hatches of
/// neighbours fit together.
fn hatch(rect: Rect) -> Vec<Step> {
    // On each line, x + y is a multiple of the distance.
    let (least, greatest) = (rect.x + rect.y, rect.right() + rect.bottom());
    let lines = (least / HATCH_DISTANCE).ceil() as i64..=(greatest / HATCH_DISTANCE).floor() as i64;
    let line = |k: i64| {
        let sum = k as f64 * HATCH_DISTANCE;
        let (left, right) = ((sum - rect.bottom()).max(rect.x), (sum - rect.y).min(rect.right()));
        [Step::Move([left, sum - left]), Step::Line([right, sum - right])]
    };
    lines.flat_map(line).collect()
}

/// Returns the legend of a proof.
pub fn proof_key() -> Key {
    (Sign::Hatched, "proof: separating boxes".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_of_a_proof_is_drawn_where_it_is() {
        let frame = Frame::filling(Rect { x: 0.0, y: 0.0, width: 100.0, height: 100.0 }, (0.0, 1.0), (0.0, 1.0));
        let boxes = Chain(vec![Configuration::new(0.25, 0.5), Configuration::new(0.5, 1.0)]);
        let items = proof(&boxes, &frame);
        let Some(Item::Outline(steps, style)) = items.last() else { panic!("not an outline") };
        assert_eq!(*steps, rectangle(Rect { x: 25.0, y: 0.0, width: 25.0, height: 50.0 }));
        assert_eq!(style.pen.map(|pen| pen.color), Some(PROOF));
    }

    /// Checks that a place is on the hatch of a rectangle if and only if it is in the rectangle and on one of the lines.
    #[test]
    fn a_hatch_fills_its_rectangle_and_goes_on_in_the_next() {
        for rect in [[3.0, 40.0, 31.0, 22.0], [34.0, 40.0, 2.0, 22.0], [0.0, 0.0, 7.0, 90.0]] {
            let [x, y, width, height] = rect;
            let rect = Rect { x, y, width, height };
            let mut length = 0.0;
            for pair in hatch(rect).chunks(2) {
                let [Step::Move(a), Step::Line(b)] = pair[..] else { panic!("{pair:?}") };
                for [x, y] in [a, b] {
                    let inside = x >= rect.x && x <= rect.right() && y >= rect.y && y <= rect.bottom();
                    assert!(inside && ((x + y) / HATCH_DISTANCE).fract().abs() < 1e-9, "{x} {y} in {rect:?}");
                }
                length += (b[0] - a[0]).hypot(b[1] - a[1]);
            }
            // The expected total length of lines at this distance, up to one line at each end.
            let expected = width * height / (HATCH_DISTANCE / std::f64::consts::SQRT_2);
            assert!((length - expected).abs() < 2.0 * width.min(height) + HATCH_DISTANCE, "{length} for {expected}");
        }
    }
}
