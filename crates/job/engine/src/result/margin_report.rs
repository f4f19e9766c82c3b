//! The margins of a motion in the JSON of a result.

use cplan_motion::{BodyKind, Margin, Margins};
use serde::Serialize;

/// The margin of a body.
#[derive(Serialize)]
pub(super) struct MarginReport<'a> {
    body: &'a str,
    kind: BodyKind,
    /// Proven lower bound on its distance from other bodies, metres. `None` if it can meet none.
    clearance: Option<f64>,
    #[serde(flatten)]
    place: Option<PlaceReport<'a>>,
}

/// The largest error of one kind for which the motion is proven free.
#[derive(Serialize)]
pub(super) struct ToleranceReport<'a> {
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
    /// Names of the obstacle, and of the part of the arm or the payload, that are nearest to contact there.
    between: [&'a str; 2],
    /// Configuration of the arm.
    at: [f64; 2],
    /// Time of the trajectory, seconds. At a corner that it rounds, it is about the time at which it passes.
    time: f64,
}

impl<'a> PlaceReport<'a> {
    fn new(margins: &'a Margins, Margin { bodies, at, time, .. }: Margin) -> Self {
        Self { between: bodies.map(|body| margins.bodies[body].name.as_str()), at: at.into(), time }
    }
}

/// Returns the margins of all bodies.
pub(super) fn margin_reports(margins: &Margins) -> Vec<MarginReport<'_>> {
    let reports = margins.bodies.iter().map(|body| MarginReport {
        body: &body.name,
        kind: body.kind,
        clearance: body.margin.map(|margin| margin.size),
        place: body.margin.map(|margin| PlaceReport::new(margins, margin)),
    });
    reports.collect()
}

/// Returns the largest error of each kind.
pub(super) fn tolerance_reports(margins: &Margins) -> Vec<ToleranceReport<'_>> {
    let reports = margins.tolerances.iter().map(|tolerance| ToleranceReport {
        of: tolerance.of.name(),
        unit: if tolerance.of.is_angle() { "rad" } else { "m" },
        error: tolerance.margin.map(|margin| margin.size),
        place: tolerance.margin.map(|margin| PlaceReport::new(margins, margin)),
    });
    reports.collect()
}
