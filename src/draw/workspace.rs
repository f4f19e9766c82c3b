//! The left panel: the workspace, with the arm in it.

use super::arm::{self, GHOST, GOAL, START};
use super::axes::{Frame, Unit};
use super::color::{self, PALE};
use super::figure::{Item, Rect, Step, Style, chain};
use super::{Picture, extent, page, preferences, shapes};
use crate::geometry::{Convex, cross};
use crate::model::{Arm, JointType, Plane};
use crate::space::{Configuration, Path};
use nalgebra::Vector3;

/// Poses shown between start and goal.
const GHOSTS: usize = 5;

/// The panel in this part of the page, which it fills.
#[must_use]
pub fn panel(picture: &Picture, area: Rect) -> Vec<Item> {
    let scene = picture.scene;
    let obstacles = &scene.workspace().obstacles;
    let frame = frame(picture, area);
    let mut inside = ground(&frame, scene.arm());
    for (i, obstacle) in obstacles.iter().enumerate() {
        inside.push(shapes::solid(&frame, obstacle, color::obstacle(i)));
    }
    inside.extend(preferences::in_workspace(&scene.workspace().preferences, &frame));
    if let [(_, path)] = picture.paths[..] {
        for q in between(path, GHOSTS) {
            inside.extend(arm::items(&frame, scene, q, &GHOST));
        }
    }
    inside.extend(arm::items(&frame, scene, picture.start, &START));
    let goal = picture.paths.first().map(|(_, path)| path.goal()).or(picture.single_goals().first().copied());
    inside.extend(goal.into_iter().flat_map(|q| arm::items(&frame, scene, q, &GOAL)));
    let traces = picture.paths.iter().map(|(_, path)| tip_trace(&frame, scene.arm(), path)).collect();
    inside.extend(page::path_items(traces));
    inside.extend(extent::hidden_note(&frame, obstacles));
    framed(&frame, &scene.arm().plane, inside)
}

/// The frame of the panel in this part of the page.
#[must_use]
pub fn frame(picture: &Picture, area: Rect) -> Frame {
    extent::frame(picture.scene, &picture.shown(), area)
}

/// What lies below everything: grid and reach.
#[must_use]
pub fn ground(frame: &Frame, arm: &Arm) -> Vec<Item> {
    let mut items = frame.grid([Unit::Meters; 2]);
    let reach = Style::line(PALE, 1.0).dashed(&[2.0, 4.0]);
    items.push(Item::Outline(shapes::outline(frame, &reach_shape(arm)), reach));
    items
}

/// Cuts what sticks out of the frame, and draws its border.
#[must_use]
pub fn framed(frame: &Frame, plane: &Plane, inside: Vec<Item>) -> Vec<Item> {
    let mut items = vec![Item::Clip(frame.rect, inside)];
    items.extend(frame.border([Unit::Meters; 2], titles(plane), [false; 2]));
    items
}

/// The plane's coordinates are named after the root frame's axes if they run along them.
pub fn titles(plane: &Plane) -> [String; 2] {
    const ALONG: f64 = 0.9999;
    let name = |v: Vector3<f64>, other: &str| {
        let axis = ["x", "y", "z"].into_iter().zip(v.iter()).find(|(_, part)| **part > ALONG);
        format!("{} (m)", axis.map_or(other, |(name, _)| name))
    };
    [name(plane.u, "u"), name(plane.v, "v")]
}

/// The region that the tip can never leave: within the greatest distance from the base if joint 1 turns, else the
/// places that the slides reach, grown by the reach of a turning second link.
fn reach_shape(arm: &Arm) -> Convex {
    let topology = arm.topology();
    let [first, second] = topology.ranges.map(|axis| axis.domain());
    if arm.joints[0].joint_type.is_revolute() {
        const FINE: usize = 720;
        let at = |i: usize| second.0 + (second.1 - second.0) * i as f64 / FINE as f64;
        let distance = |i: usize| (arm.tip_at(Configuration::new(first.0, at(i))) - arm.base).norm();
        return Convex::trusted(vec![arm.base], (0..=FINE).map(distance).fold(0.0, f64::max));
    }
    match arm.joints[1].joint_type {
        JointType::Revolute { .. } => {
            Convex::trusted(vec![arm.elbow_at(first.0), arm.elbow_at(first.1)], arm.tip.coords.norm())
        }
        JointType::Prismatic { .. } => {
            let tip = |q1, q2| arm.tip_at(Configuration::new(q1, q2));
            let mut corners =
                vec![tip(first.0, second.0), tip(first.1, second.0), tip(first.1, second.1), tip(first.0, second.1)];
            if cross(corners[1] - corners[0], corners[2] - corners[1]) < 0.0 {
                corners.reverse();
            }
            Convex::trusted(corners, 0.0)
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
#[must_use]
pub fn tip_trace(frame: &Frame, arm: &Arm, path: &Path) -> Vec<Step> {
    /// Radians; a chord of such an arc is off by 2e-5 of the reach at most, a hundredth of a pixel.
    const STEP: f64 = 0.0125;
    const MOST: f64 = 2000.0;
    let turns = [0, 1].map(|k| arm.joints[k].joint_type.is_revolute());
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
}
