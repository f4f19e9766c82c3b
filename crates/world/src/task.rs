//! Converts the steps of a world to a task for its arm.

use super::reasons::{
    HELP_FOR_LIMITS, HELP_FOR_TIP, beyond_limits, describe_out_of_reach, help_for_reach, within_limits,
};
use super::requirement::{Required, Requirement};
use super::tool_values::require_free_lowered;
use super::{LoadedScene, Overrides, World};
use cplan_geometry::Point;
use cplan_handling::{Payload, Stroke, Task};
use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Goal, Scene, inverse};
use cplan_robot::{Diagnostic, DiagnosticKind, InputError, RobotReport};
use cplan_text::listed;

/// A task, and how it was read.
#[derive(Debug, Clone)]
pub struct LoadedTask {
    /// The task. Its start is within the limits and free, unless it comes from [`LoadedScene::recorded_task`].
    pub task: Task,
    /// The arm, empty-handed, among obstacles and objects at their initial places.
    pub scene: Scene,
    /// Report on how the robot was read.
    pub robot: RobotReport,
    /// Notes for the user about defaults.
    pub notes: Vec<String>,
}

impl LoadedScene {
    /// Returns true if the world is a task: it has steps, or its start or goal states values of the tool's joints. Then the
    /// task is a move to the goal.
    #[must_use]
    pub fn is_task(&self) -> bool {
        self.world.is_task()
    }

    /// Returns true if the world has steps. Such a world has no goal.
    #[must_use]
    pub fn has_steps(&self) -> bool {
        self.world.steps.is_some()
    }

    /// Returns the task of the world's steps, or of its move from the start to the goal. A start on the command line overrides that of the world.
    ///
    /// # Errors
    /// - A world that is no task, or a goal on the command line for a world with steps.
    /// - Values of the tool's joints that are outside their limits, or of joints that the world does not name.
    /// - A start that is missing, outside the limits or blocked.
    /// - A step that requires joint values outside the limits, or a point out of the tip's reach.
    /// - A step that requires that an object rests on something, although the object is too thin.
    pub fn task(self, overrides: &Overrides) -> Result<LoadedTask, InputError> {
        self.task_from(overrides, true)
    }

    /// Returns the task with which a recording is compared. Its start may be outside the limits or blocked; the check
    /// of the recording reports that.
    ///
    /// # Errors
    /// The errors of [`LoadedScene::task`] that do not concern the start.
    pub fn recorded_task(self, overrides: &Overrides) -> Result<LoadedTask, InputError> {
        self.task_from(overrides, false)
    }

    fn task_from(self, overrides: &Overrides, is_checked: bool) -> Result<LoadedTask, InputError> {
        if !self.is_task() {
            let diagnostic = self.world.source.diagnostic("there are no steps");
            return Err(diagnostic.help("[[step]] pick = \"NAME\", and so on").into());
        }
        if self.world.steps.is_some() && (overrides.goal.is_some() || overrides.goal_tip.is_some()) {
            return Err(self.has_no_goal(overrides).into());
        }
        let loaded = self.with_clearance(overrides.clearance)?;
        let mut notes = loaded.world.notes.clone();
        let (start, place) = loaded.start(overrides, &mut notes)?;
        if is_checked {
            let is_free = loaded.require("the start", start, &place).and_then(|()| loaded.require_clear(start, &place));
            is_free.map_err(|diagnostic| diagnostic.with_kind(DiagnosticKind::Start))?;
        }
        let [start_tool, goal_tool] = loaded.tool_values()?;
        let start_refused = place.diagnostic(String::new()).with_kind(DiagnosticKind::Start);
        let own_move = if loaded.world.steps.is_none() {
            let (goals, place) = loaded.goals(overrides).map_err(|error| error.with_kind(DiagnosticKind::Goal))?;
            let step = LoadedScene::move_to_goal(&goals, &place, goal_tool)?;
            if let [Goal::Joints(q)] = goals[..] {
                let outside = beyond_limits(&loaded.scene, q);
                let message = format!("the goal is outside the joint limits: {}", outside.join("; "));
                InputError::check(
                    (!outside.is_empty())
                        .then(|| place.diagnostic(message).help(HELP_FOR_LIMITS))
                        .into_iter()
                        .collect(),
                )?;
            }
            Some(step)
        } else {
            None
        };
        let requirements = loaded.world.steps.iter().flat_map(|steps| &steps.requirements);
        InputError::check(requirements.filter_map(|r| loaded.unmet_requirement(r, start)).collect())?;
        let wrist = loaded.wrist();
        let Self { scene, world, robot, .. } = loaded;
        let stroke = robot.joints.stroke.clone();
        if let Some(stroke) = &stroke {
            InputError::check(too_deep(stroke, &world).collect())?;
        }
        let mut workspace = world.workspace;
        workspace.fixed.clearance = scene.workspace().clearance;
        let items = world.steps.map_or_else(|| own_move.into_iter().collect(), |steps| steps.items);
        notes.extend(world.wrist.and_then(|(_, note)| note));
        let task = Task {
            arm: scene.arm().clone(),
            workspace,
            objects: world.objects,
            start,
            items,
            wrist,
            stroke,
            start_tool,
        };
        if let Some((mover, why)) = task.static_only_feature() {
            let help = "remove its motion, or the feature that needs static obstacles";
            return Err(world.source.diagnostic(format!("\"{mover}\" moves, and {why}")).help(help).into());
        }
        if let Err(error) = task.check_tool() {
            let help = "raise the limits of [robot] stroke and wrist, or of their joints";
            return Err(world.source.diagnostic(error.to_string()).help(help).into());
        }
        if is_checked {
            require_free_lowered(&task, start_refused)?;
        }
        Ok(LoadedTask { task, scene, robot, notes })
    }

    /// Returns the reason why the arm cannot satisfy a requirement. `None` if it can.
    fn unmet_requirement(&self, requirement: &Requirement, start: Configuration) -> Option<Diagnostic> {
        let step = format!("step {}", requirement.step);
        let (message, help) = match requirement.required {
            Required::Joints(q) => self.beyond_limits(&step, q)?,
            Required::Tip(tip) => self.beyond_reach(&step, tip, start)?,
            Required::Rest(object) => self.too_thin(&step, object)?,
        };
        Some(self.world.source.diagnostic_at(requirement.at.clone(), message).help(help))
    }

    fn beyond_limits(&self, step: &str, q: Configuration) -> Option<(String, String)> {
        let outside = beyond_limits(&self.scene, q);
        (!outside.is_empty())
            .then(|| (format!("{step} is outside the joint limits: {}", outside.join("; ")), HELP_FOR_LIMITS.into()))
    }

    fn beyond_reach(&self, step: &str, tip: Point, start: Configuration) -> Option<(String, String)> {
        let solved = inverse(self.scene.arm(), tip, start);
        if solved.branches.is_empty() {
            return Some((
                describe_out_of_reach(&self.scene, &format!("{step}:"), tip),
                help_for_reach(&self.scene, tip),
            ));
        }
        // If a joint's value does not matter, another value may be within the limits.
        let (allowed, outside) = within_limits(&self.scene, &solved);
        (allowed.is_empty() && solved.free.is_none()).then(|| {
            let message = format!(
                "{step}: no IK solution that puts the tip at ({}, {}) m is within the joint limits: {}",
                tip.x,
                tip.y,
                listed(&outside)
            );
            (message, HELP_FOR_TIP.into())
        })
    }

    fn too_thin(&self, step: &str, object: usize) -> Option<(String, String)> {
        let object = &self.world.objects[object];
        let arm = self.scene.arm();
        if object.can_rest(arm) {
            return None;
        }
        let by = Payload::penetration_allowance(arm);
        let message = format!(
            "{step}: object \"{}\" is too thin to rest on a support: it may press {by:.2e} m into its supports, and no part of it is that thick",
            object.name
        );
        Some((message, "make it thicker, or remove its supports".into()))
    }
}

/// Iterates over diagnostics about objects that the tool cannot reach, because its joint cannot lower it so far.
fn too_deep<'a>(stroke: &'a Stroke, world: &'a World) -> impl Iterator<Item = Diagnostic> + 'a {
    let joint = &stroke.joint;
    world.objects.iter().filter_map(|object| {
        let JointRange::Interval { lower, upper } = joint.range else { return None };
        let (depth, at) = (stroke.depth(object), stroke.lowered(stroke.depth(object)));
        let message = format!(
            "[robot] stroke: for object \"{}\" the tool is lowered by {depth} m, which takes joint \"{}\" to {at} m, outside its \
             limits [{lower}, {upper}] m",
            object.name, joint.name
        );
        let help = "choose another fixed value of the joint, less travel, or less lift of the object";
        (!stroke.reaches(object)).then(|| world.source.diagnostic(message).help(help))
    })
}
