//! Bisectors of two sites: functions of the parameter of one site's rays.

use super::site::{CONTACT_DISTANCE, Site};
use cplan_geometry::cross;
use std::f64::consts::PI;

/// Sides count as parallel if the sine of their angle is smaller. Such sides lie on one line, one after the other, and have no
/// bisector.
const PARALLEL_SINE: f64 = 1e-9;

/// The points that are equally near to a site and another one, given by their heights on the rays of the site. The height is the
/// distance along the ray.
///
/// A quadratic polynomial in the rays' parameter `t` has values that increase with the height `h`: `h` itself for a side,
/// `-(1 + t^2) / h` for a corner. The sign of the difference of two such polynomials shows which of two other sites is nearer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bisector {
    /// Coefficients of `1, t, t^2`.
    coefficients: [f64; 3],
    on_side: bool,
    /// The ends of the range of parameters for which the nearest point of the other site is not one of its ends. Elsewhere, the
    /// bisector does not apply.
    pub from: f64,
    pub to: f64,
    /// Index of the other site.
    pub other: usize,
}

impl Bisector {
    /// Returns the bisectors of a site with the other site `with`, whose index is `other`. There are two if the site is a corner
    /// that is nearer to both ends of a side than to its middle.
    pub fn between(site: &Site, with: &Site, other: usize) -> impl Iterator<Item = Self> + use<> {
        let (parts, on_side) = match (site.is_side, with.is_side) {
            (true, true) => ([side_and_side(site, with), None, None], true),
            (true, false) => ([side_and_point(site, with), None, None], true),
            (false, true) => (point_and_side(site, with), false),
            (false, false) => ([point_and_point(site, with), None, None], false),
        };
        let [first, last] = site.range;
        let made = move |(coefficients, from, to): Part| {
            let (from, to) = (f64::max(from, first), f64::min(to, last));
            (from <= to).then_some(Self { coefficients, on_side, from, to, other })
        };
        parts.into_iter().flatten().filter_map(made)
    }

    /// Returns the polynomial's value. The site with the least value is nearest.
    pub fn value(&self, t: f64) -> f64 {
        let [a, b, c] = self.coefficients;
        a + t * (b + t * c)
    }

    /// Returns the slope of the polynomial.
    pub fn slope(&self, t: f64) -> f64 {
        let [_, b, c] = self.coefficients;
        b + 2.0 * t * c
    }

    /// Returns the height on the ray of parameter `t`.
    pub fn height(&self, t: f64) -> f64 {
        let value = self.value(t);
        match self.on_side {
            true => value.max(0.0),
            false if value < 0.0 => -(1.0 + t * t) / value,
            false => f64::INFINITY,
        }
    }

    /// Returns the distance between the parabola over a side and a chord, for parameters that differ by `step`. Zero for corners.
    pub fn sag(&self, step: f64) -> f64 {
        if self.on_side { self.coefficients[2] * step * step / 4.0 } else { 0.0 }
    }

    /// Returns the only parameter at which the value falls below that of `other`. `None` if it never does.
    pub fn falls_below(&self, other: &Self) -> Option<f64> {
        let [c, b, a] = [0, 1, 2].map(|k| self.coefficients[k] - other.coefficients[k]);
        let square = b * b - 4.0 * a * c;
        if square <= 0.0 {
            return None;
        }
        // The zero with a falling slope, computed without cancellation.
        let root = square.sqrt();
        let at = if b > 0.0 { (-b - root) / (2.0 * a) } else { 2.0 * c / (root - b) };
        at.is_finite().then_some(at)
    }
}

/// Returns the polynomial for `a + b cos(x) + c sin(x)`, times `1 + t^2`, where `t = tan(x / 2)`.
fn of_wave([a, b, c]: [f64; 3]) -> [f64; 3] {
    [a + b, 2.0 * c, a - b]
}

/// The coefficients of a bisector, and the ends of its range of parameters.
type Part = ([f64; 3], f64, f64);

fn side_and_point(site: &Site, point: &Site) -> Option<Part> {
    let there = point.at - site.at;
    let (x, y) = (there.dot(&site.along), there.dot(&site.normal()));
    let parabola = || ([(x * x + y * y) / (2.0 * y), -x / y, 1.0 / (2.0 * y)], f64::NEG_INFINITY, f64::INFINITY);
    (y > CONTACT_DISTANCE).then(parabola)
}

fn side_and_side(site: &Site, side: &Site) -> Option<Part> {
    // The height is the distance of the ray's foot from the other side, divided by the difference of the rates at which the
    // distances from both sides change.
    let turned = site.normal() - side.normal();
    let apart = turned.norm_squared() / 2.0;
    if turned.norm() < PARALLEL_SINE {
        return None;
    }
    let there = site.at - side.at;
    let height = [there.dot(&side.normal()) / apart, site.along.dot(&side.normal()) / apart];
    let rise = site.normal().dot(&side.along);
    let foot = [there.dot(&side.along) + height[0] * rise, site.along.dot(&side.along) + height[1] * rise];
    let range = [(height[0], height[1]), (foot[0], foot[1]), (side.range[1] - foot[0], -foot[1])];
    let (from, to) = range.into_iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(from, to), (value, slope)| {
        // The parameters at which `value + slope * t` is not negative.
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
        let wave = [0.0, rate * there.dot(&site.along), rate * there.dot(&site.normal())];
        (of_wave(wave), f64::NEG_INFINITY, f64::INFINITY)
    };
    (square > CONTACT_DISTANCE * CONTACT_DISTANCE).then(wave)
}

fn point_and_side(site: &Site, side: &Site) -> [Option<Part>; 3] {
    let there = site.at - side.at;
    let away = there.dot(&side.normal());
    if away <= CONTACT_DISTANCE {
        return [None; 3];
    }
    let wave = [-1.0 / away, side.normal().dot(&site.along) / away, side.normal().dot(&site.normal()) / away];
    // Half the angle from the middle ray to the ray through an end of the side. From the ray perpendicular to the side, the
    // tangent of the angle is the distance along the side divided by the distance from it.
    let straight = -side.normal();
    let begin = 0.5 * cross(site.along, straight).atan2(site.along.dot(&straight));
    let foot = there.dot(&side.along);
    let ends = [-foot, side.range[1] - foot].map(|along| begin + (along / away).atan());
    let least = [0, 1].map(|k| site.range[k].atan());
    [-PI, 0.0, PI].map(|turn| {
        let [from, to] = [(ends[0] + turn).max(least[0]), (ends[1] + turn).min(least[1])];
        (from <= to).then(|| (of_wave(wave), from.tan(), to.tan()))
    })
}
