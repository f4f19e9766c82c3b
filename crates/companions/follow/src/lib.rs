//! Moves the tip of a planar arm along a line.
//!
//! [`follow`] gives one of three answers:
//!
//! - *found*: a motion within the joints' limits whose tip stays within the tolerance of the line, in the order of the
//!   line. This holds also between the samples, for all usual interpolations of controllers. The motion is certified to
//!   be free of collisions.
//! - *infeasible*, with a proof: a place is out of reach, or each IK solution there is outside the limits or collides.
//!   Or each solution is excluded somewhere on a stretch of the line where the arm cannot change its solution.
//! - *unknown*, with the reason.
//!
//! ```
//! use cplan_model::{Arm, Outcome, Scene, Workspace};
//! use cplan_follow::{Settings, follow};
//! use cplan_toolpath::{Format, Placement, read};
//!
//! let scene = Scene::new(Arm::rr([1.0, 0.8], 0.06)?, Workspace::new([]))?;
//! let text = "G21 G0 X900 Y200\nG1 X1200 F6000\nG3 X1300 Y300 J100\n";
//! let line = read(text.as_bytes(), Format::GCode, &Placement::default())?;
//! let Outcome::Found(found) = follow(&scene, &line, &Settings::default())? else { panic!("found") };
//! assert!(found.deviation <= 1e-5 && found.timed.trajectory.duration() > 4.57);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Method
//!
//! Pieces far below the tolerance are merged for planning (`merge`); proofs and the final check of the distance are about the
//! line of the file. The line is divided into short parts (`nodes`): while the joints move straight from one end of a part to
//! the other, the tip stays near the line. A search (`search`) chooses the IK solution for each part, and the places where it
//! changes. The joints move along smooth curves through the nodes (`course`). The corners between these curves are blended as
//! far as the tolerance allows (`motion`), and the crate `cplan-motion` computes the timing. With limits on jerks, a smooth
//! curve near the line replaces the blended path between two stops (`smooth`), with control points whose spacing changes
//! gradually (`spacing`). Finally the motion is judged from its samples alone (`deviation`).
//!
//! For most positions of the tip, an arm with two joints has two IK solutions. They meet where the arm is straight or folded.
//! The arm can change its solution there. Near such places the joints are fast, so their speed limits slow down the tip.
//!
//! A travel (G0) is a straight move of the tip as fast as the joints allow, with stops at both ends. The tip stays
//! within the same tolerance of this move.
//!
//! [`fit`] searches for a placement of the line at which it can be followed with one IK solution.
#![forbid(unsafe_code)]

mod course;
mod deviation;
mod fit;
mod fixed_angle;
mod follower;
mod merge;
mod motion;
mod nodes;
mod proof;
mod proof_wrist;
mod search;
mod sheets;
mod smooth;
mod spacing;
mod tool;
mod wrist;

pub use cplan_deviation::Place;
pub use cplan_handling::{DEFAULT_TOLERANCE, MIN_TOLERANCE};
pub use fit::{Fitted, fit};
pub use proof::{Cause, Exclusion, Infeasible, Obstacle};
pub use proof_wrist::WristExcess;
pub use wrist::WristAlong;

use cplan_deviation::{Kinematics, Line};
use cplan_handling::{MAX_WRIST_TOLERANCE, MIN_WRIST_TOLERANCE, ToolAngle};
use cplan_model::space::Configuration;
use cplan_model::{Elbow, Outcome, Scene};
use cplan_motion::{TimedMotion, TimingError};
use cplan_toolpath::Toolpath;
use follower::Follower;
use proof::Prover;
use search::Search;

/// Greatest turn of the line's direction between two nodes, as a multiple of the tolerance of the tool's angle. The
/// tool turns evenly between nodes, so its angle deviates by far less than this turn.
const TURN_TOLERANCES: f64 = 10.0;

/// Settings of a motion along a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Greatest distance between the tip's path and the line, metres, at least [`MIN_TOLERANCE`].
    pub tolerance: f64,
    /// Greatest speed of the tip, metres per second. Replaces the speeds that the file states.
    pub speed: Option<f64>,
    /// Greatest speed of the tip on the whole line, including travels, metres per second. `None` for no limit.
    pub tip_speed: Option<f64>,
    /// Share of the joints' top speeds to use, above 0 and at most 1.
    pub share: f64,
    /// Time between two samples, seconds.
    pub period: f64,
    /// The wrist that turns the tool; `None` if the angle of the tool does not matter.
    pub wrist: Option<WristAlong>,
    /// The side of the elbow. `None` for either side. Arms without an elbow ignore it.
    pub elbow: Option<Elbow>,
}

impl Default for Settings {
    /// Returns a tolerance of a hundredth of a millimetre, the speeds of the file, and a sample every hundredth of a
    /// second.
    fn default() -> Self {
        Self {
            tolerance: DEFAULT_TOLERANCE,
            speed: None,
            tip_speed: None,
            share: 1.0,
            period: 0.01,
            wrist: None,
            elbow: None,
        }
    }
}

impl Settings {
    /// Returns the greatest turn of the line's direction between two nodes, radians. Infinite if the direction does not matter.
    fn greatest_turn(&self) -> f64 {
        self.wrist.map_or(f64::INFINITY, |wrist| match wrist.guide.angle {
            ToolAngle::Fixed(_) => f64::INFINITY,
            ToolAngle::Tangent(_) => TURN_TOLERANCES * wrist.guide.tolerance,
        })
    }

    fn check(&self) -> Result<(), FollowError> {
        let Self { tolerance, .. } = *self;
        if !(tolerance.is_finite() && tolerance >= MIN_TOLERANCE) {
            return Err(FollowError::Tolerance(tolerance));
        }
        if self.wrist.is_some_and(|wrist| !wrist.is_valid()) {
            return Err(FollowError::Wrist);
        }
        match self.speed.filter(|speed| !(speed.is_finite() && *speed > 0.0)) {
            Some(speed) => Err(FollowError::Speed(speed)),
            None => Ok(()),
        }
    }
}

/// The reason why settings cannot be used, or a motion cannot be timed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FollowError {
    /// The tolerance is too small, or not a number.
    #[error("the tolerance is {0} m; it must be a finite number of at least {MIN_TOLERANCE} m")]
    Tolerance(f64),
    /// The speed is not a positive number.
    #[error("the speed is {0} m/s; it must be a finite number above 0")]
    Speed(f64),
    /// The requirement on the tool's angle, or a number of the wrist, is not valid.
    #[error(
        "numbers of the wrist are invalid: all must be finite, limits positive, and the tolerance from {MIN_WRIST_TOLERANCE} to {MAX_WRIST_TOLERANCE} rad"
    )]
    Wrist,
    /// A tool must follow the direction of the line although jerks are limited.
    #[error(
        "the tool cannot follow the line's direction while jerks are limited; give the tool a fixed angle, or remove `jerk` from [robot]"
    )]
    TangentWithJerk,
    /// The wrist is too fast although the motion was slowed down.
    #[error("all motions that were tried are too fast for the wrist; give the wrist a higher acceleration")]
    WristTooSlow,
    /// The motion cannot be timed.
    #[error(transparent)]
    Timing(#[from] TimingError),
    /// A part of a certified path could not be certified by itself.
    #[error("a part of the path could not be certified; use a smaller tolerance")]
    Uncertified,
}

/// A motion along a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The motion, with its certified curve in joint space.
    pub timed: TimedMotion,
    /// Proven upper bound on the distance between the tip's path and the line, metres.
    pub deviation: f64,
    /// The places where the arm changes its IK solution.
    pub changes: Vec<Place>,
    /// Number of waypoints of the path in joint space.
    pub waypoints: usize,
    /// Proven upper bound on the difference between the tool's angle and the required one, radians; `None` without a
    /// wrist.
    pub tool_deviation: Option<f64>,
}

/// The answer about a line.
pub type Followed = Outcome<Found, Infeasible>;

/// Returns a motion whose tip follows a line, or a proof that no motion does.
///
/// The motion begins and ends at rest at the ends of the line. It keeps the scene's clearance. The time for planning is
/// proportional to the length of the line and to `1 / sqrt(tolerance)`.
///
/// # Errors
/// [`FollowError`]: unusable settings, or a motion that cannot be timed.
pub fn follow(scene: &Scene, path: &Toolpath, settings: &Settings) -> Result<Followed, FollowError> {
    settings.check()?;
    let (kinematics, line) = (Kinematics::new(scene.arm()), Line::new(path));
    let follower = Follower { scene, kinematics: &kinematics, line: &line, settings, ends: None };
    let prove = |prover: &Prover, _: &Search| prover.prove().or_else(|| follower.prove_finely(prover));
    follower.run(&prove, &|text, _| format!("`--tolerance {text}`"))
}

/// Like [`follow`], but from one configuration to another, which must put the tip at the ends of the line. Whole turns
/// of continuous joints do not count. If no motion exists, returns the reason in words.
///
/// # Errors
/// [`FollowError`]: unusable settings, or a motion that cannot be timed.
pub fn follow_between(
    scene: &Scene,
    path: &Toolpath,
    settings: &Settings,
    ends: [Configuration; 2],
) -> Result<Outcome<Found, String>, FollowError> {
    settings.check()?;
    let (kinematics, line) = (Kinematics::new(scene.arm()), Line::new(path));
    let follower = Follower { scene, kinematics: &kinematics, line: &line, settings, ends: Some(ends) };
    let prove = |prover: &Prover, search: &Search| {
        let sheet = |end: usize| (0..prover.sheets.sheets.len()).find(|sheet| search.is_end(end, *sheet));
        let between = sheet(0).zip(sheet(1)).and_then(|(from, to)| prover.prove_between([from, to]));
        let whole = || prover.prove().or_else(|| follower.prove_finely(prover));
        between.or_else(|| whole().map(String::from))
    };
    let option = |_: &str, tolerance: f64| format!("`tolerance = {tolerance}`");
    follower.run(&prove, &option)
}
