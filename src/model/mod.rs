//! The arm, the workspace, and the two together.

mod arm;
mod carried;
mod joint;
mod link;
mod preference;
mod problem;
mod scene;
mod workspace;

pub use arm::{Arm, Plane};
pub use carried::Carried;
pub(crate) use carried::{on_axis, swept};
pub use joint::{Joint, Motion};
pub use link::{Link, OutlineSource, Part};
pub use preference::{Preference, Region};
pub use problem::{Goal, Problem};
pub use scene::{Contact, Pair, Scene};
pub use workspace::{Heights, Obstacle, Shape, Workspace};
