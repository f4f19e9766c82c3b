//! An independent checker of cplan's certificates. This crate reads the files, and judges tasks and moving obstacles.
//!
//! [`check`] reads a URDF, a world and a certificate, and decides whether the certificate proves its answer, in exact
//! arithmetic. Decimals have exactly the value that is written. Roots, sines and cosines are enclosed between a lower
//! and an upper bound. The checker shares no code with the planner. `cplan-check` judges certificates about one motion.
//! This crate reads URDF and meshes, worlds and maps for it, and judges tasks by repeating their steps. In cplan's
//! repository, `docs/certificate_format.md` describes the format and the meaning of each key, and
//! `docs/certificate_checks.md` lists the conditions that are checked and explains why they suffice.
//!
//! ```
//! let urdf = r#"<robot name="bar">
//!     <link name="base"/>
//!     <joint name="j1" type="revolute">
//!         <parent link="base"/> <child link="bar"/> <axis xyz="0 0 1"/> <limit lower="-3" upper="3"/>
//!     </joint>
//!     <link name="bar">
//!         <collision> <origin xyz="0.5 0 0"/> <geometry> <box size="1 0.1 0.1"/> </geometry> </collision>
//!     </link>
//!     <joint name="j2" type="revolute">
//!         <parent link="bar"/> <child link="tool"/> <origin xyz="1 0 0"/> <axis xyz="0 0 1"/> <limit lower="-1" upper="1"/>
//!     </joint>
//!     <link name="tool"/>
//! </robot>"#;
//! let world = "start.joints = [-1, 0]\ngoal.joints = [1, 0]\nobstacle = [{ circle = { center = [0.9, 0.0], radius = 0.2 } }]";
//! let certificate = r#"{
//!     "format": "cplan certificate 1", "answer": "infeasible",
//!     "shapes": [{ "link": "bar", "collision": 0 }], "parts": [{ "obstacle": 0 }],
//!     "boxes": [{ "lower": [-0.1, -1], "upper": [0.1, 1], "shape": 0, "part": 0 }]
//! }"#;
//! assert!(cplan_check_files::check(urdf, world, certificate).is_ok());
//! let too_long = certificate.replace("0.1, 1", "0.3, 1");
//! let why = cplan_check_files::check(urdf, world, &too_long).unwrap_err();
//! assert!(matches!(why, cplan_check_files::CheckError::Fails(_)));
//! ```
#![forbid(unsafe_code)]

mod files;
mod robot;
mod task;
mod world;

pub use cplan_check::{CheckError, Input};

use cplan_check::certificate;
use files::Files;
use robot::Robot;
use std::path::{Path, PathBuf};
use world::WorldFile;

/// Checks a certificate, given the texts of the three files. Returns a sentence that states the proven answer.
///
/// # Errors
/// [`CheckError::Fails`] names the first part that does not hold. [`CheckError::Input`] reports files that are wrong or
/// contain something that the checker does not know. It also reports references to other files, because their location
/// is unknown.
pub fn check(urdf: &str, world: &str, certificate: &str) -> Result<String, CheckError> {
    check_texts([urdf, world, certificate], [None, None])
}

/// Checks a certificate, given the paths of the three files. If the URDF or the world refers to other files, their
/// paths are relative to the referring file.
///
/// # Errors
/// Same as [`check`], and if a file cannot be read.
pub fn check_files(urdf: &Path, world: &Path, certificate: &Path) -> Result<String, CheckError> {
    let read = |input: Input, path: &Path| {
        let message = |error| format!("{error}: give a URDF, a world file and a certificate");
        std::fs::read_to_string(path).map_err(|error| CheckError::in_file(input, message(error)))
    };
    let texts = [read(Input::Urdf, urdf)?, read(Input::World, world)?, read(Input::Certificate, certificate)?];
    check_beside(texts.each_ref().map(String::as_str), [urdf, world])
}

/// Checks a certificate, given the texts of the three files. `beside` has the paths of the URDF and the world. Paths of
/// other files are relative to these.
///
/// # Errors
/// Same as [`check`], and if a file cannot be read.
pub fn check_beside(texts: [&str; 3], beside: [&Path; 2]) -> Result<String, CheckError> {
    check_texts(texts, beside.map(|path| Some(path.to_owned())))
}

/// Checks a certificate, given three texts, and the paths of the URDF and the world if known.
fn check_texts([urdf, world, certificate]: [&str; 3], given: [Option<PathBuf>; 2]) -> Result<String, CheckError> {
    let certificate = certificate::read(certificate)?;
    let files = Files::new(&certificate, [urdf, world], given)?;
    // Drop a byte order mark.
    let [urdf, world] = [urdf, world].map(|text| text.strip_prefix('\u{feff}').unwrap_or(text));
    let mut world = WorldFile::read(world, &files)?;
    // A document type is harmless: the parser limits the size of entities.
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
    let document = roxmltree::Document::parse_with_options(urdf, options).map_err(|error| CheckError::Input {
        input: Input::Urdf,
        line: Some(error.pos().row as usize),
        message: error.to_string(),
    })?;
    let mut robot = Robot::read(&document, &world, &files, certificate.joints.as_ref())?;
    let mut errors = std::mem::take(&mut world.robot.calibration);
    certificate.calibration.as_ref().map_or(Ok(()), |stated| errors.replace(stated, &mut world.world))?;
    let clearance = certificate.clearance(&world.world)?.clone();
    if errors.grow(&mut robot.arm, &mut world.world, &clearance)? && world.task.is_some() {
        return Err(CheckError::in_file(
            Input::World,
            "the checker does not judge tasks in worlds with errors (calibration)",
        ));
    }
    let proven = match (&certificate.line, &certificate.steps) {
        (Some(line), _) => cplan_check_line::judge(&robot.arm, &world.world, &certificate, line.get())?,
        (None, Some(steps)) => task::check_motion(&robot, &world, &certificate, steps)?,
        (None, None) if world.task.as_ref().is_some_and(|task| task.is_move) => {
            let message = "the world gives values of the tool's joints, so the certificate needs steps";
            return Err(CheckError::in_file(Input::Certificate, message));
        }
        (None, None) => cplan_check::judge(&robot.arm, &world.world, &certificate)?,
    };
    Ok(proven + &robot.arm.notes)
}
