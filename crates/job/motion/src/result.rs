//! Records about paths and searches in results.

use crate::CertifiedCurve;
use cplan_handling::{INTERPOLATION, SMOOTH_INTERPOLATION};
use cplan_model::Arm;
use serde::Serialize;

/// Describes how to interpolate trajectories of an arm.
pub fn interpolation(arm: &Arm) -> &'static str {
    if arm.limits_jerks() { SMOOTH_INTERPOLATION } else { INTERPOLATION }
}

/// Length of a path, with a proven lower bound on the length of every free motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LengthOptimality {
    /// Measure of lengths: `euclidean`, `weighted`, `time` (seconds at the top speeds of joints and motors), or `motor`.
    pub metric: &'static str,
    /// Weights of the joints, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weights: Option<[f64; 2]>,
    /// Length of the path in this metric.
    pub length: f64,
    /// Proven lower bound on the length of every motion to any of the goals.
    pub lower_bound: f64,
    /// `length / lower_bound - 1`; `None` if only the bound is 0.
    pub gap: Option<f64>,
}

/// Duration of a motion, with a proven lower bound on the duration of every motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DurationOptimality {
    /// Duration of the motion, seconds.
    pub duration: f64,
    /// Proven lower bound on the duration of every motion to any of the goals within the joints' limits.
    pub lower_bound: f64,
    /// `duration / lower_bound - 1`; `None` if the bound is 0.
    pub gap: Option<f64>,
}

impl DurationOptimality {
    /// Creates the record with its gap.
    pub fn new(duration: f64, lower_bound: f64) -> Self {
        Self { duration, lower_bound, gap: (lower_bound > 0.0).then_some(duration / lower_bound - 1.0) }
    }
}

/// The corners at which a motion does not stop.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BlendReport {
    /// Number of blends. The motion stops at the path's other corners.
    pub count: usize,
    /// Greatest distance from a corner, in joint space (mixing radians and metres), at which the motion is off the path. For a
    /// blend, it is the distance of its ends from the corner.
    pub largest_radius: f64,
}

impl BlendReport {
    /// Summarises the blends of a curve.
    pub fn of(curve: &CertifiedCurve) -> Self {
        let radii: Vec<f64> = curve.radii().iter().copied().filter(|radius| *radius > 0.0).collect();
        Self { count: radii.len(), largest_radius: radii.into_iter().fold(0.0, f64::max) }
    }
}

/// Settings of a search of a grid or a roadmap.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct SearchReport {
    /// Name of the search: `wave` or `deepening` (only for grids), `bfs`, `dfs`, `dijkstra`, `astar` or `greedy`.
    pub search: &'static str,
    /// Rule by which A\* breaks ties between equally promising cells, unless it is the default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ties: Option<&'static str>,
    /// For grids, the number of neighbours: 4, or 8 with diagonal moves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub neighbors: Option<u8>,
    /// True if the search began at the goals. For grids, it is stated only if false.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub backward: Option<bool>,
    /// `full` for the full visibility graph; omitted for the reduced one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub graph: Option<&'static str>,
}

impl std::fmt::Display for SearchReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.search)?;
        if let Some(neighbors) = self.neighbors {
            write!(f, ", {neighbors} neighbours")?;
        }
        if let Some(ties) = self.ties {
            write!(f, ", ties {ties}")?;
        }
        f.write_str(match (self.neighbors, self.backward) {
            (None, Some(true)) => ", backward",
            (Some(_), Some(false)) => ", forward",
            _ => "",
        })
    }
}
