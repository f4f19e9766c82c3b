//! Interpolation of a motion between its samples.

/// Interpolation that the consumer of a file applies between samples.
///
/// | format | consumer | between samples |
/// |---|---|---|
/// | ROS 2 `JointTrajectory` (YAML, JSON, MCAP) | `joint_trajectory_controller`, interpolation method `splines` | with velocities and accelerations quintic, with velocities cubic, else linear |
/// | ROS 2 `JointState` (MCAP) | measured values; no controller follows them | with velocities cubic, else linear |
/// | cplan's JSON | as its member `interpolation` states: [`INTERPOLATION`], or [`SMOOTH_INTERPOLATION`] | quartic, or cubic; without accelerations cubic, without velocities linear |
/// | CSV | no convention; the usual one for positions with velocities | with velocities cubic, else linear |
/// | a path without times | straight segments between waypoints | linear |
///
/// Values that the consumer does not use (such as accelerations in a CSV) do not change the motion. They must still be
/// within the limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight lines in joint space, at constant velocity between two samples.
    Linear,
    /// Cubic polynomials with the positions and velocities of both ends (Hermite).
    Cubic,
    /// Polynomials of degree 4 with position, velocity and acceleration at the beginning, and position and velocity at the end.
    /// The acceleration at a sample is that of the interval that begins there, and may jump from one interval to the next.
    Quartic,
    /// Polynomials of degree 5 with the positions, velocities and accelerations of both ends.
    Quintic,
}

/// Creates the description of an interpolation from that of its straight pieces.
macro_rules! interpolation {
    ($straight:literal) => {
        concat!(
            "from time[k] to time[k+1], with p = position, v = velocity, a = acceleration, \
            h = time[k+1] - time[k] and t = time - time[k]: p[k] + v[k] t + a[k] t^2 / 2 + c t^3 + d t^4 where \
            E = p[k+1] - p[k] - v[k] h - a[k] h^2 / 2, F = v[k+1] - v[k] - a[k] h, c = (4 E - F h) / h^3, \
            d = (F h - 3 E) / h^4; ",
            $straight
        )
    };
}

/// Description of the interpolation of cplan's JSON: [`Interpolation::Quartic`].
pub const INTERPOLATION: &str =
    interpolation!("c = d = 0 on straight pieces of the path, where the acceleration is constant");

/// Description of the interpolation of cplan's JSON if jerks are limited: [`Interpolation::Cubic`]. The file also
/// states accelerations.
pub const SMOOTH_INTERPOLATION: &str = interpolation!("d = 0, because the jerk is constant");
