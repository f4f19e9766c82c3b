//! Distribution of values.

/// The five numbers of a box plot, and the mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Number of values; at least one.
    pub n: usize,
    /// The least of the values.
    pub min: f64,
    /// Lower quartile: a quarter of the values are at most this.
    pub lower_quartile: f64,
    /// Half of the values are at most this.
    pub median: f64,
    /// Three quarters of the values are at most this.
    pub upper_quartile: f64,
    /// The greatest of the values.
    pub max: f64,
    /// The arithmetic mean.
    pub mean: f64,
}

impl Spread {
    /// Computes the distribution of the finite values; `None` if all are infinite or missing. `O(n log n)`.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let (min, max) = (*sorted.first()?, *sorted.last()?);
        let n = sorted.len();
        // Rounding of the sum must not put the mean outside the values.
        let mean = (sorted.iter().map(|v| v / n as f64).sum::<f64>()).clamp(min, max);
        let [lower_quartile, median, upper_quartile] = [0.25, 0.5, 0.75].map(|share| quantile(&sorted, share));
        Some(Self { n, min, lower_quartile, median, upper_quartile, max, mean })
    }

    /// Returns least value, lower quartile, median, upper quartile, greatest value and mean, as the tables list them.
    pub fn numbers(&self) -> [f64; 6] {
        [self.min, self.lower_quartile, self.median, self.upper_quartile, self.max, self.mean]
    }
}

/// Returns the quantile `share` (0 to 1) of the values, with linear interpolation, as R (type 7) and NumPy do by default. The
/// values are ascending, and there is at least one.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let at = share * (sorted.len() - 1) as f64;
    let below = at.floor() as usize;
    let above = (below + 1).min(sorted.len() - 1);
    // In a weighted sum, the difference of the values cannot overflow.
    let part = at - below as f64;
    (sorted[below] * (1.0 - part) + sorted[above] * part).clamp(sorted[below], sorted[above])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn known_quartiles() {
        // numpy.quantile([1, 2, 4, 8], [0.25, 0.5, 0.75]) = [1.75, 3, 5]
        let spread = Spread::of([8.0, 1.0, 4.0, 2.0]).unwrap();
        assert_eq!((spread.n, spread.numbers()), (4, [1.0, 1.75, 3.0, 5.0, 8.0, 3.75]));
        // numpy.quantile([15, 20, 35, 40, 50], ...) = [20, 35, 40]
        let spread = Spread::of([15.0, 20.0, 35.0, 40.0, 50.0]).unwrap();
        assert_eq!(spread.numbers(), [15.0, 20.0, 35.0, 40.0, 50.0, 32.0]);
        let single = Spread::of([7.5]).unwrap();
        assert_eq!((single.n, single.numbers()), (1, [7.5; 6]));
    }

    #[test]
    fn nan_values_are_ignored() {
        assert_eq!(Spread::of([f64::NAN, f64::INFINITY]), None);
        assert_eq!(Spread::of([]), None);
        assert_eq!(Spread::of([f64::NAN, 2.0, f64::NEG_INFINITY]).unwrap().n, 1);
    }

    /// Computes the quantile as a broken line through the points `(i / (n - 1), sorted[i])`.
    fn quantile_on_broken_line(sorted: &[f64], share: f64) -> f64 {
        let knots: Vec<f64> = (0..sorted.len()).map(|i| i as f64 / (sorted.len().max(2) - 1) as f64).collect();
        for i in 1..sorted.len() {
            if share <= knots[i] {
                let part = (share - knots[i - 1]) / (knots[i] - knots[i - 1]);
                return sorted[i - 1] + part * (sorted[i] - sorted[i - 1]);
            }
        }
        sorted[sorted.len() - 1]
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        #[test]
        fn quartiles_lie_on_the_broken_line(values in prop::collection::vec(-1e6..1e6_f64, 1..60)) {
            let spread = Spread::of(values.iter().copied()).unwrap();
            // Insertion sort, which shares no code with the implementation.
            let mut sorted: Vec<f64> = Vec::new();
            for value in &values {
                let at = sorted.iter().position(|s| s > value).unwrap_or(sorted.len());
                sorted.insert(at, *value);
            }
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let expected = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| quantile_on_broken_line(&sorted, share));
            for (got, want) in spread.numbers().into_iter().zip(expected.into_iter().chain([mean])) {
                prop_assert!((got - want).abs() < 1e-6, "{got} {want}");
            }
            prop_assert!(spread.numbers()[..5].windows(2).all(|w| w[0] <= w[1]));
            prop_assert!(spread.min <= spread.mean && spread.mean <= spread.max);
        }

        #[test]
        fn at_least_half_lie_on_either_side_of_the_median(values in prop::collection::vec(0..9_i32, 1..40)) {
            let median = Spread::of(values.iter().map(|&v| f64::from(v))).unwrap().median;
            let below = values.iter().filter(|&&v| f64::from(v) <= median).count();
            let above = values.iter().filter(|&&v| f64::from(v) >= median).count();
            prop_assert!(2 * below >= values.len() && 2 * above >= values.len());
        }
    }
}
