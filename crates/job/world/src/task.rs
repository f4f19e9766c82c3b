//! Converts the steps of a world to a task for its arm.

use super::problem::{Place, no_elbow};
use super::reasons::{
    HELP_FOR_TIP, Notation, beyond_limits, describe_out_of_reach, help_for_limits, help_for_reach, within_limits,
};
use super::requirement::{Required, Requirement};
use super::tool_values::require_free_lowered;
use super::{LoadedScene, Overrides, World};
use cplan_geometry::Point;
use cplan_handling::{Item, Object, Payload, Stroke, Task, ToolJoint, ToolValues};
use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Elbow, Goal, RESTING_TOLERANCE, inverse};
use cplan_robot::{Diagnostic, DiagnosticKind, InputError};
use cplan_text::{length, listed, short};

impl LoadedScene {
    /// Returns true if the world is a task: it has steps, or its start or goal states values of the tool's joints. Without steps,
    /// the task is a move to the goal.
    pub fn is_task(&self) -> bool {
        self.world.is_task()
    }

    /// Returns true if the world has steps. Such a world has no goal.
    pub fn has_steps(&self) -> bool {
        self.world.steps.is_some()
    }

    /// Returns the task: the world's steps, or a move from the start to the goal. Unless `is_checked`, the tool may hit something
    /// at the start.
    pub(super) fn task(
        &self,
        overrides: &Overrides,
        (start, place): (Configuration, &Place),
        is_checked: bool,
        notes: &mut Vec<String>,
    ) -> Result<Task, InputError> {
        let [start_tool, goal_tool] = self.tool_values()?;
        let items = match &self.world.steps {
            Some(steps) => steps.items.clone(),
            None => vec![self.own_move(overrides, goal_tool)?],
        };
        let requirements = self.world.steps.iter().flat_map(|steps| &steps.requirements);
        InputError::check(requirements.filter_map(|r| self.unmet_requirement(r, start)).collect())?;
        let stroke = self.robot.joints.stroke.clone();
        if let Some(stroke) = &stroke {
            InputError::check(too_deep(stroke, &self.world).collect())?;
        }
        let mut workspace = self.world.workspace.clone();
        workspace.fixed.clearance = self.scene.workspace().clearance;
        let workspace = workspace.grown();
        notes.extend(self.world.wrist.iter().filter_map(|(_, note)| note.clone()));
        notes.extend(stroke.iter().flat_map(|stroke| lifted_higher(stroke, &self.world.objects)));
        let task = Task {
            arm: self.scene.arm().clone(),
            workspace,
            objects: self.world.objects.clone(),
            start,
            items,
            wrist: self.wrist(),
            stroke,
            start_tool,
        };
        if let Some((mover, why)) = task.static_only_feature() {
            let help = "remove the motion, or the keys that need static obstacles";
            return Err(self.world.source.diagnostic(format!("\"{mover}\" moves, and {why}")).help(help).into());
        }
        if let Some((step, value)) = task.step_beyond_stroke() {
            let limits = task.stroke.as_ref().map_or_else(String::new, |stroke| limits(&stroke.joint));
            let message = format!(
                "step {} ({}): the tool would be lowered to {} m, outside the {limits}",
                step.number,
                step.place,
                short(value)
            );
            let help = "change the height of the place, the fixed value of the joint, or the travel";
            return Err(self.world.source.diagnostic(message).help(help).into());
        }
        if let Err(error) = task.check_tool() {
            let help = "raise the limits of [robot] stroke and wrist, or of their joints";
            return Err(self.world.source.diagnostic(error.to_string()).help(help).into());
        }
        if is_checked {
            require_free_lowered(&task, place.diagnostic(String::new()).with_kind(DiagnosticKind::Start))?;
        }
        Ok(task)
    }

    /// Returns the only step of a task without steps: a move to the goal.
    fn own_move(&self, overrides: &Overrides, tool: ToolValues) -> Result<Item, InputError> {
        let (goals, place) = self.goals(overrides)?;
        let step = Self::move_to_goal(&goals, &place, tool)?;
        if let [Goal::Joints(q)] = goals[..]
            && let Some((message, help)) = self.beyond_limits("the goal", q, place.notation())
        {
            return Err(place.diagnostic(message).help(help).into());
        }
        Ok(step)
    }

    /// Returns the reason why the arm cannot satisfy a requirement. `None` if it can.
    fn unmet_requirement(&self, requirement: &Requirement, start: Configuration) -> Option<Diagnostic> {
        let step = format!("step {}", requirement.step);
        let (message, help) = match requirement.required {
            Required::Joints(q) => self.beyond_limits(&step, q, Notation::in_world(&self.world, &requirement.at))?,
            Required::Tip(tip, elbow) => self.beyond_reach(&step, (tip, elbow), start)?,
            Required::Elbow => {
                no_elbow(&self.scene).map(|(message, help)| (format!("{step}: {message}"), help.to_owned()))?
            }
            Required::Rest(object) => self.too_thin(&step, object)?,
        };
        Some(self.world.source.diagnostic_at(requirement.at.clone(), message).help(help))
    }

    fn beyond_limits(&self, step: &str, q: Configuration, notation: Notation) -> Option<(String, String)> {
        let outside = beyond_limits(&self.scene, q);
        (!outside.is_empty()).then(|| {
            (
                format!("{step} is outside the joint limits: {}", outside.join("; ")),
                help_for_limits(&self.scene, q, notation),
            )
        })
    }

    fn beyond_reach(
        &self,
        step: &str,
        (tip, elbow): (Point, Option<Elbow>),
        start: Configuration,
    ) -> Option<(String, String)> {
        let solved = inverse(self.scene.arm(), tip, start);
        if solved.branches.is_empty() {
            return Some((
                describe_out_of_reach(&self.scene, &format!("{step}:"), tip),
                help_for_reach(&self.scene, tip),
            ));
        }
        let solved = solved.with_elbow(self.scene.arm(), elbow);
        // If a joint's value does not matter, another value may be within the limits.
        let (allowed, outside) = within_limits(&self.scene, &solved);
        (allowed.is_empty() && solved.free.is_none()).then(|| {
            let message = format!(
                "{step}: no IK solution for the tip at ({}, {}) m{} is within the joint limits: {}",
                tip.x,
                tip.y,
                Elbow::describe(elbow),
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
            "{step}: object \"{}\" is too thin to rest on a support: an object may press {by:.2e} m into its supports, but no part of this one is so thick",
            object.name
        );
        Some((message, "make the object thicker, or remove its `supports`".into()))
    }
}

/// Describes the limits of a tool's joint, as a phrase after "the".
fn limits(joint: &ToolJoint) -> String {
    match joint.range {
        JointRange::Interval { lower, upper } => format!("limits [{lower}, {upper}] m of joint \"{}\"", joint.name),
        JointRange::Circle => format!("limits of joint \"{}\"", joint.name),
    }
}

/// Iterates over notes about objects whose lift is greater than the tool's travel.
fn lifted_higher<'a>(stroke: &Stroke, objects: &'a [Object]) -> impl Iterator<Item = String> + 'a {
    let travel = stroke.travel.unwrap_or(f64::INFINITY);
    let higher = move |object: &&Object| object.lift > travel + RESTING_TOLERANCE;
    objects.iter().filter(higher).map(move |object| {
        let (lift, travel) = (length(object.lift), length(travel));
        format!(
            "object \"{}\" counts as lifted by {lift}, but the stroke raises the tool only by {travel}: the gripper must lift it by the rest",
            object.name
        )
    })
}

/// Returns diagnostics about objects below the lowest position of the tool.
fn too_deep<'a>(stroke: &'a Stroke, world: &'a World) -> impl Iterator<Item = Diagnostic> + 'a {
    let joint = &stroke.joint;
    world.objects.iter().filter_map(|object| {
        let (depth, at) = (stroke.depth(object), stroke.lowered(stroke.depth(object)));
        let message = format!(
            "[robot] stroke: for object \"{}\", the tool is lowered by {depth} m; joint \"{}\" would be at {at} m, outside the {}",
            object.name, joint.name, limits(joint)
        );
        let help = "change the fixed value of the joint, the travel, or the lift of the object";
        (!stroke.reaches(object)).then(|| world.source.diagnostic(message).help(help))
    })
}
