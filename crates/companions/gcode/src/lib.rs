//! Judges G-code for machines that compute the kinematics of their arm themselves, and replaces unsafe travels.
//!
//! Such a machine moves the tip along each line of the program, with the elbow always on the same side. [`judge`]
//! proves for each line that the arm can follow it within its limits and without collisions, or states why it cannot.
//! Travels (G0) that the machine cannot play are planned again in joint space, and written as straight lines that it
//! can play. All other lines remain unchanged, byte for byte.
//!
//! ```
//! use cplan_gcode::{Job, Settings, Setup, judge};
//! use cplan_model::{Arm, Obstacle, Scene, Status, Workspace};
//!
//! // The travel would hit the post.
//! let post = Obstacle::circle("post", [0.2, 0.25], 0.03)?;
//! let scene = Scene::new(Arm::rr([0.2, 0.2], 0.02)?, Workspace::new([post]))?;
//! let program = b"G21 G90\nG0 X300 Y0\nG1 X300 Y100\nG0 X50 Y350\nG1 X-50 Y350\n";
//! let job = Job::read(program, &Setup::default())?;
//! let answer = judge(&scene, &job, &Settings::default())?;
//! assert_eq!((answer.status(), answer.replaced.len()), (Status::Found, 1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Method
//!
//! `player` proves a single move. `walk` joins the moves of the program into chains. `detour` plans a travel with the
//! solver of the main job, and divides its path into lines. `written` writes the program. The written file is then read
//! and judged again, so the proof holds for its digits.
#![forbid(unsafe_code)]

mod answer;
mod detour;
mod dialect;
mod fault;
mod firmware;
mod frame;
mod job;
mod player;
mod walk;
mod written;

pub use answer::{Answer, Failed, GcodeError, Segments, Settings, Travel, judge};
pub use dialect::Dialect;
pub use fault::{Cause, Fault};
pub use frame::Frame;
pub use job::{Job, Pen, PenWords, Setup};
