//! Machines whose coordinates are not those of the world.

use super::*;

/// Returns a move of the file at its place in the world, with coordinates turned by 90 degrees and then moved.
fn placed(own: &Move, shift: Point) -> Move {
    let at = |[x, y]: Point| [shift[0] - y, shift[1] + x];
    Move { from: at(own.from), to: at(own.to), center: at(own.center), ..own.clone() }
}

/// Travels of a turned and moved program are replaced as those of one in the coordinates of the world.
#[test]
fn turned_and_moved_programs_are_safe() {
    let place = Place::new();
    let shift = [0.013, -0.02];
    let mut counts = [0; 3];
    for case in 0..cplan_cases::times(25) {
        let mut dice = dice(0x91ac_0000 + case);
        let (machine, text) = (machine(&mut dice), program(&mut dice));
        // The program is about coordinates of the world, so its file has those that the placement leads there.
        let back = |[x, y]: Point| [y - shift[1], shift[0] - x];
        let mut file = "G21 G90\n".to_owned();
        let own = moves(&text);
        for (k, one) in own.iter().enumerate() {
            let [from, to, center] = [one.from, one.to, one.center].map(back);
            let [i, j] = [0, 1].map(|k| 1e3 * (center[k] - from[k]));
            if k == 0 {
                writeln!(file, "G0 X{:.7} Y{:.7}", 1e3 * from[0], 1e3 * from[1]).unwrap();
            }
            write!(file, "G{} X{:.7} Y{:.7}", one.kind, 1e3 * to[0], 1e3 * to[1]).unwrap();
            writeln!(file, "{}", if one.kind > 1 { format!(" I{i:.7} J{j:.7}") } else { String::new() }).unwrap();
        }
        place.write("arm.urdf", machine.urdf());
        place.write("world.toml", machine.world());
        place.write("job.gcode", &file);
        let options = "--output safe.gcode --json --dialect klipper --turn 90deg --move 0.013,-0.02";
        let done = place.run(&["gcode", "arm.urdf", "world.toml", "job.gcode"], options);
        let result = done.json();
        counts[[0, 3, 4].iter().position(|code| *code == done.code).expect("an answer")] += 1;
        if done.code == 0 {
            let written = place.read("safe.gcode");
            assert_eq!(without_travels(&file), without_travels(&written));
            let mut last: Option<Point> = None;
            for own in moves(&written).iter().map(|own| placed(own, shift)) {
                let played = machine.play(&own, result["elbow"] == "left");
                let (ends, least) = played.unwrap_or_else(|stop| panic!("{case}: {stop:?} {own:?}\n{written}"));
                assert!(least > 0.0 && last.is_none_or(|last| distance(last, ends[0]) < 1e-5), "{case}: {own:?}");
                last = Some(ends[1]);
            }
        }
        // Places of faults are those of the world.
        for failed in result["lines"]["failed"].as_array().unwrap().iter().filter(|failed| failed["proven"] == true) {
            if ["out_of_reach", "collision"].contains(&failed["cause"].as_str().unwrap()) {
                holds(&machine, &file, failed, result["elbow"] == "left", 0.0);
            }
        }
    }
    if cplan_cases::uses_default_cases() {
        assert!(counts[0] > 5 && counts[1] > 3, "{counts:?}");
    }
}

/// The place of homing is in the coordinates of the file, and so are displacements.
#[test]
fn homing_and_displacements_count_in_the_file() {
    let place = Place::new();
    let files = ["robots/scara.urdf", "workspaces/gcode/labels.toml"].map(shipped);
    let run = |text: &str, options: &str| {
        place.write("job.gcode", text);
        place.run(&["gcode", &files[0], &files[1], "job.gcode"], &format!("--output safe.gcode {options}"))
    };
    let whole = run("G21 G91\nG1 X5 Y0\nG0 X-480 Y0\nG1 Y10\n", "--home 0.235,0.265 --dialect grbl");
    let safe = place.read("safe.gcode");
    let moved = run("G21 G91\nG1 X5 Y0\nG0 X-480 Y0\nG1 Y10\n", "--home 0.035,0.065 --move 0.2,0.2 --dialect grbl");
    assert_eq!((whole.code, moved.code, safe), (0, 0, place.read("safe.gcode")));
    // A place outside is named in the world.
    let done = run("G21 G90\nG0 X0 Y0\nG1 X5\n", "--move 0.7,0 --dialect grbl --json").exits(3).json();
    let place = done["lines"]["failed"][0]["place"].as_array().unwrap();
    assert!(place[0].as_f64().unwrap() > 0.69, "{done}");
}
