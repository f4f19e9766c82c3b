//! The mission of a mobile robot of the literature: to three targets of a room, by forces, by fields, and by exploring.
//!
//! ```text
//! cargo run --example mission [-- FOLDER]
//! ```
//!
//! With a folder, it writes pictures of the routes there.

use cplan::field::Stopping;
use cplan_testkit::mobile::floor::Floor;
use cplan_testkit::mobile::forces::Ending;
use cplan_testkit::mobile::mission::{Leg, by_fields, by_forces, explored, followed, planners, way};
use cplan_testkit::mobile::occupancy::Occupancy;
use cplan_testkit::mobile::{START, TARGETS, fields};
use cplan_testkit::published::alves;
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map(PathBuf::from);
    for name in ["hall", "house"] {
        let floor = Floor::load(&format!("explore/{name}.toml"))?;
        println!("{name}: S. F. dos Reis Alves, Trabalho 2. Targets: object 1, bin, object 2, bin");
        let (map, _) = followed(&floor, 300.0);
        let is_solid = |k: usize| fields::is_solid(&map, k);
        // Direction in which the robot must arrive at each target: rows (downwards) and columns.
        let directions = [[0.0, -1.0], [0.0, -1.0], [1.0, 0.0], [0.0, -1.0]];
        let missions = [
            ("forces, unknown room, as printed", by_forces(&floor, None, false)),
            ("forces, unknown room, mended", by_forces(&floor, None, true)),
            ("forces, the follower's map", by_forces(&floor, Some(&map), false)),
            ("forces, the follower's map, mended", by_forces(&floor, Some(&map), true)),
            ("harmonic, the follower's map", harmonic(&floor, &map, alves::STOPPING.below)),
            ("harmonic, relaxed to 1e-26", harmonic(&floor, &map, 1e-26)),
            (
                "oriented, the follower's map",
                by_fields(&floor, &|leg| Some(alves::oriented(TARGETS[leg].1, directions[leg], &is_solid)?.values)),
            ),
        ];
        for (how, legs) in &missions {
            println!("  {how:<34} {}", legs.iter().map(output).collect::<Vec<_>>().join("; "));
        }
        println!("  sweeps, published and on the follower's map of 5 minutes:");
        for (field, count) in alves::rows_among(&is_solid) {
            println!("    {field:<27} {count}");
        }
        println!("  cplan explore, each leg in a room of which nothing is known:");
        let mut ways: Vec<_> = missions
            .iter()
            .take(2)
            .map(|(how, legs)| (how.to_string(), legs.iter().flat_map(|leg| leg.way.clone()).collect()))
            .collect();
        for (planner, choice) in planners() {
            let legs = explored(&floor, choice)?;
            let each: Vec<String> = legs
                .iter()
                .map(|(_, leg)| format!("{} {:.1} m, {} readings", leg.ending.name(), leg.length, leg.readings.len()))
                .collect();
            println!("    {planner:<9} {}", each.join("; "));
            ways.push((format!("cplan, {planner}"), legs.iter().flat_map(|(_, leg)| way(leg)).collect()));
        }
        if let Some(folder) = &folder {
            let goals: Vec<_> = TARGETS[..3].iter().map(|&(_, at)| at).chain([START]).collect();
            std::fs::write(folder.join(format!("mission_{name}.svg")), floor.picture("The mission", &goals, &ways))?;
        }
    }
    Ok(())
}

/// Drives along harmonic fields on a map. They are relaxed until the sum of the squared changes of a sweep is less than
/// `below`.
fn harmonic(floor: &Floor, map: &Occupancy, below: f64) -> Vec<Leg> {
    let is_solid = |k: usize| fields::is_solid(map, k);
    let stopping = Stopping { below, ..alves::STOPPING };
    by_fields(floor, &|leg| Some(alves::harmonic(TARGETS[leg].1, &is_solid, &stopping)?.values))
}

/// Describes a leg of the mission.
fn output(leg: &Leg) -> String {
    let how = match leg.ending {
        Ending::Reached => "reached".to_owned(),
        Ending::Trapped(distance) => format!("trapped {distance:.2} m before it"),
        Ending::OnObstacle => "on an obstacle: error".to_owned(),
    };
    let touched = if leg.refused > 0 { ", pushed against something" } else { "" };
    format!("{how} after {:.1} m, {:.0} s{touched}", leg.length, leg.time)
}
