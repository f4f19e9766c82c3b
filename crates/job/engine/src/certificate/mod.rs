//! Evidence for an answer, which an independent checker verifies against the two files. See `docs/certificates.md`.

mod bound;
mod contacts;
mod line;
mod lower_bound;
mod motion;
mod stated;
mod task;

pub use line::{CertifiedLine, ExcludedSolution};
pub use motion::recorded as certificate_of_recording;
pub use stated::{BoundCertificate, certificate_of_bound, certificate_of_boxes};

use super::{Detail, Motion, Plan};
use crate::result::step_reports;
use contacts::Contacts;
use cplan_handling::Task;
use cplan_judge::{Cell, CollisionBox};
use cplan_legs::TaskAnswer;
use cplan_model::space::{Configuration, JointRange, Segment, Topology};
use cplan_model::{Arm, MotionProblem, Outcome, Scene, Status, inverse};
use cplan_solver::Answer;
use cplan_world::{Digests, Overrides, TipPoint};
use lower_bound::LowerBound;
use serde::Serialize;
use serde_json::json;
use thiserror::Error;

/// Fraction of a bound that the certificate of a motion may lose, so that it stays small and quick to check.
const MAX_BOUND_LOSS: f64 = 1e-3;

/// Reason why an answer has no certificate.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NoCertificate {
    /// The answer is unknown.
    #[error("the answer is \"{}\", which claims nothing", .0.name())]
    Answer(Status),
    /// The answer is that a task is infeasible.
    #[error("there are no certificates for infeasible tasks; the result states the step that fails, and the reason")]
    Task,
    /// The goal of a task is stated on the command line.
    #[error(
        "the certificate includes the tool's joints, so the goal must be in the world file, not on the command line"
    )]
    Goal,
    /// An object rests on another one, and the corners of its outline cannot be moved inwards, as a checker does.
    #[error(
        "the outline of object \"{0}\", which rests on a support, cannot be shrunk by the allowed depth of contact, because it is too fine or touches itself"
    )]
    Outline(String),
    /// The motion has no times, but the world has moving obstacles.
    #[error("the motion has no times, so it is unknown whether it avoids the moving obstacles")]
    Untimed,
    /// No collision box is found around an IK solution that is excluded at a place of a line.
    #[error("an IK solution collides so slightly that a checker could not confirm it; a smaller tolerance may help")]
    Line,
    /// The range of a wrist excludes an IK solution at a place of a line.
    #[error("the proof depends on the range of the wrist, but certificates of lines do not cover the wrist")]
    Wrist,
    /// A line is too large for some placements.
    #[error("the answer is about all placements of the line, but a certificate is about one placement")]
    Placement,
}

impl Plan {
    /// Returns the certificate of the answer. It includes the values in `asked`, which override the world file, and the
    /// digests of the `files` that it refers to.
    ///
    /// # Errors
    /// [`NoCertificate`].
    pub fn certificate(&self, asked: &Overrides, files: Option<&Digests>) -> Result<String, NoCertificate> {
        let (word, evidence) = match self.detail() {
            Detail::Motion { problem, answer } => evidence_of_motion(problem, answer, asked)?,
            Detail::Task { task, answer } => ("found", evidence_of_task(task, answer, asked)?),
        };
        let members = [robot_members(files, self.arm()), members(&self.problem().query, asked), evidence];
        Ok(written(word, members.concat()))
    }
}

/// Returns the status that the answer claims, and the evidence for it.
fn evidence_of_motion(
    problem: &MotionProblem,
    answer: &Answer<Motion>,
    asked: &Overrides,
) -> Result<(&'static str, Evidence), NoCertificate> {
    let mut contacts = Contacts::new(problem.scene());
    let (word, evidence) = match &answer.outcome {
        Outcome::Found(motion) => {
            let mut evidence = vec![motion::evidence(problem.scene().arm(), &motion.timed.trajectory, false)];
            let bound = motion.path.bound.and_then(|stated| LowerBound::of(problem, &stated, asked, MAX_BOUND_LOSS));
            evidence.extend(bound.into_iter().flat_map(|bound| bound.evidence(&mut contacts)));
            ("found", evidence)
        }
        Outcome::Infeasible(proof) => {
            let stuck = [proof.collision_boxes(), &blocked_solutions(problem).0].concat();
            ("infeasible", vec![contacts.boxes(&stuck)])
        }
        Outcome::Unknown(_) => return Err(NoCertificate::Answer(Status::Unknown)),
    };
    Ok((word, contacts.named().into_iter().chain(evidence).collect()))
}

/// Returns the evidence for a task that was found.
fn evidence_of_task(task: &Task, answer: &TaskAnswer, asked: &Overrides) -> Result<Evidence, NoCertificate> {
    if matches!(answer.outcome, Outcome::Infeasible(_)) {
        return Err(NoCertificate::Task);
    }
    task::checkable(task)?;
    if asked.goal.is_some() || asked.goal_tip.is_some() {
        return Err(NoCertificate::Goal);
    }
    let Outcome::Found(motion) = &answer.outcome else { return Err(NoCertificate::Answer(Status::Unknown)) };
    let (steps, _) = step_reports(task, answer);
    let trajectory = &motion.sequence.trajectory;
    Ok(vec![motion::evidence(&task.arm, trajectory, false), task::steps(task, &steps, trajectory)])
}

/// A member of a certificate's JSON object: its name, and its value as JSON text.
type Member = (&'static str, String);

/// Members of a certificate's JSON object.
type Evidence = Vec<Member>;

fn member(name: &'static str, value: impl Serialize) -> Member {
    (name, json!(value).to_string())
}

/// Formats a certificate as text, one member per line.
fn written(answer: &str, members: impl IntoIterator<Item = Member>) -> String {
    let mut text = format!("{{\n  \"format\": \"cplan certificate 1\",\n  \"answer\": \"{answer}\"");
    for (name, value) in members {
        text += &format!(",\n  \"{name}\": {value}");
    }
    text + "\n}\n"
}

/// Formats a list as JSON, one entry per line.
fn lines(entries: &[impl Serialize]) -> String {
    let entries: Vec<String> = entries.iter().map(|entry| format!("    {}", json!(entry))).collect();
    format!("[\n{}\n  ]", entries.join(",\n"))
}

/// Returns the members about the files and the joints.
fn robot_members(files: Option<&Digests>, arm: &Arm) -> Evidence {
    let joints = member("joints", arm.joints.each_ref().map(|joint| &joint.name));
    let Some(Digests { urdf, world, others }) = files else { return vec![joints] };
    let others = (!others.is_empty()).then(|| member("others", others));
    [member("urdf", urdf), member("world", world)].into_iter().chain(others).chain([joints]).collect()
}

/// Returns the members for values that override the world file.
fn members(problem: &MotionProblem, asked: &Overrides) -> Evidence {
    let topology = problem.scene().arm().topology();
    let start = asked.start.map(|_| member("start", inward(&topology, problem.start())));
    let goal = asked.goal.map(|_| member("goal", inward(&topology, problem.goals().pieces()[0].ends()[0])));
    start.into_iter().chain(goal).chain(tip_and_clearance(asked)).collect()
}

/// Returns the members for a goal of the tip and a clearance that override the world file.
fn tip_and_clearance(asked: &Overrides) -> impl Iterator<Item = Member> + use<> {
    let tip = asked.goal_tip.map(|TipPoint(tip)| member("goal_tip", [tip.x, tip.y]));
    let clearance = asked.clearance.map(|clearance| member("clearance", clearance));
    let errors = asked.calibration.map(|errors| member("calibration", errors.to_string()));
    let elbow = asked.elbow.map(|elbow| member("elbow", elbow.name()));
    tip.into_iter().chain(elbow).chain(clearance).chain(errors)
}

/// Values of a joint closer than this count as equal, in radians or metres.
const EQUALITY_TOLERANCE: f64 = 1e-6;

/// Margins of boxes around IK solutions in the order of the attempts, as fractions of the joints' ranges.
const BOX_MARGINS: [f64; 11] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7];

/// Largest number of times that a curve of IK solutions is halved to find boxes around its pieces.
const MAX_HALVINGS: u32 = 12;

/// Returns boxes around the IK solutions that are not free and thus no goals. A checker knows only the place of the tip, so
/// without the boxes it would count them as goals. Also returns the middles of curves of solutions without boxes.
fn blocked_solutions(problem: &MotionProblem) -> (Vec<CollisionBox>, Vec<Configuration>) {
    let (scene, goals) = (problem.scene(), problem.goals());
    let (arm, topology) = (scene.arm(), scene.arm().topology());
    let Some(goal) = goals.pieces().first() else { return (vec![], vec![]) };
    let solved = inverse(arm, arm.tip_at(goal.ends()[0]), problem.start());
    let is_goal = |piece: &Segment| goals.contains(&topology, piece.at(0.5), EQUALITY_TOLERANCE);
    let solutions = solved.solutions(arm).into_iter().flat_map(|piece| piece.wrapped(&topology));
    let mut waiting: Vec<(Segment, u32)> = solutions.filter(|piece| !is_goal(piece)).map(|piece| (piece, 0)).collect();
    let (mut boxes, mut left) = (Vec::new(), Vec::new());
    while let Some((piece, halvings)) = waiting.pop() {
        if let Some(stuck) = collision_box_about(scene, &piece) {
            boxes.push(stuck);
        } else if !piece.is_point() && halvings < MAX_HALVINGS {
            let halves = [[0.0, 0.5], [0.5, 1.0]].map(|[a, b]| Segment::new(piece.at(a), piece.at(b)));
            waiting.extend(halves.map(|half| (half, halvings + 1)));
        } else {
            left.push(piece.at(0.5));
        }
    }
    (boxes, left)
}

/// Returns the widest box around a segment in which one pair of shapes collides everywhere, if there is one.
fn collision_box_about(scene: &Scene, piece: &Segment) -> Option<CollisionBox> {
    let (scene, [from, to]) = (&*scene.inner(), piece.ends());
    let ranges = scene.arm().topology().ranges.map(|range| range.domain());
    // A checker does not accept obstacles that the arm may pass above or below.
    let obstructions = scene.obstructions(piece.at(0.5));
    BOX_MARGINS.into_iter().find_map(|margin| {
        let room = ranges.map(|(lower, upper)| margin * (upper - lower));
        let lower = [0, 1].map(|k| from[k].min(to[k]) - room[k]);
        let upper = [0, 1].map(|k| from[k].max(to[k]) + room[k]);
        let claims = obstructions.iter().map(|o| CollisionBox { cell: Cell { lower, upper }, pair: o.contact.pair });
        claims.into_iter().find(|stuck| stuck.holds(scene, scene.workspace().clearance))
    })
}

/// Values closer than this to a limit are moved inwards, as a fraction of the limit or of the range, whichever is larger. It
/// covers rounding: a limit in degrees, or with many digits, may be up to two units in the last place inside the double that
/// represents it. Near a limit of 0, control points of polynomials are differences of values within the range.
const LIMIT_MARGIN: f64 = 4.0 * f64::EPSILON;

/// Returns a configuration in the form of certificates, with values at a limit moved slightly inwards.
fn inward(topology: &Topology, q: Configuration) -> Configuration {
    Configuration::from_fn(|k, _| match topology.ranges[k] {
        JointRange::Interval { lower, upper } => {
            let room = |limit: f64| LIMIT_MARGIN * limit.abs().max(upper - lower);
            q[k].min(upper - room(upper)).max(lower + room(lower))
        }
        JointRange::Circle => q[k],
    })
}

/// Returns the least and greatest values of a box, which is split in two at half a turn of a circle. A part that ends at the end
/// of the domain is extended slightly: limits are decimals, but half a turn is irrational, so the nearest double would leave a
/// gap.
fn reaching_out(scene: &Scene, stuck: &CollisionBox) -> Vec<[[f64; 2]; 2]> {
    let mut parts = vec![[stuck.cell.lower, stuck.cell.upper]];
    for (k, range) in scene.arm().topology().ranges.into_iter().enumerate() {
        let (lower, upper) = range.domain();
        let turns: &[f64] = if range.is_circle() { &[-1.0, 0.0, 1.0] } else { &[0.0] };
        let turned = |ends: [[f64; 2]; 2]| {
            turns.iter().map(move |turn| {
                ends.map(|mut end| {
                    end[k] += turn * (upper - lower);
                    end
                })
            })
        };
        parts = parts.into_iter().flat_map(turned).filter(|[from, to]| from[k] < upper && lower < to[k]).collect();
        let beyond = |end: f64| 2.0 * f64::EPSILON * end.abs().max(1.0);
        for [from, to] in &mut parts {
            if from[k] <= lower {
                from[k] = lower - beyond(lower);
            }
            if to[k] >= upper {
                to[k] = upper + beyond(upper);
            }
        }
    }
    parts
}
