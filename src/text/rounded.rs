//! Numbers for people: short, and if they are proven no more than what is proven.

/// A number to six digits that count, without zeros at its end.
#[must_use]
pub fn short(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

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

/// A share in words, rounded up: `0.04 %`, `8.5e-3 %`. That a quotient was rounded makes it no more.
#[must_use]
pub fn percent(share: f64) -> String {
    let percent = 100.0 * (share - 2.0 * f64::EPSILON).max(0.0);
    if percent == 0.0 || percent >= 0.01 {
        return format!("{} %", at_most(percent, 2));
    }
    // Two digits that count.
    let decimals = 1 - percent.log10().floor() as i32;
    let shown = at_most(percent, decimals.unsigned_abs() as usize);
    shown.parse().map_or(shown.clone(), |shown: f64| format!("{shown:.1e}")) + " %"
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

    #[test]
    fn short_numbers_keep_six_digits() {
        let shown = [0.2617993877991494, 0.281882666843, 1e-4 / 3.0, 123_456.789, 0.1 + 0.2, -0.0, 1.0].map(short);
        assert_eq!(shown, [0.261799, 0.281883, 3.33333e-5, 123_457.0, 0.3, 0.0, 1.0]);
    }

    #[test]
    fn shares_are_rounded_up_to_two_digits() {
        let shown = [0.0, 1e-16, 0.0004, 0.00040001, 8.41e-5, 9.96e-5, 1.0e-9, 1.01e-9, 0.25].map(percent);
        let asked = ["0.00 %", "0.00 %", "0.04 %", "0.05 %", "8.5e-3 %", "1.0e-2 %", "1.0e-7 %", "1.1e-7 %", "25.00 %"];
        assert_eq!(shown, asked);
    }

    proptest! {
        #![proptest_config(crate::random::cases(500))]

        #[test]
        fn shares_are_no_less(exponent in -14.0..0.5_f64) {
            let share = 10_f64.powf(exponent);
            let shown: f64 = percent(share).trim_end_matches(" %").parse().unwrap();
            let unit = if share < 1e-4 { share } else { 1e-4 };
            prop_assert!((-1e-15..=1.001 * unit).contains(&(shown / 100.0 - share)), "{share} {shown}");
        }

        #[test]
        fn they_enclose_by_a_unit_at_most(value in -1e3..1e3_f64, decimals in 0..7_usize) {
            let [low, high] = [at_least(value, decimals), at_most(value, decimals)].map(|text| text.parse::<f64>().unwrap());
            let unit = 0.1_f64.powi(decimals as i32);
            prop_assert!(low <= value && value <= high && high - low <= 1.001 * unit, "{low} {value} {high}");
        }
    }
}
