//! `cplan verify` of the motions of two arms, compared with the oracle.

use super::super::{Done, Place, number};
use super::oracle::{Arm, Motion, distance, replayed};
use super::random::Cell;
use super::{SKEW, STEP, bars, column_arm, crossing_arms, shipped};
use cplan_cases::dice::Dice;
use serde_json::Value;
use std::f64::consts::PI;

/// Plans a cell with files for both arms, and returns the answer.
fn planned(place: &Place, cell: &str, names: [&str; 2]) -> Option<Value> {
    let outputs = names.map(|name| [format!("{name}.csv"), format!("{name}.yaml")]).concat().join(" --output ");
    let done = place.run(&["cell", cell], &format!("--json --quiet --boxes 0 --output cell.json --output {outputs}"));
    (done.code == 0).then(|| super::answer(&done))
}

fn judged(place: &Place, cell: &str, files: &str, options: &str) -> (i32, Value) {
    let done = place.run(&["verify", cell], &format!("{files} --json --quiet {options}"));
    assert!([0, 3, 4].contains(&done.code), "{}{}", done.stdout, done.stderr);
    (done.code, super::answer(&done))
}

/// Checks that a stated place is one at which the arms are as near as stated.
#[track_caller]
fn check_place(place: &Value, arms: &[Arm; 2], motions: &[Motion; 2], skew: f64) {
    let times = [0, 1].map(|k| number(&place["times"][k]));
    assert!((times[0] - times[1]).abs() <= skew + 1e-9, "{place}");
    let at = [0, 1].map(|k| motions[k].at(times[k]));
    for (arm, at) in at.iter().enumerate() {
        assert!((0..2).all(|k| (at[k] - number(&place["configurations"][arm][k])).abs() < 1e-6), "{place} {at:?}");
    }
    // Discs of the oracle are polygons, and overlaps have the distance 0.
    let [seen, stated] = [distance(arms, at), number(&place["distance"]).max(0.0)];
    assert!((seen - stated).abs() < 1e-3, "{seen} {place}");
}

#[test]
fn motions_of_cplan_are_free() {
    let column = [[[0.2, 0.26], [0.13, 0.19], [0.05, 0.15]], [[0.3, 0.36], [0.13, 0.29], [0.05, 0.15]]];
    for (name, arms, names) in [
        ("crossing", crossing_arms(), ["left", "right"]),
        ("swap", [bars([-1.3, 0.0], 0.0), bars([1.3, 0.0], PI)], ["left", "right"]),
        ("column", column.map(column_arm), ["lower", "upper"]),
    ] {
        let place = Place::new();
        let cell = shipped(&format!("workspaces/cells/{name}.toml"));
        let answer = planned(&place, &cell, names).expect("motions");
        let motions = [0, 1].map(|k| Motion::read(&answer["arms"][k]));
        let least = replayed(&arms, &motions, SKEW, STEP);
        let [one, two] = names;
        for files in [format!("{one}.csv {two}.csv"), format!("{one}.yaml {two}.yaml"), "cell.json".to_owned()] {
            let (code, judged) = judged(&place, &cell, &files, "");
            assert_eq!((code, &judged["verdict"]), (0, &"free".into()), "{name} {files}: {judged:#}");
            let proven = number(&judged["between"]["clearance"]);
            assert!(0.0 < proven && proven <= least + 1e-6, "{name} {files}: {proven} {least}");
            check_place(&judged["between"]["nearest"], &arms, &motions, SKEW);
        }
        place.run(&["verify", &cell, "cell.json"], "").exits(0).says(&["free", "between the arms, proven", one, two]);
    }
}

/// Writes the motion of an arm as a table whose times are shifted.
fn write_shifted(place: &Place, file: &str, motion: &Motion, shift: f64) {
    let mut text = "time,j0,j1,j0_velocity,j1_velocity\n".to_owned();
    for (time, (q, v)) in motion.time.iter().zip(motion.position.iter().zip(&motion.velocity)) {
        text += &format!("{:?},{:?},{:?},{:?},{:?}\n", time + shift, q[0], q[1], v[0], v[1]);
    }
    place.write(file, text);
}

#[test]
fn shifted_motions_agree_with_the_oracle() {
    let (mut free, mut collisions) = (0, 0);
    for seed in cplan_cases::seeds(40) {
        let mut random = Dice::new(seed);
        let cell = Cell::new(&mut random);
        let place = cell.place();
        let Some(answer) = planned(&place, "cell.toml", ["left", "right"]) else { continue };
        let [left, right] = [0, 1].map(|k| Motion::read(&answer["arms"][k]));
        for _ in 0..3 {
            let shift = random.within(-0.4, 0.4);
            let skew = random.within(0.0, 0.05);
            write_shifted(&place, "left.csv", &left, 0.0);
            write_shifted(&place, "right.csv", &right, shift);
            let later = right.time.iter().map(|time| time + shift).collect();
            let right = Motion { time: later, position: right.position.clone(), velocity: right.velocity.clone() };
            let motions = [
                Motion { time: left.time.clone(), position: left.position.clone(), velocity: left.velocity.clone() },
                right,
            ];
            // The oracle begins at time 0, and both arms rest before it.
            let least = replayed(&cell.arms, &motions, skew, STEP);
            let (_, judged) = judged(&place, "cell.toml", "left.csv right.csv", &format!("--skew {skew}"));
            match judged["between"]["verdict"].as_str().unwrap() {
                "free" => {
                    let proven = number(&judged["between"]["clearance"]);
                    assert!(proven > 0.0 && proven <= least + 1e-6, "seed {seed}, {shift}: {proven} {least}");
                    assert_eq!(judged["verdict"], "free", "seed {seed}: {judged:#}");
                    free += 1;
                }
                "collision" => {
                    assert_eq!(judged["verdict"], "collision");
                    assert!(least < 2e-3, "seed {seed}, {shift}: {least}");
                    for key in ["first", "nearest"] {
                        check_place(&judged["between"][key], &cell.arms, &motions, skew);
                    }
                    collisions += 1;
                }
                _ => panic!("seed {seed}: {judged:#}"),
            }
        }
    }
    if cplan_cases::uses_default_cases() {
        assert!(free >= 30 && collisions >= 10, "{free} {collisions}");
    }
}

/// Judges two motions in the cell "swap": the left arm sweeps from one of two samples to the other.
fn swept(right: [f64; 2]) -> Value {
    let place = Place::new();
    place.write("left.csv", "time,shoulder,elbow\n0,0.6,0\n2,-0.6,0\n");
    place.write("right.csv", format!("time,shoulder,elbow\n0,{},{}\n2,{0},{1}\n", right[0], right[1]));
    let arms = [bars([-1.3, 0.0], 0.0), bars([1.3, 0.0], PI)];
    for q in [[0.6, 0.0], [-0.6, 0.0]] {
        assert!(distance(&arms, [q, right]) > 0.1, "the arms are apart at the samples");
    }
    judged(&place, &shipped("workspaces/cells/swap.toml"), "left.csv right.csv", "--anywhere").1
}

#[test]
fn a_collision_between_samples_is_found() {
    let judged = swept([0.0, 0.0]);
    assert_eq!(judged["verdict"], "collision", "{judged:#}");
    let at = number(&judged["between"]["first"]["configurations"][0][0]);
    assert!(at.abs() < 0.5, "{judged:#}");
    let judged = swept([PI / 2.0, 0.0]);
    assert_eq!(judged["between"]["verdict"], "free", "{judged:#}");
}

#[test]
fn false_statements_about_the_distance_are_found() {
    let place = Place::new();
    let cell = shipped("workspaces/cells/swap.toml");
    let mut answer = planned(&place, &cell, ["left", "right"]).expect("motions");
    answer["clearance_between"] = Value::from(0.5);
    place.write("cell.json", answer.to_string());
    let (code, judged) = judged(&place, &cell, "cell.json", "");
    assert_eq!((code, &judged["verdict"]), (3, &"claims".into()), "{judged:#}");
    place.run(&["verify", &cell, "cell.json"], "").exits(3).says(&["fault", "states that the arms keep 500.0 mm"]);
}

#[test]
fn what_does_not_apply_to_cells_is_refused() {
    let place = Place::new();
    let cell = shipped("workspaces/cells/swap.toml");
    place.write("path.csv", "shoulder,elbow\n0.6,0\n-0.6,0\n");
    place.write("half.json", "{\"arms\": [{\"name\": \"left\"}]}");
    let robot = shipped("robots/planar_2r.urdf");
    let run = |first: &str, options: &str| -> Done { place.run(&["verify", first], options) };
    run(&cell, "path.csv path.csv").refused(1, &["the motion of left has no times", "hint: "]);
    run(&cell, "half.json").refused(1, &["half.json", "has no motion of arm \"left\"", "hint: "]);
    run(&cell, "path.csv").refused(1, &["path.csv", "is no result of `cplan cell`"]);
    run(&cell, "path.csv path.csv --certificate c.json").refused(2, &["--certificate does not apply"]);
    run(&robot, "path.csv").refused(2, &["the motion is missing"]);
    run(&robot, "world.toml path.csv --skew 0.1").refused(2, &["--skew needs a cell"]);
}
