//! `cplan cell`: two arms in one cell, on one clock.

mod files;
mod json;
mod programs;
mod words;

use super::exit::code_of;
use super::failure::Failure;
use super::headings::OUTPUT;
use super::outputs::{Outputs, refuse_to_overwrite_inputs};
use super::print_args::PrintArgs;
use super::program_args::{ProgramArgs, ProgramWriter};
use super::sinks;
use super::theme::ThemeArgs;
use super::values::clearance;
use crate::engine::Options;
use crate::input::{InputError, Source};
use crate::model::Outcome;
use crate::motion::{Format, field_per_line};
use crate::options::number_in;
use clap::{Args, ValueHint};
use cplan_cell::{Answer, Cell, CellPlan, Settings, plan_cell};
pub use json::{assignment as assignment_json, handover as handover_json, step as step_json};
use programs::CellPrograms;
use std::path::{Path, PathBuf};

/// Coordinate two arms in one cell, on one clock.
#[derive(Debug, Args)]
#[command(after_help = "\
Both motions are certified: the arms touch neither obstacles nor each other,
even if the clocks of the controllers differ by up to --skew seconds. Each arm
has a start and a goal, or steps: picks, places, handovers. Obstacles stand still.

Examples:
  cplan cell workspaces/cells/crossing.toml
  cplan cell workspaces/cells/crossing.toml --picture cell.html
  cplan cell workspaces/cells/crossing.toml --output cell.json \\
    --output left.csv --output right.csv
  cplan cell workspaces/cells/column.toml --skew 0.1 --json
  cplan cell workspaces/cells/crossing.toml --template rapid \\
    --output left.mod --output right.mod
  cplan cell workspaces/cells/handover.toml --output cell.json

Exit codes: 0 both motions are found and certified, 1 bad input or I/O, 2 wrong
command line, 3 there are no such motions, proven, 4 unknown.")]
pub struct CellArgs {
    /// Cell file: the arms with their robots, starts and goals, and the obstacles.
    #[arg(value_name = "CELL", value_hint = ValueHint::FilePath)]
    cell: PathBuf,
    /// Greatest difference of the two controllers' clocks, seconds. The certificate holds for all differences up to
    /// this one.
    #[arg(long, value_name = "SECONDS", value_parser = skew, default_value_t = skew_or_default(None))]
    skew: f64,
    /// Least distance to keep from every obstacle and between the arms, metres, instead of the cell's.
    #[arg(long, value_name = "METRES", value_parser = clearance)]
    pub clearance: Option<f64>,
    /// Number of boxes, in the space of all four joints, for a proof that the arms cannot both reach their goals. With
    /// 0, cplan tries no such proof.
    #[arg(long, value_name = "COUNT", default_value_t = Settings::default().boxes)]
    boxes: usize,
    /// Write the result: .json, .csv or .yaml (ROS 2). A .csv or .yaml file has the motions of both arms, or that of
    /// one arm if its name ends in the name of the arm. With --template, other extensions are programs, one for
    /// each arm. Repeatable.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub output: Vec<PathBuf>,
    /// Draw both arms, the diagram of their times, and a time line for each arm: .svg, .png or .html. Repeatable.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub picture: Vec<PathBuf>,
    #[command(flatten)]
    pub program: ProgramArgs,
    #[command(flatten)]
    pub theme: ThemeArgs,
    #[command(flatten)]
    pub print: PrintArgs,
}

/// Greatest skew of two clocks, seconds.
const MAX_SKEW: f64 = 60.0;

/// Returns the skew of a command line.
pub fn skew_or_default(skew: Option<f64>) -> f64 {
    skew.unwrap_or_else(|| Settings::default().skew)
}

/// Parses a skew.
///
/// # Errors
/// The allowed values.
pub fn skew(text: &str) -> Result<f64, String> {
    number_in(text, |x| (0.0..=MAX_SKEW).contains(&x), &format!("of seconds, from 0 to {MAX_SKEW}"))
}

/// A cell with its answer.
struct Answered<'a> {
    args: &'a CellArgs,
    cell: &'a Cell,
    plan: &'a CellPlan,
    programs: Option<&'a CellPrograms>,
}

/// The content of a file with motions.
#[derive(Debug, Clone, Copy)]
enum Content {
    /// The result.
    Result(Format),
    /// A program for the controller of one arm.
    Program,
}

/// Plans a cell, and writes its motions.
///
/// # Errors
/// Bad input and I/O, and motions that cannot be timed.
pub fn run(args: &CellArgs) -> Result<u8, Failure> {
    answer(args, |clearance| {
        Cell::load(&Source::read(&args.cell)?, &|path| crate::input::robot(path).read(), clearance)
    })
}

/// Plans the cell that `load` returns for a clearance, and writes its motions.
///
/// # Errors
/// Bad input and I/O, and motions that cannot be timed.
pub fn answer(args: &CellArgs, load: impl Fn(Option<f64>) -> Result<Cell, InputError>) -> Result<u8, Failure> {
    let content = |path: &Path| content(path, &args.program);
    let outputs = Outputs::new(&args.output, content, &args.picture, [])?.without_animation("a cell")?;
    let has_program = outputs.results.iter().any(|(_, content)| matches!(content, Content::Program));
    let mut writer = args.program.writer(has_program, 0.0)?;
    let cell = programs::load(load, args.clearance, &outputs, writer.as_mut())?;
    let inputs: Vec<PathBuf> = cell.files.iter().cloned().chain(writer.iter().flat_map(ProgramWriter::files)).collect();
    refuse_to_overwrite_inputs(outputs.paths(), &inputs)?;
    for arm in &cell.arms {
        let warnings = arm.problem.robot().warnings.iter();
        warnings.for_each(|warning| args.print.print_status(&format!("warning: {}: {warning}", arm.name)));
    }
    let mut options = Options::default();
    if writer.is_some() {
        options.drive.blend = 0.0;
    }
    let settings = Settings { options, skew: args.skew, boxes: args.boxes };
    let plan = plan_cell(&cell, &settings, &mut |text| args.print.print_status(text))?;
    let programs = plan.outcome.found().zip(writer.as_ref());
    let programs = programs.map(|(found, writer)| CellPrograms::new(&cell, found, writer)).transpose()?;
    let answered = Answered { args, cell: &cell, plan: &plan, programs: programs.as_ref() };
    outputs.write(
        vec![],
        |path, content| match (content, &plan.outcome) {
            (Content::Result(Format::Json), _) => Ok(Some(field_per_line(&answered.json()).into_bytes())),
            (Content::Result(format), Outcome::Found(found)) => {
                Ok(Some(files::motion(&cell, found, path, format).into_bytes()))
            }
            (Content::Program, Outcome::Found(_)) => Ok(programs
                .as_ref()
                .and_then(|programs| programs.text(&cell, path))
                .map(|text| text.as_bytes().to_vec())),
            _ => {
                sinks::warn_unwritten(path, "motions");
                Ok(None)
            }
        },
        |format| {
            let facts = answered.facts();
            let answer = Answer { cell: &cell, plan: &plan, skew: args.skew, facts: &facts };
            Ok(format.bytes_of(|| answer.figure().on_background(args.theme.is_dark()), || answer.page())?)
        },
    )?;
    let code = code_of(plan.status());
    args.print.report(code, || Ok(field_per_line(&answered.json())), || answered.summary())?;
    Ok(code)
}

/// Returns the content of an output by its extension.
fn content(path: &Path, program: &ProgramArgs) -> Result<Content, Failure> {
    let format = match Format::from_path(path) {
        Ok(format) => format,
        Err(error) => return program.accept(error).map(|()| Content::Program),
    };
    match format {
        format @ (Format::Json | Format::Csv | Format::Yaml) => Ok(Content::Result(format)),
        #[cfg(feature = "mcap")]
        Format::Mcap => {
            Err(Failure::Usage(format!("{}: motions of cells are written as .json, .csv or .yaml", path.display())))
        }
    }
}
