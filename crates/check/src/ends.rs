//! Where motions begin and end: what is asked, and the configurations that are it.

use crate::certificate::Certificate;
use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::free::{Chain, On};
use crate::interval::{BITS, Interval, Point, length, minus};
use crate::robot::{Arm, Body};
use crate::sweep::{Axis, Range, Rectangle};
use crate::world::{Goal, World};
use num_bigint::BigInt;
use std::rc::Rc;

/// By how much a motion may miss its start or goal, radians or metres: `10^-5`.
const MISSED: u32 = 5;

/// Parts of the domain in which the tip may be at a place, at the most, if it is to be shut off there, ...
pub const MOST_PARTS: usize = 2000;

/// ... and if it is only to be known where.
pub const FEW_PARTS: usize = 500;

/// The start or the goal.
pub struct End {
    what: &'static str,
    pub at: Goal,
    /// What the certificate says of it in place of the world, in words.
    own: String,
}

impl End {
    /// The start: the certificate's, else the world's.
    ///
    /// # Errors
    /// When there is none.
    pub fn start(certificate: &Certificate, world: &World) -> Result<Self, CheckError> {
        Self::of("start", certificate.start.as_ref().map(exactly), world.start.as_ref())
    }

    /// The goal, likewise.
    ///
    /// # Errors
    /// When there is none, or two.
    pub fn goal(certificate: &Certificate, world: &World) -> Result<Self, CheckError> {
        let own = match (&certificate.goal, &certificate.goal_tip) {
            (Some(_), Some(_)) => return Err(CheckError::in_file(Input::Certificate, "it has two goals")),
            (joints, tip) => joints.as_ref().map(exactly).or(tip.clone().map(Goal::Tip)),
        };
        Self::of("goal", own, world.goal.as_ref())
    }

    fn of(what: &'static str, own: Option<Goal>, given: Option<&Goal>) -> Result<Self, CheckError> {
        let said = match &own {
            Some(Goal::Joints([[a, _], [b, _]]) | Goal::Tip([a, b])) => format!(" ({a}, {b})"),
            None => String::new(),
        };
        let missing = || format!("there is no {what}: [{what}] joints = [q1, q2]");
        let at = own.or_else(|| given.cloned()).ok_or_else(|| CheckError::in_file(Input::World, missing()))?;
        Ok(Self { what, at, own: said })
    }

    /// It in words, as far as it is not the world's.
    pub fn named(&self, arm: &Arm) -> String {
        match self.at {
            Goal::Joints(_) => self.own.clone(),
            Goal::Tip(_) => format!("{}, a place of the tip \"{}\",", self.own, arm.tip_link),
        }
    }

    /// The same with how near to it a motion has its first or last knot.
    ///
    /// # Errors
    /// If that is too far away.
    pub fn reached(&self, arm: &Arm, knot: &[Decimal]) -> Result<String, CheckError> {
        let named = self.named(arm);
        let is_it = |k: usize, range: &Range| range.iter().all(|end| *end == knot[1 + k]);
        match &self.at {
            Goal::Joints(ranges) if (0..2).all(|k| is_it(k, &ranges[k])) => Ok(named),
            at => Ok(named.trim_end_matches(',').to_owned() + &missed(self.what, &arm.away(knot, at))?),
        }
    }

    /// What encloses it, if it is one configuration.
    ///
    /// # Errors
    /// Places of the tip, and values outside of the limits.
    pub fn configuration(&self, arm: &Arm) -> Result<Rectangle, CheckError> {
        match &self.at {
            Goal::Joints(values) => arm.configuration(self.what, values),
            Goal::Tip(_) => {
                let message = format!(
                    "the checker does not know proofs from a {} that is a place of the tip: give joint values",
                    self.what
                );
                Err(CheckError::in_file(Input::World, message))
            }
        }
    }

    /// All configurations that are it.
    ///
    /// # Errors
    /// Values outside of the limits.
    pub fn region(&self, arm: &Arm) -> Result<Region, CheckError> {
        match &self.at {
            Goal::Joints(values) => Ok(Region::Configuration(arm.configuration(self.what, values)?)),
            Goal::Tip(at) => Ok(Region::tip(arm, at.each_ref().map(Interval::from))),
        }
    }
}

fn exactly(q: &[Decimal; 2]) -> Goal {
    Goal::Joints(q.each_ref().map(|value| [value.clone(), value.clone()]))
}

/// The configurations that are to be reached.
#[derive(Clone)]
pub enum Region {
    /// What encloses one.
    Configuration(Rectangle),
    /// All that put a point of the second link, such as the tip, at a place.
    Tip { tip: Rc<Body>, place: Point },
}

impl Region {
    /// All that put the tip at a place.
    pub fn tip(arm: &Arm, place: Point) -> Self {
        Self::Tip { tip: Rc::new(arm.tip.clone()), place }
    }

    /// What holds all of it but what is left out.
    pub fn places(&self, arm: &Arm, most: usize, is_left_out: impl Fn(&Rectangle) -> bool) -> Vec<Rectangle> {
        match self {
            Self::Configuration(goal) => [goal.clone()].into_iter().filter(|goal| !is_left_out(goal)).collect(),
            Self::Tip { tip, place } => arm.places((tip, place), most, is_left_out),
        }
    }
}

/// By how much an end is missed, in words.
///
/// # Errors
/// If it is too much.
pub fn missed(what: &str, off: &BigInt) -> Result<String, CheckError> {
    let is_within = |digits: &u32| Interval::from(&Decimal::power_of_ten(*digits)).lower >= *off;
    match (MISSED..50).rev().find(is_within) {
        Some(digits) => Ok(format!(", within 1e-{digits},")),
        None => CheckError::fails(format!("the motion misses the {what} by more than 1e-{MISSED}")),
    }
}

impl Arm<'_> {
    /// What encloses a configuration.
    ///
    /// # Errors
    /// One that is outside of the limits.
    pub fn configuration(&self, what: &str, values: &[Range; 2]) -> Result<Rectangle, CheckError> {
        let wrapped = |k: usize| {
            let name = &self.joints[k].name;
            let outside = || format!("the {what}'s joint \"{name}\" is outside its limits, or at half a turn");
            let within = self.domain.wrapped(k, &values[k]);
            within.ok_or_else(|| CheckError::in_file(Input::World, outside()))
        };
        Ok([wrapped(0)?, wrapped(1)?])
    }

    /// A bound on how far a knot is from where it is to be: joint by joint, or of the tip.
    pub fn away(&self, knot: &[Decimal], goal: &Goal) -> BigInt {
        let at = [&knot[1], &knot[2]];
        match goal {
            Goal::Joints(ranges) => (0..2).map(|k| self.off(k, at[k], &ranges[k])).max().expect("two joints"),
            Goal::Tip(place) => {
                let tip = &self.tip.shape.points[0];
                let is = Chain::from(self).point_at(&On::Link(1), tip, &at.map(Interval::from));
                length(&minus(&is, &place.each_ref().map(Interval::from))).upper
            }
        }
    }

    /// A bound on how far a value of a joint is from another, whole turns of a joint that turns without end not counted.
    fn off(&self, joint: usize, is: &Decimal, should: &Range) -> BigInt {
        let apart = &Interval::from(is) - &Interval::around(should);
        if !matches!(self.joints[joint].axis, Axis::Circle) {
            return apart.magnitude();
        }
        let turn = Interval::pi() + Interval::pi();
        let turns = &apart.lower / &turn.lower;
        let without = |more: i32| {
            let turns = Interval::exactly((&turns + more) << BITS);
            (&apart - &(&turn * &turns)).magnitude()
        };
        (-1..=1).map(without).min().expect("three")
    }
}
