//! Checks that start and goal are within the limits and free. Finds every IK solution for a goal of the tip.

use super::reasons::{
    HELP_FOR_LIMITS, Notation, beyond_limits, describe, describe_out_of_reach, describe_segment, help_at,
    help_for_ik_solutions, help_for_limits, help_for_reach, obstructions, within_limits,
};
use super::{AllowedErrors, JointValues, LoadedProblem, LoadedScene, Overrides};
use cplan_geometry::Point;
use cplan_model::space::{Configuration, GoalSet, Segment};
use cplan_model::{BlockedStretch, Elbow, Freedom, Goal, MotionProblem, Scene, area_goals, inverse};
use cplan_robot::{Diagnostic, DiagnosticKind, InputError};
use cplan_text::{first_lines, listed};
use std::fmt::Write;
use std::ops::Range;
use std::sync::Arc;

/// The source of a value: the command line or the world file.
pub(super) enum Place<'a> {
    Option(&'static str),
    /// An option that gives joint values.
    Joints(&'static str, JointValues),
    World(&'a LoadedScene, Range<usize>),
}

impl Place<'_> {
    pub(super) fn diagnostic(&self, message: String) -> Diagnostic {
        match self {
            Place::Option(name) | Place::Joints(name, _) => Diagnostic::new(*name, message),
            Place::World(loaded, at) => loaded.world.source.diagnostic_at(at.clone(), message),
        }
    }

    /// Returns the notation of joint values from this source.
    pub(super) fn notation(&self) -> Notation {
        match self {
            Place::Option(_) => Notation::default(),
            Place::Joints(_, values) => values.notation(),
            Place::World(loaded, at) => Notation::in_world(&loaded.world, at),
        }
    }
}

/// A command's requirements on start, goal and steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rules {
    /// The start is free. A world with steps, or with values of the tool's joints, gives a task; any other world gives a motion,
    /// whose goals are free, too.
    Plan,
    /// A motion whose start and goals are free.
    Motion,
    /// A motion that may lack a goal. Start and goals are free, and no obstacle moves.
    Exploration,
    /// Start and goals as stated, which may be blocked.
    Unchecked,
    /// Only the start counts, which may be blocked; it is also the goal. The world may have steps.
    Start,
    /// The task with which a recording is compared. Its start may be blocked or outside the limits: the check of the recording
    /// reports this.
    Recording,
}

impl LoadedScene {
    /// Reads the motion or the task of this scene. Values on the command line override those of the world file.
    ///
    /// # Errors
    /// - A world with steps or values of the tool's joints, unless the rules allow a task.
    /// - A goal on the command line for a world with steps.
    /// - A start that is missing.
    /// - Unless the rules say otherwise: a goal that is missing; a start or goal outside the joint limits, in contact
    ///   with an obstacle or nearer to one than the clearance; a goal of the tip that no IK solution reaches. The
    ///   message states which link hits which obstacle, and how deep.
    /// - Values of the tool's joints that are outside their limits, or of joints that the world does not name.
    /// - A step that requires joint values outside the limits, or a point out of the tip's reach.
    /// - A step that requires that an object rests on something, although the object is too thin.
    pub fn resolve(self, overrides: &Overrides, rules: Rules) -> Result<LoadedProblem, InputError> {
        if rules == Rules::Exploration {
            self.require_static_obstacles("explorations need static obstacles")?;
            self.require_real_shapes()?;
        }
        let may_be_task = matches!(rules, Rules::Plan | Rules::Start | Rules::Recording);
        let overrides_goal = overrides.goal.is_some() || overrides.goal_tip.is_some();
        if self.is_task() && !may_be_task || self.has_steps() && overrides_goal {
            return Err(self.has_no_goal(overrides).into());
        }
        let loaded = self.with_margins(overrides.clearance, overrides.calibration)?;
        let mut notes = loaded.world.notes.clone();
        let (start, place) = loaded.start(overrides, &mut notes)?;
        let is_checked = matches!(rules, Rules::Plan | Rules::Motion | Rules::Exploration);
        if is_checked {
            let is_free = loaded.require("the start", start, &place).and_then(|()| loaded.require_clear(start, &place));
            is_free.map_err(|diagnostic| diagnostic.with_kind(DiagnosticKind::Start))?;
        }
        let errors = loaded.allowed_errors(overrides, rules);
        let (mut stated_goals, mut goals, mut task) = (Vec::new(), GoalSet::default(), None);
        match rules {
            Rules::Start => stated_goals.push(Goal::Joints(start)),
            Rules::Unchecked => stated_goals = loaded.stated_goals(overrides, &mut notes)?,
            Rules::Exploration if loaded.world.goals.is_none() && !overrides_goal => {}
            _ if loaded.is_task() => task = Some(loaded.task(overrides, (start, &place), is_checked, &mut notes)?),
            _ => goals = loaded.free_goals(overrides, start, &mut notes)?,
        }
        let Self { scene, trajectories, robot, .. } = loaded;
        let problem = MotionProblem::trusted(scene, start, goals);
        Ok(LoadedProblem { problem, stated_goals, task, trajectories, robot, notes, errors })
    }

    /// Returns the errors for which motions must be free, and the problem without these errors.
    fn allowed_errors(&self, overrides: &Overrides, rules: Rules) -> Option<AllowedErrors> {
        if !self.world.has_errors() || !matches!(rules, Rules::Plan | Rules::Motion) {
            return None;
        }
        let (robot, obstacles) = (self.world.calibration.of_robot(), self.world.greatest_displacement());
        let mut world = self.world.clone();
        world.remove_errors();
        let drawn = Self::unchecked(world, self.arm.clone(), self.robot.clone());
        let overrides = Overrides { clearance: None, calibration: None, ..overrides.clone() };
        let drawn = drawn.resolve(&overrides, rules).ok().map(|drawn| Arc::new(drawn.problem));
        Some(AllowedErrors { robot, obstacles, drawn })
    }

    /// Reads start and goal of a motion: [`LoadedScene::resolve`] by [`Rules::Motion`].
    ///
    /// # Errors
    /// The errors of [`LoadedScene::resolve`].
    pub fn problem(self, overrides: &Overrides) -> Result<LoadedProblem, InputError> {
        self.resolve(overrides, Rules::Motion)
    }

    /// Returns the stated goals. Values beyond a limit by a rounding error are set to the limit, with a note.
    fn stated_goals(&self, overrides: &Overrides, notes: &mut Vec<String>) -> Result<Vec<Goal>, InputError> {
        let (mut goals, _) = self.goals(overrides)?;
        for goal in &mut goals {
            if let Goal::Joints(q) = goal {
                *q = self.at_limits("the goal", *q, notes);
            }
        }
        Ok(goals)
    }

    /// Returns the configurations that reach a goal and are not known to be blocked. There is at least one.
    fn free_goals(
        &self,
        overrides: &Overrides,
        start: Configuration,
        notes: &mut Vec<String>,
    ) -> Result<GoalSet, InputError> {
        let (asked, place) = self.goals(overrides)?;
        let (mut goals, mut refused) = (Vec::new(), Vec::new());
        for goal in &asked {
            match self.configurations(*goal, start, &place, notes) {
                Ok(found) => goals.extend_from_slice(found.pieces()),
                Err(diagnostic) => refused.push(diagnostic),
            }
        }
        // In a world with errors, a refused goal may be free for some of them. A proof of infeasibility would miss it.
        if goals.is_empty() || self.world.has_errors() && !refused.is_empty() {
            // `refused` is not empty, since there is at least one goal.
            return Err(refused.swap_remove(0).with_kind(DiagnosticKind::Goal).into());
        }
        notes.extend(refused.iter().map(|diagnostic| format!("a goal is ruled out: {}", diagnostic.message)));
        Ok(goals.into_iter().collect())
    }

    /// Returns the configurations that reach a goal and are not known to be blocked.
    fn configurations(
        &self,
        goal: Goal,
        start: Configuration,
        place: &Place,
        notes: &mut Vec<String>,
    ) -> Result<GoalSet, Diagnostic> {
        match goal.of_arm(self.scene.arm()) {
            Goal::Joints(q) => {
                let q = self.at_limits("the goal", q, notes);
                self.require("the goal", q, place)?;
                Ok(GoalSet::from(q))
            }
            Goal::Tip(tip) => {
                if let Goal::Area([low, high]) = goal
                    && low != high
                {
                    let arm = "this arm does not slide along both axes, so";
                    notes.push(format!("{arm} the goal is the middle of the goal area: ({}, {})", tip.x, tip.y));
                }
                self.ik_solutions((tip, None), start, place, notes)
            }
            Goal::TipAndElbow(tip, elbow) => self.ik_solutions((tip, Some(elbow)), start, place, notes),
            Goal::Area(area) => self.area(area, start, place),
        }
    }

    /// Returns the configurations that put the tip on the boundary of a rectangle and are not known to be blocked. If the start
    /// has the tip inside the rectangle, includes the start.
    fn area(&self, area: [Point; 2], start: Configuration, place: &Place) -> Result<GoalSet, Diagnostic> {
        let [low, high] = area;
        let shown = format!("the goal area from ({}, {}) to ({}, {})", low.x, low.y, high.x, high.y);
        let rim = area_goals(self.scene.arm(), area, start);
        if rim.is_empty() {
            let message = format!("{shown} is outside the joint limits");
            return Err(place.diagnostic(message).help(HELP_FOR_LIMITS));
        }
        let (mut goals, mut blocked) = (Vec::new(), Vec::new());
        for piece in rim.pieces() {
            match blocked_all_along(&self.scene.inner(), piece) {
                Some(reasons) => blocked.extend(reasons),
                None => goals.push(*piece),
            }
        }
        if goals.is_empty() {
            let message =
                format!("the tip cannot enter {shown}, because its whole boundary is blocked: {}", listed(&blocked));
            return Err(place.diagnostic(message).help("move the area or the obstacles"));
        }
        Ok(goals.into_iter().collect())
    }

    /// Returns the alternative goals, at least one.
    pub(super) fn goals(&self, overrides: &Overrides) -> Result<(Vec<Goal>, Place<'_>), InputError> {
        self.given_goals(overrides).map_err(|error| error.with_kind(DiagnosticKind::Goal))
    }

    fn given_goals(&self, overrides: &Overrides) -> Result<(Vec<Goal>, Place<'_>), InputError> {
        match (&overrides.goal, overrides.tip_goal()) {
            (Some(_), Some(_)) => {
                let diagnostic = Diagnostic::new("--goal and --goal-tip", "both options give a goal");
                return Err(diagnostic.help("give one of them").into());
            }
            (Some(values), None) => {
                let q = values.resolve(&self.scene.arm().joints, "--goal")?;
                return Ok((vec![Goal::Joints(q)], Place::Joints("--goal", *values)));
            }
            (None, Some(goal)) => {
                let place = Place::Option("--goal-tip");
                self.require_elbow(&goal, &place)?;
                return Ok((vec![goal], place));
            }
            (None, None) => {}
        }
        match &self.world.goals {
            Some((goals, at)) => {
                let place = Place::World(self, at.clone());
                goals.iter().try_for_each(|goal| self.require_elbow(goal, &place))?;
                Ok((goals.clone(), place))
            }
            None => {
                let help =
                    "[goal] joints = [q1, q2] or tip = [x, y] in the world file, or --goal q1,q2, or --goal-tip x,y";
                Err(self.missing("goal", help).into())
            }
        }
    }

    /// Checks that the arm has an elbow if a goal states a side of the elbow.
    pub(super) fn require_elbow(&self, goal: &Goal, place: &Place) -> Result<(), Diagnostic> {
        match goal.elbow().and_then(|_| no_elbow(&self.scene)) {
            Some((message, help)) => Err(place.diagnostic(format!("the goal: {message}")).help(help)),
            None => Ok(()),
        }
    }

    /// Returns the diagnostic about a goal in a world with steps.
    pub(super) fn has_no_goal(&self, overrides: &Overrides) -> Diagnostic {
        if self.world.steps.is_none() {
            let message =
                "this world states values of the tool's joints; only `cplan plan` and `cplan verify` support them";
            let help = "for other commands remove `stroke` and `wrist` from [start] and [goal]";
            return self.world.source.diagnostic(message).help(help);
        }
        let message = "this world has steps, not a goal";
        let option = match (&overrides.goal, &overrides.goal_tip) {
            (Some(_), _) => "--goal",
            (None, Some(_)) => "--goal-tip",
            (None, None) => {
                let at = self.world.steps.as_ref().map_or(0..0, |steps| steps.at.clone());
                let help = "use `cplan plan`, which plans steps, or replace the steps by a [goal]";
                return self.world.source.diagnostic_at(at, message).help(help);
            }
        };
        Diagnostic::new(option, message).help("leave the option out, or remove the steps from the world")
    }

    pub(super) fn missing(&self, what: &str, help: &str) -> Diagnostic {
        self.world.source.diagnostic(format!("there is no {what}")).help(help)
    }

    pub(super) fn require(&self, what: &str, q: Configuration, place: &Place) -> Result<(), Diagnostic> {
        let outside = beyond_limits(&self.scene, q);
        if !outside.is_empty() {
            let message = format!("{what} is outside the joint limits: {}", outside.join("; "));
            let help = help_for_limits(&self.scene, q, place.notation());
            return Err(place.diagnostic(message).help(help));
        }
        let hits = obstructions(&self.scene, q);
        if !hits.is_empty() {
            let message = format!("{what} ({}) is not free: {}", describe(&self.scene, q), listed(&hits));
            return Err(place.diagnostic(message).help(help_at(&self.scene, q)));
        }
        Ok(())
    }

    /// Returns true if an obstacle moves.
    pub(super) fn has_moving_obstacles(&self) -> bool {
        !self.trajectories.is_empty()
    }

    /// Checks that no obstacle moves. Called by functions that ignore time; `what` names the function.
    ///
    /// # Errors
    /// A moving obstacle.
    pub fn require_static_obstacles(&self, what: &str) -> Result<(), InputError> {
        let Some(mover) = self.scene.loose_obstacles().first() else { return Ok(()) };
        let message = format!("{what}, but obstacle \"{}\" moves", mover.obstacle.name);
        let help =
            "remove the motion, or use `cplan plan`, `cplan verify` or `cplan check`, which allow moving obstacles";
        Err(self.world.source.diagnostic(message).help(help).into())
    }

    /// Checks that no obstacle is grown by errors. An exploration's sensor must see obstacles in their real size.
    fn require_real_shapes(&self) -> Result<(), InputError> {
        let grown = self.scene.workspace().obstacles.iter().find(|obstacle| obstacle.growth.total > 0.0);
        if grown.is_none() && !self.world.has_errors() {
            return Ok(());
        }
        let message = "explorations support neither errors (calibration) nor clearances of single obstacles";
        let help = "give the world a clearance that covers them";
        Err(self.world.source.diagnostic(message).help(help).into())
    }

    /// Checks that no moving obstacle is at the arm's start at time 0.
    pub(super) fn require_clear(&self, start: Configuration, place: &Place) -> Result<(), Diagnostic> {
        let hits = self.timed().obstructions(start, 0.0);
        if hits.is_empty() {
            return Ok(());
        }
        let hits: Vec<String> = hits.iter().map(|hit| self.scene.explain(hit)).collect();
        let message = format!(
            "the start ({}) is not free when the motion begins: {}",
            describe(&self.scene, start),
            listed(&hits)
        );
        Err(place.diagnostic(message).help("change the obstacle's initial position, or choose another start"))
    }

    /// Returns every IK solution for `tip` with the elbow on the stated side that is within the limits and not proven to be
    /// blocked.
    fn ik_solutions(
        &self,
        (tip, elbow): (Point, Option<Elbow>),
        start: Configuration,
        place: &Place,
        notes: &mut Vec<String>,
    ) -> Result<GoalSet, Diagnostic> {
        let scene = &self.scene;
        let solved = inverse(scene.arm(), tip, start);
        let at = format!("({}, {}){}", tip.x, tip.y, Elbow::describe(elbow));
        if solved.branches.is_empty() {
            return Err(place
                .diagnostic(describe_out_of_reach(scene, "the goal", tip))
                .help(help_for_reach(scene, tip)));
        }
        let other = elbow.map(|elbow| solved.clone().with_elbow(scene.arm(), Some(elbow.other())));
        let solved = solved.with_elbow(scene.arm(), elbow);
        notes.extend(solved.free.map(|free| freedom(scene, &at, free)));
        let (allowed, outside) = within_limits(scene, &solved);
        let (mut goals, mut undecided, mut blocked) = (Vec::new(), Vec::new(), Vec::new());
        for piece in allowed {
            match blocked_all_along(scene, &piece) {
                Some(reasons) => {
                    undecided.extend(blocked_all_along(&scene.inner(), &piece).is_none().then_some(piece));
                    blocked.extend(reasons);
                }
                None => goals.push(piece),
            }
        }
        if goals.is_empty() {
            let mut help = help_for_ik_solutions(scene, !outside.is_empty(), !blocked.is_empty());
            let reasons = listed(&[outside, blocked].concat());
            let mut message = format!("no IK solution for the tip at {at} is within the limits and free: {reasons}");
            if let (Some(elbow), Some(other)) = (elbow.map(Elbow::other), other) {
                let free = within_limits(scene, &other).0.into_iter().map(|piece| piece.at(0.5));
                if let Some(q) = free.into_iter().find(|q| scene.obstructions(*q).is_empty()) {
                    let _ = write!(message, "; with the elbow on the {}, {} is free", elbow.name(), describe(scene, q));
                    help = format!("choose the other side of the elbow; or {help}");
                }
            }
            return Err(place.diagnostic(message).help(help));
        }
        let ruled_out = |reason: String| format!("one IK solution for the tip at {at} cannot be used: {reason}");
        let reasons = outside.into_iter().chain(blocked).map(ruled_out).collect();
        notes.extend(first_lines(reasons, |more| format!("and so are {more} more")));
        // A motion cannot end at an undecided goal, but a proof of infeasibility must rule it out.
        Ok(goals.into_iter().chain(undecided).collect())
    }
}

pub(super) fn no_elbow(scene: &Scene) -> Option<(&'static str, &'static str)> {
    let is_absent = !scene.arm().only_turns();
    is_absent.then_some(("only arms with two revolute joints have an elbow", "leave out its side"))
}

/// Explains which values the joints may have while the tip stays at a place.
fn freedom(scene: &Scene, at: &str, free: Freedom) -> String {
    let name = |joint: usize| &scene.arm().joints[joint].name;
    match free {
        Freedom::Joint(joint) => {
            format!("the tip is at {at} for all values of joint \"{}\", so any free value of it is a goal", name(joint))
        }
        Freedom::Share => format!(
            "joints \"{}\" and \"{}\" turn about the same axis, so the tip is at {at} for all values with the same sum; any free pair of such values is a goal",
            name(0),
            name(1)
        ),
        Freedom::Both => format!("the tip is at {at} in every configuration, so the start is the goal"),
    }
}

/// Explains why each part of a segment is blocked. Returns `None` if it is not proven that the whole segment is
/// blocked.
fn blocked_all_along(scene: &Scene, piece: &Segment) -> Option<Vec<String>> {
    if piece.is_point() {
        let [q, _] = piece.ends();
        let hits = obstructions(scene, q);
        return (!hits.is_empty()).then(|| vec![format!("({}): {}", describe(scene, q), listed(&hits))]);
    }
    let reason = |blocked: &BlockedStretch| {
        format!("({}): {}", describe_segment(scene, &blocked.stretch), scene.explain(&blocked.obstruction))
    };
    Some(scene.blocked_along(piece)?.iter().map(reason).collect())
}
