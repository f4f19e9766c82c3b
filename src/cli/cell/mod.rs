//! `cplan cell`: two arms in one cell, on one clock.

mod files;
mod json;
mod words;

use super::exit::code_of;
use super::failure::Failure;
use super::headings::OUTPUT;
use super::outputs::{Outputs, refuse_to_overwrite_inputs};
use super::print_args::PrintArgs;
use super::sinks;
use super::theme::ThemeArgs;
use super::values::clearance;
use crate::engine::Options;
use crate::model::Outcome;
use crate::motion::{Format, field_per_line};
use crate::options::number_in;
use clap::{Args, ValueHint};
use cplan_cell::{Cell, CellPlan, Settings, plan_cell};
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
  cplan cell workspaces/cells/crossing.toml --output cell.csv \\
    --output left.yaml --output right.yaml
  cplan cell workspaces/cells/column.toml --skew 0.1 --json
  cplan cell workspaces/cells/handover.toml --output cell.json

Exit codes: 0 both motions are found and certified, 1 bad input or I/O, 2 wrong
command line, 3 there are no such motions, proven, 4 unknown.")]
pub struct CellArgs {
    /// Cell file: the arms with their robots, starts and goals, and the obstacles.
    #[arg(value_name = "CELL", value_hint = ValueHint::FilePath)]
    cell: PathBuf,
    /// Greatest difference of the two controllers' clocks, seconds. The certificate holds for all differences up to
    /// this one.
    #[arg(long, value_name = "SECONDS", value_parser = skew, default_value_t = Settings::default().skew)]
    skew: f64,
    /// Least distance to keep from every obstacle and between the arms, metres, instead of the cell's.
    #[arg(long, value_name = "METRES", value_parser = clearance)]
    clearance: Option<f64>,
    /// Number of boxes, in the space of all four joints, for a proof that the arms cannot both reach their goals. With
    /// 0, cplan tries no such proof.
    #[arg(long, value_name = "COUNT", default_value_t = Settings::default().boxes)]
    boxes: usize,
    /// Write the result: .json, .csv with four joints, or .yaml (ROS 2). A .yaml file has the motions of both arms, or
    /// that of one arm if its name ends in the name of the arm. Repeatable.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    output: Vec<PathBuf>,
    /// Draw both arms, the diagram of their times, and a time line for each arm: .svg, .png or .html. Repeatable.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    picture: Vec<PathBuf>,
    #[command(flatten)]
    theme: ThemeArgs,
    #[command(flatten)]
    print: PrintArgs,
}

/// Greatest skew of two clocks, seconds.
const MAX_SKEW: f64 = 60.0;

fn skew(text: &str) -> Result<f64, String> {
    number_in(text, |x| (0.0..=MAX_SKEW).contains(&x), &format!("of seconds, from 0 to {MAX_SKEW}"))
}

/// A cell with its answer.
struct Answered<'a> {
    args: &'a CellArgs,
    cell: &'a Cell,
    plan: &'a CellPlan,
}

/// Plans a cell, and writes its motions.
///
/// # Errors
/// Bad input and I/O, and motions that cannot be timed.
pub fn run(args: &CellArgs) -> Result<u8, Failure> {
    let outputs = Outputs::new(&args.output, content, &args.picture, [])?.without_animation("a cell")?;
    let cell = Cell::load(&args.cell, &|path| crate::input::robot(path), args.clearance)?;
    refuse_to_overwrite_inputs(outputs.paths(), &cell.files)?;
    for arm in &cell.arms {
        let warnings = arm.problem.robot().warnings.iter();
        warnings.for_each(|warning| args.print.print_status(&format!("warning: {}: {warning}", arm.name)));
    }
    let settings = Settings { options: Options::default(), skew: args.skew, boxes: args.boxes };
    let plan = plan_cell(&cell, &settings, &mut |text| args.print.print_status(text))?;
    let answered = Answered { args, cell: &cell, plan: &plan };
    outputs.write(
        vec![],
        |path, format| match (format, &plan.outcome) {
            (Format::Json, _) => Ok(Some(field_per_line(&answered.json()).into_bytes())),
            (format, Outcome::Found(found)) => Ok(Some(files::motion(&cell, found, path, format).into_bytes())),
            _ => {
                sinks::warn_unwritten(path, "motions");
                Ok(None)
            }
        },
        |format| {
            let figure = || cplan_cell::figure(&cell, &plan, args.skew).on_background(args.theme.is_dark());
            Ok(format.bytes_of(figure, || cplan_cell::page(&cell, &plan, args.skew))?)
        },
    )?;
    let code = code_of(plan.status());
    args.print.report(code, || Ok(field_per_line(&answered.json())), || answered.summary())?;
    Ok(code)
}

/// Returns the format of an output by its extension.
fn content(path: &Path) -> Result<Format, Failure> {
    match Format::from_path(path)? {
        format @ (Format::Json | Format::Csv | Format::Yaml) => Ok(format),
        #[cfg(feature = "mcap")]
        Format::Mcap => {
            Err(Failure::Usage(format!("{}: motions of cells are written as .json, .csv or .yaml", path.display())))
        }
    }
}
