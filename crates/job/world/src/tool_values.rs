//! Values of the tool's joints in the world file's `[start]` and `[goal]`.

use super::LoadedScene;
use super::problem::Place;
use super::reader::Reader;
use super::reasons::describe;
use cplan_handling::{Action, Item, Object, Step, Task, ToolJoint, ToolValues};
use cplan_model::Goal;
use cplan_model::space::JointRange;
use cplan_robot::{Diagnostic, InputError, Length, Written};
use cplan_text::listed;
use std::ops::Range;

/// Values of the tool's joints as the file states them, with their positions in the file.
#[derive(Debug, Clone, Default)]
pub(super) struct StatedTool {
    /// The value of the stroke's joint, metres.
    stroke: Option<(f64, Range<usize>)>,
    /// The value of the wrist's joint, radians.
    wrist: Option<(f64, Range<usize>)>,
}

impl StatedTool {
    /// Reads the keys `stroke` and `wrist` of a table.
    pub fn read(
        reader: &Reader,
        stroke: Option<&Length>,
        wrist: Option<&Written>,
        what: &str,
    ) -> Result<Self, Diagnostic> {
        let stroke = stroke.map(|n| Ok((reader.source.finite(n, &format!("{what}, stroke"))?, n.span())));
        let wrist = wrist.map(|w| Ok((reader.quantity(w, &format!("{what}, wrist"))?, w.span())));
        Ok(Self { stroke: stroke.transpose()?, wrist: wrist.transpose()? })
    }

    /// Returns true if the file states no value.
    pub fn is_empty(&self) -> bool {
        self.stroke.is_none() && self.wrist.is_none()
    }
}

impl LoadedScene {
    /// Returns the values of the tool's joints at the start and at the goal. If the goal has a value of the wrist, the start has
    /// one, too.
    ///
    /// # Errors
    /// Values of joints that the world does not name, and values outside the joints' limits.
    pub fn tool_values(&self) -> Result<[ToolValues; 2], InputError> {
        let [start, goal] = &self.world.tool;
        let (start, goal) = (self.values_of("the start", start)?, self.values_of("the goal", goal)?);
        let rest = self.robot.joints.wrist.as_ref().map(|joint| joint.rest);
        let from = start.wrist.or(rest.filter(|_| goal.wrist.is_some()));
        // A wrist without a stated goal stays where it is.
        let to = goal.wrist.or(from.filter(|_| !self.has_steps()));
        Ok([ToolValues { wrist: from, ..start }, ToolValues { wrist: to, ..goal }])
    }

    fn values_of(&self, what: &str, stated: &StatedTool) -> Result<ToolValues, Diagnostic> {
        let joints = &self.robot.joints;
        let stroke = joints.stroke.as_ref();
        let lowered = self.value_of(what, "stroke", &stated.stroke, stroke.map(|stroke| &stroke.joint))?;
        let depth = lowered.zip(stroke).map_or(0.0, |(value, stroke)| stroke.depth_at(value));
        Ok(ToolValues { depth, wrist: self.value_of(what, "wrist", &stated.wrist, joints.wrist.as_ref())? })
    }

    /// Returns the stated value of a tool's joint, which must be within the joint's limits.
    fn value_of(
        &self,
        what: &str,
        key: &str,
        stated: &Option<(f64, Range<usize>)>,
        joint: Option<&ToolJoint>,
    ) -> Result<Option<f64>, Diagnostic> {
        let Some((value, at)) = stated else { return Ok(None) };
        let refuse =
            |message: String, help: String| Err(self.world.source.diagnostic_at(at.clone(), message).help(help));
        let (moves, table) = match key {
            "stroke" => ("lowers the tool", "[robot] stroke = { joint = \"NAME\" }"),
            _ => ("turns the tool", "[robot] wrist = { joint = \"NAME\", velocity = 6.0 }"),
        };
        let Some(joint) = joint else {
            let message = format!("{what} has a value `{key}`, but the world names no joint that {moves}");
            return refuse(message, format!("add {table}, or remove the key"));
        };
        match joint.range {
            JointRange::Interval { lower, upper } if !joint.range.contains(*value) => {
                let message = format!(
                    "{what}, {key}: joint \"{}\" at {value} is outside its limits [{lower}, {upper}]",
                    joint.name
                );
                refuse(message, format!("choose a value from {lower} to {upper}"))
            }
            _ => Ok(Some(*value)),
        }
    }

    /// Returns the task's only item, a move to the goal, for a world whose start or goal states values of the tool's joints.
    pub(super) fn move_to_goal(goals: &[Goal], place: &Place, tool: ToolValues) -> Result<Item, Diagnostic> {
        let &[goal @ (Goal::Joints(_) | Goal::Tip(_) | Goal::TipAndElbow(..))] = goals else {
            let message = "values of the tool's joints, in [start] or [goal], are not possible with a goal of areas";
            return Err(place.diagnostic(message.to_owned()).help("joints = [q1, q2], or tip = [x, y]"));
        };
        let Diagnostic { origin, position, .. } = place.diagnostic(String::new());
        let place = position.map_or(origin.clone(), |at| format!("{origin}:{}:{}", at.line, at.column));
        Ok(Item::Step(Step {
            action: Action::Move(goal),
            number: 1,
            cycle: 1,
            place,
            speed: 1.0,
            dwell: 0.0,
            tool,
            elevation: 0.0,
            elbow: None,
        }))
    }
}

/// Checks that the arm is free at the start while the tool is lowered there. `refused` is a diagnostic about the start.
pub(super) fn require_free_lowered(task: &Task, refused: Diagnostic) -> Result<(), Diagnostic> {
    let poses: Vec<_> = task.objects.iter().map(Object::initial_static_pose).collect();
    let lowered = task.start_tool.lowered_by().and_then(|depth| task.empty_lowered_scene(depth, &poses, []));
    let Some(scene) = lowered else { return Ok(()) };
    let hits: Vec<String> = scene.obstructions(task.start).iter().map(|hit| scene.explain(hit)).collect();
    if hits.is_empty() {
        return Ok(());
    }
    let at = describe(&scene, task.start);
    let message = format!("the start ({at}) is not free while the tool is lowered: {}", listed(&hits));
    Err(Diagnostic { message, ..refused }
        .help("raise the tool at the start, choose another start, or move the obstacle"))
}
