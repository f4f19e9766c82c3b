//! Arcs between two points, given by a centre or a radius.

use crate::curve::{minus, norm};
use crate::{Curve, Point};
use std::f64::consts::TAU;

/// An arc's two ends may differ by this in their distance from its centre, metres. Files round their numbers, and the controller
/// Grbl accepts the same difference.
const MAX_RADIUS_DIFFERENCE: f64 = 5e-6;

/// The same difference as a share of the radius, as in Grbl. Larger arcs may have larger differences.
const MAX_RADIUS_SHARE: f64 = 1e-3;

/// A smaller difference is rounding, metres: the arc is part of a circle.
const ROUNDING: f64 = 1e-12;

/// An arc that turns by less, radians, is a whole turn: the rest is rounding.
const LEAST_TURN: f64 = 1e-9;

/// If the radius is too short for the ends of the arc by at most this share, half their distance replaces it.
const RADIUS_ROUNDING: f64 = 1e-3;

/// Returns the arc about a centre, whose radius changes linearly from the first end to the second. If both ends are in the same
/// direction from the centre, the arc is a whole turn. If their distances from the centre differ too much, returns these
/// distances as the error.
pub(crate) fn about(from: Point, to: Point, center: Point, is_left: bool) -> Result<Curve, [f64; 2]> {
    let radii = [from, to].map(|end| norm(minus(end, center)));
    let growth = radii[1] - radii[0];
    let is_spiral = growth.abs() > MAX_RADIUS_DIFFERENCE && growth.abs() > MAX_RADIUS_SHARE * radii[0];
    if radii.contains(&0.0) || is_spiral {
        return Err(radii);
    }
    let growth = if growth.abs() > ROUNDING { growth } else { 0.0 };
    let curve = between(from, to, center, is_left);
    let Curve::Arc { center, radius, from, by, .. } = curve else { return Ok(curve) };
    let is_whole = by.abs() < LEAST_TURN || by.abs() > TAU - LEAST_TURN;
    let by = if is_whole { if is_left { TAU } else { -TAU } } else { by };
    Ok(Curve::Arc { center, radius, from, by, growth })
}

/// Returns the arc with a radius: at most half a circle or, if the radius is negative, the longer arc. Returns `None` if the ends
/// are equal, or farther apart than twice the radius.
pub(crate) fn with_radius(from: Point, to: Point, radius: f64, is_left: bool) -> Option<Curve> {
    let chord = minus(to, from);
    let half = norm(chord) / 2.0;
    if half == 0.0 || half > radius.abs() * (1.0 + RADIUS_ROUNDING) {
        return None;
    }
    let aside = (radius * radius - half * half).max(0.0).sqrt();
    // The centre of a short arc is on the side to which the arc turns; that of a long arc is on the other side.
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
    Curve::Arc { center, radius: norm(first), from: a, by, growth: 0.0 }
}
