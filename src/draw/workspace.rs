//! The left panel: the workspace, with the arm in it.

use super::axes::{Frame, Range, Unit};
use super::color::{self, GREY, INK, PALE, Rgb, WHITE};
use super::figure::{Anchor, Item, Label, Rect, Step, Style, chain};
use super::{Picture, page, preferences};
use crate::geometry::{Convex, Point, cross};
use crate::model::{Arm, Motion, Obstacle, Plane, Shape};
use crate::space::{Configuration, Path};
use nalgebra::Vector3;

/// Poses shown between start and goal.
const GHOSTS: usize = 5;
/// Configurations along each axis from which the extent of the arm's motion is read.
const SAMPLES: usize = 17;

/// The panel in this part of the page, which it fills.
#[must_use]
pub fn panel(picture: &Picture, area: Rect) -> Vec<Item> {
    let arm = &picture.scene.arm;
    let obstacles = &picture.scene.workspace.obstacles;
    let frame = frame(picture, area);
    let mut inside = frame.grid([Unit::Meters; 2]);
    let reach = Style::line(PALE, 1.0).dashed(&[2.0, 4.0]);
    inside.push(Item::Outline(outline(&frame, &reach_shape(arm)), reach));
    for (i, obstacle) in obstacles.iter().enumerate() {
        inside.push(obstacle_item(&frame, obstacle, color::obstacle(i)));
    }
    inside.extend(preferences::in_workspace(&picture.scene.workspace.preferences, &frame));
    if let [(_, path)] = picture.paths[..] {
        for q in between(path, GHOSTS) {
            inside.extend(arm_items(&frame, arm, q, &GHOST));
        }
    }
    inside.extend(arm_items(&frame, arm, picture.start, &START));
    let goal = picture.paths.first().map(|(_, path)| path.goal()).or(picture.goals.first().copied());
    inside.extend(goal.into_iter().flat_map(|q| arm_items(&frame, arm, q, &GOAL)));
    inside.extend(page::path_items(picture.paths.iter().map(|(_, path)| tip_trace(&frame, arm, path)).collect()));
    inside.extend(hidden_note(&frame, obstacles));
    let mut items = vec![Item::Clip(frame.rect, inside)];
    items.extend(frame.border([Unit::Meters; 2], titles(&arm.plane), [false; 2]));
    items
}

/// The plane's coordinates are named after the root frame's axes if they run along them.
fn titles(plane: &Plane) -> [String; 2] {
    const ALONG: f64 = 0.9999;
    let name = |v: Vector3<f64>, other: &str| {
        let axis = ["x", "y", "z"].into_iter().zip(v.iter()).find(|(_, part)| **part > ALONG);
        format!("{} (m)", axis.map_or(other, |(name, _)| name))
    };
    [name(plane.u, "u"), name(plane.v, "v")]
}

/// Shows all that the arm can sweep, and of the obstacles what is not much farther away.
#[must_use]
pub fn frame(picture: &Picture, area: Rect) -> Frame {
    /// Part of the swept extent up to which the panel grows for the sake of obstacles.
    const NEARBY: f64 = 0.25;
    const MARGIN: f64 = 0.04;
    let swept = swept(picture);
    let size = (swept[0].1 - swept[0].0).max(swept[1].1 - swept[1].0);
    let mut shown = swept;
    for corners in picture.scene.workspace.obstacles.iter().map(extent) {
        let near = [0, 1]
            .map(|k| (corners[k].0.max(swept[k].0 - NEARBY * size), corners[k].1.min(swept[k].1 + NEARBY * size)));
        if near.iter().all(|(lower, upper)| lower <= upper) {
            shown = [0, 1].map(|k| (shown[k].0.min(near[k].0), shown[k].1.max(near[k].1)));
        }
    }
    let [x, y] = shown.map(|(lower, upper)| (lower - MARGIN * size, upper + MARGIN * size));
    Frame::filling(area, x, y)
}

/// The box around the arm in a sample of its configurations, which are dense enough for a picture.
fn swept(picture: &Picture) -> [Range; 2] {
    let arm = &picture.scene.arm;
    let mut bounds = [(f64::INFINITY, f64::NEG_INFINITY); 2];
    let mut include = |p: Point, r: f64| {
        for k in 0..2 {
            bounds[k] = (bounds[k].0.min(p[k] - r), bounds[k].1.max(p[k] + r));
        }
    };
    include(arm.base, 0.0);
    let [first, second] = arm.topology().axes.map(|axis| {
        let (lower, upper) = axis.domain();
        (0..SAMPLES).map(move |i| lower + (upper - lower) * i as f64 / (SAMPLES - 1) as f64)
    });
    let sampled = first.flat_map(|q1| second.clone().map(move |q2| Configuration::new(q1, q2)));
    let shown = [picture.start].into_iter().chain(picture.goals.iter().copied());
    for q in sampled.chain(shown) {
        include(arm.tip_at(q), 0.0);
        for (link, pose) in arm.links.iter().zip(arm.poses(q)) {
            for shape in link.parts.iter().map(|p| &p.shape) {
                shape.core().iter().for_each(|p| include(pose * p, shape.radius()));
            }
        }
    }
    bounds
}

fn extent(obstacle: &Obstacle) -> [Range; 2] {
    let mut bounds = [(f64::INFINITY, f64::NEG_INFINITY); 2];
    for piece in &obstacle.pieces {
        for (p, k) in piece.core().iter().flat_map(|p| [(p, 0), (p, 1)]) {
            bounds[k] = (bounds[k].0.min(p[k] - piece.radius()), bounds[k].1.max(p[k] + piece.radius()));
        }
    }
    bounds
}

/// Says so if obstacles lie outside the panel.
fn hidden_note(frame: &Frame, obstacles: &[Obstacle]) -> Option<Item> {
    let outside = |o: &&Obstacle| {
        let [x, y] = extent(o);
        x.1 < frame.x.0 || x.0 > frame.x.1 || y.1 < frame.y.0 || y.0 > frame.y.1
    };
    let text = match obstacles.iter().filter(outside).count() {
        0 => return None,
        1 => "1 obstacle lies outside this picture".to_owned(),
        n => format!("{n} obstacles lie outside this picture"),
    };
    let at = [frame.rect.x + 10.0, frame.rect.bottom() - 10.0];
    Some(Item::Text(Label { at, text, size: 13.0, anchor: Anchor::Start, upwards: false, color: GREY }))
}

fn obstacle_item(frame: &Frame, obstacle: &Obstacle, color: Rgb) -> Item {
    let solid = Style::line(color.darker(0.25), 1.2).filled(color.lighter(0.25));
    match &obstacle.shape {
        Shape::Polygon(points) => Item::Outline(chain(points.iter().map(|p| frame.at(p.x, p.y)), true), solid),
        Shape::Circle { center, radius } => {
            Item::Disc(frame.at(center.x, center.y), (radius * frame.scale()).max(1.0), solid)
        }
        Shape::Polyline(points) => {
            let wall = Style::line(color.darker(0.1), 3.0);
            Item::Outline(chain(points.iter().map(|p| frame.at(p.x, p.y)), false), wall)
        }
        Shape::Pieces => {
            let steps = obstacle.pieces.iter().flat_map(|piece| outline(frame, piece)).collect();
            Item::Outline(steps, Style { pen_below: true, ..solid })
        }
    }
}

/// How a pose is drawn.
struct Look {
    fill: Rgb,
    line: Rgb,
    width: f64,
    opacity: f64,
    joints: bool,
}

const START: Look = Look { fill: WHITE, line: INK, width: 1.4, opacity: 0.9, joints: true };
const GOAL: Look = Look { fill: PALE, line: INK, width: 1.4, opacity: 0.9, joints: true };
const GHOST: Look =
    Look { fill: Rgb(0xf3, 0xf4, 0xf6), line: Rgb(0x8c, 0x94, 0x9d), width: 1.0, opacity: 0.65, joints: false };

fn arm_items(frame: &Frame, arm: &Arm, q: Configuration, look: &Look) -> Vec<Item> {
    let mut items = Vec::new();
    let body =
        Style { pen_below: true, ..Style::line(look.line, 2.0 * look.width).filled(look.fill).faded(look.opacity) };
    for (link, pose) in arm.links.iter().zip(arm.poses(q)) {
        let parts = link.parts.iter().flat_map(|part| outline(frame, &part.shape.at(&pose)));
        items.push(Item::Outline(parts.collect(), body));
    }
    if look.joints {
        let [base, elbow, tip] = [arm.base, arm.elbow_at(q[0]), arm.tip_at(q)].map(|p| frame.at(p.x, p.y));
        let axis = Style::line(look.line, 1.0).faded(0.7);
        items.push(Item::Outline(vec![Step::Move(base), Step::Line(elbow), Step::Line(tip)], axis));
        items.push(Item::Disc(base, 5.0, Style::fill(INK)));
        items.push(Item::Disc(elbow, 3.5, Style::fill(INK)));
        items.push(Item::Disc(tip, 3.0, Style::line(INK, 1.4).filled(WHITE)));
    }
    items
}

/// Outline of a rounded convex polygon: its sides moved outwards, joined by arcs.
fn outline(frame: &Frame, shape: &Convex) -> Vec<Step> {
    let (core, r) = (shape.core(), shape.radius());
    let pixels = r * frame.scale();
    let at = |p: Point| frame.at(p.x, p.y);
    if let [center] = core {
        let [x, y] = at(*center);
        return vec![
            Step::Move([x + pixels, y]),
            Step::Arc(pixels, [x - pixels, y]),
            Step::Arc(pixels, [x + pixels, y]),
            Step::Close,
        ];
    }
    let mut steps = Vec::new();
    let mut begin = None;
    for (i, &a) in core.iter().enumerate() {
        let b = core[(i + 1) % core.len()];
        let Some(along) = (b - a).try_normalize(0.0) else { continue };
        let outward = crate::geometry::Vector::new(along.y, -along.x) * r;
        let from = at(a + outward);
        steps.push(match begin {
            None => Step::Move(from),
            Some(_) if r > 0.0 => Step::Arc(pixels, from),
            Some(_) => Step::Line(from),
        });
        begin = begin.or(Some(from));
        steps.push(Step::Line(at(b + outward)));
    }
    if let Some(begin) = begin {
        if r > 0.0 {
            steps.push(Step::Arc(pixels, begin));
        }
        steps.push(Step::Close);
    }
    steps
}

/// The region that the tip can never leave: within the greatest distance from the base if joint 1 turns, else the
/// places that the slides reach, grown by the reach of a turning second link.
fn reach_shape(arm: &Arm) -> Convex {
    let topology = arm.topology();
    let [first, second] = topology.axes.map(|axis| axis.domain());
    if arm.joints[0].motion.is_revolute() {
        const FINE: usize = 720;
        let at = |i: usize| second.0 + (second.1 - second.0) * i as f64 / FINE as f64;
        let distance = |i: usize| (arm.tip_at(Configuration::new(first.0, at(i))) - arm.base).norm();
        return Convex::disc(arm.base, (0..=FINE).map(distance).fold(0.0, f64::max));
    }
    match arm.joints[1].motion {
        Motion::Revolute { .. } => {
            Convex::new(vec![arm.elbow_at(first.0), arm.elbow_at(first.1)], arm.tip.coords.norm())
        }
        Motion::Prismatic { .. } => {
            let tip = |q1, q2| arm.tip_at(Configuration::new(q1, q2));
            let mut corners =
                vec![tip(first.0, second.0), tip(first.1, second.0), tip(first.1, second.1), tip(first.0, second.1)];
            if cross(corners[1] - corners[0], corners[2] - corners[1]) < 0.0 {
                corners.reverse();
            }
            Convex::new(corners, 0.0)
        }
    }
}

/// Configurations that divide the path into `count + 1` equal parts.
fn between(path: &Path, count: usize) -> Vec<Configuration> {
    let total = path.length();
    let mut wanted = (1..=count).map(|k| total * k as f64 / (count + 1) as f64).peekable();
    let (mut found, mut done) = (Vec::new(), 0.0);
    for (a, b) in path.segments() {
        let length = (b - a).norm();
        while let Some(s) = wanted.next_if(|&s| s <= done + length) {
            found.push(a + (b - a) * ((s - done) / length));
        }
        done += length;
    }
    found
}

/// Where the tip goes: straight joint motions are curves here, so they are followed in small steps.
fn tip_trace(frame: &Frame, arm: &Arm, path: &Path) -> Vec<Step> {
    /// Radians; a chord of such an arc is off by 2e-5 of the reach at most, a hundredth of a pixel.
    const STEP: f64 = 0.0125;
    const MOST: f64 = 2000.0;
    let turns = [0, 1].map(|k| arm.joints[k].motion.is_revolute());
    let mut spots = vec![path.start()];
    for (a, b) in path.segments() {
        let angle = (0..2).filter(|&k| turns[k]).map(|k| (b[k] - a[k]).abs()).fold(0.0, f64::max);
        let n = (angle / STEP).ceil().clamp(1.0, MOST) as usize;
        spots.extend((1..=n).map(|i| a + (b - a) * (i as f64 / n as f64)));
    }
    let place = |q: Configuration| {
        let tip = arm.tip_at(q);
        frame.at(tip.x, tip.y)
    };
    chain(spots.into_iter().map(place), false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ghosts_are_equally_spaced() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 3.0), (0.5, 3.0)];
        let path = Path::new(corners.iter().map(|c| Configuration::new(c.0, c.1)).collect());
        let all = between(&path, 8);
        let expected: Vec<Configuration> =
            [(0.5, 0.0), (1.0, 0.0), (1.0, 0.5), (1.0, 1.0), (1.0, 1.5), (1.0, 2.0), (1.0, 2.5), (1.0, 3.0)]
                .iter()
                .map(|c| Configuration::new(c.0, c.1))
                .collect();
        assert_eq!(all.len(), expected.len());
        assert!(all.iter().zip(&expected).all(|(a, b)| (a - b).norm() < 1e-12), "{all:?}");
        assert!(between(&Path::new(vec![Configuration::zeros()]), 3).is_empty());
    }

    /// Flattens the outline and compares its area with Steiner's formula.
    #[test]
    fn outlines_enclose_their_shape() {
        let area = Rect { x: 0.0, y: 0.0, width: 100.0, height: 100.0 };
        let frame = Frame::filling(area, (-2.0, 2.0), (-2.0, 2.0));
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|c| Point::new(c.0, c.1));
        for (n, r) in [(1, 0.5), (2, 0.3), (3, 0.2), (4, 0.0), (4, 0.4)] {
            let shape = Convex::new(square[..n].to_vec(), r);
            let (mut twice, mut at, mut arcs) = (0.0, [0.0; 2], 0.0);
            let mut line = |from: [f64; 2], to: [f64; 2]| twice += from[0] * to[1] - from[1] * to[0];
            for step in outline(&frame, &shape) {
                match step {
                    Step::Move(to) => at = to,
                    Step::Line(to) => {
                        line(at, to);
                        at = to;
                    }
                    Step::Arc(radius, to) => {
                        line(at, to);
                        let chord = (to[0] - at[0]).hypot(to[1] - at[1]);
                        let angle = 2.0 * (chord / 2.0 / radius).min(1.0).asin();
                        arcs += radius * radius / 2.0 * (angle - angle.sin());
                        at = to;
                    }
                    Step::Close => {}
                }
            }
            // Counter-clockwise as seen is clockwise where y points down.
            let found = (-twice / 2.0 + arcs) / frame.scale().powi(2);
            // The arc sine loses half the digits at half a turn.
            assert!((found - shape.area()).abs() < 1e-7, "{n} corners, radius {r}: {found} for {}", shape.area());
        }
    }
}
