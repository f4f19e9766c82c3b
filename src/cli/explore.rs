//! `cplan explore`: planning in a world that is discovered step by step.

use super::exit::code_of;
use super::failure::Failure;
use super::files::Files;
use super::headings::{EXPLORATION, OUTPUT, PLANNER};
use super::outputs::{Outputs, refuse_to_overwrite_inputs};
use super::print_args::PrintArgs;
use super::query_args::QueryArgs;
use super::sinks;
use super::theme::ThemeArgs;
use crate::engine::{CellCounts, Method, Options};
use crate::explore::{
    Ending, Exploration, ExploreError, Settings, Strategy, exploration_page, explore, map_description, map_picture,
};
use crate::input::{self, LoadedProblem, OccupancyMap, Rules};
use crate::model::{Arm, Scene, Status};
use crate::motion::{Format, JointMotion, Trajectory, csv, ros_yaml};
use crate::options::{PlannerArgs, Word, planners, positive, word};
use crate::output::{CSpaceFormat, Line, PictureFormat, contours, format_columns, title_of};
use crate::space::{Configuration, Path as JointPath};
use crate::text::{chosen_length, counted};
use crate::view::{self, Picture, View};
use clap::{Args, ValueHint};
use std::path::{Path, PathBuf};

/// Plan in an unknown world that a range sensor reveals.
///
/// All options of `cplan plan`'s planner group also apply: see `cplan help planners`.
#[derive(Debug, Args)]
#[command(after_help = "\
The world file describes the real world. The arm knows only the space that its
range sensor has seen; unseen space counts as solid. The table [sensor] of the
world file describes the sensor: its place (tip or base), rays, field of view,
range and noise. Each motion is certified within known free space before it
begins.

An exploration ends in one of these ways:
  reached      the arm is at the goal
  explored     no reachable configuration of the grid shows anything new
  unreachable  proven: no path leads to the goal in the known space, where cells
               of the map that contain anything count as solid

Examples:
  cplan explore robots/planar_2r.urdf workspaces/shelf.toml
  cplan explore robots/planar_2r.urdf workspaces/shelf.toml \\
    --strategy nearest --picture explored.html --map map.yaml
  cplan explore robots/gantry.urdf workspaces/explore/rooms.toml \\
    --strategy harmonic --output explored.json

Exit codes: 0 reached or explored, 1 bad input or I/O, 2 wrong command line, 3
proven that no path leads to the goal in the known space, 4 unknown.")]
pub struct ExploreArgs {
    #[command(flatten)]
    pub files: Files,
    /// Choice of the next motion [default: goal if the world has a goal, otherwise view].
    #[arg(long, value_parser = word(STRATEGIES), value_name = "NAME", help_heading = EXPLORATION)]
    pub strategy: Option<Strategy>,

    #[command(flatten)]
    pub query: QueryArgs,
    /// Number of grid cells along each axis of joint space. Their centres are the configurations that the search considers.
    #[arg(long, value_name = "N|AxB", default_value = "96", help_heading = EXPLORATION)]
    pub grid: CellCounts,
    /// Distance from the arm within which the world is known at the beginning, metres [default: two cells of the map].
    #[arg(long, value_name = "METRES", value_parser = positive, help_heading = EXPLORATION)]
    pub surveyed: Option<f64>,
    /// Map of known space (FILE.yaml) that an earlier exploration of this world wrote with --map.
    #[arg(long, value_name = "FILE.yaml", value_hint = ValueHint::FilePath, help_heading = EXPLORATION)]
    pub known: Option<PathBuf>,
    /// Maximum number of decisions.
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(1..))]
    #[arg(help_heading = EXPLORATION)]
    pub decisions: u32,
    /// Write the exploration (.json), or only its motion (.csv, .yaml for a ROS 2 JointTrajectory). Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub output: Vec<PathBuf>,
    /// Write the map for ROS's map server: FILE.yaml, and FILE.pgm beside it. World files accept it as an obstacle's
    /// `image`.
    #[arg(long, value_name = "FILE.yaml", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub map: Option<PathBuf>,
    /// Draw the world and the whole path: .svg, .png, or .html (a page that plays the exploration). Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub picture: Vec<PathBuf>,
    #[command(flatten)]
    pub theme: ThemeArgs,
    #[command(flatten)]
    pub print: PrintArgs,
    /// Also report the time of decisions. Without this option, the same input gives the same output.
    #[arg(long, help_heading = OUTPUT)]
    pub timings: bool,
    /// Planner for the optimistic paths of strategy "goal", which treat unknown space as free.
    #[arg(long, value_parser = word(planners()), value_name = "NAME", default_value_t = Method::Shortest)]
    #[arg(help_heading = PLANNER)]
    pub planner: Method,
    #[command(flatten)]
    pub options: PlannerArgs,
}

/// Strategies in the order of the help.
const STRATEGIES: [Word<Strategy>; 5] = [
    (Strategy::Goal, "goal", "Toward the goal, as far as the path is known to be free"),
    (Strategy::View, "view", "To a configuration that shows all that the nearest one shows, and more"),
    (Strategy::Nearest, "nearest", "To the nearest configuration that shows something new"),
    (
        Strategy::Harmonic,
        "harmonic",
        "Up the harmonic potential, whose sources are all configurations that show something new",
    ),
    (Strategy::Wall, "wall", "Along the wall on the right, to the first configuration that shows something new"),
];

/// Explores, and prints the result.
///
/// # Errors
/// Bad input and I/O.
pub fn run(args: &ExploreArgs) -> Result<u8, Failure> {
    let map = args.map.as_deref().map(map_files).transpose()?;
    let outputs = Outputs::new(&args.output, motion_format, &args.picture, map.iter().flatten().cloned())?;
    let loaded = input::load_scene(args.files.robot(), &args.files.world)?;
    let mut inputs = loaded.files();
    let sensor = loaded.sensor();
    let world = loaded.resolve(&args.query.overrides(), Rules::Exploration)?;
    world.robot.warnings.iter().for_each(|w| sinks::print_status(&format!("warning: {w}")));
    args.options.effort.ignored(args.planner).iter().for_each(|w| args.print.print_status(&format!("warning: {w}")));
    let goals = Some(world.problem.goals()).filter(|goals| !goals.is_empty());
    let settings = args.settings(goals.is_some())?;
    inputs.extend(args.known.clone());
    inputs.extend(settings.known.as_ref().and_then(|map| map.picture.clone()));
    refuse_to_overwrite_inputs(outputs.paths(), &inputs)?;
    let mut print_status = |text: &str| args.print.print_status(&format!("{text} ..."));
    let done = explore(world.problem.scene(), &sensor, world.problem.start(), goals, &settings, &mut print_status)
        .map_err(|error| args.refused(&error))?;
    let joints = world.problem.scene().arm().joints.each_ref().map(|joint| joint.name.clone());
    let json = || done.to_json(joints.each_ref().map(String::as_str), &sensor, args.timings).to_string() + "\n";
    let mut maps = Vec::new();
    if let Some([description, picture]) = &map {
        let name = picture.file_name().unwrap_or_default().to_string_lossy();
        maps.push((picture.clone(), map_picture(&done.survey)));
        maps.push((description.clone(), map_description(&done.survey, &name).into_bytes()));
    }
    let result = |path: &Path, format| {
        let text = match (format, &done.trajectory) {
            (Format::Json, _) => Some(json()),
            (_, None) => {
                sinks::warn_unwritten(path, "trajectory");
                None
            }
            (Format::Csv, Some(trajectory)) => {
                let motors = world.problem.scene().arm().motor_angles(&trajectory.position);
                Some(csv(&joints, trajectory, &motors, false, None))
            }
            (_, Some(trajectory)) => Some(ros_yaml(&JointMotion::new(&world.robot.joints, trajectory, false))),
        };
        Ok(text.map(String::into_bytes))
    };
    let picture = |format: PictureFormat| {
        let figure = || view::figure(&args.theme.apply(view(&world, &done, done.trajectory.as_ref())));
        // The page plays the readings, and does not need the times of the motion.
        let page_view = || view(&world, &done, None);
        let page = || exploration_page(&page_view(), world.problem.scene(), &sensor, &done, args.timings);
        Ok(format.bytes_of(figure, page)?)
    };
    outputs.write(maps, result, picture)?;
    let code = code_of(status(&done.ending));
    args.print.report(code, || Ok(json()), || summary(&world, &done, args.timings))?;
    Ok(code)
}

impl ExploreArgs {
    /// Describes why no exploration is possible, with a hint.
    fn refused(&self, error: &ExploreError) -> Failure {
        let (file, cure) = match error {
            ExploreError::Map(_) => (&self.files.world, "increase `cell` in [sensor], or narrow the limits of joint 1"),
            ExploreError::NoGoal => (&self.files.world, "add a [goal] to the world, or use --strategy view"),
            ExploreError::Known(_) => (
                self.known.as_ref().unwrap_or(&self.files.world),
                "use a map that --map wrote for this world, arm and sensor",
            ),
        };
        Failure::Refused(format!("{}: {error}\n  hint: {cure}", file.display()))
    }

    fn settings(&self, has_goal: bool) -> Result<Settings, Failure> {
        let usual = Settings::default();
        let strategy = self.strategy.unwrap_or(if has_goal { Strategy::Goal } else { Strategy::View });
        let planner = self.options.planner(self.planner).map_err(Failure::Usage)?;
        self.options.field.missing().map_or(Ok(()), |missing| Err(Failure::Refused(missing)))?;
        if let Some(error) = self.grid.error() {
            return Err(Failure::Usage(format!("--grid: {error}")));
        }
        Ok(Settings {
            strategy,
            cells: self.grid.0,
            surveyed: self.surveyed,
            known: self.known.as_deref().map(OccupancyMap::read).transpose()?,
            decisions: self.decisions as usize,
            options: Options { levels: self.options.effort.levels(&planner), planner, ..usual.options },
        })
    }
}

/// Returns the format of an exploration in this file.
fn motion_format(path: &Path) -> Result<Format, Failure> {
    match Format::from_path(path)? {
        format @ (Format::Json | Format::Csv | Format::Yaml) if CSpaceFormat::from_path(path).is_none() => Ok(format),
        _ => {
            let path = path.display();
            Err(Failure::Usage(format!("{path}: an exploration's name must end in .json, .csv or .yaml")))
        }
    }
}

/// Returns the status of an exploration with this ending.
fn status(ending: &Ending) -> Status {
    match ending {
        Ending::Reached | Ending::Explored { .. } => Status::Found,
        Ending::Unreachable(_) => Status::Infeasible,
        Ending::Unknown(_) => Status::Unknown,
    }
}

/// Returns the paths of a map's description and picture.
fn map_files(description: &Path) -> Result<[PathBuf; 2], Failure> {
    if !matches!(description.extension().and_then(|e| e.to_str()), Some("yaml" | "yml")) {
        return Err(Failure::Usage(format!("{}: a map's name must end in .yaml", description.display())));
    }
    Ok([description.to_path_buf(), description.with_extension("pgm")])
}

/// Returns the path of all legs together.
fn explored_path(done: &Exploration, start: Configuration) -> JointPath {
    let legs = done.legs.iter().flat_map(|leg| leg.curve.curve().path().waypoints().iter().copied());
    JointPath::new(std::iter::once(start).chain(legs).collect())
}

fn view(world: &LoadedProblem, done: &Exploration, trajectory: Option<&Trajectory>) -> View {
    let scene: &Scene = world.problem.scene();
    let explored_path = explored_path(done, world.problem.start());
    let status = status(&done.ending);
    let verdict = match status {
        Status::Unknown => status.name().to_owned(),
        Status::Found => done.ending.name().to_owned(),
        Status::Infeasible => format!("{}: {}", status.name(), done.ending.name()),
    };
    View::of_picture(&Picture {
        title: vec![done.headline(), title_of(scene)],
        status: verdict,
        ending: Some(status),
        facts: facts(scene.arm(), done).into_iter().map(|(name, value)| [name.to_owned(), value]).collect(),
        goals: if done.strategy == Strategy::Goal { world.problem.goals().pieces() } else { &[] },
        paths: vec![("path".to_owned(), &explored_path)],
        trajectory,
        c_obstacles: &contours(scene),
        ..Picture::new(scene, world.problem.start())
    })
}

/// Returns names and descriptions of the facts about an exploration.
fn facts(arm: &Arm, done: &Exploration) -> Vec<Line> {
    let map = done.survey.map();
    let [free, occupied, unknown] = done.survey.counts();
    let seen = 100.0 * (free + occupied) as f64 / map.cells.len() as f64;
    let [width, height] = map.size;
    let duration = done.trajectory.as_ref().map_or(0.0, |trajectory| trajectory.duration());
    let [rows, columns] = done.cells;
    let mut facts = vec![
        (
            "map",
            format!(
                "{width} \u{d7} {height} cells of {}: {free} free, {occupied} occupied, {unknown} unknown",
                chosen_length(map.resolution)
            ),
        ),
        ("seen", format!("{seen:.1} % of the map")),
        ("grid", format!("{rows} \u{d7} {columns} configurations")),
        ("path", format!("{}, {duration:.3} s, {}", arm.format_length(done.length), counted(done.legs.len(), "leg"))),
        ("readings", format!("{}, {}", done.readings.len(), counted(done.decisions.len(), "decision"))),
    ];
    if let Some(known) = done.known_length.filter(|&known| known > 0.0) {
        facts.push((
            "known",
            format!(
                "{:.2} times the length of a plan in the fully known world ({})",
                done.length / known,
                arm.format_length(known)
            ),
        ));
    }
    facts
}

fn summary(world: &LoadedProblem, done: &Exploration, timed: bool) -> String {
    let ending = match &done.ending {
        Ending::Reached => "reached: the arm is at the goal".to_owned(),
        Ending::Explored { configurations, given_up } => {
            let given_up = match given_up {
                0 => String::new(),
                n => format!("; {n} of them were tried and given up, because sensor errors hid the expected new space"),
            };
            format!(
                "explored: nothing new can be seen from any of the {configurations} reachable configurations{given_up}"
            )
        }
        Ending::Unreachable(why) => format!("unreachable: {why}"),
        Ending::Unknown(why) => format!("unknown: {why}"),
    };
    let mut lines = vec![("result", ending)];
    lines.extend(facts(world.problem.scene().arm(), done));
    if timed {
        let mut times: Vec<f64> = done.decisions.iter().map(|time| 1e3 * time.as_secs_f64()).collect();
        times.sort_unstable_by(f64::total_cmp);
        let [median, most, longest] = [times.len() / 2, times.len() * 99 / 100, times.len() - 1].map(|k| times[k]);
        lines.push(("decision", format!("{median:.1} ms (median), {most:.1} ms (99 %), {longest:.1} ms (longest)")));
    }
    lines.extend(world.notes.iter().map(|note| ("note", note.clone())));
    format!("{}\n{}", title_of(world.problem.scene()), format_columns(&lines))
}
