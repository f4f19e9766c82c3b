//! Reads a robot from URDF and reduces it to a planar two-joint arm. Errors have file, line and hint.
//!
//! ```text
//! arm.urdf --> RobotFile --> Source (URDF text) --+--> load -----> Arm, RobotReport
//!                                                 |
//! [robot] of a world file --> RobotSettings ------+--> survey ---> Inspection
//! ```
//!
//! [`load`] stops at the first stage that fails; [`survey`] reports all stages. Readers of other files use the same errors
//! ([`InputError`], [`Diagnostic`]), files ([`Source`]) and numbers ([`Quantity`]).
//!
//! To understand the code, read `error` and `source` first, then `toml_values`, `robot_table` and `quantity`, then `urdf`, whose
//! documentation lists the stages.

mod assumed;
mod calibration;
mod drives;
mod error;
mod identity;
mod inspection;
mod quantity;
mod report;
mod robot_file;
mod robot_table;
#[cfg(feature = "schema")]
pub mod schema;
mod settings;
mod source;
mod spanned;
mod stroke;
mod toml_values;
mod urdf;
mod wrist;

pub use assumed::AssumedLimits;
pub use calibration::{CalibrationTable, ErrorBound, LengthError};
pub use drives::{DrivesTable, DrivesValue, MotorTable};
pub use error::{Diagnostic, DiagnosticKind, InputError, quoted};
pub use identity::FileIdentity;
pub use inspection::{
    BodyEntry, Frame, Inspection, JointEntry, LimitEntry, LimitSource, LinkEntry, MotorEntry, OutlineEntry, PairEntry,
    PlaneEntry, RateEntry, RateSource, ReachEntry, Role, SelfObstacleEntry,
};
pub use quantity::{Length, Lengths, MAX_LENGTH, Metres, Number, Numbers, PerJoint, Quantity, Written, length};
pub use report::RobotReport;
pub use robot_file::{Conversion, RobotFile};
pub use robot_table::RobotTable;
pub use settings::RobotSettings;
pub use source::{Cursor, Origins, Position, Source, nearest_file, read_bounded, read_bytes, read_recorded};
pub use spanned::Spanned;
pub use stroke::StrokeTable;
pub use toml_values::{Fields, FromToml, TomlError, TomlValue, key_of, number};
pub use urdf::{load, meshes_elsewhere, survey};
pub use wrist::WristTable;
