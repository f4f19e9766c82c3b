//! Checks certificates about one motion of an arm, in exact arithmetic.
//!
//! [`judge`] takes an [`Arm`], a [`World`] and a [`Certificate`], and decides whether the certificate proves its answer: a
//! motion is free, there is no motion, or no motion is shorter than a length. Decimals have exactly the value that is written.
//! Roots, sines and cosines are enclosed between a lower and an upper bound. This crate shares no code with the planner and
//! reads no files: `cplan-check-files` reads robots, worlds and maps, and judges tasks on top of it. In cplan's repository,
//! `docs/certificate_checks.md` lists the conditions that are checked and explains why they suffice. In reading order:
//!
//! | modules | subject |
//! |---|---|
//! | [`decimal`], [`interval`] | numbers |
//! | [`overlap`], [`polygon`] | shapes |
//! | [`domain`], [`curve`] | configurations and motions |
//! | [`arm`], [`elbow`], [`shapes`], [`obstacle`], [`world`], [`certificate`] | input of the checks |
//! | [`ends`] | start and goal |
//! | [`motion`], [`scene`], [`free`] | a motion is free |
//! | `infeasible`, `sweep` | boxes separate start and goal |
//! | `bound` | walls block all shorter motions |
//! | `mover`, `contacts` | boxes and walls collide |
#![forbid(unsafe_code)]

pub mod arm;
mod bound;
pub mod certificate;
pub mod contacts;
pub mod curve;
pub mod decimal;
pub mod domain;
pub mod elbow;
pub mod ends;
mod error;
pub mod free;
mod infeasible;
pub mod interval;
pub mod joint_sum;
pub mod motion;
pub mod mover;
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

/// Checks a certificate about one motion. Returns the proven statement as a sentence.
///
/// # Errors
/// [`CheckError::Fails`] names the first part of the certificate that does not hold. [`CheckError::Input`] reports
/// input that the checker cannot read.
pub fn judge(arm: &Arm, world: &World, certificate: &Certificate) -> Result<String, CheckError> {
    match &certificate.answer {
        Answer::Found if certificate.bound.is_some() => {
            Ok(motion::check_motion(arm, world, certificate)? + "; " + &bound::no_shorter(arm, world, certificate)?)
        }
        Answer::Found => motion::check_motion(arm, world, certificate),
        Answer::Infeasible => infeasible::infeasible(arm, world, certificate),
        Answer::NoShorter => bound::no_shorter(arm, world, certificate),
    }
}
