//! Tests of features, holes, heights, and refused files.

use super::{area, drawing, notes, only_shape, ring, wall};
use cplan_drawing::{Format, Geometry, Settings, read};

#[test]
fn features_have_names_holes_and_heights() {
    let cell = r#"{ "type": "FeatureCollection", "features": [
        { "type": "Feature", "id": 7, "properties": { "name": "frame", "height": 0.2, "layer": "steel" }, "geometry": {
            "type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]], [[1, 1], [1, 2], [2, 2, 9], [2, 1], [1, 1]]] } },
        { "type": "Feature", "id": 8, "properties": { "height": [0.1, 0.3] }, "geometry": {
            "type": "MultiPolygon", "coordinates": [[[[5, 0], [6, 0], [6, 1], [5, 0]]], [[[7, 0], [8, 0], [8, 1], [7, 0]]]] } },
        { "type": "Feature", "properties": null, "geometry": { "type": "GeometryCollection", "geometries": [
            { "type": "LineString", "coordinates": [[0, 5], [4, 5]] },
            { "type": "MultiLineString", "coordinates": [[[0, 6], [4, 6]], [[0, 7], [4, 7], [4, 8]]] },
            { "type": "Point", "coordinates": [1, 1] }] } },
        { "type": "Feature", "properties": {}, "geometry": null } ] }"#;
    let given = drawing(cell, Format::GeoJson);
    let [frame, left, right, walls @ ..] = &given.shapes[..] else { panic!("{given:?}") };
    let Geometry::Polygon { outer, holes } = &frame.geometry else { panic!("{frame:?}") };
    assert_eq!((area(outer), area(&holes[0]).abs(), holes.len()), (12.0, 1.0, 1));
    assert_eq!((frame.name.as_deref(), frame.layer.as_deref()), (Some("frame"), Some("steel")));
    assert_eq!((frame.height, left.height, walls[0].height), (Some([0.0, 0.2]), Some([0.1, 0.3]), None));
    assert_eq!((left.name.as_deref(), right.name.as_deref()), (Some("8"), Some("8")));
    assert_eq!((ring(left).len(), area(ring(right))), (3, 0.5));
    assert_eq!(walls.iter().map(|shape| wall(shape).len()).collect::<Vec<_>>(), [2, 2, 3]);
    let expected =
        ["GeoJSON does not state a unit: read as m", "Point: left out", "Feature without geometry: left out"];
    assert_eq!(notes(&given), expected);
    let settings = Settings { unit: Some("cm".parse().unwrap()), ..Settings::default() };
    let small = read(cell.as_bytes(), Format::GeoJson, &settings).unwrap();
    assert_eq!((small.shapes[0].height, wall(&small.shapes[3])[1]), (Some([0.0, 0.002]), [0.04, 0.05]));
    assert_eq!(
        ring(only_shape(&drawing(r#"{"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1]]]}"#, Format::GeoJson))).len(),
        3
    );
}

#[test]
fn errors_name_their_place() {
    let cases = [
        ("", None, "the file is empty"),
        ("{ \"type\":\n \"Polygon\", ]", Some(2), "this is not JSON"),
        ("[1, 2]", None, "expected an object with a type"),
        (r#"{"type": "Topology"}"#, None, "TopoJSON"),
        (r#"{"type": "Polygon"}"#, None, "coordinates: expected a list"),
        (r#"{"type": "Polygon", "coordinates": [[[0, 0], [1, "x"]]]}"#, None, "coordinates[0][1]: expected a position"),
        (
            r#"{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"height": "x"}}]}"#,
            None,
            "features[0].properties.height: expected a number",
        ),
        (
            r#"{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"height": 1e300}}]}"#,
            None,
            "features[0].properties.height: the height is too large (beyond 1e6 m)",
        ),
        (
            r#"{"type": "Feature", "properties": {"height": [-2e6, 1]}}"#,
            None,
            "properties.height: the height is too large",
        ),
        (r#"{"type": "Polygon", "coordinates": [[[0, 0], [1e308, 1e400], [1, 1]]]}"#, Some(1), "number out of range"),
    ];
    for (text, line, message) in cases {
        let error = read(text.as_bytes(), Format::GeoJson, &Settings::default()).unwrap_err();
        assert!(error.message.contains(message) && !error.cure.is_empty(), "{text}: {error:?}");
        assert_eq!(error.line, line, "{text}");
    }
}

#[test]
fn hints_match_the_error() {
    let cases = [
        (r#"{"type": "Polygon", "coordinates": {}}"#, "positions as lists"),
        (r#"{"type": "Polygon", "coordinates": [[[0, 0], [1, "x"]]]}"#, "both coordinates as numbers, without quotes"),
        (r#"{"type": "Feature", "properties": {"height": "x"}}"#, "heights as numbers, without quotes"),
        (r#"{"type": "Feature", "properties": {"height": -1}}"#, "lower end first; a single number must be above 0"),
    ];
    for (text, cure) in cases {
        let error = read(text.as_bytes(), Format::GeoJson, &Settings::default()).unwrap_err();
        assert!(error.cure.contains(cure), "{text}: {error:?}");
    }
}
