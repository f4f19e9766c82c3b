//! Paths in joint space.

use super::Configuration;

/// A polyline in joint space, in *unwrapped* values: on a circle axis a waypoint may lie beyond a turn, so which way
/// round a motion goes is never ambiguous. At least one waypoint.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    waypoints: Vec<Configuration>,
}

impl Path {
    /// A path through `waypoints`, without consecutive repetitions.
    ///
    /// # Panics
    /// If there is no waypoint.
    #[must_use]
    pub fn new(mut waypoints: Vec<Configuration>) -> Self {
        assert!(!waypoints.is_empty(), "a path has at least one waypoint");
        waypoints.dedup();
        Self { waypoints }
    }

    /// The corners, start and goal included.
    #[must_use]
    pub fn waypoints(&self) -> &[Configuration] {
        &self.waypoints
    }

    /// The first waypoint.
    #[must_use]
    pub fn start(&self) -> Configuration {
        self.waypoints[0]
    }

    /// The last waypoint.
    #[must_use]
    pub fn goal(&self) -> Configuration {
        self.waypoints[self.waypoints.len() - 1]
    }

    /// The straight pieces. A path that stays where it is has none.
    pub fn segments(&self) -> impl Iterator<Item = (Configuration, Configuration)> + '_ {
        self.waypoints.windows(2).map(|w| (w[0], w[1]))
    }

    /// Euclidean length in joint space (rad and m as they come).
    #[must_use]
    pub fn length(&self) -> f64 {
        // Not `sum`: of nothing it is -0.
        self.segments().map(|(a, b)| (b - a).norm()).fold(0.0, |length, piece| length + piece)
    }
}
