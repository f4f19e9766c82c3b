//! The result as JSON: which fields, in which order.

use super::Report;
use cplan_motion::{Trajectory, as_map, line_a_field};
use cplan_robot::AssumedLimits;
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};

/// Fields one after the other.
struct Fields<'a, M> {
    map: M,
    /// Those that are written; all if there are none.
    only: &'a [String],
}

impl<M: SerializeMap> Fields<'_, M> {
    fn put(&mut self, name: &'static str, value: &(impl Serialize + ?Sized)) -> Result<(), M::Error> {
        debug_assert!(Report::FIELDS.contains(&name), "{name} is not listed");
        let is_written = self.only.is_empty() || self.only.iter().any(|only| only == name);
        if is_written { self.map.serialize_entry(name, value) } else { Ok(()) }
    }

    /// Leaves it out if there is none.
    fn some<T: Serialize>(&mut self, name: &'static str, value: Option<&T>) -> Result<(), M::Error> {
        value.map_or(Ok(()), |value| self.put(name, value))
    }
}

/// The whole motion with the step that each of its samples belongs to.
#[derive(Serialize)]
struct Samples<'a> {
    #[serde(flatten)]
    trajectory: &'a Trajectory,
    #[serde(skip_serializing_if = "Option::is_none")]
    step: Option<&'a [usize]>,
}

/// Limits that nobody gives, by joint and in words.
#[derive(Serialize)]
struct AssumedInWords<'a> {
    #[serde(flatten)]
    limits: &'a AssumedLimits,
    notes: Vec<String>,
}

/// Stages with their milliseconds.
struct Stages<'a>(&'a [(String, f64)]);

impl Serialize for Stages<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        as_map(self.0, serializer)
    }
}

/// Some fields of a result.
struct Only<'a> {
    report: &'a Report,
    fields: &'a [String],
}

impl Serialize for Only<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.report.write(self.fields, serializer)
    }
}

impl Serialize for Report {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.write(&[], serializer)
    }
}

impl Report {
    /// The names of all fields that results can have.
    pub const FIELDS: [&str; 35] = [
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
    ];

    /// The result with these fields alone, in their usual order; with all where none is named.
    #[must_use]
    pub fn only<'a>(&'a self, fields: &'a [String]) -> impl Serialize + 'a {
        Only { report: self, fields }
    }

    /// The limits that nobody gives, and what is said of them everywhere.
    fn assumed_in_words(&self) -> Option<AssumedInWords<'_>> {
        let joints = [0, 1].map(|k| (self.joints[k].as_str(), self.units[k]));
        let limits = Some(&self.assumed).filter(|assumed| !assumed.is_empty())?;
        Some(AssumedInWords { limits, notes: limits.notes(joints) })
    }

    /// The path of a single motion stands before what is proven of it, that of a task behind its steps.
    fn write<S: Serializer>(&self, only: &[String], serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = Fields { map: serializer.serialize_map(None)?, only };
        fields.put("status", &self.status)?;
        fields.some("name", self.name.as_ref())?;
        fields.put("planner", &self.planner)?;
        fields.some("search", self.search.as_ref())?;
        fields.some("space", self.space.as_ref())?;
        fields.put("joints", &self.joints)?;
        fields.put("units", &self.units)?;
        fields.some("assumed", self.assumed_in_words().as_ref())?;
        fields.some("reason", self.reason.as_ref())?;
        fields.some("proof", self.proof.as_ref())?;
        fields.some("failed", self.task.as_ref().and_then(|task| task.failed.as_ref()))?;
        fields.some("path_exists", self.path_exists.as_ref())?;
        fields.some("path_kind", self.path_kind.as_ref())?;
        if self.task.is_none() {
            fields.put("path", &self.path)?;
            fields.some("free_joints", Some(&self.free_joints).filter(|joints| !joints.is_empty()))?;
            fields.put("length", &self.length)?;
        }
        fields.some("optimum", self.optimum.as_ref())?;
        fields.some("fastest", self.fastest.as_ref())?;
        fields.some("moving", self.moving.as_ref())?;
        fields.put("certified", &self.certified)?;
        fields.put("clearance", &self.clearance)?;
        fields.some("closest", self.closest.as_ref())?;
        fields.some("field", self.field.as_ref())?;
        fields.some("size", Some(&self.size).filter(|size| !size.is_empty()))?;
        if let Some(task) = &self.task {
            fields.some("duration", self.duration.as_ref())?;
            fields.some("lower_bound", task.lower_bound.as_ref())?;
            fields.some("gap", task.gap.as_ref())?;
            fields.some("choice", task.choice.as_ref())?;
            fields.put("motions", &task.motions)?;
            fields.put("steps", &task.steps)?;
            fields.put("events", &task.events)?;
            fields.put("path", &self.path)?;
            fields.put("length", &self.length)?;
        }
        fields.some("timings", Some(&Stages(&self.timings)).filter(|_| !self.timings.is_empty()))?;
        fields.some("blends", self.blends.as_ref())?;
        fields.some("duration", self.duration.as_ref().filter(|_| self.task.is_none()))?;
        fields.some("interpolation", self.interpolation.as_ref())?;
        let step = self.task.as_ref().map(|task| &task.step_of_sample[..]);
        fields.put("trajectory", &self.trajectory.as_ref().map(|trajectory| Samples { trajectory, step }))?;
        fields.map.end()
    }

    /// The result as a JSON object, a line a field. Numbers have as many digits as it takes to read the same `f64` back.
    #[must_use]
    pub fn json(&self) -> String {
        line_a_field(self)
    }
}
