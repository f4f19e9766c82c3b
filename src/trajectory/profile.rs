//! Speed along one straight segment.

/// A rest-to-rest motion over a distance: constant acceleration, constant speed (perhaps for no time at all), constant
/// deceleration, as long as the acceleration. The fastest such motion is the time-optimal one for limits on speed and
/// acceleration (bang-bang, or bang-coast-bang where the speed limit is reached).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Profile {
    length: f64,
    acceleration: f64,
    /// Duration of the acceleration, and of the deceleration.
    ramp: f64,
    /// Duration of the constant speed between them: 0 in a triangular profile.
    cruise: f64,
}

/// Distance covered, speed and acceleration along the segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct State {
    pub(super) distance: f64,
    pub(super) speed: f64,
    pub(super) acceleration: f64,
}

/// One stretch of constant acceleration, in seconds from the segment's beginning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Phase {
    pub(super) begin: f64,
    pub(super) end: f64,
}

impl Profile {
    /// The fastest profile over `length` within the limits, none of whose phases is shorter than `shortest`.
    ///
    /// Where that floor acts, the motion is slowed down, by at most `4 shortest`: ramps are stretched to the floor at a
    /// lower acceleration, and a shorter cruise is spread over the ramps. All limits stay kept. `length`, `speed`,
    /// `acceleration` and `shortest` are positive; the limits may be infinite.
    pub(super) fn rest_to_rest(length: f64, speed: f64, acceleration: f64, shortest: f64) -> Self {
        let ramp = (speed / acceleration).max(shortest);
        let cruise = length / speed - ramp;
        if cruise >= shortest {
            return Self { length, acceleration: speed / ramp, ramp, cruise };
        }
        // Without a cruise the peak speed is length / ramp and the acceleration length / ramp^2: both limits are lower
        // bounds of the ramp.
        let ramp = (length / acceleration).sqrt().max(length / speed).max(shortest);
        Self { length, acceleration: length / ramp / ramp, ramp, cruise: 0.0 }
    }

    /// Seconds from rest to rest.
    pub(super) fn duration(&self) -> f64 {
        2.0 * self.ramp + self.cruise
    }

    /// The two or three phases, in order.
    pub(super) fn phases(&self) -> impl Iterator<Item = Phase> {
        let up = Phase { begin: 0.0, end: self.ramp };
        let level = Phase { begin: self.ramp, end: self.ramp + self.cruise };
        let down = Phase { begin: self.ramp + self.cruise, end: self.duration() };
        [Some(up), (self.cruise > 0.0).then_some(level), Some(down)].into_iter().flatten()
    }

    /// The state `time` seconds after the beginning. At the beginning of a phase the acceleration is that phase's.
    ///
    /// Each ramp is computed from its end at rest, so that both ends are exact.
    pub(super) fn at(&self, time: f64) -> State {
        let left = self.duration() - time;
        let speed = self.acceleration * self.ramp;
        if time < self.ramp {
            let distance = 0.5 * self.acceleration * time * time;
            State { distance, speed: self.acceleration * time, acceleration: self.acceleration }
        } else if time < self.ramp + self.cruise {
            State { distance: speed * (time - 0.5 * self.ramp), speed, acceleration: 0.0 }
        } else {
            let distance = self.length - 0.5 * self.acceleration * left * left;
            State { distance, speed: self.acceleration * left, acceleration: -self.acceleration }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn triangle_and_trapezoid_last_as_long_as_in_closed_form() {
        let triangle = Profile::rest_to_rest(0.5, 10.0, 2.0, 1e-6);
        assert_eq!(triangle.duration(), 2.0 * (0.5f64 / 2.0).sqrt());
        assert_eq!(triangle.phases().count(), 2);
        let trapezoid = Profile::rest_to_rest(6.0, 2.0, 4.0, 1e-6);
        assert_eq!(trapezoid.duration(), 6.0 / 2.0 + 2.0 / 4.0);
        assert_eq!(trapezoid.phases().count(), 3);
    }

    #[test]
    fn infinite_limits_leave_the_floor() {
        let both = Profile::rest_to_rest(1.0, f64::INFINITY, f64::INFINITY, 1e-6);
        assert_eq!(both.duration(), 2e-6);
        let speed_only = Profile::rest_to_rest(1.0, 2.0, f64::INFINITY, 1e-6);
        assert!((speed_only.duration() - 0.500_001).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn limits_floor_and_optimum(
            length in -18.0..6.0f64, speed in -4.0..5.0f64, acceleration in -4.0..6.0f64,
        ) {
            let [length, speed, acceleration] = [length, speed, acceleration].map(|e| 10f64.powf(e));
            let profile = Profile::rest_to_rest(length, speed, acceleration, 1e-6);
            let peak = profile.at(profile.ramp).speed;
            prop_assert!(peak <= speed * (1.0 + 1e-14));
            prop_assert!(profile.acceleration <= acceleration * (1.0 + 1e-14));
            prop_assert!(profile.phases().all(|p| p.end - p.begin >= 1e-6 * (1.0 - 1e-6) - 1e-15 * profile.duration()));
            // Area under the speed is the length.
            let covered = peak * (profile.ramp + profile.cruise);
            prop_assert!((covered - length).abs() <= 1e-12 * length, "{covered} {length}");
            let optimum = if length * acceleration <= speed * speed {
                2.0 * (length / acceleration).sqrt()
            } else {
                length / speed + speed / acceleration
            };
            prop_assert!(profile.duration() >= optimum * (1.0 - 1e-12));
            prop_assert!(profile.duration() <= optimum + 4e-6 + 1e-12 * optimum);
        }
    }
}
