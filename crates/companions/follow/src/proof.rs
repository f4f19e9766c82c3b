//! Proofs that no motion follows a line.
//!
//! All configurations that put the tip within the tolerance of a place lie in boxes, one for each IK solution and whole
//! turn ([`Kinematics::solution_box`]). If all these boxes are outside the joint limits, or collide as a whole, then no
//! motion follows the line past that place.
//!
//! While the line stays farther than the tolerance from all singular places, these boxes form separate bands. A motion
//! cannot change from one band to another. So there is no motion if each band is excluded at some place of the stretch,
//! even if these places differ. The range of a wrist excludes solutions as well (`proof_wrist`).

use crate::nodes::{Nodes, chord};
use crate::proof_wrist::{self, Winding, WristExcess};
use crate::sheets::{LISTED_BEYOND_LIMITS, Sheets};
use crate::wrist::WristAlong;
use cplan_deviation::{Kinematics, Line, Place, sag};
use cplan_geometry::Point;
use cplan_interrupt::checkpoint;
use cplan_judge::{Deviation, Posture};
use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Pair, Scene};
use cplan_text::{length, length_down};

/// Greatest change of a joint between both ends of a part. A smaller change cannot hide a whole turn.
const MAX_STEP: f64 = 0.5;

/// Greatest length of a part as a share of its distance from joint 1. A shorter part cannot hide a whole turn.
const MAX_STEP_SHARE: f64 = 0.1;

/// Allowance for rounding when distances are compared with the tolerance, as a share of the distances.
const ROUNDING: f64 = 1e-12;

/// A proof that no motion follows a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Infeasible {
    /// The reason.
    pub cause: Cause,
    /// The place of the reason. For [`Cause::NoChange`], the first excluded place.
    pub place: Place,
    /// All exclusions of the proof: one for each IK solution and whole turn within the limits or near them. Empty if
    /// the place is out of reach.
    pub evidence: Vec<Exclusion>,
}

/// The reason why no motion follows a line.
#[derive(Debug, Clone, PartialEq)]
pub enum Cause {
    /// The tip cannot come within the tolerance of the place.
    OutOfReach {
        /// Lower bound on the distance of the place from all points that the tip can reach, metres.
        by: f64,
    },
    /// Two points of the line are farther apart than any two places of the tip, so it cannot be followed at any
    /// placement. Only [`crate::fit`] gives this reason.
    TooLarge {
        /// Distance between two points of the line, metres.
        width: f64,
        /// Upper bound on the distance between two places of the tip, metres.
        reach: f64,
    },
    /// Each IK solution at the place is excluded.
    Excluded(Vec<Exclusion>),
    /// Each IK solution is excluded somewhere on a stretch, and cannot be changed within the stretch.
    NoChange(Vec<Exclusion>),
}

/// An IK solution that is excluded at a place, together with all configurations near it whose tip is within the
/// tolerance of the place.
#[derive(Debug, Clone, PartialEq)]
pub struct Exclusion {
    /// Number of the IK solution, 0 or 1.
    pub solution: usize,
    /// The place on the line.
    pub place: Place,
    /// The joint values that put the tip at the place.
    pub q: [f64; 2],
    /// The reason for the exclusion.
    pub by: Obstacle,
}

/// The reason why an IK solution is excluded at a place.
#[derive(Debug, Clone, PartialEq)]
pub enum Obstacle {
    /// The joint with this index, 0 or 1, is outside its limits.
    Limit(usize),
    /// These shapes collide, or are nearer than the clearance.
    Collision(Pair),
    /// The wrist cannot give the tool its angle.
    Wrist(WristExcess),
}

/// The input of a search for a proof.
#[derive(Clone, Copy)]
pub(crate) struct Prover<'a> {
    pub scene: &'a Scene,
    pub inner: &'a Scene,
    pub kinematics: &'a Kinematics<'a>,
    pub line: &'a Line<'a>,
    pub nodes: &'a Nodes,
    pub sheets: &'a Sheets<'a>,
    pub tolerance: f64,
    pub wrist: Option<WristAlong>,
}

/// Returns a proof that the tip cannot reach a node, if there is one.
pub(crate) fn out_of_reach(kinematics: &Kinematics, nodes: &Nodes, tolerance: f64) -> Option<Infeasible> {
    let off = |place: &Place| {
        let scale = place.point.norm() + kinematics.arm.base.norm() + kinematics.arm.reach();
        let by = kinematics.distance_out_of_reach(place.point) - ROUNDING * scale;
        (by > tolerance).then_some(by)
    };
    nodes.nodes.iter().find_map(|node| {
        let by = off(&node.place)?;
        Some(Infeasible { cause: Cause::OutOfReach { by }, place: node.place, evidence: Vec::new() })
    })
}

impl Prover<'_> {
    /// Returns a proof that no motion follows the line, if one is found.
    pub fn prove(&self) -> Option<Infeasible> {
        if !self.sheets.is_complete {
            return None;
        }
        let count = self.sheets.sheets.len();
        let excluded: Vec<Vec<Option<Exclusion>>> = (0..self.nodes.nodes.len())
            .map(|node| (0..count).map(|sheet| self.exclusion(node, sheet)).collect())
            .collect();
        self.at_one_place(&excluded).or_else(|| self.on_a_stretch(&excluded))
    }

    /// Returns the reason why no motion follows the line from one sheet to another, if this is proven. The motion must
    /// stay on one sheet along the whole line, but the sheets differ, or the sheet is excluded somewhere.
    pub fn prove_between(&self, [from, to]: [usize; 2]) -> Option<String> {
        if !(0..self.nodes.parts.len()).all(|part| self.is_separate(part)) {
            return None;
        }
        if from != to {
            return Some("the IK solution cannot change along the line".into());
        }
        let mut winding = Winding::new(self.sheets.sheets.len());
        let excluded = |node: usize| self.exclusion(node, from).or_else(|| winding.add(self, node, from));
        let excluded = (0..self.nodes.nodes.len()).find_map(excluded)?;
        Some(format!("{} at {}", excluded.describe(self.scene), excluded.place))
    }

    fn at_one_place(&self, excluded: &[Vec<Option<Exclusion>>]) -> Option<Infeasible> {
        let blocked =
            |node: &usize| self.nodes.nodes[*node].solutions.is_some() && excluded[*node].iter().all(Option::is_some);
        let node = (0..excluded.len()).find(blocked)?;
        let mut list: Vec<Exclusion> = excluded[node].iter().flatten().cloned().collect();
        if list.is_empty() {
            // No sheet is within the limits at any node.
            let solutions = self.sheets.solutions.clone();
            list = solutions.map(|solution| self.outside(node, solution)).collect::<Option<_>>()?;
        }
        let (place, evidence) = (self.place(node), list.clone());
        self.is_box_known(node).then(|| Infeasible { cause: Cause::Excluded(one_each(list)), place, evidence })
    }

    fn on_a_stretch(&self, excluded: &[Vec<Option<Exclusion>>]) -> Option<Infeasible> {
        let count = self.sheets.sheets.len();
        let mut found: Vec<Option<Exclusion>> = vec![None; count];
        let mut winding = Winding::new(count);
        for (node, here) in excluded.iter().enumerate() {
            if node > 0 && !self.is_separate(node - 1) {
                found = vec![None; count];
                winding.forget();
            }
            for (sheet, (known, new)) in found.iter_mut().zip(here).enumerate() {
                let wound = winding.add(self, node, sheet);
                // Keep the last exclusion of each sheet, because it is closest to those of the other sheets.
                *known = new.clone().or(wound).or(known.take());
            }
            if count > 0 && found.iter().all(Option::is_some) {
                let mut list: Vec<Exclusion> = found.into_iter().flatten().collect();
                list.sort_by(|a, b| a.place.distance.total_cmp(&b.place.distance));
                let place = list[0].place;
                let evidence = list.clone();
                return Some(Infeasible { cause: Cause::NoChange(one_each(list)), place, evidence });
            }
        }
        None
    }

    fn place(&self, node: usize) -> Place {
        self.nodes.nodes[node].place
    }

    fn is_box_known(&self, node: usize) -> bool {
        let point = self.place(node).point;
        self.sheets
            .solutions
            .clone()
            .all(|solution| self.kinematics.solution_box(point, solution, self.tolerance).is_some())
    }

    /// Returns true if the boxes of all sheets stay separate on a part, and the sheets are continuous there.
    fn is_separate(&self, part: usize) -> bool {
        let own = &self.nodes.parts[part];
        let (Some(from), Some(to)) = (self.nodes.nodes[part].solutions, self.nodes.nodes[part + 1].solutions) else {
            return false;
        };
        let [a, b]: [Point; 2] = chord(self.line, own);
        let off = sag(self.line.curve(own.piece), own.ends);
        let scale = a.norm() + b.norm() + self.kinematics.arm.base.norm() + self.kinematics.arm.reach();
        let away = (a - self.kinematics.arm.base).norm();
        let joints = &self.kinematics.arm.joints;
        let turns_little = (0..2)
            .all(|k| !joints[k].joint_type.is_revolute() || (0..2).all(|s| (to[s][k] - from[s][k]).abs() <= MAX_STEP));
        let is_short = self.kinematics.arm.is_gantry()
            || (b - a).norm() + off + self.tolerance <= MAX_STEP_SHARE * away
            || !joints[0].joint_type.is_revolute();
        let apart = self.kinematics.distance_from_singular([a, b], off) - ROUNDING * scale;
        self.nodes.nodes[part + 1].is_continued && turns_little && is_short && apart > self.tolerance
    }

    /// Returns the reason why a sheet is excluded at a node, if it is proven.
    fn exclusion(&self, node: usize, sheet: usize) -> Option<Exclusion> {
        checkpoint();
        let (middle, half) = self.solution_box(node, sheet)?;
        if let Some(joint) = (0..2).find(|&k| self.is_outside(k, middle[k], half[k])) {
            return self.exclusion_at(node, sheet, Obstacle::Limit(joint));
        }
        let collision = self.collision(middle, half).map(Obstacle::Collision);
        let by = collision.or_else(|| proof_wrist::outside(self, node, middle, half).map(Obstacle::Wrist))?;
        self.exclusion_at(node, sheet, by)
    }

    /// Creates the exclusion of a sheet at a node for a reason.
    pub fn exclusion_at(&self, node: usize, sheet: usize, by: Obstacle) -> Option<Exclusion> {
        let q = self.sheets.unlimited(node, sheet)?;
        Some(Exclusion { solution: self.sheets.sheets[sheet].solution, place: self.place(node), q: [q[0], q[1]], by })
    }

    /// Returns the box of a sheet at a node: its middle, and half of its size. `None` if it is unknown.
    pub fn solution_box(&self, node: usize, sheet: usize) -> Option<(Configuration, [f64; 2])> {
        let q = self.sheets.unlimited(node, sheet)?;
        let solution = self.sheets.sheets[sheet].solution;
        let known = self.kinematics.solution_box(self.place(node).point, solution, self.tolerance)?;
        // The kinematics give the box up to whole turns. Its middle is near the solution.
        let middle = self.kinematics.near(known.middle, q);
        let is_near = (0..2).all(|k| (middle[k] - q[k]).abs() <= known.half[k] + 1e-6);
        // The box must be smaller than this limit, so that the boxes of sheets that are not listed are outside the limits.
        let is_known = is_near && known.half[0].max(known.half[1]) < LISTED_BEYOND_LIMITS;
        is_known.then_some((middle, known.half))
    }

    fn is_outside(&self, joint: usize, middle: f64, half: f64) -> bool {
        match self.kinematics.arm.joints[joint].range {
            JointRange::Circle => false,
            JointRange::Interval { lower, upper } => middle + half < lower || middle - half > upper,
        }
    }

    /// Returns the exclusion of an IK solution that is outside the limits with every number of whole turns.
    fn outside(&self, node: usize, solution: usize) -> Option<Exclusion> {
        let place = self.place(node);
        let known = self.kinematics.solution_box(place.point, solution, self.tolerance)?;
        let is_outside = |k: usize| match self.kinematics.arm.joints[k].range {
            JointRange::Circle => false,
            JointRange::Interval { lower, upper } => {
                let middle = (lower + upper) / 2.0;
                let room = (upper - lower) / 2.0 + known.half[k];
                if self.kinematics.arm.joints[k].joint_type.is_revolute() {
                    let turn = std::f64::consts::TAU;
                    let away = known.middle[k] - middle;
                    // Compare the distance between the middle of the range and the nearest equivalent value.
                    room < turn / 2.0 && (away - (away / turn).round() * turn).abs() > room
                } else {
                    (known.middle[k] - middle).abs() > room
                }
            }
        };
        let joint = (0..2).find(|&k| is_outside(k))?;
        let q = [known.middle[0], known.middle[1]];
        Some(Exclusion { solution, place, q, by: Obstacle::Limit(joint) })
    }

    /// Returns a pair that violates the clearance in the whole box.
    fn collision(&self, middle: Configuration, half: [f64; 2]) -> Option<Pair> {
        let clearance = self.scene.workspace().clearance;
        let posture = Posture::new(self.inner, middle);
        let here = Deviation::Box(half);
        let meets = |pair: &Pair| {
            let between = posture.disc_bound(*pair, Deviation::Box([0.0; 2]));
            between < clearance.max(0.0) && posture.greatest(*pair, here) < clearance
        };
        self.inner.pairs().iter().copied().find(meets)
    }
}

/// Returns one exclusion per IK solution. Collisions take precedence, because a violated limit may concern only one
/// number of whole turns.
fn one_each(mut list: Vec<Exclusion>) -> Vec<Exclusion> {
    list.sort_by_key(|exclusion| matches!(exclusion.by, Obstacle::Limit(_)));
    let mut kept: Vec<Exclusion> = Vec::new();
    for exclusion in list {
        if kept.iter().all(|known| known.solution != exclusion.solution) {
            kept.push(exclusion);
        }
    }
    kept
}

impl Infeasible {
    /// Describes the reason in words.
    pub fn describe(&self) -> String {
        let at = self.place;
        match &self.cause {
            Cause::OutOfReach { by } => format!("the line is {} out of reach at {at}", length_down(*by)),
            Cause::TooLarge { width, reach } => {
                let [width, reach] = [length_down(*width), length(*reach)];
                format!(
                    "the line is too large: two of its points are {width} apart, but the places of the tip are at most {reach} apart"
                )
            }
            Cause::Excluded(_) => format!("no IK solution is possible at {at}"),
            Cause::NoChange(list) if list.iter().all(|e| matches!(e.by, Obstacle::Wrist(WristExcess::Turn(..)))) => {
                format!("the wrist cannot turn far enough for the tool's angle before {at}")
            }
            Cause::NoChange(list) => {
                let last = list.last().map_or(at, |exclusion| exclusion.place);
                format!("the IK solution must change between {at} and {last}, but cannot")
            }
        }
    }
}

impl From<Infeasible> for String {
    fn from(infeasible: Infeasible) -> Self {
        infeasible.describe()
    }
}

impl Exclusion {
    /// Describes the exclusion in words.
    pub fn describe(&self, scene: &Scene) -> String {
        match &self.by {
            Obstacle::Limit(joint) => scene.arm().joints[*joint].explain_outside(self.q[*joint]),
            Obstacle::Wrist(excess) => excess.describe(),
            Obstacle::Collision(pair) => scene.explain_contact(*pair),
        }
    }
}
