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
mod contacts;
mod curve;
mod decimal;
mod error;
mod files;
mod free;
mod impossible;
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

use certificate::{Answer, Certificate, rectangles};
use contacts::{Among, Contacts};
use decimal::Decimal;
use files::Files;
use interval::{Interval, Point};
use robot::{Arm, Body};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use sweep::{Domain, Reached, Rectangle};
use world::{Goal, World};

/// Checks a certificate: the texts of the three files. What it proves is returned in words.
///
/// # Errors
/// [`CheckError::Fails`] with the first part that does not hold, [`CheckError::Input`] for files that are wrong or that say
/// what the checker does not know; also if they name other files, which have no place here.
pub fn check(urdf: &str, world: &str, certificate: &str) -> Result<String, CheckError> {
    judged([urdf, world, certificate], [None, None])
}

/// The same of three files. What the URDF and the world name is looked for beside them.
///
/// # Errors
/// As [`check`], and files that cannot be read.
pub fn check_files(urdf: &Path, world: &Path, certificate: &Path) -> Result<String, CheckError> {
    let read = |input: Input, path: &Path| {
        let message = |error| format!("{error}: give a URDF, a world file and a certificate");
        std::fs::read_to_string(path).map_err(|error| CheckError::in_file(input, message(error)))
    };
    let texts = [read(Input::Urdf, urdf)?, read(Input::World, world)?, read(Input::Certificate, certificate)?];
    judged(texts.each_ref().map(String::as_str), [urdf, world].map(|path| Some(path.to_owned())))
}

/// Checks a certificate of texts, and where they are from.
fn judged([urdf, world, certificate]: [&str; 3], given: [Option<PathBuf>; 2]) -> Result<String, CheckError> {
    let certificate = certificate::read(certificate)?;
    let files = Files::new(&certificate, [urdf, world], given)?;
    // A byte order mark says nothing.
    let [urdf, world] = [urdf, world].map(|text| text.strip_prefix('\u{feff}').unwrap_or(text));
    let world = World::read(world, &files)?;
    let document = roxmltree::Document::parse(urdf).map_err(|error| CheckError::Input {
        input: Input::Urdf,
        line: Some(error.pos().row as usize),
        message: error.to_string(),
    })?;
    let arm = Arm::read(&document, &world, &files, certificate.joints.as_ref())?;
    let proven = match (&certificate.answer, &certificate.steps, &certificate.cases) {
        (Answer::Found, Some(steps), _) => task::found(&arm, &world, &certificate, steps),
        (Answer::Found, None, _) if certificate.bound.is_some() => {
            Ok(motion::found(&arm, &world, &certificate)? + "; " + &no_shorter(&arm, &world, &certificate)?)
        }
        (Answer::Found, None, _) => motion::found(&arm, &world, &certificate),
        (Answer::Infeasible, _, Some(cases)) => impossible::infeasible(&arm, &world, &certificate, cases),
        (Answer::Infeasible, ..) => infeasible(&arm, &world, &certificate),
        (Answer::NoShorter, ..) => no_shorter(&arm, &world, &certificate),
    };
    Ok(proven? + &arm.notes)
}

/// That no motion leads from the start to the goal.
fn infeasible(arm: &Arm, world: &World, certificate: &Certificate) -> Result<String, CheckError> {
    let domain = Domain::new(&arm.joints.each_ref().map(|joint| joint.axis.clone()));
    let start = start(arm, &domain, world, certificate)?;
    let goal = GoalRegion::of(arm, &domain, world, certificate)?;
    let clearance = certificate.clearance(world)?;
    let stuck = certificate.boxes.as_deref().unwrap_or_default();
    let boxes = rectangles(stuck)?;
    let Some(reached) = Reached::new(&domain, &boxes, &start) else {
        return CheckError::fails("the boxes leave more gaps than the checker looks at");
    };
    if !goal.places(arm, &domain, MOST_PARTS, |part| !reached.meets(part)).is_empty() {
        return CheckError::fails("the boxes do not separate the goal from the start");
    }
    Contacts::new(arm, &Among::all(world), certificate, clearance).complete()?.hold(arm, stuck, &boxes)?;
    let [first, second] = arm.joints.each_ref().map(|joint| &joint.name);
    Ok(format!(
        "no motion of \"{first}\" and \"{second}\" leads from the start{} to the goal{} with clearance {clearance}",
        shown(certificate.start.as_ref()),
        goal.named(certificate)
    ))
}

/// Parts of the domain in which the tip may be at a place, at the most, if it is to be shut off there, ...
const MOST_PARTS: usize = 2000;

/// ... and if it is only to be known where.
const FEW_PARTS: usize = 500;

/// The configurations that are to be reached.
#[derive(Clone)]
enum GoalRegion<'a> {
    /// What encloses one.
    Configuration(Rectangle),
    /// All that put the tip, the origin of a link, at a place.
    Tip { link: &'a str, tip: Rc<Body>, place: Point },
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
        Ok(Self::Tip { link: arm.tip_link, tip: Rc::new(arm.tip.clone()), place })
    }

    /// What holds all of it but what is left out.
    fn places(
        &self,
        arm: &Arm,
        domain: &Domain,
        most: usize,
        is_left_out: impl Fn(&Rectangle) -> bool,
    ) -> Vec<Rectangle> {
        match self {
            Self::Configuration(goal) => [goal.clone()].into_iter().filter(|goal| !is_left_out(goal)).collect(),
            Self::Tip { tip, place, .. } => arm.places((tip, place), domain, most, is_left_out),
        }
    }

    /// What was asked in place of the world's goal, in words.
    fn named(&self, certificate: &Certificate) -> String {
        let own = shown(certificate.goal.as_ref().or(certificate.goal_tip.as_ref()));
        match self {
            Self::Configuration(_) => own,
            Self::Tip { link, .. } => format!("{own}, a place of the tip \"{link}\","),
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
    let stuck = certificate.boxes.as_deref().unwrap_or_default();
    let boxes = rectangles(stuck)?;
    let (goals, to) = match &bound.to {
        Some(to) => (vec![place(arm, &domain, "bound", Some(to), None)?], shown(Some(to))),
        None => {
            let goal = GoalRegion::of(arm, &domain, world, certificate)?;
            let is_stuck = |part: &Rectangle| boxes.iter().any(|stuck| within(part, stuck));
            (goal.places(arm, &domain, FEW_PARTS, is_stuck), format!(" the goal{}", goal.named(certificate)))
        }
    };
    bound::holds(arm, bound, &start, &goals)?;
    let among = Among::all(world);
    let contacts = Contacts::new(arm, &among, certificate, certificate.clearance(world)?).complete()?;
    contacts.hold(arm, stuck, &boxes)?;
    for (number, wall) in bound.walls.iter().enumerate() {
        let (body, part) = contacts.pair(wall.shape, wall.part, || format!("wall {number}"))?;
        if !bound::closes(arm, wall, &body, &part) {
            return CheckError::fails(format!("wall {number}: along it the shape can come off the part"));
        }
    }
    let from = shown(certificate.start.as_ref());
    Ok(format!("no motion from the start{from} to{to} is shorter than {}", bound.length))
}

/// Whether a rectangle is part of another.
fn within(part: &Rectangle, whole: &Rectangle) -> bool {
    (0..2).all(|k| whole[k][0] <= part[k][0] && part[k][1] <= whole[k][1])
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
