//! Compares a cell that ezdxf wrote (`cell.py`) in the form of CAD programs. The numbers are ezdxf's (its paths,
//! flattened within 0.5 um) and Shapely's (areas and lengths).

use super::{area, length, near, notes, ring, wall};
use cplan_drawing::{Format, Geometry, Settings, Shape, read};

const CELL: &[u8] = include_bytes!("../../../../../workspaces/drawings/cell.dxf");

/// The expected size of a shape. An area in mm2 comes with its allowance, a length is in mm. Both come with a layer and
/// a block.
enum Measure {
    Area(f64),
    Length(f64),
}
use Measure::{Area, Length};

#[test]
fn areas_agree_with_ezdxf() {
    let drawing = read(CELL, Format::Dxf, &Settings::default()).unwrap();
    let expected: [(&str, Option<&str>, Measure); 9] = [
        ("robot", None, Area(156_912.83)),
        ("conveyor", None, Area(685_698.70)),
        ("fence", None, Length(2400.0 + 3600.0 + 2700.0 + 471.305 + 3300.0)),
        ("fixtures", Some("feeder"), Area(86_400.0)),
        ("fixtures", Some("feeder"), Area(45_251.53)),
        ("fixtures", Some("feeder"), Area(86_400.0 * 0.64)),
        ("fixtures", Some("feeder"), Area(28_960.85)),
        ("fixtures", None, Area(31_424.56)),
        ("fixtures", None, Area(141_411.03)),
    ];
    let shown: Vec<&Shape> = drawing.shapes.iter().filter(|shape| shape.hidden_by.is_none()).collect();
    assert_eq!(shown.len(), expected.len(), "{shown:#?}");
    for (shape, (layer, name, measure)) in shown.iter().zip(expected) {
        assert_eq!((shape.layer.as_deref(), shape.name.as_deref()), (Some(layer), name));
        match (measure, &shape.geometry) {
            // Chords are at most a tenth of a millimetre inside, along at most a metre and a half of curve.
            (Area(mm2), Geometry::Polygon { .. }) => near(area(ring(shape)).abs() * 1e6, mm2, 150.0),
            // ezdxf represents circles by Bézier curves.
            (Area(mm2), Geometry::Circle { radius, .. }) => {
                near(std::f64::consts::PI * radius * radius * 1e6, mm2, 15.0)
            }
            (Length(mm), _) => near(length(wall(shape)) * 1e3, mm, 0.5),
            (_, other) => panic!("{other:?}"),
        }
    }
    assert_eq!(shown[1].height, Some([0.0, 0.9]));
    let hidden: Vec<_> = drawing.shapes.iter().filter(|shape| shape.hidden_by.is_some()).collect();
    assert!(hidden.iter().any(|shape| shape.layer.as_deref() == Some("old")), "{hidden:?}");
    let output: Vec<String> = notes(&drawing).iter().map(|note| note.split(" (").next().unwrap().to_owned()).collect();
    assert_eq!(output, ["TEXT: left out", "DIMENSION: left out", "HATCH: left out"]);
}
