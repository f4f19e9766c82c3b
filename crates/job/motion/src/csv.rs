//! Trajectories as comma-separated values.

use super::{JointMotion, Trajectory};
use std::borrow::Cow;
use std::fmt::Write;

/// Returns the trajectory as CSV: a header `time,A,B,A_velocity,B_velocity` for joints `A` and `B`, then one line per sample.
/// With `accelerations`, there are also columns `A_acceleration,B_acceleration`. If the trajectory has torques, there are also
/// `A_torque,B_torque`. `motors` has the angles of both motors' shafts for each sample; unless it is empty, they are in columns
/// `motor_1,motor_2`.
///
/// Fields are quoted by RFC 4180. Lines end in a single line feed, which all readers accept and text tools prefer. Numbers have
/// enough digits to read back the same `f64`.
///
/// `steps` has one number per sample; if it is given, there is a column `step`.
pub fn csv(
    joints: &[String; 2],
    trajectory: &Trajectory,
    motors: &[[f64; 2]],
    accelerations: bool,
    steps: Option<&[usize]>,
) -> String {
    let Trajectory { time, position, velocity, acceleration, torque, .. } = trajectory;
    let mut columns = vec![("", &position[..]), ("_velocity", velocity)];
    columns.extend(accelerations.then_some(("_acceleration", &acceleration[..])));
    columns.extend((!torque.is_empty()).then_some(("_torque", &torque[..])));
    table(joints, time, &columns, motors, steps)
}

/// Returns a motion of all joints as CSV, in the format of [`csv`]: value and velocity of each joint, its acceleration if the
/// motion has accelerations, and the step of each sample if it is given.
pub fn csv_of_joints(motion: &JointMotion, motors: &[[f64; 2]], steps: Option<&[usize]>) -> String {
    let mut columns = vec![("", &motion.position[..]), ("_velocity", &motion.velocity)];
    columns.extend(motion.acceleration.iter().map(|rows| ("_acceleration", &rows[..])));
    table(&motion.joints, &motion.time, &columns, motors, steps)
}

/// Returns a table: the times, for each suffix a column for each joint, and the columns of motors and steps.
fn table<R: AsRef<[f64]>>(
    joints: &[String],
    time: &[f64],
    columns: &[(&str, &[R])],
    motors: &[[f64; 2]],
    steps: Option<&[usize]>,
) -> String {
    let names = columns.iter().flat_map(|(suffix, _)| joints.iter().map(move |joint| format!("{joint}{suffix}")));
    let mut text = names.fold(String::from("time"), |text, name| text + "," + &quoted(&name));
    text.push_str(if motors.is_empty() { "" } else { ",motor_1,motor_2" });
    text.push_str(if steps.is_some() { ",step\n" } else { "\n" });
    for (k, time) in time.iter().enumerate() {
        let values = columns.iter().flat_map(|(_, rows)| rows[k].as_ref()).chain(motors.get(k).into_iter().flatten());
        // Debug formatting gives the shortest text that reads back the same number, with an exponent if the number would be long.
        write!(text, "{time:?}").expect("a string takes all");
        values.for_each(|value| write!(text, ",{value:?}").expect("a string takes all"));
        if let Some(step) = steps.and_then(|steps| steps.get(k)) {
            write!(text, ",{step}").expect("a string takes all");
        }
        text.push('\n');
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
