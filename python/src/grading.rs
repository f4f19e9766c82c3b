//! Functions for the grader of exercises: verdicts of the judge on boxes of configurations, and pictures of answers.

use crate::findings::called;
use crate::problem::{Arm, World};
use cplan_calls::{DrawnAnswer, JointBox, Verdict};
use pyo3::prelude::*;

/// Returns for each joint its least and greatest value, and whether it is a circle.
#[pyfunction]
pub fn joint_ranges(py: Python<'_>, arm: &Arm, world: &World) -> PyResult<[(f64, f64, bool); 2]> {
    called(py, || cplan_calls::joint_ranges(&arm.0, &world.0))
}

/// Judges closed boxes of configurations, each given by its least and its greatest values. Boxes are expected free; with
/// `colliding`, they are expected in collision, and their parts beyond the limits do not matter.
///
/// If a box is proven as expected, the verdict is "free" or "collision" without a configuration. Otherwise the verdict
/// comes with a configuration: the opposite verdict, "limits" or "undecided".
#[pyfunction]
#[pyo3(signature = (arm, world, boxes, colliding = false))]
pub fn judge_boxes(
    py: Python<'_>,
    arm: &Arm,
    world: &World,
    boxes: Vec<JointBox>,
    colliding: bool,
) -> PyResult<Vec<Verdict>> {
    called(py, || cplan_calls::judge_boxes(&arm.0, &world.0, &boxes, colliding))
}

/// Returns true if these boxes are in collision and separate the start from all goals of the world.
#[pyfunction]
pub fn separate(py: Python<'_>, arm: &Arm, world: &World, boxes: Vec<JointBox>) -> PyResult<bool> {
    called(py, || cplan_calls::separate(&arm.0, &world.0, &boxes))
}

/// Draws the arm at a configuration with its contacts, the configuration space, and an answer: paths, edges of a roadmap,
/// and boxes, which are free, in collision or wrong.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn drawn(
    py: Python<'_>,
    arm: &Arm,
    world: &World,
    title: Vec<String>,
    at: [f64; 2],
    paths: Vec<Vec<[f64; 2]>>,
    edges: Vec<[[f64; 2]; 2]>,
    boxes: [Vec<JointBox>; 3],
) -> PyResult<String> {
    called(py, || cplan_calls::drawn(&arm.0, &world.0, DrawnAnswer { title, at, paths, edges, boxes }))
}
