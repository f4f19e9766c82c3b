//! Trajectories as ROS 2 messages.

use super::JointMotion;
use super::clock::{NANOSECONDS_PER_SECOND, nanoseconds};
use std::fmt::Write;

/// Writes the trajectory as a `trajectory_msgs/msg/JointTrajectory` in the YAML of `ros2 topic pub`.
///
/// The header's stamp is 0, which means "begin now", and its frame is empty. Times are whole nanoseconds. Numbers have enough
/// digits to read back the same `f64`. The [module](super) describes how controllers join the points.
pub fn ros_yaml(motion: &JointMotion) -> String {
    let mut text = String::from("header:\n  stamp: {sec: 0, nanosec: 0}\n  frame_id: \"\"\njoint_names:\n");
    let mut line = |line: std::fmt::Arguments| {
        text.write_fmt(line).expect("a string takes all");
        text.push('\n');
    };
    for joint in &motion.joints {
        line(format_args!("- {}", quoted(joint)));
    }
    line(format_args!("points:"));
    for (k, &time) in motion.time.iter().enumerate() {
        let (seconds, nanoseconds) = split(time);
        line(format_args!("- positions: {}", list(&motion.position[k])));
        line(format_args!("  velocities: {}", list(&motion.velocity[k])));
        if let Some(acceleration) = &motion.acceleration {
            line(format_args!("  accelerations: {}", list(&acceleration[k])));
        }
        line(format_args!("  time_from_start: {{sec: {seconds}, nanosec: {nanoseconds}}}"));
    }
    text
}

/// Splits a time into whole seconds and nanoseconds.
fn split(time: f64) -> (u64, u64) {
    let nanoseconds = nanoseconds(time);
    (nanoseconds / NANOSECONDS_PER_SECOND, nanoseconds % NANOSECONDS_PER_SECOND)
}

fn list(values: &[f64]) -> String {
    let numbers: Vec<String> = values.iter().map(|value| number(*value)).collect();
    format!("[{}]", numbers.join(", "))
}

/// Formats a number for YAML 1.1 readers such as PyYAML, which require a point in the mantissa and a sign in the exponent, and
/// read `1e-7` as text.
fn number(value: f64) -> String {
    let plain = format!("{value:?}");
    let Some((mantissa, exponent)) = plain.split_once('e') else { return plain };
    let point = if mantissa.contains('.') { "" } else { ".0" };
    let sign = if exponent.starts_with('-') { "" } else { "+" };
    format!("{mantissa}{point}e{sign}{exponent}")
}

/// Formats a name as a double-quoted scalar (YAML 1.2.2, section 7.3.1), because without quotes `no`, `1` or `a: b` would not be
/// strings. Escapes characters that YAML does not allow, and those that are line breaks in YAML 1.1.
fn quoted(name: &str) -> String {
    let mut text = String::from("\"");
    for c in name.chars() {
        match c {
            '"' | '\\' => text.extend(['\\', c]),
            '\u{2028}' | '\u{2029}' | '\u{feff}' | '\u{fffe}' | '\u{ffff}' => text.push_str(&escape(c)),
            c if c.is_control() => text.push_str(&escape(c)),
            c => text.push(c),
        }
    }
    text.push('"');
    text
}

fn escape(c: char) -> String {
    format!("\\u{:04X}", u32::from(c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_have_a_point_and_a_signed_exponent() {
        assert_eq!(number(1e-7), "1.0e-7");
        assert_eq!(number(-2.5e-300), "-2.5e-300");
        assert_eq!(number(1e20), "1.0e+20");
        assert_eq!(number(0.25), "0.25");
        assert_eq!(number(3.0), "3.0");
    }

    #[test]
    fn nanoseconds_carry_over_to_seconds() {
        assert_eq!(split(0.0), (0, 0));
        assert_eq!(split(0.999_999_999_9), (1, 0));
        assert_eq!(split(2.000_000_001), (2, 1));
        assert_eq!(split(999_999.999_999_999), (999_999, 999_999_999));
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        #[test]
        fn any_name_is_read_back(name in any::<String>()) {
            let read: String = serde_saphyr::from_str(&quoted(&name)).expect("valid YAML");
            prop_assert_eq!(read, name);
        }

        #[test]
        fn any_number_is_read_back(value in any::<f64>().prop_filter("finite", |v| v.is_finite())) {
            prop_assert_eq!(number(value).parse::<f64>().expect("a number"), value);
        }
    }
}
