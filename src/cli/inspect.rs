//! `cplan inspect`: what the planner makes of a robot, and what keeps it from planning.

use super::DONE;
use super::args::InspectArgs;
use super::failure::Failure;
use super::inspect_text::text;
use super::sinks::{self, Sink};
use crate::draw::{AxesFrame, Posture};
use crate::input::{self, Defect, Inspection};
use crate::space::Configuration;
use serde::Serialize;

/// The report as JSON.
#[derive(Serialize)]
struct Json<'a> {
    /// Whether the robot can be planned with as it is.
    plannable: bool,
    #[serde(flatten)]
    inspection: &'a Inspection,
    /// All that prevents planning.
    defects: Vec<DefectEntry<'a>>,
}

#[derive(Serialize)]
struct DefectEntry<'a> {
    origin: &'a str,
    line: Option<usize>,
    column: Option<usize>,
    message: &'a str,
    cure: Option<&'a str>,
}

/// Reports on stdout.
///
/// # Errors
/// I/O; and, after the report, the first defect of a robot that cannot be planned with.
pub fn run(args: &InspectArgs) -> Result<u8, Failure> {
    let sinks = sinks::sinks(&[], &args.picture)?;
    let inspection = input::inspect(&args.urdf, args.world.as_deref());
    sinks::spare_inputs(sinks.iter().map(Sink::path))?;
    for sink in &sinks {
        let Sink::Picture(format, path) = sink else { continue };
        match posture(&inspection) {
            Some(posture) => sinks::save_picture(*format, path, &posture)?,
            None => sinks::say(&format!("warning: {} is not written: there is no planar arm to draw", path.display())),
        }
    }
    if args.json {
        let defects = inspection.errors.iter().flat_map(|e| e.defects()).map(entry).collect();
        let json = Json { plannable: inspection.is_plannable(), inspection: &inspection, defects };
        let json = serde_json::to_string_pretty(&json).map_err(|e| Failure::Option(e.to_string()))?;
        sinks::print_json(&(json + "\n"))?;
    } else {
        sinks::tell(&text(&inspection))?;
    }
    match inspection.errors.into_iter().next() {
        None => Ok(DONE),
        Some(error) if args.json => Err(Failure::Reported(error)),
        Some(error) => Err(error.into()),
    }
}

fn entry(defect: &Defect) -> DefectEntry<'_> {
    DefectEntry {
        origin: &defect.origin,
        line: defect.position.map(|p| p.line),
        column: defect.position.map(|p| p.column),
        message: &defect.message,
        cure: defect.cure.as_deref(),
    }
}

/// The arm at zero, if there is one.
fn posture(inspection: &Inspection) -> Option<Posture<'_>> {
    let scene = inspection.scene.as_ref()?;
    let arm = scene.arm();
    let [first, second] = &arm.joints;
    let outlines: Vec<String> = inspection.outlines.iter().map(|o| format!("{}: {}", o.link, o.source)).collect();
    let outlines = if outlines.is_empty() { "none".into() } else { outlines.join(", ") };
    let frames = &inspection.frames;
    Some(Posture {
        title: vec![arm.name.clone(), format!("{} and {} at zero; outlines: {outlines}", first.name, second.name)],
        status: if inspection.is_plannable() { "can be planned with".into() } else { "cannot be planned with".into() },
        scene,
        at: Configuration::zeros(),
        frames: frames.iter().map(|f| AxesFrame { name: f.name.clone(), at: f.at, axes: f.axes }).collect(),
    })
}
