//! Evidence for an answer that a checker of its own can hold against the two files: `docs/certificates.md`.

use super::Plan;
use crate::check::{CheckedProof, StuckBox};
use crate::geometry::Point;
use crate::input::Overrides;
use crate::model::{MotionProblem, OutlineSource, Pair, Scene, Shape, Status};
use serde::Serialize;
use serde_json::json;
use std::collections::BTreeMap;
use thiserror::Error;

/// Why an answer has no certificate.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NoCertificate {
    /// Another answer than "infeasible".
    #[error("only \"infeasible\" has a certificate yet, and the answer is \"{}\"", .0.name())]
    Answer(Status),
    /// The answer to a task.
    #[error("tasks have no certificates yet")]
    Task,
    /// A goal that is more than one configuration.
    #[error("goals that are places of the tip have no certificates yet; a goal's joint values do")]
    Tip,
    /// A link whose shapes are not those that the URDF has to collide with.
    #[error("link \"{link}\" has no <collision> geometry of its own, without which there is no certificate yet")]
    Outline {
        /// Its name.
        link: String,
    },
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
        let proof = plan.answer.verdict.proof().ok_or(NoCertificate::Answer(self.status()))?;
        let problem = &plan.problem;
        if asked.goal_tip.is_some() || problem.goals().pieces().len() != 1 {
            return Err(NoCertificate::Tip);
        }
        let scene = problem.scene();
        let (shapes, parts, boxes) = tables(scene, proof)?;
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
    let clearance = asked.clearance.map(|clearance| ("clearance", json!(clearance)));
    start.into_iter().chain(goal).chain(clearance).collect()
}

type Tables = (Vec<serde_json::Value>, Vec<serde_json::Value>, Vec<Stuck>);

/// The shapes and the parts of obstacles that the boxes name, each once, and the boxes.
fn tables(scene: &Scene, proof: &CheckedProof) -> Result<Tables, NoCertificate> {
    let (mut shapes, mut parts, mut boxes) = (Vec::new(), Vec::new(), Vec::new());
    let (mut shape_numbers, mut part_numbers) = (BTreeMap::new(), BTreeMap::new());
    for stuck in proof.stuck() {
        let Pair { link, part, obstacle, piece } = stuck.pair;
        let shape = match shape_numbers.get(&(link, part)) {
            Some(number) => *number,
            None => {
                shapes.push(shape(scene, link, part)?);
                shape_numbers.insert((link, part), shapes.len() - 1);
                shapes.len() - 1
            }
        };
        let part = *part_numbers.entry((obstacle, piece)).or_insert_with(|| {
            parts.push(part_of(scene, stuck.pair));
            parts.len() - 1
        });
        let [lower, upper] = reaching_out(scene, stuck);
        boxes.push(Stuck { lower, upper, shape, part });
    }
    Ok((shapes, parts, boxes))
}

/// A part of a link by its URDF link and its number among the collision shapes there.
fn shape(scene: &Scene, link: usize, part: usize) -> Result<serde_json::Value, NoCertificate> {
    let link = &scene.arm().links[link];
    if link.source != OutlineSource::Collision {
        return Err(NoCertificate::Outline { link: link.name.clone() });
    }
    let body = &link.parts[part].body;
    let collision = link.parts[..part].iter().filter(|part| part.body == *body).count();
    Ok(json!({ "link": body, "collision": collision }))
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
