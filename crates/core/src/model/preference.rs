//! Regions that a field planner prefers or avoids.

use super::Arm;
use crate::space::Configuration;
use cplan_geometry::{Point, SimplePolygon};
use serde::{Deserialize, Serialize};

/// The configurations for which a preference holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Region {
    /// These configurations, and on circles their copies.
    Configurations(SimplePolygon),
    /// The configurations whose tip lies in this polygon of the workspace, metres.
    Tip(SimplePolygon),
}

/// A region of the world that field planners may treat differently. Unlike an obstacle it is no strict constraint.
/// Other planners ignore it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Preference {
    /// The user's name for it, or `preference 3`.
    pub name: String,
    /// The configurations to which it applies.
    pub region: Region,
    /// Strength of the drift in the field equation, per grid cell; finite. With fields whose drift follows their own
    /// slope a positive value makes the region less attractive, a negative one more attractive.
    pub epsilon: f64,
    /// Direction of the drift in joint space, of length 1; for fields that are oriented by region.
    pub direction: Option<[f64; 2]>,
}

impl Preference {
    /// Returns true if it holds at `q`. Exact, boundaries included, up to the rounding of the tip's place.
    #[must_use]
    pub fn holds_at(&self, arm: &Arm, q: Configuration) -> bool {
        match &self.region {
            Region::Tip(polygon) => polygon.contains(arm.tip_at(q)),
            Region::Configurations(polygon) => {
                let axes = arm.topology().ranges;
                let copies = |k: usize| {
                    let corners = polygon.corners().iter().map(|corner| corner[k]);
                    let window = corners.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
                    axes[k].copies_within(q[k], window)
                };
                copies(0).any(|a| copies(1).any(|b| polygon.contains(Point::new(a, b))))
            }
        }
    }
}
