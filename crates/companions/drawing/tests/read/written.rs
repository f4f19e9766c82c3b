//! Tests that written files are read back unchanged, and that no input causes a panic.

use super::{drawing, dxf::file, only_shape, ring, wall};
use cplan_drawing::{Format, Point, Settings, Unit, read};
use proptest::prelude::*;

/// Generates corners around the origin, which form a simple polygon.
fn corners() -> impl Strategy<Value = Vec<Point>> {
    prop::collection::vec(0.1_f64..1000.0, 3..40).prop_map(|radii| {
        let step = std::f64::consts::TAU / radii.len() as f64;
        radii.iter().enumerate().map(|(k, r)| [r * (k as f64 * step).cos(), r * (k as f64 * step).sin()]).collect()
    })
}

proptest! {
    #![proptest_config(cplan_cases::cases(64))]

    #[test]
    fn polygons_come_back_from_every_format(corners in corners()) {
        let metres = Settings { unit: Some(Unit::METER), ..Settings::default() };
        let pairs = |with: &str| corners.iter().map(|[x, y]| format!("{x}{with}{y}")).collect::<Vec<_>>();
        let closed: String = corners.iter().map(|[x, y]| format!("10 {x} 20 {y} ")).collect();
        let lines: String = corners.iter().zip(corners.iter().cycle().skip(1))
            .map(|(p, q)| format!("0 LINE 8 a 10 {} 20 {} 11 {} 21 {} ", p[0], p[1], q[0], q[1])).collect();
        for entities in [format!("0 LWPOLYLINE 8 a 70 1 {closed}"), lines] {
            let given = read(file("", &entities).as_bytes(), Format::Dxf, &metres).unwrap();
            prop_assert_eq!(ring(only_shape(&given)), &corners);
        }
        let json = format!("{{\"type\":\"Polygon\",\"coordinates\":[[[{}],[{}]]]}}", pairs(",").join("],["), pairs(",")[0]);
        let given = drawing(&json, Format::GeoJson);
        prop_assert_eq!(ring(only_shape(&given)), &corners);
        let svg = format!("<svg><g transform='scale(1 -1)'><path d='M{}z'/></g></svg>", pairs(" ").join("L"));
        let given = read(svg.as_bytes(), Format::Svg, &metres).unwrap();
        prop_assert_eq!(ring(only_shape(&given)), &corners);
    }

    /// Compares the elliptical arcs of paths with those of the library kurbo: the ellipse and the angle.
    #[test]
    fn arcs_agree_with_another_library(
        from in (0.0..500.0, 0.0..500.0), to in (0.0..500.0, 0.0..500.0), radii in (5.0..400.0, 5.0..400.0),
        degrees in -180.0..180.0, large in any::<bool>(), sweep in any::<bool>(),
    ) {
        let [large_arc, sweep_flag] = [large, sweep].map(u8::from);
        let d = format!("M{} {}A{} {} {degrees} {large_arc} {sweep_flag} {} {}", from.0, from.1, radii.0, radii.1, to.0, to.1);
        let metres = Settings { unit: Some(Unit::METER), tolerance: 0.01, ..Settings::default() };
        let svg = format!("<svg><path fill='none' transform='scale(1 -1)' d='{d}'/></svg>");
        let given = read(svg.as_bytes(), Format::Svg, &metres).unwrap();
        let points = wall(only_shape(&given));
        let arc = kurbo::SvgArc {
            from: from.into(), to: to.into(), radii: radii.into(), x_rotation: f64::to_radians(degrees), large_arc: large, sweep,
        };
        let arc = kurbo::Arc::from_svg_arc(&arc).expect("two ends and two radii");
        let (sin, cos) = arc.x_rotation.sin_cos();
        let angle = |p: &Point| {
            let [x, y] = [p[0] - arc.center.x, p[1] - arc.center.y];
            let [u, v] = [(cos * x + sin * y) / arc.radii.x, (cos * y - sin * x) / arc.radii.y];
            (v.atan2(u), u.hypot(v))
        };
        // Both solve for the centre by a difference that may be all but zero.
        prop_assert!(points.iter().all(|p| (angle(p).1 - 1.0).abs() < 1e-5), "{points:?} on {arc:?}");
        let turned: f64 = points.windows(2).map(|w| {
            let step = angle(&w[1]).0 - angle(&w[0]).0;
            step - std::f64::consts::TAU * (step / std::f64::consts::TAU).round()
        }).sum();
        prop_assert!((turned - arc.sweep_angle).abs() < 1e-4, "{turned} against {arc:?}");
    }

    /// Tests that after parts of a file are removed, the reader refuses the file, or at least reads it without a panic.
    #[test]
    fn no_input_makes_a_reader_panic(bytes in prop::collection::vec(any::<u8>(), 0..400), at in 0_usize..20_000) {
        let cell = include_bytes!("../../../../../workspaces/drawings/cell.dxf");
        let at = at.min(cell.len());
        let spoiled: Vec<u8> = [&cell[..at], &bytes, &cell[at..]].concat();
        for format in [Format::Dxf, Format::Svg, Format::GeoJson] {
            for bytes in [&bytes, &spoiled] {
                if let Err(error) = read(bytes, format, &Settings::default()) {
                    prop_assert!(!error.message.is_empty() && !error.cure.is_empty());
                }
            }
        }
    }
}
