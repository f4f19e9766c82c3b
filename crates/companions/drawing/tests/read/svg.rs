//! Tests of elements, transforms, sizes, styles and fill rules.

use super::{area, assert_same_points, distance, drawing, length, near, notes, only_shape, ring, wall};
use cplan_drawing::{Drawing, FillRule, Format, Geometry, Point, Settings, filled, read};
use std::f64::consts::PI;

/// Reads elements on a page of 1 m by 1 m with millimetres as units.
fn svg(elements: &str) -> Drawing {
    let head = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' \
                xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' \
                width='1000mm' height='100cm' viewBox='0 0 1000 1000'>";
    drawing(&format!("{head}{elements}</svg>"), Format::Svg)
}

/// Converts the page's millimetres, downwards, to metres, upwards.
fn in_metres(points: &[Point]) -> Vec<Point> {
    points.iter().map(|[x, y]| [x / 1000.0, 1.0 - y / 1000.0]).collect()
}

const TOLERANCE: f64 = 1e-4;

#[test]
fn basic_shapes_are_where_they_are_drawn() {
    let all = svg("<rect id='r' x='10' y='20' width='100' height='50'/><polygon points='0,0 10,0 10,10'/>\
                   <line x1='0' y1='1' x2='20' y2='1'/><polyline fill='none' points='0,0 5,5 9,0'/>\
                   <circle cx='100' cy='100' r='30'/>");
    assert_same_points(ring(&all.shapes[0]), &in_metres(&[[10.0, 20.0], [110.0, 20.0], [110.0, 70.0], [10.0, 70.0]]));
    assert_same_points(ring(&all.shapes[1]), &in_metres(&[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]]));
    assert_same_points(wall(&all.shapes[2]), &in_metres(&[[0.0, 1.0], [20.0, 1.0]]));
    assert_same_points(wall(&all.shapes[3]), &in_metres(&[[0.0, 0.0], [5.0, 5.0], [9.0, 0.0]]));
    let Geometry::Circle { center, radius } = all.shapes[4].geometry else { panic!("{all:?}") };
    assert_same_points(&[center], &in_metres(&[[100.0, 100.0]]));
    near(radius, 0.03, 1e-15);
    assert_eq!(all.shapes[0].name.as_deref(), Some("r"));
    assert_eq!(notes(&all), [""; 0]);
    let ellipse = svg("<ellipse cx='500' cy='500' rx='300' ry='100'/>");
    near(area(ring(only_shape(&ellipse))).abs(), PI * 0.3 * 0.1, 1.4 * TOLERANCE);
    let rounded = svg("<rect width='200' height='100' rx='20'/>");
    near(area(ring(only_shape(&rounded))).abs(), 0.02 - (4.0 - PI) * 0.02 * 0.02, 0.13 * TOLERANCE);
}

#[test]
fn every_path_command_is_drawn() {
    // Lines of all kinds, absolute and relative, twice closed.
    let lines = svg("<path d='M10 10 h20 v20 l-20 0 z m100,0 H130 V 30 L110 30Z'/>");
    let rings: Vec<_> = lines.shapes.iter().map(ring).collect();
    assert_eq!(rings.iter().map(|ring| (area(ring).abs() * 1e6).round()).collect::<Vec<_>>(), [400.0, 400.0]);
    // A circle by two arcs, and by one with flags written together.
    for d in ["M100 200a100 100 0 1 0 200 0a100 100 0 1 0-200 0", "M200 100A100 100 0 11199.9999 100z"] {
        let circle = svg(&format!("<path d='{d}'/>"));
        let given = area(ring(only_shape(&circle))).abs();
        assert!(given < PI * 0.01 && given > PI * 0.01 - 0.63 * TOLERANCE, "{d}: {given}");
        for p in ring(only_shape(&circle)) {
            near(distance(*p, [0.2, 0.8]), 0.1, 1e-6);
        }
    }
    // An arc of a rotated ellipse: its ends are given, and its points fit the equation.
    let arc = svg("<path fill='none' d='M500 400 A 200 100 30 0 1 600 300'/>");
    let points = wall(only_shape(&arc));
    assert_same_points(&[points[0], points[points.len() - 1]], &in_metres(&[[500.0, 400.0], [600.0, 300.0]]));
    assert!(length(points) > 0.1 * 2.0_f64.sqrt() && points.len() > 5);
    // The area below a parabola by a quadratic curve is two thirds of its box; the smooth ones repeat it upside down.
    let parabola = svg("<path d='M0 100 Q 100 -100 200 100 z'/>");
    let given = area(ring(only_shape(&parabola))).abs();
    assert!(given <= 0.02 * 2.0 / 3.0 && given > 0.02 * 2.0 / 3.0 - 0.3 * TOLERANCE, "{given}");
    let waves = [
        "M0 100 Q 100 -100 200 100 T 400 100",
        "M0 100 C 66.66666666666667 -33.333333333333336 \
                 133.33333333333334 -33.333333333333336 200 100 s 133.33333333333334 133.33333333333334 200 0",
    ];
    let [q, c] = waves.map(|d| wall(only_shape(&svg(&format!("<path fill='none' d='{d}'/>")))).to_vec());
    assert_same_points(&q, &c);
    near(q.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min), 0.8, 1e-6);
}

#[test]
fn transforms_are_applied_in_their_order() {
    let nested = svg("<g transform='translate(100 50) rotate(90)'><g transform='scale(2,3)'>\
                      <polygon transform='matrix(1 0 0 1 5 7)' points='0,0 10,0 10,10'/></g></g>");
    // By hand: moved by (5, 7), stretched, turned (y downwards: (x, y) -> (-y, x)), moved.
    let by_hand = |[x, y]: Point| [100.0 - 3.0 * (y + 7.0), 50.0 + 2.0 * (x + 5.0)];
    assert_same_points(ring(only_shape(&nested)), &in_metres(&[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]].map(by_hand)));
    let skewed = svg("<circle transform='skewX(45)' r='10' cx='100' cy='0'/>");
    near(area(ring(only_shape(&skewed))).abs(), PI * 1e-4, 0.08 * TOLERANCE);
    let mirrored = svg("<circle transform='translate(200) scale(-2 2)' r='10' cx='50'/>");
    assert!(matches!(only_shape(&mirrored).geometry, Geometry::Circle { radius, .. } if (radius - 0.02).abs() < 1e-15));
}

#[test]
fn page_size_and_view_box_give_the_scale() {
    let side = |head: &str| {
        let given = drawing(&format!("<svg {head}><rect width='96' height='48'/></svg>"), Format::Svg);
        let ring = ring(only_shape(&given)).clone();
        ([ring[1][0] - ring[0][0], ring[0][1] - ring[3][1], ring[3][1]], notes(&given))
    };
    let unsaid = vec!["the drawing does not state its size: read as px, 96 to an inch".to_owned()];
    let cases = [
        ("", [0.0254, 0.0127, -0.0127], true),
        ("height='96' width='200'", [0.0254, 0.0127, 0.0127], true),
        ("width='1in' height='1in'", [0.0254, 0.0127, 0.0127], false),
        ("width='96mm' viewBox='0 0 96 96'", [0.096, 0.048, 0.048], false),
        ("width='100%' viewBox='0 0 96 96'", [0.0254, 0.0127, 0.0127], true),
        // Twice as high as necessary: it is centred, unless it must be stretched.
        ("width='96mm' height='192mm' viewBox='0 0 96 96'", [0.096, 0.048, 0.096], false),
        ("width='96mm' height='192mm' viewBox='0 0 96 96' preserveAspectRatio='none'", [0.096, 0.096, 0.096], false),
        (
            "width='96mm' height='192mm' viewBox='0 0 96 96' preserveAspectRatio='xMinYMin'",
            [0.096, 0.048, 0.144],
            false,
        ),
    ];
    for (head, expected, is_unsaid) in cases {
        let (given, notes) = side(head);
        given.iter().zip(expected).for_each(|(a, b)| near(*a, b, 1e-12));
        assert_eq!(notes, if is_unsaid { unsaid.clone() } else { vec![] }, "{head}");
    }
    let settings = Settings { unit: Some("cm".parse().unwrap()), ..Settings::default() };
    let text = "<svg width='96mm' viewBox='0 0 10 10'><rect width='4' height='1'/></svg>";
    let given = read(text.as_bytes(), Format::Svg, &settings).unwrap();
    assert_same_points(ring(only_shape(&given)), &[[0.0, 0.1], [0.04, 0.1], [0.04, 0.09], [0.0, 0.09]]);
}

#[test]
fn filling_makes_holes_and_closes() {
    let frame = "M0 0H100V100H0Z M20 20H80V80H20Z";
    let holes = |given: &Drawing| match &only_shape(given).geometry {
        Geometry::Polygon { outer, holes } => (area(outer).abs(), holes.iter().map(|h| area(h).abs()).sum::<f64>()),
        other => panic!("{other:?}"),
    };
    let (outer, inner) = holes(&svg(&format!("<path fill-rule='evenodd' d='{frame}'/>")));
    near(outer, 0.01, 1e-9);
    near(inner, 0.0036, 1e-9);
    let (outer, inner) = holes(&svg(&format!("<path d='{frame}'/>")));
    near(outer, 0.01, 1e-9);
    assert_eq!(inner, 0.0);
    // The same, with the inner one in the opposite direction.
    let (_, inner) = holes(&svg("<path d='M0 0H100V100H0Z M20 20V80H80V20Z'/>"));
    near(inner, 0.0036, 1e-9);
    let open = "<path d='M0 0H100V100'/>";
    assert_eq!(notes(&svg(open)), ["open outlines with a fill: closed, as in SVG (line 1)"]);
    assert_eq!(ring(only_shape(&svg(open))).len(), 3);
    for style in ["fill='none'", "style='fill:none'", "class='thin'"] {
        let given = svg(&format!(
            "<style>.thin {{ stroke: red; fill: none }}</style>{}",
            open.replace("/>", &format!(" {style}/>"))
        ));
        assert_eq!(wall(only_shape(&given)).len(), 3, "{style}");
    }
    // A path whose ends almost meet is closed.
    let nearly = svg("<path fill='none' d='M0 0H100V100L0.05 0'/>");
    assert_eq!((ring(only_shape(&nearly)).len(), notes(&nearly).len()), (3, 1));
    // An outline that crosses itself covers the region of its fill rule.
    let star: Vec<Point> = (0..5).map(|k| (4.0 * PI * f64::from(k) / 5.0).sin_cos().into()).collect();
    let sums = [FillRule::NonZero, FillRule::EvenOdd]
        .map(|rule| filled(std::slice::from_ref(&star), rule).iter().map(|(outer, _)| area(outer).abs()).sum::<f64>());
    // The pentagon in the middle: its circumradius is that of the star by the golden ratio, twice.
    let pentagon = 2.5 * (0.4 * PI).sin() * ((3.0 - 5.0_f64.sqrt()) / 2.0).powi(2);
    near(sums[0] - sums[1], pentagon, 1e-9);
}

#[test]
fn names_layers_uses_and_hidden_elements_are_respected() {
    let given = svg(
        "<defs><rect id='tile' width='10' height='20'/><symbol id='s' viewBox='0 0 2 2'><circle id='dot' cx='1' cy='1' r='1'/></symbol></defs>\
        <g inkscape:groupmode='layer' inkscape:label='walls' id='layer1'>\
          <rect width='1' height='1' id='rect9' inkscape:label='post'/><g id='rack'><rect width='1' height='1'/></g></g>\
        <g id='fixtures'><use xlink:href='#tile' x='100' y='0'/><use id='lamp' href='#s' x='500' y='500' width='20' height='20'/></g>\
        <rect display='none' width='1' height='1'/><rect visibility='hidden' width='1' height='1'/>\
        <text>hello</text><image href='x.png'/><use href='#nowhere'/>",
    );
    let named: Vec<_> = given.shapes.iter().map(|s| (s.name.as_deref(), s.layer.as_deref())).collect();
    let expected = [
        (Some("post"), Some("walls")),
        (Some("rack"), Some("walls")),
        (Some("tile"), Some("fixtures")),
        (Some("lamp"), Some("fixtures")),
    ];
    assert_eq!(named, expected);
    assert_same_points(ring(&given.shapes[2]), &in_metres(&[[100.0, 0.0], [110.0, 0.0], [110.0, 20.0], [100.0, 20.0]]));
    let Geometry::Circle { center, radius } = given.shapes[3].geometry else { panic!() };
    assert_same_points(&[center], &in_metres(&[[510.0, 510.0]]));
    near(radius, 0.01, 1e-15);
    let output: Vec<String> = notes(&given).iter().map(|note| note.replace(" (line 1)", "")).collect();
    let expected = [
        "elements not displayed: left out",
        "elements not visible: left out",
        "<text>: left out",
        "<image>: left out",
        "<use> of \"#nowhere\", which the file does not contain: left out",
    ];
    assert_eq!(output, expected);
}
