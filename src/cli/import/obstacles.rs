//! Converts shapes to obstacles at their places, with valid outlines and unique names.

use crate::geometry::{Point, Polygon};
use crate::input::{Diagnostic, MAX_LENGTH, Position};
use cplan_drawing::{FillRule, Frame, Geometry, Notes, Ring, Shape, filled};
use std::collections::{HashMap, HashSet};
use std::f64::consts::PI;

/// An obstacle that was imported.
#[derive(Clone)]
pub(super) struct ImportedObstacle {
    pub name: String,
    /// The shape in metres, in coordinates of its frame if the world file states one.
    pub shape: Shape,
}

/// Note about shapes that are too small to be written.
const NO_EXTENT_NOTE: &str = "parts without length or area: left out";

/// The placement of a drawing: a rotation followed by a displacement.
pub(super) struct Placement {
    pub turn: f64,
    pub shift: [f64; 2],
}

/// Number of steps per metre to which coordinates in the file are rounded. A step of a nanometre is smaller than any
/// measurement, and gives short numbers.
const ROUNDING_STEPS_PER_METRE: f64 = 1e9;

impl Placement {
    /// Returns the frame of a block in the world.
    fn frame(&self, frame: Frame) -> Frame {
        let drawing = Frame { at: self.shift, angle: self.turn };
        let angle = frame.angle + self.turn;
        let angle = if angle.abs() <= PI { angle } else { angle.sin().atan2(angle.cos()) };
        Frame { at: drawing.placed(frame.at).map(rounded), angle: angle + 0.0 }
    }

    /// Returns the coordinates in the world file of a point of the drawing. In a block, they are relative to the
    /// block's frame.
    fn point(&self, p: [f64; 2], frame: Option<&Frame>) -> [f64; 2] {
        let drawing = Frame { at: self.shift, angle: self.turn };
        frame.map_or_else(|| drawing.placed(p), |frame| frame.local(p)).map(rounded)
    }

    fn ring(&self, ring: Ring, frame: Option<&Frame>) -> Ring {
        let mut ring: Ring = ring.into_iter().map(|p| self.point(p, frame)).collect();
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        ring
    }
}

/// Rounds a length for the file. Never returns negative zero.
pub(super) fn rounded(value: f64) -> f64 {
    (value * ROUNDING_STEPS_PER_METRE).round() / ROUNDING_STEPS_PER_METRE + 0.0
}

/// Returns the obstacles of a drawing, with their names in the world. An outline that crosses itself is replaced by the
/// area that it encloses, or by thin walls if that is too narrow.
pub(super) fn obstacles_of_drawing(
    shapes: Vec<Shape>,
    placement: &Placement,
    notes: &mut Notes,
) -> Vec<ImportedObstacle> {
    let mut sound: Vec<Shape> = Vec::new();
    for shape in shapes {
        let frame = shape.frame.as_ref();
        let geometries = match shape.geometry.clone() {
            Geometry::Circle { center, radius } => {
                let (center, radius) = (placement.point(center, frame), rounded(radius));
                if radius > 0.0 {
                    vec![Geometry::Circle { center, radius }]
                } else {
                    notes.add_of(shape.called(), NO_EXTENT_NOTE, shape.line);
                    Vec::new()
                }
            }
            Geometry::Polyline(points) => {
                let mut points: Vec<_> = points.into_iter().map(|p| placement.point(p, frame)).collect();
                points.dedup();
                if points.len() > 1 {
                    vec![Geometry::Polyline(points)]
                } else {
                    notes.add_of(shape.called(), NO_EXTENT_NOTE, shape.line);
                    Vec::new()
                }
            }
            Geometry::Polygon { outer, holes } => {
                let holes = holes.into_iter().map(|hole| placement.ring(hole, frame)).collect();
                untangle(placement.ring(outer, frame), holes, &shape, notes)
            }
        };
        let frame = frame.map(|frame| placement.frame(*frame));
        sound.extend(geometries.into_iter().map(|geometry| Shape { geometry, frame, ..shape.clone() }));
    }
    name_obstacles(sound)
}

/// Returns the area that rings enclose as polygons that do not cross themselves.
fn untangle(outer: Ring, holes: Vec<Ring>, shape: &Shape, notes: &mut Notes) -> Vec<Geometry> {
    if is_sound(&outer, &holes) {
        return vec![Geometry::Polygon { outer, holes }];
    }
    let rule = if holes.is_empty() { FillRule::NonZero } else { FillRule::EvenOdd };
    let rings: Vec<Ring> = [outer].into_iter().chain(holes).collect();
    let parts = filled(&rings, rule);
    if !parts.is_empty() && parts.iter().all(|(outer, holes)| is_sound(outer, holes)) {
        notes.add_of(shape.called(), "outlines that cross or touch themselves: the enclosed area is solid", shape.line);
        return parts.into_iter().map(|(outer, holes)| Geometry::Polygon { outer, holes }).collect();
    }
    let closed = |mut ring: Ring| {
        ring.extend(ring.first().copied());
        ring
    };
    let walls: Vec<_> =
        rings.into_iter().filter(|ring| ring.len() > 1).map(|ring| Geometry::Polyline(closed(ring))).collect();
    let what = if walls.is_empty() { NO_EXTENT_NOTE } else { "outlines that enclose no area: imported as thin walls" };
    notes.add_of(shape.called(), what, shape.line);
    walls
}

fn is_sound(outer: &[[f64; 2]], holes: &[Ring]) -> bool {
    let points = |ring: &[[f64; 2]]| ring.iter().copied().map(Point::from).collect::<Vec<_>>();
    Polygon::new(points(outer), holes.iter().map(|hole| points(hole)).collect()).is_ok()
}

/// Refuses shapes at coordinates that no arm can reach. `shift` is the displacement of the drawing that options state.
pub(super) fn within_reach(taken: &[ImportedObstacle], shift: [f64; 2]) -> Result<(), Diagnostic> {
    taken.iter().try_for_each(|ImportedObstacle { shape, .. }| {
        let greatest = |numbers: &mut dyn Iterator<Item = f64>| numbers.map(f64::abs).fold(0.0, f64::max);
        let farthest = greatest(&mut coordinates(shape).flatten());
        let highest = greatest(&mut shape.height.into_iter().flatten());
        let (what, value, help) = if farthest > MAX_LENGTH {
            ("a coordinate", farthest, distance_hint(taken, shift))
        } else {
            ("a height", highest, "state the heights by --height, or the unit of the drawing by --unit".into())
        };
        if value <= MAX_LENGTH {
            return Ok(());
        }
        let message = format!("{} has {what} of {value:.2e} m (at most {MAX_LENGTH:e} is allowed)", shape.kind);
        let position = shape.line.map(|line| Position { line, column: 1 });
        Err(Diagnostic { position, ..Diagnostic::new("", message).help(help) })
    })
}

/// Returns a hint for a drawing that is far from the arm. It suggests a displacement in whole metres that brings the
/// middle of the drawing to the arm, or something else if the drawing is too large for that.
fn distance_hint(taken: &[ImportedObstacle], shift: [f64; 2]) -> String {
    let points: Vec<[f64; 2]> = taken.iter().flat_map(|taken| coordinates(&taken.shape)).collect();
    let ends = |k: usize| {
        let values = || points.iter().map(|p| p[k]);
        [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
    };
    let [x, y] = [0, 1].map(|k| {
        let [low, high] = ends(k);
        (shift[k] - low.midpoint(high)).round()
    });
    match [0, 1].iter().all(|&k| (ends(k)[1] - ends(k)[0]) / 2.0 + 1.0 <= MAX_LENGTH) {
        true => format!("add --move {x},{y} or similar to move the drawing near the arm, or state its unit by --unit"),
        false => "the whole drawing is too large; state its unit by --unit, or scale it by --scale".into(),
    }
}

/// Iterates over points, in world coordinates, that have the same bounding box as the shape.
pub(super) fn coordinates(shape: &Shape) -> impl Iterator<Item = [f64; 2]> {
    let points = match &shape.geometry {
        Geometry::Polygon { outer, holes } => outer.iter().chain(holes.iter().flatten()).copied().collect(),
        Geometry::Polyline(points) => points.clone(),
        Geometry::Circle { center, radius } => {
            let [x, y] = placed(shape, *center);
            return vec![[x - radius, y - radius], [x + radius, y + radius]].into_iter();
        }
    };
    points.into_iter().map(|p| placed(shape, p)).collect::<Vec<_>>().into_iter()
}

/// Returns the world coordinates of a point of a shape.
pub(super) fn placed(shape: &Shape, p: [f64; 2]) -> [f64; 2] {
    shape.frame.map_or(p, |frame| frame.placed(p))
}

/// Names that count as missing, such as that of the layer that every DXF has.
const MISSING_NAMES: [&str; 2] = ["", "0"];

/// Gives each obstacle a unique name: its own, or that of its layer. A number is added if several obstacles share the
/// name. Hidden obstacles are numbered after visible ones, so that names do not depend on the selection.
fn name_obstacles(shapes: Vec<Shape>) -> Vec<ImportedObstacle> {
    let base = |shape: &Shape| {
        let name = shape
            .name
            .as_deref()
            .or(shape.layer.as_deref())
            .map(str::trim)
            .filter(|name| !MISSING_NAMES.contains(name));
        name.unwrap_or("obstacle").to_owned()
    };
    let mut given = vec![String::new(); shapes.len()];
    let mut names = Names::default();
    for is_hidden in [false, true] {
        let group: Vec<usize> = (0..shapes.len()).filter(|&i| shapes[i].hidden_by.is_some() == is_hidden).collect();
        let mut counts = HashMap::<String, usize>::new();
        group.iter().for_each(|&i| *counts.entry(base(&shapes[i])).or_default() += 1);
        // The drawing may already contain numbered names.
        let single: HashSet<String> =
            counts.into_iter().filter(|(_, count)| *count == 1).map(|(name, _)| name).collect();
        let single: HashSet<String> = single.into_iter().filter(|name| names.taken.insert(name.clone())).collect();
        for i in group {
            let base = base(&shapes[i]);
            given[i] = if single.contains(&base) { base } else { names.numbered(&base) };
        }
    }
    given.into_iter().zip(shapes).map(|(name, shape)| ImportedObstacle { name, shape }).collect()
}

#[derive(Default)]
pub(super) struct Names {
    taken: HashSet<String>,
    /// The last number used after a name.
    numbers: HashMap<String, usize>,
}

impl Names {
    /// Returns the names that these obstacles use.
    pub fn of(taken: &[ImportedObstacle]) -> Self {
        Self { taken: taken.iter().map(|taken| taken.name.clone()).collect(), ..Self::default() }
    }

    /// Returns a name that is not in use: `name` followed by the next free number.
    pub fn numbered(&mut self, name: &str) -> String {
        let number = self.numbers.entry(name.to_owned()).or_default();
        loop {
            *number += 1;
            let numbered = format!("{name} {number}");
            if self.taken.insert(numbered.clone()) {
                return numbered;
            }
        }
    }
}
