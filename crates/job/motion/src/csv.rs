//! Trajectories as comma-separated values.

use super::{JointMotion, Trajectory};
use std::borrow::Cow;
use std::fmt::Write;

/// Returns the trajectory as CSV: a header `time,A,B,A_velocity,B_velocity` for joints `A` and `B`, then one line per
/// sample. With `accelerations`, there are also columns `A_acceleration,B_acceleration`. If the trajectory has torques,
/// there are also `A_torque,B_torque`. If `motors` is not empty, it has the angles of both motors' shafts for each sample,
/// in columns `motor_1,motor_2`.
///
/// Fields are quoted by RFC 4180. Lines end in a single line feed, which every reader accepts and text tools prefer.
/// Numbers have as many digits as needed to read back the same `f64`.
///
/// With `steps`, one number per sample, there is an additional column `step` with the step of each sample.
pub fn csv(
    joints: &[String; 2],
    trajectory: &Trajectory,
    motors: &[[f64; 2]],
    accelerations: bool,
    steps: Option<&[usize]>,
) -> String {
    let mut text = String::from("time");
    let torques = !trajectory.torque.is_empty();
    let columns = [("", true), ("_velocity", true), ("_acceleration", accelerations), ("_torque", torques)];
    for (suffix, _) in columns.into_iter().filter(|(_, is_there)| *is_there) {
        for joint in joints {
            text.push(',');
            text.push_str(&quoted(&format!("{joint}{suffix}")));
        }
    }
    push_last_names(&mut text, motors, steps);
    let mut step = steps.into_iter().flatten();
    for (k, time) in trajectory.time.iter().enumerate() {
        let ([p1, p2], [v1, v2], [a1, a2]) =
            (trajectory.position[k], trajectory.velocity[k], trajectory.acceleration[k]);
        // Debug formatting gives the shortest text that reads back the same number, with an exponent for long numbers.
        write!(text, "{time:?},{p1:?},{p2:?},{v1:?},{v2:?}").expect("a string takes all");
        if accelerations {
            write!(text, ",{a1:?},{a2:?}").expect("a string takes all");
        }
        if let Some([first, second]) = trajectory.torque.get(k) {
            write!(text, ",{first:?},{second:?}").expect("a string takes all");
        }
        push_last(&mut text, motors.get(k), step.next());
    }
    text
}

/// Names of the columns with the angles of the motors' shafts.
const MOTOR_COLUMNS: &str = ",motor_1,motor_2";

/// Ends the header with the columns of motors and steps.
fn push_last_names(text: &mut String, motors: &[[f64; 2]], steps: Option<&[usize]>) {
    text.push_str(if motors.is_empty() { "" } else { MOTOR_COLUMNS });
    text.push_str(if steps.is_some() { ",step\n" } else { "\n" });
}

/// Ends a line with the angles of motors and the step.
fn push_last(text: &mut String, motors: Option<&[f64; 2]>, step: Option<&usize>) {
    if let Some([first, second]) = motors {
        write!(text, ",{first:?},{second:?}").expect("a string takes all");
    }
    if let Some(step) = step {
        write!(text, ",{step}").expect("a string takes all");
    }
    text.push('\n');
}

/// Returns a motion of all joints as CSV, in the format of [`csv`]: a value and a velocity of each joint, with their
/// accelerations if the motion has them, and the step of each sample if it
/// is given.
pub fn csv_of_joints(motion: &JointMotion, motors: &[[f64; 2]], steps: Option<&[usize]>) -> String {
    let columns = [("", Some(&motion.position)), ("_velocity", Some(&motion.velocity))];
    let columns = columns.into_iter().chain([("_acceleration", motion.acceleration.as_ref())]);
    let columns: Vec<_> = columns.filter_map(|(suffix, rows)| rows.map(|rows| (suffix, rows))).collect();
    let mut text = String::from("time");
    for (suffix, _) in &columns {
        motion.joints.iter().for_each(|joint| {
            text.push(',');
            text.push_str(&quoted(&format!("{joint}{suffix}")));
        });
    }
    push_last_names(&mut text, motors, steps);
    for (k, time) in motion.time.iter().enumerate() {
        write!(text, "{time:?}").expect("a string takes all");
        for value in columns.iter().flat_map(|(_, rows)| &rows[k]) {
            write!(text, ",{value:?}").expect("a string takes all");
        }
        push_last(&mut text, motors.get(k), steps.and_then(|steps| steps.get(k)));
    }
    text
}

/// Quotes a field if it contains a special character (RFC 4180, section 2).
fn quoted(field: &str) -> Cow<'_, str> {
    if field.contains(['"', ',', '\n', '\r']) {
        Cow::Owned(format!("\"{}\"", field.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(field)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_with_separators_are_quoted() {
        assert_eq!(quoted("elbow joint"), "elbow joint");
        assert_eq!(quoted("a,b"), "\"a,b\"");
        assert_eq!(quoted("a \"b\""), "\"a \"\"b\"\"\"");
        assert_eq!(quoted("a\nb"), "\"a\nb\"");
    }
}
