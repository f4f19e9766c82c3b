//! `cplan init`: writes a robot and a world with explanations of all keys, as a start. With numbers of a data sheet, it
//! writes that robot.

use super::arm_numbers::{ArmNumbers, scaled};
use super::data_sheet::DataSheet;
use super::demo::{self, in_folder};
use super::exit::DONE;
use super::failure::Failure;
use super::fresh::{folder, refuse_existing_files, word};
use super::{schema, sinks};
use crate::engine::{Options, Problem, plan};
use crate::input::{Overrides, Source, scene_from};
use crate::model::Status;
use crate::motion::write_whole_set;
use crate::output::format_columns;
use clap::{Args, ValueEnum, ValueHint};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Names of the files that `cplan init` writes.
const ROBOT_FILE: &str = "arm.urdf";
const WORLD_FILE: &str = "world.toml";
const CELL_FILE: &str = "cell.toml";
const SCHEMA_FILE: &str = "world.schema.json";

/// Text of the world file, with `{{marks}}` where the worlds of different arms differ.
const WORLD_TEMPLATE: &str = include_str!("starter/world.toml");

/// Texts for the marks, in a table for each kind of arm.
const MARKS: &str = include_str!("starter/marks.toml");

/// Explanation of the key `drives` in world files.
const MOTORS: &str =
    "\n# Where the elbow's motor is mounted: \"standard_scara\" for the base, \"direct\" for the upper arm.\n";

/// Write a robot and a world with comments, as a start.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  cplan init
  cplan init cell --kind pr
  cplan init scara --kind scara
  cplan init two_arms --kind cell
  cplan init mine --kind scara --links 0.225,0.225 --stroke 0.2 --limits 130,145
  cplan init plotter --kind 2r --links 0.2,0.2 --drives standard_scara

Exit codes: 0 the files are written, 1 they exist already or cannot be written,
2 wrong command line.")]
pub struct InitArgs {
    /// Folder for arm.urdf, world.toml and world.schema.json, or for arm.urdf and cell.toml; created if missing.
    #[arg(value_name = "DIR", default_value = ".", value_hint = ValueHint::DirPath)]
    pub dir: PathBuf,
    /// Kind of arm.
    #[arg(long, value_enum, value_name = "KIND", default_value_t = Kind::Rr)]
    pub kind: Kind,
    #[command(flatten)]
    pub sheet: DataSheet,
    /// Replace existing files.
    #[arg(long)]
    pub force: bool,
}

/// Arms to start from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// Two turning joints; 2r is the same.
    #[value(alias = "2r")]
    Rr,
    /// A turret with a ram that slides out: turning, then sliding; polar is the same.
    #[value(alias = "polar")]
    Rp,
    /// An arm on a rail: sliding, then turning.
    Pr,
    /// A gantry: two sliding joints; gantry is the same.
    #[value(alias = "gantry")]
    Pp,
    /// The cell of `cplan demo`, a SCARA among five obstacles; with numbers of a data sheet, a SCARA of these numbers
    /// among two obstacles.
    Scara,
    /// The pick-and-place cycle of `cplan demo --kind arch`.
    Arch,
    /// The cell of `cplan demo --kind cell`: two arms, for `cplan cell`.
    Cell,
}

/// Returns the text of the world of an arm with these numbers. `marks` is the name of its table in [`MARKS`]. Obstacles
/// are at `distance` times their distance in the template.
fn world(kind: Kind, marks: &str, numbers: &ArmNumbers, distance: f64) -> String {
    let all: BTreeMap<String, BTreeMap<String, String>> = toml::from_str(MARKS).expect("a table of texts for each arm");
    let [x, y] = numbers.scale(kind).map(|scale| scale * distance);
    let ratios = numbers.limit_ratios(kind);
    // Angles change only if the ranges are narrower than usual.
    let joints = [0, 1].map(|k| ratios[k].map(|ratio| if kind.turns()[k] { ratio.min(1.0) } else { ratio }));
    let filled = |world: String, (mark, text): (&String, &String)| {
        let text = match mark.as_str() {
            "limits2" => scaled(text, &ratios[1..]),
            "start" | "goal" => scaled(text, &joints),
            "tip" | "polygon" | "wall" | "region" => scaled(text, &[[x; 2], [y; 2]]),
            "disc" => scaled(text, &[[x; 2], [y; 2], [x.min(y); 2]]),
            _ => text.clone(),
        };
        world.replace(&format!("{{{{{mark}}}}}"), &text)
    };
    let drives = match (kind.turns(), numbers.drives) {
        ([true, true], Some(drives)) => format!("{MOTORS}drives = \"{drives}\""),
        ([true, true], None) => format!("{MOTORS}#drives = \"standard_scara\""),
        _ => String::new(),
    };
    let world = WORLD_TEMPLATE.replace("{{arm}}", ROBOT_FILE).replace("{{world}}", WORLD_FILE);
    all[marks].iter().fold(world.replace("{{drives}}", &drives), filled)
}

impl Kind {
    /// Returns the name in messages, with its article.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Rr => "an arm of two turning joints",
            Kind::Rp => "a turret with a ram",
            Kind::Pr => "an arm on a rail",
            Kind::Pp => "a gantry",
            Kind::Scara | Kind::Arch | Kind::Cell => "a SCARA",
        }
    }

    /// Returns true for each revolute joint, and false for each prismatic one.
    pub fn turns(self) -> [bool; 2] {
        match self {
            Kind::Rr | Kind::Scara | Kind::Arch | Kind::Cell => [true, true],
            Kind::Rp => [true, false],
            Kind::Pr => [false, true],
            Kind::Pp => [false, false],
        }
    }

    /// Returns the texts of the robot's file and of the world file.
    fn files(self) -> [String; 2] {
        let numbers = ArmNumbers::of(self);
        match self {
            Kind::Rr | Kind::Rp | Kind::Pr | Kind::Pp => self.files_by(&numbers, 1.0),
            Kind::Scara => [demo::DEMO_ROBOT.to_owned(), shipped(demo::DEMO_WORLD)],
            Kind::Arch => [demo::DEMO_ROBOT.to_owned(), shipped(demo::ARCH_WORLD)],
            Kind::Cell => [demo::DEMO_ROBOT.to_owned(), demo::CELL.to_owned()],
        }
    }

    /// Returns the texts of the robot's file and of the world file for an arm with these numbers. Obstacles are at this
    /// multiple of their usual distances.
    fn files_by(self, numbers: &ArmNumbers, distance: f64) -> [String; 2] {
        let marks = match self {
            Kind::Rr => "rr",
            Kind::Rp => "rp",
            Kind::Pr => "pr",
            Kind::Pp => "pp",
            Kind::Scara | Kind::Arch | Kind::Cell => "scara",
        };
        let mut world = world(self, marks, numbers, distance);
        if numbers.stroke > 0.0 {
            let joints = "joints = [\"axis_1\", \"axis_2\"]\n";
            let tool = "tip = \"flange\"\n# The quill and the wrist, for tasks: `stroke` and `wrist` in [start], [goal] and [[step]].\n\
                        stroke = { joint = \"axis_3\" }\nwrist = { joint = \"axis_4\", velocity = 20.0 }\n";
            world = world.replace(&format!("#{joints}"), joints).replace("#tip = \"tool0\"\n", tool);
        }
        [numbers.urdf(self), world]
    }

    /// Returns the files for an arm with these numbers. Obstacles are at the first of the [`DISTANCES`] for which the
    /// motion is found. If there is none, they are commented out.
    fn files_of_sheet(self, numbers: &ArmNumbers) -> [String; 2] {
        let mut candidates = DISTANCES.into_iter().map(|distance| self.files_by(numbers, distance));
        if let Some(files) = candidates.find(|[robot, world]| is_found(robot, world)) {
            return files;
        }
        let [robot, world] = self.files_by(numbers, 1.0);
        let first = world.find("\n[[obstacle]]").map_or(world.len(), |at| at + 1);
        let commented = |line: &str| match line {
            "" => String::new(),
            line if line.starts_with('#') => line.to_owned(),
            line => format!("#{line}"),
        };
        let obstacles: Vec<String> = world[first..].lines().map(commented).collect();
        [robot, world[..first].to_owned() + &obstacles.join("\n") + "\n"]
    }
}

/// Multiples of the obstacles' distances in the template, in the order in which they are tried.
const DISTANCES: [f64; 8] = [1.0, 1.1, 0.9, 1.2, 0.8, 1.35, 0.7, 1.5];

/// Returns true if the motion of this world is found.
fn is_found(robot: &str, world: &str) -> bool {
    let [robot, world] = [(ROBOT_FILE, robot), (WORLD_FILE, world)].map(|(name, text)| Source::in_memory(name, text));
    let problem = scene_from(robot, world).and_then(|scene| Problem::of_scene(scene, &Overrides::default()));
    let plan = problem.ok().and_then(|problem| plan(&problem, &Options::default()).ok());
    plan.is_some_and(|plan| plan.status() == Status::Found)
}

/// Returns a shipped world without lines that only the tests need.
fn shipped(world: &str) -> String {
    let lines = world.lines().filter(|line| !line.starts_with("# robot:") && !line.starts_with("# expect:"));
    lines.fold(format!("#:schema ./{SCHEMA_FILE}\n"), |text, line| text + line + "\n")
}

/// Writes the files, and prints further commands to try.
///
/// # Errors
/// Files that exist already, and I/O. If there is an error, no file is written.
pub fn run(args: &InitArgs) -> Result<u8, Failure> {
    let is_cell = args.kind == Kind::Cell;
    let world_file = if is_cell { CELL_FILE } else { WORLD_FILE };
    let [robot, world, schema_file] = [ROBOT_FILE, world_file, SCHEMA_FILE].map(|name| in_folder(&args.dir, name));
    let mut names = vec![robot.clone(), world.clone()];
    // The schema is that of worlds.
    names.extend((!is_cell).then(|| schema_file.clone()));
    refuse_existing_files(&names, args.force, "`cplan init DIR` writes elsewhere")?;
    let numbers = (!args.sheet.is_empty()).then(|| args.sheet_numbers()).transpose()?;
    folder(&args.dir)?;
    let [robot_text, world_text] =
        numbers.as_ref().map_or_else(|| args.kind.files(), |numbers| args.kind.files_of_sheet(numbers));
    let texts = [robot_text, world_text, schema::WORLD_SCHEMA.to_owned()];
    let files: Vec<(PathBuf, String)> = names.into_iter().zip(texts).collect();
    write_whole_set(&files)?;
    let words = numbers.map(|numbers| numbers.words(args.kind));
    sinks::report(&match is_cell {
        true => description_of_cell(&args.dir, &robot, &world),
        false => description([&robot, &world, &schema_file], words.as_deref()),
    })?;
    Ok(DONE)
}

impl InitArgs {
    fn sheet_numbers(&self) -> Result<ArmNumbers, Failure> {
        match self.kind {
            Kind::Pr | Kind::Arch | Kind::Cell => {
                let message = "numbers of a data sheet need --kind rr, rp, pp or scara";
                Err(Failure::Usage(message.to_owned()))
            }
            kind => self.sheet.numbers(kind),
        }
    }
}

/// Describes the written files of a cell and the next commands.
fn description_of_cell(folder: &Path, robot: &Path, cell: &Path) -> String {
    let command = format!("cplan cell {}", word(cell));
    let [result, picture, left, right] =
        ["cell.json", "cell.html", "left.mod", "right.mod"].map(|name| word(&in_folder(folder, name)));
    format_columns(&[
        ("file", format!("{}: the robot of both arms", robot.display())),
        ("file", format!("{}: both arms, their goals and the obstacles, with every key explained", cell.display())),
        ("next", format!("{command} --output {result} --picture {picture}")),
        ("next", format!("cplan verify {} {result}", word(cell))),
        ("next", format!("{command} --template rapid --output {left} --output {right}")),
    ])
}

/// Describes the written files and the next commands.
/// `numbers` are those of a data sheet.
fn description([robot, world, schema]: [&Path; 3], numbers: Option<&str>) -> String {
    let both = format!("{} {}", word(robot), word(world));
    let bodies = numbers.map(|numbers| format!("; {numbers}; the shapes are simple envelopes")).unwrap_or_default();
    format_columns(&[
        ("file", format!("{}: the robot{bodies}", robot.display())),
        ("file", format!("{}: start, goal and obstacles, with every key explained", world.display())),
        ("file", format!("{}: with this file, editors complete and explain the keys of the world", schema.display())),
        ("next", format!("cplan {both} --picture plan.html")),
        ("next", format!("cplan check {both} --at 0.3,0.4")),
        ("next", format!("cplan inspect {both}")),
        ("next", format!("cplan compare {both}")),
    ])
}
