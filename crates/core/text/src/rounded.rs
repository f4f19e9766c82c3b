//! Numbers for people. They are short, look different if they differ, and never exceed a proven bound.

/// Largest number of decimals. A number that needs more is written in full.
const MAX_DECIMALS: usize = 12;

/// Formats a number with fixed decimals. Zero never has a minus sign.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if !rest.contains(|c: char| ('1'..='9').contains(&c)) && value.is_finite() => rest.to_owned(),
        _ => text,
    }
}

/// Formats a number with fixed decimals. If another number than zero would look like zero, it gets two significant
/// digits: `5.6e-7`.
pub fn nonzero(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    if value != 0.0 && text.parse() == Ok(0.0) { format!("{value:.1e}") } else { text }
}

/// Formats numbers with these decimals, or with as many more as needed to make different numbers look different.
pub fn format_distinct<const N: usize>(values: [f64; N], decimals: usize) -> [String; N] {
    let are_distinct =
        |texts: &[String; N]| (0..N).all(|i| (0..i).all(|j| values[i] == values[j] || texts[i] != texts[j]));
    let with = |decimals: usize| values.map(|value| fixed(value, decimals));
    (decimals..=MAX_DECIMALS)
        .map(with)
        .find(are_distinct)
        .unwrap_or_else(|| values.map(|value| (value + 0.0).to_string()))
}

/// Rounds a number to six significant digits.
pub fn short(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// Formats a number with fixed decimals, rounded down, so that a proven lower bound is still true as printed. If a
/// positive number would look like zero, it gets two significant digits: `5.6e-7`.
pub fn round_down(value: f64, decimals: usize) -> String {
    let text = round_until(value, decimals, |shown| shown <= value, -1.0);
    if value > 0.0 && text.parse() == Ok(0.0) { two_digits_below(value) } else { text }
}

/// Formats a length in metres with its unit: millimetres below one metre, with up to four significant digits and at most
/// three decimals: `0.004 mm`, `20.43 mm`, `345.6 mm`, `1.234 m`. If another length than zero would look like zero, it
/// gets two significant digits.
pub fn length(metres: f64) -> String {
    let (scale, decimals, unit) = in_unit(metres);
    format!("{} {unit}", nonzero(scale * metres, decimals))
}

/// Formats a positive length in metres as [`length`] does, but rounded down, so that a proven lower bound is still true
/// as printed.
pub fn length_down(metres: f64) -> String {
    let (scale, decimals, unit) = in_unit(metres);
    let text = round_until(scale * metres, decimals, |shown| shown / scale <= metres, -1.0);
    let text = if metres > 0.0 && text.parse() == Ok(0.0) { two_digits_below(scale * metres) } else { text };
    format!("{text} {unit}")
}

/// Formats a positive length in metres as [`length`] does, but rounded up, so that an upper bound is still true as
/// printed.
pub fn length_up(metres: f64) -> String {
    let (scale, decimals, unit) = in_unit(metres);
    format!("{} {unit}", round_until(scale * metres, decimals, |shown| shown / scale >= metres, 1.0))
}

/// Formats a length in metres as [`length`] does. If another length is not equal but would look the same, adds decimals
/// until the two look different.
pub fn length_unlike(metres: f64, other: f64) -> String {
    let (scale, decimals, unit) = in_unit(metres);
    let [text, _] = format_distinct([scale * metres, scale * other], decimals);
    format!("{text} {unit}")
}

/// Formats a length in metres that somebody chose, such as a clearance, without zeros at its end: `200 mm`, `1.5 m`.
pub fn chosen_length(metres: f64) -> String {
    let (scale, _, unit) = in_unit(metres);
    format!("{} {unit}", short(scale * metres))
}

/// Formats a number with three significant digits and without zeros at its end, for a headline: rounded up if `up`,
/// otherwise down.
pub fn headline_number(value: f64, up: bool) -> String {
    /// Number of significant digits.
    const DIGITS: i32 = 3;
    /// Share of the last digit by which the rounding error of a product may exceed a number.
    const HAIR: f64 = 1e-6;
    if value == 0.0 || !value.is_finite() {
        return format!("{}", value + 0.0);
    }
    let decimals = (DIGITS - 1 - value.abs().log10().floor() as i32).max(0);
    let unit = 10_f64.powi(decimals);
    let units = if up { (value * unit - HAIR).ceil() } else { (value * unit + HAIR).floor() };
    format!("{}", units / unit + 0.0)
}

/// Formats a length in metres for a headline, see [`headline_number`]: `614 mm`, `1.24 m`.
pub fn headline_length(metres: f64, up: bool) -> String {
    let (scale, _, unit) = in_unit(metres);
    format!("{} {unit}", headline_number(scale * metres, up))
}

/// Returns the unit in which a length is displayed: the number of units per metre, the number of decimals, and the
/// name.
fn in_unit(metres: f64) -> (f64, usize, &'static str) {
    match 1e3 * metres.abs() {
        mm if mm < 10.0 => (1e3, 3, "mm"),
        mm if mm < 100.0 => (1e3, 2, "mm"),
        mm if mm < 1000.0 => (1e3, 1, "mm"),
        _ => (1.0, 3, "m"),
    }
}

/// Formats a number with fixed decimals, rounded up.
pub fn round_up(value: f64, decimals: usize) -> String {
    round_until(value, decimals, |shown| shown >= value, 1.0)
}

/// Formats a positive number with two significant digits, rounded down.
fn two_digits_below(value: f64) -> String {
    let nearest = format!("{value:.1e}");
    let Some((digits, exponent)) =
        nearest.split_once('e').filter(|_| nearest.parse().is_ok_and(|shown: f64| shown > value))
    else {
        return nearest;
    };
    match (digits.parse::<f64>(), exponent.parse::<i32>()) {
        (Ok(1.0), Ok(exponent)) => format!("9.9e{}", exponent - 1),
        (Ok(digits), Ok(exponent)) => format!("{:.1}e{exponent}", digits - 0.1),
        _ => nearest,
    }
}

/// Formats a fraction as a percentage, rounded up: `0.04 %`, and `0.009 %` with three decimals below a hundredth. It does
/// not take the rounding error of the quotient into account.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * (share - 2.0 * f64::EPSILON).max(0.0);
    let decimals = if percent == 0.0 || percent >= 0.01 { 2 } else { 3 };
    format!("{} %", round_up(percent, decimals))
}

/// Formats the nearest decimal number, in the direction `towards`, for which `holds` is true.
fn round_until(value: f64, decimals: usize, holds: impl Fn(f64) -> bool, towards: f64) -> String {
    let nearest = fixed(value, decimals);
    match nearest.parse::<f64>() {
        Ok(number) if value.is_finite() && !holds(number) => {
            fixed(value + towards * 0.1_f64.powi(decimals as i32), decimals)
        }
        _ => nearest,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_in_millimetres_below_a_metre() {
        let lengths = [0.0, 4.2e-6, 0.020_434_9, 0.3456, 1.2344, -0.008_064, 4.2e-8];
        assert_eq!(
            lengths.map(length),
            ["0.000 mm", "0.004 mm", "20.43 mm", "345.6 mm", "1.234 m", "-8.064 mm", "4.2e-5 mm"]
        );
        let bounds = [4.9e-6, 0.020_439_9, 0.345_69, 1.2349, 4.29e-8, f64::INFINITY];
        assert_eq!(bounds.map(length_down), ["0.004 mm", "20.43 mm", "345.6 mm", "1.234 m", "4.2e-5 mm", "inf m"]);
    }
    use proptest::prelude::*;

    #[test]
    fn rounding_agrees_with_results_by_hand() {
        assert_eq!([round_down(1.66871, 3), round_up(1.66871, 3)], ["1.668", "1.669"]);
        assert_eq!([round_down(7.627e-6, 6), round_down(4.0, 4), round_up(0.25, 2)], ["0.000007", "4.0000", "0.25"]);
        assert_eq!([round_up(0.0301, 2), round_down(f64::INFINITY, 3)], ["0.04", "inf"]);
    }

    #[test]
    fn short_numbers_keep_six_digits() {
        let shown = [0.2617993877991494, 0.281882666843, 1e-4 / 3.0, 123_456.789, 0.1 + 0.2, -0.0, 1.0].map(short);
        assert_eq!(shown, [0.261799, 0.281883, 3.33333e-5, 123_457.0, 0.3, 0.0, 1.0]);
    }

    #[test]
    fn lengths_of_headlines_have_three_digits_and_are_rounded_to_the_safe_side() {
        let up = [0.6136, 0.04, 0.004_201, 1.2341, 0.95, 0.0].map(|metres| headline_length(metres, true));
        assert_eq!(up, ["614 mm", "40 mm", "4.21 mm", "1.24 m", "950 mm", "0 mm"]);
        assert_eq!([0.0137, 0.2].map(|metres| headline_length(metres, false)), ["13.7 mm", "200 mm"]);
        assert_eq!([0.2, 0.003, 1.5, 0.0].map(chosen_length), ["200 mm", "3 mm", "1.5 m", "0 mm"]);
        assert_eq!([length_unlike(0.076_569, 0.08), length_unlike(0.079_999_9, 0.08)], ["76.57 mm", "79.9999 mm"]);
        assert_eq!([length_up(0.613_62), length_up(0.04), length_up(1.2341)], ["613.7 mm", "40.00 mm", "1.235 m"]);
    }

    #[test]
    fn shares_are_rounded_up_to_two_digits() {
        let shown = [0.0, 1e-16, 0.0004, 0.00040001, 8.41e-5, 9.96e-5, 1.0e-9, 1.01e-9, 0.25].map(percent);
        let asked = ["0.00 %", "0.00 %", "0.04 %", "0.05 %", "0.009 %", "0.010 %", "0.001 %", "0.001 %", "25.00 %"];
        assert_eq!(shown, asked);
    }

    #[test]
    fn zero_has_no_sign_and_no_proven_distance_looks_like_it() {
        assert_eq!([fixed(-1e-9, 4), fixed(-0.0, 2), fixed(-0.1, 0), fixed(-0.1, 1)], ["0.0000", "0.00", "0", "-0.1"]);
        assert_eq!([nonzero(4.64e-7, 6), nonzero(-5.6e-7, 4), nonzero(-0.0, 2)], ["4.6e-7", "-5.6e-7", "0.00"]);
        assert_eq!([fixed(f64::NEG_INFINITY, 2), fixed(-20.0, 1)], ["-inf", "-20.0"]);
        assert_eq!(
            [round_down(5.6e-7, 6), round_down(5.68e-7, 6), round_down(9.96e-9, 6)],
            ["5.6e-7", "5.6e-7", "9.9e-9"]
        );
        assert_eq!(
            [round_down(1e-300, 4), round_down(0.0, 6), round_up(-1e-9, 6)],
            ["1.0e-300", "0.000000", "0.000000"]
        );
    }

    #[test]
    fn numbers_that_differ_look_different() {
        assert_eq!(format_distinct([-1e-6, 0.0, 1.0], 4), ["-0.000001", "0.000000", "1.000000"]);
        assert_eq!(format_distinct([0.4, 0.0, 0.4], 4), ["0.4000", "0.0000", "0.4000"]);
        assert_eq!(format_distinct([0.400_000_1, 0.0, 0.4], 4), ["0.4000001", "0.0000000", "0.4000000"]);
        assert_eq!(format_distinct([0.4_f64.next_up(), 0.4], 4), ["0.4000000000000001", "0.4"]);
        assert_eq!(format_distinct([-0.0, 0.0], 1), ["0.0", "0.0"]);
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(500))]

        #[test]
        fn two_digits_are_below_by_a_unit_of_the_second_at_most(exponent in -30.0..0.0_f64, decimals in 0..7_usize) {
            let value = 10_f64.powf(exponent);
            let shown: f64 = round_down(value, decimals).parse().unwrap();
            prop_assert!(0.0 < shown && shown <= value, "{value} {shown}");
            prop_assert!(value - shown <= 0.1001 * value || value >= 0.1_f64.powi(decimals as i32), "{value} {shown}");
        }

        #[test]
        fn shares_are_not_rounded_down(exponent in -14.0..0.5_f64) {
            let share = 10_f64.powf(exponent);
            let shown: f64 = percent(share).trim_end_matches(" %").parse().unwrap();
            let unit = if share < 1e-4 { 1e-5 } else { 1e-4 };
            prop_assert!((-1e-15..=1.001 * unit).contains(&(shown / 100.0 - share)), "{share} {shown}");
        }

        #[test]
        fn rounding_down_and_up_encloses_by_a_unit_at_most(value in -1e3..1e3_f64, decimals in 0..7_usize) {
            let [low, high] = [round_down(value, decimals), round_up(value, decimals)].map(|text| text.parse::<f64>().unwrap());
            let unit = 0.1_f64.powi(decimals as i32);
            prop_assert!(low <= value && value <= high && high - low <= 1.001 * unit, "{low} {value} {high}");
        }
    }
}
