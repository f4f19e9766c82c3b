//! The world file's `[[object]]`.

use super::obstacle::{CircleTable, circle};
use super::obstacle_trajectory::ObstacleTrajectoryTable;
use super::pallet::{Pallet, Pallets};
use super::polygon::{Ring, polygon};
use super::reader::Reader;
#[cfg(test)]
use super::schema::*;
use cplan_geometry::{Point, Pose};
use cplan_handling::{Holding, MovingObstacle, Object, ObstacleTrajectory};
use cplan_model::{Obstacle, RESTING_TOLERANCE};
use cplan_robot::{Diagnostic, Length, Lengths, Number, Spanned, Written, quoted, toml_table};
use cplan_text::{length, short};
use std::collections::BTreeMap;
use std::ops::Range;

toml_table! {
    /// An object that can be picked and placed. Except while it is carried, it is an obstacle.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "object", extend("allOf" = [
        { "oneOf": [{ "required": ["polygon"] }, { "required": ["circle"] }] },
        { "oneOf": [{ "required": ["at"] }, { "required": ["pallet"] }] }
    ])))]
    pub(super) struct ObjectTable {
        /// Unique name among objects and obstacles. For objects on a pallet it is the part before row and column: "NAME
        /// 2,3".
        name: Spanned<String>,
        /// Corners of the outline in its own frame, in order, m. The outline may be non-convex and touch itself in
        /// points, but must not cross itself. Or a list of such outlines: the outer one, then those of holes.
        #[cfg_attr(test, schemars(with = "Option<Rings>"))]
        polygon: Option<Ring>,
        /// A disc, in the object's own frame.
        circle: Option<CircleTable>,
        /// Initial position of its origin, m.
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        at: Option<Lengths>,
        /// Instead of `at`: a pallet. Initially, there is one such object on each place of the pallet.
        pallet: Option<Spanned<String>>,
        /// Initial angle, rad, relative to the pallet if there is one; by default 0.
        angle: Option<Written>,
        /// Its extent along the plane's normal at its initial place, m; by default all heights.
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        height: Option<Lengths>,
        /// Height by which it is raised while it is carried, m; by default 0.
        #[cfg_attr(test, schemars(with = "Option<NotNegativeLength>"))]
        lift: Option<Length>,
        /// Its mass, kg, distributed evenly over its outline; by default 0. Used for torques.
        #[cfg_attr(test, schemars(with = "Option<NotNegative>"))]
        mass: Option<Number>,
        /// "rigid": the object turns with link 2. "level": a wrist keeps its orientation. By default the `payload` of
        /// [robot].
        #[cfg_attr(test, schemars(with = "Option<HeldAs>"))]
        payload: Option<Spanned<String>>,
        /// Point of the object to which the tip moves, in the object's own frame, m; by default its origin.
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        grasp: Option<Lengths>,
        /// Obstacles and objects that it may touch where it is picked and placed.
        supports: Option<NameList>,
        /// True if each repetition of its pick finds a new object at the initial place. The old one disappears when the
        /// arm moves on.
        #[cfg_attr(test, schemars(default))]
        renew: bool,
        /// Its motion from `at`, until it is picked; by default it is static.
        motion: Option<Spanned<ObstacleTrajectoryTable>>,
    }
}

/// A list of names, each with its position in the file.
pub(super) type NameList = Spanned<Vec<Spanned<String>>>;

/// An object, with the defaults of the steps that handle it.
#[derive(Debug, Clone)]
pub(super) struct MovableObject {
    pub object: Object,
    /// Point of the object, in its own frame, to which the tip moves.
    pub grasp: Point,
    pub supports: Supports,
    /// True if each repetition of the steps finds a new object at the initial place.
    pub is_renewed: bool,
}

/// The obstacles and objects that an object may touch where it rests.
#[derive(Debug, Clone)]
pub(super) struct Supports {
    pub numbers: Vec<usize>,
    pub at: Range<usize>,
}

/// Numbers of objects and obstacles by name.
pub(super) struct Names<'a> {
    objects: BTreeMap<String, usize>,
    /// Indices of the objects on each pallet, by their common name.
    families: BTreeMap<&'a str, Range<usize>>,
    /// Numbers of obstacles by name. Several obstacles may share a name.
    obstacles: BTreeMap<&'a str, Vec<usize>>,
    /// Number of static obstacles.
    fixed: usize,
}

/// Largest number of names that a message lists.
const MAX_LISTED_NAMES: usize = 12;

impl<'a> Names<'a> {
    /// Collects the names of objects and obstacles, by which steps refer to them.
    ///
    /// # Errors
    /// Two objects with the same name, or an object with the name of an obstacle.
    fn of(
        reader: &Reader,
        placed: &[PlacedObject<'a>],
        obstacles: &'a [Obstacle],
        movers: &[MovingObstacle],
    ) -> Result<Self, Diagnostic> {
        let mut names = Self {
            objects: BTreeMap::new(),
            families: BTreeMap::new(),
            obstacles: BTreeMap::new(),
            fixed: obstacles.len(),
        };
        for (number, obstacle) in obstacles.iter().enumerate() {
            names.obstacles.entry(obstacle.name.as_str()).or_default().push(number);
        }
        for (number, PlacedObject { table, name, .. }) in placed.iter().enumerate() {
            let given = &table.get_ref().name;
            let family = given.get_ref().as_str();
            let is_mover = |name: &str| movers.iter().any(|mover| mover.obstacle.name == name);
            let is_obstacle =
                [name.as_str(), family].iter().any(|name| names.obstacles.contains_key(name) || is_mover(name));
            let mut is_object = names.objects.insert(name.clone(), number).is_some();
            if name == family {
                is_object |= names.families.contains_key(family);
            } else {
                is_object |= names.objects.contains_key(family);
                let members = names.families.entry(family).or_insert(number..number);
                is_object |= members.end != number;
                members.end = number + 1;
            }
            if is_obstacle || is_object {
                let other = if is_object { "a second object" } else { "an obstacle" };
                let message = format!("{other} is named \"{}\"", if is_object { name.as_str() } else { family });
                let help = "steps refer to objects by name: give each a unique name";
                return Err(reader.source.diagnostic_at(given.span(), message).help(help));
            }
        }
        Ok(names)
    }

    /// Returns the index of an object.
    ///
    /// # Errors
    /// An unknown name.
    pub fn object(&self, reader: &Reader, name: &Spanned<String>) -> Result<usize, Diagnostic> {
        let wanted = name.get_ref().as_str();
        if let Some(number) = self.objects.get(wanted) {
            return Ok(*number);
        }
        let message = format!("there is no object \"{wanted}\"");
        let help = match (self.obstacles.contains_key(wanted), self.families.get(wanted)) {
            (true, _) => {
                format!(
                    "\"{wanted}\" is an obstacle, and steps move only objects: write [[object]] instead of [[obstacle]]"
                )
            }
            (_, Some(all)) => format!(
                "{} of this name are on a pallet: name one of them, such as \"{wanted} 1,1\", or move all: transfer = {{ objects = \"{wanted}\", to = \"PALLET\" }}",
                all.len()
            ),
            _ => format!("the objects are {}", self.all()),
        };
        Err(reader.source.diagnostic_at(name.span(), message).help(help))
    }

    /// Returns the indices of all objects on a pallet, whose common name this is, row by row.
    ///
    /// # Errors
    /// An unknown name.
    pub fn family(&self, reader: &Reader, name: &Spanned<String>) -> Result<Range<usize>, Diagnostic> {
        let wanted = name.get_ref().as_str();
        if let Some(family) = self.families.get(wanted) {
            return Ok(family.clone());
        }
        let message = format!("there are no objects \"{wanted}\" on a pallet");
        let help = match self.objects.contains_key(wanted) {
            true => format!("\"{wanted}\" is a single object: write pick = \"{wanted}\", and a place after it"),
            false if self.families.is_empty() => "give an [[object]] of this name pallet = \"PALLET\"".into(),
            false => format!("the objects on pallets are {}", join_names(self.families.keys().copied())),
        };
        Err(reader.source.diagnostic_at(name.span(), message).help(help))
    }

    /// Returns the available names. Objects on a pallet appear once, under their common name.
    fn all(&self) -> String {
        let single = self.objects.iter().filter(|(_, number)| !self.families.values().any(|all| all.contains(number)));
        join_names(single.map(|(name, _)| name.as_str()).chain(self.families.keys().copied()))
    }

    /// Returns the obstacles and objects in a list of supports, by their numbers as obstacles.
    ///
    /// # Errors
    /// An unknown name.
    pub fn supports(&self, reader: &Reader, list: &NameList) -> Result<Supports, Diagnostic> {
        let mut numbers = Vec::new();
        for name in list.get_ref() {
            let wanted = name.get_ref().as_str();
            match (self.obstacles.get(wanted), self.objects.get(wanted), self.families.get(wanted)) {
                (Some(found), _, _) => numbers.extend(found),
                (None, Some(object), _) => numbers.push(self.fixed + object),
                (None, None, Some(all)) => numbers.extend(all.clone().map(|object| self.fixed + object)),
                (None, None, None) => {
                    let message = format!("there is no obstacle and no object \"{wanted}\" to rest on");
                    let names = self.obstacles.keys().copied().chain(self.objects.keys().map(String::as_str));
                    let help = format!("there are {}", join_names(names));
                    return Err(reader.source.diagnostic_at(name.span(), message).help(help));
                }
            }
        }
        numbers.sort_unstable();
        numbers.dedup();
        Ok(Supports { numbers, at: list.span() })
    }

    /// Returns the number of an object as an obstacle.
    pub fn as_obstacle(&self, object: usize) -> usize {
        self.fixed + object
    }
}

/// The object of a table, or one of its objects on a pallet.
struct PlacedObject<'a> {
    table: &'a Spanned<ObjectTable>,
    name: String,
    /// Its initial pose.
    at: Pose,
}

/// Returns all objects with their initial poses. Those on a pallet are listed row by row.
fn placed<'a>(
    reader: &Reader,
    tables: &'a [Spanned<ObjectTable>],
    pallets: &Pallets,
) -> Result<Vec<PlacedObject<'a>>, Diagnostic> {
    let mut all = Vec::new();
    for table in tables {
        let given = table.get_ref();
        let name = given.name.get_ref();
        let what = format!("object \"{name}\"");
        let angle =
            given.angle.as_ref().map(|a| reader.quantity(a, &format!("{what}, angle"))).transpose()?.unwrap_or(0.0);
        let turned = Pose::rotation(angle);
        match (&given.at, &given.pallet) {
            (Some(at), None) => {
                let at = reader.point(at, &format!("{what}, at"))?;
                all.push(PlacedObject { table, name: name.clone(), at: turned.shifted(at) });
            }
            (None, Some(pallet)) => {
                let on = pallets.named(reader, pallet)?;
                require_height(reader, given, on, &what)?;
                let places = on.places();
                all.extend(places.map(|(place, pose)| PlacedObject {
                    table,
                    name: format!("{name} {place}"),
                    at: pose * turned,
                }));
            }
            (at, _) => {
                let found = if at.is_some() { "both" } else { "neither" };
                let message = format!("{what} needs either `at` or `pallet`, but has {found}");
                let help = "at = [x, y] for one object, or pallet = \"NAME\" for an object on each place of the pallet";
                return Err(reader.source.diagnostic_at(table.span(), message).help(help));
            }
        }
    }
    Ok(all)
}

/// Checks that the lower ends of the objects are at the height of their pallet, if both heights are stated.
fn require_height(reader: &Reader, given: &ObjectTable, pallet: &Pallet, what: &str) -> Result<(), Diagnostic> {
    let Some((numbers, height)) = given.height.as_ref().zip(pallet.height) else { return Ok(()) };
    let [lower, upper] = reader.number_pair(numbers, &format!("{what}: height"))?;
    // Another check refuses heights in the wrong order.
    if (lower - height).abs() <= RESTING_TOLERANCE || upper <= lower {
        return Ok(());
    }
    let message =
        format!("{what} begins at a height of {}, but the height of its pallet is {}", length(lower), length(height));
    let help = format!("height = [{}, {}], or the height of the pallet", short(height), short(height + upper - lower));
    Err(reader.source.diagnostic_at(numbers.span(), message).help(help))
}

/// Reads all objects. `default` is how the gripper holds an object, unless its table states it.
///
/// # Errors
/// Names that are not unique; a table without exactly one shape, or without exactly one of position and pallet; invalid shapes
/// and values; unknown pallets and supports.
pub(super) fn read<'a>(
    reader: &Reader,
    tables: &'a [Spanned<ObjectTable>],
    pallets: &Pallets,
    obstacles: &'a [Obstacle],
    movers: &[MovingObstacle],
    default: Holding,
) -> Result<(Vec<MovableObject>, Names<'a>), Diagnostic> {
    let placed = placed(reader, tables, pallets)?;
    let names = Names::of(reader, &placed, obstacles, movers)?;
    let objects = placed.into_iter().enumerate().map(|(i, placed)| movable(reader, placed, i, &names, default));
    Ok((objects.collect::<Result<_, _>>()?, names))
}

fn movable(
    reader: &Reader,
    PlacedObject { table, name, at }: PlacedObject,
    index: usize,
    names: &Names,
    default: Holding,
) -> Result<MovableObject, Diagnostic> {
    let given = table.get_ref();
    let what = format!("object \"{name}\"");
    let (shape, pieces) = match (&given.polygon, &given.circle) {
        (Some(corners), None) => {
            polygon(reader, corners, None, None, &what, "list the corners in order round the shape, each once")?
        }
        (None, Some(disc)) => circle(reader, disc, &what)?,
        (polygon, _) => {
            let count = if polygon.is_some() { 2 } else { 0 };
            let message = format!("{what} needs exactly one shape, but has {count}");
            return Err(reader.source.diagnostic_at(table.span(), message).help("give it a polygon or a circle"));
        }
    };
    let lift = given.lift.as_ref().map(|l| reader.not_negative(l, &format!("{what}: lift"))).transpose()?;
    let mass = given.mass.as_ref().map(|m| reader.not_negative(m, &format!("{what}: mass"))).transpose()?;
    let grasp = given.grasp.as_ref().map(|g| reader.point(g, &format!("{what}, grasp"))).transpose()?;
    let supports = match &given.supports {
        Some(list) => names.supports(reader, list)?,
        None => Supports { numbers: Vec::new(), at: table.span() },
    };
    if supports.numbers.contains(&names.as_obstacle(index)) {
        return Err(rests_on_itself(reader, &name, &supports));
    }
    let trajectory =
        given.motion.as_ref().map(|motion| read_object_trajectory(reader, given, motion, &at, &what)).transpose()?;
    // The motion determines the initial position.
    let at = trajectory.as_ref().map_or(at, |trajectory| trajectory.pose(0.0));
    let object = Object {
        name,
        shape,
        pieces,
        heights: reader.heights(given.height.as_ref(), &what)?,
        lift: lift.unwrap_or(0.0),
        holding: given.payload.as_ref().map(|p| parse_holding(reader, p)).transpose()?.unwrap_or(default),
        at,
        mass: mass.unwrap_or(0.0),
        trajectory,
        presence: None,
    };
    Ok(MovableObject { object, grasp: grasp.unwrap_or_else(Point::zeros), supports, is_renewed: given.renew })
}

/// Reads the motion of an object. Stops without a position get the object's position.
fn read_object_trajectory(
    reader: &Reader,
    given: &ObjectTable,
    motion: &Spanned<ObstacleTrajectoryTable>,
    at: &Pose,
    what: &str,
) -> Result<ObstacleTrajectory, Diagnostic> {
    let refuse = |message: &str, help: &str| {
        Err(reader.source.diagnostic_at(motion.span(), format!("{what}, motion: {message}")).help(help))
    };
    if given.pallet.is_some() {
        return refuse(
            "objects on a pallet cannot move",
            "write each moving object as an [[object]] of its own, with `at`",
        );
    }
    if given.renew {
        return refuse("a moving object cannot be renewed", "write a separate [[object]] for each one that arrives");
    }
    motion.get_ref().read(reader, what, Some(at), motion.span())
}

/// Returns the diagnostic about an object that lists itself as a support.
pub(super) fn rests_on_itself(reader: &Reader, name: &str, supports: &Supports) -> Diagnostic {
    let message = format!("object \"{name}\" cannot rest on itself");
    reader.source.diagnostic_at(supports.at.clone(), message).help("remove it from `supports`")
}

/// Parses how the gripper holds objects: `"rigid"` or `"level"`.
pub(super) fn parse_holding(reader: &Reader, word: &Spanned<String>) -> Result<Holding, Diagnostic> {
    match word.get_ref().as_str() {
        "rigid" => Ok(Holding::Rigid),
        "level" => Ok(Holding::Level),
        other => {
            let message = format!("a payload is \"rigid\" or \"level\", not \"{other}\"");
            let help = "rigid: the object turns with link 2; level: a wrist keeps its orientation";
            Err(reader.source.diagnostic_at(word.span(), message).help(help))
        }
    }
}

fn join_names<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let mut names: Vec<&str> = names.take(MAX_LISTED_NAMES + 1).collect();
    let more = names.len() > MAX_LISTED_NAMES;
    names.truncate(MAX_LISTED_NAMES);
    quoted(names) + if more { ", ..." } else { "" }
}
