//! Arcs: circles, and spirals whose ends are not equally far from their centre.

use super::{near, program, refused};
use cplan_toolpath::Curve;
use std::f64::consts::TAU;

/// The file rounds the centre, so that the ends are not equally far from it. The radius changes linearly.
#[test]
fn arcs_join_their_ends_although_the_file_rounds_the_center() {
    let path = program("G21 G0 X0 Y0\nG2 X7.071 Y-2.929 I0.0004 J-10.0003\nG1 X10");
    let [arc, line] = path.pieces() else { panic!("two pieces") };
    assert!(near(arc.curve.start(), [0.0, 0.0]) && near(arc.curve.end(), line.curve.start()));
    assert!(near(line.curve.start(), [0.007071, -0.002929]));
    let center = [0.0000004, -0.0100003];
    let away = |u: f64| {
        let [x, y] = arc.curve.at(u);
        (x - center[0]).hypot(y - center[1])
    };
    for u in [0.1, 0.5, 0.9] {
        assert!((away(u) - (away(0.0) * (1.0 - u) + away(1.0) * u)).abs() < 1e-12);
    }
}

/// Chords of a micrometre made 81 nm of difference too much, because the test divided by the chord.
#[test]
fn short_arcs_may_end_at_another_radius() {
    let path = program("G21 G0 X10 Y0\nG3 X9.999919 Y0.001 I-10 J0\nG1 X0");
    assert!(near(path.pieces()[0].curve.end(), [0.009999919, 0.000001]));
}

#[test]
fn radii_may_differ_by_five_micrometres_or_a_thousandth() {
    let arc = |radius: f64, other: f64| format!("G21 G0 X{radius:.4} Y0\nG3 X0 Y{other:.4} I-{radius:.4} J0\n");
    for [radius, other] in [[1.0, 1.0049], [1.0, 0.9951], [100.0, 100.099], [100.0, 99.901], [0.01, 0.0149]] {
        let path = program(&arc(radius, other));
        assert!(near(path.start(), [radius / 1e3, 0.0]) && near(path.end(), [0.0, other / 1e3]), "{radius} {other}");
    }
    for [radius, other] in [[1.0, 1.0051], [1.0, 0.9949], [100.0, 100.101], [100.0, 99.899]] {
        let message = format!("G3 begins at a distance of {radius} mm from the centre, but ends at {other} mm");
        assert_eq!(refused(&arc(radius, other)).to_string(), message);
    }
    let inches = "G20 G0 X1 Y0\nG3 X0 Y1.0009 I-1 J0\n";
    assert!(near(program(inches).end(), [0.0, 1.0009 * 0.0254]));
}

#[test]
fn an_arc_that_ends_in_its_first_direction_is_a_whole_turn() {
    for (text, turns) in
        [("G3 X10.002 I-10", TAU), ("G2 X10.002 I-10", -TAU), ("G3 X10 Y0 I-10", TAU), ("G2 I-10 Z-1", -TAU)]
    {
        let path = program(&format!("G21 G0 X10 Y0\n{text}"));
        let Curve::Arc { by, .. } = path.pieces()[0].curve else { panic!("an arc") };
        assert_eq!(by, turns, "{text}");
    }
    // Relative moves add up to where they began, apart from rounding.
    let path = program("G21 G0 X0.1 Y0.2\nG91\nG1 X0.1 Y0.2\nG1 X-0.1 Y-0.2\nG90\nG3 X0.1 Y0.2 I-10\n");
    let Curve::Arc { by, .. } = path.pieces()[2].curve else { panic!("an arc") };
    assert_eq!(by, TAU);
}

#[test]
fn arcs_without_a_shape_are_refused() {
    let cases = [
        ("G2 X1", "G2 has neither a centre nor a radius"),
        ("G2 X1 I1 R1", "G2 has a centre and a radius"),
        ("G2 X10 R4", "G2 has ends 10 mm apart, more than twice its radius"),
        ("G2 R4", "G2 ends where it begins, so R does not determine the centre"),
        ("G3 X10 I4", "G3 begins at a distance of 4 mm from the centre, but ends at 6 mm"),
        ("G3 X10 I0", "G3 begins at a distance of 0 mm from the centre, but ends at 10 mm"),
    ];
    for (text, message) in cases {
        let error = refused(&format!("G0 X0 Y0\n{text}"));
        assert_eq!((error.line, error.column, error.to_string().as_str()), (Some(2), Some(1), message));
    }
}
