//! A cell that ezdxf wrote, as CAD programs write them. The figures are ezdxf's (its paths, within 0.5 um) and Shapely's.

use super::{area, length, near, notes, ring, wall};
use cplan_drawing::{Format, Geometry, Settings, Shape, read};

const CELL: &[u8] = include_bytes!("../../../../workspaces/drawings/cell.dxf");

/// Layer, block, and the area (mm2) with what may be missing of it, or the length (mm).
enum Measure {
    Area(f64),
    Length(f64),
}
use Measure::{Area, Length};

#[test]
fn a_cell_by_ezdxf_measures_what_others_measure() {
    let drawing = read(CELL, Format::Dxf, &Settings::default()).unwrap();
    let expected: [(&str, Option<&str>, Measure); 9] = [
        ("robot", None, Area(31_628.21)),
        ("conveyor", None, Area(71_312.83)),
        ("fence", None, Length(800.0 + 1200.0 + 900.0 + 157.101 + 1100.0)),
        ("fixtures", Some("feeder"), Area(9600.0)),
        ("fixtures", Some("feeder"), Area(5027.92)),
        ("fixtures", Some("feeder"), Area(9600.0 * 0.64)),
        ("fixtures", Some("feeder"), Area(3217.87)),
        ("fixtures", None, Area(3849.50)),
        ("fixtures", None, Area(15_712.27)),
    ];
    let shown: Vec<&Shape> = drawing.shapes.iter().filter(|shape| !shape.is_hidden).collect();
    assert_eq!(shown.len(), expected.len(), "{shown:#?}");
    for (shape, (layer, name, measure)) in shown.iter().zip(expected) {
        assert_eq!((shape.layer.as_deref(), shape.name.as_deref()), (Some(layer), name));
        match (measure, &shape.geometry) {
            // Chords of a tenth of a millimetre, around half a metre at most.
            (Area(mm2), Geometry::Polygon { .. }) => near(area(ring(shape)).abs() * 1e6, mm2, 60.0),
            // Others flatten what is a circle here.
            (Area(mm2), Geometry::Circle { radius, .. }) => {
                near(std::f64::consts::PI * radius * radius * 1e6, mm2, 2.0)
            }
            (Length(mm), _) => near(length(wall(shape)) * 1e3, mm, 0.5),
            (_, other) => panic!("{other:?}"),
        }
    }
    assert_eq!(shown[1].height, Some([0.0, 0.08]));
    let hidden: Vec<_> = drawing.shapes.iter().filter(|shape| shape.is_hidden).collect();
    assert!(hidden.iter().any(|shape| shape.layer.as_deref() == Some("old")), "{hidden:?}");
    let told: Vec<String> = notes(&drawing).iter().map(|note| note.split(" (").next().unwrap().to_owned()).collect();
    assert_eq!(told, ["TEXT: left out", "DIMENSION: left out", "HATCH: left out"]);
}
