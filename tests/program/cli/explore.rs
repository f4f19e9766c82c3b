//! `cplan explore` from outside: exit codes, output files, refused input.

use super::*;
/// A coarse grid, which is soon explored.
const COARSE: &str = "--grid 48";

fn rooms() -> [String; 2] {
    [shipped("robots/gantry.urdf"), shipped("workspaces/explore/rooms.toml")]
}

fn explore(place: &Place, files: &[String; 2], options: &str) -> Done {
    place.run(&["explore", &files[0], &files[1]], options)
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

#[test]
fn the_goal_is_reached_by_a_free_motion() {
    let place = Place::new();
    let done = explore(&place, &shelf(), "--output a.json --output a.csv --output a.yaml").exits(0);
    done.says(&["reached: the arm is at the goal"]);
    let result = json(&place.read("a.json"));
    assert_eq!(result["status"], "reached");
    let positions = result["trajectory"]["position"].as_array().unwrap();
    assert_eq!(positions[positions.len() - 1], serde_json::json!([1.55, -0.35]));
    let legs = result["legs"].as_array().unwrap();
    assert!(legs.len() > 2 && legs.windows(2).all(|w| w[0]["path"].as_array().unwrap().last() == w[1]["path"].get(0)));
    // The judge has the true world. It checks the motions that programs execute when they read the files.
    for file in ["a.csv", "a.yaml"] {
        let [urdf, world] = shelf();
        place.run(&["verify", &urdf, &world, file], "").exits(0);
    }
}

#[test]
fn rooms_are_explored_and_the_map_is_a_world() {
    let place = Place::new();
    let files = "--map rooms.yaml --picture rooms.html --picture rooms.svg --quiet";
    for strategy in ["view", "nearest", "harmonic", "wall"] {
        let options = format!("{COARSE} --strategy {strategy} --json");
        let done = explore(&place, &rooms(), &options);
        let result = json(&done.stdout);
        assert_eq!((done.code, &result["status"]), (0, &"explored".into()), "{}", done.stderr);
        assert_eq!(explore(&place, &rooms(), &options).stdout, done.stdout, "not the same again");
        let map = &result["map"];
        let [free, occupied] = ["free", "occupied"].map(|label| map[label].as_u64().unwrap());
        assert!(free > 4000 && occupied > 100, "{map}");
    }
    let done = explore(&place, &rooms(), &format!("{COARSE} {files}"));
    assert_eq!((done.code, done.stdout.as_str()), (0, ""));
    let page = place.read("rooms.html");
    let data = page.split("<script id=\"exploration\" type=\"application/json\">").nth(1).unwrap();
    let data = json(data.split("</script>").next().unwrap());
    assert!(data["frames"].as_array().unwrap().len() > 10 && data["opened"].as_array().unwrap().len() > 10);
    assert!(place.read("rooms.svg").contains("all that it can see, after"));
    // The recorded map is a world in which one can plan, from room to room.
    place.write(
        "seen.toml",
        "[start]\njoints = [0.2, 0.2]\n[goal]\njoints = [1.5, 0.2]\n[[obstacle]]\nimage = \"rooms.yaml\"\nheight = [0.0, 0.3]\n",
    );
    place.run(&[&rooms()[0], "seen.toml"], "").exits(0);
}

/// Checks that the program can continue with a known map. It explores no known area again, and refuses the map of
/// another world.
#[test]
fn an_earlier_map_is_used() {
    let place = Place::new();
    let first = explore(&place, &rooms(), &format!("{COARSE} --map rooms.yaml --json"));
    assert!(json(&first.stdout)["readings"].as_array().unwrap().len() > 50);
    let again = json(&explore(&place, &rooms(), &format!("{COARSE} --known rooms.yaml --json")).stdout);
    assert_eq!((&again["status"], again["length"].as_f64()), (&"explored".into(), Some(0.0)), "{again}");
    assert_eq!(again["map"], json(&first.stdout)["map"]);
    let onto = explore(&place, &rooms(), &format!("{COARSE} --known rooms.yaml --map rooms.yaml"));
    onto.refused(1, &["rooms.yaml", "is the input"]);
    let [robot, world] = rooms();
    let text = read(&world);
    let one = "[0.65, -0.1], [0.7, -0.1], [0.7, 0.5], [0.65, 0.5]";
    assert!(text.contains(one));
    place.write("moved.toml", text.replace(one, "[0.65, -0.1], [0.7, -0.1], [0.7, 0.4], [0.65, 0.4]"));
    let moved = place.run(&["explore", &robot, "moved.toml"], &format!("{COARSE} --known rooms.yaml"));
    moved.refused(1, &["rooms.yaml", "shows occupied space near (0.6", "the world has free space", "hint"]);
    place.write("finer.toml", text.replace("cell = 0.025", "cell = 0.02"));
    let finer = place.run(&["explore", &robot, "finer.toml"], &format!("{COARSE} --known rooms.yaml"));
    finer.refused(1, &["rooms.yaml", "has other cells"]);
}

/// Checks a head that moves above all obstacles, so that its sensor can be above unknown places. One leg of the motion
/// is longer than the sensor's range.
#[test]
fn a_head_above_unknown_space_leaves_nothing_unexplored() {
    let place = Place::new();
    let robot = shipped("robots/gantry.urdf");
    place.write(
        "above.toml",
        "[start]\njoints = [0.2, 0.2]\n[sensor]\non = \"tip\"\nrays = 90\nfield_of_view = \"360deg\"\nrange = 0.04\nstep = 0.05\n\
         cell = 0.01\n[[obstacle]]\npolygon = [[0.65, 0.3], [0.7, 0.3], [0.7, 0.5], [0.65, 0.5]]\nheight = [0.0, 0.01]\n",
    );
    for strategy in ["view", "nearest", "harmonic", "wall"] {
        let run = |options: &str| {
            let options = format!("--grid 12 --strategy {strategy} --json {options}");
            json(&place.run(&["explore", &robot, "above.toml"], &options).stdout)
        };
        let first = run(&format!("--map {strategy}.yaml"));
        assert_eq!((&first["status"], &first["configurations"]), (&"explored".into(), &144.into()));
        let again = run(&format!("--known {strategy}.yaml"));
        assert_eq!((again["readings"].as_array().unwrap().len(), &again["map"]), (1, &first["map"]), "{strategy}");
    }
}

/// Checks obstacles that are all lower than the arm, which passes above them with its tool beside them.
#[test]
fn heights_that_are_known_let_a_scara_pass() {
    let place = Place::new();
    let files = [shipped("robots/scara.urdf"), shipped("workspaces/explore/packing_cell.toml")];
    let done = explore(&place, &files, "--json --output way.csv");
    let result = json(&done.stdout);
    assert_eq!((done.code, &result["status"]), (0, &"reached".into()), "{}", done.stderr);
    let [length, known] = ["length", "known_length"].map(|key| result[key].as_f64().unwrap());
    assert!(length >= known - 1e-9 && known > 1.0, "{length} {known}");
    place.run(&["verify", &files[0], &files[1], "way.csv"], "").exits(0);
}

/// A world in which the sensor sees the obstacles between start and goal from some distance.
const RING: &str = "start.joints = [-2.0, 0.3]\ngoal.joints = [1.6, -0.6]\nsensor = { range = 0.7, on = \"tip\", rays = 200 }\n\
                    [[obstacle]]\npolygon = [[1.0, -0.1], [1.6, -0.1], [1.6, 0.1], [1.0, 0.1]]\n\
                    [[obstacle]]\ncircle = { center = [-0.7, 0.9], radius = 0.2 }\n";

#[test]
fn unreachable_goals_are_proven() {
    let place = Place::new();
    let files = [shipped("robots/planar_2r.urdf"), shipped("workspaces/singular_closed.toml")];
    explore(&place, &files, "").exits(3).says(&["unreachable: proven"]);
    // The earlier motion is valid, and the claims in its file are true.
    place.write("ring.toml", RING);
    let robot = files[0].as_str();
    explore(&place, &[robot, "ring.toml"].map(str::to_owned), "--output ring.json").exits(3);
    place.run(&["verify", robot, "ring.toml", "ring.json"], "--anywhere").exits(0);
    let stopped = explore(&place, &rooms(), "--decisions 1").exits(4);
    stopped.says(&["unknown: not finished after 1 decision"]);
    explore(&place, &rooms(), "--decisions 1 --output stopped.json");
    let [urdf, world] = rooms();
    place.run(&["verify", &urdf, &world, "stopped.json"], "--anywhere").exits(0);
}

/// Checks a grid with so few cells that steps between their centres lead through walls.
#[test]
fn exploration_on_a_coarse_grid_ends() {
    let place = Place::new();
    for strategy in ["view", "nearest", "harmonic", "wall"] {
        for grid in ["9", "13x8"] {
            let done = explore(&place, &rooms(), &format!("--grid {grid} --strategy {strategy}"));
            assert!([0, 4].contains(&done.code), "{}{}", done.stdout, done.stderr);
        }
    }
}

/// Checks that the sensor also detects obstacles that the arm cannot touch, but that are nearer to its reach than the
/// clearance.
#[test]
fn the_clearance_is_kept_from_what_lies_beyond_reach() {
    let place = Place::new();
    let robot = shipped("robots/planar_2r.urdf");
    place.write(
        "far.toml",
        "clearance = 0.3\n[start]\njoints = [-1.5, 1.0]\n[goal]\njoints = [1.5, 0.0]\n\
         [[obstacle]]\npolygon = [[1.93, -1.0], [2.0, -1.0], [2.0, 1.0], [1.93, 1.0]]\n",
    );
    place.run(&["explore", &robot, "far.toml"], "--output far.csv --grid 64").exits(0);
    place.run(&["verify", &robot, "far.toml", "far.csv"], "").exits(0);
}

#[test]
fn invalid_explorations_are_refused() {
    let place = Place::new();
    let explore = |options: &str| explore(&place, &rooms(), options);
    explore("--strategy goal").refused(1, &["needs a goal"]);
    explore("--output a.mcap").refused(2, &["a.mcap", ".json, .csv or .yaml"]);
    explore("--map a.pgm").refused(2, &["a.pgm", "must end in .yaml"]);
    explore("--grid 0").refused(2, &["grid"]);
    explore("--output a.json --picture a.json").refused(2, &["a.json"]);
    let robot = shipped("robots/planar_2r.urdf");
    for (sensor, why) in [
        ("on = \"wrist\"", "not on \"wrist\""),
        ("rays = 0", "1 to 100000 rays, not 0"),
        ("rays = -3", "rays"),
        ("step = 1e-12", "sensor step must be at least"),
        ("range = 0.0", "sensor range must be positive"),
        ("range = nan", "sensor range"),
        ("noise = -1.0", "sensor noise"),
        ("field_of_view = \"400deg\"", "at most a whole turn"),
        ("cell = 1e-9", "the map has more than"),
        ("colour = 1", "unknown key"),
    ] {
        place.write("world.toml", format!("{FREE}[sensor]\n{sensor}\n"));
        place.run(&["explore", &robot, "world.toml"], COARSE).refused(1, &[why]);
    }
}

/// Checks cells around the arm that no steps of the grid connect with the cells around its start, although the arm's
/// own path connects them.
#[test]
fn places_reachable_only_by_going_back_are_explored() {
    let place = Place::new();
    let circles =
        [(0.6548, -0.4113, 0.0295), (-0.1933, -0.8136, 0.0637), (-0.9593, -0.1962, 0.0298), (0.0598, -0.5253, 0.0797)];
    let obstacles =
        circles.map(|(x, y, radius)| format!("[[obstacle]]\ncircle = {{ center = [{x}, {y}], radius = {radius} }}\n"));
    let sensor = "[sensor]\nrays = 1\nfield_of_view = 0.02\nrange = 0.7\nstep = 0.03\ncell = 0.04\n";
    place.write("world.toml", format!("[start]\njoints = [0.3, 0.3]\n{sensor}{}", obstacles.concat()));
    let files = [shipped("robots/planar_2r.urdf"), "world.toml".into()];
    for strategy in ["nearest", "view", "wall"] {
        let options = format!("--grid 64 --surveyed 0.3 --strategy {strategy} --json");
        let first = json(&explore(&place, &files, &format!("{options} --map known.yaml")).stdout);
        assert_eq!(first["status"], "explored");
        let again = json(&explore(&place, &files, &format!("{options} --known known.yaml")).stdout);
        assert_eq!((&again["status"], again["length"].as_f64()), (&"explored".into(), Some(0.0)), "{strategy}");
    }
}
