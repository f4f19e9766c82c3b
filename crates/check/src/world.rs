//! The world file: obstacles, what is asked, and what goes over the URDF.

use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::interval::{Interval, Point, sum, turned};
use crate::overlap::Shape;
use crate::polygon::{self, Corner};
use crate::sweep::Range;
use num_bigint::Sign;
use std::collections::BTreeMap;
use task::Task;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

mod hung;
mod sides;
pub mod task;

type Value<'a> = Spanned<DeValue<'a>>;

/// What the checker knows of a world. Enclosures of what is in degrees, else the numbers themselves.
pub struct World {
    /// Where the root frame of the robot stands, and how it is turned.
    pub at: Corner,
    pub angle: Interval,
    /// The names of the two joints, if it says them.
    pub joints: Option<Vec<String>>,
    /// Values of other joints, by name.
    pub fixed: BTreeMap<String, Range>,
    /// Enclosures of the least and the greatest value of joints, by name.
    pub limits: BTreeMap<String, [Range; 2]>,
    pub start: Option<Goal>,
    pub goal: Option<Goal>,
    /// The radius of bars in place of links without geometry, if it wants them.
    pub bar: Option<Decimal>,
    /// The link whose origin is the tip, if it says one.
    pub tip: Option<String>,
    pub clearance: Decimal,
    /// Those that stay where they are, then the objects where they lie at first.
    pub obstacles: Vec<Obstacle>,
    /// What is to be done, if it says it in steps.
    pub task: Option<Task>,
}

/// Where the arm is, or is to go.
pub enum Goal {
    /// Values of the joints.
    Joints([Range; 2]),
    /// A place of the tip, in whatever configuration.
    Tip(Corner),
}

/// An obstacle, as it stands in the file.
#[derive(Clone)]
pub struct Obstacle {
    pub name: Option<String>,
    outline: Outline,
    /// Where its frame's origin lies, and sine and cosine of how it is turned.
    pub at: Point,
    pub turn: Point,
    /// Its extent along the plane's normal; none: everywhere.
    pub heights: Option<Range>,
}

#[derive(Clone)]
enum Outline {
    /// What its rings surround an odd number of times.
    Polygon(Vec<Vec<Corner>>),
    Polyline(Vec<Corner>),
    Circle(Corner, Decimal),
    Image,
}

/// Reads values of the file, with their places.
struct Reader<'a>(&'a str);

type Read<T> = Result<T, CheckError>;

impl Reader<'_> {
    fn error<T>(&self, value: &Value, message: &str) -> Read<T> {
        Err(CheckError::at(Input::World, self.0, value.span().start, message))
    }

    fn table<'v, 'i>(&self, value: &'v Value<'i>) -> Read<&'v DeTable<'i>> {
        value.get_ref().as_table().map_or_else(|| self.error(value, "expected a table"), Ok)
    }

    fn list<'v, 'i>(&self, value: &'v Value<'i>) -> Read<Vec<&'v Value<'i>>> {
        value
            .get_ref()
            .as_array()
            .map_or_else(|| self.error(value, "expected a list"), |list| Ok(list.iter().collect()))
    }

    fn text(&self, value: &Value) -> Read<String> {
        value.get_ref().as_str().map_or_else(|| self.error(value, "expected a text"), |text| Ok(text.to_owned()))
    }

    /// A number, exactly as it is written.
    fn number(&self, value: &Value) -> Read<Decimal> {
        let text = match value.get_ref() {
            DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
            DeValue::Float(number) => number.as_str(),
            _ => return self.error(value, "expected a decimal number"),
        };
        text.replace('_', "").parse().or_else(|why: String| self.error(value, &why))
    }

    /// A number, or an enclosure of degrees in radians.
    fn quantity(&self, value: &Value) -> Read<Range> {
        let Some(text) = value.get_ref().as_str() else {
            let number = self.number(value)?;
            return Ok([number.clone(), number]);
        };
        let degrees = text.trim().strip_suffix("deg").and_then(|number| number.trim_end().parse::<Decimal>().ok());
        let Some(degrees) = degrees else {
            return self.error(value, "expected a number, or an angle such as \"30deg\"");
        };
        Ok((&Interval::from(&degrees) * &Interval::pi().over(180)).ends())
    }

    fn two<T>(&self, value: &Value, read: impl Fn(&Value) -> Read<T>) -> Read<[T; 2]> {
        match self.list(value)?[..] {
            [a, b] => Ok([read(a)?, read(b)?]),
            _ => self.error(value, "expected two numbers"),
        }
    }

    fn corners(&self, value: &Value) -> Read<Vec<Corner>> {
        self.list(value)?.into_iter().map(|p| self.two(p, |n| self.number(n))).collect()
    }

    /// A ring, or as in GeoJSON a list of rings.
    fn rings(&self, value: &Value) -> Read<Vec<Vec<Corner>>> {
        let list = self.list(value)?;
        let first = list.first().and_then(|ring| ring.get_ref().as_array()?.iter().next()?.get_ref().as_array());
        if first.is_some() {
            list.into_iter().map(|r| self.corners(r)).collect()
        } else {
            Ok(vec![self.corners(value)?])
        }
    }

    fn by_name<T>(&self, value: &Value, read: impl Fn(&Value) -> Read<T>) -> Read<BTreeMap<String, T>> {
        self.table(value)?.iter().map(|(name, value)| Ok((name.get_ref().to_string(), read(value)?))).collect()
    }

    /// `[start]` or `[goal]`.
    fn place(&self, value: &Value) -> Read<Goal> {
        let table = self.table(value)?;
        match (table.get("joints"), table.get("tip")) {
            (Some(joints), None) if table.len() == 1 => Ok(Goal::Joints(self.two(joints, |q| self.quantity(q))?)),
            (None, Some(tip)) if table.len() == 1 => Ok(Goal::Tip(self.two(tip, |n| self.number(n))?)),
            _ => self.error(value, "give joints = [q1, q2] or tip = [x, y]"),
        }
    }

    fn robot(&self, value: &Value, world: &mut World) -> Read<()> {
        for (key, value) in self.table(value)? {
            match &**key.get_ref() {
                "joints" => {
                    let names: Read<Vec<String>> = self.list(value)?.into_iter().map(|name| self.text(name)).collect();
                    world.joints = Some(names?);
                }
                "fixed" => world.fixed = self.by_name(value, |q| self.quantity(q))?,
                "limits" => {
                    let range = |limits: &Value| self.two(limits, |q| self.quantity(q));
                    world.limits = self.by_name(value, range)?;
                }
                "tip" => world.tip = Some(self.text(value)?),
                "at" => world.at = self.two(value, |n| self.number(n))?,
                "angle" => world.angle = Interval::around(&self.quantity(value)?),
                // What does not concern where shapes are.
                "velocity" | "acceleration" | "jerk" | "effort" | "dynamics" | "gravity" => {}
                // What concerns tasks alone.
                "wrist" | "stroke" | "payload" => {}
                "bar" => world.bar = Some(self.number(value)?),
                other => return self.error(value, &format!("the checker does not know [robot] {other}")),
            }
        }
        Ok(())
    }

    fn obstacle(&self, value: &Value, is_object: bool) -> Read<Obstacle> {
        let (mut outlines, mut holes) = (Vec::new(), Vec::new());
        let (mut at, mut turn, mut heights) = ([0, 0].map(Interval::whole), [0, 1].map(Interval::whole), None);
        let mut name = None;
        for (key, value) in self.table(value)? {
            match &**key.get_ref() {
                "polygon" => outlines.push(Outline::Polygon(self.rings(value)?)),
                "polyline" => outlines.push(Outline::Polyline(self.corners(value)?)),
                "circle" => {
                    let table = self.table(value)?;
                    let (Some(center), Some(radius), 2) = (table.get("center"), table.get("radius"), table.len())
                    else {
                        return self.error(value, "a circle has a center and a radius");
                    };
                    outlines.push(Outline::Circle(self.two(center, |n| self.number(n))?, self.number(radius)?));
                }
                "image" => outlines.push(Outline::Image),
                "holes" => holes = self.rings(value)?,
                "at" => at = point(&self.two(value, |n| self.number(n))?),
                "angle" => turn = Interval::around(&self.quantity(value)?).sin_cos(),
                "height" => {
                    let [low, high] = self.two(value, |n| self.number(n))?;
                    if low > high {
                        return self.error(value, "its upper end is below the lower one");
                    }
                    heights = Some([low, high]);
                }
                "name" => name = Some(self.text(value)?),
                "unknown" => {}
                // Of objects: read elsewhere.
                "pallet" | "lift" | "mass" | "payload" | "grasp" | "supports" | "renew" if is_object => {}
                other => {
                    return self.error(value, &format!("the checker does not know the key {other} of an obstacle"));
                }
            }
        }
        let [outline] =
            <[Outline; 1]>::try_from(outlines).or_else(|_| self.error(value, "an obstacle has one shape"))?;
        let outline = match outline {
            Outline::Polygon(mut rings) => {
                rings.extend(holes);
                Outline::Polygon(rings)
            }
            other => other,
        };
        Ok(Obstacle { name, outline, at, turn, heights })
    }
}

impl World {
    /// Reads a world file.
    ///
    /// # Errors
    /// What is no world, or says what the checker does not know and what could make a difference.
    pub fn read(text: &str) -> Read<Self> {
        let table = DeTable::parse(text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            CheckError::at(Input::World, text, at, error.message())
        })?;
        let reader = Reader(text);
        let mut world = Self {
            at: [Decimal::whole(0), Decimal::whole(0)],
            angle: Interval::whole(0),
            joints: None,
            fixed: BTreeMap::new(),
            limits: BTreeMap::new(),
            start: None,
            goal: None,
            bar: None,
            tip: None,
            clearance: Decimal::whole(0),
            obstacles: Vec::new(),
            task: None,
        };
        for (key, value) in table.get_ref() {
            match &**key.get_ref() {
                "robot" => reader.robot(value, &mut world)?,
                "start" => world.start = Some(reader.place(value)?),
                "goal" => world.goal = Some(reader.place(value)?),
                "clearance" => world.clearance = reader.number(value)?,
                "obstacle" => {
                    let list: Read<Vec<Obstacle>> =
                        reader.list(value)?.into_iter().map(|o| reader.obstacle(o, false)).collect();
                    world.obstacles = list?;
                }
                "name" | "preference" | "sensor" => {}
                // What is to be done refers to all else.
                "object" | "pallet" | "step" | "task" => {}
                other => return reader.error(value, &format!("the checker does not know worlds with {other} yet")),
            }
        }
        reader.task(table.get_ref(), &mut world)?;
        Ok(world)
    }
}

impl Obstacle {
    /// A convex part of it, in its place: a disc all of it, of a polyline two points that follow one another, of a polygon
    /// a convex polygon within. Its corners are the obstacle's that are nearest to the given points.
    ///
    /// # Errors
    /// Why it is no such part.
    pub fn part(&self, given: &[Corner]) -> Result<Shape, String> {
        let placed = |corner: &Corner| self.placed(corner);
        let named = |corners: &[&Corner]| {
            let places: Vec<Point> = corners.iter().map(|corner| placed(corner)).collect();
            given.iter().filter_map(|at| Some(corners[nearest(&places, &point(at))?].clone())).collect::<Vec<Corner>>()
        };
        let (corners, radius) = match &self.outline {
            Outline::Circle(center, radius) => (vec![center.clone()], Interval::from(radius)),
            Outline::Polyline(points) => {
                let part = named(&points.iter().collect::<Vec<_>>());
                let is_side = |side: &[Corner]| part == side || part.iter().rev().eq(side);
                if !points.windows(2).any(is_side) {
                    return Err("its corners are not two points that follow one another in the polyline".into());
                }
                (part, Interval::whole(0))
            }
            Outline::Polygon(rings) => {
                let part = named(&rings.iter().flatten().collect::<Vec<_>>());
                if !polygon::holds(rings, &part) {
                    return Err(
                        "its corners are not those, turning left, of a convex polygon within the obstacle".into()
                    );
                }
                (part, Interval::whole(0))
            }
            Outline::Image => return Err("the obstacle is an image, which the checker does not know yet".into()),
        };
        if radius.lower.sign() == Sign::Minus {
            return Err("its radius is negative".into());
        }
        Ok(Shape { points: corners.iter().map(placed).collect(), radius })
    }

    /// The same elsewhere.
    pub fn moved(self, at: Point, turn: Point) -> Self {
        Self { at, turn, ..self }
    }

    /// A point of its frame in its place.
    pub fn placed(&self, corner: &Corner) -> Point {
        sum(&self.at, &turned(&point(corner), &self.turn))
    }
}

fn point(corner: &Corner) -> Point {
    corner.each_ref().map(Interval::from)
}

/// Which of the places is nearest, as the middles of their enclosures have it.
fn nearest(places: &[Point], to: &Point) -> Option<usize> {
    let distance = |place: &Point| {
        let [x, y] = [0, 1].map(|k| (&place[k] - &to[k]).middle().0);
        &x * &x + &y * &y
    };
    (0..places.len()).min_by_key(|i| distance(&places[*i]))
}
