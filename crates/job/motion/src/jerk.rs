//! Speed along a straight stretch with a limit on the jerk.
//!
//! A symmetric motion from rest to rest has seven phases: the acceleration grows for a time `grow`, is constant for `hold`, and
//! shrinks for `grow`; the speed is constant for `cruise`; then the same happens in reverse. Over a length `L`, this needs
//!
//! - the top speed `v = L / (2 grow + hold + cruise)`,
//! - the acceleration `a = v / (grow + hold)`,
//! - the jerk `a / grow`.
//!
//! If one of the times increases, none of these quantities does. So longer times never violate the limits.

use super::clock::whole_nanoseconds;
use super::profile::Phase;
use rsruckig::prelude::{InputParameter, Ruckig, RuckigError, ThrowErrorHandler, Trajectory};

/// A limit on speed or acceleration that has no effect. With jerk and length 1, from rest to rest, the greatest acceleration is
/// 0.79 and the greatest speed is 0.63.
const NO_LIMIT: f64 = 1.0;

/// The times of a symmetric motion from rest to rest, seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Times {
    /// Duration of each of the four phases of growing or shrinking acceleration.
    grow: f64,
    /// Duration of both phases of constant acceleration.
    hold: f64,
    /// Duration of the phase of constant speed.
    cruise: f64,
}

/// Returns the fastest motion over `length` from rest to rest with limited speed, acceleration and jerk: seven phases, or fewer
/// if a limit is not reached. No phase is shorter than `shortest`, and all last whole nanoseconds.
///
/// The least duration of phases may lengthen the motion by up to `12 shortest`, and rounding by up to seven nanoseconds. All
/// limits are satisfied. `length`, `speed`, `acceleration`, `jerk` and `shortest` are positive; `speed` and `acceleration` may be
/// infinite.
///
/// The times are from Ruckig (Berscheid, Kröger, *Jerk-limited real-time trajectory generation with arbitrary target states*,
/// 2021). Length and jerk are its units, because its tolerances are absolute. If the limits differ by about twelve orders of
/// magnitude, Ruckig finds no solution; the motion then has neither constant speed nor constant acceleration, and may be slower
/// than necessary.
pub(super) fn rest_to_rest(length: f64, speed: f64, acceleration: f64, jerk: f64, shortest: f64) -> Vec<Phase> {
    // The least duration limits the jerk anyway: there is no gain in reaching the acceleration limit sooner.
    let jerk = jerk.min(acceleration.min(speed / shortest).min(length / shortest / shortest) / shortest);
    let unit = (length / jerk).cbrt();
    let limits = [speed * unit / length, acceleration * unit * unit / length];
    let times = match fastest(limits.map(|limit| limit.min(NO_LIMIT))) {
        Ok(times) => Times { grow: times.grow * unit, hold: times.hold * unit, cruise: times.cruise * unit },
        Err(_) => {
            let grow = (length / jerk / 2.0).cbrt().max((length / acceleration / 2.0).sqrt()).max(length / speed / 2.0);
            Times { grow, hold: 0.0, cruise: 0.0 }
        }
    };
    times.with_floor(shortest).lengthened_to_limits(length, [speed, acceleration, jerk]).rounded_up().phases(length)
}

/// Returns the fastest motion over the length 1 with the jerk 1 and these limits on speed and acceleration.
fn fastest([speed, acceleration]: [f64; 2]) -> Result<Times, RuckigError> {
    let mut input = InputParameter::<1>::new(None);
    input.target_position[0] = 1.0;
    input.max_velocity[0] = speed;
    input.max_acceleration[0] = acceleration;
    input.max_jerk[0] = 1.0;
    let mut found = Trajectory::new(None);
    // The cycle time matters only for discrete durations.
    Ruckig::<1, ThrowErrorHandler>::new(None, 1.0).calculate(&input, &mut found)?;
    let profile = &found.get_profiles()[0][0];
    let [grow, hold] = [profile.t[0], profile.t[1]];
    // Ruckig may report the end of one growth and the beginning of the next as one phase.
    Ok(Times { grow, hold, cruise: (found.get_duration() - 4.0 * grow - 2.0 * hold).max(0.0) })
}

impl Times {
    /// Lengthens phases that are not empty to at least `shortest` seconds.
    fn with_floor(self, shortest: f64) -> Self {
        let Self { mut grow, mut hold, mut cruise } = self;
        if hold < shortest {
            (grow, hold) = (grow + hold, 0.0);
        }
        if cruise < shortest {
            (grow, cruise) = (grow + cruise / 2.0, 0.0);
        }
        Self { grow: grow.max(shortest), hold, cruise }
    }

    /// Returns top speed, greatest acceleration and jerk over a length.
    fn rates(&self, length: f64) -> [f64; 3] {
        let speed = length / (2.0 * self.grow + self.hold + self.cruise);
        let acceleration = speed / (self.grow + self.hold);
        [speed, acceleration, acceleration / self.grow]
    }

    /// Lengthens all times so that rates that exceed their limits by rounding errors are within them.
    fn lengthened_to_limits(self, length: f64, limits: [f64; 3]) -> Self {
        let [speed, acceleration, jerk] = [0, 1, 2].map(|i| self.rates(length)[i] / limits[i]);
        let longer = speed.max(acceleration.sqrt()).max(jerk.cbrt()).max(1.0);
        Self { grow: self.grow * longer, hold: self.hold * longer, cruise: self.cruise * longer }
    }

    /// Lengthens every duration to whole nanoseconds.
    fn rounded_up(self) -> Self {
        let Self { grow, hold, cruise } = self;
        Self { grow: whole_nanoseconds(grow), hold: whole_nanoseconds(hold), cruise: whole_nanoseconds(cruise) }
    }

    /// Returns the phases over a length.
    fn phases(&self, length: f64) -> Vec<Phase> {
        let &Self { grow, hold, cruise } = self;
        let [peak, _, jerk] = self.rates(length);
        // So rounded, the acceleration ends at exactly 0.
        let acceleration = jerk * grow;
        let (mut from, mut enter) = (0.0, 0.0);
        let ramp = [(grow, 0.0, jerk), (hold, acceleration, 0.0), (grow, acceleration, -jerk)];
        let up = ramp.map(|(duration, acceleration, jerk)| {
            let to = from + duration * (enter + duration * (0.5 * acceleration + duration * jerk / 6.0));
            let leave = enter + duration * (acceleration + 0.5 * jerk * duration);
            let phase = Phase { duration, from, to, enter, leave, acceleration, jerk };
            (from, enter) = (to, leave);
            phase
        });
        let level =
            Phase { duration: cruise, from, to: length - from, enter: peak, leave: peak, acceleration: 0.0, jerk: 0.0 };
        // In reverse, only the second derivative changes its sign.
        let down = up.into_iter().rev().map(|phase| Phase {
            from: length - phase.to,
            to: length - phase.from,
            enter: phase.leave,
            leave: phase.enter,
            acceleration: -(phase.acceleration + phase.jerk * phase.duration),
            ..phase
        });
        up.into_iter().chain([level]).chain(down).filter(|phase| phase.duration > 0.0).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SHORTEST: f64 = 1e-6;

    fn duration(phases: &[Phase]) -> f64 {
        phases.iter().map(|phase| phase.duration).sum()
    }

    #[test]
    fn times_too_short_for_the_limits_are_lengthened() {
        let times = Times { grow: 1.0, hold: 2.0, cruise: 0.5 };
        assert_eq!(times.lengthened_to_limits(9.0, times.rates(9.0)), times);
        // Scales all times until the limit with the greatest excess is reached.
        let [speed, acceleration, jerk] = times.rates(9.0);
        for (limits, longer) in [
            ([speed / 3.0, acceleration, jerk], 3.0),
            ([speed, acceleration / 4.0, jerk / 1.5], 2.0),
            ([speed, acceleration, jerk / 8.0], 2.0),
        ] {
            let slower = times.lengthened_to_limits(9.0, limits);
            assert!((slower.grow - longer).abs() < 1e-15 && (slower.cruise - longer / 2.0).abs() < 1e-15);
            let rates = slower.rates(9.0);
            assert!((0..3).all(|i| rates[i] <= limits[i] * (1.0 + 1e-15)), "{rates:?} {limits:?}");
        }
    }

    #[test]
    fn infinite_limits_leave_the_floor_and_the_jerk() {
        let free = rest_to_rest(2.0, f64::INFINITY, f64::INFINITY, 1.0, SHORTEST);
        assert!((duration(&free) - 4.0).abs() < 1e-8);
        let sudden = rest_to_rest(2.0, f64::INFINITY, 8.0, f64::MAX, SHORTEST);
        assert!((duration(&sudden) - 1.0).abs() < 12.0 * SHORTEST);
    }

    #[test]
    fn limits_of_very_different_size_are_satisfied() {
        assert!(fastest([1e-13, 1.0]).is_err());
        let (length, speed) = (1e6, 1e-9);
        let phases = rest_to_rest(length, speed, 1.0, 1e6, SHORTEST);
        joined(&phases, length, [speed, 1.0, 1e6]);
        assert_eq!(phases.len(), 4);
    }

    /// Asserts that the phases form a motion from rest to rest within the limits. Consecutive phases must agree except in the
    /// jerk, and have the expected durations.
    fn joined(phases: &[Phase], length: f64, [speed, acceleration, jerk]: [f64; 3]) {
        let same = |a: f64, b: f64, size: f64| assert!((a - b).abs() <= 1e-12 * size, "{a} {b} {phases:?}");
        let (first, last) = (phases[0], phases[phases.len() - 1]);
        let ends = [first.from, first.enter, first.acceleration, last.at(last.duration).acceleration];
        assert_eq!((ends, last.to, last.leave), ([0.0; 4], length, 0.0));
        let top = phases.iter().map(|p| p.enter).fold(0.0, f64::max);
        let strongest = phases.iter().map(|p| p.acceleration.abs()).fold(0.0, f64::max);
        for pair in phases.windows(2) {
            let (before, after) = (pair[0].at(pair[0].duration), pair[1].at(0.0));
            same(before.distance, after.distance, length);
            same(before.speed, after.speed, top);
            same(before.acceleration, after.acceleration, strongest);
        }
        for phase in phases {
            assert!(phase.duration >= SHORTEST && phase.jerk.abs() <= jerk * (1.0 + 1e-14));
            assert!(phase.enter.max(phase.leave) <= speed * (1.0 + 1e-14));
            assert!(phase.acceleration.abs() <= acceleration * (1.0 + 1e-14));
            // By both formulas.
            let (begin, end) = (phase.at(0.0), phase.at(phase.duration));
            same(begin.distance, phase.from, length);
            same(end.distance, phase.to, length);
            same(begin.speed, phase.enter, top);
            same(end.speed, phase.leave, top);
        }
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Checks limits and lengths of arms and far beyond. `tests/motion` checks the durations.
        #[test]
        fn phases_join_and_keep_the_limits(
            length in -15.0..4.0f64, speed in -4.0..4.0f64, acceleration in -4.0..6.0f64, jerk in -4.0..12.0f64,
        ) {
            let [length, speed, acceleration, jerk] = [length, speed, acceleration, jerk].map(|e| 10f64.powf(e));
            joined(&rest_to_rest(length, speed, acceleration, jerk, SHORTEST), length, [speed, acceleration, jerk]);
        }
    }
}
