//! The claims that a result of cplan makes about its samples.

use crate::parsers::json_diagnostic;
use cplan_handling::{BlendsClaim, Claims, EventClaim, OptimumClaim, StepClaims, TaskClaims};
use cplan_model::space::Configuration;
use cplan_robot::{Diagnostic, InputError, Source};
use serde::{Deserialize, Deserializer};

/// Largest valid number. A larger one must be a mistake.
const MAX_NUMBER: f64 = 1e12;

/// Members that claim nothing. Other code reads them, or they state how to read other members.
const OTHER_MEMBERS: [&str; 6] = ["joints", "trajectory", "interpolation", "steps", "events", "all_joints"];

#[derive(Deserialize)]
struct Document {
    status: Option<String>,
    joints: Option<Vec<String>>,
    certified: Option<bool>,
    units: Option<Vec<String>>,
    path: Option<Vec<Vec<f64>>>,
    length: Option<f64>,
    #[serde(default, deserialize_with = "nullable")]
    clearance: Option<Option<f64>>,
    blends: Option<BlendsClaim>,
    duration: Option<f64>,
    optimum: Option<OptimumClaim>,
    lower_bound: Option<f64>,
    gap: Option<f64>,
    trajectory: Option<TrajectoryMember>,
    steps: Option<Vec<StepMember>>,
    events: Option<Vec<EventClaim>>,
}

const JUDGED_MEMBERS: [&str; 10] =
    ["status", "certified", "units", "path", "length", "clearance", "blends", "duration", "optimum", "gap"];

#[derive(Deserialize)]
struct TrajectoryMember {
    step: Option<Vec<usize>>,
}

#[derive(Deserialize)]
struct StepMember {
    action: Option<String>,
    #[serde(default, deserialize_with = "nullable")]
    object: Option<Option<String>>,
    #[serde(default, deserialize_with = "nullable")]
    carried: Option<Option<String>>,
    begin: Option<f64>,
    arrival: Option<f64>,
    end: Option<f64>,
    path: Option<Vec<Vec<f64>>>,
    length: Option<f64>,
    #[serde(default, deserialize_with = "nullable")]
    clearance: Option<Option<f64>>,
    blends: Option<BlendsClaim>,
    turn: Option<TurnMember>,
}

#[derive(Deserialize)]
struct TurnMember {
    #[serde(default, deserialize_with = "nullable")]
    clearance: Option<Option<f64>>,
}

/// Deserialises a member that may be null, and distinguishes null from a missing member.
fn nullable<'de, D: Deserializer<'de>, T: Deserialize<'de>>(deserializer: D) -> Result<Option<Option<T>>, D::Error> {
    Option::deserialize(deserializer).map(Some)
}

/// Reads the claims that a result makes about its samples. Returns `None` if the file has no status and is thus no result of
/// cplan.
///
/// # Errors
/// Members of a wrong type, with too large numbers, or with paths of other joints.
pub(super) fn json(source: &Source, arm: [&str; 2]) -> Result<Option<Claims>, InputError> {
    let wrong = |error: serde_json::Error| json_diagnostic(source, &error).help("verify an unchanged result of cplan");
    let members: serde_json::Map<String, serde_json::Value> = serde_json::from_str(source.text()).map_err(wrong)?;
    if !members.contains_key("status") {
        return Ok(None);
    }
    let document: Document = serde_json::from_str(source.text()).map_err(wrong)?;
    let order = document.joints.as_deref().map_or(Some([0, 1]), |joints| order(joints, arm));
    let Some(order) = order else {
        // The reader of samples reports invalid names.
        return Ok(None);
    };
    let unjudged = members
        .keys()
        .filter(|name| !JUDGED_MEMBERS.contains(&name.as_str()) && !OTHER_MEMBERS.contains(&name.as_str()));
    let mut unjudged: Vec<String> = unjudged.cloned().collect();
    let samples = members.get("trajectory").filter(|trajectory| !trajectory.is_null());
    if samples.is_some_and(|samples| samples.get("torque").is_some_and(|torque| !torque.is_null())) {
        unjudged.push("trajectory.torque".into());
    }
    if samples.is_none() && document.duration.is_some() {
        unjudged.push("duration".into());
    }
    for (name, inner) in
        [("optimum", "optimum.lower_bound"), ("steps", "steps[..].closest, steps[..].raising, steps[..].stroke")]
    {
        if members.contains_key(name) {
            unjudged.push(inner.into());
        }
    }
    let steps = members.get("steps").and_then(|steps| steps.as_array());
    if steps.is_some_and(|steps| steps.iter().any(|step| step.get("deviation").is_some())) {
        unjudged.push("steps[..].deviation".into());
    }
    let width = document.joints.as_ref().map_or(2, Vec::len);
    if let Some(units) = document.units.as_ref().filter(|units| units.len() != width) {
        let diagnostic = source.diagnostic(format!("the units are {units:?}, but there are {width} joints"));
        return Err(diagnostic.help("write one unit for each joint, \"rad\" or \"m\"").into());
    }
    let paths = document.path.iter().chain(document.steps.iter().flatten().filter_map(|step| step.path.as_ref()));
    if let Some(row) =
        paths.flatten().find(|row| row.len() != width || row.iter().any(|value| value.abs() > MAX_NUMBER))
    {
        let diagnostic = source.diagnostic(format!("a waypoint of a path is {row:?}, but there are {width} joints"));
        return Err(diagnostic.help("write one value for each joint in each waypoint, in radians or metres").into());
    }
    let claims = document.claims(order, unjudged);
    let numbers = [claims.length, claims.duration, claims.clearance.flatten(), claims.task.lower_bound];
    if let Some(value) = numbers.into_iter().flatten().find(|value| value.abs() > MAX_NUMBER) {
        let diagnostic: Diagnostic = source.diagnostic(format!("{value:e} is too large"));
        return Err(diagnostic.help("write values in radians, metres and seconds").into());
    }
    Ok(Some(claims))
}

/// Returns the indices of the arm's joints among `joints`. `None` if one of them is missing.
fn order(joints: &[String], arm: [&str; 2]) -> Option<[usize; 2]> {
    let at = |name: &str| joints.iter().position(|joint| joint == name);
    Some([at(arm[0])?, at(arm[1])?])
}

impl Document {
    fn claims(self, order: [usize; 2], unjudged: Vec<String>) -> Claims {
        let path = |rows: Option<Vec<Vec<f64>>>| {
            rows.map(|rows| rows.into_iter().map(|q| Configuration::new(q[order[0]], q[order[1]])).collect())
        };
        let step = |member: StepMember| StepClaims {
            action: member.action,
            object: member.object,
            carried: member.carried,
            begin: member.begin,
            arrival: member.arrival,
            end: member.end,
            path: path(member.path),
            length: member.length,
            clearance: member.clearance,
            blends: member.blends,
            turn_clearance: member.turn.and_then(|turn| turn.clearance),
        };
        Claims {
            status: self.status,
            certified: self.certified,
            units: self
                .units
                .filter(|units| units.len() > order[0].max(order[1]))
                .map(|units| order.map(|k| units[k].clone()).to_vec()),
            path: path(self.path),
            length: self.length,
            clearance: self.clearance,
            blends: self.blends,
            duration: self.duration,
            optimum: self.optimum.map(|optimum| OptimumClaim {
                weights: optimum.weights.map(|weights| order.map(|k| weights[k])),
                ..optimum
            }),
            task: TaskClaims {
                lower_bound: self.lower_bound,
                gap: self.gap,
                step_of_sample: self.trajectory.and_then(|trajectory| trajectory.step),
                steps: self.steps.unwrap_or_default().into_iter().map(step).collect(),
                events: self.events,
            },
            unjudged,
        }
    }
}
