//! Certificates of tasks, and the verdict of the checker, which shares no code with the program.

use super::certificates::without_digests;
use super::*;

/// Returns shipped tasks with this expected outcome by name, and their robots.
fn tasks(expected: &str) -> Vec<(String, String)> {
    let folder = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("workspaces/tasks")).unwrap();
    let mut found = Vec::new();
    for path in folder.map(|entry| entry.unwrap().path()) {
        let text = read(&path);
        let robot = text.lines().find_map(|line| line.strip_prefix("# robot: ")).unwrap();
        if text.contains(&format!("# expect: {expected}")) {
            found.push((path.display().to_string(), shipped(&format!("robots/{robot}.urdf"))));
        }
    }
    found.sort();
    found
}

fn with_change(certificate: &Value, alter: impl FnOnce(&mut Value)) -> String {
    let mut whole = certificate.clone();
    alter(&mut whole);
    whole.to_string()
}

/// Changes the value of the first joint in some knots of the motion.
fn moved(certificate: &mut Value, knots: std::ops::RangeInclusive<usize>, to: impl Fn(f64) -> f64) {
    for knot in &mut certificate["motion"]["knots"].as_array_mut().unwrap()[knots] {
        knot[1] = json!(to(knot[1].as_f64().unwrap()));
    }
}

#[test]
fn every_feasible_shipped_task_has_a_valid_certificate() {
    let tasks = tasks("done");
    assert!(tasks.len() >= 11, "{tasks:?}");
    for (world, robot) in tasks {
        let place = Place::new();
        place.run(&[&robot, &world], "--quiet --certificate c.json --output plan.json").exits(0);
        let (urdf, text, certificate) = (read(&robot), read(&world), place.read("c.json"));
        let [whole, plan] = ["c.json", "plan.json"].map(|file| place.json(file));
        let report = check(&urdf, &text, &certificate).unwrap_or_else(|why| panic!("{world}: {why}"));
        let steps = plan["steps"].as_array().unwrap();
        has(&report, &[&format!("does all {} steps", steps.len()), "within 1e-"]);
        let fails = |world: &str, what: &str, certificate: &str| {
            let judged = check(&urdf, world, certificate);
            assert!(matches!(judged, Err(CheckError::Fails(_))), "{what}, {world}: {judged:?}");
        };
        // At the end of the first step the arm stands still, and an object is picked there.
        let first = &steps[0];
        assert!(["pick", "move"].contains(&first["action"].as_str().unwrap()));
        let last = first["last_sample"].as_u64().unwrap() as usize;
        let rest = last..=steps[1]["first_sample"].as_u64().unwrap() as usize;
        fails(&text, "a step is missing", &with_change(&whole, |c| drop(c["steps"].as_array_mut().unwrap().pop())));
        let swapped = with_change(&whole, |c| {
            let steps = c["steps"].as_array_mut().unwrap();
            let other = if steps.len() > 2 { 2 } else { 1 };
            (steps[0]["step"], steps[other]["step"]) = (steps[other]["step"].clone(), steps[0]["step"].clone());
        });
        fails(&text, "steps are swapped", &swapped);
        // Without a rest, the next step begins at the same knot.
        if rest.start() < rest.end() {
            fails(&text, "the arm does not stand", &with_change(&whole, |c| moved(c, last..=last, |q| q + 1e-9)));
        }
        fails(&text, "it ends elsewhere", &with_change(&whole, |c| moved(c, rest.clone(), |q| q + 1e-3)));
        if !plan["clearance"].is_null() {
            fails(&text, "it is nearer", &with_change(&whole, |c| c["clearance"] = json!(100.0)));
        }
        if !text.contains("wrist = ") {
            fails(&text, "there is no wrist", &with_change(&whole, |c| c["steps"][1]["turn"] = json!(3.0)));
        }
        // All values change by a unit in the last place, as with another compiler.
        let shifted = with_change(&whole, |c| {
            let all = 0..=c["motion"]["knots"].as_array().unwrap().len() - 1;
            moved(c, all, f64::next_up);
        });
        check(&urdf, &text, &shifted).unwrap_or_else(|why| panic!("{world}, by a unit: {why}"));
        // A post stands where the first object is picked.
        let grasp = plan["events"].as_array().unwrap()[0]["tip"].clone();
        let post = format!("{text}\n[[obstacle]]\ncircle = {{ center = {grasp}, radius = 0.01 }}\n");
        let anywhere = without_digests(&certificate);
        check(&urdf, &text, &anywhere).unwrap_or_else(|why| panic!("{world}: {why}"));
        fails(&post, "something is in the way", &anywhere);
        let more = format!("{text}\n[[step]]\nmove = {{ tip = [0.0, 0.0] }}\n");
        assert!(check(&urdf, &more, &anywhere).is_err(), "{world}: a step is left over");
    }
}

/// The warning that is printed for an infeasible task.
const NONE: &str = "is not written: there are no certificates for infeasible tasks";

/// Checks that, except for the warning, all output is the same as without `--certificate`.
#[test]
fn infeasible_tasks_have_no_certificate() {
    let tasks = tasks("infeasible");
    assert!(tasks.len() >= 2, "{tasks:?}");
    for (world, robot) in tasks {
        let place = Place::new();
        let run = |options: &str| place.run(&[&robot, &world], options);
        let without = run("--output without.json");
        let beside = run("--output beside.json --certificate c.json");
        let within = run("--output within.json --certificate within.json");
        assert_eq!([without.code, beside.code, within.code], [3; 3], "{world}: {}", beside.stderr);
        assert!(!place.path("c.json").exists(), "{world}");
        for (done, file) in [(&beside, "c.json"), (&within, "the certificate in within.json")] {
            let warnings: Vec<&str> = done.stderr.lines().filter(|line| line.starts_with("warning: ")).collect();
            let [warning] = warnings[..] else { panic!("{world}: {}", done.stderr) };
            assert!(warning.starts_with(&format!("warning: {file} {NONE}")), "{world}: {warning}");
        }
        let [without, beside, within] = ["without.json", "beside.json", "within.json"].map(|file| place.read(file));
        assert!(without == beside && without == within, "{world}");
    }
}

/// Plans a task for the robot of this URDF. Checks the exit code, and that exactly an infeasible task has no certificate.
/// Returns the checker's report on it.
#[track_caller]
fn planned(urdf: &str, world: &str, code: i32) -> String {
    let place = Place::new().with("arm.urdf", urdf).with("world.toml", world);
    let done = place.run(&["arm.urdf", "world.toml"], "--quiet --certificate c.json").exits(code);
    let is_written = place.path("c.json").exists();
    assert_eq!((is_written, done.stderr.contains(NONE)), (code == 0, code == 3), "{}", done.stderr);
    let report = |text: &str| check(urdf, world, text).unwrap_or_else(|why| panic!("{why}\n{text}"));
    if is_written { report(&place.read("c.json")) } else { Default::default() }
}

/// Plans a task for the shipped SCARA.
#[track_caller]
fn scara(world: &str, code: i32) -> String {
    planned(&read(shipped("robots/scara.urdf")), world, code)
}

/// Checks that a group with infeasible pairs is infeasible in all orders.
#[test]
fn proofs_are_about_all_orders() {
    let rigid = read(shipped("workspaces/tasks/slot_rigid.toml"));
    let free = rigid.replace("[start]", "[task]\norder = \"free\"\n\n[start]");
    let pin = |number: usize| {
        let y = -0.1 + 0.05 * number as f64;
        let object = format!(
            "[[object]]\nname = \"pin {number}\"\ncircle = {{ center = [0.0, 0.0], radius = 0.005 }}\nat = [0.45, {y}]\nheight = [0.04, 0.06]\n"
        );
        object + &format!("[[step]]\npick = \"pin {number}\"\n[[step]]\nplace = {{ at = [0.4, {y}] }}\n")
    };
    for count in [0, 2, 5] {
        scara(&(free.clone() + &(0..count).map(pin).collect::<String>()), 3);
    }
    // Two objects that exchange places block each other. A third one that blocks neither changes nothing.
    let swap = read(shipped("workspaces/tasks/swap.toml"));
    for count in [0, 1] {
        scara(&(swap.clone() + &(0..count).map(pin).collect::<String>()), 3);
    }
    scara(&swap.replacen("place = { at = [0.26, 0.20] }", "place = { at = [0.26, 0.30] }", 1), 0);
}

/// Checks a stub that the tool would hit while it is lowered, although nothing blocks the arm above.
#[test]
fn proofs_are_about_strokes() {
    let world = |robot: &str, stub: [f64; 2]| {
        format!(
            r#"[robot]
joints = ["axis_1", "axis_2"]
tip = "flange"
payload = "level"
{robot}
[start]
joints = [0.0, 1.2]
[[obstacle]]
name = "stub"
circle = {{ center = {stub:?}, radius = 0.003 }}
height = [0.0, 0.1]
[[object]]
name = "part"
polygon = [[-0.012, -0.006], [0.012, -0.006], [0.012, 0.006], [-0.012, 0.006]]
at = [0.14, 0.36]
height = [0.0, 0.01]
lift = 0.12
[[step]]
pick = "part"
[[step]]
place = {{ at = [0.35, -0.17] }}
"#
        )
    };
    let stroke = "stroke = { joint = \"axis_3\", velocity = 1.0, acceleration = 5.0 }";
    // The stub is beside the pick, beside the target, or where only the payload is lowered onto it. There is a stroke
    // or none.
    for (stub, without) in [([0.14, 0.375], 0), ([0.35, -0.155], 0), ([0.336, -0.17], 3)] {
        scara(&world("", stub), without);
        scara(&world(stroke, stub), 3);
    }
}

/// Checks a bar that replaces the tool's meshes: it ends at the tip, and is lowered with it.
#[test]
fn bars_are_lowered_with_the_tool() {
    let robot = read(shipped("robots/scara.urdf"));
    let meshes = [("0.01\" length=\"0.22", "quill"), ("0.02\" length=\"0.01", "flange")];
    let without = meshes.iter().fold(robot, |urdf, (size, name)| {
        let tool = format!("<cylinder radius=\"{size}\"/>");
        assert!(urdf.contains(&tool), "{tool}");
        urdf.replace(&tool, &format!("<mesh filename=\"{name}.stl\"/>"))
    });
    for (height, code) in [("[0.0, 0.1]", 3), ("[-0.2, -0.1]", 0)] {
        let world = format!(
            r#"[robot]
joints = ["axis_1", "axis_2"]
tip = "flange"
bar = 0.03
stroke = {{ joint = "axis_3", travel = 0.15 }}
[start]
joints = [0.0, 0.7]
[[obstacle]]
name = "wall"
polygon = [[0.41, 0.21], [0.5, 0.21], [0.5, 0.26], [0.41, 0.26]]
height = {height}
[[object]]
name = "part"
circle = {{ center = [0.0, 0.0], radius = 0.002 }}
at = [0.4, 0.22]
height = [0.0, 0.001]
lift = 0.15
[[step]]
pick = "part"
"#
        );
        planned(&without, &world, code);
    }
}

/// Checks an object that is placed into its support: as deep as it may press, and deeper. The object is convex, or has
/// several parts.
#[test]
fn objects_that_press_into_supports_have_certificates() {
    let into = |depth: f64| {
        read(shipped("workspaces/tasks/slot_rigid.toml"))
            .replace("payload = \"rigid\"", "payload = \"level\"")
            .replace("at = [0.26, 0.35]", &format!("at = [0.26, {}], supports = [\"near jaw\"]", 0.345 - depth))
    };
    // Its corners may press 5.5e-5 m into the support, and its sides 0.7 of that.
    scara(&into(2e-5), 0);
    let square = "[[-0.06, -0.01], [0.06, -0.01], [0.06, 0.01], [-0.06, 0.01]]";
    let bent = "[[-0.06, -0.01], [0.06, -0.01], [0.06, 0.01], [0.0, 0.01], [0.0, 0.012], [-0.06, 0.012]]";
    for depth in [2e-4, 1e-2] {
        scara(&into(depth), 3);
        scara(&into(depth).replace(square, bent), 3);
    }
    let beside = into(0.0).replace("at = [0.26, 0.345]", "at = [0.30, -0.21]").replace(square, bent);
    has(&scara(&beside, 0), &["does all"]);
}

/// Checks rings around pegs. They have convex pieces, some of whose sides extend sides of the hole.
#[test]
fn rings_on_pegs_have_certificates() {
    let square = |x: f64, y: f64, half: f64| {
        let ([left, right], [low, high]) = ([x - half, x + half], [y - half, y + half]);
        format!("[[{left}, {low}], [{right}, {low}], [{right}, {high}], [{left}, {high}]]")
    };
    let stepped = format!(
        "[[[-0.1, -0.1], [0.1, -0.1], [0.1, 0.04], [0.13, 0.04], [0.13, 0.1], [-0.1, 0.1]], {}]",
        square(0.0, 0.0, 0.04)
    );
    let wedged = "[[[-0.1, -0.1], [0.1, -0.1], [0.1, -0.0346], [0.15000000000000002, -0.0346], [0.15000000000000002, 0.0278], [0.13, 0.0278], [0.13, 0.1], [0.0447, 0.1], [0.0447, 0.13], [-0.0438, 0.13], [-0.0438, 0.07], [-0.1, 0.07]], [[-0.0438, -0.0346], [0.0447, -0.0346], [-0.0438, 0.0278]]]";
    let wedge = "[[0.9559263156877668, 0.7651263156877668], [1.045563099894364, 0.7651263156877668], [0.9559263156877668, 0.8283278448910624]]";
    // The allowance is 1.6e-4 m, and 0.7 of that for sides beside right angles.
    let on_a_peg = |grown: f64| (stepped.clone(), square(1.0, 0.8, 0.04 + grown));
    for ((ring, peg), code) in
        [(on_a_peg(1e-6), 0), (on_a_peg(1.1e-4), 0), (on_a_peg(2e-4), 3), ((wedged.to_owned(), wedge.to_owned()), 3)]
    {
        let world = format!(
            "[start]\njoints = [0.5, 0.4]\n[[obstacle]]\nname = \"peg\"\npolygon = {peg}\nheight = [0, 0.01]\n\
             [[object]]\nname = \"ring\"\npolygon = {ring}\nat = [1.0, 0.8]\nheight = [0, 0.01]\nsupports = [\"peg\"]\n\
             [[step]]\npick = \"ring\"\n[[step]]\nplace = {{ at = [1.0, 0.8] }}\n"
        );
        let report = planned(&read(shipped("robots/gantry.urdf")), &world, code);
        assert_eq!(report.contains("does all 2 steps"), code == 0, "{peg}: {report}");
    }
}

/// Checks that a released object may be touched, but that the new object which replaces it may not.
#[test]
fn a_new_object_is_an_obstacle() {
    let walls = |low: f64, high: f64| {
        format!(
            "[[obstacle]]\nname = \"walls\"\npolygon = [[0.8, {low}], [1.2, {low}], [1.2, {high}], [0.8, {high}]]\nheight = [0, 0.1]\n"
        )
    };
    let object = |name: &str, radius: f64, x: f64, more: &str| {
        format!(
            "[[object]]\nname = \"{name}\"\ncircle = {{ center = [0, 0], radius = {radius} }}\nat = [{x}, 0.75]\nheight = [0, 0.1]\n{more}"
        )
    };
    let world = [
        "start.joints = [0.3, 0.6]\n".to_owned(),
        walls(0.0, 0.64),
        walls(0.86, 1.7),
        object("a", 0.06, 1.0, "renew = true\n"),
        object("b", 0.03, 0.3, ""),
        "[[step]]\nrepeat = 2\n[[step.steps]]\npick = \"b\"\n[[step.steps]]\nplace = { at = [0.3, 0.5] }\n".into(),
        "[[step.steps]]\npick = \"a\"\n[[step.steps]]\nplace = { at = [1.7, 0.75] }\n".into(),
    ]
    .concat();
    let urdf = read(shipped("robots/gantry.urdf"));
    // Between the walls, the only path leads through the new object. If the object is not renewed, there is a path.
    planned(&urdf, &world, 3);
    planned(&urdf, &world.replace("renew = true\n", ""), 0);
}

/// Checks that a released object may be touched until the next step has ended. After that step, the arm must be free of
/// it. This also holds if a new object replaces the released one from then on, and if an obstacle moves.
#[test]
fn renewed_objects_stay_until_the_next_motion() {
    let place = Place::new();
    let urdf = shipped("robots/gantry.urdf");
    let moving = "[[obstacle]]\ncircle = { center = [5, 5], radius = 0.1 }\nmotion = { velocity = [1, 0] }\n";
    for among in ["", moving] {
        let world = |high: f64, x: f64| {
            format!(
                "{among}[start]\njoints = [0.9, 0.9]\n[[object]]\nname = \"p\"\ncircle = {{ center = [0, 0], radius = 0.02 }}\n\
                 at = [0.3, 0.3]\nheight = [0, {high}]\nrenew = true\n[[step]]\nrepeat = 2\n[[step.steps]]\npick = \"p\"\n\
                 [[step.steps]]\nplace = {{ at = [1.5, 0.8] }}\n[[step.steps]]\nmove = {{ joints = [{x}, 0.81] }}\ndwell = 1\n"
            )
        };
        // The move ends on the object, beside it, or high above it.
        let asked = [(0.1, 1.5, 3), (0.1, 1.3, 0), (0.01, 1.5, 0)];
        for (number, (high, x, code)) in asked.into_iter().enumerate() {
            place.write("world.toml", world(high, x));
            let options = format!("--quiet --certificate c{number}.json --output plan{number}.json");
            place.run(&[&urdf, "world.toml"], &options).exits(code);
            if code == 0 {
                let report = check(&read(&urdf), &world(high, x), &place.read(&format!("c{number}.json"))).unwrap();
                assert!(report.contains("does all 6 steps"), "{report}");
            }
        }
        // The motion high above the object does not touch it.
        let verified =
            |number: usize| place.run(&["verify", &urdf, "world.toml", &format!("plan{number}.json")], "--quiet").code;
        assert_eq!(verified(2), 0);
        place.write("world.toml", world(0.1, 1.5));
        assert_eq!(verified(2), 3);
    }
}

/// Checks an IK solution at half a turn of a continuous joint, which is blocked on both sides of that value.
#[test]
fn boxes_reach_across_half_a_turn() {
    let urdf = read(shipped("robots/planar_2r_continuous.urdf"));
    let block =
        |x: f64, y: f64, radius: f64| format!("[[obstacle]]\ncircle = {{ center = [{x}, {y}], radius = {radius} }}\n");
    let pick = "[[object]]\nname = \"p\"\ncircle = { center = [0, 0], radius = 0.02 }\nat = [-1.48, -0.64]\n[[step]]\npick = \"p\"\n";
    let task = ["[start]\njoints = [1.0, 0.5]\n", &block(-0.5, 0.1, 0.08), &block(-0.5, -0.6, 0.3), pick].concat();
    let motion =
        "[robot]\nlimits = { elbow = [-6.3, 6.3] }\n[start]\njoints = [2.4, 0.8]\n[goal]\ntip = [-1.48, -0.64]\n";
    for (world, code) in [(task, 3), (motion.to_owned() + &block(-1.0, 0.15, 0.11), 0)] {
        let report = planned(&urdf, &world, code);
        assert_eq!(report.contains("is shorter than"), code == 0, "{report}");
    }
}

/// Checks a piece of an obstacle whose area is due only to rounding. It arises where a hole touches a side between its
/// corners, in decimal numbers.
#[test]
fn slivers_are_no_evidence() {
    let urdf = read(shipped("robots/gantry.urdf"));
    let world = "[start]\njoints = [0.1, 0.1]\n[[obstacle]]\npolygon = [[[1.41558807525, 1.1732870148], [1.45402146287, 1.16220212798], \
                 [1.5, 1.2006]], [[1.43480476906, 1.16774457139], [1.45, 1.18], [1.45, 1.17]]]\n[[object]]\nname = \"disc\"\n\
                 at = [1.4, 0.98]\ncircle = { center = [0.0, 0.0], radius = 0.1 }\n[[step]]\npick = \"disc\"\n";
    planned(&urdf, world, 3);
}

/// Checks a crane that turns a thin object of 100 m. Its orientation is as exact as the joint values, however large the
/// crane is.
#[test]
fn needles_on_cranes_are_in_the_way() {
    let link = "<link name=\"boom\"><collision><origin xyz=\"300 0 20\"/><geometry><box size=\"600 1 1\"/></geometry></collision></link>";
    let joint = |name: &str, kind: &str, [parent, child]: [&str; 2], axis: &str, limit: f64| {
        format!(
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/><axis xyz=\"{axis}\"/>\
             <limit lower=\"-{limit}\" upper=\"{limit}\" effort=\"1\" velocity=\"1\"/></joint>"
        )
    };
    let joints = joint("slide", "prismatic", ["rail", "trolley"], "1 0 0", 1000.0)
        + &joint("turn", "revolute", ["trolley", "boom"], "0 0 1", 2.9)
        + "<joint name=\"mount\" type=\"fixed\"><parent link=\"boom\"/><child link=\"hook\"/><origin xyz=\"600 0 0\"/></joint>";
    let links = format!("<link name=\"rail\"/><link name=\"trolley\"/>{link}<link name=\"hook\"/>");
    let urdf = format!("<robot name=\"crane\">{links}{joints}</robot>");
    let world = "robot = { payload = \"rigid\" }\nstart = { joints = [-800.0, 0.5] }\n[[obstacle]]\n\
                 polyline = [[-13.0, -303.0], [-110.0, -220.0], [-160.0, -300.0], [-13.0, -300.0]]\nheight = [0, 10]\n\
                 [[object]]\nname = \"needle\"\npolygon = [[-50.0, 1.0], [50.0, 0.0], [-50.0, -1.0]]\nat = [230.0, 240.0]\n\
                 height = [0, 1]\n[[step]]\npick = \"needle\"\n[[step]]\nplace = { at = [-86.5, -290.0] }\n";
    planned(&urdf, world, 3);
}

#[test]
fn overrides_of_the_world_are_in_the_certificate() {
    let place = Place::new();
    let files = [shipped("robots/rrbot_vertical.urdf"), shipped("workspaces/tasks/tower.toml")];
    let options = "--quiet --certificate c.json --output plan.json --start 0.5,40deg --clearance 0.0005";
    place.run(&files, options).exits(0);
    let judged = |certificate: &str| check(&read(&files[0]), &read(&files[1]), certificate);
    let report = judged(&place.read("c.json")).unwrap();
    has(&report, &["start (0.5, 0.69813170079773", "with clearance 0.0005 (", "read as cubic or quartic"]);
    // A recording of the motion by another program is refused, too.
    let verify = ["verify", &files[0], &files[1], "plan.json"];
    let options = "--quiet --certificate v.json --start 0.5,40deg --clearance 0.0005";
    place.run(&verify, options).exits(0);
    let report = judged(&place.read("v.json")).unwrap();
    has(&report, &["does all 5 steps", "read as quartic"]);
    // Uses one of its motions, with all objects at their initial places.
    place.write("rise.csv", "shoulder,elbow\n0.6,0.8\n0.5,0.8\n");
    place.run(&["verify", &files[0], &files[1], "rise.csv"], "--quiet --certificate r.json").exits(0);
    let report = judged(&place.read("r.json")).unwrap();
    assert!(report.contains("to the goal (0.5, 0.8)"), "{report}");
}

/// Checks certificates of tasks in those respects in which they are like those of motions: they have digests, can be
/// part of the result, and have joint values slightly inside the limits.
#[test]
fn certificates_of_tasks_are_bound_to_their_files_and_can_be_a_part_of_the_result() {
    let place = Place::new();
    let robot = shipped("robots/planar_2r.urdf");
    let world = "[robot.limits]\nshoulder = [\"-100deg\", \"100deg\"]\nelbow = [-2.5, 2.5]\n\
                 [start]\njoints = [\"-100deg\", 0.5]\n[[step]]\nmove = { joints = [0.1, 2.5] }\n\
                 [[step]]\nmove = { joints = [\"100deg\", 0.5] }\n\
                 [[obstacle]]\ncircle = { center = [9, 9], radius = 0.1 }\n";
    place.run_in(&robot, world, "--quiet --certificate r.json --output r.json").exits(0);
    place.run(&["verify", &robot, "world.toml", "r.json"], "--quiet --certificate v.json").exits(0);
    let judged = |file: &str| check_files(robot.as_ref(), &place.path("world.toml"), &place.path(file));
    for file in ["r.json", "v.json"] {
        assert!(judged(file).unwrap().contains("does all 2 steps"), "{file}");
    }
    place.write("world.toml", format!("{world}\n"));
    for file in ["r.json", "v.json"] {
        assert!(matches!(judged(file), Err(CheckError::Fails(why)) if why.contains("another world")), "{file}");
    }
}
