//! The two messages of ROS 2 that hold joint values.

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

/// A sample: when, and positions, velocities and accelerations of all joints, the latter two perhaps empty.
pub(super) struct Row {
    pub nanoseconds: i64,
    pub values: [Vec<f64>; 3],
}

/// A message: when it was stamped and logged, nanoseconds, the joints' names, and its samples.
pub(super) struct Message {
    /// 0 if it has no stamp.
    pub stamp: i64,
    pub logged: i64,
    pub joints: Rc<[String]>,
    /// Times from the message's own, of a trajectory; 0 of a state.
    pub rows: Vec<Row>,
}

impl Message {
    /// Reads a message in CDR, or returns `None` if it is not of the kind.
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

    /// Returns true if it has positions of this joint.
    pub fn names(&self, joint: &str) -> bool {
        self.joints.iter().any(|name| name == joint)
    }
}
