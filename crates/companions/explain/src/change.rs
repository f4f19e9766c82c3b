//! The smallest change of a single blocker that opens a path.

use super::threshold::{Threshold, threshold};
use cplan_blockers::{Element, MotionQuestion, farthest};
use cplan_geometry::{Convex, Point, Pose, Vector};
use cplan_model::{Obstacle, Outcome};
use serde::Serialize;
use std::f64::consts::TAU;

/// Tolerance of changes, in metres or radians. If the reach of the arm is less than a metre, lengths have this fraction
/// of the reach as their tolerance.
const CHANGE_TOLERANCE: f64 = 1e-3;

/// Largest tolerance of a change, as a fraction of the largest possible change.
const MAX_TOLERANCE_SHARE: f64 = 1e-2;

/// Number of directions in which moves of an obstacle are tried.
const MOVE_DIRECTIONS: usize = 16;

/// Number of refinements of the best direction. Each one tries the directions on both sides of it, at half the previous angle.
const DIRECTION_REFINEMENTS: u32 = 3;

/// The kind of change made to a blocker.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "change")]
pub enum ChangeKind {
    /// The obstacle is moved in this direction, of unit length.
    Moved {
        /// Direction in the plane.
        direction: [f64; 2],
    },
    /// All sides of the obstacle, which is convex, are moved inwards.
    Eroded,
    /// The obstacle is scaled about the middle of its bounding box. The amount is the displacement of its farthest point.
    Scaled {
        /// Fraction of its size that remains.
        to: f64,
    },
    /// The joint's range is extended.
    Widened,
    /// The clearance is reduced.
    Lowered,
}

/// The other elements that remain in the world when a change is tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ChangeContext {
    /// All elements of the world.
    World,
    /// Only the other blockers of the set. Used if another set also blocks all paths.
    Set,
}

/// A change of one blocker that opens a path.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// The element that is changed.
    pub element: Element,
    /// The kind of change.
    pub cure: ChangeKind,
    /// The elements that remained in the world when the change was tried.
    pub among: ChangeContext,
    /// The amount of the change that opens a path, in metres or radians.
    pub by: Threshold,
}

/// Returns the smallest changes of a blocker for an infeasible `question`, one for each kind of change that applies to
/// it. The amount of a move is only an upper bound on the least amount, because not all directions are tried.
pub fn changes(question: &MotionQuestion, element: Element, among: ChangeContext, boxes: usize) -> Vec<Change> {
    let scene = question.scene();
    let fine = fineness(question);
    let made = |cure: ChangeKind, by: Threshold| Change { element, cure, among, by };
    match element {
        Element::Obstacle { number } => {
            let obstacle = &scene.workspace().obstacles[number];
            let shrunk = shrinking(question, obstacle, number, fine, boxes).map(|(cure, by)| made(cure, by));
            let moved = moving(question, obstacle, number, fine, boxes).map(|(cure, by)| made(cure, by));
            moved.into_iter().chain(shrunk).collect()
        }
        // Changes of a robot's body or motors are not a practical advice.
        Element::Link { .. } | Element::Motor => Vec::new(),
        Element::Limit { joint, side } => {
            let turns = scene.arm().joints[joint].joint_type.is_revolute();
            let (most, fine) = (question.margin_beyond_limit(joint), if turns { CHANGE_TOLERANCE } else { fine });
            let ask = |by: f64| question.with_wider(joint, side, by).answer(boxes);
            threshold(0.0, most, fine, ask).map(|by| made(ChangeKind::Widened, by)).into_iter().collect()
        }
        Element::Clearance => {
            let clearance = scene.workspace().greatest_clearance();
            let ask = |by: f64| question.with_clearance_at_most((clearance - by).max(0.0)).answer(boxes);
            let by = threshold(0.0, clearance, fine.min(MAX_TOLERANCE_SHARE * clearance), ask);
            by.map(|by| made(ChangeKind::Lowered, by)).into_iter().collect()
        }
    }
}

/// Returns the tolerance for changes of lengths, in metres.
pub(super) fn fineness(question: &MotionQuestion) -> f64 {
    CHANGE_TOLERANCE * question.scene().arm().reach().min(1.0)
}

/// Finds the least amount of shrinking an obstacle that opens a path.
fn shrinking(
    question: &MotionQuestion,
    obstacle: &Obstacle,
    number: usize,
    fine: f64,
    boxes: usize,
) -> Option<(ChangeKind, Threshold)> {
    let (_, most) = middle(obstacle)?;
    let ask = |by: f64| question.with_pieces(number, shrunk_pieces(obstacle, by)).answer(boxes);
    let by = threshold(0.0, most, fine.min(MAX_TOLERANCE_SHARE * most), ask)?;
    if by.opens >= most {
        // The obstacle has vanished. It was known before that its removal opens a path.
        return None;
    }
    let cure = if is_eroded(obstacle) { ChangeKind::Eroded } else { ChangeKind::Scaled { to: 1.0 - by.opens / most } };
    Some((cure, by))
}

/// Returns true if all sides of an obstacle can be moved inwards. Pieces of a non-convex obstacle would come apart, and
/// a wall has no inside.
fn is_eroded(obstacle: &Obstacle) -> bool {
    matches!(&obstacle.pieces[..], [only] if only.depth() > 0.0)
}

/// Returns the pieces of an obstacle after shrinking that moves no point by more than `by`. A convex obstacle shrinks by moving
/// all sides inwards. Others are scaled about the middle of their bounding box. Returns no pieces if the obstacle vanishes.
pub(super) fn shrunk_pieces(obstacle: &Obstacle, by: f64) -> Vec<Convex> {
    let (pieces, growth) = (obstacle.real_pieces(), obstacle.growth.total);
    let eroded = is_eroded(obstacle).then(|| pieces[0].eroded(by).into_iter().collect::<Vec<_>>());
    let shrunk = eroded.or_else(|| {
        let (middle, extent) = middle(obstacle).filter(|(_, extent)| by < *extent)?;
        let share = 1.0 - by / extent;
        let scaled = |piece: &Convex| piece.mapped(|p| middle + (p - middle) * share, piece.radius() * share);
        Some(pieces.iter().map(scaled).collect())
    });
    shrunk.unwrap_or_default().iter().map(|piece| piece.grown(growth)).collect()
}

/// Returns the middle of an obstacle's bounding box, and the distance from there to the farthest point of the obstacle.
/// `None` if it has no pieces.
pub(super) fn middle(obstacle: &Obstacle) -> Option<(Point, f64)> {
    let pieces = obstacle.real_pieces();
    let [lower, upper] =
        pieces.iter().map(|piece| piece.bounds().map(Point::from)).reduce(|[a, b], [c, d]| [a.inf(&c), b.sup(&d)])?;
    let middle = (lower + upper) * 0.5;
    Some((middle, pieces.iter().map(|piece| piece.reach_from(middle)).fold(0.0, f64::max)))
}

/// Finds the smallest move of an obstacle that opens a path. Doubles the step until a path opens in some directions.
/// Then bisects the step in these directions, and tries others beside the best one.
fn moving(
    question: &MotionQuestion,
    obstacle: &Obstacle,
    number: usize,
    fine: f64,
    boxes: usize,
) -> Option<(ChangeKind, Threshold)> {
    let toward = |share: f64| {
        let (sin, cos) = (TAU * share).sin_cos();
        Vector::new(cos, sin)
    };
    let ask = |share: f64, by: f64| {
        let moved = Pose::translation(toward(share) * by);
        question.with_pieces(number, obstacle.pieces.iter().map(|piece| piece.at(&moved)).collect()).answer(boxes)
    };
    let most = farthest(question.scene());
    let (mut below, mut step) = (0.0, 4.0 * fine);
    let open = loop {
        let opens = |k: &usize| matches!(ask(*k as f64 / MOVE_DIRECTIONS as f64, step), Outcome::Found(_));
        let open: Vec<f64> = (0..MOVE_DIRECTIONS).filter(opens).map(|k| k as f64 / MOVE_DIRECTIONS as f64).collect();
        if !open.is_empty() {
            break open;
        }
        (below, step) = (step, 2.0 * step);
        if step > most {
            return None;
        }
    };
    let mut best: Option<(f64, Threshold)> = None;
    let better = |share: f64, best: &mut Option<(f64, Threshold)>| {
        let most = best.as_ref().map_or(step, |(_, known)| known.opens - fine);
        if most <= 0.0 || !matches!(ask(share, most), Outcome::Found(_)) {
            return;
        }
        // A smaller step in this direction may be proven to open no path.
        let from = if below < most && matches!(ask(share, below), Outcome::Infeasible(_)) { below } else { 0.0 };
        if let Some(found) = threshold(from, most, fine, |by| ask(share, by)) {
            *best = Some((share, found));
        }
    };
    open.into_iter().for_each(|share| better(share, &mut best));
    for halving in 1..=DIRECTION_REFINEMENTS {
        let beside = 1.0 / (MOVE_DIRECTIONS << halving) as f64;
        if let Some((share, _)) = best {
            [share - beside, share + beside].into_iter().for_each(|share| better(share, &mut best));
        }
    }
    let (share, by) = best?;
    Some((ChangeKind::Moved { direction: toward(share).into() }, by))
}
