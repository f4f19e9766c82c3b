//! The world file's `[[object]]`.

use super::error::{Defect, quoted};
use super::obstacle::{CircleTable, circle};
use super::polygon::{Ring, polygon};
use super::quantity::Written;
use super::schema::{AngleOrLength, HeldAs, NotNegative, Rings, Two};
use super::world::{Number, Numbers, Reader};
use crate::geometry::{Point, Pose};
use crate::model::{Holding, Object, Obstacle};
use nalgebra::{Isometry2, Translation2};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;

/// Something that can be picked and placed; an obstacle wherever it lies.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "object", extend("oneOf" = [{ "required": ["polygon"] }, { "required": ["circle"] }]))]
pub(super) struct ObjectTable {
    /// A name that no other object or obstacle has.
    #[schemars(with = "String")]
    name: Spanned<String>,
    /// Corners in its own frame, in order round the shape, m; may be non-convex and touch itself in points, but not cross
    /// itself. Or a list of such rings: the outer one, then holes.
    #[schemars(with = "Option<Rings>")]
    polygon: Option<Ring>,
    /// A disc in its own frame.
    circle: Option<CircleTable>,
    /// Where its origin lies at first, m.
    #[schemars(with = "Two")]
    at: Numbers,
    /// How it is turned at first, rad; by default 0.
    #[schemars(with = "Option<AngleOrLength>")]
    angle: Option<Written>,
    /// Its extent along the plane's normal where it lies, m; by default all heights.
    #[schemars(with = "Option<Two>")]
    height: Option<Numbers>,
    /// By how much it is raised while it is carried, m; by default 0.
    #[schemars(with = "Option<NotNegative>")]
    lift: Option<Number>,
    /// How it is held; by default as [robot] says.
    #[schemars(with = "Option<HeldAs>")]
    payload: Option<Spanned<String>>,
    /// The point of it that the tip goes to, in its own frame, m; by default its origin.
    #[schemars(with = "Option<Two>")]
    grasp: Option<Numbers>,
    /// Obstacles and objects that it may touch where it is picked and placed.
    #[schemars(with = "Option<Vec<String>>")]
    supports: Option<NameList>,
    /// Whether each repetition of the steps that pick it finds a new one where it lay at first.
    #[serde(default)]
    renew: bool,
}

/// Names, with the place of each.
pub(super) type NameList = Spanned<Vec<Spanned<String>>>;

/// An object, and what holds for the steps that do not say otherwise.
#[derive(Debug, Clone)]
pub(super) struct Movable {
    pub object: Object,
    /// The point of it that the tip goes to, in its own frame.
    pub grasp: Point,
    pub supports: Supports,
    /// Whether a new one lies there in each repetition.
    pub is_renewed: bool,
}

/// What an object may touch where it rests.
#[derive(Debug, Clone)]
pub(super) struct Supports {
    /// Obstacles; objects follow the obstacles that stay where they are.
    pub numbers: Vec<usize>,
    /// Where they are named.
    pub at: Range<usize>,
}

/// Numbers of objects and obstacles by name.
pub(super) struct Names<'a> {
    objects: BTreeMap<&'a str, usize>,
    /// Obstacles may share a name.
    obstacles: BTreeMap<&'a str, Vec<usize>>,
    /// How many obstacles stay where they are.
    fixed: usize,
}

/// More names than this are not listed in a message.
const LISTED: usize = 12;

impl<'a> Names<'a> {
    /// # Errors
    /// When two objects, or an object and an obstacle, have the same name.
    fn of(reader: &Reader, tables: &'a [Spanned<ObjectTable>], obstacles: &'a [Obstacle]) -> Result<Self, Defect> {
        let mut names = Self { objects: BTreeMap::new(), obstacles: BTreeMap::new(), fixed: obstacles.len() };
        for (number, obstacle) in obstacles.iter().enumerate() {
            names.obstacles.entry(obstacle.name.as_str()).or_default().push(number);
        }
        for (number, table) in tables.iter().enumerate() {
            let name = &table.get_ref().name;
            let is_obstacle = names.obstacles.contains_key(name.get_ref().as_str());
            let is_object = names.objects.insert(name.get_ref(), number).is_some();
            if is_obstacle || is_object {
                let other = if is_object { "a second object" } else { "an obstacle" };
                let message = format!("{other} is named \"{}\"", name.get_ref());
                let cure = "steps refer to objects by name: give each a name of its own";
                return Err(reader.source.defect_at(name.span(), message).cure(cure));
            }
        }
        Ok(names)
    }

    /// The object of this name.
    ///
    /// # Errors
    /// When there is none.
    pub fn object(&self, reader: &Reader, name: &Spanned<String>) -> Result<usize, Defect> {
        let wanted = name.get_ref().as_str();
        if let Some(number) = self.objects.get(wanted) {
            return Ok(*number);
        }
        let message = format!("there is no object \"{wanted}\"");
        let cure = match self.obstacles.contains_key(wanted) {
            true => "that is an obstacle, which stays where it is: make it an [[object]]".to_owned(),
            false => format!("the objects are {}", listed(self.objects.keys())),
        };
        Err(reader.source.defect_at(name.span(), message).cure(cure))
    }

    /// The numbers of these obstacles and objects, for something that rests on them.
    ///
    /// # Errors
    /// When there is none of such a name.
    pub fn supports(&self, reader: &Reader, list: &NameList) -> Result<Supports, Defect> {
        let mut numbers = Vec::new();
        for name in list.get_ref() {
            let wanted = name.get_ref().as_str();
            match (self.obstacles.get(wanted), self.objects.get(wanted)) {
                (Some(found), _) => numbers.extend(found),
                (None, Some(object)) => numbers.push(self.fixed + object),
                (None, None) => {
                    let message = format!("there is no obstacle and no object \"{wanted}\" to rest on");
                    let cure = format!("there are {}", listed(self.obstacles.keys().chain(self.objects.keys())));
                    return Err(reader.source.defect_at(name.span(), message).cure(cure));
                }
            }
        }
        numbers.sort_unstable();
        numbers.dedup();
        Ok(Supports { numbers, at: list.span() })
    }

    /// The number under which an object counts as an obstacle.
    pub fn as_obstacle(&self, object: usize) -> usize {
        self.fixed + object
    }
}

/// Reads all objects. `default` is how they are held where they do not say it.
///
/// # Errors
/// On names that are not unique, not exactly one shape, shapes that are none, values that are none, unknown supports.
pub(super) fn read<'a>(
    reader: &Reader,
    tables: &'a [Spanned<ObjectTable>],
    obstacles: &'a [Obstacle],
    default: Holding,
) -> Result<(Vec<Movable>, Names<'a>), Defect> {
    let names = Names::of(reader, tables, obstacles)?;
    let objects = tables.iter().enumerate().map(|(i, table)| movable(reader, table, i, &names, default));
    Ok((objects.collect::<Result<_, _>>()?, names))
}

fn movable(
    reader: &Reader,
    table: &Spanned<ObjectTable>,
    index: usize,
    names: &Names,
    default: Holding,
) -> Result<Movable, Defect> {
    let given = table.get_ref();
    let name = given.name.get_ref().clone();
    let what = format!("object \"{name}\"");
    let (shape, pieces) = match (&given.polygon, &given.circle) {
        (Some(corners), None) => {
            polygon(reader, corners, None, &what, "list the corners in order round the shape, each once")?
        }
        (None, Some(disc)) => circle(reader, disc, &what)?,
        (polygon, _) => {
            let count = if polygon.is_some() { 2 } else { 0 };
            let message = format!("{what} needs exactly one shape, it has {count}");
            return Err(reader.source.defect_at(table.span(), message).cure("give it a polygon or a circle"));
        }
    };
    let at = reader.point(&given.at, &format!("{what}, at"))?;
    let angle = given.angle.as_ref().map(|a| reader.quantity(a, &format!("{what}, angle"))).transpose()?.unwrap_or(0.0);
    let lift = given.lift.as_ref().map(|l| reader.not_negative(l, &format!("{what}: lift"))).transpose()?;
    let grasp = given.grasp.as_ref().map(|g| reader.point(g, &format!("{what}, grasp"))).transpose()?;
    let supports = match &given.supports {
        Some(list) => names.supports(reader, list)?,
        None => Supports { numbers: Vec::new(), at: table.span() },
    };
    if supports.numbers.contains(&names.as_obstacle(index)) {
        return Err(rests_on_itself(reader, &name, &supports));
    }
    let object = Object {
        name,
        shape,
        pieces,
        heights: reader.heights(given.height.as_ref(), &what)?,
        lift: lift.unwrap_or(0.0),
        holding: given.payload.as_ref().map(|p| holding(reader, p)).transpose()?.unwrap_or(default),
        at: placed(at, angle),
    };
    Ok(Movable { object, grasp: grasp.unwrap_or_else(Point::origin), supports, is_renewed: given.renew })
}

/// The defect of an object that is among its own supports.
pub(super) fn rests_on_itself(reader: &Reader, name: &str, supports: &Supports) -> Defect {
    let message = format!("object \"{name}\" cannot rest on itself");
    reader.source.defect_at(supports.at.clone(), message).cure("remove it from `supports`")
}

/// How objects are held: `"rigid"` or `"level"`.
pub(super) fn holding(reader: &Reader, word: &Spanned<String>) -> Result<Holding, Defect> {
    match word.get_ref().as_str() {
        "rigid" => Ok(Holding::Rigid),
        "level" => Ok(Holding::Level),
        other => {
            let message = format!("a payload is \"rigid\" or \"level\", not \"{other}\"");
            let cure = "rigid: it turns with link 2; level: a wrist keeps its orientation";
            Err(reader.source.defect_at(word.span(), message).cure(cure))
        }
    }
}

/// The pose of a frame with this origin and orientation.
fn placed(at: Point, angle: f64) -> Pose {
    Translation2::from(at.coords) * Isometry2::rotation(angle)
}

fn listed<'a>(names: impl Iterator<Item = &'a &'a str>) -> String {
    let mut names: Vec<&str> = names.copied().take(LISTED + 1).collect();
    let more = names.len() > LISTED;
    names.truncate(LISTED);
    quoted(names) + if more { ", ..." } else { "" }
}
