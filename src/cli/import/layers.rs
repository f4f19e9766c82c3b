//! Selects the parts of a drawing, and decides whether they become solids or walls.

use super::advice::bounds;
use super::obstacles::{ImportedObstacle, Names, coordinates, rounded};
use crate::cli::failure::Failure;
use crate::input::MAX_LENGTH;
use crate::text::{counted, plain_line};
use cplan_drawing::{Geometry, Notes, Shape};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};
use std::str::FromStr;

/// A height from the command line: `NAME=LOW:HIGH`.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerHeight {
    name: String,
    height: [f64; 2],
}

impl FromStr for LayerHeight {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const LAYER_FORM: &str = "expected NAME=LOW:HIGH in metres, such as conveyor=0:0.2";
        let (name, range) = text.rsplit_once('=').ok_or(LAYER_FORM)?;
        let (low, high) = range.split_once(':').ok_or(LAYER_FORM)?;
        let height = [low, high].map(|number| number.trim().parse::<f64>().ok().filter(|x| x.abs() <= MAX_LENGTH));
        match height {
            [Some(low), Some(high)] if low <= high => Ok(Self { name: name.to_owned(), height: [low, high] }),
            [Some(_), Some(_)] => Err("write the lower end first".into()),
            _ => Err(LAYER_FORM.into()),
        }
    }
}

/// The options that refer to layers and names.
pub(super) struct Layers<'a> {
    pub only: &'a [String],
    pub without: &'a [String],
    pub heights: &'a [LayerHeight],
    pub walls: &'a [String],
    /// Least and greatest size of parts, in metres.
    pub sizes: [Option<f64>; 2],
    /// Greatest distance between a circle and the wall that replaces it, in metres.
    pub tolerance: f64,
}

/// Returns true if `name` is the name of an obstacle, its layer, or the hidden layer of a block that contains it.
fn is_called(taken: &ImportedObstacle, name: &str) -> bool {
    equals_ignoring_case(&taken.name, name) || taken.shape.called().iter().any(|own| equals_ignoring_case(own, name))
}

/// Returns true if two names are equal, ignoring upper and lower case.
fn equals_ignoring_case(name: &str, other: &str) -> bool {
    name.to_lowercase() == other.to_lowercase()
}

impl Layers<'_> {
    /// Checks that the drawing has all names to which options refer.
    pub fn check(&self, found: &[ImportedObstacle]) -> Result<(), Failure> {
        let only = self.only.iter().map(|name| ("--layer", name));
        let without = self.without.iter().map(|name| ("--without", name));
        let heights = self.heights.iter().map(|height| ("--height", &height.name));
        let walls = self.walls.iter().map(|name| ("--walls", name));
        let unknown = |(_, name): &(&str, &String)| !found.iter().any(|taken| is_called(taken, name));
        let Some((option, name)) = only.chain(without).chain(heights).chain(walls).find(unknown) else {
            return Ok(());
        };
        let known: BTreeSet<String> = found.iter().flat_map(|taken| taken.shape.called()).collect();
        const MAX_SHOWN_NAMES: usize = 24;
        let more = known.len().saturating_sub(MAX_SHOWN_NAMES);
        let known: Vec<String> = known.into_iter().take(MAX_SHOWN_NAMES).map(|name| format!("\"{name}\"")).collect();
        let known = match (known.is_empty(), more) {
            (true, _) => "no part of this drawing has a name or a layer".to_owned(),
            (false, 0) => format!("choose one of {}, or a name in the new world", known.join(", ")),
            (false, more) => format!("choose one of {} (and {more} more)", known.join(", ")),
        };
        Err(Failure::Refused(format!("{option}: the drawing has no layer or part \"{name}\"\n  hint: {known}")))
    }

    /// Returns true if the options select an obstacle that has one of these names.
    pub fn selects(&self, names: &[String]) -> bool {
        let among = |asked: &[String]| asked.iter().any(|name| names.iter().any(|own| equals_ignoring_case(own, name)));
        (self.only.is_empty() || among(self.only)) && !among(self.without)
    }

    /// Returns the selected obstacles. Sets the heights that options state, and converts outlines to walls where
    /// options request it.
    pub fn chosen(&self, found: Vec<ImportedObstacle>, notes: &mut Notes) -> Vec<ImportedObstacle> {
        let mut names = Names::of(&found);
        let mut chosen = Vec::new();
        for mut taken in found {
            let among = |asked: &[String]| asked.iter().any(|name| is_called(&taken, name));
            if !self.only.is_empty() && !among(self.only) || among(self.without) {
                continue;
            }
            // An obstacle that is selected by its own layer may still be in a block that is hidden as a whole.
            let shape = &taken.shape;
            let is_asked_for = |own: &String| self.only.iter().any(|name| equals_ignoring_case(own, name));
            let is_taken = || {
                [shape.hidden_by.as_ref(), shape.name.as_ref(), Some(&taken.name)]
                    .into_iter()
                    .flatten()
                    .any(is_asked_for)
            };
            if let Some(layer) = shape.hidden_by.as_ref().filter(|_| !is_taken()) {
                let message = format!("layer \"{layer}\" is switched off and left out; --layer imports it");
                notes.add_of(shape.called(), message, shape.line);
                continue;
            }
            let [least, most] = self.sizes;
            let size = size(shape);
            let is_small = least.filter(|least| size < *least).map(|least| format!("smaller than {least} m"));
            let is_large = || most.filter(|most| size > *most).map(|most| format!("larger than {most} m"));
            if let Some(why) = is_small.or_else(is_large) {
                notes.add_of(shape.called(), format!("parts {why}: left out"), shape.line);
                continue;
            }
            let is_wall = among(self.walls);
            if let Some(height) = self.heights.iter().rev().find(|height| is_called(&taken, &height.name)) {
                taken.shape.height = Some(height.height);
            }
            if is_wall {
                chosen.extend(walls(taken, self.tolerance, &mut names));
            } else {
                chosen.push(taken);
            }
        }
        chosen
    }
}

/// Returns the longer side of the box around a part, along the axes of the world.
fn size(shape: &Shape) -> f64 {
    let bounds = bounds(coordinates(shape));
    rounded(bounds.map(|(low, high)| high - low).into_iter().fold(0.0, f64::max))
}

/// Converts the outlines of an obstacle to thin walls.
fn walls(taken: ImportedObstacle, tolerance: f64, names: &mut Names) -> Vec<ImportedObstacle> {
    let rings = match taken.shape.geometry.clone() {
        Geometry::Polygon { outer, holes } => [outer].into_iter().chain(holes).collect(),
        Geometry::Circle { center, radius } => vec![chords(center, radius, tolerance)],
        Geometry::Polyline(_) => return vec![taken],
    };
    let is_one = rings.len() == 1;
    let mut wall = |mut ring: Vec<[f64; 2]>| {
        ring.extend(ring.first().copied());
        let name = if is_one { taken.name.clone() } else { names.numbered(&taken.name) };
        ImportedObstacle { name, shape: Shape { geometry: Geometry::Polyline(ring), ..taken.shape.clone() } }
    };
    rings.into_iter().map(&mut wall).collect()
}

/// Returns points on a circle whose chords are at most `tolerance` away from it.
fn chords([x, y]: [f64; 2], radius: f64, tolerance: f64) -> Vec<[f64; 2]> {
    const MIN_CHORDS: f64 = 8.0;
    let half = (1.0 - tolerance / radius).clamp(0.0, 1.0).acos();
    let count = (PI / half).ceil().clamp(MIN_CHORDS, 1e5) as usize;
    let at = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / count as f64).sin_cos();
        [x + radius * cos, y + radius * sin].map(rounded)
    };
    (0..count).map(at).collect()
}

/// Returns lines that state how many obstacles come from each layer.
pub(super) fn lines(taken: &[ImportedObstacle]) -> Vec<String> {
    let mut layers = BTreeMap::<&str, usize>::new();
    for layer in taken.iter().filter_map(|taken| taken.shape.layer.as_deref()) {
        *layers.entry(layer).or_default() += 1;
    }
    layers.into_iter().map(|(layer, count)| format!("{}: {}", plain_line(layer), counted(count, "obstacle"))).collect()
}
