//! The two kinds of ROS 2 messages that contain joint values.

use super::cdr::Cdr;
use std::rc::Rc;

/// The kinds of messages that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    /// Motions for a controller.
    Trajectory,
    /// Values of joints at one moment.
    State,
}

impl Kind {
    /// Returns the kind of a message type, or `None` for types that are not read.
    pub fn of(schema: &str) -> Option<Self> {
        match schema {
            "trajectory_msgs/msg/JointTrajectory" => Some(Self::Trajectory),
            "sensor_msgs/msg/JointState" => Some(Self::State),
            _ => None,
        }
    }
}

/// A sample: its time in nanoseconds, and the positions, velocities and accelerations of all joints. The last two may be empty.
pub(super) struct Row {
    pub nanoseconds: i64,
    pub values: [Vec<f64>; 3],
}

/// A message: its time stamp and the time at which it was recorded in nanoseconds, the names of the joints, and its samples.
pub(super) struct Message {
    /// Time stamp of the message, nanoseconds; 0 if it has none.
    pub stamp: i64,
    pub logged: i64,
    pub joints: Rc<[String]>,
    /// The samples. A trajectory's times count from the message's time; the single sample of a state has time 0.
    pub rows: Vec<Row>,
}

impl Message {
    /// Reads a message in CDR; `None` if it is not of this kind.
    pub fn read(kind: Kind, bytes: &[u8], logged: i64) -> Option<Self> {
        let mut cdr = Cdr::new(bytes)?;
        let stamp = cdr.header()?;
        let joints = cdr.strings()?.into();
        let rows = match kind {
            Kind::State => vec![Row { nanoseconds: 0, values: [cdr.f64s()?, cdr.f64s()?, Vec::new()] }],
            Kind::Trajectory => cdr.sequence(24, |cdr| {
                let values = [cdr.f64s()?, cdr.f64s()?, cdr.f64s()?];
                cdr.f64s()?;
                Some(Row { nanoseconds: cdr.nanoseconds()?, values })
            })?,
        };
        Some(Self { stamp, logged, joints, rows })
    }

    /// Returns true if the message has positions of this joint.
    pub fn names(&self, joint: &str) -> bool {
        self.joints.iter().any(|name| name == joint)
    }
}
