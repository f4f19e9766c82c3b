//! `cplan init`: writes a robot and a world to begin with, in which every key is explained.

use super::demo::{self, in_folder};
use super::exit::DONE;
use super::failure::Failure;
use super::fresh::{folder, refuse_existing_files, word};
use super::{schema, sinks};
use crate::motion::write_whole_set;
use crate::output::format_columns;
use clap::{Args, ValueEnum, ValueHint};
use std::path::{Path, PathBuf};

/// Names of the files that `cplan init` writes.
const ROBOT_FILE: &str = "arm.urdf";
const WORLD_FILE: &str = "world.toml";
const SCHEMA_FILE: &str = "world.schema.json";

/// Text of the world file, in which `{{marks}}` stand where worlds of different arms differ.
const WORLD_TEMPLATE: &str = include_str!("starter/world.toml");

/// Write a robot and a world with comments, as a start.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  cplan init
  cplan init cell --kind pr
  cplan init scara --kind scara

Exit codes: 0 the files are written, 1 they exist already or cannot be written,
2 wrong command line.")]
pub struct InitArgs {
    /// Folder for arm.urdf, world.toml and world.schema.json; created if missing.
    #[arg(value_name = "DIR", default_value = ".", value_hint = ValueHint::DirPath)]
    pub dir: PathBuf,
    /// Kind of arm.
    #[arg(long, value_enum, value_name = "KIND", default_value_t = Kind::Rr)]
    pub kind: Kind,
    /// Replace existing files.
    #[arg(long)]
    pub force: bool,
}

/// Arms to start from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// Two turning joints.
    Rr,
    /// A turret with a ram that slides out of it: turning, then sliding.
    Rp,
    /// An arm on a rail: sliding, then turning.
    Pr,
    /// A gantry: two sliding joints.
    Pp,
    /// The cell of `cplan demo`, a SCARA among six obstacles.
    Scara,
    /// The pick-and-place cycle of `cplan demo --kind arch`.
    Arch,
}

/// Texts that replace the marks of the template.
struct TemplateMarks {
    name: &'static str,
    joints: [&'static str; 2],
    units: [&'static str; 2],
    /// A range of the second joint that is narrower than the URDF's.
    limits: &'static str,
    start: &'static str,
    goal: &'static str,
    tip: &'static str,
    /// Name and corners of the polygon.
    polygon: [&'static str; 2],
    /// Name of the disc, and its centre and radius.
    disc: [&'static str; 2],
    wall: &'static str,
    region: &'static str,
    /// True if objects on the table need heights, because a part of the arm moves above all of them.
    is_above: bool,
}

const RR_MARKS: TemplateMarks = TemplateMarks {
    name: "my cell",
    joints: ["shoulder", "elbow"],
    units: ["rad", "rad"],
    limits: "[-2.0, 2.0]",
    start: "[-0.9, 0.5]",
    goal: "[1.5, -0.4]",
    tip: "[0.3, 0.6]",
    polygon: ["shelf", "[[0.6, 0.1], [0.9, 0.1], [0.9, 0.2], [0.6, 0.2]]"],
    disc: ["post", "{ center = [0.1, -0.7], radius = 0.05 }"],
    wall: "[[-0.5, -0.8], [-0.5, 0.8]]",
    region: "[[0.2, 0.3], [0.5, 0.3], [0.5, 0.6]]",
    is_above: false,
};

const RP_MARKS: TemplateMarks = TemplateMarks {
    name: "my cell",
    joints: ["turret", "ram_slide"],
    units: ["rad", "m"],
    limits: "[0.0, 0.5]",
    start: "[-0.9, 0.4]",
    goal: "[1.2, 0.4]",
    tip: "[0.3, 0.7]",
    polygon: ["shelf", "[[0.65, 0.1], [0.95, 0.1], [0.95, 0.2], [0.65, 0.2]]"],
    disc: ["post", "{ center = [0.1, -0.8], radius = 0.05 }"],
    wall: "[[-0.5, -0.8], [-0.5, 0.8]]",
    region: "[[0.2, 0.3], [0.5, 0.3], [0.5, 0.6]]",
    is_above: false,
};

const PR_MARKS: TemplateMarks = TemplateMarks {
    name: "my cell",
    joints: ["rail", "pivot"],
    units: ["m", "rad"],
    limits: "[-2.5, 2.5]",
    start: "[-0.6, 1.2]",
    goal: "[0.6, 1.9]",
    tip: "[0.5, 0.4]",
    polygon: ["machine", "[[-0.15, 0.2], [0.15, 0.2], [0.15, 0.4], [-0.15, 0.4]]"],
    disc: ["post", "{ center = [0.7, -0.35], radius = 0.05 }"],
    wall: "[[-0.9, -0.6], [0.9, -0.6]]",
    region: "[[-0.4, 0.2], [-0.2, 0.2], [-0.2, 0.4]]",
    is_above: false,
};

const PP_MARKS: TemplateMarks = TemplateMarks {
    name: "my table",
    joints: ["bridge_slide", "head_slide"],
    units: ["m", "m"],
    limits: "[0.0, 0.85]",
    start: "[0.1, 0.1]",
    goal: "[1.1, 0.8]",
    tip: "[1.0, 0.2]",
    polygon: ["machine", "[[0.4, 0.2], [0.8, 0.2], [0.8, 0.4], [0.6, 0.4], [0.6, 0.7], [0.4, 0.7]]"],
    disc: ["post", "{ center = [0.9, 0.7], radius = 0.05 }"],
    wall: "[[0.25, 0.5], [0.25, 1.0]]",
    region: "[[0.8, 0.1], [1.0, 0.1], [1.0, 0.3]]",
    is_above: true,
};

impl TemplateMarks {
    /// Returns the text of the world.
    fn world(&self) -> String {
        let [joint1, joint2] = self.joints;
        let [unit1, unit2] = self.units;
        let height = "height = [0.0, 0.3]";
        let above = |text: &str| if self.is_above { text.to_owned() } else { String::new() };
        let marks: [(&str, &str); 20] = [
            ("arm", ROBOT_FILE),
            ("world", WORLD_FILE),
            ("name", self.name),
            ("joint1", joint1),
            ("joint2", joint2),
            ("unit1", unit1),
            ("unit2", unit2),
            ("limits2", self.limits),
            ("start", self.start),
            ("goal", self.goal),
            ("tip", self.tip),
            ("polygon_name", self.polygon[0]),
            ("polygon", self.polygon[1]),
            ("height", &if self.is_above { height.to_owned() } else { format!("#{height}") }),
            ("disc_name", self.disc[0]),
            ("disc", self.disc[1]),
            ("more_height", &above(&format!("\n{height}"))),
            ("wall", self.wall),
            ("wall_height", &above(&format!("\n#{height}"))),
            ("region", self.region),
        ];
        marks
            .iter()
            .fold(WORLD_TEMPLATE.to_owned(), |text, (mark, with)| text.replace(&format!("{{{{{mark}}}}}"), with))
    }
}

impl Kind {
    /// Returns the text of the robot's file.
    fn robot(self) -> &'static str {
        match self {
            Kind::Rr => include_str!("starter/rr.urdf"),
            Kind::Rp => include_str!("starter/rp.urdf"),
            Kind::Pr => include_str!("starter/pr.urdf"),
            Kind::Pp => include_str!("starter/pp.urdf"),
            Kind::Scara | Kind::Arch => demo::DEMO_ROBOT,
        }
    }

    /// Returns the text of the world file.
    fn world(self) -> String {
        match self {
            Kind::Rr => RR_MARKS.world(),
            Kind::Rp => RP_MARKS.world(),
            Kind::Pr => PR_MARKS.world(),
            Kind::Pp => PP_MARKS.world(),
            Kind::Scara => shipped(demo::DEMO_WORLD),
            Kind::Arch => shipped(demo::ARCH_WORLD),
        }
    }
}

/// Returns a shipped world without the lines that only the tests of shipped worlds need.
fn shipped(world: &str) -> String {
    let lines = world.lines().filter(|line| !line.starts_with("# robot:") && !line.starts_with("# expect:"));
    lines.fold(format!("#:schema ./{SCHEMA_FILE}\n"), |text, line| text + line + "\n")
}

/// Writes the files, and prints further commands to try.
///
/// # Errors
/// Files that exist already, and I/O. If there is an error, no file is written.
pub fn run(args: &InitArgs) -> Result<u8, Failure> {
    let [robot, world, schema_file] = [ROBOT_FILE, WORLD_FILE, SCHEMA_FILE].map(|name| in_folder(&args.dir, name));
    refuse_existing_files(
        &[robot.clone(), world.clone(), schema_file.clone()],
        args.force,
        "`cplan init DIR` writes elsewhere",
    )?;
    folder(&args.dir)?;
    let files = [
        (robot.clone(), args.kind.robot().to_owned()),
        (world.clone(), args.kind.world()),
        (schema_file.clone(), schema::WORLD_SCHEMA.to_owned()),
    ];
    write_whole_set(&files)?;
    sinks::report(&description(&robot, &world, &schema_file))?;
    Ok(DONE)
}

/// Describes the written files and the next commands.
fn description(robot: &Path, world: &Path, schema: &Path) -> String {
    let both = format!("{} {}", word(robot), word(world));
    format_columns(&[
        ("file", format!("{}: the robot", robot.display())),
        ("file", format!("{}: start, goal and obstacles, every key explained", world.display())),
        ("file", format!("{}: lets editors complete and explain the keys of the world", schema.display())),
        ("next", format!("cplan {both} --picture plan.html")),
        ("next", format!("cplan check {both} --at 0.3,0.4")),
        ("next", format!("cplan inspect {both}")),
        ("next", format!("cplan compare {both}")),
    ])
}
