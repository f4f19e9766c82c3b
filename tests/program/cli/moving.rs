//! Moving obstacles, through the program: plans, their execution, judgements and refusals.

use super::*;
fn moving(name: &str) -> [String; 2] {
    [shipped("robots/planar_2r.urdf"), shipped(&format!("workspaces/moving/{name}.toml"))]
}

/// Returns a world with one obstacle of this motion, far from the arm.
fn world(motion: &str) -> String {
    format!("{FREE}[[obstacle]]\nname = \"cart\"\ncircle = {{ center = [0, 0], radius = 0.1 }}\nmotion = {motion}\n")
}

#[test]
fn the_arm_waits_until_the_cart_has_gone() {
    let place = Place::new();
    let [urdf, world] = moving("crossing");
    place
        .run(
            &moving("crossing"),
            "--verbose --output m.json --output m.csv --output m.yaml --picture m.html --picture m.svg",
        )
        .exits(0)
        .says(&[
            "moving     1 obstacle",
            "waits      1.46 s for cart: from 0.000 to 1.460 s at ",
            "1 obstacle, 1 moving",
        ]);
    let result = place.json("m.json");
    let output = &result["moving"];
    assert_eq!((&output["obstacles"], &output["free_until"]), (&1.into(), &Value::Null));
    assert_eq!(result["closest"], "link \"forearm\" and obstacle \"cart\"");
    assert!(number(&result["clearance"]) <= number(&output["clearance"]) && number(&result["clearance"]) > 0.0);
    // The cart leaves the path at 2.9 s at the earliest, and the arm takes 1.15 s without it.
    let [from, to] = ["from", "to"].map(|end| number(&output["waits"][0][end]));
    assert!(from < 1.0 && 1.0 < to && to < 3.0, "{output}");
    assert!((2.9..3.7).contains(&number(&result["duration"])), "{}", result["duration"]);
    // Every consumer plays the certified motion.
    for file in ["m.json", "m.csv", "m.yaml"] {
        place.run(&["verify", &urdf, &world, file], "").exits(0);
    }
    let page = place.read("m.html");
    assert!(page.contains("\"movers\":[{") && page.contains("\"moments\":[{"));
    // The same motion without its wait hits the cart.
    let table = place.read("m.csv");
    let mut lines = table.lines();
    let header = lines.next().unwrap();
    let rows: Vec<Vec<f64>> = lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    let begins = rows.iter().position(|row| row[0] >= to - 1e-9).unwrap();
    let rushed = rows[begins..].iter().map(|row| {
        let cells = std::iter::once(row[0] - rows[begins][0]).chain(row[1..].iter().copied());
        cells.map(|cell| cell.to_string()).collect::<Vec<_>>().join(",")
    });
    place.write("rushed.csv", [header.to_owned()].into_iter().chain(rushed).collect::<Vec<_>>().join("\n"));
    let judged = place.run(&["verify", &urdf, &world, "rushed.csv"], "--anywhere").exits(3);
    judged.says(&["obstacle \"cart\""]);
    // Without times, a motion cannot be judged.
    place.write("path.csv", "shoulder,elbow\n-0.9,0.3\n0.9,-0.3\n");
    place.run(&["verify", &urdf, &world, "path.csv"], "").exits(4).says(&["no times"]);
}

/// Checks a goal of the tip. The fastest motion may follow another path than the shortest one, and end at another IK
/// solution. Then it counts from which time that other solution is free.
#[test]
fn the_fastest_motion_is_timed_along_its_own_path() {
    let place = Place::new();
    let world = |stops: &str| {
        format!(
            "robot.velocity = {{ shoulder = 3.0, elbow = 0.3 }}\nstart.joints = [0.0, -0.1]\ngoal.tip = [1.432242, 0.673177]\n\
             [[obstacle]]\ncircle = {{ center = [0, 0], radius = 0.1 }}\nmotion = {{ stops = [{stops}] }}\n"
        )
    };
    let plan =
        |stops: &str| place.run_in(&shipped("robots/planar_2r.urdf"), world(stops), "--optimize time --json").json();
    // The disc arrives at the position of the upper arm.
    let output = plan("{ time = 4, at = [0, 3] }, { time = 6, at = [0.638, 0.77] }");
    let until = output["moving"]["free_until"].as_f64().expect("a time");
    let goal = output["path"].as_array().unwrap().last().unwrap().to_string();
    for (time, result) in [(until - 0.01, "result     free"), (until + 0.01, "result     not free")] {
        let at = format!("--at={} --time {time}", goal.trim_matches(['[', ']']));
        place.run(&["check", &shipped("robots/planar_2r.urdf"), "world.toml"], &at).says(&[result]);
    }
    // The disc blocks only the other solution.
    let output = plan(
        "{ time = 0, at = [3, 0.2] }, { time = 3, at = [1.25, 0.25] }, { time = 6, at = [1.25, 0.25] }, { time = 9, at = [3, 0.2] }",
    );
    assert_eq!(output["moving"]["waits"].as_array().map(Vec::len), Some(0), "{output}");
    assert!(output["duration"].as_f64().unwrap() < 3.5, "{output}");
}

#[test]
fn a_posture_is_checked_at_a_time() {
    let place = Place::new();
    let [urdf, world] = moving("crossing");
    let check = |options: &str| place.run(&["check", &urdf, &world], &format!("--at 0,0 {options}")).stdout;
    assert!(check("").contains("result     free"));
    assert!(check("--time 1.5").contains("obstacle \"cart\": penetrates"));
    assert!(check("--time 9").contains("result     free"));
}

#[test]
fn a_proof_that_no_timing_helps_leaves_the_answer_unknown() {
    let output = Place::new().run(&moving("parked"), "--json").exits(4).json();
    assert_eq!((&output["status"], &output["trajectory"]), (&"unknown".into(), &Value::Null));
    let reason = output["reason"].as_str().unwrap();
    assert!(reason.contains("no timing along the one route tried avoids the moving obstacles (proven)"), "{reason}");
}

#[test]
fn invalid_motions_of_obstacles_are_refused_with_their_place() {
    let place = Place::new();
    for (motion, parts) in [
        ("{ }", ["world.toml: line 8, column 10", "neither `stops` nor `velocity`"]),
        ("{ velocity = [0.1] }", ["world.toml: line 8", "two numbers"]),
        ("{ velocity = [inf, 0] }", ["world.toml: line 8", "not a finite number"]),
        ("{ stops = [] }", ["world.toml: line 8", "a moving obstacle needs at least one stop"]),
        ("{ stops = [{ time = -1, at = [3, 3] }] }", ["world.toml: line 8", "must not be negative"]),
        (
            "{ stops = [{ time = 1, at = [3, 3] }, { time = 1, at = [4, 3] }] }",
            ["world.toml: line 8", "is not later than"],
        ),
        ("{ stops = [{ time = 1e9, at = [3, 3] }] }", ["world.toml: line 8", "too large (at most 1e6)"]),
        ("{ speed = 1 }", ["world.toml: line 8", "unknown key `speed`"]),
        ("3", ["world.toml: line 8", "motion = { velocity = [vx, vy] }"]),
    ] {
        place.plan(world(motion), "").refused(1, &parts);
    }
    // The obstacle is where the arm begins.
    let done = place.plan(world("{ stops = [{ time = 0, at = [0.6, -0.8] }, { time = 1, at = [3, 3] }] }"), "--json");
    assert_eq!(done.code, 1);
    let output = done.json();
    assert_eq!(output["kind"], "start");
    assert!(output["message"].as_str().unwrap().contains("hits moving obstacle \"cart\""), "{output}");
}

#[test]
fn commands_without_time_refuse_moving_obstacles() {
    let place = Place::new();
    let [urdf, world] = moving("crossing");
    for command in ["compare", "explain", "explore", "reach", "converge"] {
        place.run(&[command, &urdf, &world], "").refused(1, &["obstacle \"cart\" moves", "remove the motion"]);
    }
    let [urdf, world] = moving("belt_pick");
    for command in ["explain", "explore", "reach"] {
        place.run(&[command, &urdf, &world], "").refused(1, &["\"bottle 1\" moves", "remove the motion"]);
    }
}

/// Checks that bottles are picked where they are at that time, in all written files.
#[test]
fn bottles_are_picked_from_a_belt() {
    let place = Place::new();
    let [urdf, world] = moving("belt_pick");
    let files = "--verbose --output m.json --output m.csv --output m.mcap --picture m.html --picture m.svg";
    let done = place.run(&moving("belt_pick"), files).exits(0);
    done.says(&["found and certified: 6 steps", "3 objects, 3 moving", "moving     3 obstacles", "pick \"bottle 3\""]);
    let result = place.json("m.json");
    assert_eq!(result["moving"]["obstacles"], 3);
    let events = result["events"].as_array().unwrap();
    let grasps: Vec<&Value> = events.iter().filter(|event| event["event"] == "grasp").collect();
    assert_eq!(grasps.len(), 3);
    for (grasp, first) in grasps.iter().zip([-1.6, -2.7, -3.8]) {
        let (time, tip) = (number(&grasp["time"]), &grasp["tip"]);
        let off = (number(&tip[0]) - 1.3).hypot(number(&tip[1]) - (first + 0.35 * time));
        assert!(off < 1e-8, "{grasp}: the bottle is {off} m away");
    }
    assert!(number(&result["lower_bound"]) <= number(&result["duration"]));
    place.run(&["verify", &urdf, &world, "m.json"], "").exits(0);
    let page = place.read("m.html");
    assert!(page.contains("\"movers\":[{") && page.contains("\"until\":1.01"), "what moves is not on the page");
    assert!(place.read("m.svg").contains("bottle 1, moving"));
    // Without its steps, the motion is judged empty-handed while the bottles move on: the third is still on the belt.
    place.run(&["verify", &urdf, &world, "m.csv"], "").exits(3);
}

/// Checks falsified recordings of a task. One that is a little late picks beside the bottles. One that is too fast does
/// not pause long enough.
#[test]
fn a_falsified_recording_of_a_task_is_found_out() {
    let place = Place::new();
    let [urdf, world] = moving("belt_pick");
    let result = place.run(&moving("belt_pick"), "--json").json();
    let judge = |name: &str, changed: &Value| {
        place.write(name, changed.to_string());
        place.run(&["verify", &urdf, &world, name], "")
    };
    assert_eq!(judge("as_it_is.json", &result).code, 0);
    // Only the first sample keeps its time.
    let mut late = result.clone();
    for time in late["trajectory"]["time"].as_array_mut().unwrap().iter_mut().skip(1) {
        *time = (time.as_f64().unwrap() + 0.1).into();
    }
    judge("late.json", &late).exits(3).says(&["step 1 (cycle 1): the tip ends 35.00 mm"]);
    // All times are faster.
    let mut fast = result.clone();
    for time in fast["trajectory"]["time"].as_array_mut().unwrap() {
        *time = (time.as_f64().unwrap() * 0.9).into();
    }
    assert_eq!(judge("fast.json", &fast).code, 3);
    // The pick is outside its window.
    let narrow = read(&world);
    let narrow = narrow.replace("pick = \"bottle 1\"", "pick = \"bottle 1\"\nwindow = [2.0, 2.5]");
    place.write("narrow.toml", narrow);
    place.run(&["verify", &urdf, "narrow.toml", "as_it_is.json"], "").exits(3).says(&["outside its time window"]);
}

#[test]
fn a_pick_keeps_to_its_place_and_its_window() {
    let place = Place::new();
    let world = read(shipped("workspaces/moving/belt_pick.toml"));
    for (keys, window) in [("at = [1.3, 0.15]", [5.0, 5.0]), ("window = [3.0, 4.5]", [3.0, 3.1])] {
        place.write("world.toml", world.replace("pick = \"bottle 1\"", &format!("pick = \"bottle 1\"\n{keys}")));
        let done = place.run(&[shipped("robots/planar_2r.urdf"), "world.toml".into()], "--json");
        let time = done.json()["events"][0]["time"].as_f64().unwrap();
        assert!((window[0] - 1e-9..=window[1] + 1e-9).contains(&time), "{keys}: picked at {time} s");
    }
}

/// Returns a task that picks an object with this motion.
fn belt(object: &str, step: &str) -> String {
    format!(
        "[start]\njoints = [0.9, 1.2]\n[[object]]\nname = \"bottle\"\ncircle = {{ center = [0, 0], radius = 0.04 }}\n{object}\n\
         [[step]]\npick = \"bottle\"\n{step}\n"
    )
}

#[test]
fn picks_that_make_no_sense_are_refused_with_their_place() {
    let place = Place::new();
    let moves = "at = [1.3, -0.9]\nmotion = { velocity = [0, 0.25] }";
    for (object, step, parts) in [
        (moves, "at = [1.2, 0.1]", ["line 10, column 6", "object \"bottle\" does not pass this point"]),
        (moves, "window = [3, 2]", ["line 10, column 10", "window [3, 2] is invalid"]),
        (
            moves,
            "at = [1.3, 0.1]\nwindow = [1, 2]",
            ["line 11, column 10", "at this place at 4.000 s, outside the window"],
        ),
        ("at = [1.3, -0.9]", "window = [1, 2]", ["line 9, column 10", "object \"bottle\" does not move"]),
        (
            "at = [1.3, -0.9]\nrenew = true\nmotion = { velocity = [0, 0.25] }",
            "",
            ["line 8", "a moving object cannot be renewed"],
        ),
        (
            moves,
            "[[step]]\nplace = { at = [0.5, 1.0] }\n[[step]]\npick = \"bottle\"\nat = [1.3, 0.1]",
            ["line 14, column 6", "\"bottle\" no longer moves"],
        ),
        (
            moves,
            "[[step]]\nmove = { joints = [0, 1] }\nwindow = [1, 2]",
            ["line 12", "only a pick has `at` and `window`"],
        ),
        (
            moves,
            "[robot]\nwrist = { velocity = 6.0 }\npayload = \"level\"\n[[step]]\nplace = { at = [0.5, 1.0], angle = 1.0 }",
            ["\"bottle\" moves", "a wrist can turn objects only if all obstacles are static"],
        ),
        (
            "payload = \"level\"\nat = [1.3, -0.9]\nmotion = { stops = [{ time = 1 }, { time = 2, angle = 1 }] }",
            "",
            ["\"bottle\" moves", "held level only if no moving obstacle turns"],
        ),
    ] {
        place.plan(belt(object, step), "").refused(1, &parts);
    }
}

#[test]
fn objects_never_within_reach_are_proven_and_missed_ones_reported() {
    let place = Place::new();
    let away = belt("at = [2.3, -0.9]\nmotion = { velocity = [0, 0.25] }", "");
    let done = place.plan(away, "--certificate c.json").exits(3);
    done.says(&["\"bottle\" is not within the arm's reach"]);
    done.warns(&["no certificates for infeasible tasks"]);
    assert!(!place.path("c.json").exists());
    let done = place.plan(belt("at = [1.3, -0.9]\nmotion = { velocity = [0, 0.25] }", "window = [0, 0.3]"), "");
    assert_eq!(done.code, 4, "{}", done.stdout);
    done.says(&["has passed when the arm can arrive"]);
}
