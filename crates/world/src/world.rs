//! The world file: its schema, and the workspace it describes.

use super::error::{Diagnostic, InputError};
use super::help::help;
use super::notes::Taken;
use super::object::{self, Movable, Names, ObjectTable};
use super::obstacle::{ObstacleTable, Read};
use super::pallet::{PalletTable, Pallets};
use super::preference::PreferenceTable;
use super::quantity::{JointPair, Written};
use super::schema::{AngleOrLength, HeldAs, NotNegative, Positive, Two};
use super::sensor::{SensorTable, SensorWishes};
use super::sequence::{Sequence, write_out};
use super::source::Source;
use super::step::{StepReader, StepTable, TaskTable};
use super::stroke::StrokeTable;
use super::table::Table;
use super::world_map::{self, MapTable};
use super::wrist::WristTable;
use cplan_core::model::{Goal, Heights, Holding, Object, Workspace, Wrist};
use cplan_core::space::Configuration;
use cplan_geometry::{Point, Pose, Vector};
use schemars::JsonSchema;
use serde::Deserialize;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;
use toml::Spanned;

pub(super) type Number = Spanned<f64>;
pub(super) type Numbers = Spanned<Vec<Number>>;
/// Values by joint name, with the place of both.
pub(super) type PerJoint<T> = BTreeMap<Spanned<String>, T>;

/// A world file that has been read: the workspace is valid; names of joints and links are not yet checked.
#[derive(Debug, Clone)]
pub struct World {
    /// Obstacles that stay where they are, clearance and title.
    pub workspace: Workspace,
    /// What can be moved.
    pub objects: Vec<Object>,
    /// What was taken as it must be meant, though it was not written so.
    pub notes: Vec<String>,
    pub(super) source: Source,
    pub(super) robot: RobotTable,
    /// Where the robot stands, if that is said.
    pub(super) place: Option<Pose>,
    pub(super) start: Option<(Goal, Range<usize>)>,
    /// Joint values that are in degrees, where it is not yet known whether the joints turn.
    pub(super) in_degrees: Vec<JointPair>,
    /// Where to go, any of which will do, at least one, and where that is written.
    pub(super) goals: Option<(Vec<Goal>, Range<usize>)>,
    pub(super) steps: Option<Sequence>,
    pub(super) sensor: SensorWishes,
    /// With what is to be said of it.
    pub(super) wrist: Option<(Wrist, Option<String>)>,
}

impl World {
    /// A world that says nothing.
    pub(super) fn silent() -> Self {
        Self {
            workspace: Workspace {
                name: String::new(),
                obstacles: Vec::new(),
                clearance: 0.0,
                preferences: Vec::new(),
                movers: Vec::new(),
            },
            objects: Vec::new(),
            notes: Vec::new(),
            source: Source::in_memory("", ""),
            robot: RobotTable::default(),
            place: None,
            start: None,
            in_degrees: Vec::new(),
            goals: None,
            steps: None,
            sensor: SensorWishes::default(),
            wrist: None,
        }
    }

    /// The workspace with every object where it lies at first, after the obstacles that stay where they are, or on its course.
    pub(super) fn at_first(&self) -> Workspace {
        let mut workspace = self.workspace.clone();
        let lying = |object: &Object| object.lying(object.standing_at_first().as_ref());
        workspace.obstacles.extend(self.objects.iter().map(lying));
        workspace.movers.extend(self.objects.iter().filter_map(Object::moving));
        workspace
    }
}

/// What the URDF leaves open, and what goes over it. All keys are optional.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "robot")]
pub(super) struct RobotTable {
    /// Where the robot stands: the place of its root frame's origin in the world, m; by default [0, 0].
    #[schemars(with = "Option<Two>")]
    at: Option<Numbers>,
    /// How its root frame is turned, rad; by default 0.
    #[schemars(with = "Option<AngleOrLength>")]
    angle: Option<Written>,
    /// The two joints that move, from the base to the tip; needed only if the URDF has more than two that can.
    #[schemars(with = "Option<[String; 2]>")]
    pub joints: Option<Spanned<Vec<Spanned<String>>>>,
    /// Link whose origin is the tip; by default the end of the chain.
    #[schemars(with = "Option<String>")]
    pub tip: Option<Spanned<String>>,
    /// Values of the other movable joints, by name, rad or m; by default 0, clamped into their limits.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, AngleOrLength>")]
    pub fixed: PerJoint<Written>,
    /// Least and greatest value of a joint, by name, rad or m, in place of the URDF's.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, [AngleOrLength; 2]>")]
    pub limits: PerJoint<Spanned<Vec<Written>>>,
    /// Top speed of a joint, by name, rad/s or m/s, in place of the URDF's.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Positive>")]
    pub velocity: PerJoint<Number>,
    /// Greatest acceleration of a joint, by name, rad/s2 or m/s2; by default top speed is reached in 0.25 s.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Positive>")]
    pub acceleration: PerJoint<Number>,
    /// Greatest jerk of a joint, by name, rad/s3 or m/s3; a joint without has no such limit.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Positive>")]
    pub jerk: PerJoint<Number>,
    /// Greatest torque or force of a joint, by name, N m or N, in place of the URDF's.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Positive>")]
    pub effort: PerJoint<Number>,
    /// Whether motions keep within the joints' efforts, by the masses that the URDF gives.
    #[serde(default)]
    pub dynamics: bool,
    /// Acceleration of free fall in the robot's root frame, m/s2; by default [0, 0, -9.81].
    #[schemars(with = "Option<[f64; 3]>")]
    pub gravity: Option<Numbers>,
    /// Whether links of the robot are in the way of its other links; by default true.
    pub own_body: Option<bool>,
    /// Pairs of the robot's links that may touch each other.
    #[schemars(with = "Option<Vec<[String; 2]>>")]
    pub ignore_contact: Option<Vec<Spanned<Vec<Spanned<String>>>>>,
    /// Radius of the capsule that stands in for a link without geometry, m.
    #[schemars(with = "Option<Positive>")]
    pub bar: Option<Number>,
    /// The wrist that keeps or turns what is carried with payload "level".
    wrist: Option<WristTable>,
    /// How the tool is lowered and raised at picks and places; by default it is not.
    #[schemars(with = "Option<StrokeTable>")]
    pub stroke: Option<StrokeTable>,
    /// How objects are held that do not say it; by default "rigid".
    #[schemars(with = "Option<HeldAs>")]
    payload: Option<Spanned<String>>,
}

impl RobotTable {
    /// The same of a robot that stands in the origin: what its URDF is read by.
    pub fn unplaced(&self) -> Self {
        Self { at: None, angle: None, ..self.clone() }
    }

    /// The joint of the wrist, if it is named.
    pub fn wrist_joint(&self) -> Option<&Spanned<String>> {
        self.wrist.as_ref()?.joint.as_ref()
    }
}

/// A workspace for cplan: obstacles, where the arm starts and where it is to go, or the steps that it is to do. Lengths are
/// in metres, angles in radians, coordinates in the arm's plane.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "cplan world", extend("dependencies" = {
    "task": ["step"], "step": { "not": { "required": ["goal"] } }
}))]
pub(super) struct WorldFile {
    /// Title of summaries and pictures; by default the file's name.
    name: Option<String>,
    /// Least distance to keep from every obstacle, m; by default 0: any proven distance above zero.
    #[schemars(with = "Option<NotNegative>")]
    clearance: Option<Number>,
    #[serde(default)]
    robot: RobotTable,
    #[schemars(with = "Option<StartTable>")]
    start: Option<Spanned<Table<StartTable>>>,
    #[schemars(with = "Option<GoalTable>")]
    goal: Option<Spanned<Table<GoalTable>>>,
    map: Option<MapTable>,
    sensor: Option<SensorTable>,
    /// What the arm must not touch.
    #[serde(default)]
    #[schemars(with = "Vec<ObstacleTable>")]
    obstacle: Vec<Spanned<ObstacleTable>>,
    /// Regions that field planners prefer or avoid; other planners do not look at them.
    #[serde(default)]
    #[schemars(with = "Vec<PreferenceTable>")]
    preference: Vec<Spanned<PreferenceTable>>,
    /// Places in rows and columns.
    #[serde(default)]
    #[schemars(with = "Vec<PalletTable>")]
    pallet: Vec<Spanned<PalletTable>>,
    /// What steps pick and place.
    #[serde(default)]
    #[schemars(with = "Vec<ObjectTable>")]
    object: Vec<Spanned<ObjectTable>>,
    /// What the arm is to do, one after the other, in place of a goal.
    #[serde(default)]
    #[schemars(with = "Vec<StepTable>")]
    step: Vec<Spanned<StepTable>>,
    #[schemars(with = "Option<TaskTable>")]
    task: Option<Spanned<TaskTable>>,
}

/// Where the arm is at first: joint values, or a place for the tip that a single IK solution reaches.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "start", extend("oneOf" = [{ "required": ["joints"] }, { "required": ["tip"] }]))]
struct StartTable {
    /// Values of both joints, base to tip, rad or m.
    #[schemars(with = "Option<[AngleOrLength; 2]>")]
    joints: Option<Spanned<Vec<Written>>>,
    /// Coordinates of the tip, m; taken if one IK solution alone is within the limits and free.
    #[schemars(with = "Option<Two>")]
    tip: Option<Numbers>,
}

/// Where the arm is to go: joint values, a place for the tip in whatever IK solution is best, or areas for the tip.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "goal", extend("oneOf" = [{ "required": ["joints"] }, { "required": ["tip"] }, { "required": ["areas"] }]))]
pub(super) struct GoalTable {
    /// Values of both joints, base to tip, rad or m.
    #[schemars(with = "Option<[AngleOrLength; 2]>")]
    joints: Option<Spanned<Vec<Written>>>,
    /// Coordinates of the tip, m.
    #[schemars(with = "Option<Two>")]
    tip: Option<Numbers>,
    /// Rectangles for the tip, any of which will do, each by two opposite corners, m; of an arm that does not slide along both axes each
    /// counts as its middle. Not in steps.
    #[schemars(with = "Option<Vec<[Two; 2]>>")]
    areas: Option<Spanned<Vec<Spanned<Vec<Numbers>>>>>,
}

/// Greatest length or coordinate, metres: beyond it products of coordinates lose the last micrometre, and no arm is
/// that large.
pub const LARGEST: f64 = 1e6;

/// What to do about a number beyond [`LARGEST`].
pub(super) fn bound_hint() -> String {
    format!(
        "lengths are in metres, angles in radians, from -{LARGEST:e} to {LARGEST:e}: put the origin of all coordinates near the arm"
    )
}

/// Reads a world.
///
/// # Errors
/// On malformed TOML, unknown keys and invalid values, with line, column and a caret.
pub(super) fn read(source: Source) -> Result<World, InputError> {
    if source.text.trim_start().starts_with('<') {
        let diagnostic = source.diagnostic("this is XML, not a world file (TOML)");
        return Err(diagnostic.help("give the URDF first and the world file second").into());
    }
    let file: WorldFile = toml::from_str(&source.text).map_err(|error| match error.span() {
        Some(span) => {
            let is_unknown = error.message().contains("unknown field");
            let help =
                if is_unknown { "use a key that is known, or remove this one" } else { help(&source.text, span.start) };
            source.diagnostic_at(span, in_toml_words(error.message())).help(help)
        }
        None => source.diagnostic(in_toml_words(error.message())).help(help("", 0)),
    })?;
    let reader = Reader::new(&source);
    let clearance = file.clearance.as_ref().map(|c| reader.not_negative(c, "clearance")).transpose()?.unwrap_or(0.0);
    let start = file.start.as_ref().map(|s| {
        let Table(StartTable { joints, tip }) = s.get_ref();
        reader.place(joints.as_ref(), tip.as_ref(), s.span(), "start")
    });
    let start = start.transpose()?;
    let goals = file.goal.as_ref().map(|g| reader.goals(&g.get_ref().0, g.span())).transpose()?;
    let (mut obstacles, mut movers) = (Vec::new(), Vec::new());
    for (index, table) in file.obstacle.iter().enumerate() {
        match ObstacleTable::read(&reader, index, table)? {
            Read::Standing(obstacle) => obstacles.push(obstacle),
            Read::Moving(mover) => movers.push(mover),
        }
    }
    let map = file.map.as_ref().map(|m| world_map::read(&reader, m)).transpose()?.unwrap_or_default();
    obstacles.extend(map.obstacles);
    let preferences = file.preference.iter().enumerate().map(|(i, p)| PreferenceTable::read(&reader, i, p));
    let mut preferences = preferences.collect::<Result<Vec<_>, _>>()?;
    preferences.extend(map.preferences);
    let wrist = file.robot.wrist.as_ref().map(|table| {
        let wrist = table.read(&reader)?;
        Ok::<_, Diagnostic>((wrist, table.note(&wrist)))
    });
    let wrist = wrist.transpose()?;
    let sensor = file.sensor.as_ref().map(|table| table.read(&reader)).transpose()?.unwrap_or_default();
    let payload = file.robot.payload.as_ref().map(|p| object::holding(&reader, p)).transpose()?;
    let pallets = Pallets::read(&reader, &file.pallet)?;
    let held = payload.unwrap_or(Holding::Rigid);
    let (movables, names) = object::read(&reader, &file.object, &pallets, &obstacles, &movers, held)?;
    let steps = steps(&reader, &file, &pallets, &names, &movables, wrist.is_some())?;
    let stem = source.stem().unwrap_or_else(|| "world".to_owned());
    let place = reader.pose(file.robot.at.as_ref(), file.robot.angle.as_ref(), "[robot]")?;
    let mut notes = reader.taken.lines();
    notes.extend(place.as_ref().map(|place| {
        let (at, angle) = (place.translation.vector, place.rotation.angle());
        format!("robot: its root frame stands at ({}, {}) m in the world, turned by {angle} rad", at.x, at.y)
    }));
    Ok(World {
        notes,
        workspace: Workspace { name: file.name.unwrap_or(stem), obstacles, clearance, preferences, movers },
        start,
        in_degrees: reader.in_degrees.take(),
        // Steps count for more than a map's goal.
        goals: goals.or(map.goals.filter(|_| steps.is_none())),
        objects: movables.into_iter().map(|movable| movable.object).collect(),
        steps,
        sensor,
        wrist,
        place,
        robot: file.robot,
        source,
    })
}

/// The steps, written out; none if there are none.
fn steps(
    reader: &Reader,
    file: &WorldFile,
    pallets: &Pallets,
    names: &Names,
    movables: &[Movable],
    has_wrist: bool,
) -> Result<Option<Sequence>, Diagnostic> {
    if file.step.is_empty() {
        return file.task.as_ref().map_or(Ok(None), |task| {
            let diagnostic = reader.source.diagnostic_at(task.span(), "[task] is about steps, and there are none");
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
    write_out(reader, names, movables, has_wrist, &group, at).map(Some)
}

/// The deserialiser's message without Rust's words for what TOML calls keys and numbers.
pub fn in_toml_words(message: &str) -> String {
    message
        .replace("unknown field", "unknown key")
        .replace("missing field", "missing key")
        .replace("expected f64", "expected a number")
        .replace("map, expected a sequence", "one table, expected a list of tables: [[...]]")
        .replace("expected i64", "expected a whole number")
}

/// Checks values and knows the file they come from.
pub(super) struct Reader<'a> {
    pub source: &'a Source,
    /// What is not refused, though it is not written as it is meant.
    pub taken: Taken,
    /// Joint values in degrees.
    pub in_degrees: RefCell<Vec<JointPair>>,
}

impl<'a> Reader<'a> {
    pub fn new(source: &'a Source) -> Self {
        Self { source, taken: Taken::default(), in_degrees: RefCell::default() }
    }
}

impl Reader<'_> {
    pub fn finite(&self, number: &Number, what: &str) -> Result<f64, Diagnostic> {
        let value = *number.get_ref();
        if !value.is_finite() {
            let diagnostic =
                self.source.diagnostic_at(number.span(), format!("{what}: {value} is not a finite number"));
            return Err(diagnostic.help("write a number"));
        }
        if value.abs() > LARGEST {
            let message = format!("{what}: {value} is too large (at most {LARGEST:e})");
            return Err(self.source.diagnostic_at(number.span(), message).help(bound_hint()));
        }
        Ok(value)
    }

    pub fn not_negative(&self, number: &Number, what: &str) -> Result<f64, Diagnostic> {
        let value = self.finite(number, what)?;
        if value < 0.0 {
            let message = format!("{what} must not be negative, is {value}");
            return Err(self.source.diagnostic_at(number.span(), message).help("write 0 or more"));
        }
        Ok(value)
    }

    pub fn two(&self, numbers: &Numbers, what: &str) -> Result<[f64; 2], Diagnostic> {
        match numbers.get_ref().as_slice() {
            [a, b] => Ok([self.finite(a, what)?, self.finite(b, what)?]),
            other => {
                let message = format!("{what}: expected two numbers, found {}", other.len());
                Err(self.source.diagnostic_at(numbers.span(), message).help("write [a, b]"))
            }
        }
    }

    pub fn point(&self, numbers: &Numbers, what: &str) -> Result<Point, Diagnostic> {
        self.two(numbers, what).map(Point::from)
    }

    /// Where a frame lies and how it is turned; none if neither is said.
    pub fn pose(&self, at: Option<&Numbers>, angle: Option<&Written>, what: &str) -> Result<Option<Pose>, Diagnostic> {
        let at = at.map(|at| self.point(at, &format!("{what}, at"))).transpose()?;
        let angle = angle.map(|angle| self.quantity(angle, &format!("{what}, angle"))).transpose()?;
        let is_given = at.is_some() || angle.is_some();
        let place = || Pose::new(at.map_or_else(Vector::zeros, |at| at.coords), angle.unwrap_or(0.0));
        Ok(is_given.then(place))
    }

    /// All goals of a table, of which any will do, and where they stand.
    fn goals(&self, goal: &GoalTable, at: Range<usize>) -> Result<(Vec<Goal>, Range<usize>), Diagnostic> {
        let Some(areas) = &goal.areas else {
            let (goal, at) = self.goal(goal, at, "goal")?;
            return Ok((vec![goal], at));
        };
        if goal.joints.is_some() || goal.tip.is_some() {
            let diagnostic = self.source.diagnostic_at(at, "the goal has `areas` beside another goal");
            return Err(diagnostic.help("keep one of `joints`, `tip` and `areas`"));
        }
        let area = |corners: &Spanned<Vec<Numbers>>| match corners.get_ref().as_slice() {
            [a, b] => {
                let [a, b] = [self.point(a, "goal area")?, self.point(b, "goal area")?];
                Ok(Goal::Area([a.inf(&b), a.sup(&b)]))
            }
            other => {
                let message = format!("goal area: expected two opposite corners, found {}", other.len());
                Err(self.source.diagnostic_at(corners.span(), message).help("write [[x, y], [x, y]]"))
            }
        };
        let found = areas.get_ref().iter().map(area).collect::<Result<Vec<_>, _>>()?;
        if found.is_empty() {
            let diagnostic = self.source.diagnostic_at(areas.span(), "the goal has no area");
            return Err(diagnostic.help("areas = [[[x, y], [x, y]]]: two opposite corners each"));
        }
        Ok((found, areas.span()))
    }

    /// Joint values or a point for the tip, and where they stand.
    pub fn goal(&self, goal: &GoalTable, at: Range<usize>, what: &str) -> Result<(Goal, Range<usize>), Diagnostic> {
        if let Some(areas) = &goal.areas {
            let diagnostic = self.source.diagnostic_at(areas.span(), format!("{what}: a step has no areas"));
            return Err(diagnostic.help("joints = [q1, q2], or tip = [x, y]"));
        }
        self.place(goal.joints.as_ref(), goal.tip.as_ref(), at, what)
    }

    /// The same from the two keys, of which one is there.
    fn place(
        &self,
        joints: Option<&Spanned<Vec<Written>>>,
        tip: Option<&Numbers>,
        at: Range<usize>,
        what: &str,
    ) -> Result<(Goal, Range<usize>), Diagnostic> {
        match (joints, tip) {
            (Some(joints), None) => {
                let pair = self.joint_pair(joints, &format!("{what} joints"))?;
                let goal = Goal::Joints(Configuration::from(pair.values));
                if pair.degrees.iter().any(Option::is_some) {
                    self.in_degrees.borrow_mut().push(pair);
                }
                Ok((goal, joints.span()))
            }
            (None, Some(tip)) => Ok((Goal::Tip(self.point(tip, &format!("{what} tip"))?), tip.span())),
            (joints, _) => {
                let found = if joints.is_some() { "both" } else { "neither" };
                let message = format!("the {what} needs either `joints` or `tip`, it has {found}");
                Err(self.source.diagnostic_at(at, message).help("joints = [q1, q2], or tip = [x, y]"))
            }
        }
    }

    /// The path of a file that the world names, relative to itself.
    pub fn beside(&self, name: &Spanned<String>, what: &str) -> Result<PathBuf, Diagnostic> {
        let anchor = self.source.anchor();
        let anchor = anchor.map_err(|why| {
            let help = "save the world as a file beside it";
            self.source.diagnostic_at(name.span(), format!("{what}: {why}")).help(help)
        })?;
        let path = anchor.with_file_name(name.get_ref());
        if path.is_file() {
            return Ok(path);
        }
        let message = format!("{what}: there is no file {}", path.display());
        Err(self.source.diagnostic_at(name.span(), message).help("paths are relative to the world file"))
    }

    /// Heights, all if there are none.
    pub fn heights(&self, height: Option<&Numbers>, what: &str) -> Result<Heights, Diagnostic> {
        let Some(height) = height else { return Ok(Heights::ALL) };
        let [lower, upper] = self.two(height, &format!("{what}, height"))?;
        if lower > upper {
            let message = format!("{what}: height [{lower}, {upper}] is empty");
            return Err(self.source.diagnostic_at(height.span(), message).help("write the lower end first"));
        }
        Ok(Heights { lower, upper })
    }
}
