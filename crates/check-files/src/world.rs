//! The world file: obstacles, the query, and settings that override the URDF.

use crate::files::Files;
use calibration::Calibration;
use cells::Cells;
use cplan_check::decimal::Decimal;
use cplan_check::domain::Range;
use cplan_check::elbow::Elbow;
use cplan_check::interval::Interval;
use cplan_check::obstacle::{Obstacle, Outline, point};
use cplan_check::polygon::Corner;
use cplan_check::world::{Goal, World};
use cplan_check::{CheckError, Input};
use drives::Drives;
use num_bigint::BigInt;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::rc::Rc;
use task::Task;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

pub mod calibration;
pub mod carried_shapes;
mod cells;
pub mod drives;
pub mod lines;
mod map;
mod obstacle_trajectory;
mod picture;
mod steps;
pub mod task;

type Value<'a> = Spanned<DeValue<'a>>;

/// The content of a world file.
#[derive(Default)]
pub struct WorldFile {
    /// Obstacles, start and goal.
    pub world: World,
    /// Settings for the robot, some of which override the URDF.
    pub robot: RobotTable,
    /// The task, if the file has steps.
    pub task: Option<Task>,
}

/// Values of the `[robot]` table that the checker uses. Quantities in degrees become enclosures. Others are exact.
pub struct RobotTable {
    /// Position of the robot's root frame; `angle` is the orientation of that frame.
    pub at: Corner,
    pub angle: Interval,
    /// Names of the two joints, if given.
    pub joints: Option<Vec<String>>,
    /// Values of fixed joints, by name.
    pub fixed: BTreeMap<String, Range>,
    /// Enclosures of the lower and the upper limit of joints, by name.
    pub limits: BTreeMap<String, [Range; 2]>,
    /// Limits of the shafts of motors, if given.
    pub drives: Option<Drives>,
    /// Errors that must not make a motion collide.
    pub calibration: Calibration,
    /// Radius of bars that replace links without geometry, if given.
    pub bar: Option<Decimal>,
    /// The link whose origin is the tip, if given.
    pub tip: Option<String>,
    /// True if links of the robot must not collide with each other.
    pub own_body: bool,
    /// Pairs of links that may touch each other.
    pub ignore_contact: Vec<[String; 2]>,
}

impl Default for RobotTable {
    fn default() -> Self {
        Self {
            at: origin(),
            angle: Interval::whole(0),
            joints: None,
            fixed: BTreeMap::new(),
            limits: BTreeMap::new(),
            drives: None,
            calibration: Calibration::default(),
            bar: None,
            tip: None,
            own_body: true,
            ignore_contact: Vec::new(),
        }
    }
}

/// Units of length that a world file may name, and their lengths in metres.
const LENGTH_UNITS: [(&str, &str); 10] = [
    ("mm", "0.001"),
    ("cm", "0.01"),
    ("dm", "0.1"),
    ("m", "1"),
    ("km", "1000"),
    ("um", "0.000001"),
    ("mil", "0.0000254"),
    ("in", "0.0254"),
    ("ft", "0.3048"),
    ("yd", "0.9144"),
];

/// Reads a length with its unit, metres.
fn length_with_unit(text: &str) -> Option<Decimal> {
    let text = text.trim();
    let (number, unit) = text.split_at(text.trim_end_matches(|c: char| c.is_ascii_alphabetic()).len());
    let (_, metres) = LENGTH_UNITS.iter().find(|(name, _)| *name == unit)?;
    Some(&Decimal::read(number.trim_end()).ok()? * &Decimal::read(metres).ok()?)
}

/// Reads values of the file, and reports errors with their position.
struct Reader<'a> {
    text: &'a str,
    files: &'a Files,
}

type ReadResult<T> = Result<T, CheckError>;

impl Reader<'_> {
    fn error<T>(&self, value: &Value, message: &str) -> ReadResult<T> {
        Err(CheckError::at(Input::World, self.text, value.span().start, message))
    }

    fn table<'v, 'i>(&self, value: &'v Value<'i>) -> ReadResult<&'v DeTable<'i>> {
        value.get_ref().as_table().map_or_else(|| self.error(value, "expected a table"), Ok)
    }

    fn list<'v, 'i>(&self, value: &'v Value<'i>) -> ReadResult<Vec<&'v Value<'i>>> {
        value
            .get_ref()
            .as_array()
            .map_or_else(|| self.error(value, "expected a list"), |list| Ok(list.iter().collect()))
    }

    fn text(&self, value: &Value) -> ReadResult<String> {
        value.get_ref().as_str().map_or_else(|| self.error(value, "expected a text"), |text| Ok(text.to_owned()))
    }

    /// Reads a number exactly as written.
    fn number(&self, value: &Value) -> ReadResult<Decimal> {
        let text = match value.get_ref() {
            DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
            DeValue::Integer(number) => {
                let digits = number.as_str().replace('_', "");
                let whole = BigInt::parse_bytes(digits.as_bytes(), number.radix());
                return whole.map_or_else(|| self.error(value, "expected a number"), |n| Ok(Decimal::dyadic(&n, 0)));
            }
            DeValue::Float(number) => number.as_str(),
            _ => return self.error(value, "expected a decimal number"),
        };
        Decimal::read(&text.replace('_', "")).or_else(|why: String| self.error(value, &why))
    }

    /// Reads a length in metres, exactly: a number, or a text with a unit.
    fn length(&self, value: &Value) -> ReadResult<Decimal> {
        let Some(text) = value.get_ref().as_str() else { return self.number(value) };
        length_with_unit(text).map_or_else(|| self.error(value, "expected a number, or a length such as \"20 mm\""), Ok)
    }

    /// Reads a number, or a quantity in degrees, and returns an enclosure in radians or metres.
    fn quantity(&self, value: &Value) -> ReadResult<Range> {
        let Some(text) = value.get_ref().as_str() else {
            let number = self.number(value)?;
            return Ok([number.clone(), number]);
        };
        let degrees = text.trim().strip_suffix("deg").and_then(|number| Decimal::read(number.trim_end()).ok());
        let Some(degrees) = degrees else {
            return self.error(value, "expected a number, or an angle such as \"30deg\"");
        };
        Ok((&Interval::from(&degrees) * &Interval::pi().over(180)).ends())
    }

    fn pair<T>(&self, value: &Value, read: impl Fn(&Value) -> ReadResult<T>) -> ReadResult<[T; 2]> {
        match self.list(value)?[..] {
            [a, b] => Ok([read(a)?, read(b)?]),
            _ => self.error(value, "expected a list of two"),
        }
    }

    fn corners(&self, value: &Value) -> ReadResult<Vec<Corner>> {
        self.list(value)?.into_iter().map(|p| self.pair(p, |n| self.length(n))).collect()
    }

    /// Reads a ring, or a list of rings as in GeoJSON.
    fn rings(&self, value: &Value) -> ReadResult<Vec<Vec<Corner>>> {
        let list = self.list(value)?;
        let first = list.first().and_then(|ring| ring.get_ref().as_array()?.iter().next()?.get_ref().as_array());
        if first.is_some() {
            list.into_iter().map(|r| self.corners(r)).collect()
        } else {
            Ok(vec![self.corners(value)?])
        }
    }

    fn by_name<T>(&self, value: &Value, read: impl Fn(&Value) -> ReadResult<T>) -> ReadResult<BTreeMap<String, T>> {
        self.table(value)?.iter().map(|(name, value)| Ok((name.get_ref().to_string(), read(value)?))).collect()
    }

    /// Reads `[start]` or `[goal]`, without the keys of the tool.
    fn place(&self, value: &Value) -> ReadResult<Goal> {
        let mut table = self.table(value)?.clone();
        TOOL_KEYS.iter().for_each(|key| drop(table.remove(*key)));
        if let (Some(areas), 1) = (table.get("areas"), table.len()) {
            let area = |corners: &Value| self.pair(corners, |corner| self.pair(corner, |n| self.length(n)));
            return self.list(areas)?.into_iter().map(area).collect::<ReadResult<Vec<_>>>().map(Goal::Areas);
        }
        match (table.get("joints"), table.get("tip")) {
            (Some(joints), None) if table.len() == 1 => Ok(Goal::Joints(self.pair(joints, |q| self.quantity(q))?)),
            (None, Some(tip)) if table.len() == 1 + usize::from(table.contains_key("elbow")) => {
                Ok(Goal::Tip(self.pair(tip, |n| self.length(n))?, self.elbow(&table)?))
            }
            _ => self.error(value, "give joints = [q1, q2] or tip = [x, y]"),
        }
    }

    /// Reads the side of the elbow that a table states.
    fn elbow(&self, table: &DeTable) -> ReadResult<Option<Elbow>> {
        let read = |value| match Elbow::named(&self.text(value)?) {
            Some(elbow) => Ok(elbow),
            None => self.error(value, "expected \"left\" or \"right\""),
        };
        table.get("elbow").map(read).transpose()
    }

    fn robot(&self, value: &Value, robot: &mut RobotTable) -> ReadResult<()> {
        for (key, value) in self.table(value)? {
            match &**key.get_ref() {
                "joints" => {
                    let names: ReadResult<Vec<String>> =
                        self.list(value)?.into_iter().map(|name| self.text(name)).collect();
                    robot.joints = Some(names?);
                }
                "fixed" => robot.fixed = self.by_name(value, |q| self.quantity(q))?,
                "limits" => {
                    let range = |limits: &Value| self.pair(limits, |q| self.quantity(q));
                    robot.limits = self.by_name(value, range)?;
                }
                "tip" => robot.tip = Some(self.text(value)?),
                "at" => robot.at = self.pair(value, |n| self.length(n))?,
                "angle" => robot.angle = Interval::enclosing(&self.quantity(value)?),
                "drives" => robot.drives = self.drives(value)?,
                "calibration" => robot.calibration = self.calibration(value)?,
                // These keys do not affect the positions of shapes.
                "velocity" | "acceleration" | "jerk" | "effort" | "dynamics" | "gravity" => {}
                // These keys affect tasks only.
                "wrist" | "stroke" | "arch" | "payload" => {}
                "bar" => robot.bar = Some(self.length(value)?),
                "own_body" => match value.get_ref().as_bool() {
                    Some(own_body) => robot.own_body = own_body,
                    None => return self.error(value, "expected true or false"),
                },
                "ignore_contact" => {
                    let pairs = self.list(value)?.into_iter().map(|pair| self.pair(pair, |name| self.text(name)));
                    robot.ignore_contact = pairs.collect::<ReadResult<_>>()?;
                }
                other => return self.error(value, &format!("the checker does not know [robot] {other}")),
            }
        }
        Ok(())
    }

    fn heights(&self, value: &Value) -> ReadResult<Range> {
        let [low, high] = self.pair(value, |n| self.length(n))?;
        if low > high {
            return self.error(value, "the upper end is below the lower end");
        }
        Ok([low, high])
    }

    /// Returns the path of a file that the world refers to.
    fn file(&self, name: &str) -> ReadResult<PathBuf> {
        Ok(self.files.path(Input::World)?.with_file_name(name))
    }

    /// Reads an obstacle, or an object as an obstacle at its initial pose.
    fn obstacle(&self, value: &Value, is_object: bool) -> ReadResult<Obstacle> {
        let (mut outlines, mut holes) = (Vec::new(), Vec::new());
        let (mut at, mut angle, mut heights) = (point(&origin()), Interval::whole(0), None);
        let (mut name, mut motion) = (None, None);
        let (mut image, mut unknown_is_solid, mut stated) = (None, true, [None, None]);
        for (key, value) in self.table(value)? {
            match &**key.get_ref() {
                "polygon" => outlines.push(Outline::Polygon(self.rings(value)?)),
                "polyline" => outlines.push(Outline::Polyline(self.corners(value)?)),
                "circle" => {
                    let table = self.table(value)?;
                    let (Some(center), Some(radius), 2) = (table.get("center"), table.get("radius"), table.len())
                    else {
                        return self.error(value, "a circle needs a center and a radius");
                    };
                    outlines.push(Outline::Circle(self.pair(center, |n| self.length(n))?, self.length(radius)?));
                }
                "image" => image = Some(self.text(value)?),
                "unknown" => unknown_is_solid = self.text(value)? != "free",
                "holes" => holes = self.rings(value)?,
                "at" => at = point(&self.pair(value, |n| self.length(n))?),
                "angle" => angle = Interval::enclosing(&self.quantity(value)?),
                "height" => heights = Some(self.heights(value)?),
                "name" => name = Some(self.text(value)?),
                "motion" => motion = Some(value),
                "clearance" if !is_object => stated[0] = Some(self.length(value)?),
                "calibration" if !is_object => stated[1] = Some(self.length_error(value)?),
                // Keys of objects, which are read elsewhere.
                "pallet" | "lift" | "mass" | "payload" | "grasp" | "supports" | "renew" if is_object => {}
                other => {
                    return self.error(value, &format!("the checker does not know the key {other} of an obstacle"));
                }
            }
        }
        // A picture that cannot be read matters only if something uses it.
        let cells = |name: String| Cells::read(self.files, &self.file(&name)?, unknown_is_solid);
        outlines.extend(image.map(|name| Outline::Squares(cells(name).map(|cells| Rc::new(cells) as _))));
        let [outline] =
            <[Outline; 1]>::try_from(outlines).or_else(|_| self.error(value, "an obstacle needs exactly one shape"))?;
        let outline = match outline {
            Outline::Polygon(mut rings) => {
                rings.extend(holes);
                Outline::Polygon(rings)
            }
            other => other,
        };
        let trajectory = motion
            .map(|motion| self.trajectory(motion, &at, &angle))
            .transpose()?
            .map(|trajectory| Rc::new(trajectory) as _);
        let turn = angle.sin_cos();
        Ok(Obstacle { name, at, turn, heights, trajectory, stated, ..Obstacle::new(outline) })
    }

    fn obstacles(&self, list: &Value, world: &mut World) -> ReadResult<()> {
        for (index, value) in self.list(list)?.into_iter().enumerate() {
            let mut obstacle = self.obstacle(value, false)?;
            obstacle.name.get_or_insert_with(|| format!("obstacle {}", index + 1));
            let list = if obstacle.trajectory.is_some() { &mut world.movers } else { &mut world.obstacles };
            list.push(obstacle);
        }
        Ok(())
    }
}

/// Keys of `[start]` and `[goal]` for the values of the tool's joints. A motion with such keys is a task.
const TOOL_KEYS: [&str; 2] = ["stroke", "wrist"];

fn origin() -> Corner {
    [Decimal::whole(0), Decimal::whole(0)]
}

impl WorldFile {
    /// Reads a world file.
    ///
    /// # Errors
    /// If it is not a world file, or contains something unknown that could affect the result.
    pub fn read(text: &str, files: &Files) -> ReadResult<Self> {
        let table = DeTable::parse(text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            CheckError::at(Input::World, text, at, error.message())
        })?;
        let reader = Reader { text, files };
        let mut file = Self::default();
        let world = &mut file.world;
        for (key, value) in table.get_ref() {
            match &**key.get_ref() {
                "robot" => reader.robot(value, &mut file.robot)?,
                "start" => world.start = Some(reader.place(value)?),
                "goal" => world.goal = Some(reader.place(value)?),
                "clearance" => world.clearance = reader.length(value)?,
                "obstacle" => reader.obstacles(value, world)?,
                "name" | "preference" | "sensor" => {}
                // These keys depend on all others, and are read last.
                "map" | "object" | "pallet" | "step" | "task" => {}
                other => return reader.error(value, &format!("the checker does not know the key {other} of a world")),
            }
        }
        let has_steps = table.get_ref().contains_key("step");
        table.get_ref().get("map").map_or(Ok(()), |map| reader.map(map, has_steps, world))?;
        file.task = reader.task(table.get_ref(), world)?;
        Ok(file)
    }
}
