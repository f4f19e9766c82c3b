//! Searches of roadmaps and grids on the command line: planners, searches, seeds, and grids with two numbers of cells.

use crate::cli::Place;
use cplan_testkit::judged::plan_result;
use serde_json::Value;
use std::path::Path;

const ROADMAPS: [&str; 5] = ["visibility", "trapezoid", "triangles", "voronoi", "prm"];

const FILES: [&str; 2] = ["robots/planar_2r.urdf", "workspaces/shelf.toml"];

/// Returns the library's result of planning with these options.
fn json(options: &str) -> Value {
    let [robot, world] = FILES.map(Path::new);
    let result = plan_result(robot, world, options);
    assert_eq!(result["status"], "found", "{options}");
    result
}

fn length(result: &Value) -> f64 {
    result["length"].as_f64().expect("a length")
}

#[test]
fn every_roadmap_is_searched_in_every_order_both_ways() {
    for planner in ROADMAPS {
        let of = |search: &str| {
            let path = if planner == "visibility" { "" } else { "--path own" };
            json(&format!("--planner {planner} {path} {search}"))
        };
        let usual = of("");
        assert!(usual.get("search").is_none(), "{planner}");
        for search in ["bfs", "dfs", "dijkstra", "astar", "greedy"] {
            for backward in [false, true] {
                let found = of(&format!("--search {search} {}", if backward { "--backward" } else { "" }));
                assert_eq!(found["certified"], true);
                if search != "astar" || backward {
                    assert_eq!(found["search"]["search"], search, "{planner}");
                    assert_eq!(found["search"]["backward"], backward, "{planner}");
                }
                let (least, other) = (length(&usual), length(&found));
                // The cost of a trapezoid's search is that of its own path, except for the cells at the ends.
                let is_shortest = ["dijkstra", "astar"].contains(&search);
                assert!(
                    if is_shortest { (other - least).abs() < 1e-6 } else { other > least - 1e-6 },
                    "{planner} {search}"
                );
            }
        }
    }
}

#[test]
fn samples_follow_from_the_seed() {
    let of = |options: &str| json(&format!("--planner prm --path own {options}"));
    assert_eq!(of(""), of("--seed 1 --samples 500 --nearest 12"));
    assert_ne!(of(""), of("--seed 2"));
    // More samples, which begin with the same ones, never give a longer path if each sample is joined to all.
    let [few, more] =
        [100, 400].map(|n| length(&json(&format!("--planner prm --path own --nearest 1000 --samples {n}"))));
    assert!(more <= few, "{few} {more}");
    let files = FILES.map(|file| format!("{}/{file}", env!("CARGO_MANIFEST_DIR")));
    let report = Place::new().run(&files, "--planner prm --search greedy --backward --verbose").exits(0);
    report.says(&["prm (greedy, backward): "]);
}

#[test]
fn grids_may_have_other_numbers_of_cells_along_each_joint() {
    for planner in ["wavefront", "harmonic"] {
        let of = |cells: &str| json(&format!("--planner {planner} --cells {cells}"));
        assert_eq!(of("96"), of("96x96"), "{planner}");
        assert_ne!(of("96x160")["path"], of("160x96")["path"], "{planner}");
    }
    // The path has few steps along the joint with few cells.
    let result = json("--planner wavefront --path own --cells 32x512");
    let path = result["path"].as_array().expect("a path");
    let at = |k: usize| (1..path.len() - 1).map(move |i| path[i][k].as_f64().expect("a number"));
    let steps = |k: usize| {
        let all: Vec<f64> = at(k).collect();
        all.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|d| *d > 1e-9).fold(f64::INFINITY, f64::min)
    };
    assert!(steps(0) > 4.0 * steps(1), "{} {}", steps(0), steps(1));
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
