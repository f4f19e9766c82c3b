//! Functions for the grader of exercises: verdicts of the judge on boxes of configurations, and pictures of answers.

use crate::error::Refusal;
use crate::problem::{Arm, Options, World, problem};
use cplan::check::{Cell, CollisionBox, Deviation, Disconnection, Posture};
use cplan::engine::findings::check;
use cplan::interrupt::checkpoint;
use cplan::model::{Pair, Scene};
use cplan::output::contours;
use cplan::planner::{GraphKind, Trace};
use cplan::space::{Configuration, JointRange, Path, Topology};
use cplan::view::{CheckedView, Picture, View};
use serde::Deserialize;
use std::collections::VecDeque;

/// Maximum number of parts of a box that are judged before the box is undecided.
const MAX_PARTS: usize = 50_000;

/// Radians by which an interval of a whole turn may be shorter than a turn. The box is then judged as a whole turn.
const TURN_ROUNDING: f64 = 1e-9;

/// Least and greatest value of each joint.
pub type JointBox = [[f64; 2]; 2];

/// The word of a verdict, and a configuration that shows it.
pub type Verdict = (&'static str, Option<[f64; 2]>);

/// Returns for each joint its least and greatest value, and whether it is a circle.
///
/// # Errors
/// The defects of arm and world.
pub fn joint_ranges(arm: &Arm, world: &World) -> Result<[(f64, f64, bool); 2], Refusal> {
    let listed = |range: JointRange| {
        let (lower, upper) = range.domain();
        (lower, upper, range.is_circle())
    };
    Ok(arm.among(world)?.scene.arm().topology().ranges.map(listed))
}

/// Judges closed boxes of configurations, each given by its least and its greatest values. Boxes are expected free; with
/// `colliding`, they are expected in collision, and their parts beyond the limits do not matter.
///
/// If a box is proven as expected, the verdict is "free" or "collision" without a configuration. Otherwise the verdict
/// comes with a configuration: the opposite verdict, "limits" or "undecided".
///
/// # Errors
/// The defects of arm and world.
pub fn judge_boxes(arm: &Arm, world: &World, boxes: &[JointBox], colliding: bool) -> Result<Vec<Verdict>, Refusal> {
    let scene = arm.among(world)?.scene;
    let judge = |one: &JointBox| match colliding {
        true => collision_boxes(&scene, one)
            .map_or_else(|(verdict, at)| (verdict, at.map(|at| inside(&scene, one, at))), |_| ("collision", None)),
        false => free_box(&scene, &Cell { lower: one[0], upper: one[1] }),
    };
    Ok(boxes.iter().map(judge).collect())
}

/// Returns true if these boxes are in collision and separate the start from all goals of the world.
///
/// # Errors
/// The defects of arm, world, start and goal.
pub fn separate(arm: &Arm, world: &World, boxes: &[JointBox]) -> Result<bool, Refusal> {
    let problem = problem(arm, world, &Options::default())?;
    let (scene, query) = (problem.scene(), problem.query());
    let parts: Result<Vec<_>, Verdict> = boxes.iter().map(|one| collision_boxes(scene, one)).collect();
    let checked = |parts: Vec<Vec<CollisionBox>>| {
        let clearance = scene.workspace().clearance;
        Disconnection::new(parts.concat()).checked(scene, query.start(), query.goals(), clearance).is_ok()
    };
    Ok(parts.is_ok_and(checked))
}

/// An answer to an exercise, for its picture.
#[derive(Debug, Clone, Deserialize)]
pub struct DrawnAnswer {
    /// Lines above the picture.
    pub title: Vec<String>,
    /// The configuration at which the arm is drawn with its contacts.
    pub at: [f64; 2],
    /// Waypoints of paths.
    pub paths: Vec<Vec<[f64; 2]>>,
    /// Both ends of the edges of a roadmap.
    pub edges: Vec<[[f64; 2]; 2]>,
    /// Boxes that are free, in collision and wrong.
    pub boxes: [Vec<JointBox>; 3],
}

/// Draws the arm at a configuration with its contacts, the configuration space, and an answer.
///
/// # Errors
/// The defects of arm and world, and a path without waypoints.
pub fn drawn(arm: &Arm, world: &World, answer: DrawnAnswer) -> Result<String, Refusal> {
    let DrawnAnswer { title, at, paths, edges, boxes } = answer;
    if paths.iter().any(Vec::is_empty) {
        return Err(Refusal::value("a path has one waypoint or more"));
    }
    let scene = arm.among(world)?.scene;
    let paths: Vec<Path> =
        paths.into_iter().map(|path| Path::new(path.into_iter().map(Configuration::from).collect())).collect();
    let trace = trace(edges, boxes);
    let at = Configuration::from(at);
    let findings = check(&scene, at);
    let start = if findings.free { at } else { paths.first().map_or(at, Path::start) };
    let view = View::of_picture(&Picture {
        title,
        trace: trace.as_ref(),
        paths: paths.iter().map(|path| ("answer".to_owned(), path)).collect(),
        c_obstacles: &contours(&scene),
        ..Picture::new(&scene, start)
    });
    let marked = if findings.free { view } else { view.with_findings(CheckedView::new(&scene, &findings)) };
    Ok(cplan::view::svg(&marked))
}

/// Returns the edges or the boxes of an answer as a planner's trace, which pictures show.
fn trace(edges: Vec<[[f64; 2]; 2]>, boxes: [Vec<JointBox>; 3]) -> Option<Trace> {
    let places = |pairs: Vec<[[f64; 2]; 2]>| pairs.into_iter().map(|pair| pair.map(Configuration::from)).collect();
    if !edges.is_empty() {
        return Some(Trace::Roads { edges: places(edges), expanded: Vec::new(), kind: GraphKind::Roadmap });
    }
    let is_empty = boxes.iter().all(Vec::is_empty);
    let [free, stuck, mixed] = boxes.map(places);
    (!is_empty).then_some(Trace::Boxes { free, stuck, mixed })
}

/// Judges a box that is expected free.
fn free_box(scene: &Scene, cell: &Cell) -> Verdict {
    let topology = scene.arm().topology();
    let corners = [0, 1, 2, 3].map(|k| Configuration::from_fn(|j, _| [cell.lower, cell.upper][k >> j & 1][j]));
    if let Some(corner) = corners.into_iter().find(|&q| !topology.contains(q)) {
        return ("limits", Some(corner.into()));
    }
    let clearance = scene.workspace().clearance;
    let is_free = |distance: f64| distance > 0.0 && distance >= clearance;
    if let Some(corner) = corners.into_iter().find(|&q| !scene.separations(q).all(|c| is_free(c.separation.distance))) {
        return ("collision", Some(corner.into()));
    }
    let (mut open, mut parts) = (VecDeque::from([(*cell, scene.pairs().to_vec())]), 0);
    while let Some((cell, mut pairs)) = open.pop_front() {
        checkpoint();
        parts += 1;
        let (posture, deviation) = (Posture::new(scene, cell.center()), Deviation::Box(cell.half()));
        let mut collides = false;
        pairs.retain(|&pair| {
            let bounded = posture.bound(pair, deviation);
            collides |= !is_free(bounded.here.distance);
            !is_free(bounded.least)
        });
        match (collides, parts > MAX_PARTS) {
            (true, _) => return ("collision", Some(cell.center().into())),
            _ if pairs.is_empty() => {}
            (_, true) => return ("undecided", Some(cell.center().into())),
            _ => open.extend(halves(&posture, &pairs, &cell).map(|half| (half, pairs.clone()))),
        }
    }
    ("free", None)
}

/// Returns parts of a box that are in collision, each by one pair of shapes, and together cover the box within the
/// domain. Otherwise returns a verdict other than "collision".
fn collision_boxes(scene: &Scene, one: &JointBox) -> Result<Vec<CollisionBox>, Verdict> {
    let (inner, clearance) = (scene.inner(), scene.workspace().clearance);
    let mut open = VecDeque::from(within_domain(&scene.arm().topology(), one));
    let mut found = Vec::new();
    let mut parts = 0;
    while let Some(cell) = open.pop_front() {
        checkpoint();
        parts += 1;
        let posture = Posture::new(&inner, cell.center());
        let distances = inner.pairs().iter().map(|&pair| (pair, posture.separation(pair).distance));
        let mut colliding: Vec<(Pair, f64)> = distances.filter(|d| d.1 <= 0.0 || d.1 < clearance).collect();
        colliding.sort_by(|a, b| a.1.total_cmp(&b.1));
        let by_pair =
            |&(pair, _): &(Pair, f64)| Some(CollisionBox { cell, pair }).filter(|b| b.holds(scene, clearance));
        if let Some(covered) = colliding.iter().find_map(by_pair) {
            found.push(covered);
        } else if colliding.is_empty() && scene.clearance(cell.center()) > 0.0 {
            return Err(("free", Some(cell.center().into())));
        } else if parts > MAX_PARTS || colliding.is_empty() {
            return Err(("undecided", Some(cell.center().into())));
        } else {
            let pairs: Vec<Pair> = colliding.into_iter().map(|(pair, _)| pair).collect();
            open.extend(halves(&posture, &pairs, &cell));
        }
    }
    Ok(found)
}

/// Returns the copy of a configuration that is nearest to the middle of a box.
fn inside(scene: &Scene, &[lower, upper]: &JointBox, at: [f64; 2]) -> [f64; 2] {
    let middle = Cell { lower, upper }.center();
    scene.arm().topology().lift(at.into(), middle).into()
}

/// Returns the halves of a box, across the joint that moves these pairs more.
fn halves(posture: &Posture, pairs: &[Pair], cell: &Cell) -> [Cell; 2] {
    let half = cell.half();
    let motion = |by: [f64; 2]| {
        let deviation = Deviation::Box(by);
        pairs.iter().map(|&pair| posture.farthest_motion(pair, deviation)).fold(0.0, f64::max)
    };
    let axis = usize::from(motion([0.0, half[1]]) > motion([half[0], 0.0]));
    let (mut below, mut above) = (*cell, *cell);
    below.upper[axis] = cell.center()[axis];
    above.lower[axis] = cell.center()[axis];
    [below, above]
}

/// Returns the parts of a box in the domain: within the limits, and cut at the seams of circles.
fn within_domain(topology: &Topology, [lower, upper]: &JointBox) -> Vec<Cell> {
    let [first, second] = [0, 1].map(|k| within_range(topology.ranges[k], [lower[k], upper[k]]));
    let cells = first.iter().flat_map(|a| second.iter().map(|b| Cell { lower: [a[0], b[0]], upper: [a[1], b[1]] }));
    cells.collect()
}

/// Returns the parts of an interval in the domain of a joint.
fn within_range(range: JointRange, [lower, upper]: [f64; 2]) -> Vec<[f64; 2]> {
    let (least, greatest) = range.domain();
    // A double is not exactly a turn, so an interval of a turn would leave a gap.
    if range.is_circle() && upper - lower >= range.extent() - TURN_ROUNDING {
        return vec![[least, greatest]];
    }
    let (first, copies) = match range.is_circle() {
        true => (((lower - least) / range.extent()).floor(), 3),
        false => (0.0, 1),
    };
    let copy = |k: i32| [lower, upper].map(|value| range.turned(value, -(first + f64::from(k))));
    let clipped = |[from, to]: [f64; 2]| [from.max(least), to.min(greatest)];
    (0..copies).map(copy).map(clipped).filter(|[from, to]| from < to).collect()
}
