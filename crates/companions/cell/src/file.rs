//! Reads cell files. Each arm becomes the text of a world of its own, and all keys are those of world files.

use crate::excerpt::{Composition, Excerpt};
use cplan_engine::Problem;
use cplan_geometry::{Convex, separation};
use cplan_handling::RobotJoints;
use cplan_model::{Arm, Carrier, Obstacle, SelfObstacle, Shape};
use cplan_robot::{Diagnostic, FileIdentity, InputError, Source, Spanned, toml_table};
use cplan_world::{LoadedScene, Overrides, scene_from};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Two arms in one cell, each with its start and goal.
#[derive(Debug, Clone)]
pub struct Cell {
    /// Title of the cell.
    pub name: String,
    /// The arms, in the order of the file.
    pub arms: [CellArm; 2],
    /// True if both arms belong to one robot.
    pub is_one_robot: bool,
    /// Paths of all files that were read.
    pub files: Vec<PathBuf>,
}

/// A function that reads the robot of a path.
pub type ReadRobot<'a> = dyn Fn(&Path) -> Result<Source, InputError> + 'a;

/// An arm of a cell.
#[derive(Debug, Clone)]
pub struct CellArm {
    /// Name of the arm in the cell.
    pub name: String,
    /// The motion that the arm shall make. Its obstacles are those of the cell, and the base of the other arm.
    pub problem: Problem,
    /// The robot in the cell, with the same obstacles.
    pub loaded: LoadedScene,
}

toml_table! {
    /// A cell file.
    struct CellFile {
        name: Option<String>,
        clearance: Option<Excerpt>,
        arm: Vec<Spanned<ArmTable>>,
        obstacle: Option<Excerpt>,
    }

    /// An arm of a cell file. The tables `robot`, `start` and `goal` are those of a world file.
    struct ArmTable {
        name: Spanned<String>,
        urdf: Spanned<String>,
        base: Option<BaseTable>,
        robot: Option<Spanned<Excerpt>>,
        start: Option<Excerpt>,
        goal: Option<Excerpt>,
        step: Option<Spanned<Excerpt>>,
        clearance: Option<Spanned<Excerpt>>,
    }

    /// The place of an arm's root frame in the cell.
    struct BaseTable {
        at: Option<Excerpt>,
        angle: Option<Excerpt>,
    }
}

/// Returns the hint for an error in the cell file itself.
fn hint(message: &str, _: usize) -> &'static str {
    if message.contains("unknown field") {
        "use a known key, or remove this one"
    } else if message.contains("`urdf`") {
        "name the robot's file, relative to the cell file: urdf = \"scara.urdf\""
    } else if message.contains("`name`") {
        "give each arm a name: name = \"left\""
    } else if message.contains("map, expected a sequence") {
        "begin each arm with [[arm]], and each obstacle with [[obstacle]]"
    } else {
        "see the page \"Two arms\" of the documentation"
    }
}

impl Cell {
    /// Reads a cell, its robots and their meshes. `robot` reads the file of a robot. `clearance` replaces the file's, metres.
    ///
    /// # Errors
    /// All defects of the files, with line, column and hint; a start or goal that is out of reach or not free of obstacles;
    /// bases that overlap.
    pub fn load(source: &Source, robot: &ReadRobot, clearance: Option<f64>) -> Result<Self, InputError> {
        let file: CellFile = source.toml(&hint)?;
        let tables: Vec<&ArmTable> = file.arm.iter().map(Spanned::get_ref).collect();
        let [first, second] = tables[..] else {
            let message = format!("a cell has two arms, but the file has {}", tables.len());
            let at = file.arm.get(2).map_or(0..0, Spanned::span);
            return Err(source.diagnostic_at(at, message).help("write two tables [[arm]]").into());
        };
        if first.name.get_ref() == second.name.get_ref() {
            let message = format!("both arms are named \"{}\"", first.name.get_ref());
            return Err(source.diagnostic_at(second.name.span(), message).help("give each arm its own name").into());
        }
        let title = file.name.clone().or_else(|| source.stem()).unwrap_or_else(|| "cell".to_owned());
        let robots = [first, second].map(|table| source.path().with_file_name(table.urdf.get_ref()));
        let reader = Reader { source, file: &file };
        let mut loaded = Vec::new();
        for (table, urdf) in [first, second].into_iter().zip(&robots) {
            let urdf = robot(urdf).map_err(|error| reader.unread(table, error))?;
            loaded.push(reader.scene(table, &title, urdf)?.with_margins(clearance, None)?);
        }
        let [mut one, mut two] = <[LoadedScene; 2]>::try_from(loaded).expect("one for each arm");
        let names = [first, second].map(|table| table.name.get_ref().clone());
        let identities = robots.each_ref().map(|path| FileIdentity::of(path));
        let is_same_file = identities[0].as_ref().zip(identities[1].as_ref()).is_some_and(|(a, b)| a.is_same_file(b));
        let places = [&one, &two].map(|loaded| loaded.scene.arm().plane);
        if places[0].normal != places[1].normal || places[0].u != places[1].u {
            let message = "the planes in which the arms move have different directions";
            let hint = "use robots whose joints turn about the same axis of their root frames";
            return Err(source.diagnostic_at(second.urdf.span(), message).help(hint).into());
        }
        let is_one_robot = is_same_file && first.place() == second.place();
        if is_one_robot {
            reader.check_joints([&one, &two], second)?;
        } else {
            reader.check_bases([&one, &two], second)?;
            let bases = [(&one, &names[0]), (&two, &names[1])].map(|(loaded, name)| base_of(loaded.scene.arm(), name));
            (one, two) = (among(one, &bases[1]), among(two, &bases[0]));
        }
        let mut files: Vec<PathBuf> = one.files().into_iter().chain(two.files()).chain(source.files()).collect();
        files.sort();
        files.dedup();
        let arm = |name: String, loaded: LoadedScene| {
            let problem = Problem::of_scene(loaded.clone(), &Overrides::default())?;
            Ok::<_, InputError>(CellArm { name, problem, loaded })
        };
        let [first, second] = names;
        let arms = [arm(first, one)?, arm(second, two)?];
        for arm in &arms {
            if arm.problem.motion().is_none() {
                let message = format!(
                    "arm \"{}\" has steps or values of the tool's joints, which cells do not support",
                    arm.name
                );
                return Err(source
                    .diagnostic(message)
                    .help("give the arm a goal: goal = { joints = [q1, q2] }")
                    .into());
            }
        }
        Ok(Self { name: title, arms, is_one_robot, files })
    }
}

impl Cell {
    /// Returns the joints of an arm's controller: all joints of its robot, unless the other arm moves some of them.
    pub fn joints(&self, arm: usize) -> RobotJoints {
        let problem = &self.arms[arm].problem;
        match self.is_one_robot {
            true => RobotJoints::only_planned(&problem.scene().arm().joints.each_ref().map(|joint| joint.name.clone())),
            false => problem.robot().joints.clone(),
        }
    }
}

impl ArmTable {
    /// Returns the written position and angle of the root frame.
    fn place(&self) -> [Option<&str>; 2] {
        let written = |of: fn(&BaseTable) -> &Option<Excerpt>| Some(of(self.base.as_ref()?).as_ref()?.text());
        [written(|base| &base.at), written(|base| &base.angle)]
    }
}

/// Reads the parts of a cell file.
struct Reader<'a> {
    source: &'a Source,
    file: &'a CellFile,
}

impl Reader<'_> {
    fn error(&self, at: Range<usize>, message: String, hint: &str) -> InputError {
        self.source.diagnostic_at(at, message).help(hint).into()
    }

    /// Returns the error about a robot's file that cannot be read. If the file is missing, it is about the cell's line.
    fn unread(&self, table: &ArmTable, error: InputError) -> InputError {
        let [Diagnostic { position: None, message, .. }] = error.diagnostics() else { return error };
        let message = format!("the robot of arm \"{}\" {message}", table.name.get_ref());
        self.error(table.urdf.span(), message, "the path is relative to the cell file")
    }

    /// Reads an arm in the cell, without the other arm.
    fn scene(&self, table: &ArmTable, title: &str, urdf: Source) -> Result<LoadedScene, InputError> {
        let name = table.name.get_ref();
        if let Some(step) = &table.step {
            let message = format!("arm \"{name}\" has steps, which cells do not support");
            return Err(self.error(step.span(), message, "give the arm a goal: goal = { joints = [q1, q2] }"));
        }
        if let Some(clearance) = &table.clearance {
            let message = format!("arm \"{name}\" has a clearance of its own, but both arms have that of the cell");
            return Err(self.error(clearance.span(), message, "write it above the first [[arm]]: clearance = 0.005"));
        }
        for (table_of, key, example) in [
            (&table.start, "start", "start = { joints = [q1, q2] }"),
            (&table.goal, "goal", "goal = { joints = [q1, q2] } or goal = { tip = [x, y] }"),
        ] {
            if table_of.is_none() {
                return Err(self.error(table.name.span(), format!("arm \"{name}\" has no {key}"), example));
            }
        }
        let robot = table.robot.as_ref().map(Spanned::get_ref);
        if let Some(written) = table.robot.as_ref().filter(|robot| !robot.get_ref().is_table()) {
            let message = format!("the robot of arm \"{name}\" must be a table");
            return Err(self.error(written.span(), message, "robot = { joints = [\"j1\", \"j2\"] }"));
        }
        for key in ["at", "angle"] {
            if let Some(at) = robot.and_then(|robot| robot.key(key)) {
                let message =
                    format!("the robot of arm \"{name}\" has `{key}`, but the place of an arm is stated by `base`");
                return Err(self.error(at, message, "write base = { at = [x, y], angle = \"0deg\" }"));
            }
        }
        let place = |of: fn(&BaseTable) -> &Option<Excerpt>| table.base.as_ref().and_then(|base| of(base).as_ref());
        let (at, angle) = (place(|base| &base.at), place(|base| &base.angle));
        let more = [("at", at), ("angle", angle)].map(|(key, value)| value.map(|value| (key, value)));
        let mut world = Composition::default();
        world.text("name", &format!("{title}, {name}"), table.name.span());
        for (key, value) in [
            ("clearance", &self.file.clearance),
            ("start", &table.start),
            ("goal", &table.goal),
            ("obstacle", &self.file.obstacle),
        ] {
            if let Some(value) = value {
                world.value(key, value);
            }
        }
        world.table("robot", robot, &more.into_iter().flatten().collect::<Vec<_>>());
        let loaded = scene_from(urdf, world.source(self.source))?;
        loaded.require_static_obstacles("obstacles in cells cannot move")?;
        Ok(loaded)
    }

    /// Checks that the arms of one robot have no joint in common.
    fn check_joints(&self, both: [&LoadedScene; 2], second: &ArmTable) -> Result<(), InputError> {
        let [one, two] = both.map(|loaded| &loaded.scene.arm().joints);
        let shared = one.iter().find(|joint| two.iter().any(|other| other.name == joint.name));
        shared.map_or(Ok(()), |joint| {
            let at = second.robot.as_ref().map_or(second.urdf.span(), Spanned::span);
            let message =
                format!("both arms are the same robot at the same place, and both move joint \"{}\"", joint.name);
            let hint = "give this arm other joints, robot = { joints = [\"j3\", \"j4\"] }, or another base";
            Err(self.error(at, message, hint))
        })
    }

    /// Checks that the bases of two robots do not overlap.
    fn check_bases(&self, both: [&LoadedScene; 2], second: &ArmTable) -> Result<(), InputError> {
        let [one, two] = both.map(|loaded| base_obstacles(loaded.scene.arm()));
        for (a, b) in one.iter().flat_map(|a| two.iter().map(move |b| (a, b))) {
            let depth = |p: &Convex, q: &Convex| -separation(p, q).distance;
            let deepest = a.pieces.iter().flat_map(|p| b.pieces.iter().map(move |q| depth(p, q))).fold(0.0, f64::max);
            if a.heights.overlap(b.heights) && deepest > MIN_BASE_OVERLAP {
                let names = [self.file.arm[0].get_ref(), second].map(|table| table.name.get_ref());
                let message = format!(
                    "the bases of arms \"{}\" and \"{}\" overlap: \"{}\" and \"{}\", by {:.1} mm",
                    names[0],
                    names[1],
                    a.name,
                    b.name,
                    deepest * 1e3
                );
                return Err(self.error(second.name.span(), message, "move a base: base = { at = [x, y] }"));
            }
        }
        Ok(())
    }
}

/// Least depth, metres, by which bases that overlap are an error. Bases that stand side by side may touch.
const MIN_BASE_OVERLAP: f64 = 1e-6;

/// Returns the links of an arm's robot that never move, in plane coordinates.
fn base_obstacles(arm: &Arm) -> Vec<&Obstacle> {
    let is_base = |own: &&SelfObstacle| own.carrier == Carrier::Base;
    arm.self_obstacles.iter().filter(is_base).map(|own| &own.obstacle).collect()
}

/// Returns the links of an arm's robot that never move, as obstacles of the other arm.
fn base_of(arm: &Arm, name: &str) -> Vec<Obstacle> {
    let named = |obstacle: &Obstacle| {
        let mut obstacle = obstacle.clone();
        obstacle.name = format!("{name}: {}", obstacle.name);
        obstacle.shape = Shape::Pieces;
        obstacle
    };
    base_obstacles(arm).into_iter().map(named).collect()
}

/// Returns the scene with more obstacles.
fn among(mut loaded: LoadedScene, others: &[Obstacle]) -> LoadedScene {
    loaded.scene = loaded.scene.changed(|_, workspace| workspace.obstacles.extend_from_slice(others));
    loaded
}
