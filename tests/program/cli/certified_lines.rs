//! Certificates of motions along lines, and the verdict of the checker, which shares no code with the program.

use super::certificates::without_digests;
use super::*;
use cplan_cases::dice::Dice;

fn follow(place: &Place, robot: &str, world: &str, line: &str, options: &str) -> Done {
    place.run(&["follow", robot, world, line, "--quiet"], &format!("--certificate c.json {options}"))
}

/// The files of a certificate.
struct Judged {
    urdf: String,
    world: String,
    certificate: Value,
}

impl Judged {
    /// Follows a line, and returns the certificate. It checks the exit code.
    fn of(robot: &str, world: &str, line: &str, options: &str, code: i32) -> Self {
        let place = Place::new().with("world.toml", world).with("line.gcode", line);
        follow(&place, robot, "world.toml", "line.gcode", options).exits(code);
        let certificate = serde_json::from_str(&without_digests(&place.read("c.json"))).unwrap();
        Self { urdf: std::fs::read_to_string(robot).unwrap(), world: world.to_owned(), certificate }
    }

    fn verdict(&self) -> Result<String, CheckError> {
        check(&self.urdf, &self.world, &self.certificate.to_string())
    }

    /// Returns the checker's statement.
    fn proven(&self) -> String {
        self.verdict().unwrap_or_else(|why| panic!("{why}: {}", self.world))
    }

    /// Checks that the certificate does not hold with a change, for a reason that contains `why`.
    fn fails(&self, change: impl FnOnce(&mut Value), why: &str) {
        let mut certificate = self.certificate.clone();
        change(&mut certificate);
        match check(&self.urdf, &self.world, &certificate.to_string()) {
            Err(CheckError::Fails(reason)) => assert!(reason.contains(why), "{reason}, not: {why}"),
            other => panic!("{other:?}, not: {why}"),
        }
    }
}

fn plate() -> Judged {
    let text = |file: &str| read(shipped(&format!("workspaces/follow/{file}")));
    Judged::of(&robot(), &text("engraving.toml"), &text("plate.gcode"), "", 0)
}

#[test]
fn the_shipped_plate_has_a_certificate_that_holds() {
    let plate = plate();
    let proven = plate.proven();
    for part in [
        "a motion of \"shoulder\" and \"elbow\" leads the tip \"tool0\" along a line of 13 pieces, 2 of them travels, from \
         (1.100000, -0.150000) to (1.250000, 0.060000), within 0.00001 of the line and in its order, with clearance 0",
        "read as cubic or quartic",
    ] {
        assert!(proven.contains(part), "{proven}");
    }
    let pieces = plate.certificate["line"]["pieces"].as_array().unwrap();
    assert_eq!(pieces[0], json!({ "straight": [[1.1, -0.15], [1.28, -0.15]] }));
    assert_eq!(plate.certificate["line"]["travels"], json!([7, 11]));
}

#[test]
fn changed_motions_and_lines_are_refused() {
    let plate = plate();
    let count = plate.certificate["motion"]["knots"].as_array().unwrap().len();
    // The tip is 1.1 m or more from the first joint.
    for knot in [0, count / 3, count / 2, count - 1] {
        plate.fails(
            |c| {
                let value = c["motion"]["knots"][knot][1].as_f64().unwrap();
                c["motion"]["knots"][knot][1] = json!(value + 0.05e-3);
            },
            "not proven to stay within 0.00001 of piece",
        );
    }
    plate.fails(|c| c["line"]["tolerance"] = json!(6e-6), "not proven to stay within 0.000006 of piece");
    plate.fails(|c| c["line"]["pieces"][2]["straight"][1][0] = json!(1.30005), "piece 3 of the line does not begin");
    plate.fails(|c| c["line"]["pieces"].as_array_mut().unwrap().swap(0, 2), "of the line does not begin");
    plate.fails(|c| drop(c["line"]["pieces"].as_array_mut().unwrap().pop()), "are not the ends of the motion");
    plate.fails(|c| drop(c["line"]["places"].as_array_mut().unwrap().remove(count / 2)), "skips a knot");
    plate.fails(|c| drop(c["motion"]["knots"].as_array_mut().unwrap().pop()), "are not the ends of the motion");
    plate.fails(|c| c["clearance"] = json!(0.3), "is not proven to stay farther than 0.3 from obstacle 0");
    // The post moves into the plate.
    let world = plate.world.replace("[1.75, 0.55]", "[1.2, 0.0]");
    assert_ne!(world, plate.world);
    let moved = Judged { world, ..plate };
    assert!(matches!(moved.verdict(), Err(CheckError::Fails(why)) if why.contains("from obstacle 1")));
}

/// Two squares that share a corner: the same path of the tip in another order of the pieces.
#[test]
fn the_order_of_the_line_counts() {
    let squares = "G21 F60000\nG0 X1000 Y0\nG1 X1100\nY100\nX1000\nY0\nG1 X900\nY-100\nX1000\nY0\n";
    let judged = Judged::of(&robot(), "", squares, "", 0);
    judged.proven();
    let swapped = |c: &mut Value| {
        let pieces = c["line"]["pieces"].as_array_mut().unwrap();
        pieces.rotate_left(4);
    };
    judged.fails(swapped, "not proven to stay within");
    // Backwards along both squares, each piece is joined to the next.
    let reversed = |c: &mut Value| {
        let pieces = c["line"]["pieces"].as_array_mut().unwrap();
        pieces.reverse();
        pieces.iter_mut().for_each(|piece| piece["straight"].as_array_mut().unwrap().reverse());
    };
    judged.fails(reversed, "not proven to stay within");
}

/// The ends of the arc are not equally far from its centre, so that its radius changes.
#[test]
fn arcs_of_a_changing_radius_have_certificates() {
    let judged = Judged::of(&robot(), "", "G21\nG0 X1200 Y0\nG3 X1100 Y-100.09 I-100\nG1 X1200\n", "", 0);
    judged.proven();
    let growth = judged.certificate["line"]["pieces"][0]["arc"]["growth"].as_f64().unwrap();
    assert!((growth - 0.09e-3).abs() < 1e-12, "{growth}");
    let without = |c: &mut Value| drop(c["line"]["pieces"][0]["arc"].as_object_mut().unwrap().remove("growth"));
    judged.fails(without, "of the line does not begin");
    // The same arc at another distance from its centre.
    judged.fails(
        |c| {
            let arc = &mut c["line"]["pieces"][0]["arc"];
            (arc["radius"], arc["growth"]) = (json!(0.1 + 1.5 * growth), json!(-0.5 * growth));
        },
        "not proven to stay within",
    );
}

/// All shapes of lines, with each kind of arm, and with limited jerk.
#[test]
fn every_kind_of_line_and_arm_has_a_certificate_that_holds() {
    let line = "G21 F6000\nG0 X800 Y200\nG1 X900\nG3 X1000 Y300 J100\nG0 X900 Y250\nG2 I-20\nG1 X900 Y220\nX880 Y210\n";
    let jerk = "[robot]\njerk = { shoulder = 200, elbow = 200 }\n";
    for (robot, world, options, reading) in [
        ("planar_2r", "", "", "quartic"),
        ("planar_2r", jerk, "--tolerance 0.0001", "quintic"),
        ("planar_2r", "", "--tolerance 0.001 --scale 0.5 --turn 30deg --move 0.4,0", "quartic"),
        ("planar_2r_continuous", "", "--turn 2.8", "quartic"),
        ("polar", "", "--scale 0.5 --move 0.3,0", "quartic"),
        ("rail_arm", "", "--scale 0.5", "quartic"),
        ("gantry", "", "--scale 0.2", "quartic"),
    ] {
        let robot = shipped(&format!("robots/{robot}.urdf"));
        let judged = Judged::of(&robot, world, line, options, 0);
        let proven = judged.proven();
        assert!(proven.contains("a line of 6 pieces, 1 of them travels") && proven.contains(reading), "{proven}");
        judged.fails(|c| c["line"]["tolerance"] = json!(1e-7), "not proven to stay within 0.0000001 of piece");
    }
    let place = Place::new();
    place.write(
        "line.svg",
        "<svg xmlns='http://www.w3.org/2000/svg' width='1000mm' height='1000mm' viewBox='0 0 1000 1000'>\
         <path d='M 700 800 C 900 500 1000 900 800 400 S 600 300 700 700'/><path d='M 500 300 C 700 300 500 300 700 400'/></svg>",
    );
    place.write("world.toml", "");
    follow(&place, &robot(), "world.toml", "line.svg", "--output r.json").exits(0);
    let proven = check(&read(robot()), "", &place.read("c.json")).unwrap();
    assert!(proven.contains("leads the tip") && place.read("c.json").contains("cubic"), "{proven}");
    // A certificate can be a member of the result.
    place
        .run(&["follow", &robot(), "world.toml", "line.svg", "--quiet"], "--output r.json --certificate r.json")
        .exits(0);
    let result = place.json("r.json");
    assert_eq!(result["certificate"], place.json("c.json"));
    assert_eq!(check(&read(robot()), "", &place.read("r.json")).unwrap(), proven);
}

#[test]
fn lines_out_of_reach_have_certificates() {
    let judged = Judged::of(&robot(), "", "G21 G0 X1100 Y0\nG1 X1400\nG1 X1900\n", "", 3);
    let proven = judged.proven();
    assert!(proven.contains("the tip cannot come within 0.00001 of (1.900000, 0.000000)"), "{proven}");
    judged.fails(|c| c["line"]["stretch"] = json!([1, 1]), "not prove that the tip cannot follow");
    judged.fails(|c| c["line"]["tolerance"] = json!(0.11), "not prove that the tip cannot follow");
}

#[test]
fn excluded_places_have_certificates() {
    let world = "[[obstacle]]\nname = \"above\"\npolygon = [[0.2, 0.3], [1.0, 0.3], [1.0, 0.6], [0.2, 0.6]]\n\
                 [[obstacle]]\nname = \"below\"\npolygon = [[0.2, -0.6], [1.0, -0.6], [1.0, -0.3], [0.2, -0.3]]\n";
    let judged = Judged::of(&robot(), world, "G21 G0 X1000 Y-100\nG1 Y100\n", "", 3);
    let proven = judged.proven();
    assert!(proven.contains(": from (1.000000, -0.1"), "{proven}");
    judged.fails(|c| drop(c["boxes"].as_array_mut().unwrap().pop()), "not prove that the tip cannot follow");
    judged.fails(|c| c["line"]["tolerance"] = json!(0.2), "not prove that the tip cannot follow");
    judged.fails(|c| c["boxes"][0]["upper"][0] = json!(3.0), "does not touch the part everywhere");
    // The clearance of the command line is part of the claim.
    let near = world.replace("0.3]", "0.33]").replace("-0.3]", "-0.33]");
    let judged = Judged::of(&robot(), &near, "G21 G0 X1000 Y-100\nG1 Y100\n", "--clearance 0.1", 3);
    assert!(judged.proven().contains("with clearance 0.1"));
}

/// Each end of the line allows only one IK solution, and the arm cannot change it between them.
#[test]
fn lines_that_need_a_change_of_the_solution_have_certificates() {
    let world = "[robot.limits]\nshoulder = [-0.2, 3]\nelbow = [-1, 3]\n";
    let line = "G21 G0 X808.1 Y1018.3\nG1 X1540 Y840\nG1 X1650 Y0\n";
    let judged = Judged::of(&robot(), world, line, "", 3);
    let proven = judged.proven();
    assert!(proven.contains("keeps the tip within 0.00001 of the line"), "{proven}");
    let stretch = judged.certificate["line"]["stretch"].clone();
    assert!(stretch[0].as_f64().unwrap() + 0.5 < stretch[1].as_f64().unwrap(), "{stretch}");
    judged.fails(|c| c["line"]["stretch"][1] = stretch[0].clone(), "not prove that the tip cannot follow");
    let wide = Judged { world: world.replace("-1", "-2"), ..judged };
    assert!(matches!(wide.verdict(), Err(CheckError::Fails(_))));
}

#[test]
fn unknown_answers_have_no_certificate() {
    let place = Place::new();
    // The end is out of reach by hardly less than the tolerance.
    place.write("long.gcode", "G21 G0 X1500 Y0\nG1 X1800.00999\n");
    let line = place.path("long.gcode").display().to_string();
    let done = follow(&place, &robot(), &shipped("workspaces/follow/engraving.toml"), &line, "").exits(4);
    done.warns(&["c.json is not written: the answer is \"unknown\""]);
    assert!(!place.path("c.json").exists());
    place.write("line.gcode", "G21 G0 X1100 Y-150\nG1 X1200\n");
    place.write("world.toml", "");
    place
        .run(&["follow", &robot(), "world.toml", "line.gcode"], "--certificate line.gcode")
        .refused(1, &["line.gcode is the input"]);
}

/// Returns a line of a few straight pieces, travels and arcs, in millimetres.
fn random_line(dice: &mut Dice) -> String {
    let (far, angle) = (dice.within(300.0, 1700.0), dice.within(-2.8, 2.8));
    let mut at = [far * angle.cos(), far * angle.sin()];
    let mut text = format!("G21 F6000\nG0 X{:.4} Y{:.4}\n", at[0], at[1]);
    for k in 0..1 + dice.below(4) {
        let size = [300.0, 300.0, 30.0, 3.0][dice.below(4)];
        let next = at.map(|c| c + size * dice.within(-1.0, 1.0));
        let radius = dice.within(0.51, 3.0) * (next[0] - at[0]).hypot(next[1] - at[1]);
        text += &match dice.below(5) {
            0 if k > 0 => format!("G0 X{:.4} Y{:.4}\n", next[0], next[1]),
            1 => format!("G2 X{:.4} Y{:.4} R{radius:.4}\n", next[0], next[1]),
            2 => format!("G3 X{:.4} Y{:.4} R{:.4}\n", next[0], next[1], -radius),
            _ => format!("G1 X{:.4} Y{:.4}\n", next[0], next[1]),
        };
        at = next;
    }
    text
}

fn random_world(dice: &mut Dice) -> String {
    let disc = |dice: &mut Dice| {
        let (far, angle) = (dice.within(0.35, 1.6), dice.within(-3.2, 3.2));
        let radius = dice.within(0.02, 0.2).min(far - 0.2);
        format!(
            "[[obstacle]]\ncircle = {{ center = [{:?}, {:?}], radius = {radius:?} }}\n",
            far * angle.cos(),
            far * angle.sin()
        )
    };
    (0..dice.below(4)).map(|_| disc(dice)).collect()
}

#[test]
fn every_answer_about_random_lines_has_a_certificate_that_holds() {
    let mut answers = [0, 0, 0];
    for seed in cplan_cases::seeds(60) {
        let mut dice = cplan_cases::dice(seed);
        let (line, world) = (random_line(&mut dice), random_world(&mut dice));
        let robot = shipped(["robots/planar_2r.urdf", "robots/planar_2r_continuous.urdf"][dice.below(2)]);
        let options = ["", "--tolerance 0.0001", "--tolerance 0.0005 --clearance 0.02"][dice.below(3)];
        let place = Place::new().with("world.toml", &world).with("line.gcode", &line);
        let done = follow(&place, &robot, "world.toml", "line.gcode", options);
        let code = done.code;
        answers[match code {
            0 => 0,
            3 => 1,
            4 => 2,
            _ => panic!("{seed}: {}{line}", done.stderr),
        }] += 1;
        if code != 4 {
            let urdf = read(&robot);
            let proven = check(&urdf, &world, &place.read("c.json"));
            let proven = proven.unwrap_or_else(|why| panic!("{seed}: {why}\n{line}{world}"));
            assert!(proven.starts_with(if code == 0 { "a motion" } else { "no motion" }), "{seed}: {proven}");
        }
    }
    println!("found, infeasible, unknown: {answers:?}");
    assert!(answers[0] >= 15 && answers[1] >= 10 && answers[2] <= 5, "{answers:?}");
}

/// The tip turns back within the tolerance at the beginning. The checker pairs the ways there and back with the line.
#[test]
fn lines_there_and_back_have_certificates_that_hold() {
    for (size, tolerance) in [(8e-5, 1e-5), (8e-5, 1e-4), (1e-3, 1e-5), (1e-3, 1e-4), (5e-3, 1e-5)] {
        let line = format!("G21 G90 F600\nG0 X1000 Y100\nG1 X{}\nG1 X1000\nG3 X1030 Y130 R-40\n", 1000.0 + size);
        Judged::of(&robot(), "", &line, &format!("--tolerance {tolerance}"), 0).proven();
    }
}

/// Hooks, hairpins and closings far below the tolerance, beside corners and travels.
#[test]
fn lines_with_tiny_pieces_have_certificates_that_hold() {
    for seed in cplan_cases::seeds(12) {
        let mut dice: Dice = cplan_cases::dice(seed);
        let (mut text, mut at) = ("G21 G90 F6000\nG0 X1000 Y0\n".to_owned(), [1000.0, 0.0]);
        for _ in 0..6 {
            at = at.map(|x| x + dice.within(-3.0, 3.0));
            let word = if dice.chance(0.2) { "G0" } else { "G1" };
            text += &format!("{word} X{} Y{}\n", at[0], at[1]);
            let size = 10_f64.powf(dice.within(-7.0, -2.5));
            for _ in 0..1 + dice.within(0.0, 4.0) as usize {
                let aside = at.map(|x| x + dice.within(-size, size));
                text += &format!("G1 X{} Y{}\n", aside[0], aside[1]);
            }
        }
        Judged::of(&robot(), "", &text, "", 0).proven();
    }
}
