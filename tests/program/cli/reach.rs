//! `cplan reach` from outside: cells and solutions against the tests' own kinematics, and against plans to them.

use super::*;
use std::f64::consts::{PI, TAU};

fn reach(place: &Place, files: &[String; 2], options: &str) -> Done {
    place.run(&["reach", &files[0], &files[1]], options)
}

struct Solution {
    tip: [f64; 2],
    joints: [f64; 2],
    access: String,
}

fn solutions(csv: &str) -> Vec<Solution> {
    let solution = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let [x, y, a, b] = [0, 1, 2, 3].map(|k| fields[k].parse::<f64>().unwrap());
        Solution { tip: [x, y], joints: [a, b], access: fields[4].to_owned() }
    };
    csv.lines().skip(1).map(solution).collect()
}

#[test]
fn all_solutions_are_there_and_put_the_tip_at_the_centres() {
    let place = Place::new();
    let done = reach(&place, &shelf(), "--cell 0.07 --output r.csv --output r.json --picture r.svg --quiet");
    assert_eq!((done.code, done.stdout.as_str()), (0, ""), "{}", done.stderr);
    let all = solutions(&place.read("r.csv"));
    for Solution { tip: [x, y], joints, .. } in &all {
        let [at_x, at_y] = tip(*joints);
        assert!((x - at_x).hypot(y - at_y) < 1e-9, "{joints:?}");
    }
    // Each cell centre between the least and the greatest reach has two elbow solutions, within the joints' limits.
    let result = place.json("r.json");
    let within = |value: f64| value.abs() <= 2.9;
    let (cell, corner) = (number(&result["reach"]["cell"]), &result["reach"]["corner"]);
    let size = [0, 1].map(|k| result["reach"]["size"][k].as_u64().unwrap());
    let mut expected = 0;
    for j in 0..size[1] {
        for i in 0..size[0] {
            let [x, y] = [(0, i), (1, j)].map(|(k, n)| number(&corner[k]) + cell * (n as f64 + 0.5));
            let cos = (x * x + y * y - 1.0 - 0.64) / 1.6;
            if cos.abs() < 1.0 {
                for elbow in [cos.acos(), -cos.acos()] {
                    let shoulder =
                        (y.atan2(x) - (0.8 * elbow.sin()).atan2(1.0 + 0.8 * elbow.cos()) + PI).rem_euclid(TAU) - PI;
                    expected += usize::from(within(shoulder) && within(elbow));
                }
            }
        }
    }
    assert_eq!(all.len(), expected);
    let picture = place.read("r.svg");
    has(&picture, &["Workspace", "Configuration space", "the tip can reach it, with one IK solution"]);
}

#[test]
fn each_solution_has_the_outcome_of_planning_to_it() {
    let place = Place::new();
    let mut seen = std::collections::BTreeMap::<String, usize>::new();
    for (robot, world) in [
        ("planar_2r", "singular_closed"),
        ("planar_2r", "shelf"),
        ("polar", "polar_gate"),
        ("slide_arm", "slide_table"),
    ] {
        let files = [shipped(&format!("robots/{robot}.urdf")), shipped(&format!("workspaces/{world}.toml"))];
        let result = reach(&place, &files, "--output r.csv --json").exits(0).json();
        let home = [0, 1].map(|k| result["reach"]["home"][k].as_f64().unwrap());
        let all = solutions(&place.read("r.csv"));
        for access in ["reachable", "unreachable", "blocked", "unknown"] {
            let of: Vec<&Solution> = all.iter().filter(|solution| solution.access == access).collect();
            for solution in of.iter().step_by((of.len() / 6).max(1)) {
                let [a, b] = solution.joints;
                let options = format!("--start={},{} --goal={a},{b} --planner first --quiet", home[0], home[1]);
                let planned = place.run(&files, &options).code;
                let codes: &[i32] = match access {
                    "reachable" => &[0],
                    "unreachable" => &[3],
                    // A goal that is in contact is not free.
                    "blocked" => &[1],
                    _ => &[4],
                };
                assert!(codes.contains(&planned), "{world}: {access} {a} {b}, and planning ends with {planned}");
                *seen.entry(access.to_owned()).or_default() += 1;
            }
        }
    }
    assert!(seen["reachable"] > 15 && seen["blocked"] > 15 && seen["unreachable"] > 4, "{seen:?}");
}

#[test]
fn invalid_cells_and_homes_are_refused() {
    let place = Place::new();
    reach(&place, &shelf(), "--cell 0.0001").refused(1, &["more than 4000000 cells", "choose larger cells"]);
    reach(&place, &shelf(), "--cell 0").refused(2, &["--cell"]);
    reach(&place, &shelf(), "--home 0,9").refused(1, &["elbow"]);
    reach(&place, &shelf(), "--output r.yaml").refused(2, &["must end in .json or .csv"]);
    reach(&place, &shelf(), "--picture r.gif").refused(2, &["must be .svg, .png or .html"]);
    assert!(!place.path("r.yaml").exists());
}

#[test]
fn errors_of_the_home_are_attributed_to_it() {
    let place = Place::new();
    let far = reach(&place, &shelf(), "--home 9,9");
    far.refused(1, &["--home"]);
    assert!(!far.stderr.contains("--start"), "{}", far.stderr);
}

/// Checks a place at the first joint, where that joint may have any value. A pole blocks the value nearest to the home
/// position, but not others.
#[test]
fn a_place_that_leaves_a_joint_free_is_reached_with_another_value_of_it() {
    // The forearm is 1.2 m long, and the tip is 1 m from the elbow.
    let longer =
        [("\"0.4 0 0\"", "\"0.6 0 0\""), ("0.8 0.1 0.1", "1.2 0.1 0.1"), ("\"0.8 0 0\"", "\"1 0 0\""), ("2.9", "3.2")];
    let place = Place::new().with("arm.urdf", planar_2r(&longer)).with(
        "world.toml",
        "robot.at = [0.05, 0.05]\nstart.joints = [0, 0]\nobstacle = [{ circle = { center = [-0.1, 0.05], radius = 0.02 } }]\n",
    );
    reach(&place, &["arm.urdf".into(), "world.toml".into()], "--cell 0.1 --output r.csv").exits(0);
    let all = solutions(&place.read("r.csv"));
    let folded: Vec<&Solution> = all.iter().filter(|s| s.tip.iter().all(|c| (c - 0.05).abs() < 1e-9)).collect();
    assert!(!folded.is_empty());
    for Solution { joints: [a, b], access, .. } in folded {
        assert_eq!(access, "reachable", "{a} {b}");
        // At the reported value, the arm reaches the place. At the value nearest to home, it does not.
        let goal = format!("--goal={a:?},{b:?}");
        assert_eq!(place.run(&["arm.urdf", "world.toml", &goal], "--quiet").code, 0, "{goal}");
        place.run(&["arm.urdf", "world.toml", &format!("--goal=0,{b:?}")], "").refused(1, &["goal"]);
    }
}
