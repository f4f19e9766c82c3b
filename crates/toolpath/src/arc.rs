//! Arcs between two points, from a centre or a radius.

use crate::curve::{minus, norm};
use crate::{Curve, Point};
use std::f64::consts::TAU;

/// Greatest displacement, metres, of a centre that makes it equally far from both ends of an arc. Files round their
/// numbers to a micrometre or so, which moves the centre.
const MAX_CENTER_SHIFT: f64 = 1e-5;

/// Greatest share by which the radius of an arc may be too short for its ends. Then it is half their distance.
const RADIUS_ROUNDING: f64 = 1e-3;

/// Returns the arc about a centre, or the distances of both ends from the centre if they differ. With equal ends it is
/// a whole circle.
pub(crate) fn about(from: Point, to: Point, center: Point, is_left: bool) -> Result<Curve, [f64; 2]> {
    let [first, last] = [minus(from, center), minus(to, center)];
    let radii = [norm(first), norm(last)];
    let chord = minus(to, from);
    let length = norm(chord);
    if radii[0] == 0.0 || radii[1] == 0.0 {
        return Err(radii);
    }
    if length == 0.0 {
        let by = if is_left { TAU } else { -TAU };
        return Ok(Curve::Arc { center, radius: radii[0], from: first[1].atan2(first[0]), by });
    }
    // The nearest point that is equally far from both ends.
    let shift = (radii[1] * radii[1] - radii[0] * radii[0]) / (2.0 * length);
    if shift.abs() > MAX_CENTER_SHIFT {
        return Err(radii);
    }
    let center = [0, 1].map(|k| center[k] + shift * chord[k] / length);
    Ok(between(from, to, center, is_left))
}

/// Returns the arc with a radius: at most half a circle, or the rest of the circle if the radius is negative. Returns
/// `None` if the ends are farther apart than twice the radius, or equal.
pub(crate) fn with_radius(from: Point, to: Point, radius: f64, is_left: bool) -> Option<Curve> {
    let chord = minus(to, from);
    let half = norm(chord) / 2.0;
    if half == 0.0 || half > radius.abs() * (1.0 + RADIUS_ROUNDING) {
        return None;
    }
    let aside = (radius * radius - half * half).max(0.0).sqrt();
    // The centre of a short arc is on the side to which the arc turns.
    let side = if (radius > 0.0) == is_left { 1.0 } else { -1.0 };
    let normal = [-chord[1] / (2.0 * half), chord[0] / (2.0 * half)];
    let center = [0, 1].map(|k| (from[k] + to[k]) / 2.0 + side * aside * normal[k]);
    Some(between(from, to, center, is_left))
}

fn between(from: Point, to: Point, center: Point, is_left: bool) -> Curve {
    let [first, last] = [minus(from, center), minus(to, center)];
    let [a, b] = [first, last].map(|v| v[1].atan2(v[0]));
    let by = (b - a).rem_euclid(TAU);
    let by = if is_left { by } else { by - TAU };
    Curve::Arc { center, radius: norm(first), from: a, by }
}
