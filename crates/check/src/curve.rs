//! Curves of joint values in Bezier form, and enclosures of their stretches.

use crate::decimal::Decimal;
use crate::interval::{BITS, Interval, Point};
use num_bigint::BigInt;

/// Binary digits after the point of joint values in this module: values are multiples of `2^-FRACTION_BITS`.
pub const FRACTION_BITS: u32 = 72;

/// Binary digits before the point of joint values. Values are below `2^INTEGER_BITS`, so sums and products do not overflow.
pub const INTEGER_BITS: u32 = 28;

/// Binary digits of a fraction of a chord: fractions are multiples of `2^-SHARE_BITS`.
const SHARE_BITS: u32 = 20;

/// Maximum number of times that curves are halved.
pub const MAX_HALVINGS: u32 = 40;

/// Maximum number of times that a piece may already have been halved before the check. A hundredth of a second then
/// becomes less than a nanosecond.
pub const MAX_PRIOR_HALVINGS: u32 = 24;

/// Bound on the rounding error of a control point, in units of `2^-FRACTION_BITS`. Initially it is less than two units.
/// Each halving adds at most five, one for each of its steps. The computations of a tube add less than one.
const ROUNDING_UNITS: i128 = 3 + 5 * (MAX_HALVINGS + MAX_PRIOR_HALVINGS) as i128;

/// Both joints' values, in units of `2^-FRACTION_BITS`.
pub type Values = [i128; 2];

/// The motion between two knots.
#[derive(Clone)]
pub struct Piece {
    /// The knot at which it begins.
    pub knot: usize,
    /// Control points of a Bezier curve for each interpolation.
    pub curves: Vec<Vec<Values>>,
    /// Times at which the piece begins and ends, seconds after the start of the motion.
    pub time: [Decimal; 2],
}

impl Piece {
    /// Returns the same piece with joint 1 at zero.
    pub fn of_second(&self) -> Self {
        let curve = |curve: &Vec<Values>| curve.iter().map(|[_, second]| [0, *second]).collect();
        Self { curves: self.curves.iter().map(curve).collect(), ..self.clone() }
    }

    /// Returns both halves of the piece.
    pub fn halves(&self) -> [Self; 2] {
        let middle = |[a, b]: &Values, [c, d]: &Values| [(a + c) >> 1, (b + d) >> 1];
        let halves: Vec<[Vec<Values>; 2]> = self.curves.iter().map(|curve| halves(curve, middle)).collect();
        let [begin, end] = &self.time;
        let middle = Decimal::middle(begin, end);
        let half = |k: usize, time| Self {
            knot: self.knot,
            curves: halves.iter().map(|both| both[k].clone()).collect(),
            time,
        };
        [half(0, [begin.clone(), middle.clone()]), half(1, [middle, end.clone()])]
    }
}

/// Returns the control points of both halves of a curve, by de Casteljau's algorithm. `middle` returns the point
/// between two points.
pub fn halves<T: Clone>(curve: &[T], middle: impl Fn(&T, &T) -> T) -> [Vec<T>; 2] {
    let (mut first, mut second) = (Vec::new(), Vec::new());
    let mut points = curve.to_vec();
    while let [from, .., to] = &points[..] {
        first.push(from.clone());
        second.push(to.clone());
        points = points.windows(2).map(|pair| middle(&pair[0], &pair[1])).collect();
    }
    first.extend(points.clone());
    second.extend(points);
    second.reverse();
    [first, second]
}

/// All configurations `middle + t half + b`, where `t` is from -1 to 1, and `b` is from `-beside` to `beside` in each
/// joint.
pub struct Tube {
    /// The configuration in the middle of the tube.
    pub middle: Point,
    half: Point,
    beside: Point,
}

impl Tube {
    /// Returns a tube that contains consecutive pieces. It contains all their control points exactly, and so their convex hull.
    /// Its direction is that of the chord from the first point to the last, which affects only the width of the tube.
    pub fn containing(pieces: &[Piece]) -> Self {
        let points = || pieces.iter().flat_map(|piece| piece.curves.iter().flatten());
        let end = |curve: &Vec<Values>| *curve.last().expect("a curve has points");
        let (from, to) = (pieces[0].curves[0][0], end(&pieces[pieces.len() - 1].curves[0]));
        let middle = [0, 1].map(|k| (from[k] + to[k]) >> 1);
        let half = [0, 1].map(|k| (to[k] - from[k]) >> 1);
        let [h1, h2] = half.map(|h| h as f64);
        let square = h1 * h1 + h2 * h2;
        let mut beside = [0; 2];
        for point in points() {
            let off = [0, 1].map(|k| point[k] - middle[k]);
            let share = if square > 0.0 { (off[0] as f64 * h1 + off[1] as f64 * h2) / square } else { 0.0 };
            let share = (share.clamp(-1.0, 1.0) * f64::from(1 << SHARE_BITS)) as i128;
            for k in 0..2 {
                beside[k] = beside[k].max((off[k] - ((half[k] * share) >> SHARE_BITS)).abs());
            }
        }
        let exactly = |values: Values| values.map(|n| Interval::exact(BigInt::from(n) << (BITS - FRACTION_BITS)));
        Self { middle: exactly(middle), half: exactly(half), beside: exactly(beside.map(|b| b + ROUNDING_UNITS)) }
    }

    /// Makes a tube around a single configuration.
    pub fn at_configuration(middle: Point) -> Self {
        let zero = || [0, 0].map(Interval::whole);
        Self { middle, half: zero(), beside: zero() }
    }

    /// Returns an upper bound on `abs(g1 d1 + g2 d2)` for all deviations `d` of the tube's configurations from its
    /// middle.
    pub fn greatest(&self, g: &Point) -> Interval {
        let along = &(&g[0] * &self.half[0]) + &(&g[1] * &self.half[1]);
        let beside = &(&g[0].abs() * &self.beside[0]) + &(&g[1].abs() * &self.beside[1]);
        &along.abs() + &beside
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Evaluates a curve at a fraction `t`, in floating point.
    fn evaluate(curve: &[Values], t: f64) -> [f64; 2] {
        let mut points: Vec<[f64; 2]> =
            curve.iter().map(|p| p.map(|c| c as f64 / 2f64.powi(FRACTION_BITS as i32))).collect();
        while points.len() > 1 {
            points = points.windows(2).map(|p| [0, 1].map(|k| p[0][k] + t * (p[1][k] - p[0][k]))).collect();
        }
        points[0]
    }

    fn piece() -> Piece {
        let unit = |n: [i128; 2]| n.map(|c| c << (FRACTION_BITS - 4));
        let cubic = [[0, 0], [9, 3], [-4, 20], [30, 7]].map(unit).to_vec();
        let quartic = [[0, 0], [5, 5], [-1, 2], [9, 9], [30, 7]].map(unit).to_vec();
        Piece { knot: 3, curves: vec![cubic, quartic], time: [0, 1].map(Decimal::whole) }
    }

    #[test]
    fn halves_together_equal_the_curve() {
        let whole = piece();
        let [first, second] = whole.halves();
        for k in 0..2 {
            for step in 0..=8 {
                let t = f64::from(step) / 8.0;
                for (part, from) in [(&first, 0.0), (&second, 0.5)] {
                    let (is, should) = (evaluate(&part.curves[k], t), evaluate(&whole.curves[k], from + t / 2.0));
                    assert!((0..2).all(|c| (is[c] - should[c]).abs() < 1e-12), "{is:?} {should:?}");
                }
            }
        }
        assert_eq!((first.knot, second.knot), (3, 3));
    }

    #[test]
    fn a_tube_holds_its_pieces() {
        let whole = piece();
        let [first, second] = whole.halves();
        for pieces in [vec![whole], vec![first.clone()], vec![first, second]] {
            let tube = Tube::containing(&pieces);
            let number = |i: &Interval| i.lower.to_string().parse::<f64>().unwrap() / 2f64.powi(BITS as i32);
            for g in [[1, 0], [0, 1], [1, 1], [1, -1], [-2, 3]] {
                let bound = number(&tube.greatest(&g.map(Interval::whole)));
                let of =
                    |q: [f64; 2]| (0..2).map(|k| f64::from(g[k]) * (q[k] - number(&tube.middle[k]))).sum::<f64>().abs();
                let samples = pieces
                    .iter()
                    .flat_map(|p| &p.curves)
                    .flat_map(|c| (0..=50).map(|i| evaluate(c, f64::from(i) / 50.0)));
                let most = samples.map(of).fold(0.0, f64::max);
                assert!(most <= bound + 1e-12 && bound < 3.0 * most + 1.0, "{g:?}: {most} {bound}");
            }
        }
    }
}
