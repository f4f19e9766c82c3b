//! Cusps of cubic curves: places where a curve turns back, or almost does.

use crate::curve::norm;
use crate::heading::mixed;
use crate::{Curve, Point};

/// Number of intervals in which a curve's slowest places are sought.
const INTERVALS: u32 = 64;

/// A place is a cusp if the speed of the parameter there is below this share of its greatest value.
const CUSP_SHARE: f64 = 0.25;

/// Number of golden sections that locate a slowest place.
const SECTIONS: u32 = 40;

/// Returns the parts of a curve between its cusps, in order. Curves without a cusp stay whole.
pub(crate) fn parts(curve: &Curve) -> Vec<Curve> {
    let Curve::Cubic(points) = *curve else { return vec![*curve] };
    let speed = |u: f64| norm(curve.derivative(u));
    let at = |k: u32| f64::from(k) / f64::from(INTERVALS);
    let speeds: Vec<f64> = (0..=INTERVALS).map(|k| speed(at(k))).collect();
    let fastest = speeds.iter().copied().fold(0.0, f64::max);
    let is_least = |k: &u32| {
        let here = speeds[*k as usize];
        here < CUSP_SHARE * fastest && here <= speeds[*k as usize - 1] && here < speeds[*k as usize + 1]
    };
    let (mut rest, mut done, mut parts) = (points, 0.0, Vec::new());
    for k in (1..INTERVALS).filter(is_least) {
        let cusp = least([at(k - 1), at(k + 1)], speed);
        let [first, second] = cut(rest, (cusp - done) / (1.0 - done));
        parts.push(Curve::Cubic(first));
        (rest, done) = (second, cusp);
    }
    parts.push(Curve::Cubic(rest));
    parts
}

/// Returns the parameter between two others at which a function is least.
fn least([mut low, mut high]: [f64; 2], value: impl Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    for _ in 0..SECTIONS {
        let [a, b] = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        if value(a) <= value(b) { high = b } else { low = a }
    }
    (low + high) / 2.0
}

/// Cuts a cubic Bézier curve in two at a parameter, by de Casteljau's algorithm.
fn cut([a, b, c, d]: [Point; 4], u: f64) -> [[Point; 4]; 2] {
    let [ab, bc, cd] = [mixed(a, b, u), mixed(b, c, u), mixed(c, d, u)];
    let [abc, bcd] = [mixed(ab, bc, u), mixed(bc, cd, u)];
    let middle = mixed(abc, bcd, u);
    [[a, ab, abc, middle], [middle, bcd, cd, d]]
}
