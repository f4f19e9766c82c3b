//! Motions of joints other than the arm's two: a quill that moves up and down, and a wrist that turns.

use super::*;
use cplan::input::{Source, scene_from};
use cplan::space::Configuration;
use std::fmt::Write;

/// A robot with two arms of a metre each at a height of 1 m. It has a quill of 0.6 m at their end, and a finger of 0.2
/// m off the quill's axis.
const ROBOT: &str = r#"<robot name="scara">
  <link name="base"/>
  <joint name="j1" type="revolute">
    <parent link="base"/> <child link="upper"/> <origin xyz="0 0 1"/> <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="9"/>
  </joint>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <joint name="j2" type="revolute">
    <parent link="upper"/> <child link="fore"/> <origin xyz="1 0 0"/> <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="9"/>
  </joint>
  <link name="fore"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <joint name="quill" type="prismatic">
    <parent link="fore"/> <child link="rod"/> <origin xyz="1 0 0"/> <axis xyz="0 0 -1"/>
    <limit lower="0" upper="0.6" effort="1" velocity="9"/>
  </joint>
  <link name="rod"><collision><geometry><cylinder radius="0.05" length="0.6"/></geometry></collision></link>
  <joint name="wrist" type="revolute">
    <parent link="rod"/> <child link="tool"/> <origin xyz="0 0 -0.3"/> <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="9"/>
  </joint>
  <link name="tool">FINGER</link>
</robot>
"#;

const FINGER: &str =
    r#"<collision><origin xyz="0.1 0 0"/><geometry><box size="0.2 0.02 0.02"/></geometry></collision>"#;

/// A world with a low block beside the stretched arm.
const WORLD: &str = "[robot]\njoints = [\"j1\", \"j2\"]\n[[obstacle]]\nname = \"block\"\n\
                     polygon = [[1.5, 0.5], [1.9, 0.5], [1.9, 0.9], [1.5, 0.9]]\nheight = [0.0, 0.5]\n";

/// Returns the findings about a table.
fn verify(finger: &str, table: &str) -> Result<Value, InputError> {
    let place = Place::new().with("arm.urdf", ROBOT.replace("FINGER", finger)).with("world.toml", WORLD);
    judged(&["arm.urdf", "world.toml"].map(|file| place.path(file)), "m.csv", table, &Question::with_free_ends())
}

/// Returns the verdict and the findings about a valid table.
fn verdict_and_findings(finger: &str, table: &str) -> (String, Value) {
    let found = verify(finger, table).unwrap_or_else(|error| panic!("{error}"));
    (found["verdict"].as_str().expect("a word").to_owned(), found)
}

/// Checks motions over the block and back, with the quill at different heights above it.
#[test]
fn a_quill_is_judged_at_the_heights_that_it_has() {
    let table = |depths: [f64; 4]| {
        let joints = [0.0, 0.38, 0.38, 0.0];
        let row = |k: usize| format!("{k},{},0,{}\n", joints[k], depths[k]);
        "time,j1,j2,quill\n".to_owned() + &(0..4).map(row).collect::<String>()
    };
    // The rod ends at 0.7 m less its depth.
    for (depths, verdict) in [
        ([0.0; 4], "free"),
        ([0.6, 0.0, 0.0, 0.6], "collision"),
        ([0.19; 4], "free"),
        ([0.19, 0.19, 0.21, 0.0], "collision"),
        ([0.6, 0.6, 0.6, 0.6], "collision"),
    ] {
        let (found, json) = verdict_and_findings("", &table(depths));
        assert_eq!(found, verdict, "{depths:?}: {json:#}");
        if verdict == "collision" {
            assert_eq!(json["first_contact"]["body"], "rod", "{json:#}");
        }
    }
    let (verdict, json) = verdict_and_findings("", &table([0.19, 0.19, 0.21, 0.0]));
    let time = json["first_contact"]["time"].as_f64().unwrap();
    // Halfway down over the block its heights are those of the block.
    assert!(verdict == "collision" && (1.5 - 1e-6..1.6).contains(&time), "{json:#}");
    let notes = json["notes"].to_string();
    assert!(
        notes.contains("slides between 0 and 0.21 m") && notes.contains("at their height at each moment"),
        "{notes}"
    );
}

/// Checks an arm that stands over the block. The quill moves down at the first sample and up at the second, so the
/// cubic between them is deeper than both.
#[test]
fn between_samples_a_quill_goes_where_its_velocities_lead_it() {
    let table = |speed: f64| {
        format!(
            "time,j1,j2,quill,j1_velocity,j2_velocity,quill_velocity\n0,0.38,0,0.1,0,0,{speed}\n1,0.38,0,0.1,0,0,-{speed}\n"
        )
    };
    assert_eq!(verdict_and_findings("", &table(0.39)).0, "free");
    // A quarter of the speed more, halfway.
    let (verdict, json) = verdict_and_findings("", &table(0.41));
    assert_eq!((verdict.as_str(), &json["first_contact"]["body"]), ("collision", &"rod".into()), "{json:#}");
}

/// Checks turns of a finger of 0.2 m on a tip that is 0.2 m, 0.05 m or 0 m beside the block.
#[test]
fn a_wrist_is_judged_at_the_angles_that_it_has() {
    let table = |turn: f64, j1: f64| format!("time,j1,j2,quill,wrist\n0,{j1},0,0.5,0\n1,{j1},0,0.5,{turn}\n");
    for (finger, turn, j1, verdict) in [
        (FINGER, 1.0, 0.0, "free"),
        // The finger turns towards the block, and away from it.
        (FINGER, 2.0, 0.2, "collision"),
        (FINGER, -2.0, 0.2, "free"),
        (FINGER, 0.1, 0.2, "free"),
        ("", 1.0, 0.2, "free"),
    ] {
        let (found, json) = verdict_and_findings(finger, &table(turn, j1));
        assert_eq!(found, verdict, "{turn} {j1}: {json:#}");
        assert!(json["notes"].to_string().contains("judged at their angle at each moment"), "{json:#}");
        let hit = json["first_contact"]["body"].as_str();
        assert_eq!(hit, (verdict == "collision").then_some("tool"), "{json:#}");
    }
    let (_, json) = verdict_and_findings(FINGER, &table(1.0, 0.38));
    assert_eq!(json["first_contact"]["body"], "rod", "{json:#}");
}

/// Checks a wrist that turns a bar by little. The bar keeps far from the upper arm, although the disc that it would sweep in
/// a whole turn does not.
#[test]
fn a_small_turn_of_a_bar_keeps_its_distance() {
    let joint = |name: &str, parent: &str, child: &str, x: f64| {
        format!(
            "<joint name=\"{name}\" type=\"revolute\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
             <origin xyz=\"{x} 0 0\"/><axis xyz=\"0 0 1\"/><limit lower=\"-4\" upper=\"4\" velocity=\"1\" effort=\"1\"/></joint>"
        )
    };
    let bar = |name: &str, length: f64| {
        let half = length / 2.0;
        format!(
            "<link name=\"{name}\"><collision><origin xyz=\"{half} 0 0\"/><geometry><box size=\"{length} 0.02 0.04\"/>\
             </geometry></collision></link>"
        )
    };
    let bars = bar("a", 0.3) + &bar("b", 0.2) + &bar("tool", 0.24);
    let joints = joint("j1", "base", "a", 0.0) + &joint("j2", "a", "b", 0.3) + &joint("j3", "b", "tool", 0.2);
    let place = Place::new()
        .with("arm.urdf", format!("<robot name=\"bars\"><link name=\"base\"/>{bars}{joints}</robot>"))
        .with("world.toml", "[robot]\njoints = [\"j1\", \"j2\"]\n");
    // The tip is 0.2 m from the upper arm's end, which the bar reaches only if it turns back.
    for (turn, code) in [(0.001, 0), (0.01, 0), (-3.12, 3)] {
        place.write("m.csv", format!("time,j1,j2,j3\n0,0,0,0\n1,0.1,-0.1,{turn}\n"));
        let done = place.run(&["verify", "arm.urdf", "world.toml", "m.csv"], "--anywhere --json");
        let found: Value = serde_json::from_str(&done.stdout).unwrap_or_else(|_| panic!("{}", done.stderr));
        assert_eq!(done.code, code, "{turn}: {found:#}");
        let clearance = found["clearance"].as_f64();
        assert!(code == 3 || clearance.is_some_and(|kept| (0.17..=0.2).contains(&kept)), "{turn}: {found:#}");
    }
}

/// Checks that the program writes no certificate when other joints move, because a certificate covers only two joints.
/// Errors about motions that cannot be used give the reason.
#[test]
fn motions_that_cannot_be_judged_say_why() {
    let table = "time,j1,j2,quill\n0,0,0,0\n1,0.1,0,0.1\n";
    let robot = ROBOT.replace("FINGER", "");
    let place = Place::new().with("arm.urdf", robot).with("world.toml", WORLD).with("m.csv", table);
    let done = place.run(&["verify", "arm.urdf", "world.toml", "m.csv"], "--anywhere --certificate c.json").exits(0);
    done.warns(&["joint \"quill\" moves"]);
    assert!(!place.path("c.json").exists());
    let mimic = FINGER.to_owned()
        + "</link><joint name=\"twin\" type=\"prismatic\"><parent link=\"tool\"/><child link=\"pad\"/><axis xyz=\"0 0 1\"/>\
           <limit lower=\"0\" upper=\"1\" effort=\"1\" velocity=\"1\"/><mimic joint=\"quill\"/></joint><link name=\"pad\">";
    let error = verify(&mimic, table).unwrap_err().to_string();
    assert!(error.contains("moves joint \"twin\" with it"), "{error}");
    let slanted = FINGER.to_owned()
        + "</link><joint name=\"tilt\" type=\"revolute\"><parent link=\"tool\"/><child link=\"pad\"/><axis xyz=\"1 0 0\"/>\
           <limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint><link name=\"pad\">";
    let error = verify(&slanted, &table.replace("quill", "tilt")).unwrap_err().to_string();
    assert!(error.contains("not along the normal"), "{error}");
}

/// Checks random motions of a quill and a wrist. The judge must agree with the static scene of each moment, in which both
/// have their values at that time.
#[test]
fn motions_of_a_quill_and_a_wrist_agree_with_the_scenes_of_their_moments() {
    let mut verdicts = [0; 2];
    for seed in cplan_cases::seeds(12) {
        let mut dice = cplan_cases::dice::Dice::new(seed);
        let samples: Vec<[f64; 4]> = (0..5)
            .map(|_| {
                let [j1, j2] = [dice.within(-0.8, 1.2), dice.within(-1.5, 1.5)];
                [j1, j2, dice.within(0.0, 0.6), dice.within(-2.5, 2.5)]
            })
            .collect();
        let mut table = "time,j1,j2,quill,wrist\n".to_owned();
        for (k, [j1, j2, quill, wrist]) in samples.iter().enumerate() {
            writeln!(table, "{k},{j1},{j2},{quill},{wrist}").unwrap();
        }
        let (verdict, json) = verdict_and_findings(FINGER, &table);
        let at = |time: f64| {
            let (k, share) = ((time.floor() as usize).min(3), time - time.floor().min(3.0));
            [0, 1, 2, 3].map(|j| samples[k][j] + share * (samples[k + 1][j] - samples[k][j]))
        };
        let distance = |time: f64| {
            let [j1, j2, quill, wrist] = at(time);
            let world =
                WORLD.replace("[robot]", &format!("[robot]\nfixed = {{ quill = {quill:?}, wrist = {wrist:?} }}"));
            let robot = Source::in_memory("arm.urdf", ROBOT.replace("FINGER", FINGER));
            let scene =
                scene_from(robot, Source::in_memory("world.toml", world)).unwrap_or_else(|e| panic!("{e}")).scene;
            scene.closest(Configuration::new(j1, j2)).map_or(f64::INFINITY, |contact| contact.separation.distance)
        };
        match verdict.as_str() {
            "free" => {
                let least = (0..=160).map(|k| distance(f64::from(k) / 40.0)).fold(f64::INFINITY, f64::min);
                assert!(least > 0.0, "seed {seed}: {least} {json:#}");
            }
            "collision" => {
                let time = json["first_contact"]["time"].as_f64().unwrap();
                assert!(distance(time) <= 1e-9, "seed {seed}: {} {json:#}", distance(time));
            }
            other => panic!("seed {seed}: {other} {json:#}"),
        }
        verdicts[usize::from(verdict == "collision")] += 1;
    }
    assert!(verdicts.iter().all(|count| *count > 0), "{verdicts:?}");
}

/// Margins count each part with all its heights. The quill is lowered beside the block, then it passes above it.
#[test]
fn margins_hold_while_a_quill_moves() {
    let margin = |table: &str| {
        let found = verify(FINGER, table).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(found["verdict"], "free", "{found:#}");
        let margins = found["margins"].as_array().unwrap();
        margins.iter().find(|margin| margin["body"] == "block").unwrap()["clearance"].as_f64()
    };
    // Above the block all the time.
    assert_eq!(margin("time,j1,j2,quill\n0,0,0,0.05\n1,0.38,0,0.1\n"), None);
    // The finger ends at (2.2, 0), and the quill, 0.05 m thick, stands at (2, 0). The block's nearest corner is (1.9, 0.5).
    let lowered = margin("time,j1,j2,quill\n0,0,0,0.4\n1,0,0,0\n2,0.38,0,0\n").expect("the block can be met");
    let least = 0.1_f64.hypot(0.5) - 0.05;
    assert!((0.85 * least..=least).contains(&lowered), "{lowered} instead of {least}");
}
