//! Evidence for an answer that a checker of its own can hold against the two files: `docs/certificates.md`.

mod motion;

pub use motion::recorded as certificate_of_recording;

use super::Plan;
use crate::check::{Cell, StuckBox};
use crate::geometry::Point;
use crate::input::{Overrides, TipPoint};
use crate::model::{MotionProblem, OutlineSource, Pair, Scene, Shape, Status, inverse};
use crate::space::Segment;
use serde::Serialize;
use serde_json::json;
use std::collections::BTreeMap;
use thiserror::Error;

/// Why an answer has no certificate.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NoCertificate {
    /// Neither a motion nor a proof.
    #[error("the answer is \"{}\", which claims nothing", .0.name())]
    Answer(Status),
    /// The answer to a task.
    #[error("tasks have no certificates yet")]
    Task,
}

/// A box as it stands in a certificate.
#[derive(Serialize)]
struct Stuck {
    lower: [f64; 2],
    upper: [f64; 2],
    shape: usize,
    part: usize,
}

impl Plan {
    /// The certificate of the answer, where it has one. What `asked` says in place of the world file is in it.
    ///
    /// # Errors
    /// [`NoCertificate`].
    pub fn certificate(&self, asked: &Overrides) -> Result<String, NoCertificate> {
        let plan = self.motion().ok_or(NoCertificate::Task)?;
        if let Some(trajectory) = self.trajectory() {
            return Ok(motion::certificate(&plan.problem, trajectory, asked));
        }
        let proof = plan.answer.verdict.proof().ok_or(NoCertificate::Answer(self.status()))?;
        let problem = &plan.problem;
        let scene = problem.scene();
        let (shapes, parts, boxes) = tables(scene, &[proof.stuck(), &ruled_out(problem)].concat());
        let mut text = "{\n  \"format\": \"cplan certificate 1\",\n  \"answer\": \"infeasible\",\n".to_owned();
        for (name, value) in said(problem, asked) {
            text += &format!("  \"{name}\": {value},\n");
        }
        text += &format!(
            "  \"shapes\": {},\n  \"parts\": {},\n  \"boxes\": {}\n",
            lines(&shapes),
            lines(&parts),
            lines(&boxes)
        );
        Ok(text + "}\n")
    }
}

/// A list in JSON, a line an entry.
fn lines(entries: &[impl Serialize]) -> String {
    let entries: Vec<String> = entries.iter().map(|entry| format!("    {}", json!(entry))).collect();
    format!("[\n{}\n  ]", entries.join(",\n"))
}

/// What was said in place of the world file.
fn said(problem: &MotionProblem, asked: &Overrides) -> Vec<(&'static str, serde_json::Value)> {
    let start = asked.start.map(|_| ("start", json!(problem.start())));
    let goal = asked.goal.map(|_| ("goal", json!(problem.goals().pieces()[0].ends()[0])));
    let tip = asked.goal_tip.map(|TipPoint(tip)| ("goal_tip", json!([tip.x, tip.y])));
    let clearance = asked.clearance.map(|clearance| ("clearance", json!(clearance)));
    start.into_iter().chain(goal).chain(tip).chain(clearance).collect()
}

/// Values of a joint nearer to one another than this, radians or metres, are one.
const SAME: f64 = 1e-6;

/// How much wider than what they are about boxes may be, as shares of the joints' ranges.
const MARGINS: [f64; 6] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7];

/// How often a curve of IK solutions is halved.
const MOST_HALVINGS: u32 = 12;

/// Boxes about the IK solutions that are no goals because they are not free. A checker knows but where the tip is to be, and so
/// that these are among what is to be reached.
fn ruled_out(problem: &MotionProblem) -> Vec<StuckBox> {
    let (scene, goals) = (problem.scene(), problem.goals());
    let (arm, topology) = (scene.arm(), scene.arm().topology());
    let Some(goal) = goals.pieces().first() else { return Vec::new() };
    let solved = inverse(arm, arm.tip_at(goal.ends()[0]), problem.start());
    let is_goal = |piece: &Segment| goals.contains(&topology, piece.at(0.5), SAME);
    let solutions = solved.solutions(arm).into_iter().flat_map(|piece| piece.wrapped(&topology));
    let mut waiting: Vec<(Segment, u32)> = solutions.filter(|piece| !is_goal(piece)).map(|piece| (piece, 0)).collect();
    let mut boxes = Vec::new();
    while let Some((piece, halvings)) = waiting.pop() {
        if let Some(stuck) = stuck_about(scene, &piece) {
            boxes.push(stuck);
        } else if !piece.is_point() && halvings < MOST_HALVINGS {
            let halves = [[0.0, 0.5], [0.5, 1.0]].map(|[a, b]| Segment::new(piece.at(a), piece.at(b)));
            waiting.extend(halves.map(|half| (half, halvings + 1)));
        }
    }
    boxes
}

/// The widest box about a piece in all of which something remains that is in its way.
fn stuck_about(scene: &Scene, piece: &Segment) -> Option<StuckBox> {
    let [from, to] = piece.ends();
    let ranges = scene.arm().topology().ranges.map(|range| range.domain());
    let obstructions = scene.obstructions(piece.at(0.5));
    MARGINS.into_iter().find_map(|margin| {
        let room = ranges.map(|(lower, upper)| margin * (upper - lower));
        let lower = [0, 1].map(|k| from[k].min(to[k]) - room[k]);
        let upper = [0, 1].map(|k| from[k].max(to[k]) + room[k]);
        let claims = obstructions.iter().map(|o| StuckBox { cell: Cell { lower, upper }, pair: o.contact.pair });
        claims.into_iter().find(|stuck| stuck.holds(scene, scene.workspace().clearance))
    })
}

type Tables = (Vec<serde_json::Value>, Vec<serde_json::Value>, Vec<Stuck>);

/// The shapes and the parts of obstacles that the boxes name, each once, and the boxes.
fn tables(scene: &Scene, stuck: &[StuckBox]) -> Tables {
    let (mut shapes, mut parts, mut boxes) = (Vec::new(), Vec::new(), Vec::new());
    let (mut shape_numbers, mut part_numbers) = (BTreeMap::new(), BTreeMap::new());
    for stuck in stuck {
        let Pair { link, part, obstacle, piece } = stuck.pair;
        let shape = *shape_numbers.entry((link, part)).or_insert_with(|| {
            shapes.push(shape(scene, link, part));
            shapes.len() - 1
        });
        let part = *part_numbers.entry((obstacle, piece)).or_insert_with(|| {
            parts.push(part_of(scene, stuck.pair));
            parts.len() - 1
        });
        let [lower, upper] = reaching_out(scene, stuck);
        boxes.push(Stuck { lower, upper, shape, part });
    }
    (shapes, parts, boxes)
}

/// A part of a link by its URDF link and its number among the shapes there. A bar is the last of a link's parts.
fn shape(scene: &Scene, link: usize, part: usize) -> serde_json::Value {
    let link = &scene.arm().links[link];
    let body = &link.parts[part].body;
    let number = link.parts[..part].iter().filter(|part| part.body == *body).count();
    match link.source {
        OutlineSource::Visual => json!({ "link": body, "visual": number }),
        OutlineSource::Bar if part + 1 == link.parts.len() => json!({ "link": body, "bar": 0 }),
        OutlineSource::Collision | OutlineSource::Bar | OutlineSource::None => {
            json!({ "link": body, "collision": number })
        }
    }
}

/// A piece of an obstacle by its corners; a disc is all there is of its obstacle.
fn part_of(scene: &Scene, pair: Pair) -> serde_json::Value {
    let obstacle = pair.obstacle;
    match scene.workspace().obstacles[obstacle].shape {
        Shape::Circle { .. } => json!({ "obstacle": obstacle }),
        Shape::Polygon(_) | Shape::Polyline(_) | Shape::Pieces => {
            let corners: Vec<[f64; 2]> = scene.piece(pair).core().iter().map(|&Point { coords: p }| p.into()).collect();
            json!({ "obstacle": obstacle, "corners": corners })
        }
    }
}

/// The ends of a box. Where it ends with the domain it goes on a little: limits are decimals and half a turn is no number at
/// all, next to which a double leaves a slit.
fn reaching_out(scene: &Scene, stuck: &StuckBox) -> [[f64; 2]; 2] {
    let mut ends = [stuck.cell.lower, stuck.cell.upper];
    for (k, range) in scene.arm().topology().ranges.into_iter().enumerate() {
        let (lower, upper) = range.domain();
        let beyond = |end: f64| 2.0 * f64::EPSILON * end.abs().max(1.0);
        if ends[0][k] <= lower {
            ends[0][k] = lower - beyond(lower);
        }
        if ends[1][k] >= upper {
            ends[1][k] = upper + beyond(upper);
        }
    }
    ends
}
