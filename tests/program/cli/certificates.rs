//! The option `--certificate`, and the verdict of the checker, which shares no code with the program.

use super::*;
/// Returns the certificate without the digests of its files, so that it applies to any files.
pub fn without_digests(certificate: &str) -> String {
    let mut whole: Value = serde_json::from_str(certificate).unwrap();
    ["urdf", "world", "others"].iter().for_each(|name| drop(whole.as_object_mut().unwrap().remove(*name)));
    whole.to_string()
}

/// Returns shipped worlds that are infeasible, and their robots.
fn closed() -> Vec<(String, String)> {
    let folder = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("workspaces")).unwrap();
    let mut found = Vec::new();
    for path in folder.map(|entry| entry.unwrap().path()).filter(|path| path.extension().is_some_and(|e| e == "toml")) {
        let text = read(&path);
        let robot = text.lines().find_map(|line| line.strip_prefix("# robot: "));
        if let Some(robot) = robot.filter(|_| text.contains("# expect: infeasible")) {
            found.push((path.display().to_string(), shipped(&format!("robots/{robot}.urdf"))));
        }
    }
    found.sort();
    found
}

#[test]
fn every_infeasible_shipped_world_has_a_valid_certificate() {
    let closed = closed();
    assert!(closed.len() >= 7, "{closed:?}");
    for (world, robot) in closed {
        let place = Place::new();
        place.run(&[&robot, &world], "--quiet --certificate c.json").exits(3);
        let certificate = place.read("c.json");
        assert!(certificate.len() < 1 << 20, "{world}: {} bytes", certificate.len());
        let judged = |world: &str, certificate: &str| check(&read(&robot), world, certificate);
        judged(&read(&world), &certificate).unwrap_or_else(|why| panic!("{world}: {why}"));
        // If one of the necessary boxes is missing, a path is open. In the twin, which has a path, part of the
        // certificate is false.
        let whole: Value = serde_json::from_str(&certificate).unwrap();
        let without = |k: usize| {
            let mut fewer = whole.clone();
            fewer["boxes"].as_array_mut().unwrap().remove(k);
            judged(&read(&world), &fewer.to_string())
        };
        let count = whole["boxes"].as_array().unwrap().len();
        assert!((0..count).rev().any(|k| matches!(without(k), Err(CheckError::Fails(_)))), "{world}");
        if let Some(twin) = world.strip_suffix("_closed.toml") {
            let open = read(format!("{twin}_open.toml"));
            let anywhere = without_digests(&certificate);
            judged(&read(&world), &anywhere).unwrap_or_else(|why| panic!("{world}: {why}"));
            assert!(matches!(judged(&open, &anywhere), Err(CheckError::Fails(_))), "{twin}");
        }
    }
}

#[test]
fn the_certificate_states_the_query_of_the_command_line() {
    let place = Place::new();
    let files = [shipped("robots/planar_2r.urdf"), shipped("workspaces/limits_closed.toml")];
    let options = "--start 0.4,10deg --goal 2.5,0.1 --clearance 0.01";
    let (_, report) = place.certified(&files[0], &files[1], options, 3);
    has(&report, &["start (0.4, 0.17453292519943295)", "goal (2.5, 0.1)", "clearance 0.01"]);
}

/// Checks the tasks of shipped worlds, with the goal as a place of the tip: with both elbows, with two solutions of a
/// slide, and with a stretched arm.
#[test]
fn enclosed_tip_goals_have_valid_certificates() {
    let place = Place::new();
    for (world, robot, tip) in [
        ("no_path", "planar_2r_continuous", "1.2819,1.2350"),
        ("torus_closed", "planar_2r_continuous", "1.1139,1.3429"),
        ("limits_closed", "planar_2r", "-1.5424,0.9279"),
        ("annulus_closed", "gantry", "0.2,0.2"),
        ("thin_wall_closed", "polar", "0.7648,0.6442"),
        ("slot_closed", "rail_arm", "1.0539,-0.3106"),
    ] {
        let files = [shipped(&format!("robots/{robot}.urdf")), shipped(&format!("workspaces/{world}.toml"))];
        let (_, report) = place.certified(&files[0], &files[1], &format!("--goal-tip={tip}"), 3);
        has(&report, &["a position of the tip \"tool0\""]);
        // The start is on its own side of the boxes.
        let mut other = place.json("c.json");
        other.as_object_mut().unwrap().remove("goal_tip");
        other["goal"] = start_of(&read(&files[1]));
        let judged = check(&read(&files[0]), &read(&files[1]), &other.to_string());
        assert!(matches!(judged, Err(CheckError::Fails(_))), "{world}: {judged:?}");
    }
}

/// Returns the joint values of the start.
fn start_of(world: &str) -> Value {
    let start = world.split("[start]").nth(1).and_then(|rest| rest.split("joints =").nth(1)).unwrap();
    serde_json::from_str(start.lines().next().unwrap()).unwrap()
}

/// Checks a robot that is placed elsewhere together with its world: everything is turned to the left and moved by (2,
/// -1).
#[test]
fn moved_robots_have_certificates() {
    let place = Place::new();
    place.write(
        "world.toml",
        "start.joints = [-0.8, 0.3]\ngoal.joints = [0.9, -0.3]\n[robot]\nat = [2, -1]\nangle = \"90deg\"\n\
         [[obstacle]]\npolygon = [[2.04, -0.6], [2.04, 1.0], [1.96, 1.0], [1.96, -0.6]]\n\
         [[obstacle]]\npolyline = [[2.0, -1.4], [2.0, -3.0]]\n",
    );
    let files = [shipped("robots/planar_2r_continuous.urdf"), "world.toml".to_owned()];
    place.run(&files, "--quiet --certificate c.json").exits(3);
    let urdf = read(&files[0]);
    let judged = |world: &str| check(&urdf, world, &without_digests(&place.read("c.json")));
    let world = place.read("world.toml");
    judged(&world).unwrap();
    for other in ["at = [2, 1]", "at = [2.1, -1]"] {
        assert!(matches!(judged(&world.replace("at = [2, -1]", other)), Err(CheckError::Fails(_))), "{other}");
    }
    assert!(matches!(judged(&world.replace("90deg", "100deg")), Err(CheckError::Fails(_))));
}

/// Checks links that have only visual geometry, or no shapes, so that bars replace them.
#[test]
fn every_shape_of_a_link_is_named() {
    let place = Place::new();
    let whole = read(shipped("robots/planar_2r_continuous.urdf"));
    let world = read(shipped("workspaces/no_path.toml"));
    for (tag, robot, named) in [("visual", "", "\"visual\":0"), ("lamp", "[robot]\nbar = 0.05\n", "\"bar\":0")] {
        place.write("arm.urdf", whole.replace("collision>", &format!("{tag}>")));
        place.write("world.toml", world.replace("[start]", &format!("{robot}[start]")));
        place.run(&["arm.urdf", "world.toml"], "--quiet --certificate c.json").exits(3);
        let certificate = place.read("c.json");
        assert!(certificate.contains(named), "{certificate}");
        let judged = |urdf: &str| check(urdf, &place.read("world.toml"), &certificate);
        judged(&place.read("arm.urdf")).unwrap_or_else(|why| panic!("{tag}: {why}"));
        assert!(matches!(judged(&whole), Err(CheckError::Fails(why)) if why.contains("another URDF")), "{tag}");
        let anywhere = check(&whole, &place.read("world.toml"), &without_digests(&certificate));
        assert!(matches!(anywhere, Err(CheckError::Fails(_))), "{tag}");
    }
}

#[test]
fn a_certificate_does_not_overwrite_its_input() {
    Place::new().plan(FREE, "--quiet --certificate world.toml").refused(1, &["world.toml is the input"]);
}

/// Checks that a certificate applies to its files only, byte by byte, and to the files that they name.
#[test]
fn certificates_are_bound_to_their_files() {
    let place = Place::new();
    let den = |file: &str| read(shipped(&format!("workspaces/{file}")));
    place.write("arm.urdf", read(shipped("robots/planar_2r.urdf")));
    place.write("den.toml", den("den.toml"));
    place.write("den.yaml", den("den.yaml"));
    let picture = std::fs::read(shipped("workspaces/den.pgm")).unwrap();
    place.write("den.pgm", &picture);
    place.run(&["arm.urdf", "den.toml"], "--quiet --certificate c.json --output m.csv").exits(0);
    let judged = || place.judged(["arm.urdf", "den.toml", "c.json"]);
    judged().unwrap();
    for (file, named) in [("arm.urdf", "another URDF"), ("den.toml", "another world"), ("den.yaml", "den.yaml")] {
        let whole = place.read(file);
        place.write(file, format!("{whole}\n"));
        let Err(CheckError::Fails(why)) = judged() else { panic!("{file}") };
        assert!(why.contains(named), "{why}");
        place.write(file, &whole);
    }
    // A pixel becomes a shade lighter.
    let mut other = picture.clone();
    *other.last_mut().unwrap() ^= 1;
    place.write("den.pgm", &other);
    assert!(matches!(judged(), Err(CheckError::Fails(why)) if why.contains("den.pgm")));
    place.write("den.pgm", &picture);
    // The certificate of `verify` refers to the same files, but not to the trajectory.
    place.run(&["verify", "arm.urdf", "den.toml", "m.csv"], "--quiet --certificate v.json").exits(0);
    let digests = |file: &str| {
        let whole = place.json(file);
        ["urdf", "world", "others"].map(|name| whole[name].clone())
    };
    assert_eq!(digests("c.json"), digests("v.json"));
    assert_eq!(digests("c.json")[2].as_array().unwrap().len(), 2);
    place.judged(["arm.urdf", "den.toml", "v.json"]).unwrap();
}

/// Checks that a certificate can be written to a file of its own or into the result. Programs that read the result skip
/// the certificate, and the checker finds it.
#[test]
fn a_certificate_can_be_a_part_of_the_result() {
    let place = Place::new();
    let files = [shipped("robots/planar_2r.urdf"), shipped("workspaces/limits_open.toml")];
    place.run(&files, "--quiet --certificate r.json --output r.json --output m.csv").exits(0);
    place.run(&files, "--quiet --certificate c.json --output plain.json").exits(0);
    let value = |file: &str| place.json(file);
    let mut whole = value("r.json");
    assert_eq!(whole.as_object_mut().unwrap().remove("certificate").unwrap(), value("c.json"));
    assert_eq!(whole, value("plain.json"));
    let judged = |file: &str| place.judged([&files[0], &files[1], file]);
    assert_eq!(judged("r.json").unwrap(), judged("c.json").unwrap());
    assert!(matches!(judged("plain.json"), Err(CheckError::Input { .. })));
    place.run(&["verify", &files[0], &files[1], "r.json"], "--quiet").exits(0);
    // For an infeasible problem, `recheck` verifies the boxes of the proof from the same file.
    let closed = [files[0].clone(), shipped("workspaces/limits_closed.toml")];
    place.run(&closed, "--quiet --certificate r.json --output r.json").exits(3);
    place.judged([&closed[0], &closed[1], "r.json"]).unwrap();
    place.run(&["recheck", &closed[0], &closed[1]], "--proof r.json").exits(0);
    place.run(&files, "--quiet --certificate m.csv --output m.csv").refused(1, &["m.csv", "the same file"]);
}

/// Returns an STL file of a block of 1 m along x that is slightly thinner in the middle. The program uses its convex
/// hull.
fn stl() -> String {
    let ring = |x: f64, half: f64| [[x, -half, -half], [x, half, -half], [x, half, half], [x, -half, half]];
    let rings = [ring(-0.5, 0.05), ring(0.0, 0.02), ring(0.5, 0.05)];
    let mut text = "solid block\n".to_owned();
    for [from, to] in [[0, 1], [1, 2]].map(|pair| pair.map(|k| rings[k])) {
        for k in 0..4 {
            let next = (k + 1) % 4;
            for triangle in [[from[k], from[next], to[k]], [from[next], to[next], to[k]]] {
                let corners = triangle.map(|[x, y, z]| format!("vertex {x} {y} {z}\n")).concat();
                text += &format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n");
            }
        }
    }
    text + "endsolid block\n"
}

/// Checks links with meshes: motions, bounds and proofs refer to the convex hulls.
#[test]
fn arms_of_meshes_have_valid_certificates() {
    let place = Place::new().with("block.stl", stl());
    let meshes = [
        ("<box size=\"1.0 0.1 0.1\"/>", "<mesh filename=\"block.stl\"/>"),
        ("<box size=\"0.8 0.1 0.1\"/>", "<mesh filename=\"block.stl\" scale=\"0.8 1 1\"/>"),
    ];
    place.write("arm.urdf", planar_2r(&meshes));
    for (world, code, part) in
        [("shelf", 0, "is shorter than"), ("limits_open", 0, "is shorter than"), ("limits_closed", 3, "no motion of")]
    {
        let world = shipped(&format!("workspaces/{world}.toml"));
        has(&place.certified("arm.urdf", &world, "", code).1, &[part]);
        // Another mesh is another robot.
        place.write("block.stl", format!("{}\n", stl()));
        let judged = place.judged(["arm.urdf", &world, "c.json"]);
        assert!(matches!(judged, Err(CheckError::Fails(why)) if why.contains("block.stl")), "{world}");
        place.write("block.stl", stl());
    }
}

/// Checks arms with two bars of a millimetre or two, among polygons that are a thousand times as large. The shortest
/// paths keep some nanometres from the polygons' sides.
#[test]
fn shortest_paths_past_huge_obstacles_have_valid_certificates() {
    // The tip is at the elbow.
    let arm = |[first, second]: [f64; 2], width: f64| {
        planar_2r(&[
            ("revolute", "continuous"),
            ("\"0.8 0 0\"", "\"0 0 0\""),
            ("\"0.5 0 0\"", &format!("\"{} 0 0\"", first / 2.0)),
            ("\"0.4 0 0\"", &format!("\"{} 0 0\"", second / 2.0)),
            ("1.0 0.1 0.1", &format!("{first} {width} {width}")),
            ("0.8 0.1 0.1", &format!("{second} {width} {width}")),
            ("\"1.0 0 0\"", &format!("\"{first} 0 0\"")),
        ])
    };
    let drawn = [
        (
            arm([0.000_768_001_349_861_993, 0.000_496_322_129_867_232_4], 3.251_186_249_428_235e-5),
            "start.joints = [-0.7658430157668175, 0.6172762024624654]\ngoal.joints = [0.6680556539680671, 0.3629183085269361]\n\
             [[obstacle]]\npolygon = [[0.001066289303945124, -0.000513903727308219], [2.1648420973291085, -2.631137332551655], \
             [4.795465526153455, -0.4673615245264915], [2.6316897181282917, 2.163261904297855]]\n",
        ),
        (
            arm([0.000_881_213_591_769_368_7, 0.000_833_884_153_919_755_6], 0.000_149_795_346_061_618_28),
            "start.joints = [-2.127767445010293, 0.5185130737650949]\ngoal.joints = [-1.253169459995272, -1.613275432719459]\n\
             [[obstacle]]\npolygon = [[-6.416929572231785, 17.412259488316753], [-18.024165429593197, 13.135443473552318], \
             [-9.470533400064332, -10.079028241170503], [2.13670245729708, -5.802212226406071]]\n",
        ),
    ];
    for (urdf, world) in &drawn {
        let place = Place::new().with("a.urdf", urdf).with("world.toml", world);
        place.certified("a.urdf", "world.toml", "", 0);
    }
}

/// Checks goal areas: a path ends on the rim of one area, and a proof covers all areas. The checker accepts both.
#[test]
fn goal_areas_have_valid_certificates() {
    let robot = shipped("robots/room_gantry.urdf");
    let judged = |areas: &str, walls: &str, code: i32| {
        let place = Place::new().with("world.toml", format!("start.joints = [0, 0]\ngoal.areas = [{areas}]\n{walls}"));
        place.certified(&robot, "world.toml", "--json", code).0.json()
    };
    let post = "[[obstacle]]\npolyline = [[4, -3], [4, 3]]\nheight = [0, 3]\n";
    let found = judged("[[5, -1], [7, 1]], [[-9, -2], [-8, 2]]", post, 0);
    let length = found["length"].as_f64().unwrap();
    // The path leads past the wall's end to the lower left corner of the first area's upper side.
    let expected = 4f64.hypot(3.15) + 1f64.hypot(2.15);
    assert!((expected - 0.2..expected + 0.2).contains(&length), "{length} {expected}");
    let inside = judged("[[-1, -1], [1, 1]]", post, 0);
    assert!(inside["length"].as_f64().unwrap() < 1e-9, "{inside}");
    let ring = "[[obstacle]]\npolyline = [[-2, -2], [2, -2], [2, 2], [-2, 2], [-2, -2]]\nheight = [0, 3]\n";
    judged("[[5, -1], [7, 1]], [[-9, -2], [-8, 2]]", ring, 3);
    // Only a corner of the area is within the ring.
    judged("[[1, 1], [7, 7]]", ring, 0);
}

#[test]
fn invalid_goal_areas_are_refused_and_turning_arms_take_the_middle() {
    let place = Place::new();
    for (goal, parts) in [
        ("areas = []", &["the goal has no area", "two opposite corners"][..]),
        ("areas = [[[1, 2]]]", &["goal area: expected two opposite corners, found 1"]),
        ("areas = [[[1, 2], [3]]]", &["goal area: expected two numbers, found 1"]),
        ("areas = [[[1, 2], [3, nan]]]", &["finite"]),
        ("areas = [[[1, 2], [3, 4]]]\ntip = [1, 1]", &["`areas` together with `joints` or `tip`"]),
    ] {
        place.write("world.toml", format!("[start]\njoints = [0, 0]\n[goal]\n{goal}\n"));
        let gantry = shipped("robots/room_gantry.urdf");
        place.run(&[&*gantry, "world.toml"], "").refused(1, parts);
    }
    place.write("world.toml", "start.joints = [0, 0]\ngoal.areas = [[[100, 2], [103, 4]]]\n");
    let far = place.run(&[shipped("robots/room_gantry.urdf").as_str(), "world.toml"], "").exits(1);
    far.warns(&["the goal area from (100, 2) to (103, 4) is outside the joint limits"]);
    let turned =
        place.plan(format!("{}[goal]\nareas = [[[1.0, 0.9], [1.2, 1.1]]]\n", "[start]\njoints = [-0.9, 0.4]\n"), "");
    assert_eq!(turned.code, 0, "{}", turned.stderr);
    assert!((turned.stdout + &turned.stderr).contains("the goal is the middle of the goal area: (1.1, 1)"));
}
