//! Values, placements and curves.

use super::{near, program, refused};
use cplan_toolpath::{Curve, Format, Placement, read};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

#[test]
fn moves_have_their_ends_speeds_and_places() {
    let path =
        program("%\nN10 G21 G90 G17\ng0 x 10 y20 ; to the start\nG1 X30 F600 (cut)\nY-5.5\nG0 X0 Y0\nG1 X1\nM30\nX9");
    let ends: Vec<_> = path.pieces().iter().map(|piece| piece.curve.end()).collect();
    let expected = [[0.03, 0.02], [0.03, -0.0055], [0.0, 0.0], [0.001, 0.0]];
    assert!(ends.len() == 4 && ends.iter().zip(expected).all(|(a, b)| near(*a, b)), "{ends:?}");
    assert!(near(path.start(), [0.01, 0.02]));
    let speeds: Vec<_> = path.pieces().iter().map(|piece| piece.speed).collect();
    assert_eq!(speeds, [Some(0.01), Some(0.01), None, Some(0.01)]);
    let travels: Vec<_> = path.pieces().iter().map(|piece| piece.is_travel).collect();
    assert_eq!(travels, [false, false, true, false]);
    let places: Vec<_> = path.pieces().iter().map(|piece| (piece.source.line, piece.source.column)).collect();
    assert_eq!(places, [(4, Some(1)), (5, Some(1)), (6, Some(1)), (7, Some(1))]);
    assert_eq!(path.notes(), ["words without effect on the line: G17 (1)"]);
    assert!((path.length() - (0.02 + 0.0255 + 0.03_f64.hypot(0.0055) + 0.001)).abs() < 1e-12);
}

#[test]
fn inches_and_relative_moves() {
    let path = program("G20 G91\nG0 X1\nG1 X0.5 F60\nX0.5 Y1\nG90 X0 Y0");
    let ends: Vec<_> = path.pieces().iter().map(|piece| piece.curve.end()).collect();
    let expected = [[0.0381, 0.0], [0.0508, 0.0254], [0.0, 0.0]];
    assert!(ends.len() == 3 && ends.iter().zip(expected).all(|(a, b)| near(*a, b)), "{ends:?}");
    assert!((path.pieces()[0].speed.expect("a speed") - 0.0254).abs() < 1e-15);
}

#[test]
fn a_file_without_a_unit_is_in_millimetres_and_has_a_note() {
    let path = program("G0 X0 Y0\nG1 X100");
    assert!((path.length() - 0.1).abs() < 1e-15);
    assert_eq!(path.notes(), ["the file states no unit (G20 or G21): read as mm"]);
    let metres = Placement { unit: "m".parse().ok(), ..Placement::default() };
    let path = read(b"G20\nG0 X0 Y0\nG1 X0.5 F60", Format::GCode, &metres).expect("a line");
    assert!((path.length() - 0.5).abs() < 1e-15 && path.pieces()[0].speed == Some(1.0));
}

#[test]
fn arcs_by_center_and_by_radius() {
    let arc = |text: &str| program(&format!("G21 G0 X10 Y0\n{text}")).pieces()[0].curve;
    let check = |curve: Curve, center: [f64; 2], by: f64| {
        let Curve::Arc { center: c, by: b, .. } = curve else { panic!("an arc") };
        assert!(near(c, center) && (b - by).abs() < 1e-9, "{curve:?}");
        assert!(near(curve.start(), [0.01, 0.0]));
    };
    check(arc("G3 X0 Y10 I-10 J0"), [0.0, 0.0], FRAC_PI_2);
    check(arc("G2 X0 Y10 I-10"), [0.0, 0.0], -3.0 * FRAC_PI_2);
    check(arc("G3 I-10"), [0.0, 0.0], TAU);
    check(arc("G2 I-10"), [0.0, 0.0], -TAU);
    check(arc("G3 X0 Y10 R10"), [0.0, 0.0], FRAC_PI_2);
    check(arc("G2 X0 Y10 R-10"), [0.0, 0.0], -3.0 * FRAC_PI_2);
    check(arc("G2 X0 Y10 R10"), [0.01, 0.01], -FRAC_PI_2);
    check(arc("G3 X-10 R10"), [0.0, 0.0], PI);
}

#[test]
fn a_placement_scales_turns_and_moves() {
    let placement = Placement { scale: 2.0, turn: FRAC_PI_2, shift: [1.0, -1.0], ..Placement::default() };
    let path = read(b"G21 G0 X100 Y0\nG1 X200 F600\nG3 X300 Y100 J100", Format::GCode, &placement).expect("a line");
    assert!(near(path.start(), [1.0, -0.8]) && near(path.pieces()[0].curve.end(), [1.0, -0.6]));
    assert!(near(path.pieces()[1].curve.end(), [0.8, -0.4]));
    assert_eq!(path.pieces()[0].speed, Some(0.01));
}

#[test]
fn files_without_a_line_are_refused() {
    for text in ["", "G0 X0 Y0", "G0 X0 Y0\nG1 X0", "G0 X0 Y0\nG0 X5"] {
        let error = refused(text);
        assert_eq!(error.to_string(), "the file has no line", "{text}");
        assert!(error.hint.contains("G1"), "{error:?}");
    }
    assert_eq!(refused("G0 X0 Y0\nG1 X1e3").to_string(), "X1 has an exponent, and numbers of G-code have none");
    let far = refused("G0 X0 Y0\nG1 X99999999999");
    assert_eq!((far.line, far.to_string().as_str()), (Some(2), "the line has a coordinate beyond 1e6 m"));
    let bytes = read(&[b'G', b'0', b'\n', 0xff], Format::GCode, &Placement::default()).expect_err("an error");
    assert_eq!(bytes.line, Some(2));
}

proptest! {
    #![proptest_config(cplan_cases::cases(256))]

    /// Compares the nearest place on a curve with dense samples.
    #[test]
    fn the_nearest_place_is_the_nearest(
        points in prop::array::uniform4(prop::array::uniform2(-1.0..1.0_f64)), point in prop::array::uniform2(-1.0..1.0_f64),
        kind in 0..3_usize, turn in -3.0..3.0_f64,
    ) {
        let curve = match kind {
            0 => Curve::Line { from: points[0], to: points[1] },
            _ => {
                let radius = points[1][0].abs() + 0.1;
                // A spiral's foot is near the place in the same direction from the centre.
                let growth = if kind == 2 { 1e-7 * radius } else { 0.0 };
                Curve::Arc { center: points[0], radius, from: points[2][0], by: turn, growth }
            }
        };
        prop_assume!(curve.length() > 1e-3);
        let far = |u: f64| { let p = curve.at(u); (p[0] - point[0]).hypot(p[1] - point[1]) };
        // An arc is searched for half a turn, and its other end may be nearer than its start.
        let sampled = (0..=1000).map(|k| far(f64::from(k) / 1000.0)).fold(f64::INFINITY, f64::min);
        let found = far(curve.nearest(point, 0.0));
        prop_assert!(found <= sampled + 1e-9 || (kind > 0 && found <= far(0.0) + 1e-9), "{found} {sampled}");
    }

    /// Compares derivative and bend with differences.
    #[test]
    fn derivatives_agree_with_differences(
        points in prop::array::uniform4(prop::array::uniform2(-1.0..1.0_f64)), u in 0.01..0.99_f64, turn in 0.1..6.0_f64,
    ) {
        let curves = [
            Curve::Line { from: points[0], to: points[1] },
            Curve::Arc { center: points[0], radius: points[1][0].abs(), from: points[2][0], by: turn, growth: 0.0 },
            Curve::Arc { center: points[0], radius: 1.0, from: points[2][0], by: turn, growth: points[1][0] },
            Curve::Cubic(points),
        ];
        for curve in curves {
            let step = 1e-4;
            let [before, here, after] = [u - step, u, u + step].map(|u| curve.at(u));
            let derivative = curve.derivative(u);
            let second = [0, 1].map(|k| (before[k] - 2.0 * here[k] + after[k]) / (step * step));
            for k in 0..2 {
                prop_assert!(((after[k] - before[k]) / (2.0 * step) - derivative[k]).abs() < 1e-5);
            }
            prop_assert!(second[0].hypot(second[1]) <= curve.bend() * (1.0 + 1e-6) + 1e-6);
        }
    }
}

#[test]
fn travels_at_both_ends_are_left_out_with_a_note() {
    let text = "G21 G0 X0 Y0\nG0 X10\nG1 X20\nG0 X0\nG0 Y5\n";
    let path = read(text.as_bytes(), Format::GCode, &Placement::default()).unwrap();
    assert_eq!(path.pieces().len(), 1);
    let notes = ["1 travel (G0) before the first piece left out", "2 travels (G0) after the last piece left out"];
    assert_eq!(path.notes(), notes);
}
