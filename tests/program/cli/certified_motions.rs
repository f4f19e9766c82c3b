//! Certificates of motions, and the verdict of the checker, which shares no code with the program.

use super::certificates::without_digests;
use super::*;

/// Returns shipped worlds that are feasible by name, and their robots.
fn open() -> Vec<(String, String)> {
    let folder = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("workspaces")).unwrap();
    let mut found = Vec::new();
    for path in folder.map(|entry| entry.unwrap().path()).filter(|path| path.extension().is_some_and(|e| e == "toml")) {
        let text = read(path.display().to_string());
        let robot = text.lines().find_map(|line| line.strip_prefix("# robot: "));
        if let Some(robot) = robot.filter(|_| text.contains("# expect: found")) {
            found.push((path.display().to_string(), shipped(&format!("robots/{robot}.urdf"))));
        }
    }
    found.sort();
    found
}

/// Returns the certificate, with its motion changed by `alter`.
fn with_changed_motion(certificate: &str, alter: impl FnOnce(&mut Vec<Value>)) -> String {
    let mut whole: Value = serde_json::from_str(certificate).unwrap();
    alter(whole["motion"]["knots"].as_array_mut().unwrap());
    whole.to_string()
}

#[test]
fn every_solved_shipped_world_has_a_valid_certificate() {
    let open = open();
    assert!(open.len() >= 20, "{open:?}");
    let mut bounds = 0;
    for (world, robot) in open {
        let place = Place::new();
        place.run(&[&robot, &world], "--quiet --certificate c.json --output plan.json").exits(0);
        let certificate = place.read("c.json");
        assert!(certificate.len() < 1 << 20, "{world}: {} bytes", certificate.len());
        let judged = |world: &str, certificate: &str| {
            place.write("altered.json", certificate);
            place.judged([&robot, world, "altered.json"])
        };
        let begun = std::time::Instant::now();
        let verdict = judged(&world, &certificate);
        eprintln!("{world}: {} bytes, {:.3} s", certificate.len(), begun.elapsed().as_secs_f64());
        let report = verdict.unwrap_or_else(|why| panic!("{world}: {why}"));
        // The checker proves the reported bound, except for a small loss from the walls.
        let plan = place.json("plan.json");
        let [output, length] = ["lower_bound", "length"].map(|of| plan["optimum"][of].as_f64().unwrap());
        if let Some((_, proven)) = report.split_once("is shorter than ") {
            let proven: f64 = proven.parse().unwrap();
            assert!((0.99 * output..=length).contains(&proven), "{world}: {proven}, {output} told of {length}");
            eprintln!("  bound {proven:.6}: {:.1e} below {output:.6}", 1.0 - proven / output);
            bounds += 1;
        } else {
            eprintln!("  no bound");
        }
        let fails = |world: &str, certificate: &str| matches!(judged(world, certificate), Err(CheckError::Fails(_)));
        // A motion without its end does not reach the goal. A clearance greater than any distance is false.
        assert!(fails(&world, &with_changed_motion(&certificate, |knots| knots.truncate(knots.len() / 2))), "{world}");
        let farther = certificate.replacen("\"motion\"", "\"clearance\": 100.0,\n  \"motion\"", 1);
        assert!(fails(&world, &farther), "{world}");
        if let Some(twin) = world.strip_suffix("_open.toml") {
            let closed = format!("{twin}_closed.toml");
            assert!(fails(&closed, &certificate) && fails(&closed, &without_digests(&certificate)), "{twin}");
        }
    }
    assert!(bounds >= 15, "{bounds}");
}

#[test]
fn the_certificate_states_motion_and_query() {
    let place = Place::new();
    let files = shelf();
    let report = |options: &str| {
        place.run(&files, &format!("--quiet --certificate c.json --output plan.json {options}")).exits(0);
        let [certificate, plan] = ["c.json", "plan.json"].map(|file| place.json(file));
        // The samples are those of the trajectory, number by number.
        let knots = certificate["motion"]["knots"].as_array().unwrap();
        let times = plan["trajectory"]["time"].as_array().unwrap();
        assert!(knots.len() == times.len() && (0..knots.len()).all(|k| knots[k][0] == times[k]));
        let rows = ["position", "velocity"].map(|name| plan["trajectory"][name].as_array().unwrap());
        for (k, knot) in knots.iter().enumerate() {
            assert!((0..2).all(|j| knot[1 + j] == rows[0][k][j] && knot[3 + j] == rows[1][k][j]), "knot {k}");
        }
        place.judged([&files[0], &files[1], "c.json"]).unwrap()
    };
    let plain = report("");
    assert!(plain.contains("read as cubic or quartic") && !plain.contains("within"), "{plain}");
    assert!(report("--jerk 100,100").contains("read as cubic)"));
    let asked = report("--start -0.9,10deg --goal 1.5,-0.3 --clearance 0.0005");
    has(&asked, &["start (-0.9, 0.17453292519943295)", "goal (1.5, -0.3)", "clearance 0.0005"]);
    let tip = report("--goal-tip 0.35,0.5");
    assert!(tip.contains("goal (0.35, 0.5), a position of the tip") && tip.contains("within 1e-1"), "{tip}");
}

/// Checks the motions of the planners other than the default, and a motion with sharp corners.
#[test]
fn motions_of_every_planner_hold() {
    let place = Place::new();
    let files = shelf();
    for options in ["--planner visibility", "--planner voronoi", "--planner prm", "--planner harmonic", "--blend none"]
    {
        place.certified(&files[0], &files[1], options, 0);
    }
}

#[test]
fn a_motion_without_obstacles_has_a_certificate() {
    Place::new().with("world.toml", FREE).certified(&shelf()[0], "world.toml", "", 0);
}

#[test]
fn verify_writes_certificates_of_motions_that_it_accepts() {
    let place = Place::new();
    let [urdf, world] = shelf();
    place.run(&[&urdf, &world], "--quiet --output m.csv --output m.json --output m.yaml").exits(0);
    place.write("path.csv", "shoulder,elbow\n-0.9,0.4\n-0.9,0.5\n");
    let judged = |file: &str, options: &str| {
        let files = ["verify", &urdf, &world, file];
        let done = place.run(&files, &format!("--quiet --certificate {file}.c {options}"));
        (done.code, place.path(&format!("{file}.c")).exists(), done.stderr)
    };
    for (file, options, part) in [
        ("m.csv", "", "read as cubic)"),
        ("m.yaml", "", "read as cubic)"),
        ("m.json", "--clearance 0.000001", "clearance 0.000001"),
        ("path.csv", "--anywhere", "start (-0.9, 0.4) to the goal (-0.9, 0.5) with"),
        ("path.csv", "--start -0.9,0.400001 --goal -0.9,0.5", "start (-0.9, 0.400001), within 1e-5,"),
    ] {
        let (code, exists, why) = judged(file, options);
        assert!(code == 0 && exists, "{file}: {code} {why}");
        let report = place.judged([&urdf, &world, &format!("{file}.c")]).unwrap();
        assert!(report.contains(part), "{file}: {report}");
    }
    place.write("through.csv", "shoulder,elbow\n-0.9,0.4\n1.55,-0.35\n");
    let (code, exists, why) = judged("through.csv", "");
    assert!(code == 3 && !exists && why.contains("not accepted"), "{code} {why}");
}

/// Checks coordinates of a map, in the hundreds of kilometres.
#[test]
fn an_arm_far_from_the_origin_has_certificates() {
    let place = Place::new();
    let urdf = shipped("robots/planar_2r.urdf");
    let obstacle =
        "polygon = [[600001.15, 900000.18], [600001.6, 900000.18], [600001.6, 900000.3], [600001.15, 900000.3]]";
    place.write(
        "world.toml",
        format!(
            "robot.at = [6e5, 9e5]\nstart.joints = [-0.9, 0.4]\ngoal.joints = [1.55, -0.35]\n[[obstacle]]\n{obstacle}\n"
        ),
    );
    has(&place.certified(&urdf, "world.toml", "", 0).1, &["is shorter than"]);
}

/// Checks limits that cannot be written as doubles: limits in degrees, or with more digits than a double has. The
/// nearest double may lie slightly beyond such a limit.
#[test]
fn motions_from_limit_to_limit_are_within_the_limits_as_they_are_written() {
    let place = Place::new();
    let urdf = shipped("robots/planar_2r.urdf");
    let hold = |options: &str| place.certified(&urdf, "world.toml", options, 0).1;
    for [low, high] in [["-135deg", "77.7deg"], ["-50deg", "0.7deg"], ["-1.23deg", "2.7deg"], ["0deg", "100deg"]] {
        let ends = [format!("[\"{low}\", 0]"), format!("[\"{high}\", \"{high}\"]")];
        place.write(
            "world.toml",
            format!(
                "[robot.limits]\nshoulder = [\"{low}\", \"{high}\"]\nelbow = [\"-1deg\", \"{high}\"]\n\
                 [start]\njoints = {}\n[goal]\njoints = {}\n",
                ends[0], ends[1]
            ),
        );
        // The same limits on the command line, in the other direction.
        for options in [String::new(), format!("--start {high},{high} --goal={low},0")] {
            has(&hold(&options), &["is shorter than"]);
        }
    }
    let many = |end: &str| {
        format!("[robot.limits]\nelbow = [-1, {end}]\n[start]\njoints = [0, 0]\n[goal]\njoints = [0, {end}]\n")
    };
    for end in ["0.10000000000000000000001", "0.09999999999999999999999", "2.7182818284590452353602874713526624977572"]
    {
        place.write("world.toml", many(end));
        hold("");
    }
}

/// Checks a limit of 0, at which a margin in proportion to the limit is 0, too.
#[test]
fn motions_at_a_limit_of_0_are_within_the_limits_as_they_are_written() {
    let place = Place::new();
    let urdf = shipped("robots/gantry.urdf");
    for (from, to) in [("0.3,0.1", "0,0"), ("0,0", "1.2,0.7"), ("1.9,0", "0,1.4")] {
        for options in ["--jerk 8,8", "--jerk 20,20 --optimize time", ""] {
            place.write("world.toml", format!("[start]\njoints = [{from}]\n[goal]\njoints = [{to}]\n"));
            place.certified(&urdf, "world.toml", options, 0);
        }
    }
}
