//! Random robots whose bases have several parts: plates, posts, combs, rings, columns at the axis. They are shapes of
//! the root, or of links that fixed joints hang from it.

use cplan::geometry::{Convex, Point};
use cplan_cases::dice::Dice;
use cplan_testkit::solid::{Solid, V};
use std::fmt::Write;

/// Position of joint 2 on link 1, metres.
pub const ELBOW: f64 = 0.5;

/// The link to which a shape belongs: the base, link 1, link 2.
pub type Group = usize;

/// A shape with a vertical axis.
#[derive(Debug, Clone)]
pub struct Shape {
    pub group: Group,
    /// Outline in the frame of the group, whose origin is at the joint that moves it.
    pub solid: Solid,
    pub heights: [f64; 2],
    /// The element `<collision>`.
    text: String,
}

impl Shape {
    fn boxed(group: Group, [x, y]: V, [a, b]: V, heights: [f64; 2]) -> Self {
        let corner = |s: f64, t: f64| Point::new(x + s * a / 2.0, y + t * b / 2.0);
        let corners = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let size = format!("<box size=\"{a} {b} {}\"/>", heights[1] - heights[0]);
        Self::of(group, Convex::new(corners, 0.0).unwrap(), [x, y], &size, heights)
    }

    fn post(group: Group, at: V, radius: f64, heights: [f64; 2]) -> Self {
        let size = format!("<cylinder radius=\"{radius}\" length=\"{}\"/>", heights[1] - heights[0]);
        Self::of(group, Convex::new(vec![Point::new(at[0], at[1])], radius).unwrap(), at, &size, heights)
    }

    fn of(group: Group, outline: Convex, [x, y]: V, size: &str, heights: [f64; 2]) -> Self {
        let middle = f64::midpoint(heights[0], heights[1]);
        let text = format!("<collision> <origin xyz=\"{x} {y} {middle}\"/> <geometry> {size} </geometry> </collision>");
        Self { group, solid: Solid::new(&outline), heights, text }
    }

    /// Returns true if the heights of two shapes overlap by more than rounding.
    pub fn shares_heights(&self, other: &Self) -> bool {
        self.heights[0].max(other.heights[0]) + 1e-6 < self.heights[1].min(other.heights[1])
    }
}

/// A robot whose two joints turn about vertical axes.
#[derive(Debug)]
pub struct Robot {
    pub shapes: Vec<Shape>,
    /// Ranges of the two joints; for a continuous one, a whole turn.
    pub ranges: [[f64; 2]; 2],
    pub urdf: String,
}

/// Rounds to millimetres, so that the file says the same number.
fn millimetres(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

/// Draws heights. There are few, so that shapes often share them, and sometimes rest on each other.
fn heights(dice: &mut Dice) -> [f64; 2] {
    let low = dice.below(3_usize);
    let high = low + 1 + dice.below(2_usize);
    [low, high].map(|level| 0.1 * level as f64)
}

/// Draws a part of a base: some shapes near joint 1.
fn base_part(dice: &mut Dice) -> Vec<Shape> {
    let heights = heights(dice);
    let far = |dice: &mut Dice, low: f64, high: f64| {
        let (out, angle) = (dice.within(low, high), dice.within(-3.2, 3.2));
        [angle.cos(), angle.sin()].map(|c| millimetres(out * c))
    };
    match dice.below(6_u64) {
        0 => vec![Shape::post(0, [0.0, 0.0], millimetres(dice.within(0.03, 0.12)), heights)],
        1 => {
            let size = [0, 1].map(|_| millimetres(dice.within(0.1, 2.2)));
            vec![Shape::boxed(0, far(dice, 0.0, 0.6), size, heights)]
        }
        2 => vec![Shape::post(0, far(dice, 0.15, 0.9), millimetres(dice.within(0.01, 0.06)), heights)],
        3 => {
            let [x, y] = far(dice, 0.2, 0.7);
            let tooth = |k: i32| Shape::boxed(0, [x, millimetres(y + 0.12 * f64::from(k))], [0.2, 0.03], heights);
            (-1..=1).map(tooth).collect()
        }
        4 => {
            let (out, count) = (dice.within(0.3, 0.95), 3 + dice.below(5_usize));
            let post = |k: usize| {
                let angle = 6.3 * k as f64 / count as f64;
                Shape::post(0, [angle.cos(), angle.sin()].map(|c| millimetres(out * c)), 0.03, heights)
            };
            (0..count).map(post).collect()
        }
        _ => vec![Shape::boxed(0, [0.0, 0.0], [2.5, 2.5], heights)],
    }
}

/// Draws the shapes of a link: a bar from near its joint, and sometimes a box or a quill.
fn link(dice: &mut Dice, group: Group, length: f64) -> Vec<Shape> {
    let (begins, at) = ([-0.05, 0.0, 0.02][dice.below(3_usize)], heights(dice));
    let bar = Shape::boxed(group, [millimetres(f64::midpoint(begins, length)), 0.0], [length - begins, 0.08], at);
    let mut shapes = vec![bar];
    if dice.chance(0.4) {
        shapes.push(Shape::boxed(group, [millimetres(dice.within(0.0, length)), 0.06], [0.1, 0.06], heights(dice)));
    }
    if dice.chance(0.4) {
        shapes.push(Shape::post(group, [length, 0.0], 0.03, heights(dice)));
    }
    shapes
}

impl Robot {
    /// Draws a robot.
    pub fn drawn(dice: &mut Dice) -> Self {
        let parts: Vec<Vec<Shape>> = (0..1 + dice.below(3_usize)).map(|_| base_part(dice)).collect();
        let links = [link(dice, 1, ELBOW), link(dice, 2, 0.4)];
        let text = |shapes: &[Shape]| shapes.iter().map(|shape| shape.text.as_str()).collect::<String>();
        let hung = (0..parts.len()).map(|_| dice.chance(0.5)).collect::<Vec<_>>();
        let root: String = parts.iter().zip(&hung).filter(|(_, hung)| !**hung).map(|(part, _)| text(part)).collect();
        let mut urdf = format!("<robot name=\"drawn\"> <link name=\"root\"> {root} </link>\n");
        let mut above = "root".to_owned();
        for (number, part) in parts.iter().enumerate().filter(|(number, _)| hung[*number]) {
            let parent = if dice.chance(0.5) { "root" } else { &above };
            writeln!(
                urdf,
                "<joint name=\"f{number}\" type=\"fixed\"> <parent link=\"{parent}\"/> <child link=\"part{number}\"/> </joint>\n\
                 <link name=\"part{number}\"> {} </link>",
                text(part)
            )
            .unwrap();
            above = format!("part{number}");
        }
        let carrier = if dice.chance(0.5) { "root".to_owned() } else { above };
        let ranges = [0, 1].map(|_| {
            let (middle, half) = (dice.within(-1.0, 1.0), dice.within(0.3, 2.9));
            dice.chance(0.8).then(|| [millimetres(middle - half), millimetres(middle + half)])
        });
        for (number, range) in ranges.iter().enumerate() {
            let limit = range.map_or("continuous\">".to_owned(), |[low, high]| {
                format!("revolute\"> <limit lower=\"{low}\" upper=\"{high}\" velocity=\"1\" effort=\"1\"/>")
            });
            let (parent, x) = if number == 0 { (carrier.as_str(), 0.0) } else { ("link1", ELBOW) };
            writeln!(
                urdf,
                "<joint name=\"j{number}\" type=\"{limit} <parent link=\"{parent}\"/> <child link=\"link{}\"/> \
                 <origin xyz=\"{x} 0 0\"/> <axis xyz=\"0 0 1\"/> </joint>\n<link name=\"link{}\"> {} </link>",
                number + 1,
                number + 1,
                text(&links[number])
            )
            .unwrap();
        }
        urdf += "</robot>";
        let shapes = parts.into_iter().chain(links).flatten().collect();
        let turn = std::f64::consts::PI;
        Self { shapes, ranges: ranges.map(|range| range.unwrap_or([-turn, turn])), urdf }
    }
}
