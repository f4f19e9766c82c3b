//! An independent checker of cplan's certificates.
//!
//! [`check`] reads a URDF, a world and a certificate, and says whether the certificate proves its answer, in exact arithmetic:
//! decimals are taken as they are written, roots, sines and cosines are enclosed by numbers below and above. It shares no code
//! with the planner. `docs/certificates.md` in cplan's repository has the format, what each part of it means, and why what is
//! checked suffices.
//!
//! ```
//! let urdf = r#"<robot name="bar">
//!     <link name="base"/>
//!     <joint name="j1" type="revolute">
//!         <parent link="base"/> <child link="bar"/> <axis xyz="0 0 1"/> <limit lower="-3" upper="3"/>
//!     </joint>
//!     <link name="bar">
//!         <collision> <origin xyz="0.5 0 0"/> <geometry> <box size="1 0.1 0.1"/> </geometry> </collision>
//!     </link>
//!     <joint name="j2" type="revolute">
//!         <parent link="bar"/> <child link="tool"/> <origin xyz="1 0 0"/> <axis xyz="0 0 1"/> <limit lower="-1" upper="1"/>
//!     </joint>
//!     <link name="tool"/>
//! </robot>"#;
//! let world = "start.joints = [-1, 0]\ngoal.joints = [1, 0]\nobstacle = [{ circle = { center = [0.9, 0.0], radius = 0.2 } }]";
//! let certificate = r#"{
//!     "format": "cplan certificate 1", "answer": "infeasible",
//!     "shapes": [{ "link": "bar", "collision": 0 }], "parts": [{ "obstacle": 0 }],
//!     "boxes": [{ "lower": [-0.1, -1], "upper": [0.1, 1], "shape": 0, "part": 0 }]
//! }"#;
//! assert!(cplan_check::check(urdf, world, certificate).is_ok());
//! let too_long = certificate.replace("0.1, 1", "0.3, 1");
//! let why = cplan_check::check(urdf, world, &too_long).unwrap_err();
//! assert!(matches!(why, cplan_check::CheckError::Fails(_)));
//! ```
#![forbid(unsafe_code)]

mod arm;
mod bound;
mod certificate;
mod curve;
mod decimal;
mod error;
mod free;
mod interval;
mod motion;
mod overlap;
mod polygon;
mod robot;
mod scene;
mod sweep;
mod task;
mod world;

pub use error::{CheckError, Input};

use arm::{Cell, Mover};
use certificate::{Answer, Certificate};
use decimal::Decimal;
use interval::{Interval, Point};
use overlap::Shape;
use robot::{Arm, Body};
use sweep::{Domain, Range, Reached, Rectangle};
use world::{Goal, World};

/// Checks a certificate: the texts of the three files. What it proves is returned in words.
///
/// # Errors
/// [`CheckError::Fails`] with the first part that does not hold, [`CheckError::Input`] for files that are wrong or that say
/// what the checker does not know.
pub fn check(urdf: &str, world: &str, certificate: &str) -> Result<String, CheckError> {
    let certificate = certificate::read(certificate)?;
    let world = World::read(world)?;
    let document = roxmltree::Document::parse(urdf).map_err(|error| CheckError::Input {
        input: Input::Urdf,
        line: Some(error.pos().row as usize),
        message: error.to_string(),
    })?;
    let arm = Arm::read(&document, &world)?;
    match certificate.answer {
        Answer::Found => {
            let found = match &certificate.steps {
                Some(steps) => return task::found(&arm, &world, &certificate, steps),
                None => motion::found(&arm, &world, &certificate)?,
            };
            match &certificate.bound {
                Some(_) => Ok(format!("{found}; {}", no_shorter(&arm, &world, &certificate)?)),
                None => Ok(found),
            }
        }
        Answer::Infeasible => infeasible(&arm, &world, &certificate),
        Answer::NoShorter => no_shorter(&arm, &world, &certificate),
    }
}

/// That no motion leads from the start to the goal.
fn infeasible(arm: &Arm, world: &World, certificate: &Certificate) -> Result<String, CheckError> {
    let domain = Domain::new(&arm.joints.each_ref().map(|joint| joint.axis.clone()));
    let start = start(arm, &domain, world, certificate)?;
    let goal = GoalRegion::of(arm, &domain, world, certificate)?;
    let clearance = certificate.clearance(world)?;
    let stuck = certificate.boxes.as_deref().unwrap_or_default();
    let boxes: Vec<Rectangle> =
        stuck.iter().map(|b| [0, 1].map(|k| [b.lower[k].clone(), b.upper[k].clone()])).collect();
    if let Some(empty) = boxes.iter().position(|ranges| ranges.iter().any(|[low, high]| low > high)) {
        return CheckError::fails(format!("box {empty}: an upper end is below the lower one"));
    }
    let Some(reached) = Reached::new(&domain, &boxes, &start) else {
        return CheckError::fails("the boxes leave more gaps than the checker looks at");
    };
    if goal.may_meet(arm, &domain, &reached) {
        return CheckError::fails("the boxes do not separate the goal from the start");
    }
    let contacts = Contacts::new(arm, world, certificate, clearance)?;
    for (number, (stuck, ranges)) in stuck.iter().zip(&boxes).enumerate() {
        let (body, part) = contacts.pair(stuck.shape, stuck.part, || format!("box {number}"))?;
        if !Mover::new(arm, body).overlaps(part, &Cell::from(ranges)) {
            return CheckError::fails(format!("box {number}: within it the shape can come off the part"));
        }
    }
    let [first, second] = arm.joints.each_ref().map(|joint| &joint.name);
    let tip = match &goal {
        GoalRegion::Configuration(_) => String::new(),
        GoalRegion::Tip { link, .. } => format!(", a place of the tip \"{link}\","),
    };
    Ok(format!(
        "no motion of \"{first}\" and \"{second}\" leads from the start{} to the goal{}{tip} with clearance {clearance}",
        shown(certificate.start.as_ref()),
        shown(certificate.goal.as_ref().or(certificate.goal_tip.as_ref()))
    ))
}

/// The configurations that are to be reached.
enum GoalRegion<'a> {
    /// What encloses one.
    Configuration(Rectangle),
    /// All that put the tip, the origin of a link, at a place.
    Tip { link: &'a str, tip: Box<Body>, place: Point },
}

impl<'a> GoalRegion<'a> {
    /// The certificate's, else the world's.
    fn of(arm: &Arm<'a>, domain: &Domain, world: &World, certificate: &Certificate) -> Result<Self, CheckError> {
        let tip = match (&certificate.goal, &certificate.goal_tip, &world.goal) {
            (Some(_), Some(_), _) => return Err(CheckError::in_file(Input::Certificate, "it has two goals")),
            (None, Some(tip), _) | (None, None, Some(Goal::Tip(tip))) => tip,
            (own, None, given) => {
                return Ok(Self::Configuration(place(arm, domain, "goal", own.as_ref(), given.as_ref())?));
            }
        };
        let place = tip.each_ref().map(Interval::from);
        let (link, tip) = arm.tip()?;
        Ok(Self::Tip { link, tip: Box::new(tip), place })
    }

    /// Whether some of it may be among what is reached.
    fn may_meet(&self, arm: &Arm, domain: &Domain, reached: &Reached) -> bool {
        match self {
            Self::Configuration(goal) => reached.meets(goal),
            Self::Tip { tip, place, .. } => arm.may_reach(tip, place, domain, |part| reached.meets(part)),
        }
    }
}

/// That no motion from the start to a configuration is shorter than a length.
fn no_shorter(arm: &Arm, world: &World, certificate: &Certificate) -> Result<String, CheckError> {
    let Some(bound) = &certificate.bound else {
        return Err(CheckError::in_file(Input::Certificate, "it has no bound"));
    };
    let domain = Domain::new(&arm.joints.each_ref().map(|joint| joint.axis.clone()));
    let start = start(arm, &domain, world, certificate)?;
    let goal = place(arm, &domain, "bound", Some(&bound.to), None)?;
    bound::holds(arm, bound, &start, &[goal])?;
    let contacts = Contacts::new(arm, world, certificate, certificate.clearance(world)?)?;
    for (number, wall) in bound.walls.iter().enumerate() {
        let (body, part) = contacts.pair(wall.shape, wall.part, || format!("wall {number}"))?;
        if !bound::closes(arm, wall, body, part) {
            return CheckError::fails(format!("wall {number}: along it the shape can come off the part"));
        }
    }
    let [from, to] = [certificate.start.as_ref(), Some(&bound.to)].map(shown);
    Ok(format!("no motion from the start{from} to{to} is shorter than {}", bound.length))
}

/// The shapes and the parts of obstacles that a certificate names, parts grown by the clearance.
struct Contacts<'a> {
    bodies: Vec<Body>,
    parts: Vec<(Shape, Option<&'a Range>)>,
}

impl<'a> Contacts<'a> {
    fn new(arm: &Arm, world: &'a World, certificate: &Certificate, clearance: &Decimal) -> Result<Self, CheckError> {
        let bodies = certificate.shapes.iter().map(|name| match (name.collision, name.visual, name.bar) {
            (Some(number), None, None) => arm.body(&name.link, "collision", number),
            (None, Some(number), None) => arm.body(&name.link, "visual", number),
            (None, None, Some(0)) => arm.bar(&name.link),
            _ => Err(CheckError::in_file(Input::Certificate, "a shape has one number, of a bar 0")),
        });
        let parts = certificate.parts.iter().enumerate().map(|(number, name)| {
            let part = world.obstacles.get(name.obstacle).ok_or_else(|| "there is no such obstacle".to_owned());
            let part = part.and_then(|obstacle| {
                let Shape { points, radius } = obstacle.part(&name.corners)?;
                Ok((Shape { points, radius: &radius + &Interval::from(clearance) }, obstacle.heights.as_ref()))
            });
            part.map_err(|why| CheckError::Fails(format!("part {number}, of obstacle {}: {why}", name.obstacle)))
        });
        Ok(Self { bodies: bodies.collect::<Result<_, _>>()?, parts: parts.collect::<Result<_, _>>()? })
    }

    /// A shape and a part that can meet.
    fn pair(&self, shape: usize, part: usize, who: impl Fn() -> String) -> Result<(&Body, &Shape), CheckError> {
        let (Some(body), Some((part, heights))) = (self.bodies.get(shape), self.parts.get(part)) else {
            return CheckError::fails(format!("{} names a shape or a part that is not there", who()));
        };
        if !body.is_at(*heights) {
            return CheckError::fails(format!("{}: the shape passes over or under the obstacle", who()));
        }
        Ok((body, part))
    }
}

/// What was asked in place of the world's, in words.
fn shown(own: Option<&[Decimal; 2]>) -> String {
    own.map_or_else(String::new, |[a, b]| format!(" ({a}, {b})"))
}

/// The start.
fn start(arm: &Arm, domain: &Domain, world: &World, certificate: &Certificate) -> Result<Rectangle, CheckError> {
    match (&certificate.start, &world.start) {
        (None, Some(Goal::Tip(_))) => {
            let message = "the checker does not know starts that are places of the tip: give joint values";
            Err(CheckError::in_file(Input::World, message))
        }
        (own, given) => place(arm, domain, "start", own.as_ref(), given.as_ref()),
    }
}

/// The start or the goal: the certificate's, else the world's.
fn place(
    arm: &Arm,
    domain: &Domain,
    what: &str,
    own: Option<&[Decimal; 2]>,
    given: Option<&Goal>,
) -> Result<Rectangle, CheckError> {
    let own = own.map(|q| q.each_ref().map(|value| [value.clone(), value.clone()]));
    let given = given.and_then(|given| if let Goal::Joints(values) = given { Some(values.clone()) } else { None });
    let Some(values) = own.or(given) else {
        return Err(CheckError::in_file(Input::World, format!("there is no {what}: [{what}] joints = [q1, q2]")));
    };
    let wrapped = |k: usize| {
        let message =
            || format!("the {what}'s joint \"{}\" is outside its limits, or at half a turn", arm.joints[k].name);
        domain.wrapped(k, &values[k]).ok_or_else(|| CheckError::in_file(Input::World, message()))
    };
    Ok([wrapped(0)?, wrapped(1)?])
}
