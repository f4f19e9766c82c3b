//! Conditions on the squared speeds at the ends of a span.

/// The feasible squared speeds `z0` and `z1` at the ends of a span: both are at least 0, and `a z0 + b z1 <= 1` for each row
/// `[a, b]`. The set is convex, and contains all small `z0` and `z1`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bounds {
    /// Greatest `z0` that the rows without a `z1` allow.
    most: f64,
    /// Upper bounds on `z1` from the rows that give one, as functions of `z0`: intercept and slope.
    above: Vec<[f64; 2]>,
    /// Lower bounds on `z1` from the rows that give one, as functions of `z0`: intercept and slope.
    below: Vec<[f64; 2]>,
}

/// Assumed relative rounding error of coefficients and squared speeds. It is far above that of doubles, and far below the unused
/// share of the limits.
const ROUNDING: f64 = 1e-12;

impl Default for Bounds {
    fn default() -> Self {
        // Enough for the rows of a span without torques.
        let [above, below] = [0, 1].map(|_| Vec::with_capacity(8));
        Self { most: f64::MAX, above, below }
    }
}

impl Extend<[f64; 2]> for Bounds {
    fn extend<T: IntoIterator<Item = [f64; 2]>>(&mut self, rows: T) {
        for [a, b] in rows {
            let line = [1.0 / b, -a / b];
            // A second coefficient that is only a rounding error is ignored, because dividing by it would be meaningless.
            if b.abs() <= ROUNDING * a.abs() {
                self.most = if a > 0.0 { self.most.min(1.0 / a) } else { self.most };
            } else if b > 0.0 {
                self.above.push(line);
            } else {
                self.below.push(line);
            }
        }
    }
}

impl Bounds {
    /// Returns the greatest `z1` up to `most` for a feasible `z0`.
    pub fn greatest_end(&self, z0: f64, most: f64) -> f64 {
        self.upper(z0, most).0.max(0.0)
    }

    /// Returns the greatest `z0` for which a `z1` up to `most` exists.
    ///
    /// The difference between the greatest and the least `z1` is a concave, piecewise linear function of `z0`, at least 0 at
    /// `z0 = 0`. Newton's method from above finds its root in at most as many steps as there are pairs of rows. The result is
    /// lowered by more than rounding errors, so that [`Bounds::greatest_end`] finds a feasible `z1`.
    pub fn greatest_start(&self, most: f64) -> f64 {
        let mut z0 = self.most;
        for _ in 0..=(self.above.len() + 1) * (self.below.len() + 1) {
            let (upper, lower) = (self.upper(z0, most), self.lower(z0));
            let (room, slope) = (upper.0 - lower.0, upper.1 - lower.1);
            let next = z0 - room / slope;
            // Rounding also ends the iteration.
            if room >= 0.0 || next.is_nan() || next >= z0 {
                break;
            }
            z0 = next.max(0.0);
        }
        z0 * (1.0 - ROUNDING)
    }

    /// Returns the greatest `z1` for a `z0`, and its slope over `z0`.
    fn upper(&self, z0: f64, most: f64) -> (f64, f64) {
        let lines = self.above.iter().map(|[at_zero, slope]| (at_zero + slope * z0, *slope));
        lines.fold((most, 0.0), |best, line| if line.0 < best.0 { line } else { best })
    }

    /// Returns the least `z1` for a `z0`, and its slope over `z0`.
    fn lower(&self, z0: f64) -> (f64, f64) {
        let lines = self.below.iter().map(|[at_zero, slope]| (at_zero + slope * z0, *slope));
        lines.fold((0.0, 0.0), |best, line| if line.0 > best.0 { line } else { best })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Compares the bounds with the vertices of the feasible polygon, found by brute force.
        #[test]
        fn bounds_of_a_corner_agree_with_the_feasible_polygon(
            rows in prop::collection::vec(prop::array::uniform2(prop_oneof![Just(0.0), -3.0..3.0_f64]), 1..9),
            caps in (0.1..5.0_f64, 0.1..5.0_f64), most in 0.0..4.0_f64, share in 0.0..1.0_f64,
        ) {
            let mut rows = rows;
            rows.extend([[1.0 / caps.0, 0.0], [0.0, 1.0 / caps.1]]);
            let mut bounds = Bounds::default();
            bounds.extend(rows.iter().copied());
            // All lines as a z0 + b z1 = c.
            let mut lines: Vec<[f64; 3]> = rows.iter().map(|[a, b]| [*a, *b, 1.0]).collect();
            lines.extend([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, most]]);
            let inside = |z0: f64, z1: f64| {
                z0 >= -1e-9 && (-1e-9..=most + 1e-9).contains(&z1)
                    && rows.iter().all(|[a, b]| a * z0 + b * z1 <= 1.0 + 1e-9)
            };
            let mut greatest = 0.0_f64;
            for (i, [a, b, c]) in lines.iter().enumerate() {
                for [d, e, f] in &lines[..i] {
                    let determinant = a * e - b * d;
                    let (z0, z1) = ((c * e - b * f) / determinant, (a * f - c * d) / determinant);
                    if determinant.abs() > 1e-12 && inside(z0, z1) {
                        greatest = greatest.max(z0);
                    }
                }
            }
            let back = bounds.greatest_start(most);
            prop_assert!((back - greatest).abs() < 1e-6 * (1.0 + greatest), "{back} {greatest}");
            let z0 = back * share;
            let z1 = bounds.greatest_end(z0, most);
            prop_assert!(inside(z0, z1) && (z1 + 1e-6 > most || !inside(z0, z1 + 1e-6)), "{z0} {z1}");
        }
    }
}
