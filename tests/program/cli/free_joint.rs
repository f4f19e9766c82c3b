//! Goals of the tip that leave a joint free: all values of that joint are goals.

use super::*;
/// An arm with links of 1 m and 0.8 m. It has no tool frame, so the tip is the second link's origin, on the axis of its
/// joint.
const ELBOW: &str = r#"<robot name="elbow">
  <link name="base"/>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.05 0.1"/></geometry></collision></link>
  <link name="fore"><collision><origin xyz="0.4 0 0"/><geometry><box size="0.8 0.05 0.1"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" velocity="2" effort="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-2.5" upper="2.5" velocity="2" effort="1"/></joint>
</robot>"#;

const ENDS: &str = "[start]\njoints = [-1, 0]\n[goal]\ntip = [0.5403023058681398, 0.8414709848078965]\n";
const BELOW: &str = "[[obstacle]]\npolyline = [[0.428912, 0.958402], [1.225462, 2.738292]]\n";
const ABOVE: &str = "[[obstacle]]\npolyline = [[0.692982, 0.788844], [1.979949, 2.253841]]\n";

const PLANNERS: [&str; 5] = ["visibility", "trapezoid", "wavefront", "harmonic", "subdivision"];

/// Returns a folder with an arm and a world.
fn place(arm: &str, world: &str) -> Place {
    Place::new().with("arm.urdf", arm).with("world.toml", world)
}

fn run(place: &Place, options: &str) -> Done {
    place.run(&["arm.urdf", "world.toml"], options)
}

fn path(result: &Value) -> Vec<[f64; 2]> {
    serde_json::from_value(result["path"].clone()).unwrap()
}

fn last(result: &Value) -> [f64; 2] {
    *path(result).last().unwrap()
}

#[test]
fn all_planners_find_paths_to_any_value_of_the_free_joint() {
    let place = place(ELBOW, &format!("{ENDS}{BELOW}{ABOVE}"));
    assert_eq!(run(&place, "--goal 1,0 --quiet").code, 3, "with the elbow as at the start there is no way");
    assert_eq!(run(&place, "--goal 1,2.4 --quiet").code, 0, "with this elbow there is");
    for planner in PLANNERS {
        let result = run(&place, &format!("--planner {planner} --json")).exits(0).json();
        let [shoulder, elbow] = last(&result);
        assert!((shoulder - 1.0).abs() < 1e-9 && (-2.5..=2.5).contains(&elbow), "{planner}: {shoulder}, {elbow}");
        assert_eq!(result["free_joints"], json!(["elbow"]), "{planner}");
    }
}

#[test]
fn a_proof_that_holds_for_one_value_of_the_free_joint_is_refuted() {
    let place = place(ELBOW, &format!("{ENDS}{BELOW}{ABOVE}"));
    let proof = run(&place, "--goal 1,0 --json").exits(3);
    place.write("proof.json", &proof.stdout);
    let recheck =
        |options: &str| place.run(&["recheck", "arm.urdf", "world.toml"], &format!("--proof proof.json {options}"));
    assert_eq!(recheck("--goal 1,0").code, 0);
    recheck("").refused(1, &["does not hold", "do not separate"]);
}

#[test]
fn no_bound_is_above_the_length_to_any_value_of_the_free_joint() {
    for obstacle in [BELOW, ABOVE, ""] {
        let place = place(ELBOW, &format!("{ENDS}{obstacle}"));
        let result = run(&place, "--json --gap 1e-3").json();
        let optimum = &result["optimum"];
        let (bound, gap) = (optimum["lower_bound"].as_f64().unwrap(), optimum["gap"].as_f64().unwrap());
        assert!(gap <= 1e-3, "{obstacle}: {optimum}");
        let mut least = f64::INFINITY;
        for k in -8..=8 {
            let elbow = 0.3 * f64::from(k);
            let each = run(&place, &format!("--json --goal 1,{elbow}"));
            if each.code == 0 {
                least = least.min(each.json()["length"].as_f64().unwrap());
            }
        }
        assert!(least.is_finite() && bound <= least, "{obstacle}: {bound} above {least}");
    }
}

/// Checks that the shortest path meets the segment of goals at right angles, as measured by the metric.
#[test]
fn without_obstacles_only_the_joint_that_matters_moves() {
    let place = place(ELBOW, ENDS);
    for metric in ["--metric euclidean", "--metric weighted --weights 1,3", "--metric time"] {
        let result = run(&place, &format!("{metric} --json")).json();
        assert_eq!(path(&result), [[-1.0, 0.0], [1.0, 0.0]], "{metric}");
        let gap = result["optimum"]["gap"].as_f64().unwrap();
        assert!(gap < 1e-8, "{metric}: {gap}");
    }
    let words = run(&place, "--verbose");
    assert!(
        words.stdout.contains("any from -143.24 deg (-2.5000 rad)")
            && words.stdout.contains("for all values of joint \"elbow\"")
    );
    words.says(&["reached"]);
}

#[test]
fn a_goal_is_refused_only_if_no_value_of_the_free_joint_is_free() {
    // The start's elbow value would hit this at the goal; others do not.
    let one = "[[obstacle]]\ncircle = { center = [0.8644, 1.3463], radius = 0.1 }\n";
    let some = place(ELBOW, &format!("{ENDS}{one}"));
    run(&some, "--goal 1,0").refused(1, &["the goal", "not free"]);
    let done = run(&some, "--json").exits(0);
    assert!(last(&done.json())[1].abs() > 0.1);
    // A ring around the elbow's place at the goal blocks link 2 in most directions. Link 1 enters through its opening.
    let ring: Vec<String> = (-9..=9)
        .map(|k| {
            let (sin, cos) = (1.0 + f64::from(k) * std::f64::consts::TAU / 24.0).sin_cos();
            format!(
                "[[obstacle]]\ncircle = {{ center = [{}, {}], radius = 0.06 }}\n",
                0.5403 + 0.5 * cos,
                0.8415 + 0.5 * sin
            )
        })
        .collect();
    let none = place(ELBOW, &format!("{ENDS}{}", ring.concat()));
    run(&none, "").refused(1, &["no IK solution for the tip at", "elbow from -2.5 ", "hits obstacle", " more"]);
}

/// Checks a segment of goals. Walls close off one part of it, and obstacles block the rest, which the program proves.
#[test]
fn a_proof_for_all_values_of_the_free_joint_holds() {
    let across = "[[obstacle]]\npolyline = [[0.6, 0.05], [1.9, 0.05]]\n";
    let place = place(ELBOW, &format!("{ENDS}{across}"));
    for planner in PLANNERS {
        let done = run(&place, &format!("--planner {planner} --json")).exits(3);
        place.write("proof.json", &done.stdout);
        place.run(&["recheck", "arm.urdf", "world.toml"], "--proof proof.json").exits(0);
    }
}

/// Checks links of equal lengths that fold onto their base, which leaves joint 1 free.
#[test]
fn a_folded_arm_may_stand_at_any_angle() {
    let arm = ELBOW.replace("0.4 0 0", "0.5 0 0").replace("0.8 0.05", "1 0.05").replace("2.5", "3.3").replace(
        "</robot>",
        r#"<link name="tip"/><joint name="tool" type="fixed"><parent link="fore"/><child link="tip"/><origin xyz="1 0 0"/></joint></robot>"#,
    );
    let world = "[start]\njoints = [-1, 1]\n[goal]\ntip = [0, 0]\n";
    let wall = "[[obstacle]]\ncircle = { center = [0.35, -0.3], radius = 0.05 }\n";
    for obstacle in ["", wall] {
        let place = place(&arm, &format!("{world}{obstacle}"));
        for planner in PLANNERS {
            let result = run(&place, &format!("--planner {planner} --json")).exits(0).json();
            assert!((last(&result)[1].abs() - std::f64::consts::PI).abs() < 1e-7, "{planner}: {:?}", last(&result));
            assert_eq!(result["free_joints"], json!(["shoulder"]), "{planner}");
        }
        let free = run(&place, "--json").json();
        assert!(free["optimum"]["gap"].as_f64().unwrap() < 0.05, "{free}");
    }
    let straight = run(&self::place(&arm, world), "--json").json();
    let way = path(&straight);
    assert!(
        way.len() == 2
            && way[1][0] == -1.0
            && (straight["length"].as_f64().unwrap() - (std::f64::consts::PI - 1.0)).abs() < 1e-7
    );
}

#[test]
fn a_robot_without_a_tool_is_planned_for_unchanged() {
    let world = "[start]\njoints = [0, 0.5]\n[goal]\ntip = [0, 1]\n";
    let place = Place::new()
        .with("world.toml", world)
        .with("arm.urdf", ELBOW.replace("type=\"revolute\"", "type=\"continuous\""));
    let done = run(&place, "--json");
    let result = done.json();
    assert_eq!((done.code, path(&result).len()), (0, 2), "{}", done.stderr);
    assert!((result["length"].as_f64().unwrap() - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
}
