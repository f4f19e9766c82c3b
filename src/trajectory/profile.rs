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

/// One stretch of constant acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Phase {
    kind: Kind,
    /// Seconds from the segment's beginning.
    pub(super) begin: f64,
    /// Seconds.
    pub(super) duration: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Up,
    Level,
    Down,
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
        let up = Phase { kind: Kind::Up, begin: 0.0, duration: self.ramp };
        let level = Phase { kind: Kind::Level, begin: self.ramp, duration: self.cruise };
        let down = Phase { kind: Kind::Down, begin: self.ramp + self.cruise, duration: self.ramp };
        [Some(up), (self.cruise > 0.0).then_some(level), Some(down)].into_iter().flatten()
    }

    /// The state `time` seconds after the beginning of `phase`.
    ///
    /// Counted from there, and not from the segment's beginning, because a short ramp after a long cruise would drown
    /// in the rounding of the latter.
    pub(super) fn at(&self, phase: Phase, time: f64) -> State {
        let peak = self.acceleration * self.ramp;
        match phase.kind {
            Kind::Up => State {
                distance: 0.5 * self.acceleration * time * time,
                speed: self.acceleration * time,
                acceleration: self.acceleration,
            },
            Kind::Level => State { distance: peak * (0.5 * self.ramp + time), speed: peak, acceleration: 0.0 },
            Kind::Down => {
                let left = self.ramp - time;
                State {
                    distance: self.length - 0.5 * self.acceleration * left * left,
                    speed: self.acceleration * left,
                    acceleration: -self.acceleration,
                }
            }
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
            let down = profile.phases().last().expect("two at least");
            let peak = profile.at(down, 0.0).speed;
            prop_assert!(peak <= speed * (1.0 + 1e-14));
            prop_assert!(profile.acceleration <= acceleration * (1.0 + 1e-14));
            prop_assert!(profile.phases().all(|p| p.duration >= 1e-6));
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
