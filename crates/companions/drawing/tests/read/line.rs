//! Tests of reading SVG outlines as lines.

use cplan_drawing::read_line;
use cplan_toolpath::{Curve, Placement, Toolpath};
use std::f64::consts::{PI, TAU};

fn drawing(content: &str) -> Toolpath {
    let text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200mm\" height=\"100mm\" viewBox=\"0 0 200 100\">\n{content}\n</svg>"
    );
    read_line(text.as_bytes(), &Placement::default()).expect("a line")
}

fn near(a: [f64; 2], b: [f64; 2]) -> bool {
    (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9
}

#[test]
fn paths_keep_their_curves_with_y_upwards() {
    let path = drawing("<path d=\"M 10 90 L 30 90 C 40 90 50 80 50 70 Q 50 60 60 60\" fill=\"none\"/>");
    let [line, cubic, raised] = path.pieces() else { panic!("three pieces: {:?}", path.pieces()) };
    assert!(near(line.curve.start(), [0.01, 0.01]) && near(line.curve.end(), [0.03, 0.01]));
    let Curve::Cubic(points) = cubic.curve else { panic!("a cubic") };
    assert!(points.iter().zip([[0.03, 0.01], [0.04, 0.01], [0.05, 0.02], [0.05, 0.03]]).all(|(a, b)| near(*a, b)));
    // The quadratic curve at its middle is (a + 2 b + c) / 4.
    assert!(near(raised.curve.at(0.5), [(0.05 + 2.0 * 0.05 + 0.06) / 4.0, (0.03 + 2.0 * 0.04 + 0.04) / 4.0]));
    assert_eq!(line.source.line, 2);
}

#[test]
fn circles_and_circular_arcs_are_arcs() {
    let path = drawing("<circle cx=\"50\" cy=\"50\" r=\"20\"/>\n<path d=\"M 100 50 a 10 10 0 0 1 20 0\"/>");
    let [circle, travel, arc] = path.pieces() else { panic!("three pieces: {:?}", path.pieces()) };
    let Curve::Arc { center, radius, by, .. } = circle.curve else { panic!("an arc") };
    // SVG draws circles clockwise on the page with y downwards, so they turn clockwise here too.
    assert!(near(center, [0.05, 0.05]) && (radius - 0.02).abs() < 1e-12 && (by + TAU).abs() < 1e-12);
    assert!(travel.is_travel && near(travel.curve.start(), [0.07, 0.05]) && near(travel.curve.end(), [0.1, 0.05]));
    let Curve::Arc { by, .. } = arc.curve else { panic!("an arc") };
    assert!((by + PI).abs() < 1e-9 && near(arc.curve.at(0.5), [0.11, 0.06]) && near(arc.curve.end(), [0.12, 0.05]));
    assert_eq!((circle.source.line, arc.source.line), (2, 3));
}

#[test]
fn ellipses_are_cubics_that_stay_on_them() {
    let path = drawing("<ellipse cx=\"100\" cy=\"50\" rx=\"60\" ry=\"20\"/>");
    assert_eq!(path.pieces().len(), 32);
    for piece in path.pieces() {
        for k in 0..=20 {
            let [x, y] = piece.curve.at(f64::from(k) / 20.0);
            let level = ((x - 0.1) / 0.06).hypot((y - 0.05) / 0.02);
            assert!((level - 1.0).abs() < 1e-8, "{level}");
        }
    }
}

#[test]
fn closed_outlines_come_back_and_transforms_apply() {
    let path =
        drawing("<g transform=\"translate(100 50) scale(2)\"><rect x=\"0\" y=\"0\" width=\"10\" height=\"5\"/></g>");
    let points: Vec<_> = path.pieces().iter().map(|piece| piece.curve.end()).collect();
    let corners = [[0.12, 0.05], [0.12, 0.04], [0.1, 0.04], [0.1, 0.05]];
    assert!(points.len() == 4 && points.iter().zip(corners).all(|(a, b)| near(*a, b)), "{points:?}");
    let rounded = drawing("<rect x=\"10\" y=\"10\" width=\"40\" height=\"20\" rx=\"5\"/>");
    assert_eq!(rounded.pieces().iter().filter(|piece| matches!(piece.curve, Curve::Arc { .. })).count(), 4);
    assert!((rounded.length() - (0.06 + 0.02 + TAU * 0.005)).abs() < 1e-12);
}

#[test]
fn outlines_have_a_stretch_for_each_element() {
    let path =
        drawing("<polyline points=\"0,0 10,0 10,10\" fill=\"none\"/><line x1=\"50\" y1=\"0\" x2=\"60\" y2=\"0\"/>");
    assert_eq!(path.outlines(1e-4).iter().map(Vec::len).collect::<Vec<_>>(), [3, 2]);
    assert_eq!(path.pieces().iter().map(|piece| piece.is_travel).collect::<Vec<_>>(), [false, false, true, false]);
}

#[test]
fn broken_and_empty_drawings_are_refused() {
    let refuse = |text: &str| read_line(text.as_bytes(), &Placement::default()).expect_err("an error");
    let empty = refuse("<svg xmlns=\"http://www.w3.org/2000/svg\"/>");
    assert_eq!(empty.to_string(), "the file has no line");
    assert!(empty.hint.contains("<path") && !empty.hint.contains("G1"), "{empty:?}");
    let error = refuse("<svg xmlns=\"http://www.w3.org/2000/svg\">\n<path d=\"M 0 0 L 1 nonsense\"/></svg>");
    assert!(error.line == Some(2) && error.to_string().starts_with("path data:"), "{error:?}");
    assert_eq!(refuse("G0 X0").line, Some(1));
}

/// The control points cross over, so the curve turns back in a cusp at its middle, at (40, 77.5) of the page.
#[test]
fn cubics_are_cut_at_their_cusps() {
    let path = drawing("<path d=\"M 30 70 C 50 80 30 80 50 70\" fill=\"none\"/>");
    let [first, second] = path.pieces() else { panic!("two pieces: {:?}", path.pieces()) };
    assert!(near(first.curve.end(), [0.04, 0.0225]) && first.curve.end() == second.curve.start());
    assert!(near(second.curve.end(), [0.05, 0.03]));
    // Both parts together are the whole curve: halves of the parameter.
    let whole = Curve::Cubic([[0.03, 0.03], [0.05, 0.02], [0.03, 0.02], [0.05, 0.03]]);
    for k in 0..=20 {
        let u = f64::from(k) / 20.0;
        let part = if u <= 0.5 { first.curve.at(2.0 * u) } else { second.curve.at(2.0 * u - 1.0) };
        assert!(near(part, whole.at(u)), "{u}");
    }
    let smooth = drawing("<path d=\"M 30 70 C 40 80 50 80 60 70\" fill=\"none\"/>");
    assert_eq!(smooth.pieces().len(), 1);
}
