//! The two ROS 2 messages that hold a motion: what they are made of, and their bytes.

use super::super::JointMotion;
use super::super::clock::{PER_SECOND, nanoseconds};
use super::cdr::Cdr;

/// A message type.
pub struct Type {
    /// Its full name.
    pub name: &'static str,
    fields: &'static str,
    parts: &'static [Part],
}

/// A type within a message: its name, as definitions refer to it, and its fields.
type Part = (&'static str, &'static str);

const TIME: Part = ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n");
const DURATION: Part = ("builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n");
const HEADER: Part = ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n");
const POINT: Part = (
    "trajectory_msgs/JointTrajectoryPoint",
    "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\n\
     builtin_interfaces/Duration time_from_start\n",
);

/// Where the joints are at one time.
pub const JOINT_STATE: Type = Type {
    name: "sensor_msgs/msg/JointState",
    fields: "std_msgs/Header header\n\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n",
    parts: &[HEADER, TIME],
};

/// A whole motion, for a controller.
pub const JOINT_TRAJECTORY: Type = Type {
    name: "trajectory_msgs/msg/JointTrajectory",
    fields: "std_msgs/Header header\n\nstring[] joint_names\nJointTrajectoryPoint[] points\n",
    parts: &[HEADER, TIME, POINT, DURATION],
};

impl Type {
    /// The definition in the encoding `ros2msg` (MCAP registry): its own fields, then those of every type within it, each
    /// after a line of 80 equals signs and one with its name. So readers need no ROS to decode a message.
    #[must_use]
    pub fn definition(&self) -> String {
        let parts = self.parts.iter().map(|(name, fields)| format!("{}\nMSG: {name}\n{fields}", "=".repeat(80)));
        std::iter::once(self.fields.to_owned()).chain(parts).collect()
    }
}

/// The bytes of a [`JOINT_STATE`] at a time of the recording, nanoseconds. Efforts are not known, and left out.
#[must_use]
pub fn joint_state(joints: &[String], time: u64, position: &[f64], velocity: &[f64]) -> Vec<u8> {
    let mut cdr = Cdr::new();
    header(&mut cdr, time);
    cdr.strings(joints);
    cdr.f64s(position);
    cdr.f64s(velocity);
    cdr.f64s(&[]);
    cdr.into_bytes()
}

/// The bytes of a [`JOINT_TRAJECTORY`]. As in [`super::super::ros_yaml`] the stamp is 0, which means "begin now".
#[must_use]
pub fn joint_trajectory(motion: &JointMotion) -> Vec<u8> {
    let mut cdr = Cdr::new();
    header(&mut cdr, 0);
    cdr.strings(&motion.joints);
    cdr.length(motion.time.len());
    for (k, &time) in motion.time.iter().enumerate() {
        cdr.f64s(&motion.position[k]);
        cdr.f64s(&motion.velocity[k]);
        cdr.f64s(motion.acceleration.as_ref().map_or(&[], |acceleration| &acceleration[k]));
        cdr.f64s(&[]);
        since(&mut cdr, nanoseconds(time));
    }
    cdr.into_bytes()
}

/// A header whose frame is empty: joint values are in none.
fn header(cdr: &mut Cdr, time: u64) {
    since(cdr, time);
    cdr.string("");
}

/// A `Time` or a `Duration`.
fn since(cdr: &mut Cdr, nanoseconds: u64) {
    // The types end after 68 years; motions after eleven days.
    cdr.i32(i32::try_from(nanoseconds / PER_SECOND).unwrap_or(i32::MAX));
    cdr.u32((nanoseconds % PER_SECOND) as u32);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names() -> [String; 2] {
        ["a".into(), "bc".into()]
    }

    /// Bytes written as people read them.
    fn hex(text: &str) -> Vec<u8> {
        text.split_whitespace().map(|byte| u8::from_str_radix(byte, 16).expect("two hexadecimal digits")).collect()
    }

    #[test]
    fn a_state_by_hand() {
        let bytes = joint_state(&names(), 1_500_000_000, &[1.0, -2.0], &[0.5, 0.0]);
        let expected = hex("00 01 00 00  01 00 00 00  00 65 cd 1d  01 00 00 00 00  00 00 00 \
             02 00 00 00  02 00 00 00 61 00  00 00  03 00 00 00 62 63 00  00 \
             02 00 00 00  00 00 00 00 00 00 f0 3f  00 00 00 00 00 00 00 c0 \
             02 00 00 00  00 00 00 00  00 00 00 00 00 00 e0 3f  00 00 00 00 00 00 00 00 \
             00 00 00 00");
        assert_eq!(bytes, expected);
    }

    #[test]
    fn a_trajectory_by_hand() {
        let motion = JointMotion {
            joints: names().to_vec(),
            time: vec![0.0, 2.000_000_001],
            position: vec![vec![1.0, 0.0], vec![2.0, 0.0]],
            velocity: vec![vec![0.0, 0.0]; 2],
            acceleration: Some(vec![vec![0.0, -2.0], vec![0.0, 0.0]]),
        };
        let zero = "00 00 00 00 00 00 00 00";
        // A length at a multiple of 8, as the first point's at 40, leaves four bytes free before its values; that of the
        // second point's positions lies at 124, and its values follow at once.
        let expected = hex(&format!(
            "00 01 00 00  00 00 00 00  00 00 00 00  01 00 00 00 00  00 00 00 \
             02 00 00 00  02 00 00 00 61 00  00 00  03 00 00 00 62 63 00  00  02 00 00 00 \
             02 00 00 00  00 00 00 00  00 00 00 00 00 00 f0 3f  {zero} \
             02 00 00 00  00 00 00 00  {zero}  {zero} \
             02 00 00 00  00 00 00 00  {zero}  00 00 00 00 00 00 00 c0 \
             00 00 00 00  00 00 00 00  00 00 00 00 \
             02 00 00 00  00 00 00 00 00 00 00 40  {zero} \
             02 00 00 00  00 00 00 00  {zero}  {zero} \
             02 00 00 00  00 00 00 00  {zero}  {zero} \
             00 00 00 00  02 00 00 00  01 00 00 00"
        ));
        assert_eq!(joint_trajectory(&motion), expected);
    }

    #[test]
    fn definitions_name_all_that_they_use() {
        for kind in [JOINT_STATE, JOINT_TRAJECTORY] {
            let text = kind.definition();
            let defined: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("MSG: ")).collect();
            let separators = text.lines().filter(|line| *line == "=".repeat(80)).count();
            assert_eq!(separators, defined.len());
            for line in text.lines().filter(|line| line.contains('/') && !line.starts_with("MSG: ")) {
                let (used, _) = line.split_once(' ').expect("a type and a name");
                assert!(defined.contains(&used), "{used}");
            }
        }
        assert!(
            JOINT_TRAJECTORY.definition().contains("MSG: trajectory_msgs/JointTrajectoryPoint\nfloat64[] positions\n")
        );
    }
}
