//! The planners of docs/own_planner.md: they run, and the judge accepts their paths.

use crate::cli::{Place, shipped};
use std::fs::read_to_string;
use std::process::Command;

#[path = "../../examples/own_planner.rs"]
#[allow(dead_code, reason = "the test needs no `main`")]
mod own_planner_in_rust;

/// Returns the first C++ compiler that runs.
fn compiler() -> Option<&'static str> {
    let runs = |name: &&str| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success());
    ["c++", "g++", "clang++"].into_iter().find(runs)
}

#[test]
fn own_planners_in_rust_and_cpp_write_paths_that_the_judge_accepts() {
    let place = Place::new();
    let [robot, world] = ["robots/planar_2r.urdf", "workspaces/shelf.toml"].map(shipped);
    let cells = "--planner wavefront --cells 200 --space whole --quiet --output cspace.json";
    place.run(&[&robot, &world], cells).exits(0);
    let mut planners = vec!["rust"];
    place.write("results/rust/shelf.csv", own_planner_in_rust::csv(&place.json("cspace.json")).expect("a path"));
    if let Some(compiler) = compiler() {
        let (source, program) = (shipped("examples/own_planner.cpp"), place.path("own_planner"));
        let warnings = ["-std=c++17", "-Wall", "-Wextra", "-Werror", "-o"];
        let built = Command::new(compiler).args(warnings).arg(&program).arg(source).output().unwrap();
        assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
        let printed = Command::new(program).arg(place.path("cspace.json")).output().unwrap();
        assert!(printed.status.success(), "{}", String::from_utf8_lossy(&printed.stderr));
        place.write("results/cpp/shelf.csv", printed.stdout);
        planners.push("cpp");
    } else {
        eprintln!("no C++ compiler: own_planner.cpp is not run");
    }
    let done = place.run(&["compare", robot.as_str(), world.as_str()], "--planner shortest --paths results --json");
    let rows = done.exits(0).json()["planners"].as_array().unwrap().clone();
    for planner in planners {
        let row = rows.iter().find(|row| row["planner"] == planner).unwrap_or_else(|| panic!("{planner}: {rows:?}"));
        assert_eq!(row["outcome"], "found", "{row}");
        // Moves along the axes are as long as the sums of the differences of both joints, or longer.
        let length = row["length"].as_f64().unwrap();
        assert!((4.492..6.21).contains(&length), "{planner}: {length}");
    }
}

#[test]
fn the_page_shows_both_programs() {
    let page = read_to_string(shipped("docs/own_planner.md")).unwrap();
    for (language, file) in [("cpp", "examples/own_planner.cpp"), ("rust", "examples/own_planner.rs")] {
        assert!(page.contains(&format!("```{language}\n{}```\n", read_to_string(shipped(file)).unwrap())), "{file}");
    }
}
