//! Metrics of joint space.

use super::{Configuration, Path};

/// A norm on displacements in joint space. For every norm, a path does not get longer if a straight segment replaces
/// a piece of it. So some shortest path among polygons turns at convex corners only, and the funnel path is as short
/// as any path in its homotopy class.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Metric {
    /// `sqrt(d1^2 + d2^2)`, which adds squares of radians and metres.
    #[default]
    Euclidean,
    /// `sqrt((w1 d1)^2 + (w2 d2)^2)`.
    Weighted {
        /// A positive weight for each joint.
        weights: [f64; 2],
    },
    /// The greatest of `|d1| / v1`, `|d2| / v2` and, if the speed of a sum of both joints is limited,
    /// `|ratio d1 + d2| / speed`: the time, seconds, in which both joints move together at their top speeds.
    Time {
        /// Top speed of each joint, rad/s or m/s; positive.
        speeds: [f64; 2],
        /// The limit of the sum, which a motor of the elbow on the base turns.
        sum: Option<SumSpeed>,
    },
    /// `sqrt(d1^2 + (ratio d1 + d2)^2)`: the Euclidean length in the angles of both motors, without their gears, radians.
    Motor {
        /// Turns of the elbow's motor for each turn of joint 1.
        ratio: f64,
    },
}

/// Top speed of the sum `ratio q1 + q2` of both joint values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SumSpeed {
    /// Factor of joint 1.
    pub ratio: f64,
    /// Top speed, rad/s; positive.
    pub speed: f64,
}

impl SumSpeed {
    /// Returns the weights of both joints in the time that the sum needs.
    pub(super) fn weights(self) -> [f64; 2] {
        [self.ratio / self.speed, 1.0 / self.speed]
    }
}

impl Metric {
    /// Returns the norm of a displacement.
    pub fn norm(self, d: Configuration) -> f64 {
        match self {
            Metric::Euclidean => d.norm(),
            Metric::Weighted { weights: [w1, w2] } => (w1 * d[0]).hypot(w2 * d[1]),
            Metric::Time { speeds: [v1, v2], sum } => {
                let of_sum = |sum: SumSpeed| (sum.ratio * d[0] + d[1]).abs() / sum.speed;
                (d[0].abs() / v1).max(d[1].abs() / v2).max(sum.map_or(0.0, of_sum))
            }
            Metric::Motor { ratio } => d[0].hypot(ratio * d[0] + d[1]),
        }
    }

    /// Returns a lower bound on the norm of all displacements that move a joint by 1.
    pub fn least(self, joint: usize) -> f64 {
        match (self, joint) {
            (Metric::Euclidean, _) | (Metric::Motor { .. }, 0) => 1.0,
            (Metric::Weighted { weights }, _) => weights[joint],
            (Metric::Time { speeds, .. }, _) => 1.0 / speeds[joint],
            (Metric::Motor { ratio }, _) => 1.0 / 1.0_f64.hypot(ratio),
        }
    }

    /// Returns the length of a path.
    pub fn length(self, path: &Path) -> f64 {
        // Not `sum`, which is -0 for an empty path.
        path.segments().map(|(a, b)| self.norm(b - a)).fold(0.0, |length, piece| length + piece)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norms_of_a_displacement_are_as_defined() {
        let d = Configuration::new(-3.0, 4.0);
        assert_eq!(Metric::Euclidean.norm(d), 5.0);
        assert_eq!(Metric::Weighted { weights: [4.0, 4.0] }.norm(d), 20.0);
        assert_eq!(Metric::Time { speeds: [2.0, 1.0], sum: None }.norm(d), 4.0);
        assert_eq!(Metric::Time { speeds: [0.5, 1.0], sum: None }.norm(d), 6.0);
        let sum = |ratio: f64, speed: f64| Metric::Time { speeds: [0.5, 1.0], sum: Some(SumSpeed { ratio, speed }) };
        assert_eq!([sum(-1.0, 0.5).norm(d), sum(1.0, 0.5).norm(d)], [14.0, 6.0]);
        assert_eq!(
            [Metric::Motor { ratio: 1.0 }.norm(d), Metric::Motor { ratio: 0.0 }.norm(d)],
            [3.0_f64.hypot(1.0), 5.0]
        );
    }

    /// Compares the least norm with the least one of many displacements that move a joint by 1. The least norm of
    /// [`Metric::Time`] ignores the sum, so it is only a lower bound.
    #[test]
    fn least_norms_are_those_of_the_best_displacements() {
        let sum = Some(SumSpeed { ratio: -1.5, speed: 0.4 });
        let metrics = [
            (Metric::Euclidean, true),
            (Metric::Weighted { weights: [2.0, 0.5] }, true),
            (Metric::Time { speeds: [2.0, 0.7], sum: None }, true),
            (Metric::Time { speeds: [2.0, 0.7], sum }, false),
            (Metric::Motor { ratio: 1.5 }, true),
        ];
        for ((metric, is_exact), joint) in metrics.into_iter().flat_map(|metric| [(metric, 0), (metric, 1)]) {
            let other = (-4000..=4000).map(|k| f64::from(k) / 1000.0);
            let norms = other.map(|by| metric.norm(if joint == 0 { [1.0, by] } else { [by, 1.0] }.into()));
            let (best, least) = (norms.fold(f64::INFINITY, f64::min), metric.least(joint));
            assert!(least <= best + 1e-15 && (!is_exact || best <= least + 1e-6), "{metric:?} {joint}: {least} {best}");
        }
    }

    #[test]
    fn a_path_is_as_long_as_its_pieces() {
        let path = Path::new([[0.0, 0.0], [3.0, 4.0], [3.0, 5.0]].map(Configuration::from).to_vec());
        assert_eq!(Metric::Euclidean.length(&path), path.length());
        assert_eq!(Metric::Time { speeds: [1.0, 1.0], sum: None }.length(&path), 5.0);
    }
}
