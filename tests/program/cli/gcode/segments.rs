//! Firmwares that divide lines into a number of segments per second, against the tests' own machine.

use super::*;

/// Rates, segments per second.
const RATES: [f64; 4] = [0.5, 1.5, 5.0, 100.0];

/// A straight move with all that determines its segments.
struct Drawn {
    own: Move,
    /// Difference of heights, millimetres.
    rise: f32,
    /// Millimetres per minute.
    feed: f32,
}

/// Returns the number of segments, as the firmware computes it: in single precision and millimetres.
fn count(drawn: &Drawn, rate: f64, is_marlin: bool) -> u32 {
    let Drawn { own, rise, feed } = drawn;
    let flat = 1e3 * distance(own.from, own.to) as f32;
    let length = if is_marlin { flat.hypot(*rise) } else { flat };
    let seconds = length / (feed / 60.0);
    match is_marlin {
        true => (rate as f32 * seconds).min(length / 0.5) as u32,
        false => (rate as f32 * seconds).min(length / 0.2).round_ties_even() as u32,
    }
    .max(1)
}

/// Plays a move in segments on which the joints move straight. Returns the least distance; `None` out of reach or limits.
fn in_segments(machine: &Machine, own: &Move, count: u32, is_left: bool) -> Option<f64> {
    let at = |k: u32| machine.turned(machine.solve(own.at(f64::from(k) / f64::from(count)), is_left)?);
    let places: Option<Vec<Point>> = (0..=count).map(at).collect();
    let places = places?;
    Some(places.windows(2).map(|pair| machine.straight([pair[0], pair[1]])).fold(f64::INFINITY, f64::min))
}

#[test]
fn segments_follow_from_length_and_speed() {
    let place = Place::new();
    let (mut agreed, mut only_in_segments) = ([0; 2], 0);
    for case in 0..cplan_cases::times(150) {
        let mut dice = dice(0x5e97_0000 + case);
        let machine = Machine { motor: None, ..machine(&mut dice) };
        let round = |x: f64| (x * 1e6).round() / 1e6;
        let point = |dice: &mut Dice| {
            let (angle, away) = (dice.within(-1.5, 1.5), dice.within(0.2, 0.42));
            [round(away * angle.cos()), round(away * angle.sin())]
        };
        let (from, to) = (point(&mut dice), point(&mut dice));
        let (rise, feed) = (dice.within(-40.0, 40.0).round(), dice.within(1000.0, 15000.0).round());
        let [[a, b], [c, d]] = [from, to].map(|p| p.map(|x| round(1e3 * x)));
        let text = format!("G21 G90\nG0 X{a} Y{b} Z50\nG1 X{c} Y{d} Z{} F{feed}\n", 50.0 + rise);
        let own = Move { line: 3, from, to, kind: 1, center: [0.0; 2] };
        let drawn = Drawn { own, rise: rise as f32, feed: feed as f32 };
        let (rate, is_marlin, is_left) = (RATES[dice.below(4_usize)], dice.chance(0.5), dice.chance(0.5));
        place.write("arm.urdf", machine.urdf());
        place.write("world.toml", machine.world());
        place.write("job.gcode", &text);
        let (dialect, side) = (if is_marlin { "marlin" } else { "duet" }, if is_left { "left" } else { "right" });
        let options = format!("--check --quiet --dialect {dialect} --elbow {side} --segments-per-second {rate}");
        let done = place.run(&["gcode", "arm.urdf", "world.toml", "job.gcode"], &options);
        let least = in_segments(&machine, &drawn.own, count(&drawn, rate, is_marlin), is_left);
        match least {
            None | Some(..=0.0) => assert_ne!(done.code, 0, "{case}: {text} {options} {least:?}"),
            Some(1e-3..) if done.code == 4 => {}
            Some(1e-3..) => assert_eq!(done.code, 0, "{case}: {text} {options} {least:?} {}", done.stderr),
            _ => continue,
        }
        let exact = machine.play(&drawn.own, is_left).is_ok();
        agreed[usize::from(done.code == 0)] += 1;
        only_in_segments += usize::from(exact != (done.code == 0));
    }
    if cplan_cases::uses_default_cases() {
        assert!(agreed[0] > 10 && agreed[1] > 10 && only_in_segments > 2, "{agreed:?} {only_in_segments}");
    }
}

#[test]
fn the_number_of_segments_needs_a_speed_and_a_height() {
    let place = Place::new();
    let files = ["robots/scara.urdf", "workspaces/gcode/labels.toml"].map(shipped);
    let run = |text: &str, options: &str| {
        place.write("job.gcode", text);
        place.run(&["gcode", &files[0], &files[1], "job.gcode"], &format!("--check {options}"))
    };
    let text = "G21 G90\nG0 X240 Y265\nG1 Y275\n";
    run(text, "--segments-per-second 100").refused(1, &["job.gcode: line 3: no speed is stated before this move"]);
    run(text, "--segments-per-second 100 --dialect klipper").refused(2, &["klipper does not divide lines"]);
    run(text, "--segments-per-second 0").refused(2, &["--segments-per-second"]);
    run(text, "--min-segment 1mm").refused(2, &["--segments-per-second"]);
    let unknown = "G21 G90\nG0 X240 Y265 F3000\nG1 Y275 Z1\n";
    run(unknown, "--segments-per-second 100").exits(4).says(&["depends on the height (Z)"]);
    let done = run(unknown, "--segments-per-second 100 --dialect duet --segment 2mm --min-segment 1mm --json").exits(0);
    assert_eq!(done.json()["segments_per_second"], 100.0);
    // The speed also holds for travels, and for arcs the length counts.
    run("G21 G90\nG0 X240 Y265 F3000\nG0 X250\nG3 J10\n", "--segments-per-second 100").exits(0);
}
