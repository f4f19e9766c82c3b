//! `cplan converge`: convergence of relaxations on a world's grid.

use super::exit::DONE;
use super::failure::Failure;
use super::files::Files;
use super::headings::{OUTPUT, RELAXATION};
use super::outputs::{Outputs, by_extension, refuse_to_overwrite_inputs};
use super::print_args::PrintArgs;
use super::query_args::QueryArgs;
use super::sinks;
use super::theme::ThemeArgs;
use crate::compare::{Setup, convergence};
use crate::cspace::ZonedGrid;
use crate::engine::{CellCounts, Problem, field_on_cells};
use crate::field::{Difference, Direction, Domain, Equation, Initial, Limits, Measure, Order, Stencil, Stopping};
use crate::input;
use crate::options::{INITIALS, LIMITS, MEASURES, ORDERS, direction, finite, positive, word};
use crate::output::{PictureFormat, title_of};
use crate::planner::EquationChoice;
use clap::{Args, ValueHint};
use std::path::{Path, PathBuf};

/// Report how relaxations of the harmonic planner's fields converge.
///
/// The report gives errors and sweeps by relaxation, order, factor and drift.
#[derive(Debug, Args)]
#[command(after_help = "\
The measured relaxations are Jacobi, weighted Jacobi (0.8), Gauss-Seidel and
SOR. Gauss-Seidel and SOR go row by row, from the four corners in turn, and
red-black; SOR uses the formula for empty rectangles. The cells are those of the
harmonic planner: obstacles have the value 0, goals 1. As in the planner, SOR
keeps all values in this range.

The equations are harmonic, and oriented (by central and by upwind differences).
For worlds with preferences they are also local (by both differences;
--direction applies to regions without a direction), bvp and bvp2. The error is
the difference from the solution by elimination. Divergence is reported.

Examples:
  cplan converge robots/planar_2r.urdf workspaces/shelf.toml --cells 24
  cplan converge robots/planar_2r.urdf workspaces/u_trap.toml --cells 24 \\
    --epsilon 1 --direction 0,-1 --picture sweeps.svg
  cplan converge robots/scara.urdf workspaces/scara_cell.toml --cells 32 \\
    --order red-black --output sweeps.csv --quiet

Exit codes: 0 measured, 1 bad input or I/O, 2 wrong command line.")]
pub struct ConvergeArgs {
    #[command(flatten)]
    pub files: Files,
    #[command(flatten)]
    pub query: QueryArgs,
    /// Number of grid cells along each axis, 8 to 256, or one number per joint, such as 80x40. Except for SOR, the
    /// number of sweeps grows with the square of this number: 256 cells take minutes.
    #[arg(long, value_name = "N|AxB", default_value = "64", value_parser = cells, allow_hyphen_values = true)]
    #[arg(help_heading = RELAXATION)]
    pub cells: CellCounts,
    /// Strength of the drift per grid cell in the oriented equations.
    #[arg(long, value_name = "E", default_value_t = 0.5, value_parser = finite, allow_hyphen_values = true)]
    #[arg(help_heading = RELAXATION)]
    pub epsilon: f64,
    /// Direction of the drift in joint space, also in [[preference]] regions without a direction.
    #[arg(long, value_name = "v1,v2", default_value = "1,0", value_parser = direction, allow_hyphen_values = true)]
    #[arg(help_heading = RELAXATION)]
    pub direction: Direction,
    /// Order of the cells in a sweep, in the measurements with many factors and epsilons.
    #[arg(long, value_parser = word(ORDERS), value_name = "NAME", default_value = "rows", help_heading = RELAXATION)]
    pub order: Order,
    /// Effect of the joint limits on the field.
    #[arg(long, value_parser = word(LIMITS), value_name = "NAME", default_value = "high")]
    #[arg(help_heading = RELAXATION)]
    pub limits: Limits,
    /// Value of free cells before the first sweep.
    #[arg(long, value_parser = word(INITIALS), value_name = "NAME", default_value = "high")]
    #[arg(help_heading = RELAXATION)]
    pub initial: Initial,
    /// Measure of a sweep's changes, which must fall below the tolerance.
    #[arg(long, value_parser = word(MEASURES), value_name = "NAME", default_value = "relative")]
    #[arg(help_heading = RELAXATION)]
    pub measure: Measure,
    /// Relax until the measure is below this.
    #[arg(long, value_name = "SIZE", default_value_t = 1e-6, value_parser = positive, allow_hyphen_values = true)]
    #[arg(help_heading = RELAXATION)]
    pub tolerance: f64,
    /// Maximum number of sweeps.
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(1..))]
    #[arg(help_heading = RELAXATION)]
    pub max_sweeps: u32,
    /// Write all measurements: .csv (one line per sample) or .json. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub output: Vec<PathBuf>,
    /// Draw charts of errors and sweeps: .svg, .png or .html (with the tables). Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub picture: Vec<PathBuf>,
    #[command(flatten)]
    pub theme: ThemeArgs,
    #[command(flatten)]
    pub print: PrintArgs,
}

/// Measures how fast relaxation converges, and prints the result.
///
/// # Errors
/// Bad input and I/O.
pub fn run(args: &ConvergeArgs) -> Result<u8, Failure> {
    let description = "the name of a file of measurements must end in .csv or .json";
    let content = by_extension(&[("csv", true), ("json", false)], description);
    let outputs = Outputs::new(&args.output, content, &args.picture, [])?;
    let loaded = input::load_scene(args.files.robot(), &args.files.world)?;
    refuse_to_overwrite_inputs(outputs.paths(), &loaded.files())?;
    loaded.robot.warnings.iter().for_each(|w| sinks::print_status(&format!("warning: {w}")));
    loaded.require_static_obstacles("fields need static obstacles")?;
    let problem = Problem::of_scene(loaded, &args.query.overrides())?;
    let motion = problem.motion().ok_or_else(|| {
        let world = args.files.world.display();
        Failure::Refused(format!(
            "{world}: a world with steps has a different field for each motion\n  hint: use a world with a start and a goal"
        ))
    })?;
    let (space, domain) = field_on_cells(motion, args.cells, args.limits)
        .map_err(|reason| Failure::Refused(format!("{reason}\n  hint: more --cells")))?;
    let domain = domain.with_initial(args.initial);
    let setup = args.setup(title_of(problem.scene()), &space, &domain).map_err(Failure::Refused)?;
    let measured = convergence(&setup, &mut |text| args.print.print_status(&format!("{text} ...")))
        .map_err(|error| Failure::Refused(error.to_string()))?;
    let json = || sinks::pretty(&measured.to_json());
    let table = |_: &Path, is_csv| Ok(Some(if is_csv { measured.to_csv() } else { json()? }.into_bytes()));
    let figure = || measured.figure().on_background(args.theme.is_dark());
    let chart = |format: PictureFormat| Ok(format.bytes_of(figure, || measured.to_html())?);
    outputs.write(vec![], table, chart)?;
    args.print.report(DONE, json, || measured.to_text())?;
    Ok(DONE)
}

/// Greatest number of cells along an axis. With more, the hundreds of relaxations would take hours.
const MAX_CELLS: usize = 256;

fn cells(text: &str) -> Result<CellCounts, String> {
    let fits = |CellCounts(counts): &CellCounts| counts.iter().all(|&n| n <= MAX_CELLS);
    text.parse::<CellCounts>().ok().filter(fits).ok_or_else(|| {
        format!("must be a number from 8 to {MAX_CELLS}, or two such numbers, one per joint, such as 80x40")
    })
}

impl ConvergeArgs {
    fn setup<'a>(&self, title: String, space: &'a ZonedGrid, domain: &'a Domain) -> Result<Setup<'a>, String> {
        let oriented =
            |difference| EquationChoice::Oriented { direction: self.direction, epsilon: self.epsilon, difference };
        let mut choices = vec![
            ("harmonic", EquationChoice::Harmonic),
            ("oriented, central", oriented(Difference::Central)),
            ("oriented, upwind", oriented(Difference::Upwind)),
        ];
        if !space.zones.is_empty() {
            let local = |difference| EquationChoice::LocallyOriented { direction: Some(self.direction), difference };
            choices.extend([
                ("local, central", local(Difference::Central)),
                ("local, upwind", local(Difference::Upwind)),
                ("bvp", EquationChoice::Preference { elsewhere: 0.0, difference: Difference::Central }),
                ("bvp2", EquationChoice::AlteredPreference { elsewhere: 0.0 }),
            ]);
        }
        let equations =
            choices.into_iter().map(|(name, choice)| Ok((name.to_owned(), choice.on(space, Stencil::Square)?)));
        let equations: Vec<(String, Equation)> = equations.collect::<Result<_, String>>()?;
        let in_cells = equations.iter().find_map(|(_, equation)| match equation {
            Equation::Oriented { direction, .. } => Some(*direction),
            _ => None,
        });
        let stopping = Stopping { measure: self.measure, below: self.tolerance, max_sweeps: self.max_sweeps as usize };
        Ok(Setup {
            title,
            domain,
            equations,
            direction: in_cells.unwrap_or(self.direction),
            order: self.order,
            stopping,
        })
    }
}
