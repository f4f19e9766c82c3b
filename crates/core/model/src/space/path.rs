//! Paths in joint space.

use super::Configuration;

/// A polyline in joint space, in *unwrapped* values: on a circle, a waypoint may lie beyond pi, so the direction of
/// a motion around the circle is never ambiguous. A path has at least one waypoint.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    waypoints: Vec<Configuration>,
}

impl Path {
    /// Creates a path through `waypoints`; drops each waypoint that equals the one before it.
    ///
    /// # Panics
    /// If there are no waypoints.
    pub fn new(mut waypoints: Vec<Configuration>) -> Self {
        assert!(!waypoints.is_empty(), "a path has at least one waypoint");
        waypoints.dedup();
        Self { waypoints }
    }

    /// Returns the waypoints, including start and goal.
    pub fn waypoints(&self) -> &[Configuration] {
        &self.waypoints
    }

    /// Returns the first waypoint.
    pub fn start(&self) -> Configuration {
        self.waypoints[0]
    }

    /// Returns the last waypoint.
    pub fn goal(&self) -> Configuration {
        self.waypoints[self.waypoints.len() - 1]
    }

    /// Iterates over the straight segments. A path without motion has none.
    pub fn segments(&self) -> impl Iterator<Item = (Configuration, Configuration)> + '_ {
        self.waypoints.windows(2).map(|w| (w[0], w[1]))
    }

    /// Returns the part between two distances from the start, measured along the path by its Euclidean length. The
    /// part is reversed if `from` is greater than `to`. Distances are clamped to the path's ends.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        if from > to {
            let mut part = self.part(to, from);
            part.waypoints.reverse();
            return part;
        }
        let (mut waypoints, mut gone) = (Vec::new(), 0.0);
        for (a, b) in self.segments() {
            let length = (b - a).norm();
            let ends = gone + length;
            let at = |distance: f64| {
                let share = (distance - gone) / length;
                if share >= 1.0 { b } else { a + (b - a) * share.max(0.0) }
            };
            if waypoints.is_empty() && from < ends {
                waypoints.push(at(from));
            }
            if !waypoints.is_empty() {
                waypoints.push(at(to));
                if to <= ends {
                    break;
                }
            }
            gone = ends;
        }
        if waypoints.is_empty() { Self::new(vec![self.goal()]) } else { Self::new(waypoints) }
    }

    /// Returns the Euclidean length in joint space, which adds squares of radians and metres.
    pub fn length(&self) -> f64 {
        // Not `sum`, which is -0 for an empty path.
        self.segments().map(|(a, b)| (b - a).norm()).fold(0.0, |length, piece| length + piece)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_lies_between_two_distances_along_the_path() {
        let q = |a: f64, b: f64| Configuration::new(a, b);
        let path = Path::new(vec![q(0.0, 0.0), q(2.0, 0.0), q(2.0, 1.0), q(0.0, 1.0)]);
        let part = |from: f64, to: f64| path.part(from, to).waypoints().to_vec();
        assert_eq!(part(0.0, 5.0), path.waypoints());
        assert_eq!(part(-1.0, 9.0), path.waypoints());
        assert_eq!(part(0.5, 1.5), [q(0.5, 0.0), q(1.5, 0.0)]);
        assert_eq!(part(1.0, 4.0), [q(1.0, 0.0), q(2.0, 0.0), q(2.0, 1.0), q(1.0, 1.0)]);
        assert_eq!(part(4.0, 1.0), [q(1.0, 1.0), q(2.0, 1.0), q(2.0, 0.0), q(1.0, 0.0)]);
        assert_eq!(part(2.0, 3.0), [q(2.0, 0.0), q(2.0, 1.0)]);
        assert_eq!((part(2.5, 2.5), part(5.0, 5.0)), (vec![q(2.0, 0.5)], vec![q(0.0, 1.0)]));
        assert_eq!(Path::new(vec![q(1.0, 1.0)]).part(0.0, 1.0).waypoints(), [q(1.0, 1.0)]);
    }
}
