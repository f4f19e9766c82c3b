//! Shapes of the robot that can collide.

use crate::decimal::Decimal;
use crate::domain::Range;
use crate::error::CheckError;
use crate::interval::Interval;
use crate::obstacle::Obstacle;
use crate::overlap::Shape;
use std::collections::BTreeSet;
use std::fmt;

/// Least overlap of the heights of two links that can collide, metres: `10^-9`. Links often lie on one another.
const TOUCHING: u32 = 9;

/// What an outline is to be, where it is not the projection itself.
#[derive(Clone, Copy, PartialEq)]
pub enum Outline {
    /// Part of the projection.
    Within,
    /// All of it, and maybe more.
    Around,
}

/// A collision shape in the plane, as seen from the origin of its joint.
#[derive(Clone)]
pub struct Body {
    /// 0 or 1: the last joint that moves it. No matter of what stands still.
    pub link: usize,
    /// What it covers.
    pub shape: Shape,
    /// Its extent along the normal; none: everywhere.
    pub heights: Option<[Interval; 2]>,
}

impl Body {
    /// Its heights and others; none where one of them is everywhere.
    fn beside(&self, heights: Option<&Range>) -> Option<(&[Interval; 2], [Interval; 2])> {
        Some((self.heights.as_ref()?, heights?.each_ref().map(Interval::from)))
    }

    /// Whether its heights and these are known to have some in common.
    pub fn is_at(&self, heights: Option<&Range>) -> bool {
        self.beside(heights).is_none_or(|(own, [low, high])| own[0].upper <= high.lower && low.upper <= own[1].lower)
    }

    /// Whether its heights and these are known to have none in common.
    pub fn passes(&self, heights: Option<&Range>) -> bool {
        self.beside(heights).is_some_and(|(own, [low, high])| own[1].upper < low.lower || high.upper < own[0].lower)
    }

    /// Returns the heights at which other links can collide with a link that is an obstacle for them: at least those with
    /// [`Outline::Around`], at most those with [`Outline::Within`].
    pub fn kept(&self, outline: Outline) -> Option<Range> {
        let by = Interval::from(&Decimal::power_of_ten(TOUCHING));
        let [low, high] = self.heights.as_ref()?;
        let ([least, low], [high, most]) = ((low + &by).ends(), (high - &by).ends());
        Some(if outline == Outline::Around { [least, most] } else { [low, high] })
    }
}

/// A shape that counts, or a layer of one.
#[derive(Clone)]
pub struct Counted {
    /// The link that it belongs to.
    pub link: String,
    /// `collision`, `visual` or `bar`, ...
    pub kind: &'static str,
    /// ... and its number among those of its kind that the link has, without those that have no size.
    pub number: usize,
    /// The last of the two joints that moves it; none if it stands still.
    pub last: Option<usize>,
    /// Number of the layer, counted from the lowest, if the shape is cut.
    pub layer: Option<usize>,
    /// At least what it covers, ...
    pub around: Body,
    /// ... and at most.
    pub within: Body,
    /// Links that it may touch.
    pub ignored: BTreeSet<String>,
}

impl fmt::Display for Counted {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { link, kind, number, layer, .. } = self;
        match *kind {
            "bar" => write!(f, "the bar of link \"{link}\"")?,
            _ => write!(f, "link \"{link}\", {kind} {number}")?,
        }
        layer.map_or(Ok(()), |layer| write!(f, ", layer {layer}"))
    }
}

impl Counted {
    /// Returns the link as the owner of an obstacle.
    pub fn owner(&self) -> Owner {
        Owner { link: self.link.clone(), is_carried: self.last.is_some() }
    }

    /// Whether a body, which is this shape or its sweep by the tool, must keep off an obstacle.
    pub fn meets(&self, body: &Body, obstacle: &Obstacle) -> bool {
        let is_free = obstacle.own.as_ref().is_some_and(|own| self.ignored.contains(&own.link));
        !is_free && !body.passes(obstacle.heights.as_ref())
    }
}

/// A link of the robot that is an obstacle for others.
#[derive(Clone)]
pub struct Owner {
    /// Its name.
    pub link: String,
    /// Whether joint 1 carries it. Then its place is that with joint 1 at zero, and so is that of what can meet it.
    pub is_carried: bool,
}

/// Finds a shape by its link, kind and number; if it is cut, the layer that contains a height.
///
/// # Errors
/// When there is none, or several layers and no height.
pub fn named<'s>(
    all: &'s [Counted],
    (link, kind, number): (&str, &str, usize),
    height: Option<&Decimal>,
) -> Result<&'s Counted, CheckError> {
    let is_at = |own: &Counted| match (height.map(Interval::from), &own.around.heights) {
        (Some(at), Some([low, high])) => low.lower <= at.upper && at.lower <= high.upper,
        _ => true,
    };
    let is_named = |own: &&Counted| own.link == link && own.kind == kind && own.number == number && is_at(own);
    let mut found = all.iter().filter(is_named);
    match (found.next(), found.next()) {
        (Some(_), Some(_)) if height.is_none() => {
            CheckError::fails(format!("{kind} {number} of link \"{link}\" has several layers: it needs a height"))
        }
        (Some(one), _) => Ok(one),
        (None, _) => CheckError::fails(format!("link \"{link}\" has no {kind} shape number {number} that counts")),
    }
}
