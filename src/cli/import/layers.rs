//! Which parts of a drawing are taken, and as what.

use super::Failure;
use super::obstacles::Taken;
use crate::input::LARGEST;
use crate::text::{counted, plain_line};
use cplan_drawing::{Geometry, Notes, Shape};
use std::collections::{BTreeMap, BTreeSet};
use std::str::FromStr;

/// `NAME=LOW:HIGH`.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerHeight {
    name: String,
    height: [f64; 2],
}

impl FromStr for LayerHeight {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const FORM: &str = "expected NAME=LOW:HIGH in metres, such as conveyor=0:0.2";
        let (name, range) = text.rsplit_once('=').ok_or(FORM)?;
        let (low, high) = range.split_once(':').ok_or(FORM)?;
        let height = [low, high].map(|number| number.trim().parse::<f64>().ok().filter(|x| x.abs() <= LARGEST));
        match height {
            [Some(low), Some(high)] if low <= high => Ok(Self { name: name.to_owned(), height: [low, high] }),
            [Some(_), Some(_)] => Err("the lower end comes first".into()),
            _ => Err(FORM.into()),
        }
    }
}

/// What the options say of layers and names.
pub(super) struct Layers<'a> {
    pub only: &'a [String],
    pub heights: &'a [LayerHeight],
    pub walls: &'a [String],
}

/// Whether a shape, what it lies on or what hides it has this name.
fn is_called(shape: &Shape, name: &str) -> bool {
    names(shape).any(|own| is_same(own, name))
}

/// Names are the same in upper and lower case.
fn is_same(name: &str, other: &str) -> bool {
    name.to_lowercase() == other.to_lowercase()
}

fn names(shape: &Shape) -> impl Iterator<Item = &String> {
    [&shape.layer, &shape.name, &shape.hidden_by].into_iter().flatten()
}

impl Layers<'_> {
    /// Refuses names that the drawing does not have.
    pub fn check(&self, shapes: &[Shape]) -> Result<(), Failure> {
        let only = self.only.iter().map(|name| ("--layer", name));
        let heights = self.heights.iter().map(|height| ("--height", &height.name));
        let walls = self.walls.iter().map(|name| ("--walls", name));
        let unknown = |(_, name): &(&str, &String)| !shapes.iter().any(|shape| is_called(shape, name));
        let Some((option, name)) = only.chain(heights).chain(walls).find(unknown) else { return Ok(()) };
        let known: BTreeSet<&String> = shapes.iter().flat_map(names).collect();
        const SHOWN: usize = 24;
        let more = known.len().saturating_sub(SHOWN);
        let known: Vec<String> = known.into_iter().take(SHOWN).map(|name| format!("\"{name}\"")).collect();
        let known = match (known.is_empty(), more) {
            (true, _) => "nothing that is taken of the drawing has a name or a layer".to_owned(),
            (false, 0) => format!("the drawing has {}", known.join(", ")),
            (false, more) => format!("the drawing has {} and {more} more", known.join(", ")),
        };
        Err(Failure::Option(format!("{option}: the drawing has nothing called \"{name}\"\n  cure: {known}")))
    }

    /// The shapes that are taken, with what the options say of them.
    pub fn chosen(&self, shapes: Vec<Shape>, notes: &mut Notes) -> Vec<Shape> {
        let mut chosen = Vec::new();
        for mut shape in shapes {
            if !self.only.is_empty() && !self.only.iter().any(|name| is_called(&shape, name)) {
                continue;
            }
            // What is asked for by its own layer alone may still lie in a block that is hidden as a whole.
            let is_asked_for = |own: &String| self.only.iter().any(|name| is_same(own, name));
            let is_taken = || [&shape.hidden_by, &shape.name].into_iter().flatten().any(is_asked_for);
            if let Some(layer) = shape.hidden_by.as_ref().filter(|_| !is_taken()) {
                notes.add(format!("layer \"{layer}\" is switched off: left out, --layer takes it"), shape.line);
                continue;
            }
            if let Some(height) = self.heights.iter().rev().find(|height| is_called(&shape, &height.name)) {
                shape.height = Some(height.height);
            }
            if self.walls.iter().any(|name| is_called(&shape, name)) {
                chosen.extend(walls(shape));
            } else {
                chosen.push(shape);
            }
        }
        chosen
    }
}

/// The outlines of a shape as thin walls.
fn walls(shape: Shape) -> Vec<Shape> {
    let Geometry::Polygon { outer, holes } = shape.geometry.clone() else { return vec![shape] };
    let wall = |mut ring: Vec<[f64; 2]>| {
        ring.extend(ring.first().copied());
        Shape { geometry: Geometry::Polyline(ring), ..shape.clone() }
    };
    [outer].into_iter().chain(holes).map(wall).collect()
}

/// What was taken of each layer.
pub(super) fn lines(taken: &[Taken]) -> Vec<String> {
    let mut layers = BTreeMap::<&str, usize>::new();
    for layer in taken.iter().filter_map(|taken| taken.shape.layer.as_deref()) {
        *layers.entry(layer).or_default() += 1;
    }
    layers.into_iter().map(|(layer, count)| format!("{}: {}", plain_line(layer), counted(count, "obstacle"))).collect()
}
