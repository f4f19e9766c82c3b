//! `cplan demo`: a built-in cell, for users without files.

use super::cell::{self, CellArgs};
use super::exit::DONE;
use super::failure::Failure;
use super::follow::{self, FollowArgs};
use super::fresh::{folder, refuse_existing_files, word};
use super::plan::PlanArgs;
use super::print_args::PrintArgs;
use super::{plan, sinks};
use crate::input::{InputError, LoadedScene, Source, scene_from};
use crate::output::format_columns;
use clap::{Args, ValueEnum, ValueHint};
use cplan_cell::Cell;
use cplan_handling::FollowedLine;
use cplan_toolpath::{Format, Placement, read};
use std::ffi::OsString;
use std::mem::take;
use std::path::{Path, PathBuf};

/// The robot of the demonstration.
pub const DEMO_ROBOT: &str = include_str!("../../robots/scara.urdf");
/// The world of the demonstration: the SCARA cell.
pub const DEMO_WORLD: &str = include_str!("../../workspaces/scara_cell.toml");

/// The standard pick-and-place cycle for the comparison of SCARAs.
pub const ARCH_WORLD: &str = include_str!("../../workspaces/arch/pick_and_place.toml");

/// Robot, world and line of the demonstration of lines.
const FOLLOW_FILES: [[&str; 2]; 3] = [
    ["built-in planar_2r.urdf", include_str!("../../robots/planar_2r.urdf")],
    ["built-in engraving.toml", include_str!("../../workspaces/follow/engraving.toml")],
    ["built-in plate.gcode", include_str!("../../workspaces/follow/plate.gcode")],
];

/// The cell of the demonstration of two arms. Both have the robot [`DEMO_ROBOT`].
pub const CELL: &str = include_str!("starter/cell.toml");

/// The built-in worlds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DemoKind {
    /// A motion in a cell with five obstacles.
    Scara,
    /// Pick and place with arch motions: 25 mm up, 305 mm across, 25 mm down.
    Arch,
    /// The tip follows a line of G-code, as with `cplan follow`.
    Follow,
    /// Two arms share a tray, as with `cplan cell`.
    Cell,
}

impl DemoKind {
    /// Reads the robot and the world. The kind without a world has that of its robot.
    fn load(self) -> Result<LoadedScene, InputError> {
        const SCARA: [&str; 2] = ["built-in scara.urdf", DEMO_ROBOT];
        let files = match self {
            Self::Scara | Self::Cell => [SCARA, ["built-in scara_cell.toml", DEMO_WORLD]],
            Self::Arch => [SCARA, ["built-in pick_and_place.toml", ARCH_WORLD]],
            Self::Follow => [FOLLOW_FILES[0], FOLLOW_FILES[1]],
        };
        let [robot, world] = files.map(|[name, text]| Source::in_memory(name, text));
        scene_from(robot, world)
    }
}

/// Names of the files that `cplan demo` writes.
const RESULT_FILE: &str = "plan.json";
const PICTURE_FILE: &str = "plan.html";

/// Plan in a built-in cell; write plan.json and plan.html.
///
/// All options of `cplan plan` also apply; `cplan help planners` lists the options of planners. With `--kind follow`
/// and `--kind cell`, only options that `cplan follow` and `cplan cell` have as well apply.
#[derive(Debug, Args)]
#[command(after_help = "\
`cplan init --kind scara` writes the files of this cell.

Examples:
  cplan demo
  cplan demo --planner harmonic --force
  cplan demo --kind arch --dir arch
  cplan demo --kind follow --dir engraving
  cplan demo --kind cell --dir two_arms
  cplan demo --dir wider --clearance 0.02 --goal-tip 0.1,0.45

Exit codes: those of `cplan plan`, such as 0 found and certified; 1 also if the
files exist already; 2 wrong command line.")]
pub struct DemoArgs {
    /// The built-in world.
    #[arg(long, value_enum, value_name = "KIND", default_value_t = DemoKind::Scara)]
    pub kind: DemoKind,
    /// Folder for plan.json and plan.html; created if missing.
    #[arg(long, value_name = "DIR", default_value = ".", value_hint = ValueHint::DirPath)]
    pub dir: PathBuf,
    /// Replace an existing plan.json and plan.html.
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub plan: PlanArgs,
}

/// Plans in the built-in cell as `cplan plan` does, and prints further commands to try. The exit code is that of `cplan
/// plan`.
///
/// # Errors
/// Existing files, I/O, and options that do not suit the cell.
pub fn run(args: &mut DemoArgs) -> Result<u8, Failure> {
    let [result, picture] = [RESULT_FILE, PICTURE_FILE].map(|name| in_folder(&args.dir, name));
    refuse_existing_files(&[result.clone(), picture.clone()], args.force, "--dir DIR writes elsewhere")?;
    folder(&args.dir)?;
    args.plan.output.insert(0, result);
    args.plan.picture.insert(0, picture.clone());
    let kind = args.kind;
    let code = match kind {
        DemoKind::Scara | DemoKind::Arch => plan::answer(&args.plan, None, || kind.load())?,
        DemoKind::Cell => cell::answer(&cell_args(&mut args.plan)?, built_in_cell)?,
        DemoKind::Follow => follow::answer(&follow_args(&mut args.plan)?, |_| kind.load(), |_| built_in_line())?,
    };
    if code == DONE && !args.plan.print.quiet && !args.plan.print.json {
        sinks::sum_up(&next(&picture, &args.dir), code)?;
    }
    Ok(code)
}

/// Moves the options for outputs, clearance and printed text to those of `cplan follow`.
///
/// # Errors
/// Options that `cplan follow` does not have.
fn follow_args(plan: &mut PlanArgs) -> Result<FollowArgs, Failure> {
    let follow_words = ["follow"].into_iter().chain(FOLLOW_FILES.map(|file| file[0]));
    let mut follow: FollowArgs = of_words(follow_words)?;
    (follow.output, follow.picture) = (take(&mut plan.output), take(&mut plan.picture));
    (follow.verbose, follow.clearance) = (take(&mut plan.verbose), plan.query.clearance.take());
    let PrintArgs { json, quiet } = plan.print;
    follow.print = PrintArgs { json, quiet };
    std::mem::swap(&mut follow.theme, &mut plan.theme);
    let all = "--kind follow takes only --output, --picture, --clearance, --theme, --json, --quiet and --verbose";
    refuse_others(plan, &format!("{all}; for more, call `cplan follow` with files"))?;
    Ok(follow)
}

/// Moves the options for outputs, clearance, programs and printed text to those of `cplan cell`.
///
/// # Errors
/// Options that `cplan cell` does not have.
fn cell_args(plan: &mut PlanArgs) -> Result<CellArgs, Failure> {
    let mut cell: CellArgs = of_words(["cell", CELL_FILE])?;
    (cell.output, cell.picture) = (take(&mut plan.output), take(&mut plan.picture));
    cell.clearance = plan.query.clearance.take();
    let PrintArgs { json, quiet } = plan.print;
    cell.print = PrintArgs { json, quiet };
    std::mem::swap(&mut cell.theme, &mut plan.theme);
    std::mem::swap(&mut cell.program, &mut plan.program);
    let all = "--kind cell takes only --output, --picture, --template, --joint-tolerance, --clearance, --theme, --json \
               and --quiet";
    refuse_others(plan, &format!("{all}; for more, call `cplan cell` with files"))?;
    Ok(cell)
}

/// Checks that all options have their defaults, except those for printed text.
///
/// # Errors
/// The message, if some option has another value.
fn refuse_others(plan: &PlanArgs, message: &str) -> Result<(), Failure> {
    let PrintArgs { json, quiet } = plan.print;
    let unset = PlanArgs { print: PrintArgs { json, quiet }, ..of_words(["demo"])? };
    if *plan == unset { Ok(()) } else { Err(Failure::Usage(message.to_owned())) }
}

/// Name of the built-in cell in messages.
const CELL_FILE: &str = "built-in cell.toml";

fn built_in_cell(clearance: Option<f64>) -> Result<Cell, InputError> {
    let robot = |path: &Path| Ok(Source::in_memory(format!("built-in {}", path.display()), DEMO_ROBOT));
    Cell::load(&Source::in_memory(CELL_FILE, CELL), &robot, clearance)
}

/// Returns the arguments of a command line.
fn of_words<A: Args>(words: impl IntoIterator<Item = &'static str>) -> Result<A, Failure> {
    let words: Vec<OsString> = words.into_iter().map(OsString::from).collect();
    super::read(&words)
        .ok_or_else(|| Failure::Usage("internal error: the options of the demonstration have no defaults".into()))
}

fn built_in_line() -> Result<FollowedLine, Failure> {
    let [name, text] = FOLLOW_FILES[2];
    let line = read(text.as_bytes(), Format::GCode, &Placement::default());
    line.map(FollowedLine::from).map_err(|error| Failure::Refused(format!("{name}: {}", error.message)))
}

/// Returns the path of a file in the folder. Omits the folder if it is the current one.
pub fn in_folder(folder: &Path, name: &str) -> PathBuf {
    if folder == Path::new(".") { name.into() } else { folder.join(name) }
}

/// Number of blanks between the longest command and its description.
const COLUMN_GAP: usize = 5;

/// Returns the lines about further commands. Further demonstrations write into the same folder.
fn next(picture: &Path, folder: &Path) -> String {
    let folder = if folder == Path::new(".") { String::new() } else { format!(" --dir {}", word(folder)) };
    let commands = [
        (format!("demo --planner harmonic --force{folder}"), "the same cell, with another planner"),
        (format!("demo --kind arch --force{folder}"), "pick and place; the quill moves while the arm moves"),
        (format!("demo --kind cell --force{folder}"), "two arms share a tray, on one clock"),
        (format!("demo --kind follow --force{folder}"), "the tip follows a line of G-code within 0.01 mm"),
        ("init scara --kind scara".to_owned(), "the files of this cell, for you to change"),
        ("init small_arm".to_owned(), "a small arm and world, with every line explained"),
        ("--help".to_owned(), "all commands and options, with examples"),
    ];
    let width = commands.iter().map(|(command, _)| command.len()).max().unwrap_or(0) + COLUMN_GAP;
    let open = format!(
        "open {} in a browser: move the arm, play the motion, see both in the configuration space",
        word(picture)
    );
    let commands = commands.iter().map(|(command, about)| ("", format!("cplan {command:width$}{about}")));
    let labeled: Vec<_> = [("next", open)].into_iter().chain(commands).collect();
    format_columns(&labeled)
}
