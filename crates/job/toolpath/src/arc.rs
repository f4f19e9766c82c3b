//! Arcs between two points, from a centre or a radius.

use crate::curve::{minus, norm};
use crate::{Curve, Point};
use std::f64::consts::TAU;

/// Greatest difference, metres, between the distances of both ends of an arc from its centre. Files round their numbers,
/// and the controller Grbl accepts the same difference.
const MAX_RADIUS_DIFFERENCE: f64 = 5e-6;

/// Greatest difference between these distances as a share of the radius, as in Grbl.
const MAX_RADIUS_SHARE: f64 = 1e-3;

/// Difference between these distances up to which an arc is one of a circle, metres. It is rounding.
const ROUNDING: f64 = 1e-12;

/// Turn up to which an arc counts as a whole turn, radians. It is rounding.
const LEAST_TURN: f64 = 1e-9;

/// Greatest share by which the radius of an arc may be too short for its ends. Then it is half their distance.
const RADIUS_ROUNDING: f64 = 1e-3;

/// Returns the arc about a centre, or the distances of both ends from the centre if they differ too much. The radius
/// changes linearly from the first end to the second. If both ends are in the same direction from the centre, the arc
/// is a whole turn.
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
    Curve::Arc { center, radius: norm(first), from: a, by, growth: 0.0 }
}
