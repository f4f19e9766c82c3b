//! The page that plays an exploration: the known and visible parts of the workspace, and the growing configuration space.

use super::{Ending, Exploration};
use cplan_model::Scene;
use cplan_model::space::Configuration;
use cplan_view::{View, drawing, sealed};
use cplan_world::{Occupancy, Sensor};
use serde_json::{Value, json};

const STYLE: &str = include_str!("exploration.css");

/// Scripts that draw an exploration, after the script of a view.
const SCRIPTS: [&str; 2] = [include_str!("coverage.js"), include_str!("exploration.js")];

/// Returns an exploration as one self-contained HTML file. `view` has the arm, the real world and the facts. If `timed`,
/// the file includes the time that each decision took.
pub fn exploration_page(view: &View, scene: &Scene, sensor: &Sensor, done: &Exploration, timed: bool) -> String {
    let title = view.title.first().map_or("cplan", String::as_str);
    let data = data(scene, sensor, done, timed).to_string();
    // The view has its own serializer, so it becomes the first entry of the object as text.
    let data = format!("{{\"view\":{},{}", view.json(), &data[1..]);
    sealed(title, STYLE, "exploration", &data, &(drawing() + &SCRIPTS.concat()))
}

fn data(scene: &Scene, sensor: &Sensor, done: &Exploration, timed: bool) -> Value {
    let (arm, map) = (scene.arm(), done.survey.map());
    let origin = map.pose.translation;
    let frames = done.readings.iter().map(|reading| {
        let (at, ahead) = sensor.pose(arm, reading.at.into());
        json!({
            "q": rounded(reading.at),
            "length": short(reading.length),
            "new": reading.new,
            "sensor": [short(at.x), short(at.y), short(ahead)],
        })
    });
    let text = match &done.ending {
        Ending::Reached => "The arm is at the goal.".to_owned(),
        Ending::Explored { configurations, .. } => {
            format!("Explored: nothing new can be seen from any of the {configurations} reachable configurations.")
        }
        Ending::Unreachable(why) => format!("Unreachable: {why}."),
        Ending::Unknown(why) => format!("Unknown: {why}."),
    };
    let occupied: Vec<usize> = (0..map.cells.len()).filter(|&cell| map.cells[cell] == Occupancy::Occupied).collect();
    json!({
        "text": text,
        "map": { "origin": [origin.x, origin.y], "cell": map.resolution, "size": map.size },
        "occupied": occupied,
        "surroundings": done.surroundings,
        "frames": frames.collect::<Vec<_>>(),
        "opened": done.opened,
        "grid": done.cells,
        "known_length": done.known_length,
        "decisions_ms": timed.then(|| done.decisions.iter().map(|time| 1e3 * time.as_secs_f64()).collect::<Vec<_>>()),
        "sensor": { "range": sensor.range, "view": sensor.field_of_view },
    })
}

/// Rounds to tenths of a millimetre.
fn short(value: f64) -> f64 {
    (1e4 * value).round() / 1e4
}

fn rounded(q: Configuration) -> [f64; 2] {
    [short(q[0]), short(q[1])]
}
