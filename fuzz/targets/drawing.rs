//! Any bytes as a drawing of each format.
#![no_main]

use cplan_drawing::{Format, Geometry, Point, Settings, read};
use libfuzzer_sys::fuzz_target;

fn all_finite(points: &[Point]) -> bool {
    points.iter().flatten().all(|x| x.is_finite())
}

fuzz_target!(|bytes: &[u8]| {
    for format in [Format::Dxf, Format::Svg, Format::GeoJson] {
        match read(bytes, format, &Settings::default()) {
            Ok(drawing) => {
                for shape in &drawing.shapes {
                    match &shape.geometry {
                        Geometry::Polygon { outer, holes } => {
                            assert!(outer.len() > 2 && all_finite(outer) && holes.iter().all(|hole| all_finite(hole)));
                        }
                        Geometry::Polyline(points) => assert!(points.len() > 1 && all_finite(points)),
                        Geometry::Circle { center, radius } => assert!(*radius > 0.0 && all_finite(&[*center])),
                    }
                }
            }
            Err(error) => assert!(!error.message.is_empty() && !error.cure.is_empty()),
        }
    }
});
