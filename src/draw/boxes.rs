//! Boxes of configurations: what a subdivision is made of, and what a proof consists of.

use super::axes::Frame;
use super::color::{BARRED, INK, Rgb};
use super::figure::{Item, Rect, Style, rectangle};
use super::legend::{Key, Sign};
use super::view::Chain;
use crate::space::Configuration;

const FREE: Rgb = Rgb(0xcf, 0xe8, 0xd5);
const MIXED: Rgb = Rgb(0xf6, 0xe3, 0xa1);
const SIDE: Rgb = Rgb(0x7d, 0x8f, 0xa6);

/// Boxes narrower than this have no sides drawn, pixels: the lines would hide all else.
const NARROW: f64 = 2.0;

fn rect([lower, upper]: [Configuration; 2], frame: &Frame) -> Rect {
    let ([x0, y0], [x1, y1]) = (frame.at(lower[0], lower[1]), frame.at(upper[0], upper[1]));
    Rect { x: x0.min(x1), y: y0.min(y1), width: (x1 - x0).abs(), height: (y1 - y0).abs() }
}

fn surface(boxes: &Chain, frame: &Frame, style: Style) -> Item {
    Item::Outline(boxes.pairs().flat_map(|b| rectangle(rect(b, frame))).collect(), style)
}

/// Free and undecided boxes, as surfaces.
#[must_use]
pub fn surfaces(free: &Chain, mixed: [&Chain; 2], frame: &Frame) -> Vec<Item> {
    let [mixed, rest] = mixed;
    let all = [(free, FREE), (mixed, MIXED), (rest, MIXED)];
    all.map(|(boxes, color)| surface(boxes, frame, Style::fill(color).faded(0.8))).into()
}

/// The sides of boxes.
#[must_use]
pub fn sides(boxes: &Chain, frame: &Frame) -> Item {
    let rects = boxes.pairs().map(|b| rect(b, frame)).filter(|r| r.width >= NARROW && r.height >= NARROW);
    Item::Outline(rects.flat_map(rectangle).collect(), Style::line(SIDE, 0.4).faded(0.6))
}

/// Legend of a subdivision.
#[must_use]
pub fn keys() -> Vec<Key> {
    vec![(Sign::Swatch(FREE), "free boxes".to_owned()), (Sign::Swatch(MIXED), "undecided boxes".to_owned())]
}

/// The boxes of a proof, over the C-obstacles.
#[must_use]
pub fn proof(boxes: &Chain, frame: &Frame) -> Item {
    surface(boxes, frame, Style::line(BARRED.mixed(INK, 0.2), 0.9).filled(BARRED).faded(0.45))
}

/// Legend of a proof.
#[must_use]
pub fn proof_key() -> Key {
    (Sign::Swatch(BARRED), "proof: separating boxes".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_of_a_proof_is_drawn_where_it_is() {
        let frame = Frame::filling(Rect { x: 0.0, y: 0.0, width: 100.0, height: 100.0 }, (0.0, 1.0), (0.0, 1.0));
        let boxes = Chain(vec![Configuration::new(0.25, 0.5), Configuration::new(0.5, 1.0)]);
        let Item::Outline(steps, style) = proof(&boxes, &frame) else { panic!("not an outline") };
        assert_eq!(steps, rectangle(Rect { x: 25.0, y: 0.0, width: 25.0, height: 50.0 }));
        assert_eq!(style.fill, Some(BARRED));
    }
}
