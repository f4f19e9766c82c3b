//! The page that plays an exploration: the known and seen parts of the workspace, and the growing configuration space.

use super::view::{ICONS, sealed};
use cplan_core::model::Scene;
use cplan_core::space::Configuration;
use cplan_explore::{Ending, Exploration};
use cplan_geometry::Convex;
use cplan_world::{Occupancy, Sensor};
use serde_json::{Value, json};

const STYLE: &str = include_str!("assets/exploration.css");
const SCRIPT: &str = include_str!("assets/exploration.js");

/// Returns an exploration as one self-contained HTML file. If `timed`, the file includes the time that each decision
/// took.
#[must_use]
pub fn exploration_page(title: &str, scene: &Scene, sensor: &Sensor, done: &Exploration, timed: bool) -> String {
    sealed(
        title,
        STYLE,
        "exploration",
        &data(title, scene, sensor, done, timed).to_string(),
        &(ICONS.to_owned() + SCRIPT),
    )
}

fn data(title: &str, scene: &Scene, sensor: &Sensor, done: &Exploration, timed: bool) -> Value {
    let (arm, map) = (scene.arm(), done.survey.map());
    let origin = map.pose.translation;
    let obstacles = scene.workspace().obstacles.iter().flat_map(|obstacle| &obstacle.pieces).map(outline);
    let frames = done.readings.iter().map(|reading| {
        let poses = arm.poses(reading.at);
        let parts = (0..2).flat_map(|link| arm.links[link].parts.iter().map(move |part| (link, part)));
        let arms = parts.map(|(link, part)| json!([link, outline(&part.shape.at(&poses[link]))]));
        let (at, ahead) = sensor.pose(arm, reading.at.into());
        json!({
            "q": rounded(reading.at),
            "length": (1e4 * reading.length).round() / 1e4,
            "new": reading.new,
            "arm": arms.collect::<Vec<_>>(),
            "sensor": [short(at.x), short(at.y), short(ahead)],
        })
    });
    let topology = arm.topology();
    let axes = [0, 1].map(|k| {
        let joint = &arm.joints[k];
        let (lower, upper) = topology.ranges[k].domain();
        json!({ "name": joint.name, "unit": joint.unit(), "lower": lower, "upper": upper })
    });
    let (status, text) = match &done.ending {
        Ending::Reached => ("found", "reached".to_owned()),
        Ending::Explored { configurations, .. } => {
            ("found", format!("explored: none of the {configurations} reachable configurations shows anything new"))
        }
        Ending::Unreachable(why) => ("infeasible", format!("unreachable: {why}")),
        Ending::Unknown(why) => ("unknown", format!("unknown: {why}")),
    };
    let occupied: Vec<usize> = (0..map.cells.len()).filter(|&cell| map.cells[cell] == Occupancy::Occupied).collect();
    json!({
        "title": title,
        "status": status,
        "text": text,
        "map": { "origin": [origin.x, origin.y], "cell": map.resolution, "size": map.size },
        "occupied": occupied,
        "surroundings": done.surroundings,
        "obstacles": obstacles.collect::<Vec<_>>(),
        "frames": frames.collect::<Vec<_>>(),
        "opened": done.opened,
        "grid": done.cells,
        "axes": axes,
        "known_length": done.known_length,
        "decisions_ms": timed.then(|| done.decisions.iter().map(|time| 1e3 * time.as_secs_f64()).collect::<Vec<_>>()),
        "sensor": { "range": sensor.range, "view": sensor.field_of_view },
    })
}

/// Returns corners and radius of a shape.
fn outline(shape: &Convex) -> Value {
    json!([shape.core().iter().map(|p| [short(p.x), short(p.y)]).collect::<Vec<_>>(), short(shape.radius())])
}

/// Rounds to tenths of a millimetre.
fn short(value: f64) -> f64 {
    (1e4 * value).round() / 1e4
}

fn rounded(q: Configuration) -> [f64; 2] {
    [short(q[0]), short(q[1])]
}
