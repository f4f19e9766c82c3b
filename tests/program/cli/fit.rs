//! `cplan follow --fit` from outside: placements against the tests' own kinematics.

use super::*;

/// A drawing of a frame, 300 mm wide and 200 mm high, and a stroke in it.
const FRAME: &str = "G21 G90 F6000\nG0 X0 Y0\nG1 X300\nG1 Y200\nG1 X0\nG1 Y0\nG0 X50 Y50\nG1 X150 Y100\n";

/// Walls beside the arm.
const WALLS: &str = "[[obstacle]]\nname = \"right\"\npolygon = [[0.9, -0.6], [1.1, -0.6], [1.1, 0.4], [0.9, 0.4]]\n\
    [[obstacle]]\nname = \"above\"\npolygon = [[-0.6, 1.0], [0.3, 1.0], [0.3, 1.2], [-0.6, 1.2]]\n";

fn follow(place: &Place, options: &str) -> Done {
    place.run(&["follow", &robot(), "world.toml", "line.gcode"], options)
}

/// The stated options repeat the motion, which keeps one side of the elbow, and whose tip draws the line at the placement.
#[test]
fn the_stated_options_repeat_the_motion() {
    let place = Place::new().with("line.gcode", FRAME);
    for (world, fit) in [("", "--fit"), ("", "--fit --turn 0.3"), (WALLS, "--fit"), (WALLS, "--fit=turn --scale 1.5")] {
        place.write("world.toml", world);
        let found = follow(&place, &format!("{fit} --json")).exits(0).json();
        let options = found["fit"]["options"].as_str().unwrap();
        let mut again = follow(&place, &format!("{options} --json")).exits(0).json();
        again["fit"] = found["fit"].clone();
        assert_eq!(found, again, "{world} {fit}");
        assert_eq!(found["changes"], Value::Array(vec![]));
        let [scale, turn] = ["scale", "turn"].map(|key| number(&found["fit"][key]));
        let shift = [0, 1].map(|k| number(&found["fit"]["move"][k]));
        let (sin, cos) = turn.sin_cos();
        let positions = found["trajectory"]["position"].as_array().unwrap();
        let poses: Vec<[f64; 2]> = positions.iter().map(|q| [0, 1].map(|k| number(&q[k]))).collect();
        assert!(poses.iter().all(|q| q[1].sin() * poses[0][1].sin() > 0.0), "one side of the elbow");
        for q in &poses {
            let at = tip(*q);
            let [x, y] = [0, 1].map(|k| (at[k] - shift[k]) / scale);
            let [x, y] = [x * cos + y * sin, y * cos - x * sin];
            let is_on = |x: f64, y: f64| {
                let on_frame = (x.abs().min((x - 0.3).abs()) < 1e-4 && (-1e-4..0.2001).contains(&y))
                    || (y.abs().min((y - 0.2).abs()) < 1e-4 && (-1e-4..0.3001).contains(&x));
                on_frame || (0.0..0.2).contains(&x) && (0.0..0.11).contains(&y)
            };
            assert!(is_on(x, y), "{x} {y}");
        }
    }
    // The summary states the options, too.
    follow(&place, "--fit=turn").exits(0).says(&["placed", "--move ", "found and certified"]);
}

/// A line has as much room as it can have: in an empty world, the middle of a short one is in the middle of the ring between
/// both ends of the reach, and no obstacle is nearer than the stated room.
#[test]
fn the_line_has_the_most_room() {
    let place = Place::new().with("line.gcode", "G21 G90 F6000\nG0 X0 Y0\nG1 X1\n").with("world.toml", "");
    let result = follow(&place, "--fit --json").exits(0).json();
    let [x, y] = [0, 1].map(|k| number(&result["fit"]["move"][k]));
    let (room, away) = (number(&result["fit"]["room"]), (x + 0.0005).hypot(y));
    // The reach is from 0.2 to 1.8 m, and the limits of the joints may cost more.
    assert!(room > 0.3 && room < 0.81 && (away - 0.2).min(1.8 - away) > room - 0.03, "{room} {away}");
}

#[test]
fn lines_that_fit_nowhere_are_proven_or_unknown() {
    let place = Place::new().with("world.toml", "").with("line.gcode", "G21 G90\nG0 X0 Y0\nG1 X3700 Y100\n");
    let large = follow(&place, "--fit=turn --json --certificate c.json").exits(3);
    let result = large.json();
    assert_eq!((&result["status"], &result["cause"]), (&"infeasible".into(), &"too_large".into()));
    assert!(!place.path("c.json").exists() && large.stderr.contains("c.json is not written"), "{}", large.stderr);
    follow(&place, "--fit").exits(3).says(&["infeasible: the line is too large: two of its points are", "3.6"]);
    // It is shorter than the reach is wide, but the arm would have to change its elbow.
    place.write("line.gcode", "G21 G90\nG0 X0 Y0\nG1 X3590\n");
    let done = follow(&place, "--fit --output m.csv").exits(4);
    done.says(&["unknown: no placement was found: even at the best placement, the line extends about 29."]);
    assert!(!place.path("m.csv").exists());
    follow(&place, "--fit --scale 0.2").exits(0);
    follow(&place, "--fit --move 0,1").refused(2, &["--fit", "--move"]);
    follow(&place, "--fit=turn --turn 1").refused(2, &["--fit=turn searches for the angle"]);
    follow(&place, "--fit=scale").refused(2, &["--fit"]);
}
