//! Reads cell files. Each arm becomes the text of a world of its own, and all keys are those of world files.

use crate::excerpt::{Composition, Excerpt};
use crate::file_steps::{self, ArmWorld};
use cplan_engine::Problem;
use cplan_geometry::{Convex, separation};
use cplan_handling::{RobotJoints, Task};
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
    /// Names of the objects that either arm may move, in the order of the file.
    pub shared: Vec<String>,
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
    /// The steps of the arm, if an arm of the cell has steps. The first group has the objects that either arm may move.
    pub(crate) task: Option<Task>,
    /// For each object that either arm may move, its number in that group. `None` if the arm cannot move it.
    pub(crate) shared: Vec<Option<usize>>,
}

toml_table! {
    /// A cell file.
    pub(crate) struct CellFile {
        name: Option<String>,
        clearance: Option<Excerpt>,
        pub arm: Vec<Spanned<ArmTable>>,
        obstacle: Option<Excerpt>,
        pallet: Option<Excerpt>,
        pub object: Option<Excerpt>,
        pub step: Option<Excerpt>,
    }

    /// An arm of a cell file. The tables `robot`, `start`, `goal`, `step` and `task` are those of a world file.
    pub(crate) struct ArmTable {
        pub name: Spanned<String>,
        urdf: Spanned<String>,
        base: Option<BaseTable>,
        robot: Option<Spanned<Excerpt>>,
        start: Option<Excerpt>,
        pub goal: Option<Excerpt>,
        pub step: Option<Excerpt>,
        pub task: Option<Excerpt>,
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
    let is_of_world =
        |key: &str| message.contains(&format!("unknown field `{key}`, expected one of `name`, `clearance`, `arm`"));
    if ["robot", "start", "goal"].into_iter().any(is_of_world) {
        "a cell has these keys in [[arm]] tables; for the world of one arm, use `cplan URDF WORLD`"
    } else if message.contains("unknown field") {
        "use a known key, or remove this one"
    } else if message.contains("`urdf`") {
        "name the robot's file, relative to the cell file: urdf = \"scara.urdf\""
    } else if message.contains("`name`") {
        "give each arm a name: name = \"left\""
    } else if message.contains("map, expected a sequence") {
        "begin each arm with [[arm]], its steps with [[arm.step]], and each obstacle with [[obstacle]]"
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
        let reader = Reader { source, file: &file, title: &title, tables: [first, second], clearance };
        let urdfs = [0, 1].map(|arm| robot(&robots[arm]).map_err(|error| reader.unread(reader.tables[arm], error)));
        let [one, two] = urdfs;
        let urdfs = [one?, two?];
        let worlds = file_steps::worlds(&reader, &urdfs)?;
        let loaded = |arm: usize| reader.scene(arm, &urdfs[arm], &worlds[arm]);
        let (mut one, mut two) = (loaded(0)?, loaded(1)?);
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
        let mut others = [vec![], vec![]];
        if is_one_robot {
            reader.check_joints([&one, &two], second)?;
        } else {
            reader.check_bases([&one, &two], second)?;
            others = [(&two, &names[1]), (&one, &names[0])].map(|(loaded, name)| base_of(loaded.scene.arm(), name));
            (one, two) = (among(one, &others[0]), among(two, &others[1]));
        }
        let mut files: Vec<PathBuf> = one.files().into_iter().chain(two.files()).chain(source.files()).collect();
        files.sort();
        files.dedup();
        let mut arms = Vec::new();
        for (arm, loaded) in [one, two].into_iter().enumerate() {
            let problem = Problem::of_scene(loaded.clone(), &Overrides::default())?;
            let mut task = worlds[arm].task(&problem, &others[arm]);
            let world = reader.world(arm, &worlds[arm])?;
            task.iter_mut().for_each(|task| file_steps::locate(task, &world, source));
            let shared = worlds[arm].shared.clone();
            arms.push(CellArm { name: names[arm].clone(), problem, loaded, task, shared });
        }
        let arms = <[CellArm; 2]>::try_from(arms).expect("one for each arm");
        for arm in &arms {
            if arm.task.is_none() && arm.problem.motion().is_none() {
                let message = format!("arm \"{}\" has values of the tool's joints, but no steps", arm.name);
                return Err(source
                    .diagnostic(message)
                    .help("give the arm a step: [[arm.step]] with move = { joints = [q1, q2] }")
                    .into());
            }
        }
        let tasks = arms.each_ref().map(|arm| arm.task.as_ref());
        file_steps::check(&reader, tasks)?;
        Ok(Self { name: title, arms, is_one_robot, shared: file_steps::shared_names(&file), files })
    }
}

impl Cell {
    /// Returns true if an arm has steps.
    pub fn has_steps(&self) -> bool {
        self.arms.iter().any(|arm| arm.task.is_some())
    }

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
    fn place(&self) -> [Option<String>; 2] {
        let written = |of: fn(&BaseTable) -> &Option<Excerpt>| Some(of(self.base.as_ref()?).as_ref()?.text());
        [written(|base| &base.at), written(|base| &base.angle)]
    }
}

/// Reads the parts of a cell file.
pub(crate) struct Reader<'a> {
    pub source: &'a Source,
    pub file: &'a CellFile,
    title: &'a str,
    pub tables: [&'a ArmTable; 2],
    clearance: Option<f64>,
}

impl Reader<'_> {
    /// Returns an error about a place of the file.
    pub fn error(&self, at: Range<usize>, message: String, hint: &str) -> InputError {
        self.source.diagnostic_at(at, message).help(hint).into()
    }

    /// Returns the error about a robot's file that cannot be read. If the file is missing, it is about the cell's line.
    fn unread(&self, table: &ArmTable, error: InputError) -> InputError {
        let [Diagnostic { position: None, message, .. }] = error.diagnostics() else { return error };
        let message = format!("the robot of arm \"{}\" {message}", table.name.get_ref());
        self.error(table.urdf.span(), message, "the path is relative to the cell file")
    }

    /// Reads an arm in the cell, without the other arm.
    pub fn scene(&self, arm: usize, urdf: &Source, own: &ArmWorld) -> Result<LoadedScene, InputError> {
        let loaded = scene_from(urdf.clone(), self.world(arm, own)?)?;
        loaded.require_static_obstacles("obstacles in cells cannot move")?;
        loaded.with_margins(self.clearance, None)
    }

    /// Returns the text of an arm's world.
    fn world(&self, arm: usize, own: &ArmWorld) -> Result<Source, InputError> {
        let table = self.tables[arm];
        let name = table.name.get_ref();
        if let Some(clearance) = &table.clearance {
            let message = format!("arm \"{name}\" has a clearance of its own, but both arms have that of the cell");
            return Err(self.error(clearance.span(), message, "write it above the first [[arm]]: clearance = 0.005"));
        }
        let example = "goal = { joints = [q1, q2] } or goal = { tip = [x, y] } or [[arm.step]]";
        for (is_missing, key, example) in [
            (table.start.is_none(), "start", "start = { joints = [q1, q2] }"),
            (table.goal.is_none() && own.steps.is_none(), "goal", example),
        ] {
            if is_missing {
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
        let mut robot = robot.cloned().unwrap_or_else(|| Excerpt::empty_table(table.name.span()));
        for (key, value) in [("at", at), ("angle", angle)] {
            if let Some(value) = value {
                robot = robot.with(key, value.clone());
            }
        }
        let mut world = Composition::default();
        world.value("name", &Excerpt::of_text(&format!("{}, {name}", self.title), table.name.span()));
        let goal = table.goal.as_ref().filter(|_| own.steps.is_none());
        for (key, value) in [
            ("clearance", self.file.clearance.as_ref()),
            ("start", table.start.as_ref()),
            ("goal", goal),
            ("obstacle", self.file.obstacle.as_ref()),
            ("pallet", self.file.pallet.as_ref()),
            ("object", own.objects.as_ref()),
            ("step", own.steps.as_ref()),
            ("task", own.defaults.as_ref()),
            ("robot", Some(&robot)),
        ] {
            if let Some(value) = value {
                world.value(key, value);
            }
        }
        Ok(world.source(self.source))
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
