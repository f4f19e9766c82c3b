//! The option `--margin 0`, with which exact C-obstacles of gantries are written, and `--graph full`.

use super::*;

fn space(place: &Place, options: &str) -> Value {
    place.run(&maze(), &format!("{options} --quiet --output cspace.json")).exits(0);
    let spaces = place.json("cspace.json");
    spaces["spaces"][0].clone()
}

/// Returns the corners of the outer ring of an obstacle's only polygon, in ascending order.
fn corners(space: &Value, obstacle: &str) -> Vec<[f64; 2]> {
    let all = space["c_obstacles"].as_array().unwrap();
    let polygons = &all.iter().find(|o| o["obstacle"] == obstacle).unwrap()["polygons"];
    assert_eq!(polygons.as_array().unwrap().len(), 1, "{obstacle}");
    let ring: Vec<[f64; 2]> = serde_json::from_value(polygons[0][0].clone()).unwrap();
    let mut corners = ring[1..].to_vec();
    corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
    corners
}

fn near(found: &[[f64; 2]], expected: &[[f64; 2]]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!((a[0] - b[0]).abs() < 1e-12 && (a[1] - b[1]).abs() < 1e-12, "{found:?}, not {expected:?}");
    }
}

/// Checks a head of 0.1 m x 0.1 m beside walls. All sides are parallel, so `B - A` has four corners, too.
#[test]
fn margin_0_writes_the_c_obstacles_of_a_gantry_as_the_sweep_gives_them() {
    let place = Place::new();
    for options in ["--margin 0", "--margin 0 --planner trapezoid", "--margin 0 --planner visibility --graph full"] {
        let exact = space(&place, options);
        assert_eq!(exact["proves"], json!({ "kind": "exact" }), "{options}");
        near(&corners(&exact, "first wall"), &[[0.3, 0.0], [0.3, 1.2], [0.45, 0.0], [0.45, 1.2]]);
        near(&corners(&exact, "dead end"), &[[0.35, 0.65], [0.35, 0.8], [0.57, 0.65], [0.57, 0.8]]);
        assert_eq!(exact["free"]["proves"], json!({ "kind": "exact" }), "{options}");
    }
    let grown = space(&place, "");
    assert_eq!(grown["proves"]["kind"], "outer");
    assert!((corners(&grown, "dead end")[0][0] - 0.35).abs() > 1e-4);
}

/// Checks round corners, which polygons cannot have: of an obstacle, of the head, and those that a clearance makes. The
/// hint of each message works.
#[test]
fn margin_0_is_refused_where_corners_are_round() {
    let place = Place::new();
    let world = |obstacle: &str| {
        let ends = "[start]\njoints = [0.15, 0.15]\n[goal]\njoints = [1.85, 1.35]\n[[obstacle]]\nheight = [0.0, 0.3]\n";
        format!("{ends}{obstacle}")
    };
    let wedge = "name = \"wedge\"\npolygon = [[0.8, 0.4], [1.2, 0.7], [0.8, 1.0]]\n";
    let disc = "name = \"post\"\ncircle = { center = [1.0, 0.7], radius = 0.2 }\n";
    place.write("wedge.toml", world(wedge));
    place.write("disc.toml", world(disc));
    let gantry = shipped("robots/gantry.urdf");
    let cup = [shipped("robots/stage_robot.urdf"), shipped("workspaces/published/cup.toml")];
    for (files, options, reason) in [
        (
            [gantry.clone(), "wedge.toml".into()],
            "--clearance 0.02",
            "a clearance of 20.00 mm rounds the corners of C-obstacles",
        ),
        ([gantry.clone(), "disc.toml".into()], "", "obstacle \"post\" is round"),
        (cup, "", "link \"body\" is round"),
    ] {
        let parts = ["--margin 0 needs C-obstacles that are polygons", reason, "such as --margin 1e-5"];
        // One of the robots comes with a warning.
        let done = place.run(&files, &format!("{options} --margin 0"));
        assert_eq!((done.code, done.stdout.as_str()), (1, ""), "{}", done.stderr);
        assert!(parts.iter().all(|part| done.stderr.contains(part)), "{}", done.stderr);
        place.run(&files, &format!("{options} --margin 1e-5 --output cspace.json")).exits(0);
        let spaces = place.json("cspace.json");
        assert_eq!(spaces["spaces"][0]["proves"]["kind"], "outer");
    }
    place.run(&[gantry, "wedge.toml".into()], "--margin 0 --quiet").exits(0);
}

/// Checks walls that the bridge hits. They block values of joint 1, without any growth.
#[test]
fn margin_0_does_not_grow_what_the_bridge_hits() {
    let place = Place::new();
    let world = "[start]\njoints = [0.15, 0.15]\n[goal]\njoints = [0.9, 1.35]\n[[obstacle]]\nname = \"column\"\n\
                 polygon = [[1.5, 0.2], [1.6, 0.2], [1.6, 0.3], [1.5, 0.3]]\n";
    place.run_in(&shipped("robots/gantry.urdf"), world, "--margin 0 --quiet --output cspace.json").exits(0);
    let spaces = place.json("cspace.json");
    assert_eq!(spaces["spaces"][0]["proves"], json!({ "kind": "exact" }));
    let left = corners(&spaces["spaces"][0], "column")[0][0];
    // The bridge is 0.08 m wide, the head 0.1 m.
    let found = corners(&spaces["spaces"][0], "column");
    let bands: Vec<f64> =
        found.iter().filter(|corner| (corner[1] - 1.5).abs() < 1e-12).map(|corner| corner[0]).collect();
    assert!((left - 1.45).abs() < 1e-12 && (bands[0] - 1.46).abs() < 1e-12, "{found:?}");
    assert!((bands[bands.len() - 1] - 1.64).abs() < 1e-12, "{found:?}");
}

#[test]
fn a_path_that_touches_exact_polygons_is_not_certified() {
    let place = Place::new();
    for planner in ["shortest", "visibility", "visibility --graph full"] {
        let done = place.run(&maze(), &format!("--margin 0 --planner {planner} --verbose")).exits(0);
        let output: Vec<&str> = done.stdout.lines().filter(|line| line.starts_with("exact")).collect();
        assert!(
            output.len() == 1 && output[0].contains("but touches them; the certified path avoids"),
            "{}",
            done.stdout
        );
        let (_, length) = output[0].split_once("the path among the exact polygons has length ").unwrap();
        let exact: f64 = length.split(' ').next().unwrap().parse().unwrap();
        let result = place.run(&maze(), &format!("--margin 0 --planner {planner} --json --quiet")).json();
        let (length, clearance) = (result["length"].as_f64().unwrap(), result["clearance"].as_f64().unwrap());
        assert!(result["certified"] == true && clearance > 0.0, "{clearance}");
        assert!(length > exact - 1e-4 && length < exact * (1.0 + 1e-3), "{length} {exact}");
    }
    let own = place.run(&maze(), "--margin 0 --planner trapezoid --path own --verbose");
    own.says(&["the path was planned among the exact polygons and touches none"]);
}

#[test]
fn margin_0_needs_exact_polygons() {
    let place = Place::new();
    place
        .run(&shelf(), "--margin 0")
        .refused(1, &["--margin 0 needs C-obstacles that are polygons", "this arm is RR", "--margin 1e-5"]);
    place
        .run(&maze(), "--margin 0 --planner wavefront")
        .refused(2, &["--margin 0 needs --planner shortest", "does not grow C-obstacles"]);
    place.run(&maze(), "--margin=-0.1").refused(2, &["from 0 to 0.1"]);
    place.run(&maze(), "--graph full").refused(2, &["--graph needs --planner visibility"]);
}

/// Checks the maze. Its visibility graph has 46 arcs between 22 nodes according to an independent count of the
/// definition, and 11 of them are in the reduced graph. The four corners of the joint limits are no nodes.
#[test]
fn the_full_visibility_graph_of_the_maze_has_all_arcs() {
    let place = Place::new();
    let of = |options: &str| {
        let space = space(&place, &format!("--planner visibility {options}"));
        let roadmap = space["roadmap"].clone();
        (roadmap["edges"].as_array().unwrap().len(), roadmap["visibility"].as_str().unwrap().to_owned())
    };
    assert_eq!(of(""), (11, "reduced".to_owned()));
    assert_eq!(of("--search dijkstra").1, "reduced");
    assert_eq!(of("--graph full"), (46, "full".to_owned()));
    place.run(&maze(), "--planner visibility --graph full --verbose --picture graph.svg").says(&[
        "visibility (astar, full graph): 22 nodes, 46 edges",
        "the corners of C-obstacles (cut off at the joint limits)",
    ]);
    assert!(place.read("graph.svg").contains("full visibility graph"));
    place.run(&maze(), "--planner visibility --picture graph.svg");
    assert!(place.read("graph.svg").contains("reduced visibility graph"));
}
