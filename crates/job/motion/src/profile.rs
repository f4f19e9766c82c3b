//! Speed along one straight stretch.

use super::clock::whole_nanoseconds;

/// A phase of constant jerk along a stretch. In most phases, the jerk is 0. Distances are from the beginning of the stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Phase {
    /// Duration, seconds.
    pub(super) duration: f64,
    /// Distance at which the phase begins.
    pub(super) from: f64,
    /// Distance at which the phase ends.
    pub(super) to: f64,
    /// Speed at the beginning of the phase.
    pub(super) enter: f64,
    /// Speed at the end of the phase.
    pub(super) leave: f64,
    /// Acceleration at the beginning of the phase.
    pub(super) acceleration: f64,
    /// Jerk, constant during the phase.
    pub(super) jerk: f64,
}

/// Distance covered, speed and acceleration along a stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct State {
    pub(super) distance: f64,
    pub(super) speed: f64,
    pub(super) acceleration: f64,
}

impl Phase {
    /// Creates a phase between two distances and two speeds.
    pub(super) fn between([from, to]: [f64; 2], [enter, leave]: [f64; 2]) -> Self {
        let duration = 2.0 * (to - from) / (enter + leave);
        Self { duration, from, to, enter, leave, acceleration: (leave - enter) / duration, jerk: 0.0 }
    }

    /// Returns the state `time` seconds after the phase began.
    ///
    /// A deceleration is computed backwards from its end. Otherwise, a short deceleration after a long distance at top speed
    /// would be inaccurate.
    pub(super) fn at(&self, time: f64) -> State {
        let Self { duration, from, to, enter, leave, acceleration, jerk } = *self;
        let last = acceleration + jerk * duration;
        // Returns the state some time after or before another one.
        let after = |distance: f64, speed: f64, acceleration: f64, time: f64| State {
            distance: distance + time * (speed + time * (0.5 * acceleration + time * jerk / 6.0)),
            speed: speed + time * (acceleration + 0.5 * jerk * time),
            acceleration: acceleration + jerk * time,
        };
        if acceleration + last < 0.0 {
            after(to, leave, last, time - duration)
        } else {
            after(from, enter, acceleration, time)
        }
    }
}

/// Returns the fastest motion over `length` from rest to rest. It has phases of constant acceleration, of constant speed
/// (possibly empty), and of constant deceleration, which lasts as long as the acceleration. No phase is shorter than `shortest`,
/// and all last whole nanoseconds.
///
/// The least duration of phases may lengthen the motion by up to `4 shortest`. Ramps are stretched by a lower acceleration, and a
/// cruise that is too short is spread over the ramps. Phases are stretched to whole nanoseconds in the same way. All limits are
/// satisfied. `length`, `speed`, `acceleration` and `shortest` are positive; the limits may be infinite.
pub(super) fn rest_to_rest(length: f64, speed: f64, acceleration: f64, shortest: f64) -> Vec<Phase> {
    let ramp = whole_nanoseconds((speed / acceleration).max(shortest));
    let cruise = length / speed - ramp;
    let (ramp, cruise, acceleration) = if cruise >= shortest {
        let cruise = whole_nanoseconds(cruise);
        (ramp, cruise, length / (ramp + cruise) / ramp)
    } else {
        // Without a cruise, the peak speed is length / ramp, and the acceleration is length / ramp^2. Both limits are thus lower
        // bounds on the ramp.
        let ramp = whole_nanoseconds((length / acceleration).sqrt().max(length / speed).max(shortest));
        (ramp, 0.0, length / ramp / ramp)
    };
    let peak = acceleration * ramp;
    let covered = 0.5 * acceleration * ramp * ramp;
    let up = Phase { duration: ramp, from: 0.0, to: covered, enter: 0.0, leave: peak, acceleration, jerk: 0.0 };
    let down = Phase { from: length - covered, to: length, enter: peak, leave: 0.0, acceleration: -acceleration, ..up };
    let level = Phase {
        duration: cruise,
        from: covered,
        to: down.from,
        enter: peak,
        leave: peak,
        acceleration: 0.0,
        jerk: 0.0,
    };
    if cruise > 0.0 { vec![up, level, down] } else { vec![up, down] }
}

/// Returns the fastest motion over `length` between two speeds, within the limits `speed` and `acceleration`. The two speeds must
/// not both be 0, and the acceleration must allow the change from one to the other over this length. Between acceleration and
/// deceleration, the motion coasts for `coast` seconds, or as long as the two speeds allow. Returns `None` if even a single phase
/// would be shorter than `shortest`.
///
/// If a phase would be too short, it is omitted, and the greater of the two speeds is not exceeded. This costs at most the speed
/// that `shortest` seconds could gain.
pub(super) fn passing(
    length: f64,
    [enter, leave]: [f64; 2],
    speed: f64,
    acceleration: f64,
    shortest: f64,
    coast: f64,
) -> Option<Vec<Phase>> {
    let ramp = |slow: f64, fast: f64| (fast - slow).max(0.0) * ((fast + slow) / (2.0 * acceleration));
    let over = |peak: f64| {
        let (up, down) = (ramp(enter, peak), ramp(leave, peak));
        let level = (length - up - down) / peak;
        // A constant phase that is too short, or due to rounding, is spread over the ramps.
        let gentle = if level < shortest { ((up + down) / length).min(1.0) } else { 1.0 };
        let meet = (up / gentle).min(length);
        let rest = if level < shortest { meet } else { length - down };
        // Speeds determine the phase, because short distances after a long one are inaccurate.
        let phase = |[from, to]: [f64; 2], [enter, leave]: [f64; 2], acceleration: f64| {
            let duration = ((leave - enter) / acceleration).max(0.0);
            Phase { duration, from, to, enter, leave, acceleration, jerk: 0.0 }
        };
        let middle = Phase { duration: (rest - meet) / peak, acceleration: 0.0, ..phase([meet, rest], [peak; 2], 1.0) };
        let first = phase([0.0, meet], [enter, peak], acceleration * gentle);
        let last = phase([rest, length], [peak, leave], -acceleration * gentle);
        [first, middle, last].into_iter().filter(|phase| phase.duration > 0.0).collect::<Vec<_>>()
    };
    let single = || {
        let phase = Phase::between([0.0, length], [enter, leave]);
        vec![Phase { acceleration: phase.acceleration.clamp(-acceleration, acceleration), ..phase }]
    };
    let meeting = (acceleration * length + (enter * enter + leave * leave) / 2.0).sqrt();
    // Ramps and coasting together have the length of the stretch: a quadratic equation for the speed.
    let half = acceleration * coast / 2.0;
    let coasting = if half > 0.0 { half.hypot(meeting) - half } else { meeting };
    let highest = speed.min(coasting.max(enter).max(leave));
    let lasts = |phases: &Vec<Phase>| !phases.is_empty() && phases.iter().all(|phase| phase.duration >= shortest);
    [over(highest), over(enter.max(leave))].into_iter().find(lasts).or_else(|| Some(single()).filter(lasts))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn duration(phases: &[Phase]) -> f64 {
        phases.iter().map(|phase| phase.duration).sum()
    }

    #[test]
    fn infinite_limits_leave_the_floor() {
        assert_eq!(duration(&rest_to_rest(1.0, f64::INFINITY, f64::INFINITY, 1e-6)), 2e-6);
        let speed_only = rest_to_rest(1.0, 2.0, f64::INFINITY, 1e-6);
        assert!((duration(&speed_only) - 0.500_001).abs() < 1e-12);
    }

    /// Asserts that consecutive phases agree, and that within each phase both formulas do.
    fn joined(phases: &[Phase], length: f64, [enter, leave]: [f64; 2]) {
        let top = phases.iter().map(|p| p.enter.max(p.leave)).fold(0.0, f64::max);
        let same = |a: f64, b: f64, size: f64| assert!((a - b).abs() <= 1e-12 * size, "{a} {b} {phases:?}");
        let (first, last) = (phases[0], phases[phases.len() - 1]);
        assert_eq!([first.from, first.enter, last.to, last.leave], [0.0, enter, length, leave]);
        for pair in phases.windows(2) {
            same(pair[0].to, pair[1].from, length);
            same(pair[0].leave, pair[1].enter, top);
        }
        for phase in phases {
            same(phase.leave - phase.enter, phase.acceleration * phase.duration, top);
            same(phase.to - phase.from, (phase.enter + phase.leave) / 2.0 * phase.duration, length);
            for (time, distance, speed) in [(0.0, phase.from, phase.enter), (phase.duration, phase.to, phase.leave)] {
                same(phase.at(time).distance, distance, length);
                same(phase.at(time).speed, speed, top);
            }
        }
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Compares the motion with a closed form for the distance, and with the limits on the ramps to and from the peak.
        #[test]
        fn passing_speeds_are_as_fast_as_the_limits_allow(
            length in -4.0..3.0f64, acceleration in -1.0..3.0f64, at in (0.0..1.0f64, 0.0..1.0f64), top in 0.05..3.0f64,
        ) {
            let [length, acceleration] = [length, acceleration].map(|e| 10f64.powf(e));
            // Speeds that the length allows, as shares of the one reachable from rest.
            let most = (2.0 * acceleration * length).sqrt();
            let enter = at.0 * most;
            let leave = (enter * enter + (2.0 * at.1 - 1.0) * most * most).max(0.0).sqrt();
            let speed = enter.max(leave).max(top * most);
            prop_assume!(enter + leave > 1e-3 * most);
            let phases = passing(length, [enter, leave], speed, acceleration, 1e-6, 0.0).expect("long enough");
            joined(&phases, length, [enter, leave]);
            for phase in &phases {
                prop_assert!(phase.enter.max(phase.leave) <= speed * (1.0 + 1e-12));
                prop_assert!(phase.acceleration.abs() <= acceleration * (1.0 + 1e-9), "{phase:?}");
                prop_assert!(phase.duration >= 1e-6);
            }
            let meeting = ((enter * enter + leave * leave) / 2.0 + acceleration * length).sqrt();
            let optimum = if meeting <= speed {
                (2.0 * meeting - enter - leave) / acceleration
            } else {
                let ramps = (2.0 * speed * speed - enter * enter - leave * leave) / (2.0 * acceleration);
                (2.0 * speed - enter - leave) / acceleration + (length - ramps) / speed
            };
            let took = duration(&phases);
            prop_assert!(took >= optimum * (1.0 - 1e-9), "{took} {optimum}");
            prop_assert!(took <= optimum * (1.0 + 1e-9) + 1e-5 + 1e-6 * acceleration / enter.max(leave) * took);
        }
    }
}
