//! The world file: its schema, and the workspace it describes.

use super::goal_table::GoalTable;
use super::help::help;
use super::joint_pair::JointPair;
use super::object::{self, MovableObject, Names, ObjectTable};
use super::obstacle::{Margins, ObstacleKind, ObstacleTable};
use super::pallet::{PalletTable, Pallets};
use super::preference::PreferenceTable;
use super::reader::Reader;
#[cfg(test)]
use super::schema::*;
use super::sensor::{SensorTable, SensorWishes};
use super::sequence::{Sequence, WristOfWorld, write_out};
use super::step::{StepReader, StepTable, TaskTable};
use super::table::Table;
use super::tool_values::StatedTool;
use super::world_map::{self, MapTable};
use cplan_geometry::Pose;
use cplan_handling::{Holding, Object, TimedWorkspace, Wrist};
use cplan_model::{Arm, Calibration, Goal, Growth, Obstacle, Scene, Workspace};
use cplan_robot::{
    CalibrationTable, Diagnostic, InputError, Length, LengthError, Lengths, RobotSettings, RobotTable, Source, Spanned,
    Written, toml_table,
};
use cplan_text::fixed;
use std::ops::Range;
use std::path::PathBuf;

/// A world file that has been read. Its workspace is valid; names of joints and links are not checked yet.
#[derive(Debug, Clone)]
pub struct World {
    /// Obstacles (except the objects), clearance and title.
    pub workspace: TimedWorkspace,
    /// Objects that can be carried.
    pub objects: Vec<Object>,
    /// Notes about input that was corrected.
    pub notes: Vec<String>,
    /// Paths of the files that the world names, and of the files that those name.
    pub(super) named_files: Vec<PathBuf>,
    pub(super) source: Source,
    pub(super) robot: RobotTable,
    /// Pose of the robot in the world. `None` if the file states none.
    pub(super) place: Option<Pose>,
    pub(super) start: Option<(Goal, Range<usize>)>,
    /// Joint values that are written in degrees. They are checked once the types of the joints are known.
    pub(super) in_degrees: Vec<JointPair>,
    /// The alternative goals, at least one, and their position in the file. `None` without a goal.
    pub(super) goals: Option<(Vec<Goal>, Range<usize>)>,
    pub(super) steps: Option<Sequence>,
    /// Values of the tool's joints that the start and the goal state.
    pub(super) tool: [StatedTool; 2],
    pub(super) sensor: SensorWishes,
    /// The wrist, with a note about its limits if any is assumed.
    pub(super) wrist: Option<(Wrist, Option<String>)>,
    /// True if the wrist turns during motions although the world has no steps.
    pub(super) wrist_turns: bool,
    /// Errors for which motions must stay free.
    pub(super) calibration: CalibrationTable,
}

impl World {
    /// Creates an empty world.
    pub(super) fn empty() -> Self {
        Self {
            workspace: Workspace::new([]).into(),
            objects: Vec::new(),
            notes: Vec::new(),
            named_files: Vec::new(),
            source: Source::in_memory("", ""),
            robot: RobotTable::default(),
            place: None,
            start: None,
            in_degrees: Vec::new(),
            goals: None,
            steps: None,
            tool: [StatedTool::default(), StatedTool::default()],
            sensor: SensorWishes::default(),
            wrist: None,
            wrist_turns: false,
            calibration: CalibrationTable::default(),
        }
    }

    /// Returns the paths of all files that were read for the world, its own first.
    pub(super) fn files(&self) -> impl Iterator<Item = PathBuf> {
        self.source.files().into_iter().chain(self.named_files.iter().cloned())
    }

    /// Returns true if there are steps, or if start or goal state values of the tool's joints.
    pub(super) fn is_task(&self) -> bool {
        self.steps.is_some() || self.tool.iter().any(|tool| !tool.is_empty())
    }

    /// Returns the settings for reading the robot.
    pub(super) fn robot_settings(&self) -> RobotSettings<'_> {
        RobotSettings { table: &self.robot, source: &self.source, wrist_turns: self.is_task() || self.wrist_turns }
    }

    /// Returns the workspace with all objects, which follow the static obstacles. Each object is at its initial place, or moves
    /// as the file states.
    pub(super) fn initial_workspace(&self) -> TimedWorkspace {
        let mut workspace = self.workspace.clone();
        let lying = |object: &Object| object.obstacle_at(object.initial_static_pose().as_ref());
        workspace.fixed.obstacles.extend(self.objects.iter().map(lying));
        workspace.movers.extend(self.objects.iter().filter_map(Object::moving));
        let error = self.calibration.obstacles.unwrap_or_default().0;
        let fixed = workspace.fixed.obstacles.iter_mut().skip(self.workspace.fixed.obstacles.len());
        let moving = workspace.movers.iter_mut().skip(self.workspace.movers.len()).map(|mover| &mut mover.obstacle);
        for object in fixed.chain(moving) {
            object.growth.error = error;
        }
        workspace.grown()
    }

    /// Returns the scene of an arm in this workspace, with the errors for which motions must stay free.
    pub(super) fn scene(&self, workspace: TimedWorkspace, arm: &Arm) -> Scene {
        let placed = self.place.as_ref().map_or_else(|| arm.clone(), |place| arm.placed(place));
        let (drawn, errors) = (workspace.scene_trusted(placed), self.calibration.of_robot());
        if errors == Calibration::default() { drawn } else { drawn.within_errors(&errors) }
    }

    /// Replaces the errors for which motions must stay free by those of an option. A displacement that the option states applies
    /// to all obstacles.
    pub(super) fn replace_errors(&mut self, stated: CalibrationTable) {
        self.calibration = self.calibration.replaced_by(stated);
        if let Some(LengthError(error)) = stated.obstacles {
            let TimedWorkspace { fixed, movers } = &mut self.workspace;
            let moving = movers.iter_mut().map(|mover| &mut mover.obstacle);
            fixed.obstacles.iter_mut().chain(moving).for_each(|obstacle| obstacle.growth.error = error);
        }
    }

    pub(super) fn remove_errors(&mut self) {
        self.calibration = CalibrationTable::default();
        self.replace_errors(CalibrationTable { obstacles: Some(LengthError(0.0)), ..CalibrationTable::default() });
    }

    /// Returns the greatest displacement of an obstacle for which motions must stay free, metres.
    pub(super) fn greatest_displacement(&self) -> f64 {
        let moving = self.workspace.movers.iter().map(|mover| &mover.obstacle);
        let all = self.workspace.fixed.obstacles.iter().chain(moving).map(|obstacle| obstacle.growth.error);
        all.fold(self.calibration.obstacles.unwrap_or_default().0, f64::max)
    }

    /// Returns true if motions must stay free despite errors of the robot or displacements of obstacles.
    pub fn has_errors(&self) -> bool {
        self.calibration.of_robot() != Calibration::default() || self.greatest_displacement() > 0.0
    }

    /// Returns the diagnostic about a task in a world with errors.
    pub(super) fn task_with_errors(&self) -> Diagnostic {
        let at = self.robot.calibration.as_ref().map(|table| table.span());
        let message = "errors (calibration) do not apply to worlds with steps, because they would also displace the objects that are picked and placed";
        let diagnostic = match at {
            Some(at) => self.source.diagnostic_at(at, message),
            None => self.source.diagnostic(message),
        };
        diagnostic.help("remove the errors, and state a clearance that covers them")
    }
}

toml_table! {
    /// A world for cplan: obstacles, the start of the arm, and its goal or the steps of its task. Lengths are in
    /// metres, angles in radians, coordinates in the arm's plane.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "cplan world", extend("dependencies" = {
        "task": ["step"], "step": { "not": { "required": ["goal"] } }
    })))]
    pub(super) struct WorldFile {
        /// Title of summaries and pictures; by default the file's name.
        name: Option<String>,
        /// Least distance between the arm and every obstacle, m; by default 0, so that any proven distance above zero
        /// suffices.
        #[cfg_attr(test, schemars(with = "Option<NotNegativeLength>"))]
        clearance: Option<Length>,
        #[cfg_attr(test, schemars(default, with = "RobotTable"))]
        robot: Option<RobotTable>,
        #[cfg_attr(test, schemars(with = "Option<StartTable>"))]
        start: Option<Spanned<Table<StartTable>>>,
        #[cfg_attr(test, schemars(with = "Option<GoalTable>"))]
        goal: Option<Spanned<Table<GoalTable>>>,
        map: Option<MapTable>,
        sensor: Option<SensorTable>,
        /// Obstacles, which the arm must not touch.
        #[cfg_attr(test, schemars(default, with = "Vec<ObstacleTable>"))]
        obstacle: Vec<Spanned<ObstacleTable>>,
        /// Regions that field planners prefer or avoid; other planners ignore them.
        #[cfg_attr(test, schemars(default, with = "Vec<PreferenceTable>"))]
        preference: Vec<Spanned<PreferenceTable>>,
        /// Places in rows and columns.
        #[cfg_attr(test, schemars(default, with = "Vec<PalletTable>"))]
        pallet: Vec<Spanned<PalletTable>>,
        /// Objects that steps pick and place.
        #[cfg_attr(test, schemars(default, with = "Vec<ObjectTable>"))]
        object: Vec<Spanned<ObjectTable>>,
        /// The steps of the task, in order, instead of a goal.
        #[cfg_attr(test, schemars(default, with = "Vec<StepTable>"))]
        step: Vec<Spanned<StepTable>>,
        task: Option<Spanned<TaskTable>>,
    }

    /// Start of the arm: joint values, or a tip position with a single IK solution.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "start", extend("oneOf" = [{ "required": ["joints"] }, { "required": ["tip"] }])))]
    struct StartTable {
        /// Values of both joints, base to tip, rad or m.
        #[cfg_attr(test, schemars(with = "Option<[Quantity; 2]>"))]
        joints: Option<Spanned<Vec<Written>>>,
        /// Coordinates of the tip, m. Exactly one IK solution must be within the limits and free.
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        tip: Option<Lengths>,
        /// Value of the joint that lowers the tool, m; by default the tool is raised.
        stroke: Option<Length>,
        /// Value of the wrist's joint, rad; by default its `fixed` value.
        wrist: Option<Written>,
    }
}

/// Reads a world.
///
/// # Errors
/// Malformed TOML, unknown keys and invalid values, with line, column and a caret.
pub(super) fn read(source: Source) -> Result<World, InputError> {
    if source.text().trim_start().starts_with('<') {
        let diagnostic = source.diagnostic("this is XML, not a world file (TOML)");
        return Err(diagnostic.help("give the URDF first and the world file second").into());
    }
    let mut file: WorldFile = source.toml(&|message, at| {
        let is_unknown = message.contains("unknown field");
        if is_unknown { "use a known key, or remove this one" } else { help(source.text(), at) }
    })?;
    let robot = file.robot.take().unwrap_or_default();
    let reader = Reader::new(&source);
    let clearance = file.clearance.as_ref().map(|c| reader.not_negative(c, "clearance")).transpose()?.unwrap_or(0.0);
    let start = file.start.as_ref().map(|s| {
        let Table(StartTable { joints, tip, .. }) = s.get_ref();
        reader.place(joints.as_ref(), tip.as_ref(), s.span(), "start")
    });
    let start = start.transpose()?;
    let start_table = file.start.as_ref().map(|s| &s.get_ref().0);
    let goal_table = file.goal.as_ref().map(|g| &g.get_ref().0);
    let tool = [
        start_table.map(|s| StatedTool::read(&reader, s.stroke.as_ref(), s.wrist.as_ref(), "start")),
        goal_table.map(|g| StatedTool::read(&reader, g.stroke.as_ref(), g.wrist.as_ref(), "goal")),
    ];
    let [start_tool, goal_tool] = tool.map(|read| read.transpose().map(Option::unwrap_or_default));
    let tool = [start_tool?, goal_tool?];
    let goals = file.goal.as_ref().map(|g| reader.goals(&g.get_ref().0, g.span())).transpose()?;
    let (mut obstacles, mut movers) = (Vec::new(), Vec::new());
    let calibration = robot.calibration.as_ref().map(|table| *table.get_ref()).unwrap_or_default();
    let displacement = calibration.obstacles.unwrap_or_default().0;
    for (index, table) in file.obstacle.iter().enumerate() {
        match ObstacleTable::read(&reader, index, table, Margins { clearance, displacement })? {
            ObstacleKind::Static(obstacle) => obstacles.push(obstacle),
            ObstacleKind::Moving(mover) => movers.push(mover),
        }
    }
    let map = file.map.as_ref().map(|m| world_map::read(&reader, m)).transpose()?.unwrap_or_default();
    let error = displacement;
    obstacles
        .extend(map.obstacles.into_iter().map(|wall| Obstacle { growth: Growth { error, ..wall.growth }, ..wall }));
    let preferences = file.preference.iter().enumerate().map(|(i, p)| PreferenceTable::read(&reader, i, p));
    let mut preferences = preferences.collect::<Result<Vec<_>, _>>()?;
    preferences.extend(map.preferences);
    let wrist = robot.wrist.as_ref().map(|table| {
        let wrist = table.read(&source, &robot.jerk, robot.allows_arches())?;
        Ok::<_, Diagnostic>((wrist, table.note(&wrist)))
    });
    let wrist = wrist.transpose()?;
    let sensor = file.sensor.as_ref().map(|table| table.read(&reader)).transpose()?.unwrap_or_default();
    let payload = robot.payload.as_ref().map(|p| object::parse_holding(&reader, p)).transpose()?;
    let pallets = Pallets::read(&reader, &file.pallet)?;
    let held = payload.unwrap_or(Holding::Rigid);
    let (movables, names) = object::read(&reader, &file.object, &pallets, &obstacles, &movers, held)?;
    let of_wrist = match &wrist {
        None => WristOfWorld::None,
        Some(_) if robot.wrist_joint().is_none() => WristOfWorld::Nameless,
        Some((wrist, _)) if wrist.jerk.is_some() => WristOfWorld::WithJerk,
        Some(_) => WristOfWorld::Named,
    };
    let steps = steps(&reader, &file, &pallets, (&names, &obstacles, &movables), of_wrist)?;
    let stem = source.stem().unwrap_or_else(|| "world".to_owned());
    let place = reader.pose(robot.at.as_ref(), robot.angle.as_ref(), "[robot]")?;
    let mut notes = reader.taken.lines();
    notes.extend(place.as_ref().map(|place| {
        let (at, angle) = (place.translation, place.rotation.angle());
        let turn = format!("{} deg ({} rad)", fixed(angle.to_degrees(), 2), fixed(angle, 4));
        format!("robot: the root frame is at ({}, {}) m in the world, turned by {turn}", at.x, at.y)
    }));
    let fixed = Workspace { name: file.name.unwrap_or(stem), obstacles, clearance, preferences };
    let world = World {
        notes,
        workspace: TimedWorkspace { fixed, movers }.grown(),
        start,
        in_degrees: reader.in_degrees.take(),
        named_files: reader.files.take(),
        // Steps replace the goals of the map.
        goals: goals.or(map.goals.filter(|_| steps.is_none())),
        objects: movables.into_iter().map(|movable| movable.object).collect(),
        steps,
        tool,
        sensor,
        wrist,
        wrist_turns: false,
        calibration,
        place,
        robot,
        source,
    };
    if world.is_task() && world.has_errors() {
        return Err(world.task_with_errors().into());
    }
    Ok(world)
}

/// Returns the steps with all repetitions. `None` if there are no steps.
fn steps(
    reader: &Reader,
    file: &WorldFile,
    pallets: &Pallets,
    (names, obstacles, movables): (&Names, &[Obstacle], &[MovableObject]),
    wrist: WristOfWorld,
) -> Result<Option<Sequence>, Diagnostic> {
    if file.step.is_empty() {
        return file.task.as_ref().map_or(Ok(None), |task| {
            let diagnostic = reader.source.diagnostic_at(task.span(), "[task] needs steps, but there are none");
            Err(diagnostic.help("give the world a [[step]], or remove [task]"))
        });
    }
    if let Some(goal) = &file.goal {
        let diagnostic = reader.source.diagnostic_at(goal.span(), "a world has either a goal or steps, not both");
        return Err(diagnostic.help("remove [goal]; a [[step]] with move = { joints = [q1, q2] } goes there"));
    }
    let task = file.task.as_ref().map(Spanned::get_ref);
    let group = StepReader::new(reader, pallets, names, movables).all(&file.step, task)?;
    let at = file.step[0].span();
    write_out(reader, (names, obstacles, movables), wrist, &group, at).map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_agrees_with_its_file() {
        compare_with_file(toml_schemas().into_root_schema_for::<WorldFile>(), "world.schema.json");
    }
}
