//! Evidence for a motion of the tip along a line, or that no motion follows the line.

use super::contacts::Contacts;
use super::{
    BOX_MARGINS, Evidence, Member, NoCertificate, lines, member, motion, robot_members, tip_and_clearance, written,
};
use cplan_deviation::{Deviation, Foot, Kinematics, Line, Place};
use cplan_handling::{FollowedLine, Piece};
use cplan_judge::{Cell, CollisionBox};
use cplan_model::space::Configuration;
use cplan_model::{Arm, Elbow, Pair, Scene};
use cplan_motion::Trajectory;
use cplan_toolpath::{Curve, Toolpath};
use cplan_world::{Digests, Overrides};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// A line that the tip should follow, and the files of the robot and the world.
#[derive(Clone, Copy)]
pub struct CertifiedLine<'a> {
    /// The arm and its obstacles.
    pub scene: &'a Scene,
    /// The line.
    pub line: &'a Toolpath,
    /// Greatest distance between the tip and the line, metres.
    pub tolerance: f64,
    /// The side of the elbow along the line; `None` for either side.
    pub elbow: Option<Elbow>,
    /// The values that replace those of the world file.
    pub asked: &'a Overrides,
    /// The digests of the files.
    pub files: Option<&'a Digests>,
}

/// An IK solution that is excluded at a place of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExcludedSolution {
    /// The place.
    pub place: Place,
    /// Number of the IK solution, 0 or 1.
    pub solution: usize,
    /// The joint values of the solution, including whole turns.
    pub q: [f64; 2],
    /// The shapes that collide. `None` if a joint is outside its limits.
    pub pair: Option<Pair>,
}

impl CertifiedLine<'_> {
    /// Returns the certificate of a motion along the line, as controllers execute it. Linear in the number of samples.
    pub fn of_motion(&self, trajectory: &Trajectory) -> String {
        let arm = self.scene.arm();
        let motion = motion::evidence(arm, trajectory, true);
        let last = trajectory.time.len() - 1;
        let places = ("places", lines(&places(arm, self.line, self.tolerance, &motion_pieces(trajectory, [0, last]))));
        self.written("found", places, [motion])
    }

    /// Returns the certificate that no motion follows the line past a place, or past the stretch between several places, because
    /// all IK solutions are excluded there. If `excluded` is empty, the place `from` is out of reach.
    ///
    /// # Errors
    /// [`NoCertificate::Line`] if no collision box is found around a solution.
    pub fn of_exclusions(&self, from: &Place, excluded: &[ExcludedSolution]) -> Result<String, NoCertificate> {
        let position = |place: &Place| place.piece as f64 + place.u;
        let positions = || excluded.iter().map(|solution| position(&solution.place)).chain([position(from)]);
        let stretch = [positions().fold(f64::INFINITY, f64::min), positions().fold(0.0, f64::max)];
        let colliding = excluded.iter().filter(|solution| solution.pair.is_some());
        let boxes: Option<Vec<CollisionBox>> = colliding.map(|solution| self.collision_box(solution)).collect();
        let Some(boxes) = boxes else { return Err(NoCertificate::Line) };
        let mut contacts = Contacts::new(self.scene);
        let boxes = contacts.boxes(&boxes);
        let stretch = member("stretch", stretch);
        Ok(self.written("infeasible", stretch, contacts.named().into_iter().chain([boxes])))
    }

    fn written(&self, answer: &str, evidence: Member, others: impl IntoIterator<Item = Member>) -> String {
        let members = robot_members(self.files, self.scene.arm()).into_iter().chain(tip_and_clearance(self.asked));
        written(answer, members.chain([self.line_member(evidence)]).chain(others))
    }

    /// Returns the line as a member of the certificate's JSON, with its part in the evidence.
    fn line_member(&self, evidence: Member) -> Member {
        let mut members: Evidence = vec![member("tolerance", self.tolerance)];
        members.extend(self.elbow.map(|elbow| member("elbow", elbow.name())));
        members.extend(pieces_members(self.line));
        members.push(evidence);
        let members: Vec<String> = members.iter().map(|(name, value)| format!("\"{name}\": {value}")).collect();
        ("line", format!("{{ {} }}", members.join(",\n  ")))
    }

    /// Returns the widest collision box found around all configurations of a solution that keep the tip within the tolerance.
    fn collision_box(&self, excluded: &ExcludedSolution) -> Option<CollisionBox> {
        let scene = &*self.scene.inner();
        let (arm, q) = (scene.arm(), Configuration::from(excluded.q));
        let known = Kinematics::new(arm).solution_box(excluded.place.point, excluded.solution, self.tolerance)?;
        let middle = Configuration::from_fn(|k, _| match arm.joints[k].joint_type.is_revolute() {
            true => known.middle[k] + ((q[k] - known.middle[k]) / TAU).round() * TAU,
            false => known.middle[k],
        });
        let ranges = arm.topology().ranges.map(|range| range.domain());
        let mut pairs: Vec<Pair> = scene.obstructions(middle).into_iter().map(|o| o.contact.pair).collect();
        pairs.extend(excluded.pair);
        let of_margin = |margin: f64| {
            let half = [0, 1].map(|k| known.half[k] + margin * (ranges[k].1 - ranges[k].0));
            let cell = Cell { lower: [0, 1].map(|k| middle[k] - half[k]), upper: [0, 1].map(|k| middle[k] + half[k]) };
            let claims = pairs.iter().map(|pair| CollisionBox { cell, pair: *pair });
            claims.into_iter().find(|stuck| stuck.holds(scene, scene.workspace().clearance))
        };
        BOX_MARGINS.into_iter().chain([0.0]).find_map(of_margin)
    }
}

/// Returns the line of a step in the form of certificates. `motion` has the pieces of the motion that follows it.
pub(super) fn step_line(arm: &Arm, line: &FollowedLine, motion: &[Piece]) -> Value {
    let places = places(arm, &line.path, line.tolerance, motion);
    let (pieces, travels) = pieces_and_travels(&line.path);
    match travels[..] {
        [] => json!({ "pieces": pieces, "places": places }),
        _ => json!({ "pieces": pieces, "travels": travels, "places": places }),
    }
}

/// Returns the members of a line for its pieces and travels.
fn pieces_members(line: &Toolpath) -> Evidence {
    let (pieces, travels) = pieces_and_travels(line);
    let travels = (!travels.is_empty()).then(|| member("travels", travels));
    [("pieces", lines(&pieces))].into_iter().chain(travels).collect()
}

/// Returns the pieces of a line in the form of certificates, and the indices of its travels.
fn pieces_and_travels(line: &Toolpath) -> (Vec<Value>, Vec<usize>) {
    let travels = line.pieces().iter().enumerate().filter(|(_, piece)| piece.is_travel);
    (line.pieces().iter().map(|piece| curve(&piece.curve)).collect(), travels.map(|(number, _)| number).collect())
}

/// Returns moments of a motion, and the positions of the tip on the line at these moments. A moment is a sample plus the share of
/// the time until the next one; a position is a piece plus its parameter. `motion` has the pieces of the motion, at least one.
fn places(arm: &Arm, line: &Toolpath, tolerance: f64, motion: &[Piece]) -> Vec<[f64; 2]> {
    let last = Foot { piece: line.pieces().len() - 1, u: 1.0 };
    let ends = [Foot { piece: 0, u: 0.0 }, last];
    let (kinematics, line) = (Kinematics::new(arm), Line::new(line));
    let deviation = Deviation { kinematics: &kinematics, line: &line, tolerance, ends };
    deviation.pairing(motion).pairs.into_iter().map(|(moment, foot)| [moment, foot.piece as f64 + foot.u]).collect()
}

/// Returns the pieces of a motion between two samples, or a piece at rest if both are the same.
pub(super) fn motion_pieces(trajectory: &Trajectory, [first, last]: [usize; 2]) -> Vec<Piece> {
    let end = |k: usize| [trajectory.position[k].into(), trajectory.velocity[k].into()];
    let piece = |k: usize| Piece::hermite(trajectory.time[k], trajectory.time[k + 1], end(k), end(k + 1));
    let q = trajectory.position[first].into();
    if first == last { vec![Piece::line(0.0, 1.0, q, q)] } else { (first..last).map(piece).collect() }
}

/// Returns a curve in the form of certificates.
fn curve(curve: &Curve) -> Value {
    match *curve {
        Curve::Line { from, to } => json!({ "straight": [from, to] }),
        Curve::Arc { center, radius, from, by, growth: 0.0 } => {
            json!({ "arc": { "center": center, "radius": radius, "from": from, "by": by } })
        }
        Curve::Arc { center, radius, from, by, growth } => {
            json!({ "arc": { "center": center, "radius": radius, "from": from, "by": by, "growth": growth } })
        }
        Curve::Cubic(points) => json!({ "cubic": points }),
    }
}
