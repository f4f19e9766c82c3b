//! Entities, units, blocks, layers and ends that meet.

use super::{area, assert_same_points, distance, drawing, length, near, notes, only_shape, ring, wall};
use cplan_cases::plane::distance_to_segment;
use cplan_drawing::{Drawing, Format, Geometry, Point, Settings, Shape, Unit, read};
use std::f64::consts::PI;

/// Returns a DXF in millimetres. Words are alternately codes and values.
pub fn file(blocks: &str, entities: &str) -> String {
    sections("9 $INSUNITS 70 4", "", blocks, entities)
}

fn sections(header: &str, tables: &str, blocks: &str, entities: &str) -> String {
    let section = |name: &str, text: &str| format!("0 SECTION 2 {name} {text} 0 ENDSEC ");
    let all = section("HEADER", header)
        + &section("TABLES", tables)
        + &section("BLOCKS", blocks)
        + &section("ENTITIES", entities)
        + "0 EOF";
    all.split_whitespace().map(|word| format!("{word}\n")).collect()
}

fn dxf(entities: &str) -> Drawing {
    drawing(&file("", entities), Format::Dxf)
}

const TOLERANCE: f64 = 1e-4;

/// Asserts that points lie on a circle, and that the middles of their chords lie near the circle and inside it.
fn on_circle(points: &[Point], center: Point, radius: f64) {
    for p in points {
        near(distance(*p, center), radius, 1e-12);
    }
    for w in points.windows(2) {
        let middle = [(w[0][0] + w[1][0]) / 2.0, (w[0][1] + w[1][1]) / 2.0];
        let short = radius - distance(middle, center);
        assert!((0.0..=TOLERANCE).contains(&short), "a chord is {short} m inside");
    }
}

#[test]
fn bulges_are_arcs_within_the_tolerance() {
    // A belt 500 long with round ends of radius 60.
    let belt = dxf("0 LWPOLYLINE 8 belt 90 4 70 1 10 150 20 240 10 650 20 240 42 1 10 650 20 360 10 150 20 360 42 1");
    let shape = only_shape(&belt);
    assert_eq!((shape.layer.as_deref(), shape.kind.as_str(), shape.line), (Some("belt"), "LWPOLYLINE", Some(28)));
    let ring = ring(shape);
    let exact = 0.5 * 0.12 + PI * 0.06 * 0.06;
    assert!(area(ring) <= exact && area(ring) > exact - PI * 0.12 * TOLERANCE, "{}", area(ring));
    let right: Vec<Point> = ring.iter().copied().filter(|p| p[0] >= 0.65 - 1e-12).collect();
    on_circle(&right, [0.65, 0.3], 0.06);
    assert!(right.len() > 5 && ring.len() < 100, "{} corners", ring.len());
    // Inwards: the same arcs to the other side.
    let waist = dxf("0 LWPOLYLINE 8 belt 70 1 10 150 20 240 10 650 20 240 42 -1 10 650 20 360 10 150 20 360 42 -1");
    let exact = 0.5 * 0.12 - PI * 0.06 * 0.06;
    let given = area(super::ring(only_shape(&waist)));
    assert!(given >= exact && given < exact + PI * 0.12 * TOLERANCE, "{given}");
}

#[test]
fn arcs_of_any_bulge_pass_where_they_must() {
    for bulge in [-30.0_f64, -1.0, -0.4, -0.01, 1e-7, 0.01, 0.4, 1.0, 3.0] {
        let arc = dxf(&format!("0 LWPOLYLINE 8 0 70 0 10 100 20 50 42 {bulge} 10 -200 20 450"));
        let points = wall(only_shape(&arc));
        assert_same_points(&[points[0], points[points.len() - 1]], &[[0.1, 0.05], [-0.2, 0.45]]);
        // The arc's middle is `bulge` half chords to the right of the chord; its length follows from its angle.
        let (chord, angle) = (0.5_f64, 4.0 * f64::atan(bulge.abs()));
        let exact = if angle < 1e-4 { chord } else { chord / (2.0 * (angle / 2.0).sin()) * angle };
        assert!(length(points) <= exact + 1e-12 && length(points) > exact * 0.98, "{bulge}: {}", length(points));
        let middle = [-0.05 + bulge * 0.25 * 0.8, 0.25 + bulge * 0.25 * 0.6];
        let nearest = points.iter().map(|p| distance(*p, middle)).fold(f64::INFINITY, f64::min);
        let step = points.windows(2).map(|w| distance(w[0], w[1])).fold(0.0, f64::max);
        assert!(nearest <= step / 2.0 + TOLERANCE, "{bulge}: {nearest}");
    }
}

#[test]
fn polylines_of_older_programs_equal_the_newer_form() {
    let new = dxf("0 LWPOLYLINE 8 a 70 1 10 0 20 0 10 100 20 0 42 0.5 10 100 20 100");
    let old = dxf("0 POLYLINE 8 a 66 1 70 1 0 VERTEX 8 a 10 0 20 0 0 VERTEX 10 100 20 0 42 0.5 \
                   0 VERTEX 70 16 10 7 20 7 0 VERTEX 10 100 20 100 0 SEQEND");
    assert_same_points(ring(only_shape(&old)), ring(only_shape(&new)));
    let mesh = dxf("0 POLYLINE 8 a 70 64 0 VERTEX 10 0 20 0 0 SEQEND 0 CIRCLE 8 a 10 0 20 0 40 1");
    assert_eq!(notes(&mesh), ["POLYLINE that is a mesh: left out (line 28)"]);
}

/// Returns the area of a polygon without its holes, and the number of holes.
fn area_and_hole_count(shape: &Shape) -> (f64, usize) {
    let Geometry::Polygon { outer, holes } = &shape.geometry else { panic!("{shape:?}") };
    (area(outer).abs() - holes.iter().map(|hole| area(hole).abs()).sum::<f64>(), holes.len())
}

#[test]
fn a_polyline_of_some_width_covers_it() {
    // Areas in mm2 by ezdxf's `TraceBuilder` and Shapely, and by hand: a bent piece covers its length times its mean
    // width.
    let quarters = 2.0 * PI * 50.0;
    for (corners, mm2, missing, holes) in [
        ("70 0 43 20 10 0 20 0 10 200 20 0 10 200 20 100", 6000.0, 0.0, 0),
        ("70 1 43 20 10 0 20 0 10 200 20 0 10 200 20 100 10 0 20 100", 12000.0, 0.0, 1),
        ("70 0 43 20 10 0 20 0 10 200 20 0 10 300 20 80", 6561.2496949731385, 0.0, 0),
        ("70 0 10 0 20 0 40 40 41 10 10 200 20 0", 5000.0, 0.0, 0),
        ("70 0 43 20 10 0 20 0 42 1 10 100 20 0", quarters / 2.0 * 20.0, 30.0, 0),
        ("70 0 10 0 20 0 40 20 41 60 42 0.5 10 100 20 0", 4636.476013758015, 30.0, 0),
        // AutoCAD's DONUT: a ring and a disc of 60 mm.
        ("70 1 43 20 10 -50 20 0 42 1 10 50 20 0 42 1", quarters * 20.0, 60.0, 1),
        ("70 1 43 60 10 -30 20 0 42 1 10 30 20 0 42 1", PI * 3600.0, 40.0, 0),
        // A line followed by an arc, and another line.
        ("70 0 43 20 10 0 20 0 10 100 20 0 42 1 10 100 20 100 10 0 20 100", 20.0 * (200.0 + PI * 50.0), 30.0, 0),
    ] {
        for entity in ["0 LWPOLYLINE 8 a ", "0 LWPOLYLINE 8 a 210 0 220 0 230 -1 "] {
            let given = dxf(&(entity.to_owned() + corners));
            let (covered, count) = area_and_hole_count(only_shape(&given));
            assert!((mm2 - missing - 1e-3..=mm2 + missing + 1e-3).contains(&(covered * 1e6)), "{corners}: {covered}");
            assert_eq!(count, holes, "{corners}");
            let output = "closed polylines with a width: read as frames of this width, with a free inside (line 28)";
            assert_eq!(notes(&given), vec![output; holes], "{corners}");
        }
    }
    // Older polylines have a width for all vertices, and one for single vertices. Ends are butt. The mitre of a sharp
    // corner is cut off.
    let old = dxf("0 POLYLINE 8 a 66 1 70 0 40 40 41 40 0 VERTEX 10 0 20 0 41 10 0 VERTEX 10 200 20 0 0 SEQEND");
    let trapezoid = ring(only_shape(&old));
    assert_eq!(trapezoid.iter().filter(|p| p[0] == 0.0 || p[0] == 0.2).count(), trapezoid.len());
    assert!(trapezoid.contains(&[0.0, 0.02]) && trapezoid.contains(&[0.2, -0.005]), "{trapezoid:?}");
    near(area_and_hole_count(only_shape(&old)).0, 0.005, 1e-12);
    let sharp = dxf("0 LWPOLYLINE 8 a 70 0 43 20 10 0 20 0 10 200 20 0 10 20 20 20");
    let farthest = ring(only_shape(&sharp)).iter().map(|p| p[0]).fold(0.0, f64::max);
    assert!((0.2..0.2012).contains(&farthest), "{farthest}");
    // A piece without width is still a line.
    let both = dxf("0 LWPOLYLINE 8 a 70 0 10 0 20 0 40 20 41 20 10 200 20 0 10 200 20 100 10 300 20 100");
    assert_eq!(both.shapes.len(), 2);
    assert_same_points(wall(&both.shapes[0]), &[[0.2, 0.0], [0.2, 0.1], [0.3, 0.1]]);
    near(area_and_hole_count(&both.shapes[1]).0, 0.004, 1e-12);
}

#[test]
fn circles_stay_circles_and_ellipses_are_within_the_tolerance() {
    let disc = dxf("0 CIRCLE 8 a 10 30 20 -40 40 25");
    assert_eq!(only_shape(&disc).geometry, Geometry::Circle { center: [0.03, -0.04], radius: 0.025 });
    // Half axes of 100 and 50, the longer one along (3, 4) / 5.
    let ellipse = dxf("0 ELLIPSE 8 a 10 10 20 20 11 60 21 80 40 0.5 41 0 42 6.283185307179586");
    let ring = ring(only_shape(&ellipse));
    let exact = PI * 0.1 * 0.05;
    assert!(area(ring) < exact && area(ring) > exact - 0.5 * TOLERANCE, "{}", area(ring));
    for p in ring {
        let [x, y] = [p[0] - 0.01, p[1] - 0.02];
        let [along, across] = [(0.6 * x + 0.8 * y) / 0.1, (0.6 * y - 0.8 * x) / 0.05];
        near(along.hypot(across), 1.0, 1e-12);
    }
    // A quarter of it, from the end of the long axis to that of the short.
    let quarter = dxf("0 ELLIPSE 8 a 10 0 20 0 11 60 21 80 40 0.5 41 0 42 1.5707963267948966");
    let points = wall(only_shape(&quarter));
    assert_same_points(&[points[0], points[points.len() - 1]], &[[0.06, 0.08], [-0.04, 0.03]]);
}

#[test]
fn an_arc_runs_counter_clockwise_and_across_zero() {
    let arc = dxf("0 ARC 8 a 10 100 20 0 40 50 50 350 51 100");
    let points = wall(only_shape(&arc));
    on_circle(points, [0.1, 0.0], 0.05);
    near(length(points), 0.05 * 110.0_f64.to_radians(), 1e-4);
    let at = |degrees: f64| [0.1 + 0.05 * degrees.to_radians().cos(), 0.05 * degrees.to_radians().sin()];
    assert_same_points(&[points[0], points[points.len() - 1]], &[at(350.0), at(100.0)]);
}

#[test]
fn splines_pass_where_their_definition_says() {
    // A Bézier curve: knots only at both ends.
    let curve = dxf("0 SPLINE 8 a 70 8 71 3 72 8 73 4 40 0 40 0 40 0 40 0 40 1 40 1 40 1 40 1 \
                     10 0 20 0 10 100 20 300 10 200 20 -300 10 300 20 0");
    let points = wall(only_shape(&curve));
    let bernstein = |t: f64| {
        let s = 1.0 - t;
        [0.3 * (s * s * t + 2.0 * s * t * t + t * t * t), 0.9 * (s * s * t - s * t * t)]
    };
    for k in 0..=1000 {
        let exact = bernstein(f64::from(k) / 1000.0);
        let off = points.windows(2).map(|w| distance_to_segment(exact, [w[0], w[1]])).fold(f64::INFINITY, f64::min);
        assert!(off <= TOLERANCE, "{off}");
    }
    // A quarter of a circle as a rational spline of degree 2, another one to come back: closed, a lens.
    let weight = 0.5_f64.sqrt();
    let quarter =
        |points: &str| format!("0 SPLINE 8 a 70 12 71 2 40 0 40 0 40 0 40 1 40 1 40 1 {points} 41 1 41 {weight} 41 1 ");
    let lens = quarter("10 50 20 0 10 50 20 50 10 0 20 50") + &quarter("10 0 20 50 10 0 20 0 10 50 20 0");
    let lens = dxf(&lens);
    let exact = 2.0 * (PI / 4.0 - 0.5) * 0.05 * 0.05;
    let given = area(ring(only_shape(&lens)));
    assert!(given <= exact && given > exact - 0.16 * TOLERANCE, "{given} against {exact}");
}

#[test]
fn splines_of_fit_points_agree_with_cad_programs() {
    // ezdxf's `fit_points_to_cad_cv`: points in the middle of each piece, and the length, mm.
    let by_ezdxf = [
        ("", [[21.883073, 55.606669], [93.993097, 50.592198], [172.24533, 40.524983]], 305.6862947934623),
        (
            "12 0 22 2 13 0.5 23 0",
            [[14.877077, 52.157546], [98.036154, 46.348697], [165.780538, 57.755407]],
            309.1909390573607,
        ),
    ];
    for (directions, middles, mm) in by_ezdxf {
        let fit = "11 0 21 0 11 50 21 80 11 50 21 80 11 140 21 20 11 200 21 90";
        let given = dxf(&format!("0 SPLINE 8 a 70 8 71 3 74 5 {directions} {fit}"));
        assert_eq!(notes(&given), [""; 0]);
        let points = wall(only_shape(&given));
        for exact in middles.map(|p: Point| p.map(|x| x / 1000.0)) {
            let off = points.windows(2).map(|w| distance_to_segment(exact, [w[0], w[1]])).fold(f64::INFINITY, f64::min);
            assert!(off <= TOLERANCE, "{off}");
        }
        let short = mm / 1000.0 - length(points);
        assert!((0.0..3e-4).contains(&short), "{short} m shorter than the curve");
    }
    // A closed spline through the four ends of a cross of half a metre. It consists of four Bézier curves whose inner
    // points are the corners of an octagon, (1, 1/2) and so on. So they surround 3.05 times the square of the half
    // metre. The first point may be given twice.
    for again in ["", "11 500 21 0"] {
        let cross = format!("0 SPLINE 8 a 70 11 71 3 11 500 21 0 11 0 21 500 11 -500 21 0 11 0 21 -500 {again}");
        let given = area(ring(only_shape(&dxf(&cross))));
        let exact = 3.05 * 0.25;
        assert!(given <= exact && given > exact - 3.2 * TOLERANCE, "{given} against {exact}");
    }
}

#[test]
fn ends_that_meet_are_joined_two_at_a_time() {
    // A D of three pieces in any order and direction, with a gap of a twentieth of a millimetre.
    let d = dxf("0 LINE 8 a 10 0 20 0 11 0 21 100 0 ARC 8 a 10 0 20 50 40 50 50 270 51 360 \
                 0 ARC 8 a 10 0 20 50.05 40 50 50 0 51 90");
    let exact = PI * 0.05 * 0.05 / 2.0;
    near(area(ring(only_shape(&d))).abs(), exact, 3e-5);
    assert_eq!(only_shape(&d).kind, "LINE and 2 more, joined end to end");
    assert_eq!(notes(&d), ["ends that are less than 0.0001 m apart: joined (line 28)"]);
    // A piece on another layer is not part of it.
    let d = dxf("0 LINE 8 b 10 0 20 0 11 0 21 100 0 ARC 8 a 10 0 20 50 40 50 50 270 51 90");
    assert_eq!(d.shapes.len(), 2);
    // A wall of two pieces. Where three ends meet, nothing is joined.
    let bend = dxf("0 LINE 8 a 10 0 20 0 11 100 21 0 0 LINE 8 a 10 100 20 100 11 100 21 0");
    assert_same_points(wall(only_shape(&bend)), &[[0.0, 0.0], [0.1, 0.0], [0.1, 0.1]]);
    let fork = dxf("0 LINE 8 a 10 0 20 0 11 100 21 0 0 LINE 8 a 10 100 20 100 11 100 21 0 \
                    0 LINE 8 a 10 100 20 0 11 200 21 0 0 LINE 8 a 10 200 20 0 11 300 21 9");
    let lengths: Vec<usize> = fork.shapes.iter().map(|shape| wall(shape).len()).collect();
    assert_eq!(lengths, [2, 2, 3]);
    // The ends are farther apart than the tolerance.
    let open = dxf("0 LWPOLYLINE 8 a 70 0 10 0 20 0 10 100 20 0 10 100 20 100 10 0 20 0.2");
    assert_eq!(wall(only_shape(&open)).len(), 4);
    let shut = dxf("0 LWPOLYLINE 8 a 70 0 10 0 20 0 10 100 20 0 10 100 20 100 10 0 20 0.05");
    assert_same_points(ring(only_shape(&shut)), &[[0.0, 0.0], [0.1, 0.0], [0.1, 0.1]]);
    // Shorter than the tolerance, and there and back.
    assert_eq!(wall(only_shape(&dxf("0 LINE 8 a 10 0 20 0 11 0.05 21 0"))).len(), 2);
    assert_eq!(dxf("0 LINE 8 a 10 0 20 0 11 9 21 0 0 LINE 8 a 10 9 20 0 11 0 21 0").shapes.len(), 1);
}

#[test]
fn blocks_go_where_their_insertions_say() {
    let blocks = "0 BLOCK 2 screw 10 1 20 1 0 LINE 8 0 10 1 20 1 11 3 21 1 0 LINE 8 steel 10 1 20 1 11 1 21 2 0 ENDBLK \
                  0 BLOCK 2 *U7 10 0 20 0 0 INSERT 8 0 2 SCREW 10 10 20 0 50 90 41 2 42 -3 0 ENDBLK";
    // The block is inserted directly, and within another block. By hand, the map there is
    // (x, y) -> (10 + 3 (y - 1), 2 (x - 1)), then scaled by 0.5 and moved.
    let twice = drawing(
        &file(blocks, "0 INSERT 8 fix 2 screw 10 100 20 200 0 INSERT 8 cell 2 *U7 10 -50 20 0 41 0.5 42 0.5"),
        Format::Dxf,
    );
    let shapes: Vec<_> =
        twice.shapes.iter().map(|s| (s.name.as_deref(), s.layer.as_deref(), wall(s).to_vec())).collect();
    let mm = |points: [Point; 2]| points.map(|[x, y]| [x / 1000.0, y / 1000.0]);
    let expected = [
        (Some("screw"), Some("fix"), mm([[100.0, 200.0], [102.0, 200.0]])),
        (Some("screw"), Some("steel"), mm([[100.0, 200.0], [100.0, 201.0]])),
        (Some("SCREW"), Some("cell"), mm([[-45.0, 0.0], [-45.0, 2.0]])),
        (Some("SCREW"), Some("steel"), mm([[-45.0, 0.0], [-43.5, 0.0]])),
    ];
    assert_eq!(shapes.len(), expected.len());
    for ((name, layer, points), (expected_name, expected_layer, expected)) in shapes.iter().zip(&expected) {
        assert_eq!(name.map(str::to_lowercase), expected_name.map(str::to_lowercase));
        assert_eq!(layer, expected_layer);
        assert_same_points(points, expected);
    }
}

#[test]
fn insertions_repeat_stretch_and_mirror_blocks() {
    let blocks = "0 BLOCK 2 pin 10 0 20 0 0 CIRCLE 8 0 10 0 20 0 40 10 0 ENDBLK";
    let pins = drawing(&file(blocks, "0 INSERT 8 a 2 pin 10 100 20 0 50 90 70 3 71 2 44 30 45 50"), Format::Dxf);
    let centers: Vec<Point> = pins
        .shapes
        .iter()
        .map(|shape| match shape.geometry {
            Geometry::Circle { center, .. } => center,
            _ => panic!("{shape:?}"),
        })
        .collect();
    // Turned by 90 degrees columns go up and rows to the left.
    assert_same_points(&centers, &[[0.1, 0.0], [0.1, 0.03], [0.1, 0.06], [0.05, 0.0], [0.05, 0.03], [0.05, 0.06]]);
    let flat = drawing(&file(blocks, "0 INSERT 8 a 2 pin 10 0 20 0 41 3"), Format::Dxf);
    near(area(ring(only_shape(&flat))), PI * 0.03 * 0.01, 0.13 * TOLERANCE);
    // Seen from below x is mirrored: circles by their centre, arcs by their direction.
    let below = dxf("0 CIRCLE 8 a 10 30 20 5 40 10 210 0 220 0 230 -1 0 ARC 8 b 10 50 20 0 40 20 50 0 51 90 230 -1");
    assert_eq!(below.shapes[0].geometry, Geometry::Circle { center: [-0.03, 0.005], radius: 0.01 });
    let points = wall(&below.shapes[1]);
    assert_same_points(&[points[0], points[points.len() - 1]], &[[-0.07, 0.0], [-0.05, 0.02]]);
    let tilted = dxf("0 CIRCLE 8 a 10 30 20 5 40 10 210 1 220 0 230 0");
    assert_eq!((tilted.shapes.len(), notes(&tilted)), (0, vec!["CIRCLE across the plane: left out (line 28)".into()]));
}

#[test]
fn units_come_from_the_file_or_the_user() {
    let line = "0 LINE 8 a 10 0 20 0 11 10 21 0";
    for (code, metres) in [(1, 0.254), (2, 3.048), (4, 0.01), (5, 0.1), (6, 10.0), (14, 1.0)] {
        let given = drawing(&sections(&format!("9 $INSUNITS 70 {code}"), "", "", line), Format::Dxf);
        near(wall(only_shape(&given))[1][0], metres, 1e-15);
    }
    let unsaid = drawing(&sections("9 $ACADVER 1 AC1015", "", "", line), Format::Dxf);
    assert_eq!(notes(&unsaid), ["the drawing does not state its unit: read as mm"]);
    let unknown = drawing(&sections("9 $INSUNITS 70 99", "", "", line), Format::Dxf);
    assert_eq!(notes(&unknown), ["$INSUNITS 99 is not a known unit: read as mm (line 8)"]);
    near(wall(only_shape(&unknown))[1][0], 0.01, 1e-15);
    let settings = Settings { unit: Some("in".parse::<Unit>().unwrap()), ..Settings::default() };
    let inches = read(file("", line).as_bytes(), Format::Dxf, &settings).unwrap();
    near(wall(only_shape(&inches))[1][0], 0.254, 1e-15);
    assert!("feet".parse::<Unit>().unwrap_err().to_string().contains("mm, cm"));
}

#[test]
fn layers_may_be_off_and_thickness_is_height() {
    let tables = "0 TABLE 2 LAYER 0 LAYER 2 Off 70 0 62 -3 0 LAYER 2 frozen 70 1 62 3 0 LAYER 2 on 70 0 62 3 0 ENDTAB";
    let entities = "0 CIRCLE 8 OFF 10 0 20 0 40 1 0 CIRCLE 8 frozen 10 0 20 0 40 1 0 CIRCLE 8 Defpoints 10 0 20 0 40 1 \
                    0 CIRCLE 8 on 10 0 20 0 30 20 39 80 40 1 0 LWPOLYLINE 8 on 38 5 39 -2 10 0 20 0 10 1 20 1";
    let given = drawing(&sections("9 $INSUNITS 70 4", tables, "", entities), Format::Dxf);
    let hidden: Vec<_> = given.shapes.iter().map(|shape| shape.hidden_by.as_deref()).collect();
    assert_eq!(hidden, [Some("OFF"), Some("frozen"), Some("Defpoints"), None, None]);
    let heights: Vec<_> = given.shapes.iter().map(|shape| shape.height).collect();
    assert_eq!(heights, [None, None, None, Some([0.02, 0.1]), Some([0.003, 0.005])]);
}

#[test]
fn an_insertion_hides_its_own_layer_or_all_if_that_is_frozen() {
    let tables =
        "0 TABLE 2 LAYER 0 LAYER 2 off 70 0 62 -7 0 LAYER 2 frozen 70 1 62 7 0 LAYER 2 both 70 1 62 -7 0 ENDTAB";
    // A block with something on its insertion's layer and on two layers of its own; and one that contains that block
    // and more.
    let blocks = "0 BLOCK 2 pin 10 0 20 0 0 CIRCLE 8 0 10 0 20 0 40 1 0 CIRCLE 8 on 10 5 20 0 40 1 \
                  0 CIRCLE 8 off 10 9 20 0 40 1 0 ENDBLK \
                  0 BLOCK 2 pair 10 0 20 0 0 INSERT 8 0 2 pin 10 0 20 0 0 INSERT 8 FROZEN 2 pin 10 0 20 9 0 ENDBLK";
    let hidden = |block: &str, layer: &str| {
        let insert = format!("0 INSERT 8 {layer} 2 {block} 10 0 20 0");
        let given = drawing(&sections("9 $INSUNITS 70 4", tables, blocks, &insert), Format::Dxf);
        given.shapes.iter().map(|shape| shape.hidden_by.clone().unwrap_or_default()).collect::<Vec<_>>()
    };
    assert_eq!(hidden("pin", "on"), ["", "", "off"]);
    assert_eq!(hidden("pin", "off"), ["off", "", "off"]);
    assert_eq!(hidden("pin", "frozen"), ["frozen"; 3]);
    assert_eq!(hidden("pin", "both"), ["both"; 3]);
    assert_eq!(hidden("pair", "on"), ["", "", "off", "FROZEN", "FROZEN", "FROZEN"]);
    assert_eq!(hidden("pair", "off"), ["off", "", "off", "FROZEN", "FROZEN", "FROZEN"]);
    assert_eq!(hidden("pair", "frozen"), ["frozen"; 6]);
}

#[test]
fn omitted_elements_are_noted() {
    let given = dxf("0 TEXT 8 a 10 0 20 0 1 HELLO 0 MTEXT 8 a 1 x 0 TEXT 8 a 1 y 0 HATCH 8 a 0 3DFACE 8 a \
                     0 LINE 67 1 8 a 10 0 20 0 11 1 21 1 0 INSERT 8 a 2 NOWHERE 10 0 20 0 0 CIRCLE 8 a 10 0 20 0 40 1 \
                     0 LINE 8 a 10 5 20 5 30 0 11 5 21 5 31 9");
    let expected = [
        "TEXT: left out (2 times, first in line 28)",
        "MTEXT: left out (line 38)",
        "HATCH: left out (line 50)",
        "3DFACE: left out (line 54)",
        "entities in paper space: left out (line 58)",
        "INSERT of block \"NOWHERE\", which the file does not contain: left out (line 72)",
        "LINE without extent: left out (line 92)",
    ];
    assert_eq!(notes(&given), expected);
    assert_eq!(given.shapes.len(), 1);
}

/// Returns the same file in the binary form, with codes of one or of two bytes.
fn binary(text: &str, is_wide: bool) -> Vec<u8> {
    let mut bytes = b"AutoCAD Binary DXF\r\n\x1a\0".to_vec();
    let lines: Vec<&str> = text.lines().collect();
    for pair in lines.chunks(2) {
        let code: i16 = pair[0].parse().unwrap();
        match u8::try_from(code) {
            Ok(code) if !is_wide => bytes.push(code),
            _ => {
                bytes.extend(if is_wide { &[][..] } else { &[255] });
                bytes.extend(code.to_le_bytes());
            }
        }
        match code {
            10..=59 | 210..=239 => bytes.extend(pair[1].parse::<f64>().unwrap().to_le_bytes()),
            60..=79 => bytes.extend(pair[1].parse::<i16>().unwrap().to_le_bytes()),
            90..=99 | 1071 => bytes.extend(pair[1].parse::<i32>().unwrap().to_le_bytes()),
            _ => bytes.extend(pair[1].bytes().chain([0])),
        }
    }
    bytes
}

#[test]
fn binary_files_equal_their_text_form() {
    let text = file(
        "0 BLOCK 2 plate 10 0 20 0 0 CIRCLE 8 0 10 5.25 20 -3 40 2.5 0 ENDBLK",
        "0 INSERT 8 jig 2 plate 10 100 20 50 50 30 1071 7 0 LWPOLYLINE 8 belt 90 3 70 1 10 0 20 0 10 40 20 0 10 0 20 30.5",
    );
    let expected = drawing(&text, Format::Dxf);
    for is_wide in [true, false] {
        let read = read(&binary(&text, is_wide), Format::Dxf, &Settings::default()).unwrap();
        assert_eq!(read.shapes, expected.shapes);
        // A file that is cut anywhere is refused.
        let whole = binary(&text, is_wide);
        for end in 0..whole.len() - 2 {
            assert!(cplan_drawing::read(&whole[..end], Format::Dxf, &Settings::default()).is_err(), "{end}");
        }
    }
}

#[test]
fn content_after_the_end_and_empty_circles_are_noted() {
    let text = file("", "0 CIRCLE 8 a 10 1 20 0 40 0 0 CIRCLE 8 a 10 1 20 0 40 5");
    let found = drawing(&(text.clone() + "sent by mail\nyours\n"), Format::Dxf);
    assert_eq!(found.shapes.len(), 1);
    let report = notes(&found);
    assert!(report.iter().any(|note| note.contains("CIRCLE of radius 0: left out")), "{report:?}");
    assert!(report.iter().any(|note| note.contains("text after EOF: left out")), "{report:?}");
    assert!(!notes(&drawing(&(text + "\n\u{1a}\n"), Format::Dxf)).iter().any(|note| note.contains("EOF")));
}

/// Tests three insertions: with a clip, with a clip that is switched off, and without a clip.
#[test]
fn clipped_blocks_are_noted() {
    let insert = |dictionary: &str| format!("0 INSERT 8 a 2 b {dictionary} 10 0 20 0 ");
    let own = |handle: &str| format!("102 {{ACAD_XDICTIONARY 360 {handle} 102 }}");
    let inserts = insert(&own("A1")) + &insert(&own("B1")) + &insert("");
    let chain = |name: &str, is_on: u8| {
        format!(
            "0 DICTIONARY 5 {name}1 3 ACAD_FILTER 360 {name}2 0 DICTIONARY 5 {name}2 3 SPATIAL 360 {name}3 \
             0 SPATIAL_FILTER 5 {name}3 71 {is_on} "
        )
    };
    let objects = format!(" 0 SECTION 2 OBJECTS {}{} 0 ENDSEC 0 EOF", chain("A", 1), chain("B", 0));
    let objects: String = objects.split_whitespace().map(|word| format!("{word}\n")).collect();
    let text = file("0 BLOCK 2 b 0 CIRCLE 8 0 10 5 20 0 40 2 0 ENDBLK", &inserts).replace("0\nEOF\n", &objects);
    let found = drawing(&text, Format::Dxf);
    assert_eq!(found.shapes.len(), 3);
    let clipped: Vec<String> = notes(&found).into_iter().filter(|note| note.contains("(XCLIP)")).collect();
    assert!(clipped.len() == 1 && !clipped[0].contains("times"), "{clipped:?}");
}
