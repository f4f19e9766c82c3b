//! The lower bound of a result, with evidence for a checker.

use super::bound::{LeastLength, PathLimits, Potential};
use super::contacts::Contacts;
use super::{Evidence, blocked_solutions, inward, lines};
use cplan_geometry::cross;
use cplan_judge::CollisionBox;
use cplan_model::space::{Configuration, Metric, Segment, SumSpeed};
use cplan_model::{Arm, MotionProblem, inverse};
use cplan_proofs::ClosedSegment;
use cplan_solver::Bound;
use cplan_world::Overrides;
use serde_json::json;

/// Number of points along a wall, in either direction, at which a checker computes the distance. More points make the check
/// slower.
const CHECKS_PER_WALL: usize = 60;
/// Replaces [`CHECKS_PER_WALL`] if too much of the bound would be lost.
const MORE_CHECKS_PER_WALL: usize = 300;

/// A length, and the evidence that no motion is shorter. The length is the bound of a result, up to a small loss.
///
/// The motions lead to one configuration, or to any that puts the tip at the requested place. In the latter case, boxes cover
/// those of these configurations that are not free.
pub(super) struct LowerBound {
    least: LeastLength,
    metric: Metric,
    to: Option<Configuration>,
    boxes: Vec<CollisionBox>,
}

impl LowerBound {
    /// Computes evidence for a bound. If more than the fraction `loss` of the bound is lost, computes it again with more points
    /// per wall. Bounds lose where shapes separate slowly, as in a slot, because walls then end too early. `None` if the goals
    /// are a curve, or if a checker could not separate them from neighbouring configurations.
    pub fn of(problem: &MotionProblem, stated: &Bound, asked: &Overrides, loss: f64) -> Option<Self> {
        let scene = problem.scene();
        let topology = scene.arm().topology();
        let Ends { to, goals, boxes } = Ends::of(problem, asked)?;
        let limits = PathLimits {
            topology: &topology,
            metric: stated.metric,
            start: topology.wrap(problem.start()),
            goals: &goals,
            goal_tolerance: if to.is_some() { 0.0 } else { GOAL_TOLERANCE },
            limit: stated.upper,
        };
        let (evidence, clearance) = (stated.evidence(problem), scene.workspace().clearance);
        let of = |looks: usize| LeastLength::new(&limits, evidence.segments(scene, clearance, looks));
        let mut least = of(CHECKS_PER_WALL)?;
        if least.length < stated.lower * (1.0 - loss) {
            least = of(MORE_CHECKS_PER_WALL).filter(|closer| closer.length > least.length).unwrap_or(least);
        }
        Some(Self { least, metric: stated.metric, to, boxes })
    }

    /// Returns the length.
    pub fn length(&self) -> f64 {
        self.least.length
    }

    /// Returns the number of walls that bar shorter paths.
    pub fn walls(&self) -> usize {
        self.least.walls.len()
    }

    /// Returns the evidence for the bound as members of the certificate's JSON.
    pub fn evidence(&self, contacts: &mut Contacts) -> Evidence {
        let wall = |wall: &ClosedSegment| {
            let (shape, part) = contacts.numbers(wall.pair);
            let [from, to] = wall.ends.map(<[f64; 2]>::from);
            json!({ "from": from, "to": to, "shape": shape, "part": part })
        };
        let walls: Vec<_> = self.least.walls.iter().map(wall).collect();
        let potential = |p: &Potential| match p.turns {
            [0, 0] => json!({ "wall": p.wall, "end": p.end, "value": p.value }),
            turns => json!({ "wall": p.wall, "end": p.end, "turns": turns, "value": p.value }),
        };
        let potentials: Vec<_> = self.least.potentials.iter().map(potential).collect();
        let metric = match self.metric {
            Metric::Euclidean => json!("euclidean"),
            Metric::Weighted { weights } => json!({ "weights": weights }),
            Metric::Time { speeds, sum: None } => json!({ "speeds": speeds }),
            Metric::Time { speeds, sum: Some(SumSpeed { ratio, speed }) } => {
                json!({ "motor_speeds": { "speeds": speeds, "ratio": ratio, "speed": speed } })
            }
            Metric::Motor { ratio } => json!({ "motor": ratio }),
        };
        let to = self.to.map_or_else(String::new, |to| format!("\"to\": {}, ", json!(to)));
        let (length, walls, potentials) = (self.least.length, lines(&walls), lines(&potentials));
        let members =
            format!(r#"{to}"length": {length}, "metric": {metric}, "walls": {walls}, "potentials": {potentials}"#);
        let boxes = (!self.boxes.is_empty()).then(|| contacts.boxes(&self.boxes));
        boxes.into_iter().chain([("bound", format!("{{ {members} }}"))]).collect()
    }
}

/// The goals to which the bound applies.
struct Ends {
    /// The goal configuration. `None` if the goal is a place of the tip.
    to: Option<Configuration>,
    /// All configurations that may be goals.
    goals: Vec<Configuration>,
    /// Boxes around IK solutions that are not goals.
    boxes: Vec<CollisionBox>,
}

impl Ends {
    /// Collects the goals. `None` if they are a curve, or if a checker could not separate them from neighbouring configurations.
    fn of(problem: &MotionProblem, asked: &Overrides) -> Option<Self> {
        let (arm, pieces) = (problem.scene().arm(), problem.goals().pieces());
        let topology = arm.topology();
        if !pieces.iter().all(Segment::is_point) {
            return None;
        }
        let goals: Vec<Configuration> = pieces.iter().map(|goal| inward(&topology, goal.ends()[0])).collect();
        if let ([goal], None) = (&goals[..], asked.goal_tip.filter(|_| asked.elbow.is_none())) {
            return Some(Self { to: Some(*goal), goals, boxes: Vec::new() });
        }
        let solved = inverse(arm, arm.tip_at(*goals.first()?), problem.start());
        // The checker divides ranges into equal parts for all solutions together, including those on other turns.
        let least = MIN_SEPARATION * solved.solutions(arm).len().max(1) as f64;
        if solved.free.is_some() || solved.branches.iter().any(|q| manipulability(arm, *q) <= least) {
            return None;
        }
        let (boxes, left) = blocked_solutions(problem);
        Some(Self { to: None, goals: [goals, left].concat(), boxes })
    }
}

/// Tolerance with which a checker compares a goal with the tip's place, as a fraction of the path length. The checker computes
/// the goal configurations itself, to 10^-12 of the joints' ranges.
const GOAL_TOLERANCE: f64 = 1e-6;

/// Least value of [`manipulability`] for goals of a certificate. Below it, a checker, which divides both joints' ranges into
/// equal parts, cannot separate the configurations with one place of the tip from their neighbours.
const MIN_SEPARATION: f64 = 0.012;

/// Returns a measure, from 0 to 1/4, of how well the joints control the tip. It is the area spanned by the two directions in
/// which the joints move the tip, divided by the square of the sum of their lengths. Zero if the arm is stretched or folded.
fn manipulability(arm: &Arm, q: Configuration) -> f64 {
    const DERIVATIVE_STEP: f64 = 1e-6;
    let ranges = arm.topology().ranges;
    let moved = |k: usize| {
        let (lower, upper) = ranges[k].domain();
        let step = Configuration::from_fn(|i, _| if i == k { DERIVATIVE_STEP * (upper - lower) } else { 0.0 });
        arm.tip_at(q + step) - arm.tip_at(q - step)
    };
    let [a, b] = [moved(0), moved(1)];
    cross(a, b).abs() / (a.norm() + b.norm()).powi(2)
}
