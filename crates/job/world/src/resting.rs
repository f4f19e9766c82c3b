//! Decides whether objects have something to rest on where a task places them.

use super::group::Leaf;
use super::sequence::{ObjectPlace, Writer};
use cplan_geometry::{Convex, Pose, separation};
use cplan_model::{Heights, RESTING_TOLERANCE};
use cplan_robot::Diagnostic;
use cplan_text::{length, short};

impl Writer<'_> {
    /// Returns the elevation at which the object's bottom is at `height`, both in metres. Without a height, returns the elevation
    /// at which the object was picked.
    ///
    /// # Errors
    /// An object that states no heights, or a height above that at which the object is carried.
    pub(super) fn elevation(&self, leaf: &Leaf, object: usize, height: Option<f64>) -> Result<f64, Diagnostic> {
        let Some(height) = height else { return Ok(self.object_places[object].elevation) };
        let object = &self.objects[object].object;
        let refuse = |message: String, help: &str| {
            let message = format!("step {}: {message}", leaf.number);
            Err(self.reader.source.diagnostic_at(leaf.at.clone(), message).help(help))
        };
        if !object.heights.lower.is_finite() {
            let message = format!("the place has a height, but object \"{}\" has none", object.name);
            return refuse(message, "add height = [LOWER, UPPER] to the object, or remove the height of the place");
        }
        let elevation = height - object.heights.lower;
        if elevation > object.lift + RESTING_TOLERANCE {
            let carried = length(object.heights.lower + object.lift);
            let message = format!(
                "object \"{}\" is placed at a height of {}, above the height at which it is carried, {carried}",
                object.name,
                length(height)
            );
            return refuse(message, "give the object more lift, or choose a lower place");
        }
        Ok(if elevation.abs() <= RESTING_TOLERANCE { 0.0 } else { elevation })
    }

    /// Returns true if the top of an obstacle or of another object is at the height of the object's bottom there. An object that
    /// extends over all heights needs no support.
    pub(super) fn is_carried(&self, object: usize, place: &ObjectPlace) -> bool {
        let own = &self.objects[object].object;
        let bottom = own.heights_at(place.elevation).lower;
        if !bottom.is_finite() {
            return true;
        }
        let shapes = match place.angle {
            Some(angle) => own.pieces.iter().map(|piece| piece.at(&Pose::new(place.at, angle))).collect(),
            // The disc about its origin covers the object in every orientation.
            None => {
                let reach = own.pieces.iter().map(|piece| piece.reach_from(Pose::identity().translation));
                vec![Convex::trusted(vec![place.at], reach.fold(0.0, f64::max))]
            }
        };
        let ends = |heights: Heights| (heights.upper - bottom).abs() <= RESTING_TOLERANCE;
        let is_below = |piece: &Convex| shapes.iter().any(|shape| separation(shape, piece).distance <= 0.0);
        let others = self.objects.iter().zip(&self.object_places).enumerate().filter(|(other, _)| *other != object);
        self.obstacles.iter().any(|obstacle| ends(obstacle.heights) && obstacle.pieces.iter().any(is_below))
            || others.filter(|(_, (other, at))| ends(other.object.heights_at(at.elevation))).any(|(_, (other, at))| {
                let pose = Pose::new(at.at, at.angle.unwrap_or(0.0));
                other.object.pieces.iter().any(|piece| is_below(&piece.at(&pose)))
            })
    }

    /// Notes that a surface is assumed at the stated height of a place.
    pub(super) fn note_surface(&self, object: usize, place: &ObjectPlace) {
        let object = &self.objects[object].object;
        let bottom = length(object.heights_at(place.elevation).lower);
        let note = format!(
            "placed at the stated height of {bottom}; no obstacle or object ends at this height, so a surface is assumed there"
        );
        self.reader.taken.note(&format!("\"{}\"", object.name), note);
    }

    /// Returns the error that nothing carries an object at a place.
    pub(super) fn in_the_air(&self, leaf: &Leaf, object: usize, place: &ObjectPlace) -> Diagnostic {
        let object = &self.objects[object].object;
        let (x, y) = (short(place.at.x), short(place.at.y));
        let message = format!(
            "step {}: object \"{}\" would hang in the air at ({x}, {y}) m: its bottom is at a height of {}, but no obstacle or object below ends at this height",
            leaf.number,
            object.name,
            length(object.heights_at(place.elevation).lower)
        );
        let help =
            "state the height of the surface: place = { at = [x, y], height = 0.0 }, or height = 0.0 in the [[pallet]]";
        self.reader.source.diagnostic_at(leaf.at.clone(), message).help(help)
    }
}
