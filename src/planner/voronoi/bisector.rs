//! Bisectors, as functions of the parameter of a site's rays.

use super::site::{Site, TOUCH};
use std::f64::consts::{PI, TAU};

/// Sides whose directions differ by less are one after the other: they have no bisector.
const PARALLEL: f64 = 1e-9;

/// How far up its rays a site is as near as another one. What is kept of that height `h` is a function that grows with it:
/// on a side the height itself, a polynomial; on a corner `-1 / h`, a wave. Of both the three coefficients, so that where two
/// bisectors meet is a closed form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bisector {
    /// Of `1, t, t^2`, or of `1, cos t, sin t`.
    coefficients: [f64; 3],
    on_side: bool,
    /// Where the nearest point of the other site is none of its ends.
    pub from: f64,
    pub to: f64,
    /// The other one.
    pub other: usize,
}

impl Bisector {
    /// Those of a site and another one, of which `other` is the number: two where a corner sees both ends of a side better than
    /// its middle.
    pub fn between(site: &Site, with: &Site, other: usize) -> impl Iterator<Item = Self> + use<> {
        let (parts, on_side) = match (site.is_side(), with.is_side()) {
            (true, true) => ([side_and_side(site, with), None, None], true),
            (true, false) => ([side_and_point(site, with), None, None], true),
            (false, true) => (point_and_side(site, with), false),
            (false, false) => ([point_and_point(site, with), None, None], false),
        };
        let extent = site.extent;
        let made = move |(coefficients, from, to): Part| {
            let (from, to) = (f64::max(from, 0.0), f64::min(to, extent));
            (from <= to).then_some(Self { coefficients, on_side, from, to, other })
        };
        parts.into_iter().flatten().filter_map(made)
    }

    /// Its value; the least one is the nearest.
    pub fn value(&self, t: f64) -> f64 {
        let [a, b, c] = self.coefficients;
        if self.on_side {
            return a + t * (b + t * c);
        }
        let (sin, cos) = t.sin_cos();
        a + b * cos + c * sin
    }

    /// Its slope.
    pub fn slope(&self, t: f64) -> f64 {
        let [_, b, c] = self.coefficients;
        if self.on_side {
            return b + 2.0 * t * c;
        }
        let (sin, cos) = t.sin_cos();
        c * cos - b * sin
    }

    /// The height that the value stands for.
    pub fn height(&self, t: f64) -> f64 {
        let value = self.value(t);
        match self.on_side {
            true => value.max(0.0),
            false if value < 0.0 => -1.0 / value,
            false => f64::INFINITY,
        }
    }

    /// How far a chord of length `step` is from a parabola over a side.
    pub fn sag(&self, step: f64) -> f64 {
        if self.on_side { self.coefficients[2] * step * step / 4.0 } else { 0.0 }
    }

    /// Where its value falls below another's: there is one such place at most, but for whole turns.
    pub fn falls_below(&self, other: &Self, from: f64) -> Option<f64> {
        let [c, b, a] = [0, 1, 2].map(|k| self.coefficients[k] - other.coefficients[k]);
        if self.on_side {
            // Of both zeros the one with a falling slope, without cancellation.
            let square = b * b - 4.0 * a * c;
            if square <= 0.0 {
                return None;
            }
            let root = square.sqrt();
            let at = if b > 0.0 { (-b - root) / (2.0 * a) } else { 2.0 * c / (root - b) };
            return at.is_finite().then_some(at);
        }
        let radius = a.hypot(b);
        if c.abs() >= radius {
            return None;
        }
        let at = a.atan2(b) + (-c / radius).acos();
        // The first one that is not before.
        Some(from + (at - from).rem_euclid(TAU))
    }
}

/// Coefficients, and from where to where.
type Part = ([f64; 3], f64, f64);

fn side_and_point(site: &Site, point: &Site) -> Option<Part> {
    let there = point.at - site.at;
    let (x, y) = (there.dot(&site.along), there.dot(&site.normal()));
    let parabola = || ([(x * x + y * y) / (2.0 * y), -x / y, 1.0 / (2.0 * y)], f64::NEG_INFINITY, f64::INFINITY);
    (y > TOUCH).then(parabola)
}

fn side_and_side(site: &Site, side: &Site) -> Option<Part> {
    // The height is the distance of the foot from the other side by how much slower the height over that one changes.
    let turned = site.normal() - side.normal();
    let apart = turned.norm_squared() / 2.0;
    if turned.norm() < PARALLEL {
        return None;
    }
    let there = site.at - side.at;
    let height = [there.dot(&side.normal()) / apart, site.along.dot(&side.normal()) / apart];
    let rise = site.normal().dot(&side.along);
    let foot = [there.dot(&side.along) + height[0] * rise, site.along.dot(&side.along) + height[1] * rise];
    let range = [(height[0], height[1]), (foot[0], foot[1]), (side.extent - foot[0], -foot[1])];
    let (from, to) = range.into_iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(from, to), (value, slope)| {
        // Where `value + slope * t` is not negative.
        match -value / slope {
            at if slope > 0.0 => (at.max(from), to),
            at if slope < 0.0 => (from, at.min(to)),
            _ if value >= 0.0 => (from, to),
            _ => (f64::INFINITY, f64::NEG_INFINITY),
        }
    });
    (from <= to).then_some(([height[0], height[1], 0.0], from, to))
}

fn point_and_point(site: &Site, point: &Site) -> Option<Part> {
    let there = point.at - site.at;
    let square = there.norm_squared();
    let wave = || {
        let rate = -2.0 / square;
        ([0.0, rate * there.dot(&site.along), rate * there.dot(&site.normal())], 0.0, site.extent)
    };
    (square > TOUCH * TOUCH).then(wave)
}

fn point_and_side(site: &Site, side: &Site) -> [Option<Part>; 3] {
    let there = site.at - side.at;
    let away = there.dot(&side.normal());
    if away <= TOUCH {
        return [None; 3];
    }
    let wave = [-1.0 / away, side.normal().dot(&site.along) / away, side.normal().dot(&site.normal()) / away];
    // Seen from the ray that goes straight to the side, by the angle to it: the foot is as far along as its half's tangent says.
    let straight = -side.normal();
    let begin = crate::geometry::cross(site.along, straight).atan2(site.along.dot(&straight));
    let foot = there.dot(&side.along);
    let [from, to] = [-foot, side.extent - foot].map(|along| begin + 2.0 * (along / away).atan());
    debug_assert!(to - from <= TAU && begin.abs() <= PI);
    [-TAU, 0.0, TAU]
        .map(|turn| Some((wave, from + turn, to + turn)).filter(|part| part.1 <= site.extent && part.2 >= 0.0))
}
