//! Margins of a motion, as fields of a result and as one line.

use super::{BodyKind, Margin, Margins};
use cplan_text::{length_down, round_down};
use serde::Serialize;
use serde::ser::{SerializeStruct, Serializer};

/// The margin of a body.
#[derive(Serialize)]
pub struct MarginReport<'a> {
    body: &'a str,
    kind: BodyKind,
    /// Proven lower bound on its distance from other bodies, metres. `None` if it can meet no other body.
    clearance: Option<f64>,
    #[serde(flatten)]
    place: Option<PlaceReport<'a>>,
}

/// The largest error of one kind for which the motion is proven free.
#[derive(Serialize)]
pub struct ToleranceReport<'a> {
    of: &'static str,
    unit: &'static str,
    /// `None` if no error up to half a turn, or up to the arm's reach, leads to contact.
    error: Option<f64>,
    #[serde(flatten)]
    place: Option<PlaceReport<'a>>,
}

/// The place of a margin on the motion.
#[derive(Serialize)]
struct PlaceReport<'a> {
    /// Names of the obstacle, and of the part of the arm or the payload, that come nearest there.
    between: [&'a str; 2],
    /// Configuration of the arm.
    at: [f64; 2],
    /// Time of the trajectory, seconds. At a rounded corner, it is approximately the time at which the motion passes.
    #[serde(skip_serializing_if = "Option::is_none")]
    time: Option<f64>,
    /// Place on a motion without times: the index of the waypoint, plus the fraction of the segment to the next one.
    #[serde(skip_serializing_if = "Option::is_none")]
    waypoint: Option<f64>,
}

impl Margins {
    /// Returns the margins of all bodies, as the field `margins` of results.
    pub fn body_reports(&self) -> Vec<MarginReport<'_>> {
        let reports = self.bodies.iter().map(|body| MarginReport {
            body: &body.name,
            kind: body.kind,
            clearance: body.margin.map(|margin| margin.size),
            place: body.margin.map(|margin| self.place(margin)),
        });
        reports.collect()
    }

    /// Returns the largest error of each kind, as the field `tolerances` of results.
    pub fn tolerance_reports(&self) -> Vec<ToleranceReport<'_>> {
        let reports = self.tolerances.iter().map(|tolerance| ToleranceReport {
            of: tolerance.of.name(),
            unit: if tolerance.of.is_angle() { "rad" } else { "m" },
            error: tolerance.margin.map(|margin| margin.size),
            place: tolerance.margin.map(|margin| self.place(margin)),
        });
        reports.collect()
    }

    fn place(&self, Margin { bodies, at, time, .. }: Margin) -> PlaceReport<'_> {
        let between = bodies.map(|body| self.bodies[body].name.as_str());
        let is_timed = !self.lacks_times;
        PlaceReport { between, at: at.into(), time: is_timed.then_some(time), waypoint: (!is_timed).then_some(time) }
    }

    /// Returns one line: the body with the least margin, and the largest error of each kind. `None` if no body can meet
    /// another.
    pub fn describe(&self) -> Option<String> {
        let Self { bodies, tolerances, .. } = self;
        let least = bodies.iter().filter_map(|body| body.margin).min_by(|a, b| a.size.total_cmp(&b.size))?;
        let Margin { size, bodies: [nearest, _], .. } = least;
        let body = format!("{} \"{}\" {}", bodies[nearest].kind.word(), bodies[nearest].name, length_down(size));
        let errors = tolerances.iter().filter_map(|tolerance| {
            let Margin { size, .. } = tolerance.margin?;
            let size = match tolerance.of.is_angle() {
                true => format!("{} deg", round_down(size.to_degrees(), 3)),
                false => length_down(size),
            };
            Some(format!("{} {size}", tolerance.of.name()))
        });
        let errors: Vec<String> = [body].into_iter().chain(errors).collect();
        Some(format!("for one error alone: {}", errors.join(", ")))
    }
}

impl Serialize for Margins {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_struct("Margins", 2)?;
        fields.serialize_field("margins", &self.body_reports())?;
        fields.serialize_field("tolerances", &self.tolerance_reports())?;
        fields.end()
    }
}
