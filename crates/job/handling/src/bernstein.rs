//! Polynomials, given by their Bernstein coefficients.

use std::ops::{Add, Mul, Sub};

/// Number of times that an interval with a zero is halved, which locates the zero as precisely as doubles allow.
const MAX_HALVINGS: usize = 60;

/// A polynomial of degree `n`, at most 5. Its value at `u`, from 0 to 1, is `sum binomial(n, i) u^i (1 - u)^(n - i) c_i`. The
/// weights of the coefficients `c_i` are positive and add up to 1, so nothing cancels, and all values are between the least and
/// the greatest coefficient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Polynomial<T> {
    /// The coefficients are the first `count` entries.
    coefficients: [T; 6],
    count: usize,
}

impl<T> Polynomial<T>
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>,
{
    /// Creates the polynomial with these coefficients, of which there are one to six.
    pub fn new<const N: usize>(given: [T; N]) -> Self {
        let mut coefficients = [given[N - 1]; 6];
        coefficients[..N].copy_from_slice(&given);
        Self { coefficients, count: N }
    }

    pub fn coefficients(&self) -> &[T] {
        &self.coefficients[..self.count]
    }

    pub fn degree(&self) -> usize {
        self.count - 1
    }

    /// Returns the value at `u`, by repeated interpolation (de Casteljau). Exact at both ends.
    pub fn at(&self, u: f64) -> T {
        self.polar(|_| u)
    }

    /// Evaluates the polar form: like [`Polynomial::at`], but with a separate value of `u` for each step.
    fn polar(&self, share: impl Fn(usize) -> f64) -> T {
        let mut rest = self.coefficients;
        for step in 0..self.degree() {
            let u = share(step);
            for i in 0..self.degree() - step {
                // Written like this, interpolation is exact at both ends.
                rest[i] = rest[i] * (1.0 - u) + rest[i + 1] * u;
            }
        }
        rest[0]
    }

    /// Returns the derivative of this order by `u`, divided by `n (n - 1) ...`. `None` if the order exceeds the degree.
    pub fn differences(&self, order: usize) -> Option<Self> {
        let mut next = *self;
        for _ in 0..order {
            next.count = next.count.checked_sub(1).filter(|count| *count > 0)?;
            for i in 0..next.count {
                next.coefficients[i] = next.coefficients[i + 1] - next.coefficients[i];
            }
        }
        Some(next)
    }

    /// Returns the polynomial of one component of each coefficient.
    pub fn map(&self, component: impl Fn(T) -> f64) -> Polynomial<f64> {
        Polynomial { coefficients: self.coefficients.map(component), count: self.count }
    }
}

impl Polynomial<f64> {
    /// Returns the part of the polynomial from `u = from` to `u = to`, as a polynomial over 0 to 1.
    pub fn restricted(&self, from: f64, to: f64) -> Self {
        let mut part = *self;
        for ends in 0..self.count {
            part.coefficients[ends] = self.polar(|step| if step < ends { to } else { from });
        }
        part
    }

    /// Returns the zeros between 0 and 1, ascending. Zeros at which the sign does not change may be missing.
    pub fn zeros(&self) -> Vec<f64> {
        let one_sign = |sign: f64| self.coefficients().iter().all(|c| c * sign > 0.0);
        if one_sign(1.0) || one_sign(-1.0) {
            return Vec::new();
        }
        let inside = |u: &f64| 0.0 < *u && *u < 1.0;
        match *self.coefficients() {
            [a, b] => Some(a / (a - b)).into_iter().filter(inside).collect(),
            [a, b, c] => roots(a - 2.0 * b + c, 2.0 * (b - a), a).into_iter().filter(inside).collect(),
            _ => {
                // Between two zeros of the derivative, there is at most one zero.
                let mut ends = vec![0.0];
                ends.extend(self.differences(1).map_or(Vec::new(), |slope| slope.zeros()));
                ends.push(1.0);
                ends.windows(2).filter_map(|w| self.sign_change(w[0], w[1])).filter(inside).collect()
            }
        }
    }

    /// Finds the place between two shares where the sign changes, by bisection. `None` if it does not change.
    fn sign_change(&self, mut from: f64, mut to: f64) -> Option<f64> {
        let first = self.at(from) > 0.0;
        if first == (self.at(to) > 0.0) {
            return None;
        }
        for _ in 0..MAX_HALVINGS {
            let middle = (from + to) / 2.0;
            if (self.at(middle) > 0.0) == first { from = middle } else { to = middle }
        }
        Some((from + to) / 2.0)
    }
}

/// Returns the real roots of `a u^2 + b u + c`, ascending, computed without cancellation. Missing roots are NaN or
/// infinite.
fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return [f64::NAN; 2];
    }
    let s = -0.5 * (b + discriminant.sqrt().copysign(b));
    let (one, two) = (s / a, c / s);
    if one < two { [one, two] } else { [two, one] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn of(count: usize, values: [f64; 6]) -> Polynomial<f64> {
        Polynomial { coefficients: values, count }
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Checks that every change of sign among 2000 samples is near a zero, and that every zero is near a change of sign, up
        /// to rounding.
        #[test]
        fn zeros_are_where_the_sign_changes(count in 1..=6_usize, c in prop::array::uniform6(-3.0..3.0_f64)) {
            let polynomial = of(count, c);
            let found = polynomial.zeros();
            prop_assert!(found.windows(2).all(|w| w[0] <= w[1]), "{found:?}");
            for u in &found {
                prop_assert!(polynomial.at(*u).abs() < 1e-12, "{u}: {}", polynomial.at(*u));
            }
            let at = |i: u32| f64::from(i) / 2000.0;
            for i in 0..2000 {
                if polynomial.at(at(i)) * polynomial.at(at(i + 1)) < 0.0 {
                    prop_assert!(found.iter().any(|u| at(i) <= *u && *u <= at(i + 1)), "none near {}: {found:?}", at(i));
                }
            }
        }

        #[test]
        fn a_restriction_is_the_same_polynomial(
            count in 1..=6_usize, c in prop::array::uniform6(-3.0..3.0_f64), ends in (0.0..1.0_f64, 0.0..1.0_f64),
            u in 0.0..1.0_f64,
        ) {
            let polynomial = of(count, c);
            let part = polynomial.restricted(ends.0, ends.1);
            prop_assert!((part.at(u) - polynomial.at(ends.0 + (ends.1 - ends.0) * u)).abs() < 1e-13);
        }
    }
}
