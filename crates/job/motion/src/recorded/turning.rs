//! Turns of a payload by a wrist while the arm moves.
//!
//! During a span of time, the payload turns from one angle to another while the tip carries it along. Its *cover* is a convex
//! shape around all its orientations between both angles. A span is free if the cover is free all along it. Spans that are not
//! proven free are halved, so that covers become smaller. Nothing is sampled.

use super::arch::{MIN_GAP, times_between};
use super::collision::proven_clearance;
use super::cover::cover;
use super::encounter::{CollisionCheck, Encounter, Moment, Touch};
use crate::{phase_at, single};
use cplan_geometry::{Point, Pose};
use cplan_handling::{Derivative, Recording, Wrist};
use cplan_interrupt::checkpoint;
use cplan_judge::Posture;
use cplan_model::{Arm, AttachedPart, Contact, Grip, Scene};

/// Spans with less than this angle, in radians, are not halved. Their covers hardly differ from the payload.
const MIN_ANGLE: f64 = 1e-4;

/// Limits of a quick search: greatest number of spans, and greatest number of checks of pairs in each. They take a few
/// milliseconds.
const TRIAL: Effort = Effort { spans: 48, evaluations: 1_000 };

/// Limits of a search for a proof.
const PROOF: Effort = Effort { spans: 4_096, evaluations: 50_000 };

/// Number of times that a desired clearance is halved if it is not proven. After that, only the required clearance is tried.
const CLEARANCE_HALVINGS: u8 = 3;

/// Number of times that a span is halved to bound the speed of the wrist.
const LIMIT_HALVINGS: u8 = 5;

/// Tolerated excess over a limit, as a share of it; the same as for the arm's own joints.
const LIMIT_TOLERANCE: f64 = 1e-6;

/// Limits of a search.
#[derive(Clone, Copy)]
struct Effort {
    spans: usize,
    evaluations: usize,
}

/// A level payload, at the heights at which it is carried, with the obstacles that it may meet.
#[derive(Debug, Clone)]
pub struct TurnCover {
    /// The scene of the motion, without the arm's own shapes.
    scene: Scene,
    /// The payload's shapes relative to the tip, at the angle 0.
    parts: Vec<AttachedPart>,
}

impl TurnCover {
    /// Creates the covers of a scene's payload. `None` if it has no level payload.
    pub fn new(scene: &Scene) -> Option<Self> {
        let attachment = scene.attachment()?;
        let Grip::Level { point, .. } = attachment.grip else { return None };
        let about = Pose::translation(-point);
        let moved = |part: &AttachedPart| AttachedPart { shape: part.shape.at(&about), ..part.clone() };
        let parts = attachment.parts.iter().map(moved).collect();
        let scene = scene.changed(|arm, _| arm.links.iter_mut().for_each(|link| link.parts.clear()));
        Some(Self { scene, parts })
    }

    /// Returns the scene with the payload in all orientations from one angle to another, in radians, at once. Exact if both are
    /// the same.
    fn between(&self, angles: [f64; 2]) -> Scene {
        let covering = |part: &AttachedPart| AttachedPart { shape: cover(&part.shape, angles), ..part.clone() };
        self.scene.with_attachment(|attachment| {
            attachment.parts = self.parts.iter().map(covering).collect();
            attachment.grip = Grip::Level { angle: 0.0, point: Point::zeros() };
        })
    }

    /// Returns true if no obstacle is at the height of the payload.
    fn is_empty(&self) -> bool {
        self.scene.pairs().is_empty()
    }
}

/// Returns the motion of a wrist that turns by `distance` radians in `seconds`: its fastest motion, stretched evenly in time.
/// Each entry is an end of a phase of constant jerk: seconds since the beginning, angle so far, and speed.
pub fn turn_profile(wrist: &Wrist, distance: f64, seconds: f64) -> Vec<[f64; 3]> {
    let fastest = single(distance, &wrist.limits());
    let least = fastest.last().map_or(0.0, |[end, ..]| *end);
    if least <= 0.0 || seconds == least {
        return fastest;
    }
    let stretch = seconds / least;
    fastest.into_iter().map(|[time, angle, speed]| [time * stretch, angle, speed / stretch]).collect()
}

/// A turn of the payload that begins or ends during a motion of the arm. Before and after the turn, the payload has the
/// orientations `ends`.
#[derive(Debug, Clone)]
pub struct TurnDuringMotion<'a> {
    /// The payload and its obstacles.
    pub cover: &'a TurnCover,
    /// Limits of the wrist.
    pub wrist: Wrist,
    /// The payload's orientations at both ends, radians, without wrapping.
    pub ends: [f64; 2],
    /// Duration, seconds: see [`turn_profile`].
    pub seconds: f64,
    /// Time at which the turn begins, on the clock of the motion, seconds.
    pub begin: f64,
    /// True for a turn before a place: the payload keeps its final orientation until the end of the motion. False for a turn
    /// after a pick: it has its first orientation from the beginning of the motion.
    pub is_before_place: bool,
}

impl TurnDuringMotion<'_> {
    fn profile(&self) -> Vec<[f64; 3]> {
        turn_profile(&self.wrist, (self.ends[1] - self.ends[0]).abs(), self.seconds)
    }

    /// Returns the payload's orientation at a time, radians.
    pub fn angle(&self, time: f64) -> f64 {
        turn_angle(&self.profile(), self.ends, time - self.begin)
    }

    /// Returns the span of a motion in which the turn changes the payload's orientation from that in the rest of the motion.
    /// `None` if there is none.
    fn window(&self, motion: &Recording) -> Option<[f64; 2]> {
        let times = motion.times()?;
        let [first, last] = [times[0], times[times.len() - 1]];
        let window = match self.is_before_place {
            true => [self.begin.max(first), last],
            false => [first, (self.begin + self.seconds).min(last)],
        };
        (window[1] - window[0] >= MIN_GAP).then_some(window)
    }

    /// Returns the first spans to examine: before, during and after the turn.
    fn spans(&self, [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
        let ends = [self.begin, self.begin + self.seconds];
        let mut times = vec![from];
        times.extend(ends.into_iter().filter(|time| from + MIN_GAP < *time && *time < to - MIN_GAP));
        times.push(to);
        times.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }

    /// Returns a proven lower bound, positive and at least `clearance` metres, on the payload's distance from obstacles.
    /// Otherwise returns a span that is not proven free as the error.
    fn proven(&self, motion: &Recording, clearance: f64, effort: Effort) -> Result<f64, [f64; 2]> {
        let (Some(window), Some(times)) = (self.window(motion), motion.times()) else { return Ok(f64::INFINITY) };
        if self.cover.is_empty() {
            return Ok(f64::INFINITY);
        }
        let profile = self.profile();
        let mut stack = self.spans(window);
        stack.reverse();
        let (mut least, mut examined) = (f64::INFINITY, 0);
        while let Some([from, to]) = stack.pop() {
            checkpoint();
            examined += 1;
            let angles = [from, to].map(|time| turn_angle(&profile, self.ends, time - self.begin));
            let part = motion.resampled(&times_between(times.iter(), [from, to]));
            let scene = self.cover.between(angles);
            if let Some(proven) = proven_clearance(&scene, &part, clearance, effort.evaluations) {
                least = least.min(proven);
                continue;
            }
            let middle = (from + to) / 2.0;
            let is_narrow = (angles[1] - angles[0]).abs() < MIN_ANGLE || to - from < 4.0 * MIN_GAP;
            if is_narrow || examined + stack.len() >= effort.spans {
                return Err([from, to]);
            }
            stack.extend([[middle, to], [from, middle]]);
        }
        Ok(least)
    }

    /// Returns true if a quick search proves that the payload keeps at least `clearance` metres while its orientation differs
    /// from that in the rest of the motion.
    pub fn keeps(&self, motion: &Recording, clearance: f64) -> bool {
        self.proven(motion, clearance, TRIAL).is_ok()
    }

    /// Returns a proven lower bound, metres, on the payload's distance from obstacles in the same part of the motion. It is at
    /// least `clearance`, and up to `sought` if that can be proven. `None` if the motion is not proven free.
    pub fn clearance(&self, motion: &Recording, clearance: f64, sought: f64) -> Option<f64> {
        let mut sought = sought;
        for _ in 0..=CLEARANCE_HALVINGS {
            if sought.is_finite()
                && sought > clearance
                && let Ok(proven) = self.proven(motion, sought, TRIAL)
            {
                return Some(proven);
            }
            sought /= 2.0;
        }
        self.proven(motion, clearance, PROOF).ok()
    }

    /// Checks the same part of the motion. Returns the result, and the scene to which its pairs belong. Reports a collision if
    /// the payload touches an obstacle at an end or in the middle of a span that is not proven free.
    pub fn check(&self, motion: &Recording, clearance: f64, sought: f64) -> (Scene, CollisionCheck) {
        if let Some(clearance) = self.clearance(motion, clearance, sought) {
            return (self.cover.scene.clone(), CollisionCheck::Free { clearance, nearest: None });
        }
        let span = self.proven(motion, clearance, PROOF).err().or(self.window(motion)).unwrap_or([self.begin; 2]);
        let times = [span[0], (span[0] + span[1]) / 2.0, span[1]];
        let found = times.map(|time| {
            let (scene, at) = (self.cover.between([self.angle(time); 2]), motion.resampled(&[time]).positions()[0]);
            let sample = motion.times().map_or(0, |times| times.partition_point(|at| *at <= time).saturating_sub(1));
            let pair = scene.pairs()[0];
            let posture = Posture::new(&scene, at);
            let all = scene.pairs().iter().map(|pair| Contact { pair: *pair, separation: posture.separation(*pair) });
            let nearer = |a: Contact, b: Contact| if b.separation.distance < a.separation.distance { b } else { a };
            let contact = all.fold(Contact { pair, separation: posture.separation(pair) }, nearer);
            (scene, Encounter { moment: Moment { time, sample, at }, contact })
        });
        let distance = |(_, encounter): &(Scene, Encounter)| encounter.contact.separation.distance;
        let nearer = |a, b| if distance(&b) < distance(&a) { b } else { a };
        let [first, middle, last] = found;
        let (scene, first) = nearer(nearer(first, middle), last);
        let apart = first.contact.separation.distance;
        if apart <= 0.0 || apart < clearance {
            let touch = if apart <= 0.0 { Touch::Proven } else { Touch::Undecided };
            return (scene, CollisionCheck::Collision { first, free_until: span[0], deepest: first, touch });
        }
        (scene, CollisionCheck::Undecided(first))
    }

    /// Returns true if the wrist is proven to keep its limits in the part of the turn during the motion, in which it also
    /// compensates the rotation of link 2. Speeds and accelerations of both rotations add up.
    pub fn keeps_limits(&self, arm: &Arm, motion: &Recording) -> bool {
        let weights = arm.joints.each_ref().map(|joint| joint.joint_type.turn());
        let sign = (self.ends[1] - self.ends[0]).signum();
        let profile = self.profile();
        let [velocity, acceleration] =
            [self.wrist.velocity, self.wrist.acceleration].map(|limit| limit * (1.0 + LIMIT_TOLERANCE));
        let is_within = |low: f64, high: f64, limit: f64| -limit <= low && high <= limit;
        motion.pieces().iter().all(|piece| {
            profile.windows(2).all(|phase| {
                let [begin, end] = [phase[0], phase[1]].map(|[time, ..]| time + self.begin);
                let span = [begin.max(piece.from), end.min(piece.to)];
                if span[1] <= span[0] || end <= begin {
                    return true;
                }
                // Within a phase, speed and acceleration are monotone.
                let rates = |time: f64| {
                    let [_, speed, acceleration] = phase_at([phase[0], phase[1]], time - self.begin);
                    [sign * speed, sign * acceleration]
                };
                let mut stack = vec![(span, LIMIT_HALVINGS)];
                while let Some(([from, to], halvings)) = stack.pop() {
                    let shares = [from, to].map(|time| ((time - piece.from) / (piece.to - piece.from)).clamp(0.0, 1.0));
                    let [low, high] = piece.bounds_of_sum(Derivative::Velocity, weights, shares);
                    let [[a, c], [b, d]] = [rates(from), rates(to)];
                    let of_rate = is_within(a.min(b) - high, a.max(b) - low, velocity);
                    let [low, high] = piece.bounds_of_sum(Derivative::Acceleration, weights, shares);
                    let of_acceleration = is_within(c.min(d) - high, c.max(d) - low, acceleration);
                    if of_rate && of_acceleration {
                        continue;
                    }
                    if halvings == 0 {
                        return false;
                    }
                    let middle = (from + to) / 2.0;
                    stack.extend([([from, middle], halvings - 1), ([middle, to], halvings - 1)]);
                }
                true
            })
        })
    }
}

/// Returns the angle of a turn with this profile at a time after its beginning, in radians and seconds.
pub fn turn_angle(profile: &[[f64; 3]], [from, to]: [f64; 2], since: f64) -> f64 {
    if since <= 0.0 {
        return from;
    }
    let Some(phase) = profile.windows(2).find(|phase| since < phase[1][0]) else { return to };
    let [angle, ..] = phase_at([phase[0], phase[1]], since);
    from + (to - from).signum() * angle
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Compares the profile with the integral of its speeds, and checks both limits.
        #[test]
        fn a_stretched_turn_covers_its_angle(
            distance in 0.01..6.0_f64, velocity in 0.5..9.0_f64, acceleration in 1.0..90.0_f64,
            jerk in proptest::option::of(5.0..2000.0_f64), stretch in 1.0..3.0_f64,
        ) {
            let wrist = Wrist { velocity, acceleration, jerk, turns_on_the_way: true, joint: None };
            let least = single(distance, &wrist.limits()).last().unwrap()[0];
            let profile = turn_profile(&wrist, distance, least * stretch);
            let mut area = 0.0;
            for w in profile.windows(2) {
                let [begin, end] = [w[0][0], w[1][0]];
                let speeds = (0..=64).map(|k| phase_at([w[0], w[1]], begin + (end - begin) * f64::from(k) / 64.0)[1]);
                let speeds: Vec<f64> = speeds.collect();
                let step = (end - begin) / 64.0;
                area += speeds.windows(2).map(|pair| step * (pair[0] + pair[1]) / 2.0).sum::<f64>();
                prop_assert!(speeds.iter().all(|speed| *speed <= velocity * (1.0 + 1e-6)), "{speeds:?}");
                let [a, b] = [begin, end].map(|time| phase_at([w[0], w[1]], time)[2]);
                prop_assert!(a.abs().max(b.abs()) <= acceleration * (1.0 + 1e-5) + 1e-6, "{a} {b}");
                let most = jerk.map_or(f64::INFINITY, |jerk| jerk * (end - begin) * (1.0 + 1e-5));
                prop_assert!((b - a).abs() <= most + 1e-6, "{a} {b}");
            }
            prop_assert!((area - distance).abs() < 1e-3 * distance, "{area} {distance}");
            let [from, to] = [1.0, 1.0 - distance];
            prop_assert_eq!(turn_angle(&profile, [from, to], 0.0), from);
            prop_assert_eq!(turn_angle(&profile, [from, to], least * stretch + 1.0), to);
            let middle = turn_angle(&profile, [from, to], least * stretch / 2.0);
            prop_assert!((middle - (from + to) / 2.0).abs() < 1e-6, "{middle}");
        }
    }
}
