//! The option `--plan`: the greatest distances of a motion from its plan, and motions that are nearer than required.

use super::*;
const SHELF: [&str; 2] = ["planar_2r", "shelf"];

/// Returns the findings about a table, and the program's exit code.
fn verify(place: &Place, table: &str, options: &str) -> (i32, Value) {
    let done = verify_table(place, SHELF, table, &format!("--anywhere --json {options}"));
    (done.code, done.json())
}

/// Compares a plan along one joint with a motion that leaves it by a bump of the other joint.
#[test]
fn the_greatest_distances_from_the_plan_are_those_of_the_bump() {
    let place = Place::new().with("plan.csv", "time,shoulder,elbow\n0,-0.9,0.4\n2,-0.5,0.4\n");
    // The motion begins later and moves more slowly, which does not count.
    let bump = "time,shoulder,elbow\n5,-0.9,0.4\n6,-0.8,0.4\n7,-0.7,0.41\n8,-0.6,0.4\n9,-0.5,0.4\n";
    let (code, found) = verify(&place, bump, "--plan plan.csv");
    assert_eq!((code, &found["verdict"]), (0, &"free".into()), "{found:#}");
    let [joints, tip] = ["joints", "tip"].map(|of| &found["plan"][of]);
    assert!((joints["distance"].as_f64().unwrap() - 0.01).abs() < 1e-4, "{joints:#}");
    assert!((joints["time"].as_f64().unwrap() - 7.0).abs() < 1e-2 && joints["sample"] == 2, "{joints:#}");
    // Both links are known, so the planned tip is on a circle about the shoulder, whose radius the elbow alone decides.
    let [a, b] = [1.0_f64, 0.8];
    let radius = |elbow: f64| (a * a + b * b + 2.0 * a * b * elbow.cos()).sqrt();
    let off = radius(0.4) - radius(0.41);
    assert!((tip["distance"].as_f64().unwrap() - off).abs() < 0.02 * off + 2e-5, "{tip:#} {off}");
    let (_, same) = verify(&place, "time,shoulder,elbow\n0,-0.9,0.4\n2,-0.5,0.4\n", "--plan plan.csv");
    assert!(same["plan"]["joints"]["distance"].as_f64().unwrap() < 1e-9, "{same:#}");
    let (_, without) = verify(&place, bump, "");
    assert!(without["plan"].is_null(), "{without:#}");
}

#[test]
fn a_motion_that_is_too_near_is_no_collision() {
    let place = Place::new();
    let table = "shoulder,elbow\n-0.9,0.4\n-0.8,0.4\n";
    let (_, free) = verify(&place, table, "");
    let least = -free["nearest"]["depth"].as_f64().unwrap();
    let (code, found) = verify(&place, table, &format!("--clearance {}", least + 4e-5));
    assert_eq!((code, &found["touches"]), (3, &false.into()), "{found:#}");
    let shortfall = found["shortfall"].as_f64().unwrap();
    assert!((shortfall - 4e-5).abs() < 1e-6, "{shortfall}");
    let clearance = format!("--anywhere --clearance {}", least + 4e-5);
    let text = verify_table(&place, SHELF, table, &clearance).stdout;
    let result = text.lines().next().unwrap();
    assert!(result.contains("by 0.040 mm") && result.contains("no collision: proven"), "{result}");
    let hit = "shoulder,elbow\n-0.9,0.4\n1.55,-0.35\n";
    for clearance in ["", "--clearance 0.01"] {
        let (code, found) = verify(&place, hit, clearance);
        assert_eq!((code, &found["touches"]), (3, &true.into()), "{found:#}");
    }
    let text = verify_table(&place, SHELF, hit, "--anywhere --clearance 0.01").stdout;
    assert_eq!(text.lines().next(), Some("result     collision: proven"), "{text}");
}
