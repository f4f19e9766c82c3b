//! The contents of a ROS 2 message about a motion.

use super::Trajectory;
use cplan_handling::{Drives, RobotJoints};
use thiserror::Error;

/// A motion of all joints that a message names.
#[derive(Debug, Clone, PartialEq)]
pub struct JointMotion {
    /// Names in the URDF.
    pub joints: Vec<String>,
    /// Times in seconds from the start. They are whole nanoseconds and strictly increasing.
    pub time: Vec<f64>,
    /// For each sample, the value of each joint, radians or metres.
    pub position: Vec<Vec<f64>>,
    /// For each sample, the velocity of each joint, radians or metres per second.
    pub velocity: Vec<Vec<f64>>,
    /// For each sample, the acceleration of each joint. `None` if readers must join samples by cubics.
    pub acceleration: Option<Vec<Vec<f64>>>,
}

/// The accelerations of a motion jump. Readers that join samples by quintics would execute another motion.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "accelerations cannot be written: they jump at {time:.6} s, so a controller that joins points by quintics would leave the certified motion; limit the jerk of both joints (--jerk 200,200, or [robot] jerk in the world file), or leave out --accelerations"
)]
pub struct AccelerationJump {
    /// Time of the first jump, seconds.
    pub time: f64,
}

/// Two accelerations at a sample count as equal if they differ by at most this share of the greatest acceleration. It is far
/// above the rounding to nanoseconds, and has no visible effect on a quintic.
const ACCELERATION_TOLERANCE: f64 = 1e-6;

/// Uncertainty of a piece's acceleration, as a multiple of a unit in the last place of the greatest position, divided by the
/// piece's squared duration.
const ULPS: f64 = 256.0;

impl JointMotion {
    /// Creates a motion of the planned joints, and of the wrist if it turns in the trajectory. Other joints are at rest.
    pub fn new(robot: &RobotJoints, trajectory: &Trajectory, accelerations: bool) -> Self {
        let turned = |k: usize, of: usize| trajectory.wrist.get(k).map(|row| row[of]);
        let position = |(k, &planned): (usize, &[f64; 2])| {
            let at_rest = robot.at_rest(planned);
            robot.values(&Drives { wrist: turned(k, 0).unwrap_or(at_rest.wrist), ..at_rest })
        };
        let positions = trajectory.position.iter().enumerate().map(position);
        let rates = |rows: &[[f64; 2]], of: usize| {
            let rate = |(k, &planned): (usize, &[f64; 2])| {
                robot.rates(&Drives { planned, wrist: turned(k, of).unwrap_or(0.0), ..Drives::default() })
            };
            rows.iter().enumerate().map(rate).collect::<Vec<_>>()
        };
        Self {
            joints: robot.names().map(str::to_owned).collect(),
            time: trajectory.time.clone(),
            position: positions.collect(),
            velocity: rates(&trajectory.velocity, 1),
            acceleration: accelerations.then(|| rates(&trajectory.acceleration, 2)),
        }
    }
}

impl JointMotion {
    /// Removes the samples after which all joints stay at rest.
    #[must_use]
    pub fn without_rest(mut self) -> Self {
        while let [.., before, last] = &self.position[..]
            && before == last
        {
            self.position.pop();
            self.time.pop();
            self.velocity.pop();
            self.acceleration.iter_mut().for_each(|rows| drop(rows.pop()));
        }
        self
    }

    /// Removes the accelerations, for readers that join samples by cubics.
    #[must_use]
    pub fn without_accelerations(self) -> Self {
        Self { acceleration: None, ..self }
    }
}

impl Trajectory {
    /// Checks that quintics through the samples equal the motion: its acceleration must not jump.
    ///
    /// # Errors
    /// The first jump.
    pub fn check_accelerations(&self) -> Result<(), AccelerationJump> {
        let greatest = |rows: &[[f64; 2]]| rows.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        let (pull, size) = (greatest(&self.acceleration), greatest(&self.position));
        let is_smooth = |k: usize| {
            let h = self.time[k + 1] - self.time[k];
            (0..2).all(|joint| {
                let [p, v, a] = [&self.position, &self.velocity, &self.acceleration].map(|rows| rows[k][joint]);
                let beyond = self.position[k + 1][joint] - p - v * h - a * h * h / 2.0;
                let faster = self.velocity[k + 1][joint] - v - a * h;
                // The acceleration at the end of the interval, by INTERPOLATION.
                let end = a + 6.0 * (faster * h - 2.0 * beyond) / h / h;
                let may = ACCELERATION_TOLERANCE * pull + ULPS * f64::EPSILON * size / h / h;
                (end - self.acceleration[k + 1][joint]).abs() <= may
            })
        };
        match (0..self.time.len().saturating_sub(1)).find(|&k| !is_smooth(k)) {
            Some(k) => Err(AccelerationJump { time: self.time[k + 1] }),
            None => Ok(()),
        }
    }
}
