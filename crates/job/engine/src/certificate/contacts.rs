//! The shapes and obstacle parts to which the evidence of a certificate refers.

use super::{Evidence, lines, reaching_out};
use cplan_geometry::Convex;
use cplan_judge::CollisionBox;
use cplan_model::{Heights, OutlineSource, Pair, Part, Scene, SelfObstacle, Shape};
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// A collision box in the form of certificates.
#[derive(Serialize)]
struct CertificateBox {
    lower: [f64; 2],
    upper: [f64; 2],
    shape: usize,
    part: usize,
}

/// The lists of shapes and of obstacle parts to which the evidence refers. Each entry occurs once.
pub(super) struct Contacts<'a> {
    scene: &'a Scene,
    pub shapes: Vec<Value>,
    pub parts: Vec<Value>,
    /// For each shape of the scene in the evidence, its index in the list of shapes.
    shape_numbers: BTreeMap<(usize, usize), usize>,
    part_numbers: BTreeMap<(usize, usize), usize>,
}

/// Returns the index of an entry in a list. Appends the entry if it is missing.
fn index_of_entry(list: &mut Vec<Value>, entry: Value) -> usize {
    list.iter().position(|known| *known == entry).unwrap_or_else(|| {
        list.push(entry);
        list.len() - 1
    })
}

impl<'a> Contacts<'a> {
    pub fn new(scene: &'a Scene) -> Self {
        Self { scene, shapes: vec![], parts: vec![], shape_numbers: BTreeMap::new(), part_numbers: BTreeMap::new() }
    }

    /// Returns the lists as members of the certificate's JSON. Empty if the evidence names no shape.
    pub fn named(&self) -> Evidence {
        let lists = [("shapes", &self.shapes), ("parts", &self.parts)].map(|(name, list)| (name, lines(list)));
        if self.shapes.is_empty() { Vec::new() } else { lists.into() }
    }

    /// Returns the indices, in the lists, of the shape and the obstacle part of a pair of shapes.
    pub fn numbers(&mut self, pair: Pair) -> (usize, usize) {
        let Self { scene, shapes, parts, .. } = self;
        let Pair { link, part, obstacle, piece } = pair;
        let shape =
            self.shape_numbers.entry((link, part)).or_insert_with(|| index_of_entry(shapes, shape(scene, pair)));
        let part =
            self.part_numbers.entry((obstacle, piece)).or_insert_with(|| index_of_entry(parts, part_of(scene, pair)));
        (*shape, *part)
    }

    /// Returns the list of boxes as a member of the certificate's JSON.
    pub fn boxes(&mut self, stuck: &[CollisionBox]) -> (&'static str, String) {
        let boxes: Vec<CertificateBox> = stuck.iter().flat_map(|stuck| self.collision_boxes(stuck)).collect();
        ("boxes", lines(&boxes))
    }

    /// Converts a box to the form of certificates. A box that crosses the seam at half a turn becomes two boxes.
    fn collision_boxes(&mut self, stuck: &CollisionBox) -> Vec<CertificateBox> {
        let (shape, part) = self.numbers(stuck.pair);
        let parts = reaching_out(self.scene, stuck).into_iter();
        parts.map(|[lower, upper]| CertificateBox { lower, upper, shape, part }).collect()
    }
}

/// Identifies a part of a link by its URDF link and its index among the shapes of that link. A bar is the last one of a link's
/// own parts.
fn shape(scene: &Scene, pair: Pair) -> Value {
    let link = scene.link(pair);
    let Part { body, number, is_visual, heights, .. } = &link.parts[pair.part];
    if link.source == OutlineSource::Bar && pair.part + 1 == scene.own_parts(pair.link.min(1)).len() {
        return json!({ "link": body, "bar": 0 });
    }
    let same = |other: &&Part| other.body == *body && other.number == *number && other.is_visual == *is_visual;
    let layers = link.parts.iter().filter(same).map(|other| other.heights);
    of_layer(json!({ "link": body, kind(*is_visual): number }), *heights, layers)
}

/// Identifies a piece of an obstacle by its corners. A disc, which is always the only piece of its obstacle, needs none.
fn part_of(scene: &Scene, pair: Pair) -> Value {
    let obstacle = pair.obstacle;
    if let Some(own) = scene.self_obstacle(obstacle) {
        let same = |other: &&SelfObstacle| {
            (&other.obstacle.name, other.number, other.is_visual) == (&own.obstacle.name, own.number, own.is_visual)
        };
        let layers = scene.arm().self_obstacles.iter().filter(same).map(|other| other.obstacle.heights);
        let named = json!({ "own": own.obstacle.name, kind(own.is_visual): own.number });
        return of_layer(named, own.obstacle.heights, layers);
    }
    match scene.obstacle(obstacle).shape {
        Shape::Circle { .. } => json!({ "obstacle": obstacle }),
        Shape::Polygon(_) | Shape::Polyline(_) | Shape::Pieces => {
            json!({ "obstacle": obstacle, "corners": corners(scene.obstacle_piece(pair)) })
        }
    }
}

fn kind(is_visual: bool) -> &'static str {
    if is_visual { "visual" } else { "collision" }
}

/// If a shape is cut into several layers, adds the height of the layer's middle to the identification.
fn of_layer(mut named: Value, own: Heights, mut all: impl Iterator<Item = Heights>) -> Value {
    if all.any(|other| other != own) {
        named["height"] = json!(f64::midpoint(own.lower, own.upper));
    }
    named
}

fn corners(piece: &Convex) -> Vec<[f64; 2]> {
    piece.core().iter().map(|&p| p.into()).collect()
}
