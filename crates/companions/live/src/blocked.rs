//! Answers about blocked starts and goals: position, obstacles in contact, and a description that does not refer to
//! files.

use super::answer::refused;
use super::protocol::AnswerReply;
use cplan_model::space::{Configuration, Segment};
use cplan_model::{Goal, Obstruction, Scene, inverse};
use cplan_robot::{DiagnosticKind, InputError};
use cplan_view::output::names::capitalized;
use cplan_world::LoadedScene;
use serde_json::{Value, json};

/// Largest number of blocked configurations that are drawn. More of them would hide each other.
const MAX_SHOWN: usize = 4;

/// Depth up to which overlapping shapes are reported as touching, in metres.
const TOUCHING_DEPTH: f64 = 1e-9;

/// Returns the answer about a world whose start or goal is unusable.
pub fn refusal(loaded: &LoadedScene, error: &InputError, near: Configuration) -> AnswerReply {
    let [start, goal] = loaded.stated_ends();
    let kinds = error.diagnostics().iter().map(|diagnostic| diagnostic.kind);
    let (about, place) = match kinds.into_iter().find(|kind| *kind != DiagnosticKind::Input) {
        Some(DiagnosticKind::Start) => ("start", start),
        Some(DiagnosticKind::Goal) => ("goal", goal),
        _ => ("world", None),
    };
    let scene = &loaded.scene;
    let blocked: Vec<_> = place.map_or_else(Vec::new, |place| configurations(scene, place, near).collect());
    let is_hit = !blocked.is_empty() && blocked.iter().all(|(_, hits)| !hits.is_empty());
    let error = if is_hit { describe_contacts(scene, about, &blocked) } else { without_places(error) };
    let reply = |(q, hits): &(Configuration, Vec<Obstruction>)| json!({ "at": [q[0], q[1]], "hits": hits.iter().map(reply).collect::<Vec<_>>() });
    AnswerReply { blocked: blocked.iter().take(MAX_SHOWN).map(reply).collect(), ..refused(about, error) }
}

/// Returns the configurations at a start or goal, each with the obstacles in contact, the deepest first.
fn configurations(
    scene: &Scene,
    place: Goal,
    near: Configuration,
) -> impl Iterator<Item = (Configuration, Vec<Obstruction>)> {
    let found = match place {
        Goal::Joints(q) => vec![q],
        Goal::Tip(_) | Goal::TipAndElbow(..) | Goal::Area(_) => {
            let tip = place.tip().unwrap_or(scene.arm().base);
            let solved = inverse(scene.arm(), tip, near).with_elbow(scene.arm(), place.elbow());
            let within: Vec<_> = solved.solutions(scene.arm()).iter().map(|piece: &Segment| piece.ends()[0]).collect();
            if within.is_empty() { solved.branches } else { within }
        }
    };
    found.into_iter().map(|q| {
        let mut hits = scene.obstructions(q);
        hits.sort_by(|a, b| a.contact.separation.distance.total_cmp(&b.contact.separation.distance));
        (q, hits)
    })
}

fn reply(obstruction: &Obstruction) -> Value {
    let contact = &obstruction.contact;
    let distance = contact.separation.distance;
    // The exact test may find a contact although the rounded distance is positive.
    let distance = if obstruction.touches { distance.min(0.0) } else { distance };
    json!({ "link": contact.pair.link.min(1), "obstacle": contact.pair.obstacle, "distance": distance })
}

/// Describes the obstacles in contact.
fn describe_contacts(scene: &Scene, what: &str, blocked: &[(Configuration, Vec<Obstruction>)]) -> String {
    let one = |hits: &[Obstruction]| hits.iter().map(|hit| describe_contact(scene, hit)).collect::<Vec<_>>().join("; ");
    let touches = blocked.iter().all(|(_, hits)| hits.iter().any(|hit| hit.touches));
    let help = if touches { "Move" } else { "Require less clearance, or move" };
    let help = format!("{help} the {what} or the obstacle.");
    match blocked {
        [(_, hits)] => format!("The {what} is blocked: {}. {help}", one(hits)),
        _ => {
            let each: Vec<String> =
                blocked.iter().zip(1..).map(|((_, hits), k)| format!("configuration {k}: {}", one(hits))).collect();
            format!("The {what} is blocked for both IK solutions. {}. {help}", each.join(". "))
        }
    }
}

fn describe_contact(scene: &Scene, hit: &Obstruction) -> String {
    let (part, distance) = (scene.describe_part(hit.contact.pair), hit.contact.separation.distance);
    let obstacle = scene.obstacle_name(hit.contact.pair);
    if !hit.touches {
        let wanted = millimetres(scene.workspace().clearance);
        return format!("{part} is {} from \"{obstacle}\", less than the clearance of {wanted}", millimetres(distance));
    }
    match -distance {
        depth if depth < TOUCHING_DEPTH => format!("{part} touches \"{obstacle}\""),
        depth => format!("{part} is {} deep in \"{obstacle}\"", millimetres(depth)),
    }
}

fn millimetres(metres: f64) -> String {
    let length = metres * 1e3;
    let digits = [10.0, 100.0].into_iter().filter(|bound| length < *bound).count();
    if length < 0.01 { format!("{length:.1e} mm") } else { format!("{length:.digits$} mm") }
}

/// Formats the diagnostics without file, line and column, because the user does not see the file.
pub fn without_places(error: &InputError) -> String {
    let mut sentences: Vec<String> =
        error.diagnostics().iter().map(|diagnostic| capitalized(&diagnostic.message)).collect();
    sentences.dedup();
    sentences.join("\n")
}
