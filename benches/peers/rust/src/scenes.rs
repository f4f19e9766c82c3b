//! Arm and obstacles as plain convex polygons, from the same files that all contenders read.

use crate::Result;
use cplan::geometry::Convex;
use cplan::input::{self, Overrides};
use cplan::model::{MotionProblem, Scene};
use std::path::Path;

pub fn scene(urdf: &str, world: &str) -> Result<Scene> {
    Ok(input::load_scene(Path::new(urdf), Path::new(world)).map_err(|e| e.to_string())?.scene)
}

pub fn problem(urdf: &str, world: &str) -> Result<MotionProblem> {
    let loaded = input::load(Path::new(urdf), Path::new(world), &Overrides::default()).map_err(|e| e.to_string())?;
    Ok(loaded.problem)
}

/// The shape of each link, given by its corners in the link's frame, and the x coordinate of joint 2 on link 1.
pub struct Bars {
    pub links: [Vec<[f64; 2]>; 2],
    pub elbow: f64,
}

/// Returns the bars of an arm. Fails unless the arm is of the simple kind that the peers' checkers support.
pub fn bars(scene: &Scene) -> Result<Bars> {
    let arm = scene.arm();
    let simple = arm.base.norm() == 0.0 && arm.offset.y == 0.0 && arm.links.iter().all(|l| l.parts.len() == 1);
    if !simple {
        return Err("the peers' checkers know an arm of two bars at the origin".into());
    }
    let links = [0, 1].map(|k| corners(&arm.links[k].parts[0].shape));
    Ok(Bars { links, elbow: arm.offset.x })
}

/// Returns the corners of all convex pieces of the obstacles.
pub fn obstacles(scene: &Scene) -> Vec<Vec<[f64; 2]>> {
    scene.workspace().obstacles.iter().flat_map(|o| &o.pieces).map(corners).collect()
}

fn corners(shape: &Convex) -> Vec<[f64; 2]> {
    shape.core().iter().map(|p| [p.x, p.y]).collect()
}
