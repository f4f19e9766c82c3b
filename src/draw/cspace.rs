//! The right panel: the configuration space.

use super::axes::{Frame, Unit};
use super::color::{self, INK, WHITE};
use super::copies::Window;
use super::figure::{Item, Rect, Spot, Step, Style, chain};
use super::{Picture, boxes, page, preferences, trace};
use crate::cspace::CObstacle;
use crate::geometry::{Point, cross};
use crate::model::Joint;
use crate::space::{Configuration, Path};

/// Ratio of the ranges of two joints of one kind up to which both are drawn to one scale.
const ONE_SCALE: f64 = 2.2;

/// The panel in this part of the page, with room for a scale of colours to the right of it.
#[must_use]
pub fn panel(picture: &Picture, area: Rect) -> Vec<Item> {
    let arm = &picture.scene.arm;
    let topology = arm.topology();
    let ranges = topology.axes.map(|axis| axis.domain());
    let units = [0, 1].map(|k| unit(&arm.joints[k]));
    let [width, height] = topology.axes.map(|axis| axis.extent());
    let equal = units[0] == units[1] && width <= ONE_SCALE * height && height <= ONE_SCALE * width;
    let frame = Frame::fitted(area, ranges[0], ranges[1], equal);
    let seams = topology.axes.map(|axis| axis.is_circle());
    let paths = Window { ranges, repeats: seams };
    // A turning link meets an obstacle again after each turn, limits or not.
    let obstacles = Window { ranges, repeats: units.map(|u| u == Unit::Degrees) };

    let mut inside = frame.grid(units);
    inside.extend(picture.trace.into_iter().flat_map(|t| trace::below(t, &frame, &paths)));
    for index in 0..picture.scene.workspace.obstacles.len() {
        let contours = picture.c_obstacles.iter().filter(|c| c.obstacle == index);
        inside.push(c_obstacle(contours, color::obstacle(index), &frame, &obstacles));
    }
    inside.extend(picture.trace.into_iter().flat_map(|t| trace::above(t, &frame, &topology, &paths)));
    inside.extend(preferences::in_cspace(&picture.scene.workspace.preferences, &frame, &paths));
    if !picture.proof.is_empty() {
        inside.push(boxes::proof(picture.proof, &frame));
    }
    let outline = |path: &Path| {
        let pieces = paths.pieces(path.waypoints());
        pieces.into_iter().flat_map(|p| chain(p.iter().map(|q| frame.at(q[0], q[1])), false)).collect()
    };
    inside.extend(page::path_items(picture.paths.iter().map(|(_, path)| outline(path)).collect()));
    let mut items = vec![Item::Clip(frame.rect, inside)];
    items.extend(frame.border(units, [0, 1].map(|k| title(&arm.joints[k])), seams));
    items.extend(picture.trace.into_iter().flat_map(|t| trace::color_bar(t, &frame)));
    let place = |q: Configuration| {
        let q = topology.wrap(q);
        frame.at(q[0], q[1])
    };
    // Where paths were found, the goals that none of them reached are hollow.
    let reached: Vec<Spot> = picture.paths.iter().map(|(_, path)| place(path.goal())).collect();
    items.extend(picture.goals.iter().flat_map(|&q| goal_marker(place(q), picture.paths.is_empty())));
    items.extend(reached.into_iter().flat_map(|spot| goal_marker(spot, true)));
    items.extend(start_marker(place(picture.start)));
    items
}

fn unit(joint: &Joint) -> Unit {
    if joint.motion.is_revolute() { Unit::Degrees } else { Unit::Meters }
}

fn title(joint: &Joint) -> String {
    let name = super::figure::shortened(&joint.name, 14.0, 260.0);
    match (joint.motion.is_revolute(), joint.axis.is_circle()) {
        (true, true) => format!("{name} (degrees, wraps around)"),
        (true, false) => format!("{name} (degrees)"),
        (false, _) => format!("{name} (m)"),
    }
}

/// All contours of one obstacle with their copies as one outline, so that they look like their union.
fn c_obstacle<'a>(
    contours: impl Iterator<Item = &'a CObstacle>,
    color: color::Rgb,
    frame: &Frame,
    window: &Window,
) -> Item {
    let mut steps = Vec::new();
    for contour in contours.map(|c| &c.contour) {
        let twice: f64 =
            (0..contour.len()).map(|i| cross(contour[i].coords, contour[(i + 1) % contour.len()].coords)).sum();
        // The non-zero rule unites contours of one orientation only.
        let ordered: Vec<&Point> = if twice >= 0.0 { contour.iter().collect() } else { contour.iter().rev().collect() };
        for shift in window.shifts(contour.iter().map(|p| &p.coords)) {
            steps.extend(chain(ordered.iter().map(|p| frame.at(p.x + shift[0], p.y + shift[1])), true));
        }
    }
    let style = Style::line(color.darker(0.25), 2.0).filled(color.lighter(0.35)).faded(0.85);
    Item::Outline(steps, Style { pen_below: true, ..style })
}

/// Where the motion begins: a ring.
#[must_use]
pub fn start_marker(at: Spot) -> Vec<Item> {
    vec![Item::Disc(at, 8.0, Style::fill(WHITE).faded(0.85)), Item::Disc(at, 5.5, Style::line(INK, 2.2).filled(WHITE))]
}

/// Where it ends: a diamond, hollow if no path ended there.
#[must_use]
pub fn goal_marker([x, y]: Spot, reached: bool) -> Vec<Item> {
    let diamond = |r: f64| {
        vec![
            Step::Move([x, y - r]),
            Step::Line([x + r, y]),
            Step::Line([x, y + r]),
            Step::Line([x - r, y]),
            Step::Close,
        ]
    };
    let inside = if reached { INK } else { WHITE };
    vec![
        Item::Outline(diamond(10.5), Style::fill(WHITE).faded(0.85)),
        Item::Outline(diamond(7.0), Style::line(INK, 1.6).filled(inside)),
    ]
}
