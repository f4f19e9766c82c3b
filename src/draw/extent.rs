//! What of the workspace is shown.

use super::axes::{Frame, Range};
use super::color::GREY;
use super::figure::{Anchor, Item, Label, Rect};
use crate::geometry::{Convex, Point, Pose};
use crate::model::{Obstacle, Scene};
use crate::space::Configuration;

/// Configurations along each axis from which the extent of the arm's motion is read.
const SAMPLES: usize = 17;

/// Shows all that the arm can sweep, and of the obstacles what is not much farther away.
#[must_use]
pub fn frame(scene: &Scene, shown: &[Configuration], area: Rect) -> Frame {
    let [x, y] = sides(scene, shown);
    Frame::filling(area, x, y)
}

/// The same as least and greatest coordinates.
#[must_use]
pub fn sides(scene: &Scene, shown: &[Configuration]) -> [Range; 2] {
    /// Part of the swept extent up to which the panel grows for the sake of obstacles.
    const NEARBY: f64 = 0.25;
    const MARGIN: f64 = 0.04;
    let swept = swept(scene, shown);
    let size = (swept[0].1 - swept[0].0).max(swept[1].1 - swept[1].0);
    let mut sides = swept;
    for corners in scene.workspace().obstacles.iter().map(extent) {
        let near = [0, 1]
            .map(|k| (corners[k].0.max(swept[k].0 - NEARBY * size), corners[k].1.min(swept[k].1 + NEARBY * size)));
        if near.iter().all(|(lower, upper)| lower <= upper) {
            sides = [0, 1].map(|k| (sides[k].0.min(near[k].0), sides[k].1.max(near[k].1)));
        }
    }
    sides.map(|(lower, upper)| (lower - MARGIN * size, upper + MARGIN * size))
}

/// The box around the arm in a sample of its configurations, which are dense enough for a picture.
fn swept(scene: &Scene, shown: &[Configuration]) -> [Range; 2] {
    let arm = scene.arm();
    let mut bounds = [(f64::INFINITY, f64::NEG_INFINITY); 2];
    let mut include = |p: Point, r: f64| {
        for k in 0..2 {
            bounds[k] = (bounds[k].0.min(p[k] - r), bounds[k].1.max(p[k] + r));
        }
    };
    include(arm.base, 0.0);
    let [first, second] = arm.topology().ranges.map(|axis| {
        let (lower, upper) = axis.domain();
        (0..SAMPLES).map(move |i| lower + (upper - lower) * i as f64 / (SAMPLES - 1) as f64)
    });
    let sampled = first.flat_map(|q1| second.clone().map(move |q2| Configuration::new(q1, q2)));
    for q in sampled.chain(shown.iter().copied()) {
        include(arm.tip_at(q), 0.0);
        let mut shape =
            |shape: &Convex, pose: &Pose| shape.core().iter().for_each(|p| include(pose * p, shape.radius()));
        for (link, pose) in arm.poses(q).iter().enumerate() {
            scene.own_parts(link).iter().for_each(|part| shape(&part.shape, pose));
        }
        if let Some(payload) = scene.payload() {
            let pose = payload.pose(arm, q);
            payload.pieces.iter().for_each(|piece| shape(piece, &pose));
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

/// The box around an obstacle that lies somewhere, on the page.
#[must_use]
pub fn on_page(frame: &Frame, obstacle: &Obstacle) -> Rect {
    let [x, y] = extent(obstacle);
    let ([left, bottom], [right, top]) = (frame.at(x.0, y.0), frame.at(x.1, y.1));
    Rect { x: left, y: top, width: right - left, height: bottom - top }
}

/// Says so if obstacles lie outside the panel. Those without pieces lie nowhere.
#[must_use]
pub fn hidden_note(frame: &Frame, obstacles: &[Obstacle]) -> Option<Item> {
    let outside = |o: &&Obstacle| {
        let [x, y] = extent(o);
        !o.pieces.is_empty() && (x.1 < frame.x.0 || x.0 > frame.x.1 || y.1 < frame.y.0 || y.0 > frame.y.1)
    };
    let text = match obstacles.iter().filter(outside).count() {
        0 => return None,
        1 => "1 obstacle lies outside this picture".to_owned(),
        n => format!("{n} obstacles lie outside this picture"),
    };
    let at = [frame.rect.x + 10.0, frame.rect.bottom() - 10.0];
    Some(Item::Text(Label { at, text, size: 13.0, anchor: Anchor::Start, upwards: false, color: GREY }))
}
