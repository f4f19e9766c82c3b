//! The meaning of columns in a table of joint values, determined by their names.

/// The meaning of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Meaning {
    /// The time of the sample, in seconds.
    Time,
    /// A quantity of the joint with this index.
    Of(usize, Quantity),
}

/// The quantity of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    Position,
    Velocity,
    Acceleration,
    /// Torque or force. Torques follow from the other quantities, so they are not read.
    Torque,
}

/// Names of columns with times, in lower case.
const TIME_COLUMNS: [&str; 5] = ["time", "t", "time_from_start", "time_s", "__time"];

/// Words that may stand before or after a joint's name, and the quantities that they denote.
const QUANTITY_WORDS: [(Quantity, &[&str]); 4] = [
    (Quantity::Position, &["position", "positions", "pos"]),
    (Quantity::Velocity, &["velocity", "velocities", "vel"]),
    (Quantity::Acceleration, &["acceleration", "accelerations", "acc"]),
    (Quantity::Torque, &["torque", "torques"]),
];

/// Returns the possible meanings of a column's name. Names such as `elbow`, `elbow_velocity`, `elbow.velocity` or
/// `velocities_elbow`, possibly after a topic (`/joint_states/elbow/position`), denote a quantity of a joint; some others denote
/// times. The caller must refuse names with several meanings.
pub(super) fn meanings(column: &str, joints: &[&str]) -> Vec<Meaning> {
    let mut found = Vec::new();
    if TIME_COLUMNS.contains(&column.to_lowercase().as_str()) {
        found.push(Meaning::Time);
    }
    let is = |name: &str| column.strip_suffix(name).is_some_and(|topic| topic.is_empty() || topic.ends_with('/'));
    for (index, joint) in joints.iter().enumerate() {
        for (quantity, words) in QUANTITY_WORDS {
            let with_word = |word: &&str| {
                ["_", ".", "/"].iter().any(|s| is(&format!("{joint}{s}{word}")) || is(&format!("{word}{s}{joint}")))
            };
            if words.iter().any(with_word) || (quantity == Quantity::Position && column == *joint) {
                found.push(Meaning::Of(index, quantity));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use Quantity::{Acceleration, Position, Velocity};

    #[test]
    fn common_column_names_are_recognised() {
        let joints = ["shoulder", "elbow"];
        for (column, expected) in [
            ("elbow", Meaning::Of(1, Position)),
            ("shoulder_velocity", Meaning::Of(0, Velocity)),
            ("elbow.position", Meaning::Of(1, Position)),
            ("positions_elbow", Meaning::Of(1, Position)),
            ("pos_shoulder", Meaning::Of(0, Position)),
            ("elbow_vel", Meaning::Of(1, Velocity)),
            ("/joint_states/elbow/position", Meaning::Of(1, Position)),
            ("accelerations/elbow", Meaning::Of(1, Acceleration)),
            ("elbow_torque", Meaning::Of(1, Quantity::Torque)),
            ("Time", Meaning::Time),
            ("t", Meaning::Time),
            ("time_from_start", Meaning::Time),
            ("__time", Meaning::Time),
        ] {
            assert_eq!(meanings(column, &joints), [expected], "{column}");
        }
        for column in ["", "wrist", "left_elbow", "elbow_effort", "Elbow", "elbowposition", "timestamps"] {
            assert_eq!(meanings(column, &joints), [], "{column}");
        }
    }

    #[test]
    fn ambiguous_names_have_both_meanings() {
        assert_eq!(meanings("a_vel", &["a", "a_vel"]), [Meaning::Of(0, Velocity), Meaning::Of(1, Position)]);
        assert_eq!(meanings("t", &["t", "u"]), [Meaning::Time, Meaning::Of(0, Position)]);
    }
}
