//! Certificates of motions, written by hand, and falsified ones.

use crate::common::robots::bars;
use crate::common::verdict::{Verdict, agrees, fails, fails_with, found, holds, judge, refused};
use cplan_check_files::{CheckError, Input, check};

/// Returns a robot of two bars. Its base has a mesh that nobody can read.
fn robot(first: &str, second: &str) -> String {
    let mesh = r#"<link name="base"> <visual> <geometry> <mesh filename="m"/> </geometry> </visual> </link>"#;
    bars(first, second).replace(r#"<link name="base"/>"#, mesh)
}

const ENDS: &str = "start.joints = [-1, 0]\ngoal.joints = [1, 0]\n";

fn arm() -> String {
    robot("revolute", "revolute")
}

fn world(obstacles: &str) -> String {
    format!("{ENDS}{obstacles}")
}

const LINEAR: &str = r#""linear""#;

/// Checks a straight motion from the start to the goal among obstacles.
fn judge_straight_motion(urdf: &str, obstacles: &str) -> Verdict {
    judge(urdf, &world(obstacles), &found("", LINEAR, "[0, -1, 0], [1, 1, 0]"))
}

/// Asserts that the straight motion among obstacles is free, or fails with a message that has this part.
#[track_caller]
fn passes(obstacles: &str, is_free: bool, part: &str) {
    agrees(judge_straight_motion(&arm(), obstacles), is_free, part);
}

/// Tests distances in closed form. Both bars turn about the origin together, up to 1.8 m and sqrt(1.8^2 + 0.05^2) at
/// the corners.
#[test]
fn distances_agree_with_the_closed_form() {
    let reach = (1.8f64 * 1.8 + 0.05 * 0.05).sqrt();
    for (gap, is_free) in [(1e-3, true), (1e-6, true), (1e-9, true), (-1e-9, false), (-0.1, false)] {
        let post = format!("[[obstacle]]\ncircle = {{ center = [{}, 0], radius = 0.5 }}\n", reach + 0.5 + gap);
        passes(&post, is_free, "link \"fore\", collision 0");
        // Beyond the reach, the wall is straight, and only its middle is near.
        let wall = reach + gap;
        passes(&format!("[[obstacle]]\npolyline = [[{wall}, -3], [{wall}, 3]]\n"), is_free, "obstacle 0");
    }
    // A corner that the long side reaches just where the arm stops turning.
    for (gap, is_free) in [(1e-3, true), (1e-9, true), (-1e-9, false)] {
        let (sine, cosine) = 1f64.sin_cos();
        let at = |along: f64, beside: f64| [along * cosine - beside * sine, along * sine + beside * cosine];
        let [x, y] = at(1.5, 0.05 + gap);
        let [u, v] = at(1.7, 0.4);
        let [s, t] = at(1.2, 0.4);
        let block = format!("[[obstacle]]\npolygon = [[{x}, {y}], [{u}, {v}], [{s}, {t}]]\n");
        passes(&block, is_free, "link \"fore\"");
    }
}

#[test]
fn clearance_counts_and_other_queries_are_described() {
    let post = "[[obstacle]]\ncircle = { center = [2.2, 0], radius = 0.1 }\n";
    let at = |extra: &str| judge(&arm(), &world(post), &found(extra, LINEAR, "[0, -1, 0], [1, 1, 0]"));
    assert_eq!(at("").0, 0);
    // 2.1 - sqrt(1.8^2 + 0.05^2) = 0.299305...
    assert_eq!(at(r#""clearance": 0.2993,"#).0, 0);
    fails(at(r#""clearance": 0.2994,"#), "farther than 0.2994 from obstacle 0");
    let place = format!("clearance = 0.2994\n{}", world(post));
    assert_eq!(judge(&arm(), &place, &found("", LINEAR, "[0, -1, 0], [1, 1, 0]")).0, 3);
    let (_, report) = at(r#""clearance": 0.25, "start": [-1.0, 0.0], "goal": [1, 5e-10],"#);
    for part in
        ["start (-1, 0) to", "goal (1, 0.0000000005), within 1e-9,", "clearance 0.25", "2 knots, read as linear"]
    {
        assert!(report.contains(part), "{report}");
    }
    fails(at(r#""goal": [1, 0.00002],"#), "misses the goal by more than 1e-5");
    fails(at(r#""start": [1, 0],"#), "misses the start");
}

/// Moves one knot of a motion. The message must name the problem.
#[test]
fn falsified_parts_are_named() {
    // Beside the stretched arm, and on the path of the folded arm.
    let post = "[[obstacle]]\ncircle = { center = [0.7, 0.8], radius = 0.15 }\n";
    let judged = |knots: &str| judge(&arm(), &world(post), &found("", LINEAR, knots));
    let fold = "[0, -1, 0], [1, -1, 2.5], [2, 1, 2.5], [3, 1, 0]";
    fails_with(judged(fold), &["after knot 1, link \"fore\"", "obstacle 0"]);
    let post = "[[obstacle]]\ncircle = { center = [1.4, 0], radius = 0.15 }\n";
    let judged = |knots: &str| judge(&arm(), &world(post), &found("", LINEAR, knots));
    assert_eq!(judged(fold).0, 0);
    for (knots, part) in [
        ("[0, -1, 0], [3, 1, 0]", "after knot 0, link"),
        ("[0, -1, 0], [1, -1, 1], [3, 1, 0]", "after knot 1, link"),
        ("[0, -1, 0], [1, -0.2, 2.5], [2, 1, 2.5], [3, 1, 0]", "after knot 0, link"),
        ("[0, -1, 0], [1, -1, 2.5], [2, 1, 2.5], [3, 1, 0.1]", "goal"),
        ("[0, -1.1, 0], [1, -1, 2.5], [2, 1, 2.5], [3, 1, 0]", "start"),
        ("[0, -1, 0], [1, -1, 2.5], [1, 1, 2.5], [3, 1, 0]", "time of knot 2 is not after"),
        ("[0, -1, 0], [1, -1, 2.91], [2, 1, 2.5], [3, 1, 0]", "after knot 0 (linear) joint \"b\" leaves its limits"),
        ("[0, -1, 0], [1, -1, 2.9000000000000000000000000000000000001], [2, 1, 2.5], [3, 1, 0]", "limits"),
        ("[0, -1, 0], [1, 1e300, 2.5], [3, 1, 0]", "limits"),
    ] {
        fails(judged(knots), part);
    }
    // At the limit itself, and with very long durations.
    assert_eq!(judged("[-1e9, -1, 0], [1, -1, 2.90], [2, 1, 2.9], [3e9, 1, 0]").0, 0);
}

/// Tests that lengths with units are exact, and that other units are refused.
#[test]
fn lengths_with_units_are_exact() {
    for (center, is_free) in [("\"2400.001 mm\"", true), ("\"240.01cm\"", true), ("\"2300mm\"", false), ("2.3", false)]
    {
        passes(
            &format!("[[obstacle]]\ncircle = {{ center = [{center}, 0], radius = \"5 dm\" }}\n"),
            is_free,
            "obstacle 0",
        );
    }
    let foot = "[[obstacle]]\ncircle = { center = [\"9 foot\", 0], radius = 1 }\n";
    refused(judge_straight_motion(&arm(), foot), "a length such as \"20 mm\"");
}

/// Tests an arm inside an obstacle. It does not touch the obstacle's sides, but collides.
#[test]
fn an_arm_inside_an_obstacle_collides() {
    let ring = "polygon = [[-9, -9], [9, -9], [9, 9], [-9, 9]]\n";
    passes(&format!("[[obstacle]]\n{ring}"), false, "link \"upper\", collision 0 is inside obstacle 0");
    // In its hole the arm is free.
    passes(&format!("[[obstacle]]\n{ring}holes = [[[-3, -3], [3, -3], [3, 3], [-3, 3]]]\n"), true, "");
    passes(&format!("[[obstacle]]\n{ring}holes = [[[-3, -3], [1, -3], [1, 3], [-3, 3]]]\n"), false, "obstacle 0");
    let turned = format!(
        "[[obstacle]]\nat = [0.1, 0.2]\nangle = \"30deg\"\n{ring}holes = [[[-3, -3], [3, -3], [3, 3], [-3, 3]]]\n"
    );
    passes(&turned, true, "");
    // A disc around the whole arm, and one that contains only the second bar.
    passes("[[obstacle]]\ncircle = { center = [0, 0], radius = 9 }\n", false, "after knot 0, link");
    let second = "[[obstacle]]\npolyline = [[1.2, 0], [1.3, 0]]\n";
    passes(&format!("[[obstacle]]\ncircle = {{ center = [0, 0.9], radius = 0.1 }}\n{second}"), false, "obstacle 1");
}

/// Tests all combinations of joint types. The tip passes a wall at a distance known in closed form.
#[test]
fn distances_are_exact_for_all_joint_types() {
    for (first, second, farthest) in [
        // Slid to the right by at most 1, the first bar reaches to 2. The second's corner adds its own distance.
        ("prismatic", "revolute", 2.0 + (0.8f64 * 0.8 + 0.05 * 0.05).sqrt()),
        ("prismatic", "prismatic", 2.8),
        // Slid across by at most 1, its outermost corner is at (1.8, 1.05).
        ("revolute", "prismatic", (1.8f64 * 1.8 + 1.05 * 1.05).sqrt()),
    ] {
        let urdf = robot(first, second);
        let world = |gap: f64| {
            let at = farthest + gap;
            format!(
                "robot.own_body = false\nstart.joints = [-1, -1]\ngoal.joints = [1, 1]\n[[obstacle]]\ncircle = {{ center = [0, 0], radius = 0.001 }}\nheight = [1, 2]\n\
                     [[obstacle]]\npolyline = [[{at}, -5], [{at}, 5]]\n"
            )
        };
        let knots = "[0, -1, -1], [1, 1, 0], [2, 1, 1]";
        holds(judge(&urdf, &world(1e-6), &found("", LINEAR, knots)));
        if first == "prismatic" {
            fails(judge(&urdf, &world(-1e-6), &found("", LINEAR, knots)), "");
        }
    }
}

/// Tests that a pair with disjoint heights cannot collide. If heights touch, it can.
#[test]
fn disjoint_heights_exclude_a_pair_and_touching_ones_do_not() {
    let at = |height: &str| {
        judge_straight_motion(
            &arm(),
            &format!("[[obstacle]]\ncircle = {{ center = [1.4, 0], radius = 0.1 }}\nheight = {height}\n"),
        )
        .0
    };
    assert_eq!((at("[0.06, 0.2]"), at("[-1, -0.06]"), at("[0.05, 0.2]"), at("[-1, 0]")), (0, 0, 3, 3));
    assert_eq!(at("[0.2, 0.06]"), 1);
}

/// Tests interpolations. Between knots, cubics with these velocities make the arm swing out, and lines do not.
#[test]
fn the_interpolation_between_knots_matters() {
    // q2 is 2.5 at both knots. With slopes 4 and -4 over a second the cubic rises by 1; with (4, 0) by 8 / 27 = 0.296.
    let world = |limit: &str| {
        format!("start.joints = [0, 1]\ngoal.joints = [0, 1]\nrobot.limits = {{ b = [-2.9, {limit}] }}\n")
    };
    let knots = "[0, 0, 1, 0, 4, 0, -8], [1, 0, 1, 0, -4, 0, -8]";
    let code = |ways: &str, limit: &str| judge(&arm(), &world(limit), &found("", ways, knots)).0;
    // All are the parabola 1 + 4 t (1 - t), which reaches 2.
    for way in [r#""cubic", "quartic", "quintic""#, r#""quintic", "linear", "cubic""#] {
        assert_eq!((code(way, "2"), code(way, "1.99999999999999999999")), (0, 3), "{way}");
    }
    let code = |ways: &str, knots: &str, limit: &str| judge(&arm(), &world(limit), &found("", ways, knots)).0;
    let cubic = "[0, 0, 1, 0, 4], [1, 0, 1, 0, 0]";
    // 1 + 4 t (1 - t)^2 is at most 1 + 16 / 27 = 1.5925926 at 1/3.
    assert_eq!((code(r#""cubic""#, cubic, "1.5925926"), code(r#""cubic""#, cubic, "1.5925925")), (0, 3));
    // 1 + 4 t - 12 t^3 + 8 t^4 has position 1, velocity 4, acceleration 0; then 1 and 0. The samples below give its
    // maximum.
    let quartic = |t: f64| 1.0 + 4.0 * t - 12.0 * t.powi(3) + 8.0 * t.powi(4);
    let most = (0..=1_000_000).map(|i| quartic(f64::from(i) / 1e6)).fold(0.0, f64::max);
    let knots = "[0, 0, 1, 0, 4, 0, 0], [1, 0, 1, 0, 0, 0, 0]";
    let limits = [most + 1e-9, most - 1e-9].map(|limit| limit.to_string());
    assert_eq!(limits.each_ref().map(|limit| code(r#""quartic""#, knots, limit)), [0, 3]);
    // 1 + 4 t - 24 t^3 + 32 t^4 - 12 t^5.
    let quintic = |t: f64| 1.0 + 4.0 * t - 24.0 * t.powi(3) + 32.0 * t.powi(4) - 12.0 * t.powi(5);
    let most = (0..=1_000_000).map(|i| quintic(f64::from(i) / 1e6)).fold(0.0, f64::max);
    let limits = [most + 1e-9, most - 1e-9].map(|limit| limit.to_string());
    assert_eq!(limits.each_ref().map(|limit| code(r#""quintic""#, knots, limit)), [0, 3]);
}

/// Tests a continuous joint, which has no limits. Whole turns are ignored at its goal.
#[test]
fn whole_turns_of_continuous_joints_do_not_matter_at_the_goal() {
    let urdf = arm().replacen("revolute", "continuous", 1);
    let post = "[[obstacle]]\ncircle = { center = [1.4, 0], radius = 0.15 }\n";
    let code = |goal: &str, last: &str| {
        let world = format!("start.joints = [-1, 0]\ngoal.joints = [{goal}, 0]\n{post}");
        let (code, report) = judge(&urdf, &world, &found("", LINEAR, &format!("[0, -1, 0], [1, {last}, 0]")));
        assert!(code == 3 || report.contains("within 1e-15"), "{report}");
        code
    };
    assert_eq!((code("1", "-5.283185307179586"), code("1", "7.283185307179586")), (0, 3));
    assert_eq!((code("-11.566370614359172", "-5.283185307179586"), code("1.1", "-5.283185307179586")), (0, 3));
}

/// Tests a goal that is a tip position. The message states the distance from it.
#[test]
fn the_distance_from_a_tip_goal_is_stated() {
    let urdf = arm();
    let (x, y) = (1.8 * 1f64.cos(), 1.8 * 1f64.sin());
    let line = found("", LINEAR, "[0, -1, 0], [1, 1, 0]");
    let world = |tip: &str| format!("start.tip = [{x}, {}]\n{tip}", -y);
    let (code, report) = judge(&urdf, &world(&format!("goal.tip = [{x}, {y}]")), &line);
    assert!(code == 0 && report.contains("the goal, a position of the tip \"tool\", within 1e-1"), "{report}");
    assert_eq!(judge(&urdf, &world(&format!("goal.tip = [{x}, {}]", y + 2e-5)), &line).0, 3);
    // Requested at another place, and for another link.
    let asked = found(&format!(r#""goal_tip": [{x}, {y}],"#), LINEAR, "[0, -1, 0], [1, 1, 0]");
    let (code, report) = judge(&urdf, ENDS, &asked);
    assert!(code == 0 && report.contains("goal (0.97"), "{report}");
    fails(judge(&urdf, &format!("{ENDS}robot.tip = \"fore\""), &asked), "misses the goal");
    let two = asked.replace("\"motion\"", "\"goal\": [1, 0], \"motion\"");
    assert!(judge(&urdf, ENDS, &two).1.contains("two goals"));
    // Robot and surroundings are moved and turned by 45 degrees.
    let turn = std::f64::consts::FRAC_PI_4;
    let place =
        |angle: f64, r: f64| format!("[{}, {}]", 5.0 + r * (turn + angle).cos(), -2.0 + r * (turn + angle).sin());
    let at = |r: f64| {
        let world = format!(
            "robot.at = [5, -2]\nrobot.angle = \"45deg\"\nstart.joints = [-1, 0]\ngoal.tip = {}\n[[obstacle]]\ncircle = {{ center = {}, radius = 0.1 }}\n",
            place(1.0, 1.8),
            place(0.5, r)
        );
        judge(&urdf, &world, &line).0
    };
    assert_eq!((at(1.901), at(1.899)), (0, 3));
}

/// Tests a single knot, which means an arm at rest.
#[test]
fn a_single_knot_is_an_arm_at_rest() {
    let post =
        "start.joints = [-1, 0]\ngoal.joints = [-1, 0]\n[[obstacle]]\ncircle = { center = [1.4, 0], radius = 0.15 }\n";
    assert_eq!(judge(&arm(), post, &found("", r#""cubic""#, "[0, -1, 0, 0, 0]")).0, 0);
    assert_eq!(judge(&arm(), &post.replace("-1, 0", "0, 0"), &found("", r#""cubic""#, "[0, 0, 0, 0, 0]")).0, 3);
}

/// Tests that the checker refuses unknown input, and never ignores it.
#[test]
fn unknown_input_is_refused_with_its_place() {
    let place = world("[[obstacle]]\npolyline = [[3, 0], [4, 0]]\n");
    let good = found("", LINEAR, "[0, -1, 0], [1, 1, 0]");
    let bad =
        |urdf: &str, world: &str, certificate: &str, file: Input, part: &str| match check(urdf, world, certificate)
            .map(|_| ())
        {
            Err(CheckError::Input { input, message, .. }) => {
                assert!(input == file && message.contains(part), "{input:?} {message}");
            }
            other => panic!("{part}: {other:?}"),
        };
    assert_eq!(judge(&arm(), &place, &good).0, 0);
    let urdf = |from: &str, to: &str, part: &str| {
        assert!(arm().contains(from), "{from}");
        bad(&arm().replace(from, to), &place, &good, Input::Urdf, part);
    };
    urdf("box size=\"0.8 0.1 0.1\"", "mesh filename=\"m\"", "mesh");
    urdf("<collision> <origin xyz=\"0.4 0 0\"/> <geometry>", "<collision> <geometry/> <geometry>", "second element");
    urdf("<link name=\"fore\">", "<link name=\"fore\"> <collision/>", "need a <geometry> with exactly one shape");
    urdf("<box size=\"0.8 0.1 0.1\"/>", "<box size=\"0.8 0.1 0.1\"/> <sphere radius=\"3\"/>", "exactly one shape");
    urdf("collision", "nothing", "could collide");
    urdf("<link name=\"fore\">", "<joint name=\"m\" type=\"revolute\"> <parent link=\"fore\"/> <child link=\"c\"/> <mimic joint=\"a\"/> </joint>
          <link name=\"c\"> <collision> <geometry> <sphere radius=\"0.1\"/> </geometry> </collision> </link> <link name=\"fore\">", "mimic");
    urdf("<limit lower=\"-2.9\" upper=\"2.9\"/>", "<limit lower=\"2.9\" upper=\"2.9\"/>", "no limits");
    let worlds = |text: &str, part: &str| bad(&arm(), &world(text), &good, Input::World, part);
    worlds("[[obstacle]]\nimage = \"map.yaml\"", "check_files");
    worlds("[[obstacle]]\npolygon = [[0, 0], [1, 1]]", "too few");
    worlds("[[obstacle]]\npolyline = [[0, 0]]", "too few");
    worlds("[[obstacle]]\ncircle = { center = [9, 9], radius = -1 }", "no radius");
    worlds("[map]\nfile = \"m\"", "check_files");
    worlds("[[object]]\nname = \"m\"", "one shape");
    let bare = arm().replace(
        "<collision> <origin xyz=\"0.4 0 0\"/> <geometry> <box size=\"0.8 0.1 0.1\"/> </geometry> </collision>",
        "",
    );
    assert_eq!(judge(&bare, &place, &good).0, 0);
    // The bar extends from the second joint to the tip, where the wall is.
    let at = |x: f64| format!("robot.bar = 0.05\n{ENDS}[[obstacle]]\npolyline = [[{x}, 0], [4, 0]]\n");
    assert_eq!((judge(&bare, &at(1.851), &good).0, judge(&bare, &at(1.849), &good).0), (0, 3));
    let certificates = |text: String, part: &str| bad(&arm(), &place, &text, Input::Certificate, part);
    certificates(found("", "", "[0, -1, 0], [1, 1, 0]"), "does not state the interpolation");
    certificates(found("", LINEAR, ""), "no knots");
    certificates(found("", r#""cubic""#, "[0, -1, 0], [1, 1, 0]"), "needs 5");
    certificates(found("", LINEAR, "[0, -1, 0], [1, 1, 0, 2, 3]"), "knot 1 has 5");
    certificates(found("", r#""spline""#, "[0, -1, 0], [1, 1, 0]"), "spline");
    certificates(found("", LINEAR, "[0, -1, NaN], [1, 1, 0]"), "certificate");
    certificates(found(r#""boxes": [],"#, LINEAR, "[0, -1, 0], [1, 1, 0]"), "boxes");
    certificates(good.replace("motion", "motions"), "motion");
    certificates(good.replace("certificate 1", "certificate 2"), "certificate 2");
}

/// Tests that visual shapes are used if there are no others, separately for each part of the arm. Solids have the
/// orientations of the file.
#[test]
fn visual_shapes_replace_missing_collision_shapes() {
    let visual = arm().replacen("collision", "visual", 2);
    let wall = |at: f64| format!("[[obstacle]]\npolyline = [[{at}, -3], [{at}, 3]]\n");
    assert_eq!((judge_straight_motion(&visual, &wall(1.81)).0, judge_straight_motion(&visual, &wall(1.79)).0), (0, 3));
    // A solid at the tip, in several orientations, and its reach beyond 1.8.
    let tipped = |solid: &str, turn: &str| {
        arm().replace(
            "<link name=\"fore\">",
            &format!("<link name=\"fore\"> <collision> <origin xyz=\"1.8 0 0\" rpy=\"{turn}\"/> <geometry> <{solid}/> </geometry> </collision>"),
        )
    };
    let oblique = |angle: f64| 0.3 * angle.sin() + 0.2 * angle.cos();
    for (solid, turn, reach) in [
        ("sphere radius=\"0.2\"", "0 0 0", 0.2),
        ("cylinder radius=\"0.2\" length=\"0.6\"", "0 0 0", 0.2),
        ("cylinder radius=\"0.2\" length=\"0.6\"", "0 1.5707963267948966 0", (0.3f64 * 0.3 + 0.0).sqrt()),
        ("cylinder radius=\"0.2\" length=\"0.6\"", "0 0.7 0", oblique(0.7)),
        ("cylinder radius=\"0.2\" length=\"0.6\"", "0 1.3 0", oblique(1.3)),
        ("capsule radius=\"0.2\" length=\"0.6\"", "0 1.5707963267948966 0", 0.5),
        ("box size=\"0.6 0.2 0.1\"", "0 0 0.3", 0.3 * 0.3f64.cos() + 0.1 * 0.3f64.sin()),
    ] {
        let urdf = tipped(solid, turn);
        // The stretched arm has its tip at 2.8, and the wall is short and straight: nearly the inner border of a ring.
        let at = |gap: f64| {
            judge_straight_motion(
                &urdf,
                &format!("[[obstacle]]\npolyline = [[{0}, -0.001], [{0}, 0.001]]\n", 2.8 + reach + gap),
            )
            .0
        };
        let corner = if solid.starts_with("box") || turn.starts_with("0 1.57") { 0.15 } else { 0.02 };
        assert_eq!((at(corner), at(-0.005)), (0, 3), "{solid} {turn}");
    }
    // Turned by such an angle that its orientation is unknown.
    let urdf = tipped("cylinder radius=\"0.2\" length=\"0.6\"", "0 1e14 0");
    assert_eq!(judge_straight_motion(&urdf, "[[obstacle]]\npolyline = [[2.9, 0], [3, 0]]\n").0, 3);
}
