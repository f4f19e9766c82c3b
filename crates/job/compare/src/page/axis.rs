//! The axis of a chart.

/// An axis is logarithmic if the ratio of its greatest to its least value is at least this.
const LOGARITHMIC_RATIO: f64 = 8.0;

/// Largest number of ticks, except on a logarithmic axis over many decades.
const MAX_TICKS: usize = 6;

/// A range of values along an axis of a chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    lower: f64,
    upper: f64,
    /// True for a logarithmic axis.
    pub is_logarithmic: bool,
}

impl Axis {
    /// Returns an axis that contains these values, and `base` if it is given, with a small margin. `None` without values. The
    /// axis is logarithmic if all values are positive and differ greatly.
    pub fn over(values: impl Iterator<Item = f64> + Clone, base: Option<f64>) -> Option<Self> {
        let all = values.chain(base).filter(|v| v.is_finite());
        let min = all.clone().reduce(f64::min)?;
        let max = all.reduce(f64::max)?;
        if min > 0.0 && max / min > LOGARITHMIC_RATIO {
            let room = (max / min).powf(0.04);
            return Some(Self { lower: min / room, upper: max * room, is_logarithmic: true });
        }
        let room = if max > min { 0.04 * (max - min) } else { 0.1 * max.abs().max(1e-9) };
        // A margin below zero, or below the base, would show impossible values.
        let floor = if base == Some(min) || (min >= 0.0 && min < room) { min } else { min - room };
        Some(Self { lower: floor, upper: max + room, is_logarithmic: false })
    }

    /// Returns an axis from one value to a greater one, without a margin.
    pub fn between(lower: f64, upper: f64) -> Self {
        Self { lower, upper, is_logarithmic: false }
    }

    /// Returns the position of a value: 0 at the lower end, 1 at the upper.
    pub fn place(&self, value: f64) -> f64 {
        let [value, lower, upper] =
            [value, self.lower, self.upper].map(|v| if self.is_logarithmic { v.ln() } else { v });
        ((value - lower) / (upper - lower)).clamp(0.0, 1.0)
    }

    /// Returns round values within the axis, ascending, with their texts.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        if self.is_logarithmic {
            self.factors().into_iter().map(|v| (v, with_minus(written(v, v)))).collect()
        } else {
            let step = self.step();
            self.multiples(step).into_iter().map(|v| (v, with_minus(written(v, step)))).collect()
        }
    }

    /// Returns powers of ten and multiples of them, as many as there is room for.
    fn factors(&self) -> Vec<f64> {
        let decades = self.lower.log10().floor() as i32..=self.upper.log10().ceil() as i32;
        let within = |digits: &[f64]| -> Vec<f64> {
            let all = decades.clone().flat_map(|d| digits.iter().map(move |digit| digit * 10_f64.powi(d)));
            all.filter(|v| (self.lower..=self.upper).contains(v)).collect()
        };
        let choices = [&[1.0, 2.0, 3.0, 5.0, 7.0][..], &[1.0, 2.0, 5.0], &[1.0, 3.0], &[1.0]].map(within);
        let fitting = choices.iter().find(|ticks| ticks.len() <= MAX_TICKS);
        fitting.cloned().unwrap_or_else(|| {
            let stride = choices[3].len().div_ceil(MAX_TICKS);
            choices[3].iter().copied().step_by(stride).collect()
        })
    }

    /// Returns a round step with at least three multiples within the axis, so that distances can be read.
    fn step(&self) -> f64 {
        let least = (self.upper - self.lower) / (MAX_TICKS - 1) as f64;
        let power = 10_f64.powf(least.log10().floor());
        let steps = [0.5, 1.0, 2.0, 5.0, 10.0].map(|digit| digit * power);
        let chosen = steps.iter().position(|step| *step >= least).unwrap_or(steps.len() - 1).max(1);
        if self.multiples(steps[chosen]).len() < 3 { steps[chosen - 1] } else { steps[chosen] }
    }

    fn multiples(&self, step: f64) -> Vec<f64> {
        let first = (self.lower / step).ceil();
        // Products, because sums would accumulate rounding errors.
        let multiples = (0..=2 * MAX_TICKS).map(|i| (first + i as f64) * step);
        multiples.take_while(|v| *v <= self.upper + 1e-9 * step).collect()
    }
}

/// Replaces hyphens by minus signs.
fn with_minus(text: String) -> String {
    text.replace('-', "\u{2212}")
}

/// Formats a round number with enough digits to distinguish it from neighbours at the distance `apart`.
fn written(value: f64, apart: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    // The small addition compensates for rounding of the logarithm at powers of ten.
    let power = |v: f64| (v.abs().log10() + 1e-9).floor();
    let (magnitude, last) = (power(value), power(apart));
    if (-4.0..6.0).contains(&magnitude) {
        format!("{value:.*}", (-last).clamp(0.0, 12.0) as usize)
    } else {
        format!("{value:.*e}", (magnitude - last).clamp(0.0, 12.0) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn ticks_are_round() {
        let shown = |values: &[f64], base| -> Vec<String> {
            let axis = Axis::over(values.iter().copied(), base).unwrap();
            axis.ticks().into_iter().map(|(_, text)| text).collect()
        };
        assert_eq!(shown(&[1.0, 1.37], Some(1.0)), ["1.0", "1.1", "1.2", "1.3"]);
        assert_eq!(shown(&[0.3, 70.0], None), ["0.3", "1", "3", "10", "30"]);
        assert_eq!(shown(&[2.0, 30.0], None), ["2", "5", "10", "20"]);
        assert_eq!(shown(&[0.001, 2e6], None), ["0.001", "0.1", "10", "1000", "100000"]);
        assert_eq!(shown(&[0.0, 9.0], None), ["0", "2", "4", "6", "8"]);
        assert_eq!(shown(&[8.07e8], None), ["7.5e8", "8.0e8", "8.5e8"]);
    }

    #[test]
    fn no_values_make_no_axis() {
        assert_eq!(Axis::over([f64::NAN].into_iter(), None), None);
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        #[test]
        fn every_axis_holds_its_values_and_has_ticks(
            values in prop::collection::vec(prop_oneof![-1e3..1e3_f64, 1e-9..1e-3_f64, Just(0.0), 1e3..1e9_f64], 1..20)
        ) {
            let axis = Axis::over(values.iter().copied(), None).unwrap();
            let mut sorted = values.clone();
            sorted.sort_by(f64::total_cmp);
            let places: Vec<f64> = sorted.iter().map(|v| axis.place(*v)).collect();
            prop_assert!(places.windows(2).all(|w| w[0] <= w[1]), "{places:?}");
            let ticks = axis.ticks();
            prop_assert!((3..=9).contains(&ticks.len()), "{ticks:?}");
            prop_assert!(ticks.windows(2).all(|w| w[0].0 < w[1].0 && w[0].1 != w[1].1), "{ticks:?}");
        }
    }
}
