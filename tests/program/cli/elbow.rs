//! The side of the elbow at goals, steps and lines, through the program and the checker.

use super::certificates::without_digests;
use super::*;

/// Returns the side of the elbow of `planar_2r`: that of the point between both bars, seen from joint 1 towards the tip.
fn side(q: [f64; 2]) -> &'static str {
    let ([x, y], [a, b]) = (tip(q), [q[0].cos(), q[0].sin()]);
    if x * b - y * a > 0.0 { "left" } else { "right" }
}

fn pair(value: &Value) -> [f64; 2] {
    [0, 1].map(|k| number(&value[k]))
}

/// Returns the last configuration of a result's path.
fn end(result: &Value) -> [f64; 2] {
    pair(result["path"].as_array().unwrap().last().unwrap())
}

const START: &str = "[start]\njoints = [-0.9, 0.4]\n";

/// An arc about the base that the stretched arm cannot pass, and limits of joint 1. The elbow cannot change its side.
fn ring() -> String {
    let corner = |k: i32| {
        let angle = -0.6 + f64::from(k) / 20.0;
        format!("[{:.4}, {:.4}]", 1.6 * angle.cos(), 1.6 * angle.sin())
    };
    let corners: Vec<String> = (0..54).map(corner).collect();
    format!(
        "[robot.limits]\nshoulder = [-0.1, 1.55]\n[start]\njoints = [0.1, 1.2]\n[[obstacle]]\nname = \"ring\"\n\
         polyline = [{}]\n",
        corners.join(", ")
    )
}

#[test]
fn goals_are_reached_with_the_elbow_on_the_stated_side() {
    let place = Place::new();
    let plan = |world: &str, options: &str| {
        let done = place.plan(format!("{START}{world}"), &format!("--json {options}"));
        done.exits(0).json()
    };
    let any = plan("", "--goal-tip 0.9,0.9");
    let mut lengths = Vec::new();
    for elbow in ["left", "right"] {
        let stated = plan(&format!("[goal]\ntip = [0.9, 0.9]\nelbow = \"{elbow}\"\n"), "");
        let asked = plan("", &format!("--goal-tip 0.9,0.9 --elbow {elbow}"));
        let q = end(&asked);
        assert_eq!((side(q), &stated["path"]), (elbow, &asked["path"]));
        let [x, y] = tip(q);
        assert!((x - 0.9).hypot(y - 0.9) < 1e-8, "{q:?}");
        lengths.push(number(&asked["length"]));
    }
    assert_eq!(number(&any["length"]), lengths[0].min(lengths[1]));
}

#[test]
fn mistakes_about_the_side_have_a_place_and_a_hint() {
    let place = Place::new();
    let goal = |keys: &str| place.plan(format!("{START}[goal]\n{keys}\n"), "");
    let both = "joints = [1.0, 0.2]\nelbow = \"left\"";
    let stated = "line 5, column 9: the goal has `elbow`, but its joint values already determine the side of the elbow";
    goal(both).refused(1, &[stated, "hint: remove `elbow`"]);
    goal("tip = [0.9, 0.9]\nelbow = \"up\"").refused(1, &["line 5", "\"up\" is no side of the elbow", "hint"]);
    goal("areas = [[[0.8, 0.8], [1, 1]]]\nelbow = \"left\"").refused(1, &["`areas` cannot have `elbow`", "hint"]);
    place.plan(START, "--elbow left --goal 0,0").refused(2, &["--elbow", "--goal"]);
    // The bar of the arm would hit the post with the elbow on the left.
    let post = "[[obstacle]]\nname = \"post\"\ncircle = { center = [0.09, 0.85], radius = 0.03 }\n";
    place.write("post.toml", format!("{START}{post}"));
    let blocked = place.run(&[&robot(), "post.toml"], "--goal-tip 0.9,0.9 --elbow left");
    let parts = [
        "no IK solution for the tip at (0.9, 0.9) with the elbow on the left is within the limits and free",
        "\"post\"",
        "with the elbow on the right, shoulder 0.10",
        "hint: choose the other side of the elbow; or",
    ];
    blocked.refused(1, &parts);
    let explained = place.run(&["explain", &robot(), "post.toml"], "--goal-tip 0.9,0.9 --elbow left").exits(3);
    explained.says(&["tip at (0.9, 0.9) m with the elbow on the left", "post"]);
    let limited = format!("[robot.limits]\nelbow = [0.0, 2.9]\n{START}[goal]\ntip = [0.9, 0.9]\nelbow = \"left\"\n");
    place.plan(limited, "").refused(1, &["with the elbow on the left", "\"elbow\"", "with the elbow on the right"]);

    let [gantry, maze] = [shipped("robots/gantry.urdf"), shipped("workspaces/gantry_maze.toml")];
    let refused = place.run(&[&gantry, &maze], "--goal-tip 0.5,0.5 --elbow left");
    refused.refused(1, &["only arms with two revolute joints have an elbow", "hint: leave out its side"]);
}

/// The claim of a certificate is about one side: it holds for that side, and fails for the other one or without a side.
#[test]
fn certificates_claim_one_side() {
    let place = Place::new();
    let robot = robot();
    place.write("ring.toml", ring());
    let judged = |world: &str, certificate: &Value| check(&read(&robot), world, &certificate.to_string());
    for (elbow, other, code) in [("left", "right", 3), ("right", "left", 0)] {
        let options = format!("--goal-tip 0.9,0.9 --elbow {elbow}");
        let (_, report) = place.certified(&robot, "ring.toml", &options, code);
        has(&report, &[&format!("with the elbow on the {elbow}")]);
        let certificate: Value = serde_json::from_str(&without_digests(&place.read("c.json"))).unwrap();
        assert_eq!(certificate["elbow"], elbow);
        // The same claim about a world that states the goal.
        let mut silent = certificate.clone();
        ["goal_tip", "elbow"].iter().for_each(|key| drop(silent.as_object_mut().unwrap().remove(*key)));
        let stated = |elbow: &str| ring() + &format!("[goal]\ntip = [0.9, 0.9]\nelbow = \"{elbow}\"\n");
        judged(&stated(elbow), &silent).unwrap_or_else(|why| panic!("{elbow}: {why}"));
        let wrong = judged(&stated(other), &silent).unwrap_err();
        let why = if code == 3 { "do not separate the goal" } else { "the elbow is not on the left" };
        assert!(matches!(&wrong, CheckError::Fails(reason) if reason.contains(why)), "{wrong}");
        let mut any = certificate.clone();
        any.as_object_mut().unwrap().remove("elbow");
        assert_eq!(judged(&ring(), &any).is_ok(), code == 0, "{elbow}");
    }
    // A motion that is judged later.
    let plan = |elbow: &str| format!("--goal-tip 0.9,0.9 --elbow {elbow}");
    place.run(&[&robot, "ring.toml"], &(plan("right") + " --output m.json")).exits(0);
    place.run(&["verify", &robot, "ring.toml", "m.json"], &plan("right")).exits(0);
    let wrong = place.run(&["verify", &robot, "ring.toml", "m.json"], &plan("left"));
    assert_ne!(wrong.code, 0);
    wrong.says(&["the motion ends with the elbow on the right, not on the left"]);
}

const TASK: &str = "[start]\njoints = [-0.9, 0.4]\n
[[object]]\nname = \"part\"\ncircle = { center = [0, 0], radius = 0.04 }\nat = [0.9, 0.9]\nheight = [-0.3, -0.2]\n
[[step]]\npick = \"part\"\nelbow = \"PICK\"\n[[step]]\nplace = { at = [1.2, -0.6], elbow = \"PLACE\" }\n
[[step]]\nmove = { tip = [0.5, 1.2], elbow = \"MOVE\" }\n
[[step]]\nfollow = { points = [[0.9, 0.9], [1.0, 0.7]], elbow = \"LINE\", tolerance = 1e-3 }\n";

/// Picks, places, moves and lines have their sides, which `verify` and the checker judge.
#[test]
fn steps_have_their_sides() {
    let place = Place::new();
    let robot = robot();
    let task = |sides: [&str; 4]| {
        let names = ["PICK", "PLACE", "MOVE", "LINE"];
        names.iter().zip(sides).fold(TASK.to_owned(), |text, (name, side)| text.replace(name, side))
    };
    let other = |side: &str| if side == "left" { "right" } else { "left" };
    for sides in [["left", "right", "left", "right"], ["right", "right", "left", "left"]] {
        place.write("task.toml", task(sides));
        place.run(&[&robot, "task.toml"], "--output m.json --certificate c.json").exits(0);
        let result = place.json("m.json");
        let rows = result["trajectory"]["position"].as_array().unwrap();
        let times: Vec<f64> = result["trajectory"]["time"].as_array().unwrap().iter().map(number).collect();
        let steps = result["steps"].as_array().unwrap();
        let at = |time: f64| rows[times.iter().position(|t| (t - time).abs() < 1e-9).unwrap()].clone();
        let ends: Vec<&str> = [0, 1, 2, 3, 4].map(|k| side(pair(&at(number(&steps[k]["arrival"]))))).to_vec();
        assert_eq!(ends, [sides[0], sides[1], sides[2], sides[3], sides[3]]);
        let along = rows.iter().zip(&times).filter(|(_, time)| **time >= number(&steps[4]["begin"]) - 1e-9);
        assert!(along.map(|(q, _)| side(pair(q))).all(|side| side == sides[3]));

        let certificate = without_digests(&place.read("c.json"));
        let judged = |world: &str| check(&read(&robot), world, &certificate);
        judged(&task(sides)).unwrap_or_else(|why| panic!("{sides:?}: {why}"));
        place.run(&["verify", &robot, "task.toml", "m.json"], "").exits(0);
        for k in 0..4 {
            let mut changed = sides;
            changed[k] = other(sides[k]);
            let wrong = judged(&task(changed)).unwrap_err().to_string();
            assert!(wrong.contains("the elbow"), "{k}: {wrong}");
            place.write("other.toml", task(changed));
            let verified = place.run(&["verify", &robot, "other.toml", "m.json"], "");
            assert_ne!(verified.code, 0, "{k}");
            verified.says(&[&format!("the elbow is on the {}, not on the {}", sides[k], changed[k])]);
        }
    }
    place.write("task.toml", task(["left", "up", "left", "left"]));
    place.run(&[&robot, "task.toml"], "").refused(1, &["\"up\" is no side of the elbow", "line 14"]);
    let beside = task(["left"; 4]).replace("[[step]]\nplace", "[[step]]\nelbow = \"left\"\nplace");
    place.write("task.toml", beside);
    place.run(&[&robot, "task.toml"], "").refused(1, &["only a pick has `elbow` beside it", "hint"]);
    let limited = task(["left"; 4]).replace("[start]", "[robot.limits]\nelbow = [0.0, 2.9]\n[start]");
    place.write("task.toml", limited);
    place.run(&[&robot, "task.toml"], "").warns(&["step 1", "with the elbow on the left is within the joint limits"]);
}

/// Lines are followed on one side, and proofs exclude that side alone.
#[test]
fn lines_are_followed_on_one_side() {
    let place = Place::new();
    let robot = robot();
    place.write("line.toml", "points = [[0.9, 0.9], [1.0, 0.7], [1.1, 0.75]]\ntolerance = 1e-3\n");
    place.write("free.toml", START);
    let judged = |world: &str, certificate: &Value| check(&read(&robot), world, &certificate.to_string());
    let follow = |world: &str, options: &str, code: i32| {
        let files = ["follow", &robot, world, "line.toml"];
        let done = place.run(&files, &format!("--json --certificate c.json {options}")).exits(code);
        (done.json(), serde_json::from_str::<Value>(&without_digests(&place.read("c.json"))).unwrap())
    };
    for elbow in ["left", "right"] {
        let (result, certificate) = follow("free.toml", &format!("--elbow {elbow}"), 0);
        let rows = result["trajectory"]["position"].as_array().unwrap();
        assert!(rows.iter().all(|q| side(pair(q)) == elbow));
        let report = judged(START, &certificate).unwrap_or_else(|why| panic!("{elbow}: {why}"));
        has(&report, &[&format!("with the elbow on the {elbow}")]);
        let mut wrong = certificate.clone();
        wrong["line"]["elbow"] = if elbow == "left" { "right".into() } else { "left".into() };
        let wrong = judged(START, &wrong).unwrap_err().to_string();
        assert!(wrong.contains("the elbow does not stay on"), "{wrong}");
    }
    // A post that only the arm with its elbow on the left meets.
    let post = format!("{START}[[obstacle]]\nname = \"post\"\ncircle = {{ center = [0.09, 0.85], radius = 0.03 }}\n");
    place.write("post.toml", &post);
    follow("post.toml", "", 0);
    let (result, certificate) = follow("post.toml", "--elbow left", 3);
    assert!(result["excluded"].as_array().unwrap().iter().all(|excluded| excluded["solution"] == 2), "{result}");
    judged(&post, &certificate).unwrap();
    for elbow in [Value::Null, "right".into()] {
        let mut wrong = certificate.clone();
        match elbow {
            Value::Null => drop(wrong["line"].as_object_mut().unwrap().remove("elbow")),
            elbow => wrong["line"]["elbow"] = elbow,
        }
        assert!(matches!(judged(&post, &wrong), Err(CheckError::Fails(_))));
    }
    let gantry = [shipped("robots/gantry.urdf"), shipped("workspaces/gantry_maze.toml")];
    let done = place.run(&["follow", &gantry[0], &gantry[1], "line.toml"], "--elbow left");
    assert_eq!(done.code, 1);
    done.warns(&["line.toml: only arms with two revolute joints have an elbow"]);
}
