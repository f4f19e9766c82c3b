//! The answer as JSON.

use super::Answered;
use super::fit::Placed;
use super::words::{exclusions, joints};
use crate::model::Outcome;
use crate::motion::interpolation;
use cplan_follow::{Cause, Infeasible, Place};
use serde_json::{Value, json};

/// Returns the answer as a JSON object.
pub fn object(answered: &Answered) -> Value {
    let line = answered.line;
    let mut object = json!({
        "status": answered.answer.status().name(),
        "joints": joints(answered.loaded.scene.arm()),
        "line": {
            "file": answered.args.path.display().to_string(),
            "length": line.length(),
            "pieces": line.pieces().len(),
            "start": line.start(),
            "notes": line.notes(),
        },
        "tolerance": answered.tolerance,
        "clearance": answered.loaded.scene.workspace().clearance,
    });
    let more = match answered.answer {
        Outcome::Found(found) => {
            let clearance = found.timed.curve.clearance();
            json!({
                "deviation": found.deviation,
                "proven_clearance": clearance.is_finite().then_some(clearance),
                "duration": found.timed.trajectory.duration(),
                "changes": found.changes.iter().map(place).collect::<Vec<_>>(),
                "fit": answered.placed.as_ref().map(Placed::to_json),
                "wrist": answered.wrist.map(|wrist| wrist.to_json(found.tool_deviation)),
                "interpolation": interpolation(answered.loaded.scene.arm()),
                "trajectory": found.timed.trajectory,
                "tool": answered.tool.iter().map(|is_on| u8::from(*is_on)).collect::<Vec<_>>(),
            })
        }
        Outcome::Infeasible(infeasible) => infeasible_object(answered, infeasible),
        Outcome::Unknown(why) => json!({ "reason": why }),
    };
    if let (Value::Object(object), Value::Object(more)) = (&mut object, more) {
        let is_absent = |key: &str, value: &Value| match key {
            "wrist" | "fit" => value.is_null(),
            "tool" => answered.tool.is_empty(),
            _ => false,
        };
        object.extend(more.into_iter().filter(|(key, value)| !is_absent(key, value)));
    }
    object
}

fn infeasible_object(answered: &Answered, infeasible: &Infeasible) -> Value {
    let scene = &answered.loaded.scene;
    let excluded = exclusions(infeasible).iter().map(|exclusion| {
        json!({
            "solution": exclusion.solution + 1,
            "place": place(&exclusion.place),
            "joints": exclusion.q,
            "reason": exclusion.describe(scene),
        })
    });
    let (cause, by) = match infeasible.cause {
        Cause::OutOfReach { by } => ("out_of_reach", Some(by)),
        Cause::TooLarge { .. } => ("too_large", None),
        Cause::Excluded(_) => ("excluded", None),
        Cause::NoChange(_) => ("no_change", None),
    };
    json!({
        "cause": cause,
        "reason": infeasible.describe(),
        "place": place(&infeasible.place),
        "misses": by,
        "excluded": excluded.collect::<Vec<_>>(),
    })
}

fn place(place: &Place) -> Value {
    json!({
        "distance": place.distance,
        "point": [place.point.x, place.point.y],
        "piece": place.piece,
        "line": place.source.line,
        "column": place.source.column,
    })
}
