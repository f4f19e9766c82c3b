//! Quantities as the page shows them: three or four significant digits, with units.

use cplan_text::{length_down, percent};

/// Formats a number with this many significant digits, and at most six decimals.
fn significant(value: f64, digits: i32) -> String {
    let magnitude = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    let decimals = (digits - 1 - magnitude).clamp(0, 6) as usize;
    format!("{value:.decimals$}")
}

/// Formats a length in joint space as the terminal does. If the joints are of two kinds, there is no single unit.
pub fn path_length(value: f64, unit: &str) -> String {
    format!("{value:.4} {}", if unit.contains(',') { "in joint space" } else { unit })
}

/// Formats the ratio of a length to the optimum as an excess, rounded up.
pub fn excess(ratio: f64) -> String {
    percent(ratio - 1.0)
}

/// Formats a proven clearance, which is infinite if no obstacle is within reach.
pub fn clearance(metres: f64) -> String {
    if metres.is_finite() { length_down(metres) } else { "none in reach".to_owned() }
}

/// Formats the duration of a motion.
pub fn duration(seconds: f64) -> String {
    format!("{} s", significant(seconds, 4))
}

/// Formats a computing time.
pub fn computing_time(seconds: f64) -> String {
    if seconds < 1.0 {
        format!("{} ms", significant(seconds * 1e3, 3))
    } else {
        format!("{} s", significant(seconds, 3))
    }
}

/// Formats an amount of memory.
pub fn memory(bytes: f64) -> String {
    let kibibytes = bytes / 1024.0;
    if kibibytes < 1024.0 {
        format!("{} KiB", significant(kibibytes, 3))
    } else {
        format!("{} MiB", significant(kibibytes / 1024.0, 3))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_have_few_digits_and_a_unit() {
        assert_eq!(
            [path_length(4.49196, "rad"), path_length(12.5, "rad, m")],
            ["4.4920 rad", "12.5000 in joint space"]
        );
        assert_eq!([excess(1.25), excess(1.0)], ["25.00 %", "0.00 %"]);
        assert_eq!([clearance(0.13095), clearance(f64::INFINITY)], ["130.9 mm", "none in reach"]);
        assert_eq!(duration(2.0634), "2.063 s");
        assert_eq!(
            [computing_time(0.000_095_1), computing_time(0.017_76), computing_time(2.5)],
            ["0.0951 ms", "17.8 ms", "2.50 s"]
        );
        assert_eq!([memory(2048.0), memory(5.5 * 1048576.0)], ["2.00 KiB", "5.50 MiB"]);
    }
}
