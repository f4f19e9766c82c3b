//! Shapes as obstacles: where they come to lie, sound, each with a name of its own.

use crate::geometry::{Point, Polygon};
use crate::input::{Diagnostic, LARGEST, Position};
use cplan_drawing::{FillRule, Geometry, Notes, Ring, Shape, filled};
use std::collections::HashMap;

/// An obstacle of the world.
pub(super) struct Taken {
    pub name: String,
    /// In metres, as the world file has it.
    pub shape: Shape,
}

/// What is too small for the file.
const NO_EXTENT: &str = "what has no extent: left out";

/// Where a drawing comes to lie: turned, then moved.
pub(super) struct Placement {
    pub turn: f64,
    pub shift: [f64; 2],
}

/// Decimals that the file has: a nanometre is less than anyone measures, and leaves short numbers.
const GRAINS: f64 = 1e9;

impl Placement {
    fn point(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.turn.sin_cos();
        let turned = [cos * x - sin * y, sin * x + cos * y];
        [0, 1].map(|k| rounded(turned[k] + self.shift[k]))
    }

    fn ring(&self, ring: Ring) -> Ring {
        let mut ring: Ring = ring.into_iter().map(|p| self.point(p)).collect();
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        ring
    }
}

/// A length of the file, without a negative zero.
pub(super) fn rounded(value: f64) -> f64 {
    (value * GRAINS).round() / GRAINS + 0.0
}

/// The obstacles. An outline that crosses itself is what it goes round, or thin walls where even that is too narrow.
pub(super) fn taken(shapes: Vec<Shape>, placement: &Placement, notes: &mut Notes) -> Result<Vec<Taken>, Diagnostic> {
    let mut sound: Vec<Shape> = Vec::new();
    for shape in shapes {
        let geometries = match shape.geometry.clone() {
            Geometry::Circle { center, radius } => {
                let (center, radius) = (placement.point(center), rounded(radius));
                if radius > 0.0 {
                    vec![Geometry::Circle { center, radius }]
                } else {
                    notes.add(NO_EXTENT, shape.line);
                    Vec::new()
                }
            }
            Geometry::Polyline(points) => {
                let mut points: Vec<_> = points.into_iter().map(|p| placement.point(p)).collect();
                points.dedup();
                if points.len() > 1 {
                    vec![Geometry::Polyline(points)]
                } else {
                    notes.add(NO_EXTENT, shape.line);
                    Vec::new()
                }
            }
            Geometry::Polygon { outer, holes } => {
                let holes = holes.into_iter().map(|hole| placement.ring(hole)).collect();
                untangled(placement.ring(outer), holes, &shape, notes)
            }
        };
        for geometry in geometries {
            within_reach(&geometry, &shape)?;
            sound.push(Shape { geometry, ..shape.clone() });
        }
    }
    if let Some(border) = border(&sound) {
        let name = border.name.as_ref().or(border.layer.as_ref()).map_or("an outline", String::as_str);
        notes.add(format!("\"{name}\" is solid and lies around all else: --walls makes a wall of it"), border.line);
    }
    Ok(named(sound))
}

/// Rings as polygons that do not cross themselves.
fn untangled(outer: Ring, holes: Vec<Ring>, shape: &Shape, notes: &mut Notes) -> Vec<Geometry> {
    if is_sound(&outer, &holes) {
        return vec![Geometry::Polygon { outer, holes }];
    }
    let rule = if holes.is_empty() { FillRule::NonZero } else { FillRule::EvenOdd };
    let rings: Vec<Ring> = [outer].into_iter().chain(holes).collect();
    let parts = filled(&rings, rule);
    if !parts.is_empty() && parts.iter().all(|(outer, holes)| is_sound(outer, holes)) {
        notes.add("outlines that cross or touch themselves: what they go round is solid", shape.line);
        return parts.into_iter().map(|(outer, holes)| Geometry::Polygon { outer, holes }).collect();
    }
    let closed = |mut ring: Ring| {
        ring.extend(ring.first().copied());
        ring
    };
    let walls: Vec<_> =
        rings.into_iter().filter(|ring| ring.len() > 1).map(|ring| Geometry::Polyline(closed(ring))).collect();
    let what = if walls.is_empty() { NO_EXTENT } else { "outlines that surround nothing: taken as thin walls" };
    notes.add(what, shape.line);
    walls
}

fn is_sound(outer: &[[f64; 2]], holes: &[Ring]) -> bool {
    let points = |ring: &[[f64; 2]]| ring.iter().copied().map(Point::from).collect::<Vec<_>>();
    Polygon::new(points(outer), holes.iter().map(|hole| points(hole)).collect()).is_ok()
}

/// Refuses what lies where no arm can be.
fn within_reach(geometry: &Geometry, shape: &Shape) -> Result<(), Diagnostic> {
    let greatest = |numbers: &mut dyn Iterator<Item = f64>| numbers.map(f64::abs).fold(0.0, f64::max);
    let farthest = greatest(&mut coordinates(geometry).flatten());
    let highest = greatest(&mut shape.height.into_iter().flatten());
    let (what, value, help) = if farthest > LARGEST {
        ("a coordinate", farthest, "bring the drawing to the arm by --move, or say its --unit")
    } else {
        ("a height", highest, "say where it is by --height, or the drawing's --unit")
    };
    if value <= LARGEST {
        return Ok(());
    }
    let message = format!("{} has {what} of {value:.2e} m (at most {LARGEST:e})", shape.kind);
    let position = shape.line.map(|line| Position { line, column: 1 });
    Err(Diagnostic { position, ..Diagnostic::new("", message).help(help) })
}

/// Points as far out as the shape.
fn coordinates(geometry: &Geometry) -> Box<dyn Iterator<Item = [f64; 2]> + '_> {
    match geometry {
        Geometry::Polygon { outer, holes } => Box::new(outer.iter().chain(holes.iter().flatten()).copied()),
        Geometry::Polyline(points) => Box::new(points.iter().copied()),
        Geometry::Circle { center: [x, y], radius } => {
            Box::new([[x - radius, y - radius], [x + radius, y + radius]].into_iter())
        }
    }
}

/// The solid that lies around all others, if one does: people draw the walls of a room like that.
fn border(shapes: &[Shape]) -> Option<&Shape> {
    let around = |shape: &Shape| {
        let mut bounds = [(f64::INFINITY, f64::NEG_INFINITY); 2];
        for p in coordinates(&shape.geometry) {
            bounds = [0, 1].map(|k| (bounds[k].0.min(p[k]), bounds[k].1.max(p[k])));
        }
        bounds
    };
    let bounds: Vec<_> = shapes.iter().map(around).collect();
    let holds = |i: usize, j: usize| (0..2).all(|k| bounds[i][k].0 < bounds[j][k].0 && bounds[j][k].1 < bounds[i][k].1);
    let is_solid = |i: usize| matches!(&shapes[i].geometry, Geometry::Polygon { holes, .. } if holes.is_empty());
    let others = |i: usize| (0..shapes.len()).filter(move |&j| j != i);
    // The widest is the only one that can.
    let widest = (0..shapes.len()).max_by(|&i, &j| {
        let width = |i: usize| bounds[i][0].1 - bounds[i][0].0;
        width(i).total_cmp(&width(j))
    })?;
    let is_border = shapes.len() > 1 && is_solid(widest) && others(widest).all(|j| holds(widest, j));
    is_border.then(|| &shapes[widest])
}

/// No names: that of the layer which every DXF has is none, either.
const UNNAMED: [&str; 2] = ["", "0"];

/// Gives each a name of its own: that of what is drawn, or of its layer, with a number where several have it.
fn named(shapes: Vec<Shape>) -> Vec<Taken> {
    let base = |shape: &Shape| {
        let name =
            shape.name.as_deref().or(shape.layer.as_deref()).map(str::trim).filter(|name| !UNNAMED.contains(name));
        name.unwrap_or("obstacle").to_owned()
    };
    let mut counts = HashMap::<String, usize>::new();
    shapes.iter().for_each(|shape| *counts.entry(base(shape)).or_default() += 1);
    let mut numbers = HashMap::<String, usize>::new();
    let mut taken = Vec::with_capacity(shapes.len());
    for shape in shapes {
        let base = base(&shape);
        let name = if counts[&base] == 1 {
            base
        } else {
            // Somebody may have numbered some already.
            let number = numbers.entry(base.clone()).or_default();
            loop {
                *number += 1;
                let name = format!("{base} {number}");
                if !counts.contains_key(&name) {
                    break name;
                }
            }
        };
        taken.push(Taken { name, shape });
    }
    taken
}
