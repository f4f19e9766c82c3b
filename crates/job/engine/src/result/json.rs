//! The result as JSON: its fields and their order.
//!
//! The fields that scripts rely on are always present: `path`, `length`, `clearance` and `trajectory`, which may be null. Other
//! fields are omitted if they have no value. Numbers are finite: radians for a revolute joint, metres for a prismatic one, and
//! seconds.

use super::errors_report::ErrorsReport;
use super::step_report::{FailedStepReport, step_reports};
use super::{finite, optimum};
use crate::field_report::field_report;
use crate::motion::Motion;
use crate::plan::{Detail, Plan};
use cplan_handling::Task;
use cplan_legs::{TaskAnswer, TaskMotion};
use cplan_model::{Joint, MotionProblem};
use cplan_motion::{BlendReport, JointMotion, Margins, Trajectory, field_per_line, interpolation};
use cplan_robot::AssumedLimits;
use cplan_solver::{Answer, GridSpace};
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use serde_json::value::RawValue;
use std::collections::BTreeMap;
use std::time::Duration;

/// Writes selected fields, in the order in which they are passed to it.
struct Fields<'a, M> {
    map: M,
    /// Names of the fields to write. Empty for all fields.
    only: &'a [String],
}

impl<M: SerializeMap> Fields<'_, M> {
    /// Returns true if the field is written.
    fn has(&self, name: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|only| only == name)
    }

    fn add(&mut self, name: &'static str, value: &(impl Serialize + ?Sized)) -> Result<(), M::Error> {
        debug_assert!(Plan::FIELD_NAMES.contains(&name), "{name} is not listed");
        if self.has(name) { self.map.serialize_entry(name, value) } else { Ok(()) }
    }

    /// Writes a field. Writes nothing if `value` is `None`.
    fn add_optional(&mut self, name: &'static str, value: Option<impl Serialize>) -> Result<(), M::Error> {
        value.map_or(Ok(()), |value| self.add(name, &value))
    }
}

/// The samples of the whole motion, with the number of each sample's step.
#[derive(Serialize)]
struct Samples<'a> {
    #[serde(flatten)]
    trajectory: &'a Trajectory,
    #[serde(skip_serializing_if = "Option::is_none")]
    step: Option<Vec<usize>>,
    /// Angles of both motors' shafts, radians. Empty if the motors are unknown.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    motors: Vec<[f64; 2]>,
}

/// The samples of all joints of the robot, joined by cubics.
#[derive(Serialize)]
struct AllJoints {
    joints: Vec<String>,
    time: Vec<f64>,
    position: Vec<Vec<f64>>,
    velocity: Vec<Vec<f64>>,
}

impl From<JointMotion> for AllJoints {
    fn from(motion: JointMotion) -> Self {
        let JointMotion { joints, time, position, velocity, .. } = motion;
        Self { joints, time, position, velocity }
    }
}

/// Descriptions of the assumed limits, by joint, and all in one text.
#[derive(Serialize)]
struct AssumedLimitTexts {
    #[serde(flatten)]
    limits: AssumedLimits,
    notes: Vec<String>,
}

/// Stages with their times in milliseconds.
struct Stages<'a>(&'a [(&'static str, Duration)]);

impl Serialize for Stages<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(stage, time)| (stage, time.as_secs_f64() * 1e3)))
    }
}

/// A plan's result, or some of its fields.
struct PlanResult<'a> {
    plan: &'a Plan,
    fields: &'a [String],
    /// A certificate that is written after the fields, unchanged.
    certificate: Option<&'a RawValue>,
}

impl Serialize for PlanResult<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = Fields { map: serializer.serialize_map(None)?, only: self.fields };
        self.head(&mut fields)?;
        match self.plan.detail() {
            Detail::Motion { problem, answer } => self.motion(&mut fields, problem, answer)?,
            Detail::Task { task, answer } => self.task(&mut fields, task, answer)?,
        }
        if let Some(certificate) = self.certificate {
            fields.map.serialize_entry("certificate", certificate)?;
        }
        fields.map.end()
    }
}

impl PlanResult<'_> {
    /// Writes the fields of the query and the status.
    fn head<M: SerializeMap>(&self, fields: &mut Fields<M>) -> Result<(), M::Error> {
        let Self { plan, .. } = self;
        let (planner, name) = (&plan.options().planner, &plan.problem().scene().workspace().name);
        fields.add("status", &plan.status())?;
        fields.add_optional("name", Some(name).filter(|name| !name.is_empty()))?;
        fields.add("planner", planner.method().name())?;
        fields.add_optional("search", plan.search())?;
        fields.add_optional("space", planner.space().and_then(GridSpace::reported_name))?;
        fields.add("joints", &plan.arm().joints.each_ref().map(|joint| &joint.name))?;
        fields.add("units", &plan.arm().joints.each_ref().map(Joint::unit))?;
        fields.add_optional("assumed", self.assumed_in_words())?;
        fields.add_optional("reason", plan.reason())
    }

    /// Returns the assumed limits with their description. `None` if no limits are assumed.
    fn assumed_in_words(&self) -> Option<AssumedLimitTexts> {
        let mut limits = self.plan.problem().robot().assumed.clone();
        if self.plan.options().drive.torque {
            limits.acceleration.clear();
        }
        let joints = self.plan.arm().joints.each_ref().map(|joint| (joint.name.as_str(), joint.unit()));
        (!limits.is_empty()).then(|| AssumedLimitTexts { notes: limits.notes(joints), limits })
    }

    fn motion<M: SerializeMap>(
        &self,
        fields: &mut Fields<M>,
        problem: &MotionProblem,
        answer: &Answer<Motion>,
    ) -> Result<(), M::Error> {
        let Self { plan, .. } = self;
        let motion = answer.outcome.found();
        fields.add_optional("proof", answer.outcome.infeasible())?;
        let witness = answer.outcome.unknown().and_then(|unknown| unknown.witness.as_ref());
        fields.add_optional("path_exists", witness.map(|_| true))?;
        fields.add_optional("path_kind", motion.map(|_| answer.path_kind.name()))?;
        fields.add("path", &plan.waypoints())?;
        let free = free_joints(problem);
        fields.add_optional("free_joints", Some(free).filter(|joints| !joints.is_empty()))?;
        fields.add("length", &plan.length())?;
        fields.add_optional("optimum", plan.bound().map(optimum))?;
        fields.add_optional("fastest", motion.and_then(|motion| motion.fastest))?;
        fields.add_optional("moving", plan.timing())?;
        fields.add("certified", &motion.is_some())?;
        fields.add("clearance", &plan.clearance())?;
        fields.add_optional("closest", plan.closest())?;
        self.margins(fields)?;
        fields.add_optional("calibration", plan.problem().errors().map(|errors| ErrorsReport::new(plan, errors)))?;
        fields.add_optional("field", plan.options().planner.field().map(|field| field_report(field, answer)))?;
        let size: BTreeMap<_, _> = answer.run.size.figures().into_iter().collect();
        fields.add_optional("size", Some(size).filter(|size| !size.is_empty()))?;
        self.timings(fields)?;
        fields.add_optional("blends", motion.map(|motion| BlendReport::of(&motion.timed.curve)))?;
        fields.add_optional("duration", plan.duration())?;
        self.trajectory(fields, plan.trajectory().map(|trajectory| self.samples(trajectory, None)))
    }

    /// Writes the fields of a task. Its path follows the steps; in the result of a motion, the path precedes the bounds.
    fn task<M: SerializeMap>(&self, fields: &mut Fields<M>, task: &Task, answer: &TaskAnswer) -> Result<(), M::Error> {
        let Self { plan, .. } = self;
        let motion = answer.outcome.found();
        fields.add_optional("failed", answer.failed().map(|failed| FailedStepReport::new(task, failed)))?;
        fields.add_optional("moving", plan.timing())?;
        fields.add("certified", &motion.is_some())?;
        fields.add("clearance", &plan.clearance())?;
        self.margins(fields)?;
        fields.add_optional("duration", plan.duration())?;
        fields.add_optional("lower_bound", finite(answer.least_seconds()))?;
        fields.add_optional("gap", answer.gap())?;
        fields.add_optional("choice", motion.map(|motion| if motion.exact { "fastest" } else { "good" }))?;
        fields.add("motions", &answer.motions)?;
        let (steps, events) = step_reports(task, answer);
        fields.add("steps", &steps)?;
        fields.add("events", &events)?;
        fields.add("path", &plan.waypoints())?;
        fields.add("length", &plan.length())?;
        self.timings(fields)?;
        let samples =
            motion.map(|TaskMotion { sequence, .. }| self.samples(&sequence.trajectory, Some(sequence.steps())));
        self.trajectory(fields, samples)?;
        fields.add_optional("all_joints", plan.motion_with_tool().map(AllJoints::from))
    }

    /// Writes the margins of the motion, if there is one. Computes them only if they are written.
    fn margins<M: SerializeMap>(&self, fields: &mut Fields<M>) -> Result<(), M::Error> {
        let Self { plan, .. } = self;
        let is_written = plan.trajectory().is_some() && ["margins", "tolerances"].iter().any(|name| fields.has(name));
        let margins = is_written.then(|| plan.margins());
        fields.add_optional("margins", margins.map(Margins::body_reports))?;
        fields.add_optional("tolerances", margins.map(Margins::tolerance_reports))
    }

    fn timings<M: SerializeMap>(&self, fields: &mut Fields<M>) -> Result<(), M::Error> {
        let Self { plan, .. } = self;
        fields.add_optional("timings", plan.options().timings.then(|| Stages(plan.timings())))
    }

    fn samples<'b>(&self, trajectory: &'b Trajectory, step: Option<Vec<usize>>) -> Samples<'b> {
        Samples { trajectory, step, motors: self.plan.arm().motor_angles(&trajectory.position) }
    }

    /// Writes the trajectory, and how to interpolate between its samples.
    fn trajectory<M: SerializeMap>(&self, fields: &mut Fields<M>, samples: Option<Samples>) -> Result<(), M::Error> {
        fields.add_optional("interpolation", samples.as_ref().map(|_| interpolation(self.plan.arm())))?;
        fields.add("trajectory", &samples)
    }
}

/// Returns the names of the joints that a tip goal leaves free. The path's last waypoint has the chosen values.
fn free_joints(problem: &MotionProblem) -> Vec<&str> {
    let goals = problem.goals().pieces();
    let is_free = |k: &usize| goals.iter().any(|goals| goals.ends()[0][*k] != goals.ends()[1][*k]);
    (0..2).filter(is_free).map(|k| problem.scene().arm().joints[k].name.as_str()).collect()
}

impl Plan {
    /// The names of all fields that results can have.
    pub const FIELD_NAMES: [&str; 39] = [
        "status",
        "name",
        "planner",
        "search",
        "space",
        "joints",
        "units",
        "assumed",
        "reason",
        "proof",
        "failed",
        "path_exists",
        "path_kind",
        "path",
        "free_joints",
        "length",
        "optimum",
        "fastest",
        "moving",
        "certified",
        "clearance",
        "closest",
        "margins",
        "tolerances",
        "calibration",
        "field",
        "size",
        "duration",
        "lower_bound",
        "gap",
        "choice",
        "motions",
        "steps",
        "events",
        "timings",
        "blends",
        "interpolation",
        "trajectory",
        "all_joints",
    ];

    /// Returns the result with only these fields, in their usual order. An empty list stands for all fields.
    pub fn result<'a>(&'a self, fields: &'a [String]) -> impl Serialize + 'a {
        PlanResult { plan: self, fields, certificate: None }
    }

    /// Returns the result as a JSON object, one field per line, as the book describes it. Numbers have enough digits to
    /// restore the same `f64`.
    pub fn to_json(&self) -> String {
        field_per_line(&self.result(&[]))
    }

    /// Returns the result as a JSON object, with a certificate ([`Plan::certificate`]) as its last member.
    pub fn to_json_with(&self, certificate: &RawValue) -> String {
        field_per_line(&PlanResult { plan: self, fields: &[], certificate: Some(certificate) })
    }
}
