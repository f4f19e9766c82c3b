//! Configurations, paths, and the topology of joint space.
//!
//! Goals are a [`GoalSet`]: configurations, and segments if a tip goal leaves a joint free. A roadmap ends where its
//! last edge meets a segment at a right angle, or at an end of the segment's free part. A field has all free cells
//! of a segment as goals. Certificates and proofs treat every box that meets a segment as a goal, and lower bounds
//! use the segment's nearest point.
//!
//! ```
//! use cplan_model::space::{Configuration, JointRange, Topology};
//!
//! let topology = Topology::new([JointRange::Circle, JointRange::Interval { lower: -2.0, upper: 2.0 }]);
//! let (from, to) = (Configuration::new(3.0, 0.0), Configuration::new(-3.0, 0.0));
//! // The shorter direction crosses the seam, and values continue to count past pi.
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
pub use metric::{Metric, SumSpeed};
pub use path::Path;
pub use segment::Segment;
pub use split_mix::SplitMix64;
pub use topology::{JointRange, JointSumRange, LimitedValue, Topology};

/// Values of the two joints, in the order base to tip; radians for a revolute joint, metres for a prismatic one.
pub type Configuration = cplan_geometry::Vector;
