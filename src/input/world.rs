//! The world file: its schema, and the workspace it describes.

use super::error::{Defect, InputError};
use super::occupancy::OccupancyMap;
use super::preference::PreferenceTable;
use super::source::Source;
use super::world_map::{self, MapTable};
use crate::geometry::{Convex, Point, SimplePolygon};
use crate::model::{Heights, Obstacle, Shape, Workspace};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;

pub(super) type Number = Spanned<f64>;
pub(super) type Numbers = Spanned<Vec<Number>>;
/// Values by joint name, with the place of both.
pub(super) type PerJoint<T> = BTreeMap<Spanned<String>, T>;

/// A world file that has been read: the workspace is valid; names of joints and links are not yet checked.
#[derive(Debug, Clone)]
pub struct World {
    /// Obstacles, clearance and title.
    pub workspace: Workspace,
    pub(super) source: Source,
    pub(super) robot: RobotTable,
    pub(super) start: Option<([f64; 2], Range<usize>)>,
    pub(super) goal: Option<(WorldGoal, Range<usize>)>,
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
            },
            source: Source { path: "".into(), text: String::new() },
            robot: RobotTable::default(),
            start: None,
            goal: None,
        }
    }
}

/// The goal as the file has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum WorldGoal {
    Joints([f64; 2]),
    Tip(Point),
}

/// `[robot]`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RobotTable {
    pub joints: Option<Spanned<Vec<Spanned<String>>>>,
    pub tip: Option<Spanned<String>>,
    #[serde(default)]
    pub fixed: PerJoint<Number>,
    #[serde(default)]
    pub limits: PerJoint<Numbers>,
    #[serde(default)]
    pub velocity: PerJoint<Number>,
    #[serde(default)]
    pub acceleration: PerJoint<Number>,
    /// Radius of the capsule that stands in for a link without geometry, metres.
    pub bar: Option<Number>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WorldFile {
    name: Option<String>,
    clearance: Option<Number>,
    #[serde(default)]
    robot: RobotTable,
    start: Option<StartTable>,
    goal: Option<Spanned<GoalTable>>,
    map: Option<MapTable>,
    #[serde(default)]
    obstacle: Vec<Spanned<ObstacleTable>>,
    #[serde(default)]
    preference: Vec<Spanned<PreferenceTable>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StartTable {
    joints: Numbers,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct GoalTable {
    joints: Option<Numbers>,
    tip: Option<Numbers>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ObstacleTable {
    name: Option<String>,
    polygon: Option<Spanned<Vec<Numbers>>>,
    circle: Option<CircleTable>,
    polyline: Option<Spanned<Vec<Numbers>>>,
    image: Option<Spanned<String>>,
    unknown: Option<Spanned<String>>,
    height: Option<Numbers>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CircleTable {
    center: Numbers,
    radius: Number,
}

/// Greatest length or coordinate, metres: beyond it products of coordinates lose the last micrometre, and no arm is
/// that large.
pub(super) const LARGEST: f64 = 1e6;

/// Convex pieces of the largest map: beyond it each planner takes minutes.
pub(super) const MOST_PIECES: usize = 1 << 20;

/// Reads a world file.
///
/// # Errors
/// On malformed TOML, unknown keys and invalid values, with line, column and a caret.
pub(super) fn read(path: &Path) -> Result<World, InputError> {
    let source = Source::read(path)?;
    if source.text.trim_start().starts_with('<') {
        let defect = source.defect("this is XML, not a world file (TOML)");
        return Err(defect.cure("give the URDF first and the world file second").into());
    }
    let file: WorldFile = toml::from_str(&source.text).map_err(|error| match error.span() {
        Some(span) => source.defect_at(span, in_toml_words(error.message())),
        None => source.defect(in_toml_words(error.message())),
    })?;
    let reader = Reader { source: &source };
    let clearance = file.clearance.as_ref().map(|c| reader.not_negative(c, "clearance")).transpose()?.unwrap_or(0.0);
    let start = file.start.as_ref().map(|s| reader.two(&s.joints, "start joints")).transpose()?;
    let goal = file.goal.as_ref().map(|g| reader.goal(g)).transpose()?;
    let mut obstacles =
        file.obstacle.iter().enumerate().map(|(i, o)| reader.obstacle(i, o)).collect::<Result<Vec<_>, InputError>>()?;
    let map = file.map.as_ref().map(|m| world_map::read(&reader, m)).transpose()?.unwrap_or_default();
    obstacles.extend(map.obstacles);
    let preferences = file.preference.iter().enumerate().map(|(i, p)| PreferenceTable::read(&reader, i, p));
    let mut preferences = preferences.collect::<Result<Vec<_>, _>>()?;
    preferences.extend(map.preferences);
    let stem = path.file_stem().map_or_else(|| "world".to_owned(), |s| s.to_string_lossy().into_owned());
    Ok(World {
        workspace: Workspace { name: file.name.unwrap_or(stem), obstacles, clearance, preferences },
        start: start.zip(file.start.map(|s| s.joints.span())),
        goal: goal.or(map.goal.map(|(tip, at)| (WorldGoal::Tip(tip), at))),
        robot: file.robot,
        source,
    })
}

/// The deserialiser's message without Rust's words for what TOML calls keys and numbers.
fn in_toml_words(message: &str) -> String {
    message
        .replace("unknown field", "unknown key")
        .replace("missing field", "missing key")
        .replace("expected f64", "expected a number")
}

/// Checks values and knows the file they come from.
pub(super) struct Reader<'a> {
    pub source: &'a Source,
}

impl Reader<'_> {
    pub fn finite(&self, number: &Number, what: &str) -> Result<f64, Defect> {
        let value = *number.get_ref();
        if !value.is_finite() {
            return Err(self.source.defect_at(number.span(), format!("{what}: {value} is not a finite number")));
        }
        if value.abs() > LARGEST {
            let message = format!("{what}: {value} is too large (at most {LARGEST:e})");
            return Err(self.source.defect_at(number.span(), message).cure("lengths are in metres, angles in radians"));
        }
        Ok(value)
    }

    fn not_negative(&self, number: &Number, what: &str) -> Result<f64, Defect> {
        let value = self.finite(number, what)?;
        if value < 0.0 {
            let message = format!("{what} must not be negative, is {value}");
            return Err(self.source.defect_at(number.span(), message));
        }
        Ok(value)
    }

    pub fn two(&self, numbers: &Numbers, what: &str) -> Result<[f64; 2], Defect> {
        match numbers.get_ref().as_slice() {
            [a, b] => Ok([self.finite(a, what)?, self.finite(b, what)?]),
            other => {
                let message = format!("{what}: expected two numbers, found {}", other.len());
                Err(self.source.defect_at(numbers.span(), message))
            }
        }
    }

    pub fn point(&self, numbers: &Numbers, what: &str) -> Result<Point, Defect> {
        self.two(numbers, what).map(Point::from)
    }

    fn goal(&self, goal: &Spanned<GoalTable>) -> Result<(WorldGoal, Range<usize>), Defect> {
        match (&goal.get_ref().joints, &goal.get_ref().tip) {
            (Some(joints), None) => Ok((WorldGoal::Joints(self.two(joints, "goal joints")?), joints.span())),
            (None, Some(tip)) => Ok((WorldGoal::Tip(self.point(tip, "goal tip")?), tip.span())),
            (joints, _) => {
                let found = if joints.is_some() { "both" } else { "neither" };
                let message = format!("the goal needs either `joints` or `tip`, it has {found}");
                Err(self.source.defect_at(goal.span(), message).cure("joints = [q1, q2], or tip = [x, y]"))
            }
        }
    }

    /// The path of a file that the world names, relative to itself.
    pub fn beside(&self, name: &Spanned<String>, what: &str) -> Result<PathBuf, Defect> {
        let path = self.source.path.with_file_name(name.get_ref());
        if path.is_file() {
            return Ok(path);
        }
        let message = format!("{what}: there is no file {}", path.display());
        Err(self.source.defect_at(name.span(), message).cure("paths are relative to the world file"))
    }

    /// Heights, all if there are none.
    pub fn heights(&self, height: Option<&Numbers>, what: &str) -> Result<Heights, Defect> {
        let Some(height) = height else { return Ok(Heights::ALL) };
        let [lower, upper] = self.two(height, &format!("{what}, height"))?;
        if lower > upper {
            let message = format!("{what}: height [{lower}, {upper}] is empty");
            return Err(self.source.defect_at(height.span(), message).cure("write the lower end first"));
        }
        Ok(Heights { lower, upper })
    }

    fn obstacle(&self, index: usize, table: &Spanned<ObstacleTable>) -> Result<Obstacle, InputError> {
        let obstacle = table.get_ref();
        let name = obstacle.name.clone().unwrap_or_else(|| format!("obstacle {}", index + 1));
        let what = format!("obstacle \"{name}\"");
        let (shape, pieces) = match (&obstacle.polygon, &obstacle.circle, &obstacle.polyline, &obstacle.image) {
            (Some(corners), None, None, None) => self.polygon(corners, &what)?,
            (None, Some(circle), None, None) => self.circle(circle, &what)?,
            (None, None, Some(points), None) => self.polyline(points, &what)?,
            (None, None, None, Some(image)) => self.image(image, obstacle.unknown.as_ref(), &what)?,
            (polygon, circle, polyline, image) => {
                let given = [polygon.is_some(), circle.is_some(), polyline.is_some(), image.is_some()];
                let count = given.iter().filter(|x| **x).count();
                let message = format!("{what} needs exactly one shape, it has {count}");
                let cure =
                    "give it one of polygon, circle, polyline, image; a second shape is an [[obstacle]] of its own";
                return Err(self.source.defect_at(table.span(), message).cure(cure).into());
            }
        };
        if let (Some(unknown), None) = (&obstacle.unknown, &obstacle.image) {
            let message = format!("{what}: only an image has unknown cells");
            return Err(self.source.defect_at(unknown.span(), message).cure("remove the key").into());
        }
        let heights = self.heights(obstacle.height.as_ref(), &what)?;
        Ok(Obstacle { name, shape, pieces, heights })
    }

    fn image(
        &self,
        image: &Spanned<String>,
        unknown: Option<&Spanned<String>>,
        what: &str,
    ) -> Result<(Shape, Vec<Convex>), InputError> {
        let unknown_is_free = match unknown.map(|u| (u.get_ref().as_str(), u.span())) {
            None | Some(("solid", _)) => false,
            Some(("free", _)) => true,
            Some((other, at)) => {
                let message = format!("{what}: unknown cells are \"solid\" or \"free\", not \"{other}\"");
                return Err(self.source.defect_at(at, message).into());
            }
        };
        let path = self.beside(image, what)?;
        if path.extension().is_some_and(|e| e != "yaml" && e != "yml") {
            let message = format!("{what}: an image needs the YAML of ROS's map server, which says how large it is");
            let cure = "name the YAML; it names the picture";
            return Err(self.source.defect_at(image.span(), message).cure(cure).into());
        }
        let pieces = OccupancyMap::read(&path)?.pieces(unknown_is_free);
        if pieces.len() > MOST_PIECES {
            let message = format!("{what}: {} rectangles are too many (at most {MOST_PIECES})", pieces.len());
            let cure = "remove single pixels from the picture, or make its pixels larger";
            return Err(self.source.defect_at(image.span(), message).cure(cure).into());
        }
        Ok((Shape::Pieces, pieces))
    }

    fn polygon(&self, corners: &Spanned<Vec<Numbers>>, what: &str) -> Result<(Shape, Vec<Convex>), Defect> {
        let points = self.points(corners, what)?;
        let polygon = SimplePolygon::new(points).map_err(|defect| {
            self.source
                .defect_at(corners.span(), format!("{what} is not a simple polygon: {defect}"))
                .cure("list the corners in order round the shape, each once; a wall without area is a polyline")
        })?;
        Ok((Shape::Polygon(polygon.corners().to_vec()), polygon.convex_pieces()))
    }

    fn circle(&self, circle: &CircleTable, what: &str) -> Result<(Shape, Vec<Convex>), Defect> {
        let center = self.point(&circle.center, &format!("{what}, center"))?;
        let radius = self.finite(&circle.radius, &format!("{what}, radius"))?;
        if radius <= 0.0 {
            let message = format!("{what}: the radius must be positive, is {radius}");
            return Err(self.source.defect_at(circle.radius.span(), message));
        }
        Ok((Shape::Circle { center, radius }, vec![Convex::disc(center, radius)]))
    }

    fn polyline(&self, points: &Spanned<Vec<Numbers>>, what: &str) -> Result<(Shape, Vec<Convex>), Defect> {
        let corners = self.points(points, what)?;
        if corners.len() < 2 {
            let message = format!("{what}: a polyline needs at least two points, it has {}", corners.len());
            return Err(self.source.defect_at(points.span(), message));
        }
        if let Some(i) = corners.windows(2).position(|w| w[0] == w[1]) {
            let message = format!("{what}: points {} and {} of the polyline are the same", i + 1, i + 2);
            return Err(self.source.defect_at(points.get_ref()[i + 1].span(), message).cure("leave one of them out"));
        }
        let pieces = corners.windows(2).map(|w| Convex::segment(w[0], w[1])).collect();
        Ok((Shape::Polyline(corners), pieces))
    }

    pub fn points(&self, points: &Spanned<Vec<Numbers>>, what: &str) -> Result<Vec<Point>, Defect> {
        let name = |i: usize| format!("{what}, point {}", i + 1);
        points.get_ref().iter().enumerate().map(|(i, p)| self.point(p, &name(i))).collect()
    }
}
