//! The option `--path own|taut`, and answers if a planner's space does not contain the path that exists.

use super::*;
use cplan::engine::Method;

#[test]
fn planners_with_two_paths_return_the_requested_one() {
    let place = Place::new();
    let run = |options: &str| place.run(&shelf(), &format!("{options} --cells 64 --json")).exits(0).json();
    for (planner, usual) in [
        ("trapezoid", "taut"),
        ("triangles", "taut"),
        ("voronoi", "own"),
        ("prm", "taut"),
        ("wavefront", "taut"),
        ("harmonic", "own"),
        ("subdivision", "taut"),
    ] {
        let [plain, own, taut] =
            ["", "--path own", "--path taut"].map(|path| run(&format!("--planner {planner} {path}")));
        assert_eq!([&own["path_kind"], &taut["path_kind"]], [&json!("own"), &json!("taut")], "{planner}");
        assert_eq!(plain["path"], if usual == "own" { &own } else { &taut }["path"], "{planner}");
        assert_eq!(plain["path_kind"], json!(usual), "{planner}");
        let length = |result: &Value| result["length"].as_f64().unwrap();
        assert!(length(&own) > 1.02 * length(&taut), "{planner}: {} and {}", length(&own), length(&taut));
    }
    let staircase = run("--planner wavefront --path own");
    let path = staircase["path"].as_array().unwrap();
    let straight =
        |pair: &[Value]| (0..2).any(|k| (pair[0][k].as_f64().unwrap() - pair[1][k].as_f64().unwrap()).abs() < 1e-9);
    // All pieces except those from the start to the first cell, and from the last cell to the goal.
    assert!(path[1..path.len() - 1].windows(2).all(straight), "a step that is not along a joint");
    for planner in ["shortest", "visibility", "first"] {
        let [plain, taut] = ["", "--path taut"].map(|path| run(&format!("--planner {planner} {path}")));
        assert_eq!(taut["path_kind"], "taut", "{planner}");
        assert_eq!(taut["path"], plain["path"], "{planner}");
    }
}

#[test]
fn the_shortest_path_has_no_other_beside_it() {
    let place = Place::new();
    place
        .run(&["no.urdf", "no.toml"], "--path own")
        .refused(2, &["--path own does not apply to planner shortest", "only path is taut"]);
    place.run(&["no.urdf", "no.toml"], "--path straight").refused(2, &["own, taut"]);
    let compare = ["compare", "no.urdf", "no.toml", "--with", "visibility --path own"];
    let done = place.command().args(compare).output().unwrap();
    assert_eq!(done.status.code(), Some(2));
    assert!(String::from_utf8(done.stderr).unwrap().contains("--path own does not apply to planner visibility"));
}

#[test]
fn a_trapezoids_own_path_has_the_centres_of_its_cells_between_the_middles_of_portals() {
    let place = Place::new();
    let world = format!("{FREE}[[obstacle]]\nname = \"post\"\ncircle = {{ center = [1.3, 0.2], radius = 0.2 }}\n");
    let done = place.plan(world, "--planner trapezoid --path own --json").exits(0);
    let path = done.json()["path"].as_array().unwrap().len();
    // Start, then portals and centres in turn, a portal, goal.
    assert!(path >= 3 && path % 2 == 1, "{path} waypoints");
}

#[test]
fn compare_lists_both_paths_of_each_planner() {
    let place = Place::new();
    let [urdf, world] = shelf();
    let json = place.run(&["compare", &urdf, &world], "--cells 48 --json --quiet").exits(0).json();
    let rows = json["planners"].as_array().unwrap();
    let names: Vec<&str> = rows.iter().map(|row| row["planner"].as_str().unwrap()).collect();
    assert_eq!(names, Method::ALL.map(Method::name));
    for row in rows {
        if ["shortest", "visibility", "first"].contains(&row["planner"].as_str().unwrap()) {
            assert!(row["paths"].is_null(), "{row}");
            continue;
        }
        let of = |kind: &str, key: &str| row["paths"][kind][key].as_f64().unwrap();
        assert!(of("own", "length") > of("taut", "length"), "{row}");
        let kind = row["path_kind"].as_str().unwrap();
        assert_eq!(
            (&row["length"], &row["clearance"]),
            (&row["paths"][kind]["length"], &row["paths"][kind]["clearance"])
        );
        if row["planner"] == "harmonic" || row["planner"] == "voronoi" {
            assert!(kind == "own" && of("own", "clearance") > of("taut", "clearance"), "{row}");
        }
    }
    let table = place.run(&["compare", &urdf, &world], "--cells 48 --quiet --wide").stdout;
    for column in ["own [rad]", "own [mm]", "taut [rad]", "taut [mm]"] {
        assert!(table.contains(column), "{column} is not in {table}");
    }
    let with = ["--with", "trapezoid --path own", "--planner", "trapezoid", "--json", "--quiet"];
    let two = place.command().args(["compare", &urdf, &world]).args(with).output().unwrap();
    let two: Value = serde_json::from_slice(&two.stdout).unwrap();
    assert_eq!((two["planners"].as_array().unwrap().len(), &two["planners"][1]["path_kind"]), (2, &json!("own")));
}

/// Checks a slot that the arm can pass, but that the cells are too coarse to show. The answer states that there is a
/// path, but contains none.
#[test]
fn where_cells_are_too_coarse_the_answer_says_whether_there_is_a_path() {
    let place = Place::new();
    for planner in ["wavefront", "harmonic"] {
        let on = |world: &str| {
            let files = [shipped("robots/planar_2r.urdf"), shipped(world)];
            place.run(&files, &format!("--planner {planner} --cells 16 --levels 1 --json"))
        };
        let json = on("workspaces/narrow_slot.toml").exits(4).json();
        assert_eq!((&json["status"], &json["path_exists"]), (&json!("unknown"), &json!(true)), "{planner}");
        assert!(json["path"].is_null() && json["certified"] == false);
        let reason = json["reason"].as_str().unwrap();
        assert!(reason.starts_with("a path exists (certified by subdivision)"), "{reason}");
        let closed = on("workspaces/singular_closed.toml");
        assert_eq!((closed.code, &closed.json()["status"]), (3, &json!("infeasible")), "{planner}: {}", closed.stderr);
    }
}

/// Checks the text on `--path middles` against a path around the end of a wall: both portals of the cell beside it lie on
/// one vertical.
#[test]
fn middles_pass_a_centroid_in_a_u_turn_and_the_help_says_so() {
    let place = Place::new();
    let help = place.run(&["help", "planners"], "").stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(help.contains("with a cell's centroid only between two portals on one vertical (a U-turn)"), "{help}");
    let files = [shipped("robots/stage_robot.urdf"), shipped("workspaces/published/cup.toml")];
    let done = place.run(&files, "--planner trapezoid --path middles --json --output cspace.json").exits(0);
    let spaces = place.json("cspace.json");
    let cells = &spaces["spaces"][0]["cells"];
    let [centers, middles] = ["centers", "middles"].map(|key| cells[key].as_array().unwrap().clone());
    let passed = done.json()["path"].as_array().unwrap().clone();
    let mut turns = 0;
    for (portals, center) in middles.windows(2).zip(&centers[1..]) {
        let is_turn = (portals[0][0].as_f64().unwrap() - portals[1][0].as_f64().unwrap()).abs() < 1e-12;
        assert_eq!(passed.contains(center), is_turn, "{center}");
        turns += usize::from(is_turn);
    }
    assert!(turns > 0, "the path has no U-turn");
}
