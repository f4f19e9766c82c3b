//! The configuration space: C-obstacles as polygons (for roadmaps) or cells (for fields), which state what they
//! prove.
//!
//! [`Slice::compute`] computes the forbidden values of `q2` at one `q1` exactly, from contact angles. Grids consist of
//! the slices of their rows. Polygons follow the contact curves from slice to slice, between the values of `q1` at
//! which the slices' structure changes (`events`).
//!
//! Outlines with many corners are simplified within the margin (`coarse`). Cells of the size of the margin cover
//! outlines of many small pieces (`covering`). Contours are first united with their neighbours, so that the time
//! depends on the number of corners of the result (`union`).
//!
//! On circles, polygons cover a window of some turns, in which obstacles and goals repeat. So planners need no
//! special case.
//!
//! ```
//! use cplan_planners::cspace::{Slice, c_obstacles};
//! use cplan_model::{Arm, Contacts, Obstacle, Scene, Workspace};
//! use cplan_model::space::Configuration;
//!
//! let workspace = Workspace::new([Obstacle::circle("post", [1.5, 0.0], 0.1)?]);
//! let scene = Scene::new(Arm::rr([1.0, 0.8], 0.06)?, workspace)?;
//! // With joint 1 at zero, these are exactly the values of joint 2 at which the arm hits the post.
//! let mut slice = Slice::default();
//! slice.compute(&Contacts::new(&scene), 0.0, 0.0);
//! let [[lower, upper]] = slice.merged[..] else { panic!("one interval") };
//! assert!((upper - (0.13_f64 / 0.5).asin()).abs() < 1e-9 && (lower + upper).abs() < 1e-9);
//! assert!(scene.clearance(Configuration::new(0.0, 0.0)) < 0.0);
//! // The whole C-obstacle, to within a millimetre.
//! assert_eq!(c_obstacles(&scene, 1e-3, 1e-3)[0].obstacle, 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bitmap;
mod chord;
mod coarse;
mod covering;
mod curves;
mod events;
mod gantry_cells;
mod grid;
mod nearest;
mod outline;
mod regions;
mod slices;
mod sampled;
mod slabs;
mod stretches;
mod translation;
mod union;
mod zones;

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::Serialize;

pub use bitmap::{Bitmap, bitmap};
pub use grid::Grid;
pub use nearest::{NearestFree, nearest_free};
pub use regions::{
    CObstacle, NotPolygons, PolygonWithHoles, Regions, beyond_sum, c_obstacles, exact_c_obstacles, exact_regions,
    inner_regions, not_polygons, regions, traced_pairs, united,
};
pub use sampled::sampled_grid;
pub use slabs::{grid_from_slices, outer_grid};
pub use slices::{ForbiddenInterval, Slice};
pub use stretches::free_stretches;
pub use zones::{Zone, ZonedGrid};

/// What a representation of free space proves about the true free space.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub enum Proves {
    /// Free configurations are truly free, and blocked ones truly blocked, up to rounding.
    Exact,
    /// Obstacles are grown by at most `margin` metres in the workspace. Free configurations are truly free. Blocked
    /// ones may be free.
    Outer {
        /// The greatest growth of an obstacle, metres.
        margin: f64,
    },
    /// Obstacles are shrunk by at most `margin` metres in the workspace. Blocked configurations are truly blocked. Free
    /// ones may be blocked.
    Inner {
        /// The greatest reduction of an obstacle, metres.
        margin: f64,
    },
    /// Only some configurations were examined, so nothing is proven.
    Sampled,
}

impl std::fmt::Display for Proves {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Proves::Exact => write!(f, "exact"),
            Proves::Outer { margin } => write!(f, "outer, obstacles grown by up to {margin:.2e} m"),
            Proves::Inner { margin } => write!(f, "inner, obstacles shrunk by up to {margin:.2e} m"),
            Proves::Sampled => write!(f, "sampled"),
        }
    }
}
