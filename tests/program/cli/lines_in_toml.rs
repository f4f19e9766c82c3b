//! Lines in TOML from outside: in `cplan follow`, and as steps of tasks.

use super::*;
use std::f64::consts::PI;

fn follow(place: &Place, line: &str, options: &str) -> Done {
    let [robot, world] = files("follow/engraving");
    place.write("line.toml", line);
    place.run(&["follow", &robot, &world, "line.toml"], options)
}

/// Returns the positions of the tip at the samples of a result.
fn tips(result: &Value) -> Vec<[f64; 2]> {
    let positions = result["trajectory"]["position"].as_array().unwrap();
    positions.iter().map(|q| tip([0, 1].map(|k| number(&q[k])))).collect()
}

#[test]
fn an_arc_is_followed_at_its_own_speed_and_tolerance() {
    let place = Place::new();
    let arc = "arc = [[1.2, 0.0], [1.25, 0.05], [1.3, 0.0]]\nspeed = 0.05\ntolerance = 1e-4\n";
    let result = follow(&place, arc, "--json").json();
    assert_eq!((number(&result["tolerance"]), number(&result["line"]["pieces"])), (1e-4, 1.0));
    // Half a circle of 50 mm at 50 mm/s.
    assert!((number(&result["line"]["length"]) - 0.05 * PI).abs() < 1e-12);
    assert!((PI..PI + 0.1).contains(&number(&result["duration"])), "{}", result["duration"]);
    assert!(tips(&result).iter().all(|[x, y]| ((x - 1.25).hypot(*y) - 0.05).abs() < 1e-4));
    // The command line overrides both, and places the line once more.
    let result = follow(&place, arc, "--json --tolerance 0.00002 --speed 0.1 --move 0,-0.1").json();
    assert_eq!(number(&result["tolerance"]), 2e-5);
    assert!((PI / 2.0..PI / 2.0 + 0.1).contains(&number(&result["duration"])), "{}", result["duration"]);
    assert!(tips(&result).iter().all(|[x, y]| ((x - 1.25).hypot(y + 0.1) - 0.05).abs() < 2e-5));
}

#[test]
fn lines_name_files_beside_them() {
    let place = Place::new().with("part.gcode", "G21 G0 X0 Y0\nG1 X100 F6000\n");
    let result =
        follow(&place, "file = \"part.gcode\"\nscale = 0.5\nturn = \"90deg\"\nmove = [1.2, 0]\n", "--json").json();
    let tips = tips(&result);
    let [first, last] = [tips[0], tips[tips.len() - 1]];
    assert!((first[0] - 1.2).hypot(first[1]) < 1e-8 && (last[0] - 1.2).hypot(last[1] - 0.05) < 1e-8, "{last:?}");
}

#[test]
fn defects_have_their_place_and_a_hint() {
    let place = Place::new();
    for (line, parts) in [
        ("points = [[1, 0], [1.1, 0]]\npoint = 1", ["line 2, column 1: unknown key `point`", "hint: "]),
        ("points = [[1, 0], [1.1, \"a\"]]", ["line 1, column 25", "hint: "]),
        ("arc = [[1, 0], [1.1, 0], [1.2, 0]]", ["on a straight line", "hint: write the straight line as points"]),
        ("tolerance = 1e-4", ["exactly one of `file`, `points`, `arc` and `spline`, but has 0", "hint: follow = {"]),
    ] {
        let done = follow(&place, line, "");
        assert_eq!((done.code, done.stdout.as_str()), (1, ""), "{line}");
        done.warns(&parts);
    }
    follow(&place, "points = [[1, 0], [1.1, 0]]", "--unit mm").exits(2).warns(&["leave out --unit"]);
}

#[test]
fn a_task_follows_lines_of_all_kinds() {
    let place = Place::new();
    let files = [shipped("robots/planar_2r.urdf"), shipped("workspaces/follow/badge.toml")];
    place.run(&[&files[0], &files[1]], "--output badge.json --output badge.yaml --quiet").exits(0);
    let result = place.json("badge.json");
    let steps = result["steps"].as_array().unwrap();
    let lines: Vec<&Value> = steps.iter().filter(|step| step["action"] == "follow").collect();
    assert_eq!((steps.len(), lines.len()), (9, 4));
    for (line, tolerance) in lines.iter().zip([1e-5, 1e-4, 1e-5, 1e-5]) {
        let deviation = number(&line["deviation"]);
        assert!(deviation > 0.0 && deviation <= tolerance, "{deviation}");
    }
    assert!(steps.iter().all(|step| (step["action"] == "follow") == step.get("deviation").is_some()));
    // The outline is passed at 0.3 m/s: 1.4 m less what the corners save.
    let seconds = number(&lines[0]["arrival"]) - number(&lines[0]["begin"]);
    assert!((4.4..4.8).contains(&seconds), "{seconds}");
    place.run(&["verify", &files[0], &files[1], "badge.json"], "").exits(0).says(&["free: the whole task, 9 steps"]);
    // A sample of the outline is moved by a tenth of a millimetre.
    let mut moved = result.clone();
    let sample = (steps[1]["first_sample"].as_u64().unwrap() + steps[1]["last_sample"].as_u64().unwrap()) / 2;
    let value = &mut moved["trajectory"]["position"][sample as usize][0];
    *value = (number(value) + 1e-4).into();
    place.write("moved.json", moved.to_string());
    let refused = place.run(&["verify", &files[0], &files[1], "moved.json"], "");
    assert!(refused.code != 0 && refused.stdout.contains("from the line"), "{} {}", refused.code, refused.stdout);
}

#[test]
fn a_task_with_lines_has_a_certificate() {
    let place = Place::new();
    let files = [shipped("robots/planar_2r.urdf"), shipped("workspaces/follow/badge.toml")];
    place.run(&[&files[0], &files[1]], "--certificate c.json --output badge.json --quiet").succeeds_silently();
    place.run(&["verify", &files[0], &files[1], "badge.json"], "--certificate v.json").exits(0);
    for certificate in ["c.json", "v.json"] {
        let done = place.run(&["recheck", &files[0], &files[1], "--proof", certificate], "").exits(0);
        done.says(&[
            "does all 9 steps",
            "in step 4 the tip follows a line of 1 piece from",
            "within 0.0001 of the line",
        ]);
        // The checker reads the arc of step 4 from the world.
        assert_eq!(done.stdout.matches("as the certificate states it").count(), 3, "{}", done.stdout);
    }
    // A sample of the last line is moved by a tenth of a millimetre.
    let mut moved: Value = place.json("c.json");
    let knots = &moved["steps"][7]["knots"];
    let middle = (knots[0].as_u64().unwrap() + knots[1].as_u64().unwrap()) / 2;
    let value = &mut moved["motion"]["knots"][middle as usize][1];
    *value = (number(value) + 1e-4).into();
    place.write("moved.json", moved.to_string());
    let refused = place.run(&["recheck", &files[0], &files[1], "--proof", "moved.json"], "").exits(1);
    refused.warns(&["step 8: after knot ", "the tip is not proven to stay within 0.00001 of piece "]);
}

/// Runs a task for a shipped robot, and returns its files.
fn task(place: &Place, robot: &str, world: &str) -> [String; 2] {
    place.write("world.toml", world);
    let files = [shipped(&format!("robots/{robot}.urdf")), "world.toml".to_owned()];
    place.run(&files, "--output result.json --quiet").exits(0);
    files
}

#[test]
fn results_with_limited_jerks_are_verified() {
    let place = Place::new();
    let world = "[robot]\njerk = { turret = 133.78, ram_slide = 73.4 }\n[start]\njoints = [0.38, 0.03]\n[[step]]\n\
                 follow = { points = [[-0.6437, -0.5701], [-0.6062, -0.6006], [-0.6348, -0.5798], [-0.6064, -0.5662]], \
                 tolerance = 1e-4, speed = 0.5 }\n";
    let [robot, world] = task(&place, "polar", world);
    let verified = place.run(&["verify", &robot, &world, "result.json"], "").exits(0);
    verified.says(&["free: the whole task, 2 steps"]);
    verified.says(&["steps[..].deviation"]);
}

#[test]
fn a_tip_faster_than_its_line_is_refused() {
    let place = Place::new();
    let world =
        "[start]\njoints = [-0.9, 1.6]\n[[step]]\nfollow = { points = [[1.1, -0.15], [1.4, -0.15]], speed = 0.3 }\n";
    let [robot, _] = task(&place, "planar_2r", world);
    place.write("slow.toml", world.replace("0.3", "0.1"));
    let refused = place.run(&["verify", &robot, "slow.toml", "result.json"], "");
    assert!(refused.code != 0 && refused.stdout.contains("faster than 0.1 m/s"), "{}", refused.stdout);
}

#[test]
fn a_line_that_fails_is_not_explained_as_a_free_motion() {
    let place = Place::new().with(
        "far.toml",
        "[start]\njoints = [0.3, 1.2]\n[[step]]\nfollow = { arc = [[1.2, -1.2], [1.9, 0], [1.2, 1.2]] }\n",
    );
    let explained = place.run(&["explain", &shipped("robots/planar_2r.urdf"), "far.toml"], "").exits(3);
    explained.says(&["step 2, follow a line", "99.99 mm out of reach", "`cplan follow` names the place"]);
}

#[test]
fn a_certificate_with_a_negative_tolerance_is_refused() {
    let place = Place::new();
    let done = follow(&place, "points = [[1.5, 0], [1.9, 0]]", "--certificate c.json --quiet");
    assert_eq!(done.code, 3, "{}", done.stderr);
    let files = [shipped("robots/planar_2r.urdf"), shipped("workspaces/follow/engraving.toml")];
    place.run(&["recheck", &files[0], &files[1]], "--proof c.json").exits(0);
    let mut certificate: Value = place.json("c.json");
    certificate["line"]["tolerance"] = (-0.5).into();
    place.write("negative.json", certificate.to_string());
    let refused = place.run(&["recheck", &files[0], &files[1]], "--proof negative.json").exits(1);
    refused.warns(&["tolerance must be above 0"]);
}
