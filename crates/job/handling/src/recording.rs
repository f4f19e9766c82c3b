//! Recordings: motions given by samples.

use super::{Derivative, Interpolation, Piece};
use cplan_model::space::{Configuration, Path, Topology};
use std::ops::RangeInclusive;
use thiserror::Error;

/// Limit on joint values, radians or metres. No arm needs larger values, and doubles near the limit still resolve a nanometre.
const MAX_VALUE: f64 = 1e6;

/// Limit on times, velocities and accelerations. Even seconds since 1970 are far smaller, so larger values are a mistake.
const MAX_RATE: f64 = 1e12;

/// A motion of both joints, given by samples and their [`Interpolation`]. Values are in radians or metres, and are not
/// wrapped. Times are in seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    position: Vec<Configuration>,
    time: Option<Vec<f64>>,
    velocity: Option<Vec<Configuration>>,
    acceleration: Option<Vec<Configuration>>,
    interpolation: Interpolation,
    /// Indices of the samples, ascending, after which the arm rests. From each of them, the motion to the next sample is
    /// straight.
    rests: Vec<usize>,
}

/// The motion of all joints of a robot, which a file states in addition to that of the arm's two joints.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedJoints {
    /// The motion of the arm's two joints.
    pub arm: Recording,
    /// Names of the other joints, each with its values, as first coordinates, at the same samples.
    pub others: Vec<(String, Recording)>,
}

/// The reason why samples do not form a motion. Samples are numbered from 0.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum RecordingError {
    /// There are no samples.
    #[error("there is no sample")]
    Empty,
    /// The numbers of positions, times, velocities and accelerations differ.
    #[error("there are {positions} positions, but {others} {what}")]
    Count {
        /// Number of positions.
        positions: usize,
        /// Kind of the other values: `times`, `velocities` or `accelerations`.
        what: &'static str,
        /// Number of the other values.
        others: usize,
    },
    /// There are velocities but no times.
    #[error("there are velocities, but no times")]
    VelocityWithoutTime,
    /// The interpolation uses accelerations, but there are no velocities.
    #[error("there are accelerations, but no velocities")]
    AccelerationWithoutVelocity,
    /// A number is NaN, infinite, or implausibly large.
    #[error("a {what} is {value}")]
    Value {
        /// Index of the sample.
        sample: usize,
        /// Kind of the number: `position`, `time`, `velocity` or `acceleration`.
        what: &'static str,
        /// The wrong number.
        value: f64,
    },
    /// Times do not increase.
    #[error("the time {time} s follows {before} s; times must increase")]
    Time {
        /// Index of the later of two samples.
        sample: usize,
        /// The time of the sample, seconds.
        time: f64,
        /// The time of the sample before it, seconds.
        before: f64,
    },
}

impl RecordingError {
    /// Returns the index of the sample with the error. `None` if no single sample is wrong.
    pub fn sample(&self) -> Option<usize> {
        match *self {
            RecordingError::Value { sample, .. } | RecordingError::Time { sample, .. } => Some(sample),
            _ => None,
        }
    }
}

impl Recording {
    /// Creates a motion from samples. The interpolation is cubic if velocities are known, and linear otherwise.
    ///
    /// # Errors
    /// The first problem, as a [`RecordingError`].
    pub fn new(
        position: Vec<Configuration>,
        time: Option<Vec<f64>>,
        velocity: Option<Vec<Configuration>>,
    ) -> Result<Self, RecordingError> {
        if position.is_empty() {
            return Err(RecordingError::Empty);
        }
        if velocity.is_some() && time.is_none() {
            return Err(RecordingError::VelocityWithoutTime);
        }
        let counts = [("times", time.as_ref().map(Vec::len)), ("velocities", velocity.as_ref().map(Vec::len))];
        for (what, others) in counts {
            if let Some(others) = others.filter(|n| *n != position.len()) {
                return Err(RecordingError::Count { positions: position.len(), what, others });
            }
        }
        for sample in 0..position.len() {
            let rates = velocity.as_ref().map(|v| v[sample]);
            let numbers = [("position", Some(position[sample]), MAX_VALUE), ("velocity", rates, MAX_RATE)];
            for (what, row, limit) in numbers {
                if let Some(&value) = row.iter().flatten().find(|v| outside(**v, limit)) {
                    return Err(RecordingError::Value { sample, what, value });
                }
            }
            let Some(time) = &time else { continue };
            if outside(time[sample], MAX_RATE) {
                return Err(RecordingError::Value { sample, what: "time", value: time[sample] });
            }
            if sample > 0 && time[sample] <= time[sample - 1] {
                let (time, before) = (time[sample], time[sample - 1]);
                return Err(RecordingError::Time { sample, time, before });
            }
        }
        let interpolation = if velocity.is_some() { Interpolation::Cubic } else { Interpolation::Linear };
        Ok(Self { position, time, velocity, acceleration: None, interpolation, rests: Vec::new() })
    }

    /// Adds accelerations and sets the interpolation, which may use them.
    ///
    /// # Errors
    /// [`RecordingError`] if the number of accelerations is wrong, if one is too large, or if the interpolation needs
    /// velocities and there are none.
    pub fn accelerated(
        self,
        acceleration: Vec<Configuration>,
        interpolation: Interpolation,
    ) -> Result<Self, RecordingError> {
        let uses = |what: &[Interpolation]| what.contains(&interpolation);
        if self.velocity.is_none() && !uses(&[Interpolation::Linear]) {
            return Err(RecordingError::AccelerationWithoutVelocity);
        }
        if acceleration.len() != self.position.len() {
            let (positions, others) = (self.position.len(), acceleration.len());
            return Err(RecordingError::Count { positions, what: "accelerations", others });
        }
        for (sample, row) in acceleration.iter().enumerate() {
            if let Some(&value) = row.iter().find(|value| outside(**value, MAX_RATE)) {
                return Err(RecordingError::Value { sample, what: "acceleration", value });
            }
        }
        Ok(Self { acceleration: Some(acceleration), interpolation, ..self })
    }

    /// Makes the motion straight from each of these samples to the next, whatever the interpolation. For samples at which one
    /// motion ends and the arm rests until the next one begins.
    #[must_use]
    pub fn resting_after(self, samples: &[usize]) -> Self {
        let mut rests = samples.to_vec();
        rests.sort_unstable();
        Self { rests, ..self }
    }

    /// Returns the joint values of the samples; at least one.
    pub fn positions(&self) -> &[Configuration] {
        &self.position
    }

    /// Returns the times of the samples, strictly increasing, seconds. `None` if there are no times.
    pub fn times(&self) -> Option<&[f64]> {
        self.time.as_deref()
    }

    /// Returns the joint velocities at the samples. `None` if they are unknown.
    pub fn velocities(&self) -> Option<&[Configuration]> {
        self.velocity.as_deref()
    }

    /// Returns the joint accelerations at the samples. `None` if they are unknown.
    pub fn accelerations(&self) -> Option<&[Configuration]> {
        self.acceleration.as_deref()
    }

    /// Returns the interpolation between samples.
    pub fn interpolation(&self) -> Interpolation {
        self.interpolation
    }

    /// Returns the time from the first to the last sample, seconds. `None` if there are no times.
    pub fn duration(&self) -> Option<f64> {
        self.time.as_ref().map(|t| t[t.len() - 1] - t[0])
    }

    /// Returns the recording of a range of samples, on the same clock. `None` if the range has no samples.
    #[must_use]
    pub fn part(&self, samples: RangeInclusive<usize>) -> Option<Self> {
        let last = (*samples.end()).min(self.position.len() - 1);
        let range = *samples.start()..=last;
        if range.is_empty() {
            return None;
        }
        let of = |values: &Vec<Configuration>| values[range.clone()].to_vec();
        Some(Self {
            position: of(&self.position),
            time: self.time.as_ref().map(|time| time[range.clone()].to_vec()),
            velocity: self.velocity.as_ref().map(of),
            acceleration: self.acceleration.as_ref().map(of),
            interpolation: self.interpolation,
            rests: self.rests.iter().filter(|rest| range.contains(rest)).map(|rest| rest - range.start()).collect(),
        })
    }

    /// Returns the motion with a linear map applied to its joint values, velocities and accelerations.
    #[must_use]
    pub fn mapped(&self, map: impl Fn(&Configuration) -> Configuration) -> Self {
        let of = |rows: &Vec<Configuration>| rows.iter().map(&map).collect::<Vec<_>>();
        Self {
            position: of(&self.position),
            velocity: self.velocity.as_ref().map(of),
            acceleration: self.acceleration.as_ref().map(of),
            ..self.clone()
        }
    }

    /// Returns the same motion with samples at these times, which must increase and be within the recording. Between two new
    /// samples, the motion is unchanged, up to rounding, if it is one polynomial there, as when `times` include all times of this
    /// recording.
    #[must_use]
    pub fn resampled(&self, times: &[f64]) -> Self {
        let pieces = self.pieces();
        let mut piece = 0;
        let (mut position, mut velocity, mut acceleration) = (Vec::new(), Vec::new(), Vec::new());
        for &time in times {
            while piece + 1 < pieces.len() && time >= pieces[piece].to {
                piece += 1;
            }
            let within = &pieces[piece];
            let duration = within.to - within.from;
            let share = if duration > 0.0 { ((time - within.from) / duration).clamp(0.0, 1.0) } else { 0.0 };
            position.push(within.at(share));
            velocity.push(within.derivative(Derivative::Velocity, share));
            acceleration.push(within.derivative(Derivative::Acceleration, share));
        }
        Self {
            position,
            time: Some(times.to_vec()),
            velocity: self.velocity.is_some().then_some(velocity),
            acceleration: self.acceleration.is_some().then_some(acceleration),
            interpolation: self.interpolation,
            rests: Vec::new(),
        }
    }

    /// Returns the pieces of the motion: piece `k` leads from sample `k` to sample `k + 1`. A single sample gives one
    /// piece at rest. If there are no times, sample `k` is at time `k`.
    pub fn pieces(&self) -> Vec<Piece> {
        let at = |k: usize| self.time.as_ref().map_or(k as f64, |t| t[k]);
        let q = &self.position;
        if q.len() == 1 {
            return vec![Piece::line(at(0), at(0), q[0], q[0])];
        }
        let rule = |k: usize| {
            if self.rests.binary_search(&k).is_ok() { Interpolation::Linear } else { self.interpolation }
        };
        let piece = |k: usize| match (rule(k), &self.velocity, &self.acceleration) {
            (Interpolation::Quintic, Some(v), Some(a)) => {
                Piece::quintic(at(k), at(k + 1), [q[k], v[k], a[k]], [q[k + 1], v[k + 1], a[k + 1]])
            }
            (Interpolation::Quartic, Some(v), Some(a)) => {
                Piece::quartic(at(k), at(k + 1), [q[k], v[k], a[k]], [q[k + 1], v[k + 1]])
            }
            (Interpolation::Linear, ..) | (_, None, _) => Piece::line(at(k), at(k + 1), q[k], q[k + 1]),
            (_, Some(v), _) => Piece::hermite(at(k), at(k + 1), [q[k], v[k]], [q[k + 1], v[k + 1]]),
        };
        (0..q.len() - 1).map(piece).collect()
    }

    /// Finds the intervals between samples in which a continuous joint moves by more than half a turn. Returns the first sample
    /// and the joint of each. In a recording with wrapped values, these are the intervals in which it crosses the seam.
    pub fn turns(&self, topology: &Topology) -> Vec<(usize, usize)> {
        let steps = self.position.windows(2).enumerate();
        let is_turn = |w: &[Configuration], k: usize| {
            topology.ranges[k].is_circle() && (w[1][k] - w[0][k]).abs() > std::f64::consts::PI
        };
        steps.flat_map(|(i, w)| (0..2).filter(move |&k| is_turn(w, k)).map(move |k| (i, k))).collect()
    }

    /// Adds whole turns to the values of continuous joints, so that they take the shorter direction between samples.
    #[must_use]
    pub fn unwrapped(mut self, topology: &Topology) -> Self {
        for k in 1..self.position.len() {
            self.position[k] = topology.lift(self.position[k], self.position[k - 1]);
        }
        self
    }

    /// Returns a polyline for pictures: the samples, and points between them on curved pieces.
    pub fn outline(&self) -> Path {
        let steps: u8 = if self.interpolation == Interpolation::Linear { 1 } else { 4 };
        let between = |p: Piece| (1..=steps).map(move |i| p.at(f64::from(i) / f64::from(steps)));
        let mut waypoints = vec![self.position[0]];
        waypoints.extend(self.pieces().into_iter().flat_map(between));
        Path::new(waypoints)
    }
}

/// Returns true if a number is NaN or implausibly large.
fn outside(value: f64, limit: f64) -> bool {
    value.is_nan() || value.abs() > limit
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_model::space::JointRange;

    fn q(a: f64, b: f64) -> Configuration {
        Configuration::new(a, b)
    }

    #[test]
    fn samples_that_form_no_motion_are_refused() {
        let two = || vec![q(0.0, 0.0), q(1.0, 2.0)];
        assert_eq!(Recording::new(vec![], None, None), Err(RecordingError::Empty));
        assert_eq!(Recording::new(two(), None, Some(two())), Err(RecordingError::VelocityWithoutTime));
        let count = |what, others| Err(RecordingError::Count { positions: 2, what, others });
        assert_eq!(Recording::new(two(), Some(vec![0.0]), None), count("times", 1));
        assert_eq!(Recording::new(two(), Some(vec![0.0, 1.0]), Some(vec![])), count("velocities", 0));
        for times in [[1.0, 1.0], [1.0, 0.5]] {
            let error = Recording::new(two(), Some(times.to_vec()), None).unwrap_err();
            assert_eq!(error, RecordingError::Time { sample: 1, time: times[1], before: 1.0 });
            assert_eq!(error.sample(), Some(1));
        }
        let sample = |r: Result<Recording, RecordingError>| r.unwrap_err().sample();
        assert_eq!(sample(Recording::new(two(), Some(vec![0.0, f64::NAN]), None)), Some(1));
        assert_eq!(sample(Recording::new(vec![q(0.0, 0.0), q(0.0, f64::INFINITY)], None, None)), Some(1));
        assert_eq!(sample(Recording::new(vec![q(1e7, 0.0)], None, None)), Some(0));
        let velocity = Some(vec![q(0.0, 0.0), q(f64::NAN, 0.0)]);
        assert_eq!(sample(Recording::new(two(), Some(vec![0.0, 1.0]), velocity)), Some(1));
    }

    #[test]
    fn jumps_across_seams_are_found_and_removed() {
        let topology = Topology::new([JointRange::Circle, JointRange::Interval { lower: -9.0, upper: 9.0 }]);
        let wrapped = Recording::new(vec![q(3.0, 0.0), q(-3.0, 5.0), q(-2.9, -5.0)], None, None).unwrap();
        assert_eq!(wrapped.turns(&topology), [(0, 0)]);
        let unwrapped = wrapped.unwrapped(&topology);
        assert!(unwrapped.turns(&topology).is_empty());
        assert!((unwrapped.positions()[2] - q(std::f64::consts::TAU - 2.9, -5.0)).norm() < 1e-14);
    }

    #[test]
    fn parts_are_the_samples_of_the_range() {
        let at = |k: usize| q(k as f64, -(k as f64));
        let all = || (0..5).map(at).collect::<Vec<_>>();
        let times = vec![0.0, 1.0, 2.5, 3.0, 4.0];
        let whole = Recording::new(all(), Some(times.clone()), Some(all())).unwrap();
        let expected = |range: std::ops::Range<usize>| {
            let of = || Some(all()[range.clone()].to_vec());
            Some(Recording::new(of().unwrap(), Some(times[range.clone()].to_vec()), of()).unwrap())
        };
        assert_eq!(whole.part(1..=3), expected(1..4));
        assert_eq!(whole.part(3..=usize::MAX), expected(3..5));
        assert_eq!(whole.part(2..=2), expected(2..3));
        assert_eq!((whole.part(5..=9), whole.part(RangeInclusive::new(3, 2))), (None, None));
    }

    #[test]
    fn a_single_sample_does_not_move() {
        let still = Recording::new(vec![q(0.1, 0.2)], Some(vec![3.0]), Some(vec![q(0.0, 0.0)])).unwrap();
        assert_eq!(still.duration(), Some(0.0));
        let pieces = still.pieces();
        assert_eq!((pieces.len(), pieces[0].from, pieces[0].to, pieces[0].at(1.0)), (1, 3.0, 3.0, q(0.1, 0.2)));
        assert_eq!(still.outline().waypoints(), [q(0.1, 0.2)]);
    }
}
