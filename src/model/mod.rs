//! The arm, the workspace, and the two together.

mod arm;
mod assumed;
mod carried;
mod inverse;
mod joint;
mod link;
mod obstruction;
mod payload;
mod preference;
mod problem;
mod record;
mod robot_joints;
mod scene;
mod stroke;
mod stuck_along;
mod task;
mod workspace;

pub use arm::{Arm, Plane};
pub use assumed::AssumedLimits;
pub use carried::Carried;
pub(crate) use carried::{on_axis, swept};
pub use inverse::{Freedom, Inverse, inverse, within};
pub use joint::{Joint, Motion};
pub use link::{Link, OutlineSource, Part};
pub use obstruction::Obstruction;
pub use payload::{Grip, Payload};
pub use preference::{Preference, Region};
pub use problem::{Goal, Problem};
pub use record::{RecordedStep, RecordedTurn};
pub use robot_joints::{Driver, Drives, RobotJoint, RobotJoints};
pub use scene::{Contact, Pair, Scene};
pub use stroke::{Stroke, ToolJoint};
pub use stuck_along::BlockedStretch;
pub use task::{Action, Holding, Item, Object, Step, Task, Wrist};
pub use workspace::{Heights, Obstacle, Shape, Workspace};
