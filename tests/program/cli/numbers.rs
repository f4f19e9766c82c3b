//! Numbers in messages: different numbers look different, and zero has no sign.

use super::*;
/// Returns a world with a wall just beyond the stretched arm.
fn wall(x: f64) -> String {
    format!(
        "[start]\njoints = [0.0, 0.0]\n[goal]\njoints = [0.0, 0.5]\n[[obstacle]]\npolyline = [[{x}, -0.02], [{x}, 0.0]]\n"
    )
}

#[test]
fn a_tiny_clearance_is_no_zero() {
    let place =
        Place::new().with("world.toml", wall(1.800_000_6)).with("motion.csv", "shoulder,elbow\n0,0\n0,0.0000001\n");
    let robot = shipped("robots/planar_2r.urdf");
    let report = place.run(&["verify", &robot, "world.toml", "motion.csv"], "--anywhere").stdout;
    assert!(!report.contains("-0.0000") && !report.contains(" 0.000 mm proven"), "{report}");
    assert!(report.contains("e-4 mm proven") || report.contains("e-4 mm apart"), "{report}");
}

#[test]
fn a_value_just_beyond_a_limit_is_printed_differently() {
    let place = Place::new().with("world.toml", FREE);
    let robot = shipped("robots/planar_2r.urdf");
    let report = place.run(&["check", &robot, "world.toml"], "--at -2.900001,-0.0").stdout;
    let limits = "shoulder: -166.15782 deg (-2.900001 rad) is OUTSIDE -166.15776 deg (-2.900000 rad) to 166.15776 deg";
    assert!(report.contains(limits), "{report}");
    assert!(report.contains("elbow: 0.00 deg (0.0000 rad) is within"), "{report}");
    let sliding = read(&robot);
    let sliding =
        sliding.replace("type=\"revolute\"", "type=\"prismatic\"").replacen("xyz=\"0 0 1\"", "xyz=\"1 0 0\"", 1);
    let sliding = sliding.replacen("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 1 0\"/>", 1);
    place.write("gantry.urdf", sliding.replace("lower=\"-2.9\" upper=\"2.9\"", "lower=\"0\" upper=\"1\""));
    let report = place.run(&["check", "gantry.urdf", "world.toml"], "--at -1e-6,0").stdout;
    assert!(report.contains("-0.000001 m is OUTSIDE 0.000000 m to 1.000000 m"), "{report}");
}

#[test]
fn a_point_just_out_of_reach_is_printed_differently() {
    let done = Place::new().plan(FREE, "--goal-tip 1.8000001,0");
    done.refused(1, &["1.8000001 m from joint", "the tip reaches from 0.2000000 to 1.8000000 m"]);
}

#[test]
fn bounds_on_numbers_are_stated() {
    let place = Place::new();
    let far = format!("{FREE}[[obstacle]]\ncircle = {{ center = [2e6, 0.0], radius = 1.0 }}\n");
    place.plan(far, "").refused(1, &["2000000 is too large (at most 1e6)", "from -1e6 to 1e6"]);
}
