//! The start of the arm: joint values, or a tip position that has only one IK solution.

use super::problem::Place;
use super::reasons::{
    describe, describe_out_of_reach, help_for_ik_solutions, help_for_reach, obstructions, within_limits,
};
use super::{LoadedScene, Overrides};
use cplan_geometry::Point;
use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Goal, inverse};
use cplan_robot::{Diagnostic, DiagnosticKind, InputError};
use cplan_text::listed;

/// Largest excess over a limit, in radians or metres, that counts as rounding and is removed. It covers values with nine digits,
/// and is far below the resolution of any drive.
const LIMIT_ROUNDING: f64 = 1e-9;

/// Largest number of IK solutions that a message lists. A message about more states only how many.
const MAX_LISTED_SOLUTIONS: usize = 6;

impl LoadedScene {
    /// Returns the start and the first goal as joint values. An entry is `None` if it is missing or given as a tip
    /// position.
    pub fn resolved_ends(&self) -> [Option<Configuration>; 2] {
        self.stated_ends().map(|end| match end {
            Some(Goal::Joints(q)) => Some(q),
            _ => None,
        })
    }

    /// Returns the start, which must be within the limits, and where it is stated. Values beyond a limit by a rounding error are
    /// set to the limit, with a note.
    pub(super) fn start(
        &self,
        overrides: &Overrides,
        notes: &mut Vec<String>,
    ) -> Result<(Configuration, Place<'_>), InputError> {
        let (start, place) =
            self.given_start(overrides, notes).map_err(|error| error.with_kind(DiagnosticKind::Start))?;
        Ok((self.at_limits("the start", start, notes), place))
    }

    fn given_start(
        &self,
        overrides: &Overrides,
        notes: &mut Vec<String>,
    ) -> Result<(Configuration, Place<'_>), InputError> {
        if let Some(values) = &overrides.start {
            return Ok((values.resolve(&self.scene.arm().joints, "--start")?, Place::Joints("--start", *values)));
        }
        let Some((start, at)) = &self.world.start else {
            return Err(self.missing("start", "[start] joints = [q1, q2] in the world file, or --start q1,q2").into());
        };
        let place = Place::World(self, at.clone());
        let q = match start {
            Goal::Joints(q) => *q,
            Goal::Tip(tip) => self.only_ik_solution(*tip, &place, notes)?,
            // A start cannot be an area or state a side of the elbow.
            Goal::TipAndElbow(corner, _) | Goal::Area([corner, _]) => self.only_ik_solution(*corner, &place, notes)?,
        };
        Ok((q, place))
    }

    /// Sets values that exceed a limit by a rounding error to the limit.
    pub(super) fn at_limits(&self, what: &str, q: Configuration, notes: &mut Vec<String>) -> Configuration {
        let joints = &self.scene.arm().joints;
        Configuration::from_fn(|i, _| {
            let JointRange::Interval { lower, upper } = joints[i].range else { return q[i] };
            let nearest = q[i].clamp(lower, upper);
            if nearest == q[i] || (q[i] - nearest).abs() > LIMIT_ROUNDING {
                return q[i];
            }
            let (name, unit) = (&joints[i].name, joints[i].unit());
            notes.push(format!(
                "{what}: joint \"{name}\" at {} {unit} exceeds its limit by a rounding error; {nearest} {unit} is used",
                q[i]
            ));
            nearest
        })
    }

    /// Returns the IK solution for a tip position. Exactly one solution must be within the limits and free.
    fn only_ik_solution(
        &self,
        tip: Point,
        place: &Place,
        notes: &mut Vec<String>,
    ) -> Result<Configuration, Diagnostic> {
        let scene = &self.scene;
        let solved = inverse(scene.arm(), tip, Configuration::zeros());
        let at = format!("({}, {})", tip.x, tip.y);
        if solved.branches.is_empty() {
            return Err(place
                .diagnostic(describe_out_of_reach(scene, "the start", tip))
                .help(help_for_reach(scene, tip)));
        }
        if solved.free.is_some() {
            let message = format!("the start is not unique: infinitely many IK solutions put the tip at {at}");
            return Err(place.diagnostic(message).help("give the start's joint values: joints = [q1, q2]"));
        }
        let (allowed, outside) = within_limits(scene, &solved);
        // No joint is free, so each solution is a single configuration.
        let allowed: Vec<Configuration> = allowed.iter().map(|ik_solution| ik_solution.ends()[0]).collect();
        let (free, blocked): (Vec<_>, Vec<_>) = allowed.into_iter().partition(|q| obstructions(scene, *q).is_empty());
        match free[..] {
            [only] => {
                notes.push(format!("the start is {}, the only IK solution for the tip at {at}", describe(scene, only)));
                Ok(only)
            }
            [] => {
                let hits =
                    |q: &Configuration| format!("({}): {}", describe(scene, *q), listed(&obstructions(scene, *q)));
                let help = help_for_ik_solutions(scene, !outside.is_empty(), !blocked.is_empty());
                let why: Vec<String> = outside.into_iter().chain(blocked.iter().map(hits)).collect();
                let message =
                    format!("no IK solution for the tip at {at} is within the limits and free: {}", listed(&why));
                Err(place.diagnostic(message).help(help))
            }
            _ => {
                let listed: Vec<String> =
                    free.iter().take(MAX_LISTED_SOLUTIONS).map(|q| format!("joints = [{}, {}]", q[0], q[1])).collect();
                let more = if free.len() > MAX_LISTED_SOLUTIONS { ", ..." } else { "" };
                let message = format!("the start is not unique: {} IK solutions put the tip at {at}", free.len());
                Err(place.diagnostic(message).help(format!("give joint values: {}{more}", listed.join(", or "))))
            }
        }
    }
}
