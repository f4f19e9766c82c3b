//! `cplan demo`: a built-in cell, for users without files.

use super::exit::DONE;
use super::failure::Failure;
use super::fresh::{folder, refuse_existing_files, word};
use super::plan::PlanArgs;
use super::{plan, sinks};
use crate::input::{Source, scene_from};
use crate::output::format_columns;
use clap::{Args, ValueEnum, ValueHint};
use std::path::{Path, PathBuf};

/// The robot of the demonstration.
pub const DEMO_ROBOT: &str = include_str!("../../robots/scara.urdf");
/// The world of the demonstration: the SCARA cell.
pub const DEMO_WORLD: &str = include_str!("../../workspaces/scara_cell.toml");

/// The pick-and-place cycle by which SCARAs are compared.
pub const ARCH_WORLD: &str = include_str!("../../workspaces/arch/pick_and_place.toml");

/// The built-in worlds, all of the same SCARA.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DemoKind {
    /// A motion in a cell with six obstacles.
    Scara,
    /// Pick and place with arch motions: 25 mm up, 305 mm across, 25 mm down.
    Arch,
}

impl DemoKind {
    /// Returns the name of the world in messages, and its text.
    fn world(self) -> [&'static str; 2] {
        match self {
            Self::Scara => ["built-in scara_cell.toml", DEMO_WORLD],
            Self::Arch => ["built-in pick_and_place.toml", ARCH_WORLD],
        }
    }
}

/// Names of the files that `cplan demo` writes.
const RESULT_FILE: &str = "plan.json";
const PICTURE_FILE: &str = "plan.html";

/// Plan in a built-in SCARA cell; write plan.json and plan.html.
///
/// All options of `cplan plan` also apply; `cplan help planners` lists those of planners.
#[derive(Debug, Args)]
#[command(after_help = "\
`cplan init --kind scara` writes the files of this cell.

Examples:
  cplan demo
  cplan demo --planner harmonic --force
  cplan demo --kind arch --dir arch
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
    let [name, world] = args.kind.world();
    let code = plan::answer(&args.plan, None, || {
        scene_from(Source::in_memory("built-in scara.urdf", DEMO_ROBOT), Source::in_memory(name, world))
    })?;
    if code == DONE && !args.plan.print.quiet && !args.plan.print.json {
        sinks::sum_up(&next(&picture), code)?;
    }
    Ok(code)
}

/// Returns the path of a file in the folder. If the folder is the current one, leaves it out.
pub fn in_folder(folder: &Path, name: &str) -> PathBuf {
    if folder == Path::new(".") { name.into() } else { folder.join(name) }
}

fn next(picture: &Path) -> String {
    let lines = [
        format!(
            "open {} in a browser: move the arm, play the motion, see both in the configuration space",
            word(picture)
        ),
        "cplan demo --planner harmonic --force     the same cell with another planner".into(),
        "cplan demo --kind arch --force            pick and place: the quill moves with the arm".into(),
        "cplan init --kind scara                   the files of this cell, to change".into(),
        "cplan init                                a small arm and world, every line explained".into(),
        "cplan --help                              all commands and options, with examples".into(),
    ];
    let labeled: Vec<_> =
        lines.into_iter().enumerate().map(|(i, line)| (if i == 0 { "next" } else { "" }, line)).collect();
    format_columns(&labeled)
}
