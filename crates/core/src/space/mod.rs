//! Configurations, paths, and the topology of the space they live in.
//!
//! Goals are a set ([`GoalSet`]): configurations, and segments if a tip goal leaves a joint free. Roadmaps end where
//! their last leg meets a segment perpendicularly, or at an end of its free part. Fields start in all its free cells.
//! Boxes that meet it are goals for certificates and proofs, and bounds refer to its nearest point.
//!
//! ```
//! use cplan_core::space::{Configuration, JointRange, Topology};
//!
//! let topology = Topology { ranges: [JointRange::Circle, JointRange::Interval { lower: -2.0, upper: 2.0 }] };
//! let (from, to) = (Configuration::new(3.0, 0.0), Configuration::new(-3.0, 0.0));
//! // The short direction crosses the seam, where the path continues to count.
//! assert!((topology.distance(from, to) - (std::f64::consts::TAU - 6.0)).abs() < 1e-12);
//! assert!(topology.lift(to, from)[0] > 3.0);
//! ```

mod copies;
mod split_mix;
pub mod funnel;
mod goal_set;
mod measure;
mod metric;
mod path;
mod segment;
mod topology;

pub use funnel::{Portal, funnel_path, nearest_end};
pub use goal_set::GoalSet;
pub use measure::Measure;
pub use metric::Metric;
pub use path::Path;
pub use segment::Segment;
pub use split_mix::SplitMix64;
pub use topology::{JointRange, Topology};

/// Values of the two joints, in the order base to tip; radians for a revolute joint, metres for a prismatic one.
pub type Configuration = cplan_geometry::Vector;
