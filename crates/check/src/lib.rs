//! The judge of certificates about one motion of an arm, in exact arithmetic.
//!
//! [`judge`] gets an [`Arm`], a [`World`] and a [`Certificate`], and says whether the
//! certificate proves its answer: a motion is free, there is none, or none is shorter. Decimals are taken as they are written, roots,
//! sines and cosines are enclosed by numbers below and above. It shares no code with the planner and reads no files: `cplan-check-files`
//! reads robots, worlds and maps, and judges tasks on top of it. In cplan's repository, `docs/certificate_checks.md` has
//! the conditions that are checked and why they suffice. In reading order:
//!
//! | modules | subject |
//! |---|---|
//! | [`decimal`], [`interval`] | numbers |
//! | [`overlap`], [`polygon`] | shapes |
//! | [`domain`], [`curve`] | configurations and motions |
//! | [`arm`], [`shapes`], [`obstacle`], [`world`], [`certificate`] | what is judged |
//! | [`ends`] | start and goal |
//! | [`motion`], [`scene`], [`free`] | a motion is free |
//! | `infeasible`, `sweep` | boxes separate start and goal |
//! | `bound` | walls bar what is shorter |
//! | `mover`, `contacts` | boxes and walls collide |
#![forbid(unsafe_code)]

pub mod arm;
mod bound;
pub mod certificate;
mod contacts;
pub mod curve;
pub mod decimal;
pub mod domain;
pub mod ends;
mod error;
pub mod free;
mod infeasible;
pub mod interval;
pub mod motion;
mod mover;
pub mod obstacle;
pub mod overlap;
pub mod polygon;
pub mod scene;
pub mod shapes;
mod sweep;
pub mod world;

pub use error::{CheckError, Input};

use arm::Arm;
use certificate::{Answer, Certificate};
use world::World;

/// Checks what a certificate says of one motion. What it proves is returned in words.
///
/// # Errors
/// [`CheckError::Fails`] with the first part that does not hold, [`CheckError::Input`] for what the checker does not know.
pub fn judge(arm: &Arm, world: &World, certificate: &Certificate) -> Result<String, CheckError> {
    match &certificate.answer {
        Answer::Found if certificate.bound.is_some() => {
            Ok(motion::found(arm, world, certificate)? + "; " + &bound::no_shorter(arm, world, certificate)?)
        }
        Answer::Found => motion::found(arm, world, certificate),
        Answer::Infeasible => infeasible::infeasible(arm, world, certificate),
        Answer::NoShorter => bound::no_shorter(arm, world, certificate),
    }
}
