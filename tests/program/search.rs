//! The searches of a grid on the command line.

use crate::roadmaps::json;
use std::process::Command;

fn cplan(options: &[&str]) -> std::process::Output {
    let files = ["robots/planar_2r.urdf", "workspaces/shelf.toml"];
    Command::new(env!("CARGO_BIN_EXE_cplan")).args(files).args(options).output().expect("it runs")
}

#[test]
fn every_search_with_four_and_eight_neighbours_is_certified_and_named() {
    let mut expanded = Vec::new();
    for search in ["wave", "bfs", "dfs", "dijkstra", "astar", "greedy"] {
        for neighbors in ["4", "8"] {
            let json = json(&format!("--planner wavefront --search {search} --neighbors {neighbors} --cells 128"));
            assert_eq!(json["certified"], true);
            assert_eq!(json["search"]["search"], search);
            assert_eq!(json["search"]["neighbors"].to_string(), neighbors);
            assert_eq!(json["size"]["expanded"].is_u64(), search != "wave");
            assert_eq!(json["size"]["sweeps"].is_u64(), search == "wave");
            expanded.extend(json["size"]["expanded"].as_u64().map(|n| (search, n)));
        }
    }
    let of = |name: &str| expanded.iter().find(|(search, _)| *search == name).map(|(_, n)| *n);
    assert!(of("astar") < of("dijkstra"), "{expanded:?}");
}

#[test]
fn sampled_grids_are_reported_and_their_paths_certified() {
    for planner in
        ["wavefront", "wavefront --search astar", "harmonic", "harmonic --field oriented --epsilon 0.1 --direction 0,1"]
    {
        let of = |space: &str| json(&format!("--cells 128 --planner {planner} {space}"));
        let sampled = of("--space sampled");
        assert_eq!((&sampled["space"], &sampled["certified"]), (&"sampled".into(), &true.into()));
        assert!(sampled["clearance"].as_f64() > Some(0.0));
        let rows = of("--space rows");
        assert!(rows.get("space").is_none() && rows != sampled);
        assert_eq!(rows, of(""));
    }
}

#[test]
fn searches_are_for_the_wavefront_and_have_their_names() {
    for (options, report) in [
        (&["--search", "astar"][..], "--search needs --planner wavefront, visibility"),
        (&["--planner", "harmonic", "--neighbors", "8"], "--neighbors needs --planner wavefront"),
        (&["--space", "sampled"], "--space needs --planner wavefront or harmonic: shortest has no grid"),
        (&["--planner", "harmonic", "--space", "guessed"], "[possible values: rows, whole, centers, sampled]"),
        (&["--planner", "wavefront", "--search", "best"], "wave, bfs, dfs, dijkstra, astar, greedy"),
        (&["--planner", "wavefront", "--neighbors", "6"], "possible values: 4, 8"),
    ] {
        let output = cplan(options);
        assert_eq!(output.status.code(), Some(2), "{options:?}");
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains(report), "{message}");
    }
}
