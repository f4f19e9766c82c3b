//! The page that plays an exploration: what is known and seen in the workspace, and the configuration space growing.

use crate::explore::{Ending, Exploration};
use crate::geometry::Convex;
use crate::input::Occupancy;
use crate::model::{Scene, Sensor};
use crate::space::Configuration;
use crate::text::markup;
use serde_json::{Value, json};

const STYLE: &str = include_str!("view/assets/view.css");
const OWN_STYLE: &str = include_str!("assets/exploration.css");
const CODE: &str = include_str!("assets/exploration.js");

/// Points of a half circle about a corner.
const ARC: usize = 8;

/// An exploration as one self-contained file of HTML: it loads nothing, and may not.
#[must_use]
pub fn exploration_page(title: &str, scene: &Scene, sensor: &Sensor, done: &Exploration) -> String {
    let policy = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";
    // Within a script only the less-than sign could end it.
    let data = data(title, scene, sensor, done).to_string().replace('<', "\\u003c");
    let title = markup(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>\n{STYLE}{OWN_STYLE}</style>\n</head>\n<body>\n<main><noscript>This page draws with JavaScript, which is \
         switched off here.</noscript></main>\n<script id=\"exploration\" type=\"application/json\">{data}</script>\n\
         <script>\n{CODE}</script>\n</body>\n</html>\n"
    )
}

fn data(title: &str, scene: &Scene, sensor: &Sensor, done: &Exploration) -> Value {
    let (arm, map) = (scene.arm(), done.survey.map());
    let origin = map.pose.translation.vector;
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
            ("found", format!("explored: {configurations} configurations show nothing new"))
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
        "sensor": { "range": sensor.range, "view": sensor.field_of_view },
    })
}

/// A shape's corners, rounded ones as many.
fn outline(shape: &Convex) -> Vec<[f64; 2]> {
    let (core, radius) = (shape.core(), shape.radius());
    if radius == 0.0 {
        return core.iter().map(|p| [short(p.x), short(p.y)]).collect();
    }
    let around = core.iter().flat_map(|p| {
        (0..2 * ARC).map(move |k| {
            let (sine, cosine) = (std::f64::consts::PI * k as f64 / ARC as f64).sin_cos();
            *p + crate::geometry::Vector::new(cosine, sine) * radius
        })
    });
    let points: Vec<_> = around.collect();
    crate::geometry::hull(&points).into_iter().map(|p| [short(p.x), short(p.y)]).collect()
}

/// Tenths of a millimetre.
fn short(value: f64) -> f64 {
    (1e4 * value).round() / 1e4
}

fn rounded(q: Configuration) -> [f64; 2] {
    [short(q[0]), short(q[1])]
}
