//! Trajectories: motions along a path, sampled in time.

use super::clock::{self, NANOSECONDS_PER_SECOND, nanoseconds, round_up, whole_nanoseconds};
use super::limits::{Axes, Limits};
use super::profile::Phase;
use super::schedule::{TimedTrack, Track, schedule};
use super::single::single;
use super::torque::TorqueLimit;
use crate::{BlendedPath, CertifiedCurve};
use cplan_handling::{Piece, ToolLimits};
use cplan_model::Scene;
use cplan_model::space::Configuration;
use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};
use thiserror::Error;

/// Approximate least time between two samples, seconds. It is a thousandth of the shortest servo cycle in use (1 ms), so no
/// useful sample is lost. It is also a thousand of ROS's nanoseconds and, at [`MAX_DURATION`], ten thousand times the spacing of
/// doubles, so times stay distinct after rounding.
pub const MIN_INTERVAL: f64 = 1e-6;

/// Least time, seconds, between a sample at a multiple of the period and any other sample, unless the period is shorter than
/// twice this. At this distance, rounding to doubles changes the acceleration of a cubic by less than a millionth of a radian per
/// squared second.
pub(super) const MIN_PERIODIC_INTERVAL: f64 = 1e-4;

/// Longest motion that is timed, seconds: eleven days. A longer motion probably has mistaken limits, and doubles would no longer
/// resolve [`MIN_INTERVAL`] well.
pub const MAX_DURATION: f64 = 1e6;

/// Greatest number of samples of a trajectory. They need some 300 MB of memory.
pub const MAX_SAMPLES: usize = 5_000_000;

/// A motion of both joints, sampled.
///
/// In each interval from `time[k]` to `time[k + 1]`, the motion is a polynomial in time of degree four. On straight pieces, the
/// degree is two, or three if the jerk is limited. The samples define the polynomial: position, velocity and acceleration `k` at
/// its beginning, and position and velocity `k + 1` at its end; see [`super::INTERPOLATION`]. So the samples are not an
/// approximation, but the motion itself, up to rounding.
///
/// Unless a joint's jerk is limited, the acceleration may jump at a sample; the stated one is that of the interval that begins
/// there. The cubic through positions and velocities of two samples is also within the limits, and is the same motion on straight
/// pieces.
///
/// Times begin at 0 and increase by at least [`MIN_INTERVAL`]. They are whole nanoseconds. Units are radians or metres, and
/// seconds. Joints are in the order from base to tip.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Trajectory {
    /// Seconds from the start.
    pub time: Vec<f64>,
    /// Joint values. The first ones are exactly the path's start, and the last ones its goal.
    pub position: Vec<[f64; 2]>,
    /// Joint velocities; the first and the last are 0.
    pub velocity: Vec<[f64; 2]>,
    /// Joint accelerations at the beginning of the interval that follows the sample; 0 at the last sample.
    pub acceleration: Vec<[f64; 2]>,
    /// Joint torques (N m), or forces (N) of prismatic joints, at the beginning of the interval that follows the
    /// sample. Empty if they are not requested.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub torque: Vec<[f64; 2]>,
    /// Value, velocity and acceleration of a wrist's joint, radians and seconds, which readers join like those of the arm. Empty
    /// if no wrist turns along the path.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "wrist_columns")]
    pub wrist: Vec<[f64; 3]>,
}

/// Writes the motion of a wrist like that of the arm: positions, velocities and accelerations.
fn wrist_columns<S: Serializer>(rows: &[[f64; 3]], serializer: S) -> Result<S::Ok, S::Error> {
    let mut columns = serializer.serialize_struct("wrist", 3)?;
    for (name, k) in [("position", 0), ("velocity", 1), ("acceleration", 2)] {
        columns.serialize_field(name, &rows.iter().map(|row| row[k]).collect::<Vec<_>>())?;
    }
    columns.end()
}

/// The reason why a path cannot be timed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TimingError {
    /// The period is not a number, not finite, or too small.
    #[error("the sampling period is {0} s; it must be a finite number of at least {MIN_INTERVAL} s")]
    Period(f64),
    /// The motion would have too many samples.
    #[error(
        "sampling {duration:.3} s of motion every {period} s gives more than {MAX_SAMPLES} samples; \
         choose a longer period"
    )]
    TooManySamples {
        /// Duration of the motion, seconds.
        duration: f64,
        /// The requested period, seconds.
        period: f64,
    },
    /// The motion would last longer than [`MAX_DURATION`]: the limits hardly let the joints move.
    #[error(
        "the motion would last {0:.3e} s, more than {MAX_DURATION:.0e} s; raise the limits of the joints, and the limit of the tip's speed if there is one"
    )]
    TooLong(f64),
    /// The effort of a joint or a motor is less than the torque that holds the arm against gravity.
    #[error(
        "{drive} has an effort of {effort} {unit}, but holding the arm at {} takes {torque:.3} {unit}; raise the effort in [robot], or choose a path that avoids this place",
        described(*.at)
    )]
    TooHeavy {
        /// The joint or the motor: `joint "elbow"`.
        drive: String,
        /// The configuration in which the arm cannot be held.
        at: [f64; 2],
        /// The required torque or force, N m or N.
        torque: f64,
        /// The effort.
        effort: f64,
        /// Unit of the torque and the effort.
        unit: &'static str,
    },
}

fn described([first, second]: [f64; 2]) -> String {
    format!("({first:.4}, {second:.4})")
}

impl Trajectory {
    /// Returns the seconds from the first to the last sample.
    pub fn duration(&self) -> f64 {
        self.time.last().copied().unwrap_or(0.0)
    }

    /// Returns a single sample at time 0, at which the arm of a scene rests at `q`.
    pub fn at_rest(scene: &Scene, q: Configuration) -> Self {
        let mut trajectory = Self::default();
        trajectory.push_rest(0, q);
        if let Some(torque) = TorqueLimit::of(scene) {
            trajectory.torque = torque.along_trajectory(&trajectory);
        }
        trajectory
    }

    /// Appends a motion that begins where this one ends, after a rest of `pause` seconds, rounded up to whole nanoseconds.
    /// Ignores pauses below [`MIN_INTERVAL`]. If there are no samples yet, the result is the appended motion.
    pub fn then(&mut self, pause: f64, next: &Trajectory) {
        let begin = self.time.last().map_or(0, |end| nanoseconds(after_pause(*end, pause)));
        if pause_length(pause) == 0.0 {
            // Both motions share a sample, whose acceleration is that of the next interval.
            self.time.pop();
            self.position.pop();
            self.velocity.pop();
            self.acceleration.pop();
            self.torque.pop();
            self.wrist.pop();
        }
        self.time.extend(next.time.iter().map(|time| clock::seconds(begin + nanoseconds(*time))));
        self.position.extend(&next.position);
        self.velocity.extend(&next.velocity);
        self.acceleration.extend(&next.acceleration);
        self.torque.extend(&next.torque);
        self.wrist.extend(&next.wrist);
    }

    /// Appends a rest of `pause` seconds, rounded up to whole nanoseconds. Omits a rest shorter than [`MIN_INTERVAL`].
    pub fn append_rest(&mut self, pause: f64) {
        if pause_length(pause) > 0.0 {
            self.append_rest_to(nanoseconds(self.duration() + pause_length(pause)));
        }
    }

    /// Appends a turn of the wrist to a joint value, from rest to rest, as fast as its limits (both positive) allow, while the
    /// arm rests. Does nothing if the wrist is already there, or if there is no wrist.
    pub fn append_turn(&mut self, to: f64, velocity: f64, acceleration: f64) {
        let Some(&[from, ..]) = self.wrist.last() else { return };
        let begin = nanoseconds(self.duration());
        let sign = (to - from).signum();
        let ends = single((to - from).abs(), &ToolLimits { velocity, acceleration, jerk: None });
        for (k, [time, distance, speed]) in ends.iter().enumerate() {
            let gain = ends.get(k + 1).map_or(0.0, |[end, _, later]| sign * (later - speed) / (end - time));
            let is_last = k + 1 == ends.len() && k > 0;
            let row = [if is_last { to } else { from + sign * distance }, sign * speed + 0.0, gain + 0.0];
            if k > 0 {
                self.append_rest_to(begin + nanoseconds(*time));
            } else if let Some(last) = self.acceleration.last_mut() {
                *last = [0.0; 2];
            }
            if let Some(last) = self.wrist.last_mut() {
                *last = row;
            }
        }
    }

    /// Appends a rest of at least [`MIN_INTERVAL`] that ends at the first possible whole nanosecond at or after `time`. Does
    /// nothing if the motion already ends later.
    pub fn append_rest_until(&mut self, time: f64) {
        let (end, until) = (nanoseconds(self.duration()), nanoseconds(round_up(time)));
        if end < until {
            self.append_rest_to(until.max(end + nanoseconds(MIN_INTERVAL)));
        }
    }

    fn append_rest_to(&mut self, end: u64) {
        if let Some(&position) = self.position.last() {
            self.push_rest(end, position.into());
            // At rest, torques stay those that hold the arm.
            self.torque.extend(self.torque.last().copied());
            self.wrist.extend(self.wrist.last().map(|[value, ..]| [*value, 0.0, 0.0]));
        }
    }

    /// Returns the cubics through positions and velocities.
    pub fn pieces(&self) -> Vec<Piece> {
        let end = |i: usize| [self.position[i].into(), self.velocity[i].into()];
        (1..self.time.len()).map(|i| Piece::hermite(self.time[i - 1], self.time[i], end(i - 1), end(i))).collect()
    }

    /// Returns the cubics through positions and velocities of the wrist's joint, as first components. Empty if there is no
    /// wrist.
    pub fn wrist_pieces(&self) -> Vec<Piece> {
        let end = |i: usize| [0, 1].map(|k| Configuration::new(self.wrist[i][k], 0.0));
        (1..self.wrist.len()).map(|i| Piece::hermite(self.time[i - 1], self.time[i], end(i - 1), end(i))).collect()
    }

    /// Adds a sample at rest.
    pub(super) fn push_rest(&mut self, nanoseconds: u64, q: Configuration) {
        self.push(nanoseconds, [q, Configuration::zeros(), Configuration::zeros()]);
    }

    pub(super) fn push(&mut self, nanoseconds: u64, [position, velocity, acceleration]: [Configuration; 3]) {
        // Adding 0 turns the minus zero of a joint at rest into zero.
        let row = |v: Configuration| [v[0] + 0.0, v[1] + 0.0];
        self.time.push(clock::seconds(nanoseconds));
        self.position.push([position[0], position[1]]);
        self.velocity.push(row(velocity));
        self.acceleration.push(row(acceleration));
    }
}

/// Returns the time, in whole nanoseconds, at which a motion begins after another one and a pause.
pub fn after_pause(end: f64, pause: f64) -> f64 {
    clock::seconds(nanoseconds(end + pause_length(pause)))
}

/// Returns the pause in use: rounded up to whole nanoseconds, or zero if it is too short.
fn pause_length(pause: f64) -> f64 {
    if pause < MIN_INTERVAL { 0.0 } else { whole_nanoseconds(pause) }
}

/// A motion in time, and the curve that it follows.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedMotion {
    /// The path with its blends, except those that would not make the motion faster.
    pub curve: CertifiedCurve,
    /// The motion as samples in time.
    pub trajectory: Trajectory,
}

/// Returns the fastest motion within the limits along the straight pieces and blends of a path. It begins and ends at rest, and
/// stops at every corner without a blend. Takes linear time in the number of samples.
///
/// Forward-backward integration computes the squared speed along the path: on straight pieces in closed form, and on a blend over
/// up to 256 spans. On each span, the second derivative of the path's parameter is constant, and both joints are within their
/// limits, of which a thousandth stays unused. If it is faster to stop at every corner between two stops, the motion does so.
///
/// There is a sample at each multiple of `period`, and wherever that second derivative changes. On blends, samples are so dense
/// that the cubics through positions and velocities are also within the limits, and within [`crate::BLEND_TOLERANCE`] of the
/// blend. All samples are at whole nanoseconds. A multiple of the period that is closer than a tenth of a millisecond (or half
/// the period) to another sample is omitted. A path that does not move gives one sample.
///
/// A straight piece of length `L` from rest to rest, with speed and acceleration limits `v` and `a` along it, takes
/// `2 sqrt(L / a)` if `L a <= v^2`, else `L / v + v / a`. It takes up to `4` [`MIN_INTERVAL`] longer if a phase would be shorter
/// than that, and each phase is lengthened to whole nanoseconds.
///
/// If the jerk of a joint is limited, the motion stops at every corner, blended or not ([`super::Drive::along`] passes corners
/// without a stop). A straight piece on which such a joint moves takes the least time that speed, acceleration and jerk along it
/// allow from rest to rest, with one bound on the tip's speed for the whole piece, or up to `12` [`MIN_INTERVAL`] longer if a
/// phase would be too short.
///
/// # Errors
/// [`TimingError`]: an unusable period, a motion beyond [`MAX_DURATION`], or more than [`MAX_SAMPLES`] samples.
pub fn time(curve: impl Into<CertifiedCurve>, limits: &Limits, period: f64) -> Result<TimedMotion, TimingError> {
    let curve = curve.into();
    let (used, trajectory) = time_curve(curve.curve(), limits, period)?;
    Ok(TimedMotion { curve: curve.reduced_to(used), trajectory })
}

/// Does the same as [`time`] for a curve without a certificate. Also returns the curve with only the blends in use.
pub(super) fn time_curve(
    curve: &BlendedPath,
    limits: &Limits,
    period: f64,
) -> Result<(BlendedPath, Trajectory), TimingError> {
    if !(period.is_finite() && period >= MIN_INTERVAL) {
        return Err(TimingError::Period(period));
    }
    let (used, runs) = schedule(curve, limits, &vec![1.0; curve.radii().len()], 0.0);
    let phases = || {
        let timed_tracks = runs.iter().flatten();
        timed_tracks.flat_map(|(track, phases)| phases.iter().map(move |phase| (track, phase)))
    };
    let duration = phases().map(|(_, phase)| phase.duration).fold(0.0, |sum, duration| sum + duration);
    if duration.is_nan() || duration > MAX_DURATION {
        return Err(TimingError::TooLong(duration));
    }
    let within = phases().map(|(track, phase)| 1.0 + (phase.duration / track.interval(phase, limits)).ceil());
    let samples = duration / period + within.sum::<f64>() + 1.0;
    if samples > MAX_SAMPLES as f64 {
        return Err(TimingError::TooManySamples { duration, period });
    }

    let mut trajectory = Trajectory::default();
    let end = runs.iter().fold(0, |begin, run| sample(run, begin, limits, period, &mut trajectory));
    trajectory.push_rest(end, curve.path().goal());
    trajectory.wrist.extend(limits.wrist.and_then(|wrist| Some([*wrist.values.last()?, 0.0, 0.0])));
    Ok((used, trajectory))
}

/// Appends the samples of a run from rest to rest, except the last sample. The run starts at `begin`, in nanoseconds. Returns its
/// end, in nanoseconds.
///
/// Phases start and end between nanoseconds. The sample of a phase is at the nearest nanosecond, with the motion's state at that
/// time, and the acceleration of the interval that starts there.
pub(super) fn sample(run: &[TimedTrack], begin: u64, limits: &Limits, period: f64, trajectory: &mut Trajectory) -> u64 {
    let near = nanoseconds((period / 2.0).clamp(MIN_INTERVAL, MIN_PERIODIC_INTERVAL));
    let mut since = 0.0;
    let mut before: Option<(&Track, &Phase)> = None;
    for (track, phase) in run.iter().flat_map(|(track, phases)| phases.iter().map(move |phase| (track, phase))) {
        let (first, last) = (begin + nanoseconds(since), begin + nanoseconds(since + phase.duration));
        // Seconds from the beginning of the phase.
        let into = |at: u64| clock::seconds(at - begin) - since;
        let place = |at: u64| match before {
            Some((track, phase)) if into(at) < 0.0 => (track, phase.at(phase.duration + into(at))),
            _ => (track, phase.at(into(at))),
        };
        let state = |at: u64| {
            let (track, state) = place(at);
            track.at(state)
        };
        let mut push = |at: u64, rows: [Axes; 3]| {
            trajectory.push(at, rows.map(|row| row.xy()));
            trajectory.wrist.extend(limits.wrist.map(|_| rows.map(|row| row[2] + 0.0)));
        };
        let [position, velocity, _] = state(first);
        let [.., acceleration] = track.at(phase.at(0.0));
        push(first, [position, velocity, acceleration]);
        let interval = track.interval(phase, limits);
        let mut left = first;
        let count = (clock::seconds(first) / period) as u64;
        let multiples = (count..).map(|k| nanoseconds(k as f64 * period)).skip_while(|&at| at < first + near);
        for next in multiples.take_while(|&at| at + near <= last).chain([last]) {
            let gap = (next - left) as f64;
            let parts = (gap / NANOSECONDS_PER_SECOND as f64 / interval).ceil().max(1.0);
            for part in 1..parts as u64 {
                let at = left + (gap * (part as f64 / parts)) as u64;
                push(at, state(at));
            }
            if next < last {
                push(next, state(next));
            }
            left = next;
        }
        since += phase.duration;
        before = Some((track, phase));
    }
    begin + nanoseconds(whole_nanoseconds(since))
}
