//! Reads the input files and the options. A URDF and a world file become a motion problem or a task; a recorded trajectory
//! becomes a recording.
//!
//! ```text
//! .map, .yaml with .pgm or .png
//!       |
//! world.toml --+-> World ------------------+            +--> Task (of a world with steps)
//!              |                           +--> Scene --+
//! arm.urdf ----+-> Arm (planar reduction) -+            +--> MotionProblem (of any other)
//!                                                       |
//! --start, --goal, --goal-tip, --clearance -------------+
//!
//! motion.json, .csv, .yaml ---> Recording
//! ```
//!
//! [`load`] reads URDF and world file, decomposes polygons into convex pieces, and checks start and goal. The arm comes from
//! `cplan-robot`. [`load`] returns a problem, or all diagnostics together. [`load_recording`] reads a motion that any program
//! recorded. If the file is cplan's result of a task, it also reads the steps.

mod digest;
mod ends;
mod goal_table;
mod group;
mod help;
mod joint_pair;
mod line_map;
mod line_table;
mod line_wrist;
mod map_text;
mod nearness;
mod notes;
mod object;
mod obstacle;
mod obstacle_trajectory;
mod occupancy;
mod pallet;
mod pick_times;
mod parsers;
mod polygon;
mod preference;
mod preference_map;
mod problem;
mod range_sensor;
mod reader;
mod reasons;
mod requirement;
mod resting;
#[cfg(test)]
mod schema;
mod sensor;
mod sequence;
mod start;
mod step;
mod suite;
mod table;
mod task;
mod tool_values;
mod trajectory;
mod values;
mod world;
mod world_map;

pub use digest::{Digests, digest};
pub use line_map::{Chain, LineMap};
pub use line_table::{line_diagnostic, read_line};
pub use occupancy::{MAX_CELLS, Occupancy, OccupancyMap, PixelRectangle, rectangles};
pub use preference_map::{PreferenceMap, PreferenceRectangle};
pub use problem::Rules;
pub use range_sensor::{Mount, Sensor};
pub use suite::{ExcludedWorld, LoadedProblems, MANIFEST_NAME, Member, RefusedProblem, Suite, load_folder, load_suite};
pub use trajectory::{AllJoints, LoadedRecording, load_recording, load_topic, read_recording};
pub use values::{JointValues, Overrides, TipPoint};
pub use world::World;

use cplan_handling::{ObstacleTrajectory, RobotJoints, Task, TimedScene, ToolJoint, Wrist, WristJoint};
use cplan_model::{Arm, Calibration, Goal, MotionProblem, Scene};
use cplan_robot::{Diagnostic, InputError, Inspection, RobotFile, RobotReport, RobotTable, Source};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The reason why a line cannot state an angle of the tool if the world limits the wrist's jerk.
pub(crate) const WRIST_WITH_JERK: &str =
    "the line requires an angle of the tool, but limits on the wrist's jerk cannot be kept along lines";

/// Hint for such a line.
pub(crate) const WITHOUT_JERK: &str = "remove the wrist's `jerk` from [robot], or `wrist` from the line";

/// Hint for a line that needs a wrist.
pub(crate) const NAME_THE_WRIST: &str = "[robot] wrist = { joint = \"NAME\", velocity = 6.0 }, in rad/s";

/// Arm, obstacles and objects of the files, without start, goal and steps.
#[derive(Debug, Clone)]
pub struct LoadedScene {
    /// The arm among its obstacles, with the world's clearance. Objects are at their initial places, after the static
    /// obstacles.
    pub scene: Scene,
    /// The trajectories of the scene's loose obstacles, which are moving obstacles and objects.
    pub trajectories: Vec<ObstacleTrajectory>,
    /// The world file.
    pub world: World,
    /// The arm as in the URDF, not yet moved to the world's pose of the robot.
    arm: Arm,
    /// Report on how the robot was read.
    pub robot: RobotReport,
}

/// A motion or a task, and how it was read.
#[derive(Debug, Clone)]
pub struct LoadedProblem {
    /// Scene, start and goals. Unless the [`Rules`] say otherwise, start and goals are free and within the limits. A task
    /// has no goals, and its objects are at their initial places.
    pub problem: MotionProblem,
    /// The goals as stated, which may be out of reach. Empty if the [`Rules`] demand a check of the goals.
    pub stated_goals: Vec<Goal>,
    /// The task. `None` for a motion.
    pub task: Option<Task>,
    /// The trajectories of the scene's loose obstacles.
    pub trajectories: Vec<ObstacleTrajectory>,
    /// Report on how the robot was read.
    pub robot: RobotReport,
    /// Notes for the user: defaults, blocked IK solutions of the goal, joints whose value does not matter.
    pub notes: Vec<String>,
    /// Errors of robot and world despite which the motion must be free; `None` if no errors are stated.
    pub errors: Option<AllowedErrors>,
}

/// Errors of a robot and its world. A motion must be free for all of them.
#[derive(Debug, Clone)]
pub struct AllowedErrors {
    /// Errors of the robot.
    pub robot: Calibration,
    /// Greatest displacement of an obstacle, metres.
    pub obstacles: f64,
    /// The problem without errors. `None` if its start or all of its goals are not free.
    pub drawn: Option<Arc<MotionProblem>>,
}

/// Reads a robot and a world. Does not check start, goal and steps: see [`LoadedScene::resolve`].
///
/// # Errors
/// [`InputError`] with all defects of the files themselves.
pub fn load_scene(robot: impl Into<RobotFile>, world: &Path) -> Result<LoadedScene, InputError> {
    let world = world::read(Source::read(world)?)?;
    scene_of_world(world, robot.into().read()?)
}

/// Does the same as [`load_scene`], for motions during which the wrist turns: each link beyond the wrist is replaced by the disc
/// that it sweeps about the wrist's axis. This makes a difference only if the world names the wrist's joint.
///
/// # Errors
/// Same as for [`load_scene`], and a link whose shape is not centred on the wrist's axis.
pub fn load_scene_with_turning_wrist(robot: impl Into<RobotFile>, world: &Path) -> Result<LoadedScene, InputError> {
    let mut world = world::read(Source::read(world)?)?;
    world.wrist_turns = true;
    scene_of_world(world, robot.into().read()?)
}

/// Reads a robot and a world from texts, which may be in memory only.
///
/// # Errors
/// [`InputError`] with all defects of the texts.
pub fn scene_from(urdf: Source, world: Source) -> Result<LoadedScene, InputError> {
    scene_of_world(world::read(world)?, urdf)
}

/// Reads a world for an arm that was made in code.
///
/// # Errors
/// [`InputError`] with all defects of the world, and for an arm with invalid numbers. A table `[robot]` is an error as well,
/// because it applies to URDFs only.
pub fn scene_of(arm: Arm, world: Source) -> Result<LoadedScene, InputError> {
    let world = world::read(world)?;
    let refused = |message: String, help: &str| Diagnostic::new(world.source.name(), message).help(help);
    if world.robot.unplaced() != RobotTable::default() {
        let message =
            "[robot] may have only `at`, `angle` and `calibration`, because this arm was made in code, without a URDF"
                .into();
        return Err(refused(message, "remove the other keys of [robot]").into());
    }
    for pair in &world.in_degrees {
        pair.check(&world.source, &arm.joints)?;
    }
    let joints = RobotJoints::only_planned(&arm.joints.each_ref().map(|joint| joint.name.clone()));
    let initial_workspace = world.initial_workspace();
    let trajectories = initial_workspace.trajectories();
    initial_workspace
        .clone()
        .scene(arm.clone())
        .map_err(|error| refused(error.to_string(), "use finite numbers and sizes above 0"))?;
    let scene = world.scene(initial_workspace, &arm);
    Ok(LoadedScene { scene, trajectories, world, arm, robot: RobotReport { joints, ..RobotReport::default() } })
}

/// Reads a world without a robot.
///
/// # Errors
/// [`InputError`] with all defects of the world that do not depend on the arm.
pub fn world_from(world: Source) -> Result<World, InputError> {
    world::read(world)
}

impl LoadedScene {
    /// Returns the start and the first goal that the world file states, even if they are invalid.
    pub fn stated_ends(&self) -> [Option<Goal>; 2] {
        let goal = self.world.goals.as_ref().and_then(|(goals, _)| goals.first().copied());
        [self.world.start.as_ref().map(|&(start, _)| start), goal]
    }

    /// Returns the wrist of the world, with its joint if the world names one. `None` if the world has no wrist.
    pub fn wrist(&self) -> Option<Wrist> {
        let (wrist, _) = self.world.wrist.as_ref()?;
        let turn = self.world.place.as_ref().map_or(0.0, |place| place.rotation.angle());
        let joint = self.robot.joints.wrist.as_ref().map(|ToolJoint { rest, sign, range, direction, .. }| WristJoint {
            sign: *sign,
            zero: direction + turn - sign * rest,
            rest: *rest,
            range: *range,
        });
        Some(Wrist { joint, ..*wrist })
    }

    /// Returns the wrist for a line that states the angle of the tool, the name of the wrist's joint, and a note if any of its
    /// limits is assumed.
    ///
    /// # Errors
    /// A world without a wrist, without the name of its joint, or with a limit on its jerk.
    pub fn wrist_for_line(&self) -> Result<(Wrist, &str, Option<&str>), InputError> {
        let note = self.world.wrist.as_ref().and_then(|(_, note)| note.as_deref());
        let joint = self.robot.joints.wrist.as_ref();
        if self.world.wrist.as_ref().is_some_and(|(wrist, _)| wrist.jerk.is_some()) {
            return Err(self.world.source.diagnostic(WRIST_WITH_JERK).help(WITHOUT_JERK).into());
        }
        let found = self.wrist().zip(joint).map(|(wrist, joint)| (wrist, joint.name.as_str(), note));
        found.ok_or_else(|| {
            let message = "the line requires an angle of the tool, but the world does not name the wrist's joint";
            self.world.source.diagnostic(message).help(NAME_THE_WRIST).into()
        })
    }

    /// Returns the sensor of the world. For properties that the world file does not state, uses [`Sensor::default_for`].
    pub fn sensor(&self) -> Sensor {
        let turn = self.world.place.as_ref().map_or(0.0, |place| place.rotation.angle());
        self.world.sensor.completed_by(Sensor { turn, ..Sensor::default_for(self.scene.arm()) })
    }

    /// Returns the paths of all files that were read: those of the robot, then those of the world.
    pub fn files(&self) -> Vec<PathBuf> {
        self.robot.files.iter().cloned().chain(self.world.files()).collect()
    }

    /// Does the same as [`scene_from`], for a changed text of the world. Reads the robot again only if the table `[robot]` has
    /// changed in more than the robot's pose.
    ///
    /// # Errors
    /// [`InputError`] with all defects of the texts.
    pub fn with_world_text(&self, urdf: &Source, world: Source) -> Result<Self, InputError> {
        let world = world::read(world)?;
        if world.robot.unplaced() != self.world.robot.unplaced() {
            return scene_of_world(world, urdf.clone());
        }
        for pair in &world.in_degrees {
            pair.check(&world.source, &self.scene.arm().joints)?;
        }
        Ok(Self::unchecked(world, self.arm.clone(), self.robot.clone()))
    }

    /// Combines an arm and its world, without checks.
    fn unchecked(world: World, arm: Arm, robot: RobotReport) -> Self {
        let initial_workspace = world.initial_workspace();
        let trajectories = initial_workspace.trajectories();
        Self { scene: world.scene(initial_workspace, &arm), trajectories, world, arm, robot }
    }

    /// Returns the scene without its objects, and the trajectories of its loose obstacles.
    pub fn without_objects(&self) -> (Scene, Vec<ObstacleTrajectory>) {
        let workspace = self.world.workspace.clone();
        let trajectories = workspace.trajectories();
        (self.world.scene(workspace, &self.arm), trajectories)
    }

    /// Returns the scene with the trajectories of its loose obstacles. Their times count from time 0 of the world.
    pub fn timed(&self) -> TimedScene<'_> {
        TimedScene { scene: &self.scene, trajectories: &self.trajectories }
    }
}

/// Reads the robot and combines it with its world.
fn scene_of_world(world: World, urdf: Source) -> Result<LoadedScene, InputError> {
    let (arm, robot) = cplan_robot::load(urdf, world.robot_settings())?;
    for pair in &world.in_degrees {
        pair.check(&world.source, &arm.joints)?;
    }
    let mut loaded = LoadedScene::unchecked(world, arm, robot);
    loaded.robot.warnings.extend(nearness::warnings(&loaded.scene));
    Ok(loaded)
}

/// Examines a robot and collects all defects. The world file chooses, holds and overrides joints. Without it, the decisions that
/// it would have to make are among the diagnostics, and [`Inspection::help`] has entries that make them.
pub fn inspect(robot: impl Into<RobotFile>, world: Option<&Path>) -> Inspection {
    let mut unread = None;
    let file = match world.map(|path| Source::read(path).and_then(world::read)) {
        None => World::empty(),
        Some(Ok(file)) => file,
        Some(Err(error)) => {
            unread = Some(error);
            World::empty()
        }
    };
    let inspection = cplan_robot::survey(&robot.into(), file.robot_settings());
    let mut files = inspection.files;
    files.extend(file.files());
    // A world that cannot be read is an input file, too.
    files.extend(world.map(Path::to_owned));
    let in_world = |alone: Scene| file.scene(file.initial_workspace(), alone.arm());
    let mut inspection = Inspection {
        world: world.map(|p| p.display().to_string()),
        scene: inspection.scene.map(in_world),
        trajectories: file.initial_workspace().trajectories(),
        files,
        ..inspection
    };
    if let Some(error) = unread {
        inspection.errors.insert(0, error);
    }
    inspection.warnings.extend(inspection.scene.as_ref().map(nearness::warnings).unwrap_or_default());
    if world.is_some() && inspection.is_plannable() {
        let loaded = inspection.scene.clone().map(|scene| {
            let arm = scene.arm().clone();
            let trajectories = inspection.trajectories.clone();
            LoadedScene { scene, trajectories, world: file, arm, robot: RobotReport::default() }
        });
        // The joints of the tool are not known here.
        let query = loaded.filter(|loaded| loaded.has_steps() || !loaded.is_task()).and_then(|loaded| {
            let what = if loaded.has_steps() { "task" } else { "start and goal" };
            loaded.resolve(&Overrides::default(), Rules::Plan).err().map(|error| (what, error))
        });
        if let Some((what, error)) = query {
            inspection.warnings.extend(error.diagnostics().iter().map(|d| format!("{what}: {}", d.message)));
        }
    }
    inspection
}

/// Reads a planning problem: [`load_scene`], then [`LoadedScene::problem`].
///
/// # Errors
/// [`InputError`], for the files or for start and goal.
pub fn load(robot: impl Into<RobotFile>, world: &Path, overrides: &Overrides) -> Result<LoadedProblem, InputError> {
    load_scene(robot, world)?.problem(overrides)
}
