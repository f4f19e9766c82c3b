//! A path under a clock.

use super::profile::{Phase, Profile, State};
use crate::certify::CertifiedPath;
use crate::model::Joint;
use crate::space::{Configuration, Path};
use serde::Serialize;
use thiserror::Error;

/// Two samples are never closer in time than (about) this, seconds. A thousandth of the fastest servo cycle in use
/// (1 ms), so nobody misses what it suppresses; a thousand times the nanosecond in which ROS counts and, at the end of
/// [`LONGEST_MOTION`], ten thousand times the spacing of doubles, so that times stay distinct however they are rounded.
pub const SHORTEST_INTERVAL: f64 = 1e-6;

/// The longest motion that is timed, seconds: eleven days. Beyond, the limits are a mistake rather than a wish, and
/// doubles no longer resolve [`SHORTEST_INTERVAL`] well.
pub const LONGEST_MOTION: f64 = 1e6;

/// The most samples a trajectory may have: some 300 MB of them.
pub const MOST_SAMPLES: usize = 5_000_000;

/// A motion of both joints, sampled.
///
/// Within each interval from `time[k]` to `time[k + 1]` the acceleration is constant, so with `t = time - time[k]` the
/// motion is, up to rounding, `position[k] + velocity[k] t + acceleration[k] t^2 / 2`: the samples are the motion, not an
/// approximation of it. Times begin at 0 and increase strictly, by at least [`SHORTEST_INTERVAL`]. Radians or metres, and
/// seconds; joints in the order base to tip.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trajectory {
    /// Seconds from the start.
    pub time: Vec<f64>,
    /// Joint values; the first is the path's start, the last its goal, exactly.
    pub position: Vec<[f64; 2]>,
    /// Joint velocities; the first and the last are 0.
    pub velocity: Vec<[f64; 2]>,
    /// Joint accelerations on the interval that begins here; 0 at the last sample.
    pub acceleration: Vec<[f64; 2]>,
}

/// Why a path cannot be timed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TimingError {
    /// The period is not a number, not finite, or too small.
    #[error("the sampling period is {0} s; it must be a finite number of at least {SHORTEST_INTERVAL} s")]
    Period(f64),
    /// Too many samples.
    #[error(
        "sampling {duration:.3} s of motion every {period} s gives more than {MOST_SAMPLES} samples; \
         choose a longer period"
    )]
    TooManySamples {
        /// Of the motion, seconds.
        duration: f64,
        /// As asked, seconds.
        period: f64,
    },
    /// The limits let the joints hardly move.
    #[error(
        "the motion would last {0:.3e} s, more than {LONGEST_MOTION:.0e} s; \
         raise the velocity and acceleration limits of the joints"
    )]
    TooLong(f64),
}

impl Trajectory {
    /// Seconds from the first to the last sample.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.time.last().copied().unwrap_or(0.0)
    }

    fn with_capacity(samples: usize) -> Self {
        Self {
            time: Vec::with_capacity(samples),
            position: Vec::with_capacity(samples),
            velocity: Vec::with_capacity(samples),
            acceleration: Vec::with_capacity(samples),
        }
    }

    fn push(&mut self, time: f64, [position, velocity, acceleration]: [Configuration; 3]) {
        // Adding 0 turns the minus zero of a joint at rest into zero.
        let row = |v: Configuration| [v[0] + 0.0, v[1] + 0.0];
        self.time.push(time);
        self.position.push([position[0], position[1]]);
        self.velocity.push(row(velocity));
        self.acceleration.push(row(acceleration));
    }
}

/// A straight piece of the path with its motion along it.
struct Leg {
    from: Configuration,
    to: Configuration,
    length: f64,
    direction: Configuration,
    profile: Profile,
    /// When it begins and ends, seconds.
    begin: f64,
    end: f64,
}

impl Leg {
    fn new(from: Configuration, to: Configuration, joints: &[Joint; 2], begin: f64) -> Self {
        let offset = to - from;
        // Unlike the root of the sum of squares this does not vanish for the shortest of offsets.
        let length = offset[0].hypot(offset[1]);
        let direction = offset / length;
        // The distance may grow as fast as the slower joint allows; a joint that stands still does not limit it.
        let least = |limit: fn(&Joint) -> f64| {
            (0..2).map(|k| limit(&joints[k]) / direction[k].abs()).fold(f64::INFINITY, f64::min)
        };
        let profile =
            Profile::rest_to_rest(length, least(|j| j.velocity), least(|j| j.acceleration), SHORTEST_INTERVAL);
        Self { from, to, length, direction, profile, begin, end: begin + profile.duration() }
    }

    fn at(&self, phase: Phase, time: f64) -> [Configuration; 3] {
        let State { distance, speed, acceleration } = self.profile.at(phase, time);
        let part = distance / self.length;
        let between = |k: usize| {
            let (a, b) = (self.from[k], self.to[k]);
            // Rounding must not carry a sample beyond the corner, which may lie on a joint limit.
            (a + (b - a) * part).clamp(a.min(b), a.max(b))
        };
        let position = Configuration::new(between(0), between(1));
        [position, self.direction * speed, self.direction * acceleration]
    }
}

/// Times a path: along each straight piece from rest to rest, both joints in step, as fast as the joints' velocity and
/// acceleration limits allow.
///
/// The motion stops at every corner, so it follows the path exactly. Samples lie at the multiples of `period` and, so
/// that the acceleration is constant within each interval, wherever it changes; multiples of the period closer than
/// [`SHORTEST_INTERVAL`] to such an instant are left out. A path that stays where it is gives one sample.
///
/// The duration of a piece of length `L`, with speed and acceleration limits `v` and `a` along it, is `2 sqrt(L / a)` if
/// `L a <= v^2`, else `L / v + v / a`, up to `4` [`SHORTEST_INTERVAL`] longer where a phase would be shorter than that.
/// Linear in the number of samples.
///
/// # Errors
/// [`TimingError`]: a useless period, a motion beyond [`LONGEST_MOTION`], or more than [`MOST_SAMPLES`] samples.
pub fn time(path: &CertifiedPath, joints: &[Joint; 2], period: f64) -> Result<Trajectory, TimingError> {
    time_path(path.path(), joints, period)
}

/// [`time`], whatever the path is good for.
pub(super) fn time_path(path: &Path, joints: &[Joint; 2], period: f64) -> Result<Trajectory, TimingError> {
    if !(period.is_finite() && period >= SHORTEST_INTERVAL) {
        return Err(TimingError::Period(period));
    }
    let mut legs: Vec<Leg> = Vec::new();
    for (from, to) in path.segments() {
        let begin = legs.last().map_or(0.0, |leg| leg.end);
        legs.push(Leg::new(from, to, joints, begin));
    }
    let duration = legs.last().map_or(0.0, |leg| leg.end);
    if duration.is_nan() || duration > LONGEST_MOTION {
        return Err(TimingError::TooLong(duration));
    }
    let samples = duration / period + 3.0 * legs.len() as f64 + 1.0;
    if samples > MOST_SAMPLES as f64 {
        return Err(TimingError::TooManySamples { duration, period });
    }

    let mut trajectory = Trajectory::with_capacity(samples as usize + 1);
    for leg in &legs {
        for phase in leg.profile.phases() {
            let begin = leg.begin + phase.begin;
            let end = begin + phase.duration;
            trajectory.push(begin, leg.at(phase, 0.0));
            let first = (begin / period) as u64;
            let multiples = (first..).map(|k| k as f64 * period).skip_while(|&t| t - begin < SHORTEST_INTERVAL);
            for time in multiples.take_while(|&t| end - t >= SHORTEST_INTERVAL) {
                trajectory.push(time, leg.at(phase, time - begin));
            }
        }
    }
    trajectory.push(duration, [path.goal(), Configuration::zeros(), Configuration::zeros()]);
    Ok(trajectory)
}
