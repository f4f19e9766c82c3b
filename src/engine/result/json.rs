//! The result as JSON: which fields, in which order.

use super::Report;
use crate::motion::{Trajectory, as_map, line_a_field};
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};

/// Fields one after the other.
struct Fields<M>(M);

impl<M: SerializeMap> Fields<M> {
    fn put(&mut self, name: &'static str, value: &(impl Serialize + ?Sized)) -> Result<(), M::Error> {
        self.0.serialize_entry(name, value)
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

/// Stages with their milliseconds.
struct Stages<'a>(&'a [(String, f64)]);

impl Serialize for Stages<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        as_map(self.0, serializer)
    }
}

impl Serialize for Report {
    /// The path of a single motion stands before what is proven of it, that of a task behind its steps.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = Fields(serializer.serialize_map(None)?);
        fields.put("status", &self.status)?;
        fields.some("name", self.name.as_ref())?;
        fields.put("planner", &self.planner)?;
        fields.some("search", self.search.as_ref())?;
        fields.some("space", self.space.as_ref())?;
        fields.put("joints", &self.joints)?;
        fields.put("units", &self.units)?;
        fields.some("assumed", Some(&self.assumed).filter(|assumed| !assumed.is_empty()))?;
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
        fields.0.end()
    }
}

impl Report {
    /// The result as a JSON object, a line a field. Numbers have as many digits as it takes to read the same `f64` back.
    #[must_use]
    pub fn json(&self) -> String {
        line_a_field(self)
    }
}
