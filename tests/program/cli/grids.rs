//! Searches of a grid on the command line: where they begin, ties, iterative deepening, and the matrix of their labels.

use super::*;
use cplan_testkit::reference::published;

/// Options for the published map: 12 x 20 cells, tested at their centres, and one attempt.
const MAP: &str = "--planner wavefront --cells 12x20 --space centers --levels 1 --path own --quiet";

fn map() -> [String; 2] {
    [shipped("robots/stage_robot.urdf"), shipped("workspaces/published/obstacle_map.toml")]
}

/// Returns the matrix of labels of a search.
fn matrix(place: &Place, options: &str) -> Vec<Vec<f64>> {
    place.run(&map(), &format!("{MAP} {options} --output cspace.csv")).exits(0);
    place.read("cspace.csv").lines().map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

/// Returns the number of cells with a label.
fn labeled(matrix: &[Vec<f64>]) -> usize {
    matrix.iter().flatten().filter(|value| value.is_finite()).count()
}

/// Compares the labels of a search with figures 2 and 3 of R. F. Goncalves da Silva, whose labels begin at 2 and at 1.
#[test]
fn a_search_from_the_start_with_ties_first_labels_the_published_50_cells() {
    let place = Place::new();
    let wave = matrix(&place, "");
    assert_eq!((wave.len(), wave[0].len(), labeled(&wave)), (20, 12, 110));
    // Start and goal, row by row from the top, and the blocked corner.
    assert_eq!((wave[4][2], wave[18][10], wave[0][0]), (22.0, 0.0, f64::INFINITY));
    let costs = matrix(&place, "--search astar --forward --ties first");
    assert_eq!((costs[4][2], costs[18][10], labeled(&costs)), (0.0, 22.0, 50));
    // The dead end beside the start has labels, other cells do not.
    assert_eq!((costs[3][2], costs[3][3], costs[5][1]), (1.0, 2.0, 2.0));
    assert!(costs[1][1].is_nan() && costs[19][11].is_infinite());
    // The other rule for ties, and a search from the other end, label fewer and different cells.
    assert_eq!(labeled(&matrix(&place, "--search astar --forward")), 41);
    assert_eq!(labeled(&matrix(&place, "--search astar")), 40);
}

/// Compares all cells of both published matrices with those that the command line gives.
#[test]
#[ignore = "needs the published data that CPLAN_REFERENCE names"]
fn the_published_matrices_come_from_the_command_line() {
    let place = Place::new();
    for (file, options) in [
        ("wavefront_20x12.csv", "--labels-from 2"),
        ("astar_g_20x12.csv", "--search astar --forward --ties first --labels-from 1"),
    ] {
        let published = std::fs::read_to_string(published(&format!("data/{file}"))).unwrap();
        let shown = |value: f64| if value.is_nan() { 0.0 } else { value };
        let ours: Vec<f64> = matrix(&place, options).into_iter().flatten().map(shown).collect();
        let theirs: Vec<f64> = published.split([',', '\n']).filter_map(|cell| cell.trim().parse().ok()).collect();
        assert_eq!(ours, theirs, "{file}");
    }
}

/// Compares first labels with those of figures 2 and 3, in all files and in the picture.
#[test]
fn labels_begin_at_the_requested_number() {
    let place = Place::new();
    let wave = matrix(&place, "--labels-from 2 --picture wave.svg --output cspace.json");
    assert_eq!((wave[4][2], wave[18][10], wave[17][10]), (24.0, 2.0, 3.0));
    let costs = matrix(&place, "--search astar --forward --ties first --labels-from 1");
    assert!((costs[4][2], costs[18][10]) == (1.0, 23.0) && costs[1][1].is_nan());
    let json: serde_json::Value = place.json("cspace.json");
    let values = json["spaces"][0]["grid"]["values"].as_array().unwrap();
    let least = values.iter().filter_map(serde_json::Value::as_f64).fold(f64::INFINITY, f64::min);
    assert_eq!(least, 2.0);
    let picture = place.read("wave.svg");
    matrix(&place, "--picture wave.svg");
    assert!(picture != place.read("wave.svg"), "the numbers in the picture are others");
}

/// Compares the estimates of A\* with figure 4, whose rows 16 and 17 are joined in our copy.
#[test]
fn the_estimates_of_a_star_are_the_published_ones() {
    let place = Place::new();
    let search = "--search astar --forward --ties first --output heuristic.csv --output cspace.json";
    place.run(&map(), &format!("{MAP} {search}")).exits(0);
    let text = place.read("heuristic.csv");
    let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    for (row, published) in [
        (1, "inf 26 25 24 23 22 21 20 19 18 17 inf"),
        (2, "inf 25 24 23 inf inf inf 19 inf inf 16 inf"),
        (6, "inf 21 20 19 18 17 16 15 inf inf 12 inf"),
        (7, "inf 20 inf inf inf inf inf 14 13 12 11 inf"),
        (10, "inf 17 16 15 14 13 12 11 inf inf inf inf"),
        (13, "inf inf inf 12 11 inf inf 8 inf inf inf inf"),
        (15, "inf 12 11 10 9 8 7 6 inf inf inf inf"),
        (18, "inf 9 8 7 6 5 4 3 2 1 0 inf"),
    ] {
        assert_eq!(lines[row].join(" "), published, "row {row}");
    }
    // An independent rule: the Manhattan distance from the goal's cell.
    for (row, line) in lines.iter().enumerate() {
        for (column, cell) in line.iter().enumerate() {
            let apart = row.abs_diff(18) + column.abs_diff(10);
            assert!(*cell == "inf" || *cell == apart.to_string(), "{row} {column}: {cell}");
        }
    }
    let json: serde_json::Value = place.json("cspace.json");
    let estimates = json["spaces"][0]["grid"]["heuristic"].as_array().unwrap();
    assert_eq!((estimates.len(), estimates[10 * 20 + 1].as_f64()), (240, Some(0.0)));
    place.run(&map(), "--planner wavefront --output heuristic.csv").refused(2, &["--search astar or greedy"]);
    place.run(&map(), "--planner harmonic --labels-from 1").refused(2, &["--labels-from needs --planner wavefront"]);
}

/// Compares the potential with its logarithm, and with the mean of its neighbours: 0 at the goal, 1 at obstacles.
#[test]
fn the_potential_is_that_of_the_sources() {
    let place = Place::new();
    let files = "--output potential.csv --output cspace.csv";
    place.run(&map(), &format!("--planner harmonic --cells 12x20 --space centers --levels 1 --quiet {files}")).exits(0);
    let read = |file: &str| -> Vec<Vec<f64>> {
        place.read(file).lines().map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
    };
    let (potential, logarithm) = (read("potential.csv"), read("cspace.csv"));
    let mut free = 0;
    for i in 0..20 {
        for j in 0..12 {
            let p = potential[i][j];
            if logarithm[i][j] == f64::INFINITY {
                assert_eq!(p, 1.0);
            } else if logarithm[i][j] == 0.0 {
                assert_eq!((p, i, j), (0.0, 18, 10));
            } else {
                let mean =
                    (potential[i - 1][j] + potential[i + 1][j] + potential[i][j - 1] + potential[i][j + 1]) / 4.0;
                assert!((p - (1.0 - logarithm[i][j].exp())).abs() < 1e-12 && (p - mean).abs() < 1e-9, "{i} {j}: {p}");
                free += 1;
            }
        }
    }
    assert_eq!(free, 109);
    place.run(&map(), "--planner wavefront --output potential.csv").refused(2, &["needs --planner harmonic"]);
    place.run(&map(), "--planner harmonic --field khatib --output potential.csv").refused(2, &["except khatib"]);
}

#[test]
fn the_matrix_is_the_grid_of_the_json_turned() {
    let place = Place::new();
    let outputs = "--output cspace.json --output Map.CSpace.CSV";
    place.run(&map(), &format!("{MAP} --search bfs --forward {outputs}")).exits(0);
    let spaces: serde_json::Value = place.json("cspace.json");
    let grid = &spaces["spaces"][0]["grid"];
    assert_eq!((&grid["quantity"], &grid["shape"]), (&"steps_from_start".into(), &serde_json::json!([12, 20])));
    for (line, joint2) in place.read("Map.CSpace.CSV").lines().zip((0..20).rev()) {
        for (cell, joint1) in line.split(',').zip(0..12) {
            let at = joint1 * 20 + joint2;
            match (grid["blocked"][at].as_u64(), grid["values"][at].as_f64()) {
                (Some(1), _) => assert_eq!(cell, "inf"),
                (_, None) => assert_eq!(cell, "nan"),
                (_, Some(steps)) => assert_eq!(cell, steps.to_string()),
            }
        }
    }
}

#[test]
fn every_search_finds_a_path_from_either_end() {
    let place = Place::new();
    let length = |options: &str| {
        let json = place.run(&map(), &format!("{} {options} --json", MAP.replace("--quiet", ""))).exits(0).json();
        assert_eq!(
            json["search"]["backward"],
            if options.contains("--forward") { false.into() } else { serde_json::Value::Null }
        );
        json["length"].as_f64().unwrap()
    };
    for search in ["bfs", "dfs", "dijkstra", "astar", "greedy", "deepening"] {
        let [backward, forward] = ["--backward", "--forward"].map(|end| length(&format!("--search {search} {end}")));
        let is_shortest = |length: f64| (length - 55.0).abs() < 1e-9;
        let fewest = !matches!(search, "dfs" | "greedy");
        assert!(!fewest || is_shortest(backward) && is_shortest(forward), "{search}: {backward} {forward}");
    }
}

#[test]
fn iterative_deepening_reports_the_number_of_rounds() {
    let place = Place::new();
    let done = place.run(&map(), &format!("{} --search deepening --verbose", MAP.replace(" --quiet", "")));
    // 22 moves: rounds of limits 0 to 22.
    done.says(&["wavefront (deepening, 4 neighbours), centers: 23 rounds, "]);
    let json = place.run(&map(), &format!("{MAP} --search deepening --json")).json();
    let size = &json["size"];
    assert!(size["rounds"] == 23 && size["expanded"].as_u64() > size["cells"].as_u64(), "{size}");
}

#[test]
fn unsupported_searches_are_refused() {
    let place = Place::new();
    for (options, parts) in [
        ("--planner wavefront --forward", ["--forward needs --search bfs", "the search `wave`"]),
        ("--planner shortest --forward", ["--forward needs a planner that searches", "shortest"]),
        ("--planner prm --forward --backward", ["--forward", "--backward"]),
        ("--planner wavefront --ties first", ["--ties needs", "--search astar"]),
        ("--planner prm --search astar --ties first", ["--ties needs", "--planner wavefront"]),
        ("--planner wavefront --search astar --ties last", ["farthest", "first"]),
        ("--planner prm --search deepening", ["--search deepening", "prm has a roadmap"]),
        ("--planner shortest --output cspace.csv", ["cspace.csv holds the values of a grid", "wavefront or harmonic"]),
    ] {
        place.run(&map(), options).refused(2, &parts);
    }
    assert!(!place.path("cspace.csv").exists());
}

/// Returns the grid of `cspace.json`, the number of its free cells, and the label of the cell at `(0.15, 0.15)`, the start.
fn maze_grid(place: &Place, cells: usize, options: &str) -> (serde_json::Value, usize, Option<u64>) {
    place.run(&maze(), &format!("--planner wavefront --cells {cells} --quiet --output cspace.json {options}"));
    let spaces: serde_json::Value = place.json("cspace.json");
    let space = spaces["spaces"][0].clone();
    let grid = &space["grid"];
    let free = grid["blocked"].as_array().unwrap().iter().filter(|blocked| **blocked == 0).count();
    let [i, j] = [2.0, 1.5].map(|extent| (0.15 / (extent / cells as f64)) as usize);
    let label = grid["values"][i * cells + j].as_f64().map(|label| label as u64);
    (space, free, label)
}

/// Compares numbers with a count in fractions, for which cells and C-obstacles are rectangles.
#[test]
fn the_wholly_free_cells_of_a_gantry_are_exact() {
    let place = Place::new();
    for (cells, free, label) in [(16, 149, None), (20, 269, Some(85)), (28, 505, Some(122))] {
        let (space, counted, found) = maze_grid(&place, cells, "--levels 1");
        assert_eq!((counted, found), (free, label), "{cells}");
        assert_eq!(space["grid"]["free"], "whole");
    }
    for path in ["own", "taut"] {
        let done = place.run(&maze(), &format!("--planner wavefront --cells 20 --levels 1 --path {path}")).exits(0);
        assert!(!done.stdout.contains("attempts"), "{}", done.stdout);
    }
}

#[test]
fn a_second_attempt_with_free_centres_is_reported() {
    let place = Place::new();
    let said = "second attempt with 16 x 16 cells: a cell counts as free if its centre is free; \
                wholly free cells show no certified path";
    let done = place.run(&maze(), "--planner wavefront --cells 16 --picture wave.svg").exits(0);
    assert!(done.stdout.lines().any(|line| line.starts_with("attempts") && line.ends_with(said)), "{}", done.stdout);
    assert!(place.read("wave.svg").contains(said));
    let (space, ..) = maze_grid(&place, 16, "");
    assert_eq!((&space["grid"]["free"], &space["grid"]["proves"]["kind"]), (&"center".into(), &"sampled".into()));
    assert_eq!(space["failed_attempts"], serde_json::json!(["16 x 16 cells: no path in it"]));
}

#[test]
fn the_space_whole_has_no_second_attempt() {
    let place = Place::new();
    let done = place.run(&maze(), "--planner wavefront --cells 16 --space whole --picture wave.svg").exits(4);
    assert!(!done.stdout.contains("attempts") && !place.read("wave.svg").contains("its centre"), "{}", done.stdout);
    let (space, free, _) = maze_grid(&place, 16, "--space whole");
    assert_eq!((free, &space["grid"]["free"]), (149, &"whole".into()));
    // Finer cells are wholly free, too.
    let done = place.run(&maze(), "--planner wavefront --cells 16 --space whole --levels 3 --verbose").exits(0);
    assert!(!done.stdout.contains("attempts"), "{}", done.stdout);
}

/// Compares the labels with figure 6.14 of the course, in which the start has no number: it would be 9.
#[test]
fn the_manhattan_navigation_function_is_the_published_one() {
    let place = Place::new();
    let files = [shipped("robots/gantry.urdf"), shipped("workspaces/published/manhattan.toml")];
    let done = place.run(&files, "--planner wavefront --cells 8 --space whole --path own --output cspace.csv").exits(0);
    let published = "2,1,2,3,4,5,inf,inf\n1,0,1,2,3,4,inf,inf\n2,1,2,3,4,5,inf,inf\n3,2,inf,inf,5,6,inf,inf\n\
                     4,3,inf,inf,6,7,8,9\n5,4,inf,inf,7,8,9,10\n6,5,6,7,8,9,10,11\n7,6,7,8,9,10,11,12\n";
    assert_eq!(place.read("cspace.csv"), published);
    done.says(&["9 straight pieces, length 2.0625"]);
}
