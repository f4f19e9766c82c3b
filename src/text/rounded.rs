//! Numbers that are proven, in decimals that are no more than what is proven.

/// A number with some decimals that is no more than this one, so that what is proven of it is proven of what is shown.
#[must_use]
pub fn at_least(value: f64, decimals: usize) -> String {
    shown(value, decimals, |shown| shown <= value, -1.0)
}

/// The same, no less than this one.
#[must_use]
pub fn at_most(value: f64, decimals: usize) -> String {
    shown(value, decimals, |shown| shown >= value, 1.0)
}

/// The nearest, or the next one in a direction.
fn shown(value: f64, decimals: usize, holds: impl Fn(f64) -> bool, towards: f64) -> String {
    let nearest = format!("{value:.decimals$}");
    match nearest.parse::<f64>() {
        Ok(number) if value.is_finite() && !holds(number) => {
            format!("{:.decimals$}", value + towards * 0.1_f64.powi(decimals as i32))
        }
        _ => nearest,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn by_hand() {
        assert_eq!([at_least(1.66871, 3), at_most(1.66871, 3)], ["1.668", "1.669"]);
        assert_eq!([at_least(7.627e-6, 6), at_least(4.0, 4), at_most(0.25, 2)], ["0.000007", "4.0000", "0.25"]);
        assert_eq!([at_most(0.0301, 2), at_least(f64::INFINITY, 3)], ["0.04", "inf"]);
    }

    proptest! {
        #![proptest_config(crate::random::cases(500))]

        #[test]
        fn they_enclose_by_a_unit_at_most(value in -1e3..1e3_f64, decimals in 0..7_usize) {
            let [low, high] = [at_least(value, decimals), at_most(value, decimals)].map(|text| text.parse::<f64>().unwrap());
            let unit = 0.1_f64.powi(decimals as i32);
            prop_assert!(low <= value && value <= high && high - low <= 1.001 * unit, "{low} {value} {high}");
        }
    }
}
