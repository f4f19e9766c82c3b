//! Moving obstacles, and their trajectories.

use cplan_geometry::{Interval, Point, Pose, Vector, merge_in_place};
use cplan_judge::Drift;
use cplan_model::{LooseObstacle, Obstacle, are_small};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Greatest time of a stop, seconds. It equals the duration of the longest motion that cplan times; a larger time must be a
/// mistake.
pub const MAX_STOP_TIME: f64 = 1e6;

/// A time, and the pose of a moving obstacle's frame at that time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stop {
    /// Time, seconds after the arm's motion begins.
    pub time: f64,
    /// Origin of the obstacle's own frame, in plane coordinates, metres.
    pub at: Point,
    /// Angle of the frame in the plane, radians. Between two stops, the frame turns by the difference of their angles, which may
    /// exceed a whole turn.
    pub angle: f64,
}

/// The motion of an obstacle: straight and uniform from stop to stop. Before the time of the first stop, the obstacle waits
/// there. After the last stop, it stays there, or moves on for ever at a constant velocity, like an object on a conveyor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "ObstacleTrajectoryRecord", into = "ObstacleTrajectoryRecord")]
pub struct ObstacleTrajectory {
    stops: Vec<Stop>,
    /// Velocity from the last stop on, metres per second.
    velocity: Vector,
    /// Legs, computed from the stops and the velocity.
    legs: Vec<TrajectoryLeg>,
}

/// Serialized form of an [`ObstacleTrajectory`].
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ObstacleTrajectoryRecord {
    stops: Vec<Stop>,
    velocity: Vector,
}

impl From<ObstacleTrajectory> for ObstacleTrajectoryRecord {
    fn from(ObstacleTrajectory { stops, velocity, .. }: ObstacleTrajectory) -> Self {
        Self { stops, velocity }
    }
}

impl TryFrom<ObstacleTrajectoryRecord> for ObstacleTrajectory {
    type Error = ObstacleTrajectoryError;

    fn try_from(
        ObstacleTrajectoryRecord { stops, velocity }: ObstacleTrajectoryRecord,
    ) -> Result<Self, ObstacleTrajectoryError> {
        Self::new(stops, velocity)
    }
}

/// A defect in the stops of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ObstacleTrajectoryError {
    /// There are no stops.
    #[error("a moving obstacle needs at least one stop")]
    Empty,
    /// A time is negative, not later than the previous one, or greater than [`MAX_STOP_TIME`].
    #[error("stop {} has the time {time} s; times must increase, from 0 or more to less than {MAX_STOP_TIME:e} s", stop + 1)]
    Time {
        /// Index of the stop, from 0.
        stop: usize,
        /// The stop's time.
        time: f64,
    },
    /// A place, angle or velocity is not finite, or is too large.
    #[error("stop {}: the position or the velocity is not finite, or too large", stop + 1)]
    Place {
        /// Index of the stop, from 0.
        stop: usize,
    },
}

/// A stretch of a trajectory with constant velocity and angular velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrajectoryLeg {
    /// Time at which the leg begins, seconds.
    pub from: f64,
    /// Time at which the leg ends, seconds; infinite for the last leg.
    pub to: f64,
    /// Pose at the beginning of the leg.
    pub start: Stop,
    /// Velocity of the frame's origin, metres per second.
    pub velocity: Vector,
    /// Angular velocity of the frame, radians per second.
    pub turn: f64,
}

impl TrajectoryLeg {
    /// Returns the frame's pose at a time of the leg.
    pub fn pose(&self, time: f64) -> Pose {
        let since = time - self.from;
        Pose::new(self.start.at + self.velocity * since, self.start.angle + self.turn * since)
    }

    /// Returns true if the obstacle is at rest during the leg.
    pub fn is_still(&self) -> bool {
        self.turn == 0.0 && self.velocity == Vector::zeros()
    }

    /// Returns an upper bound, in metres per second, on the speed of points within `reach` metres of the frame's
    /// origin.
    pub fn speed(&self, reach: f64) -> f64 {
        self.velocity.norm() + self.turn.abs() * reach
    }
}

impl ObstacleTrajectory {
    /// Creates a trajectory from stop to stop. After the last one, it continues at `velocity`, metres per second.
    ///
    /// # Errors
    /// The first [`ObstacleTrajectoryError`].
    pub fn new(stops: Vec<Stop>, velocity: Vector) -> Result<Self, ObstacleTrajectoryError> {
        if stops.is_empty() {
            return Err(ObstacleTrajectoryError::Empty);
        }
        let mut before = -1.0;
        for (stop, Stop { time, at, angle }) in stops.iter().enumerate() {
            if !(0.0..=MAX_STOP_TIME).contains(time) || *time <= before {
                return Err(ObstacleTrajectoryError::Time { stop, time: *time });
            }
            before = *time;
            let is_last = stop + 1 == stops.len();
            let numbers = [at.x, at.y, *angle].into_iter().chain(velocity.iter().copied().filter(|_| is_last));
            if !are_small(numbers) {
                return Err(ObstacleTrajectoryError::Place { stop });
            }
        }
        let legs = legs(&stops, velocity);
        Ok(Self { stops, velocity, legs })
    }

    /// Creates a trajectory that begins at `at` with a constant velocity, metres per second, and never turns.
    ///
    /// # Errors
    /// If numbers are not finite.
    pub fn conveyor(at: [f64; 2], velocity: [f64; 2]) -> Result<Self, ObstacleTrajectoryError> {
        Self::new(vec![Stop { time: 0.0, at: at.into(), angle: 0.0 }], velocity.into())
    }

    /// Returns the stops, in the order of time; at least one.
    pub fn stops(&self) -> &[Stop] {
        &self.stops
    }

    /// Returns the velocity after the last stop, metres per second.
    pub fn velocity(&self) -> Vector {
        self.velocity
    }

    /// Returns the legs from time 0 on, in order. The last leg never ends.
    pub fn legs(&self) -> &[TrajectoryLeg] {
        &self.legs
    }

    /// Returns the frame's pose at a time, which must not be negative.
    pub fn pose(&self, time: f64) -> Pose {
        self.leg(time).pose(time)
    }

    /// Returns a bound on the motion from one time to another.
    pub fn drift(&self, from: f64, to: f64) -> Drift {
        let (middle, half) = (f64::midpoint(from, to), (to - from) / 2.0);
        let leg = self.leg(middle);
        let middle = leg.pose(middle);
        if leg.from <= from && to <= leg.to {
            return Drift { middle, velocity: leg.velocity, turn: leg.turn, half, any: [0.0; 2] };
        }
        let met = self.legs.iter().filter(|leg| leg.from <= to && from <= leg.to);
        let any = met.fold([0.0_f64; 2], |[v, w], leg| [v.max(leg.velocity.norm()), w.max(leg.turn.abs())]);
        Drift { middle, velocity: Vector::zeros(), turn: 0.0, half, any }
    }

    /// Returns true if the frame ever turns.
    pub fn turns(&self) -> bool {
        self.legs.iter().any(|leg| leg.turn != 0.0)
    }

    /// Returns the trajectory on a clock that begins at `time`, which must not be negative.
    #[must_use]
    pub fn since(&self, time: f64) -> Self {
        let here = self.pose(time);
        let later = self.stops.iter().filter(|stop| stop.time > time);
        let mut stops: Vec<Stop> = later.map(|stop| Stop { time: stop.time - time, ..*stop }).collect();
        if time >= self.stops[0].time {
            // The angle comes from the leg, because a pose does not contain whole turns.
            let leg = self.leg(time);
            let angle = leg.start.angle + leg.turn * (time - leg.from);
            stops.insert(0, Stop { time: 0.0, at: here.translation, angle });
        }
        let legs = legs(&stops, self.velocity);
        Self { stops, velocity: self.velocity, legs }
    }

    /// Returns the intervals of time, in order, in which the frame's origin passes a point: it is at the point, or nearest to it
    /// and within `within` metres.
    pub fn passes(&self, at: Point, within: f64) -> Vec<Interval> {
        let of = |leg: &TrajectoryLeg| {
            let (way, speed2) = (at - leg.start.at, leg.velocity.norm_squared());
            let times = if speed2 > 0.0 {
                let nearest = (leg.from + leg.velocity.dot(&way) / speed2).clamp(leg.from, leg.to);
                [nearest; 2]
            } else {
                [leg.from, leg.to]
            };
            let off = (at - (leg.start.at + leg.velocity * (times[0] - leg.from))).norm();
            (off <= within).then_some(times)
        };
        let mut times = self.legs.iter().filter_map(of).collect();
        merge_in_place(&mut times);
        times
    }

    fn leg(&self, time: f64) -> &TrajectoryLeg {
        let next = self.legs.partition_point(|leg| leg.from <= time);
        &self.legs[next.saturating_sub(1)]
    }
}

/// Computes the legs of a trajectory from time 0 on.
fn legs(stops: &[Stop], velocity: Vector) -> Vec<TrajectoryLeg> {
    let first = stops[0];
    let mut legs = Vec::with_capacity(stops.len() + 1);
    if first.time > 0.0 {
        let start = Stop { time: 0.0, ..first };
        legs.push(TrajectoryLeg { from: 0.0, to: first.time, start, velocity: Vector::zeros(), turn: 0.0 });
    }
    for pair in stops.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let lasts = b.time - a.time;
        let (velocity, turn) = ((b.at - a.at) / lasts, (b.angle - a.angle) / lasts);
        legs.push(TrajectoryLeg { from: a.time, to: b.time, start: a, velocity, turn });
    }
    let last = stops[stops.len() - 1];
    legs.push(TrajectoryLeg { from: last.time, to: f64::INFINITY, start: last, velocity, turn: 0.0 });
    legs
}

/// An obstacle that moves. Its motion does not depend on the arm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MovingObstacle {
    /// Name, heights and shape of the obstacle, in its own frame.
    pub obstacle: Obstacle,
    /// Motion of the obstacle's frame.
    #[serde(rename = "course")]
    pub trajectory: ObstacleTrajectory,
}

impl MovingObstacle {
    /// Returns the obstacle at its place at a time.
    pub fn at(&self, time: f64) -> Obstacle {
        self.obstacle.at(&self.trajectory.pose(time))
    }

    /// Returns the obstacle without a place, as scenes contain it.
    pub fn to_loose_obstacle(&self) -> LooseObstacle {
        let angle = (!self.trajectory.turns()).then(|| self.trajectory.stops()[0].angle);
        LooseObstacle { obstacle: self.obstacle.clone(), angle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn stop(time: f64, x: f64, y: f64, angle: f64) -> Stop {
        Stop { time, at: Point::new(x, y), angle }
    }

    #[test]
    fn a_trajectory_waits_moves_stays_and_leaves() {
        let stops = vec![stop(1.0, 0.0, 0.0, 0.0), stop(3.0, 1.0, 2.0, 1.0)];
        let stays = ObstacleTrajectory::new(stops.clone(), Vector::zeros()).unwrap();
        let place = |trajectory: &ObstacleTrajectory, time: f64| {
            let pose = trajectory.pose(time);
            [pose.translation.x, pose.translation.y, pose.rotation.angle()]
        };
        assert_eq!(place(&stays, 0.5), [0.0, 0.0, 0.0]);
        assert_eq!(place(&stays, 2.0), [0.5, 1.0, 0.5]);
        assert_eq!(place(&stays, 99.0), [1.0, 2.0, 1.0]);
        let leaves = ObstacleTrajectory::new(stops, Vector::new(0.5, 0.0)).unwrap();
        assert_eq!(place(&leaves, 5.0), [2.0, 2.0, 1.0]);
        assert_eq!(place(&ObstacleTrajectory::conveyor([1.0, 0.0], [0.0, -0.25]).unwrap(), 4.0), [1.0, -1.0, 0.0]);
    }

    #[test]
    fn a_trajectory_since_a_later_time_has_the_same_poses() {
        let stops = vec![stop(1.0, 0.0, 0.0, 0.0), stop(3.0, 1.0, 2.0, 7.0)];
        let trajectory = ObstacleTrajectory::new(stops, Vector::new(0.5, 0.0)).unwrap();
        for time in [0.0, 0.5, 1.0, 1.7, 3.0, 4.5] {
            let later = trajectory.since(time);
            for since in [0.0, 0.3, 0.5, 1.0, 2.5, 9.0] {
                let (a, b) = (trajectory.pose(time + since), later.pose(since));
                assert!((a.translation - b.translation).norm() < 1e-12, "{since} s after {time} s");
                assert!((a.rotation.angle() - b.rotation.angle()).abs() < 1e-12, "{since} s after {time} s");
            }
        }
    }

    #[test]
    fn a_trajectory_passes_a_point_at_the_known_times() {
        let belt = ObstacleTrajectory::conveyor([1.0, -1.0], [0.0, 0.25]).unwrap();
        assert_eq!(belt.passes(Point::new(1.0, 0.0), 1e-3), [[4.0, 4.0]]);
        assert!(
            belt.passes(Point::new(1.0, -1.1), 1e-3).is_empty() && belt.passes(Point::new(1.1, 0.0), 1e-3).is_empty()
        );
        let stops = vec![
            stop(1.0, 0.0, 0.0, 0.0),
            stop(2.0, 1.0, 0.0, 0.0),
            stop(3.0, 1.0, 0.0, 0.0),
            stop(4.0, 0.0, 0.0, 0.0),
        ];
        let there_and_back = ObstacleTrajectory::new(stops, Vector::zeros()).unwrap();
        assert_eq!(there_and_back.passes(Point::new(1.0, 0.0), 1e-3), [[2.0, 3.0]]);
        assert_eq!(there_and_back.passes(Point::new(0.5, 0.0), 1e-3), [[1.5, 1.5], [3.5, 3.5]]);
        assert_eq!(there_and_back.passes(Point::zeros(), 1e-3), [[0.0, 1.0], [4.0, f64::INFINITY]]);
    }

    #[test]
    fn invalid_stops_are_refused() {
        let trajectory = |stops: Vec<Stop>| ObstacleTrajectory::new(stops, Vector::zeros()).unwrap_err();
        assert_eq!(trajectory(vec![]), ObstacleTrajectoryError::Empty);
        assert_eq!(
            trajectory(vec![stop(1.0, 0.0, 0.0, 0.0), stop(1.0, 1.0, 0.0, 0.0)]),
            ObstacleTrajectoryError::Time { stop: 1, time: 1.0 }
        );
        assert_eq!(trajectory(vec![stop(-1.0, 0.0, 0.0, 0.0)]), ObstacleTrajectoryError::Time { stop: 0, time: -1.0 });
        assert_eq!(trajectory(vec![stop(0.0, f64::NAN, 0.0, 0.0)]), ObstacleTrajectoryError::Place { stop: 0 });
        assert!(ObstacleTrajectory::conveyor([0.0, 0.0], [f64::INFINITY, 0.0]).is_err());
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(300))]

        /// Compares the true place of a point of a moving obstacle with the bound of its drift, also across stops.
        #[test]
        fn points_stay_where_their_drift_lets_them(
            at in prop::array::uniform4(prop::array::uniform3(-2.0..2.0_f64)), times in prop::array::uniform4(0.1..1.0_f64),
            point in prop::array::uniform2(-1.0..1.0_f64), from in 0.0..3.0_f64, lasts in 0.0..1.0_f64, share in 0.0..1.0_f64,
        ) {
            let mut time = 0.0;
            let stops = at.iter().zip(times).map(|([x, y, angle], lasts)| {
                time += lasts;
                stop(time, *x, *y, *angle)
            });
            let trajectory = ObstacleTrajectory::new(stops.collect(), Vector::new(at[0][0], at[1][0])).unwrap();
            let drift = trajectory.drift(from, from + lasts);
            let point = Point::from(point);
            let middle = drift.middle.point(point);
            let then = trajectory.pose(from + share * lasts).point(point);
            let moved = then - middle;
            let linear = drift.of(middle) * (2.0 * share - 1.0);
            prop_assert!((moved - linear).norm() <= drift.error_bound(middle) + 1e-12);
            prop_assert!(moved.norm() <= drift.farthest(point.norm()) + 1e-12);
        }
    }
}
