//! Regions that a field planner prefers or avoids.

use super::Arm;
use crate::space::Configuration;
use cplan_geometry::{Point, SimplePolygon};
use serde::{Deserialize, Serialize};

/// The set of configurations to which a preference applies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Region {
    /// A polygon of configurations. On circles its copies by whole turns belong to it.
    Configurations(SimplePolygon),
    /// All configurations whose tip lies in this polygon of the workspace, metres.
    Tip(SimplePolygon),
}

/// A region that field planners prefer or avoid. It is no obstacle: paths may cross it. Other planners ignore it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Preference {
    /// The user's name for the preference, or a default such as `preference 3`.
    pub name: String,
    /// The configurations to which it applies.
    pub region: Region,
    /// Strength of the drift in the field equation, per grid cell; finite. If the drift follows the field's own
    /// slope, a positive value makes the region less attractive, and a negative one more attractive.
    pub epsilon: f64,
    /// Direction of the drift in joint space, of length 1. `None` if none is given. Only fields with a
    /// direction per region use it.
    pub direction: Option<[f64; 2]>,
}

impl Preference {
    /// Returns true if the preference applies at `q`. Exact, boundaries included, up to the rounding of the tip's
    /// position.
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
