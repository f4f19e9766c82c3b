//! `cplan inspect`: reports how the planner interprets a robot, and which defects prevent planning.

use super::exit::{DONE, REFUTED};
use super::failure::Failure;
use super::files::XacroArgs;
use super::inspect_text::text;
use super::outputs::{Outputs, refuse_to_overwrite_inputs};
use super::sinks;
use super::theme::ThemeArgs;
use crate::input::{self, Diagnostic, InputError, Inspection, RobotFile};
use crate::model::TimedScene;
use crate::motion::write_whole;
use crate::output::PictureFormat;
use crate::space::Configuration;
use crate::view::{AxesFrame, Picture, View, inspection_page};
use clap::{Args, ValueHint};
use serde::Serialize;
use std::path::{Path, PathBuf};

#[derive(Serialize)]
struct Json<'a> {
    /// True if planning is possible for this robot without changes.
    plannable: bool,
    #[serde(flatten)]
    inspection: &'a Inspection,
    /// All defects that prevent planning.
    #[serde(rename = "defects")]
    diagnostics: Vec<DiagnosticEntry<'a>>,
}

impl<'a> Json<'a> {
    fn new(inspection: &'a Inspection) -> Self {
        let diagnostics = inspection.errors.iter().flat_map(|e| e.diagnostics()).map(entry).collect();
        Self { plannable: inspection.is_plannable(), inspection, diagnostics }
    }
}

/// The data of the report's page.
#[derive(Serialize)]
struct PageReport<'a> {
    #[serde(flatten)]
    json: Json<'a>,
    /// Masses and effort limits. `None` if they are unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    dynamics: Option<DynamicsEntry>,
    /// The report as the terminal shows it.
    text: String,
}

#[derive(Serialize)]
struct DynamicsEntry {
    /// Mass of each arm link including everything that it carries, kg.
    masses: [f64; 2],
    /// Effort limit of each joint, N m or N. `None` if motions need not respect it.
    efforts: Option<[f64; 2]>,
}

#[derive(Serialize)]
struct DiagnosticEntry<'a> {
    origin: &'a str,
    line: Option<usize>,
    column: Option<usize>,
    message: &'a str,
    #[serde(rename = "cure")]
    help: Option<&'a str>,
}

/// Report how cplan interprets a robot, and all its defects.
///
/// The report has the tree of links, the plane, limits, outlines, and the defects that prevent planning.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  cplan inspect robots/planar_2r.urdf
  cplan inspect robots/scara.urdf workspaces/scara_cell.toml \\
    --picture scara.svg
  cplan inspect robots/scara.urdf.xacro --xacro-arg reach=0.6 \\
    --expanded scara_expanded.urdf

Exit codes: 0 cplan can plan for the robot; 1 it cannot (the report is still
printed), or a file cannot be read or written; 2 wrong command line.")]
pub struct InspectArgs {
    /// Robot: a URDF or xacro file, which may be defective or not a planar arm.
    #[arg(value_name = "URDF", value_hint = ValueHint::FilePath)]
    pub urdf: PathBuf,
    /// World file (TOML). Its table [robot] completes the URDF.
    #[arg(value_name = "WORLD", value_hint = ValueHint::FilePath)]
    pub world: Option<PathBuf>,
    #[command(flatten)]
    pub xacro: XacroArgs,
    /// Write the URDF to which a xacro robot expands (.urdf), for `cplan-check` and other programs. Write it into the
    /// folder of the xacro file, so that its meshes are found.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub expanded: Option<PathBuf>,
    /// Draw the arm at zero with the frames of its joints: .svg or .png, or .html with the whole report. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub picture: Vec<PathBuf>,
    #[command(flatten)]
    pub theme: ThemeArgs,
    /// Print the report as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Prints the report.
///
/// # Errors
/// I/O, and, after the report, the first defect of a robot that cannot be planned for.
pub fn run(args: &InspectArgs) -> Result<u8, Failure> {
    let outputs = Outputs::of_pictures(&args.picture, args.expanded.clone())?;
    let robot = args.xacro.robot(&args.urdf);
    let inspection = input::inspect(&robot, args.world.as_deref());
    refuse_to_overwrite_inputs(outputs.paths(), &inspection.files)?;
    if let Some(path) = &args.expanded {
        write_expanded(&robot, path)?;
    }
    let view = (!args.picture.is_empty()).then(|| view(&inspection)).flatten().map(|view| args.theme.apply(view));
    for (path, format) in &outputs.pictures {
        match (*format, &view) {
            (PictureFormat::Html, _) => write_whole(path, page(&inspection, view.as_ref())?.as_bytes())?,
            (_, Some(view)) => write_whole(path, &format.bytes(view)?)?,
            (_, None) => sinks::print_status(&format!(
                "warning: {} is not written: there is no planar arm to draw",
                path.display()
            )),
        }
    }
    if args.json {
        sinks::print_json(&sinks::pretty(&Json::new(&inspection))?)?;
    } else {
        sinks::sum_up(&text(&inspection), if inspection.is_plannable() { DONE } else { REFUTED })?;
    }
    match inspection.errors.into_iter().next() {
        None => Ok(DONE),
        Some(error) if args.json => Err(Failure::Reported(error)),
        Some(error) => Err(error.into()),
    }
}

/// Writes the URDF to which a xacro robot expands. Warns about meshes that are not found from the folder of the new file.
fn write_expanded(robot: &RobotFile, path: &Path) -> Result<(), Failure> {
    let source = robot.read()?;
    if !source.is_converted() {
        let message = "this is a plain URDF, so there is nothing to expand";
        return Err(InputError::from(source.diagnostic(message).help("leave --expanded out")).into());
    }
    write_whole(path, source.text().as_bytes())?;
    for mesh in input::meshes_elsewhere(&source, path) {
        let [file, robot] = [path, &robot.path].map(|path| path.display().to_string());
        sinks::print_status(&format!(
            "warning: mesh \"{mesh}\" cannot be found from the folder of {file}; write {file} beside {robot}"
        ));
    }
    Ok(())
}

fn entry(diagnostic: &Diagnostic) -> DiagnosticEntry<'_> {
    DiagnosticEntry {
        origin: &diagnostic.origin,
        line: diagnostic.position.map(|p| p.line),
        column: diagnostic.position.map(|p| p.column),
        message: &diagnostic.message,
        help: diagnostic.help.as_deref(),
    }
}

/// Returns the page of the report, with the arm if there is one.
fn page(inspection: &Inspection, view: Option<&View>) -> Result<String, Failure> {
    let dynamics = inspection.scene.as_ref().and_then(|scene| scene.arm().dynamics).map(|dynamics| DynamicsEntry {
        masses: dynamics.bodies.map(|body| body.mass),
        efforts: dynamics.limits.then_some(dynamics.effort),
    });
    let report = PageReport { json: Json::new(inspection), dynamics, text: text(inspection) };
    let title = inspection.robot.as_deref().unwrap_or("Robot without a name");
    Ok(inspection_page(title, view, &sinks::pretty(&report)?))
}

/// Returns the view of the arm at its zero configuration. `None` if there is no arm.
fn view(inspection: &Inspection) -> Option<View> {
    let scene = inspection.scene.as_ref()?;
    let arm = scene.arm();
    let [first, second] = &arm.joints;
    let outlines: Vec<String> = inspection.outlines.iter().map(|o| format!("{}: {}", o.link, o.source)).collect();
    let outlines = if outlines.is_empty() { "none".into() } else { outlines.join(", ") };
    let picture = Picture {
        title: vec![arm.name.clone(), format!("{} and {} at zero; outlines: {outlines}", first.name, second.name)],
        status: if inspection.is_plannable() {
            "planning is possible".into()
        } else {
            "planning is not possible".into()
        },
        ..Picture::new(TimedScene { scene, trajectories: &inspection.trajectories }, Configuration::zeros())
    };
    let frame = |f: &input::Frame| AxesFrame { name: f.name.clone(), at: f.at, axes: f.axes };
    Some(View::of_arm(&picture, &inspection.frames.iter().map(frame).collect::<Vec<_>>()))
}
