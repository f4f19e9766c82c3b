//! The lower bound of a result, with the evidence that a checker needs.

use super::bound::{LeastLength, Potential, Ways};
use super::contacts::Contacts;
use super::{Evidence, inward, lines, ruled_out};
use crate::bound::{Bound, evidence, motions};
use cplan_core::check::StuckBox;
use cplan_core::model::{Arm, MotionProblem, inverse};
use cplan_core::space::{Configuration, Metric, Segment};
use cplan_geometry::cross;
use cplan_proofs::ClosedSegment;
use cplan_world::Overrides;
use serde_json::json;

/// Evidence that no motion is shorter than a length. The length is the bound of a result, up to a small tolerance.
///
/// The motions lead to one configuration, or to any configuration that puts the tip at the requested place. In the
/// latter case, boxes cover the configurations that are not free.
pub(super) struct LowerBound {
    least: LeastLength,
    metric: Metric,
    to: Option<Configuration>,
    boxes: Vec<StuckBox>,
}

impl LowerBound {
    /// Computes the evidence again. `None` if the goals form a curve, or if a checker could not separate them from
    /// neighbouring configurations.
    pub fn of(problem: &MotionProblem, stated: &Bound, asked: &Overrides, care: &Care) -> Option<Self> {
        let motions = motions(problem, stated.metric);
        let topology = problem.scene().arm().topology();
        let Ends { to, goals, boxes } = Ends::of(problem, asked)?;
        let ways = Ways {
            topology: &topology,
            metric: stated.metric,
            start: topology.wrap(motions.start),
            goals: &goals,
            about: if to.is_some() { 0.0 } else { ABOUT_A_GOAL },
            limit: stated.upper,
        };
        let evidence = evidence(&motions, stated);
        let of = |looks: usize| LeastLength::new(&ways, evidence.segments(motions.scene, motions.clearance, looks));
        let (first, more) = care.looks.split_first()?;
        let mut least = of(*first)?;
        for looks in more {
            if least.length < stated.lower * (1.0 - care.loss) {
                least = of(*looks).filter(|closer| closer.length > least.length).unwrap_or(least);
            }
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

    /// Returns the members of a certificate that prove the bound.
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
            Metric::Time { speeds } => json!({ "speeds": speeds }),
        };
        let to = self.to.map_or_else(String::new, |to| format!("\"to\": {}, ", json!(to)));
        let (length, walls, potentials) = (self.least.length, lines(&walls), lines(&potentials));
        let members =
            format!(r#"{to}"length": {length}, "metric": {metric}, "walls": {walls}, "potentials": {potentials}"#);
        let boxes = (!self.boxes.is_empty()).then(|| contacts.boxes(&self.boxes));
        boxes.into_iter().chain([("bound", format!("{{ {members} }}"))]).collect()
    }
}

/// How closely walls are examined.
pub(super) struct Care {
    /// Numbers of samples along a wall in either direction. The checker examines them as well, and takes longer. The
    /// first number suffices for most walls; the next ones are used ...
    looks: &'static [usize],
    /// ... if the bound loses more than this share. Where shapes separate slowly, as in a slot, walls end too early.
    loss: f64,
}

impl Care {
    /// For certificates, which must be small and quick to check.
    pub const USUAL: Self = Self { looks: &[60, 300], loss: 1e-3 };

    /// For bounds that must be proven in full.
    pub const CLOSE: Self = Self { looks: &[60, 300, 2000], loss: 1e-7 };
}

/// Where the motions of a bound lead.
struct Ends {
    /// The goal configuration, if there is only one. `None` if the goal is a place of the tip.
    to: Option<Configuration>,
    /// All configurations that may count as goals.
    goals: Vec<Configuration>,
    /// Boxes around solutions that are not goals.
    boxes: Vec<StuckBox>,
}

impl Ends {
    /// Collects the goals. `None` if they form a curve, or if a checker could not separate them from neighbouring
    /// configurations.
    fn of(problem: &MotionProblem, asked: &Overrides) -> Option<Self> {
        let (arm, pieces) = (problem.scene().arm(), problem.goals().pieces());
        let topology = arm.topology();
        if !pieces.iter().all(Segment::is_point) {
            return None;
        }
        let goals: Vec<Configuration> = pieces.iter().map(|goal| inward(&topology, goal.ends()[0])).collect();
        if let ([goal], None) = (&goals[..], asked.goal_tip) {
            return Some(Self { to: Some(*goal), goals, boxes: Vec::new() });
        }
        let solved = inverse(arm, arm.tip_at(*goals.first()?), problem.start());
        // All solutions share the parts that a checker examines, including solutions on other turns.
        let least = STRETCHED * solved.solutions(arm).len().max(1) as f64;
        if solved.free.is_some() || solved.branches.iter().any(|q| tells_apart(arm, *q) <= least) {
            return None;
        }
        let (boxes, left) = ruled_out(problem);
        Some(Self { to: None, goals: [goals, left].concat(), boxes })
    }
}

/// Tolerance of a checker for the place of the tip, as a share of the path length. The checker finds these
/// configurations itself, down to 10^-12 of the joints' ranges.
const ABOUT_A_GOAL: f64 = 1e-6;

/// Below this value of [`tells_apart`], a checker cannot separate configurations that put the tip at a place from their
/// neighbours, because it divides both joints' ranges into equal shares.
const STRETCHED: f64 = 0.012;

/// Computes the area spanned by the two directions in which the joints move the tip, divided by the square of the sum
/// of their lengths. At most a quarter; zero if the arm is stretched or folded.
fn tells_apart(arm: &Arm, q: Configuration) -> f64 {
    const STEP: f64 = 1e-6;
    let ranges = arm.topology().ranges;
    let moved = |k: usize| {
        let (lower, upper) = ranges[k].domain();
        let step = Configuration::from_fn(|i, _| if i == k { STEP * (upper - lower) } else { 0.0 });
        arm.tip_at(q + step) - arm.tip_at(q - step)
    };
    let [a, b] = [moved(0), moved(1)];
    cross(a, b).abs() / (a.norm() + b.norm()).powi(2)
}
