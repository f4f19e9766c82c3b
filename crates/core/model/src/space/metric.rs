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
    /// The greater of `|d1| / v1` and `|d2| / v2`: the time, seconds, in which both joints move together at their
    /// top speeds.
    Time {
        /// Top speed of each joint, rad/s or m/s; positive.
        speeds: [f64; 2],
    },
}

impl Metric {
    /// Returns the norm of a displacement.
    pub fn norm(self, d: Configuration) -> f64 {
        match self {
            Metric::Euclidean => d.norm(),
            Metric::Weighted { weights: [w1, w2] } => (w1 * d[0]).hypot(w2 * d[1]),
            Metric::Time { speeds: [v1, v2] } => (d[0].abs() / v1).max(d[1].abs() / v2),
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
        assert_eq!(Metric::Time { speeds: [2.0, 1.0] }.norm(d), 4.0);
        assert_eq!(Metric::Time { speeds: [0.5, 1.0] }.norm(d), 6.0);
    }

    #[test]
    fn a_path_is_as_long_as_its_pieces() {
        let path = Path::new([[0.0, 0.0], [3.0, 4.0], [3.0, 5.0]].map(Configuration::from).to_vec());
        assert_eq!(Metric::Euclidean.length(&path), path.length());
        assert_eq!(Metric::Time { speeds: [1.0, 1.0] }.length(&path), 5.0);
    }
}
