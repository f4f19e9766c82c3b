//! Runs cplan's library and its Rust peers on the same problems. Every subcommand runs its contenders in turn, round
//! after round, and prints one JSON object: lists of milliseconds, and the data needed to judge the answers.
//! `benches/peers/run` calls it.

mod answers;
mod brute_force;
mod cspaces;
mod fields;
mod minkowski;
mod roadmaps;
mod rounds;
mod scenes;
mod torus;
mod trees;

use std::process::ExitCode;

const USAGE: &str = "usage: cplan-peers answers URDF WORLD ROUNDS
       cplan-peers cspace URDF WORLD CELLS ROUNDS
       cplan-peers roadmap CORNERS ROUNDS POLYGONS_OUT
       cplan-peers minkowski CORNERS ROUNDS
       cplan-peers field boxes|maze|WORLD CELLS ROUNDS DIRECTORY [URDF]
       cplan-peers oxmpl URDF WORLD PLANNER SEED LIMIT_SECONDS
       cplan-peers collides URDF WORLD < configurations, two numbers a line";

/// A result whose error can be any error.
type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

fn run(arguments: &[&str]) -> Result<serde_json::Value> {
    match *arguments {
        ["answers", urdf, world, rounds] => answers::run(urdf, world, rounds.parse()?),
        ["cspace", urdf, world, cells, rounds] => cspaces::run(urdf, world, cells.parse()?, rounds.parse()?),
        ["roadmap", corners, rounds, polygons] => roadmaps::run(corners.parse()?, rounds.parse()?, polygons),
        ["field", "boxes", cells, rounds, directory] => {
            fields::run(fields::boxes(cells.parse()?), rounds.parse()?, directory)
        }
        ["field", "maze", cells, rounds, directory] => {
            fields::run(fields::maze(cells.parse()?), rounds.parse()?, directory)
        }
        ["minkowski", corners, rounds] => minkowski::run(corners.parse()?, rounds.parse()?),
        ["field", world, cells, rounds, directory, urdf] => {
            fields::run(fields::of_arm(urdf, world, cells.parse()?)?, rounds.parse()?, directory)
        }
        ["oxmpl", urdf, world, planner, seed, limit] => trees::run(urdf, world, planner, seed.parse()?, limit.parse()?),
        ["collides", urdf, world] => torus::answer_standard_input(urdf, world),
        _ => Err(USAGE.into()),
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments.iter().map(String::as_str).collect::<Vec<_>>()) {
        Ok(report) => {
            println!("{report}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
