//! Configuration spaces as GeoJSON (RFC 7946), with joint values as longitudes and latitudes.

use super::{CSpace, CSpaces, Values};
use cplan_motion::field_per_line;
use serde_json::{Value, json};

/// Returns a `FeatureCollection` without the grids. A feature's properties are its `kind` and `space`, the index of its
/// configuration space.
pub fn text(spaces: &CSpaces) -> String {
    let CSpaces { name, planner, status, axes, spaces } = spaces;
    let features: Vec<Value> = spaces.iter().enumerate().flat_map(|(number, space)| features(number, space)).collect();
    field_per_line(&json!({
        "type": "FeatureCollection",
        "name": name, "planner": planner, "status": status, "axes": axes,
        "features": features,
    }))
}

fn features(number: usize, space: &CSpace) -> Vec<Value> {
    let feature = |kind: &str, geometry: Value, more: Value| {
        let mut feature = json!({ "type": "Feature", "properties": more, "geometry": geometry });
        feature["properties"]["kind"] = json!(kind);
        feature["properties"]["space"] = json!(number);
        feature
    };
    let none = || json!({});
    let obstacle = |region: &super::ObstacleRegion| {
        let more = json!({ "name": region.obstacle, "proves": space.proves });
        feature("c_obstacle", geometry("MultiPolygon", &region.polygons), more)
    };
    let mut features: Vec<Value> = space.c_obstacles.iter().map(obstacle).collect();
    if let Some(free) = &space.free {
        features.push(feature("free", geometry("MultiPolygon", &free.polygons), json!({ "proves": free.proves })));
    }
    if let Some(cells) = &space.cells {
        let place = |cell: usize| cells.channel.iter().position(|&passed| passed == cell);
        features.extend(cells.corners.iter().enumerate().map(|(cell, corners)| {
            let ring: Vec<Values> = corners.iter().chain(corners.first()).copied().collect();
            feature("cell", geometry("Polygon", [ring]), json!({ "channel": place(cell) }))
        }));
    }
    let points = space.cells.iter().flat_map(|cells| [("center", &cells.centers), ("middle", &cells.middles)]);
    features.extend(
        points
            .filter(|(_, points)| !points.is_empty())
            .map(|(kind, points)| feature(kind, geometry("MultiPoint", points), none())),
    );
    if let Some(boxes) = &space.boxes {
        let kinds = [("free_box", &boxes.free), ("stuck_box", &boxes.stuck), ("mixed_box", &boxes.mixed)];
        features.extend(kinds.map(|(kind, boxes)| feature(kind, rectangles(boxes), none())));
    }
    if let Some(roadmap) = &space.roadmap {
        let ends = roadmap.edges.iter().map(|edge| edge.map(|vertex| roadmap.vertices[vertex]));
        let lines = geometry("MultiLineString", ends.collect::<Vec<_>>());
        let mut more = json!({ "whole": roadmap.whole });
        roadmap.visibility.iter().for_each(|graph| more["visibility"] = json!(graph));
        features.push(feature("roadmap", lines, more));
    }
    let lists = [
        ("rows", geometry("MultiLineString", &space.rows), space.rows.is_empty()),
        ("expanded", geometry("MultiPoint", &space.expanded), space.expanded.is_empty()),
        ("proof", rectangles(&space.proof), space.proof.is_empty()),
    ];
    features.extend(lists.into_iter().filter(|list| !list.2).map(|(kind, shape, _)| feature(kind, shape, none())));
    features.extend(
        space
            .paths
            .iter()
            .map(|path| feature("path", geometry("LineString", &path.outline), json!({ "name": path.name }))),
    );
    features.push(feature("start", geometry("Point", space.start), none()));
    features.extend(space.goals.iter().map(|goal| match goal {
        [from, to] if from == to => feature("goal", geometry("Point", from), none()),
        ends => feature("goal", geometry("LineString", ends), none()),
    }));
    features
}

fn geometry(kind: &str, coordinates: impl serde::Serialize) -> Value {
    json!({ "type": kind, "coordinates": coordinates })
}

fn rectangles(boxes: &[[Values; 2]]) -> Value {
    let ring = |&[[a, b], [c, d]]: &[Values; 2]| [[[a, b], [c, b], [c, d], [a, d], [a, b]]];
    geometry("MultiPolygon", boxes.iter().map(ring).collect::<Vec<_>>())
}
