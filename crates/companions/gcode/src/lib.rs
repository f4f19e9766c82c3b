//! Judges G-code for machines that compute the kinematics of their arm themselves, and replaces unsafe travels.
//!
//! Such a machine moves the tip along each line of the program, and keeps the side of its elbow. [`judge`] proves for each
//! line that the arm can follow it within its limits and free of collisions, or states the reason why not. Travels (G0) that
//! the machine cannot play are planned again in joint space, and written as straight lines that it can play. All other lines
//! stay as they are, byte for byte.
//!
//! ```
//! use cplan_gcode::{Job, Settings, judge};
//! use cplan_model::{Arm, Obstacle, Scene, Status, Workspace};
//!
//! // The arm's tower is in the way of the travel.
//! let tower = Obstacle::circle("tower", [0.0, 0.15], 0.04)?;
//! let scene = Scene::new(Arm::rr([0.2, 0.2], 0.02)?, Workspace::new([tower])?)?;
//! let job = Job::read(b"G21 G90\nG0 X150 Y-50\nG1 X150 Y50\nG0 X-150 Y50\nG1 X-150 Y-50\n", None)?;
//! let answer = judge(&scene, &job, &Settings::default())?;
//! assert_eq!((answer.status(), answer.replaced.len()), (Status::Found, 1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Method
//!
//! `player` proves a single move. `walk` joins the moves of the program to chains. `detour` plans a travel with the solver
//! of the main job, and divides its path into lines. `written` writes the program, which is then read and judged again:
//! the digits of the file are what is proven.
#![forbid(unsafe_code)]

mod answer;
mod detour;
mod dialect;
mod fault;
mod job;
mod player;
mod walk;
mod written;

pub use answer::{Answer, Elbow, Failed, GcodeError, Settings, Travel, judge};
pub use dialect::Dialect;
pub use fault::{Cause, Fault};
pub use job::{Job, Pen, PenWords};
