//! Shapes of the robot that can collide.

use crate::decimal::Decimal;
use crate::domain::Range;
use crate::error::CheckError;
use crate::interval::Interval;
use crate::obstacle::Obstacle;
use crate::overlap::Shape;
use std::collections::BTreeSet;
use std::fmt;

/// Least overlap of the heights of two links that can collide, metres: `10^-9`. Links often rest on one another.
const MIN_OVERLAP_DECIMALS: u32 = 9;

/// The approximation of a projection.
#[derive(Clone, Copy, PartialEq)]
pub enum Outline {
    /// Part of the projection.
    Within,
    /// A superset of the projection.
    Around,
}

/// A collision shape in the plane, relative to the origin of its joint.
#[derive(Clone)]
pub struct Body {
    /// The last joint that moves it, 0 or 1. Meaningless for static links.
    pub link: usize,
    /// The region that it covers.
    pub shape: Shape,
    /// Extent along the normal; `None` if unlimited.
    pub heights: Option<[Interval; 2]>,
}

impl Body {
    /// Returns its heights and others. Returns `None` if one of them is unlimited.
    fn beside(&self, heights: Option<&Range>) -> Option<(&[Interval; 2], [Interval; 2])> {
        Some((self.heights.as_ref()?, heights?.each_ref().map(Interval::from)))
    }

    /// Returns true if its heights and these certainly overlap.
    pub fn is_at(&self, heights: Option<&Range>) -> bool {
        self.beside(heights).is_none_or(|(own, [low, high])| own[0].upper <= high.lower && low.upper <= own[1].lower)
    }

    /// Returns true if its heights and these certainly do not overlap.
    pub fn passes(&self, heights: Option<&Range>) -> bool {
        self.beside(heights).is_some_and(|(own, [low, high])| own[1].upper < low.lower || high.upper < own[0].lower)
    }

    /// Returns the heights at which other links can collide with a link that is an obstacle for them.
    /// [`Outline::Around`] gives a superset of these heights, [`Outline::Within`] a subset.
    pub fn kept(&self, outline: Outline) -> Option<Range> {
        let by = Interval::from(&Decimal::power_of_ten(MIN_OVERLAP_DECIMALS));
        let [low, high] = self.heights.as_ref()?;
        let ([least, low], [high, most]) = ((low + &by).ends(), (high - &by).ends());
        Some(if outline == Outline::Around { [least, most] } else { [low, high] })
    }
}

/// A shape that is considered for collisions, or a layer of one.
#[derive(Clone)]
pub struct CollisionShape {
    /// Name of the link that it belongs to.
    pub link: String,
    /// `collision`, `visual` or `bar`.
    pub kind: &'static str,
    /// Number among the link's shapes of that kind, not counting those without size.
    pub number: usize,
    /// The last of the two joints that moves it; `None` if it is static.
    pub last: Option<usize>,
    /// Number of the layer, counted from the lowest, if the shape is cut.
    pub layer: Option<usize>,
    /// A superset of the covered region.
    pub around: Body,
    /// A subset of the covered region.
    pub within: Body,
    /// Links that it is allowed to touch.
    pub ignored: BTreeSet<String>,
}

impl fmt::Display for CollisionShape {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { link, kind, number, layer, .. } = self;
        match *kind {
            "bar" => write!(f, "the bar of link \"{link}\"")?,
            _ => write!(f, "link \"{link}\", {kind} {number}")?,
        }
        layer.map_or(Ok(()), |layer| write!(f, ", layer {layer}"))
    }
}

impl CollisionShape {
    /// Returns the link as the owner of an obstacle.
    pub fn owner(&self) -> Owner {
        Owner { link: self.link.clone(), is_carried: self.last.is_some() }
    }

    /// Returns true if a body must keep away from an obstacle. The body is this shape, or its sweep by the tool.
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
    /// True if joint 1 carries it. Then its position is given with joint 1 at zero, and so is that of anything that can
    /// collide with it.
    pub is_carried: bool,
}

/// Finds a shape by its link, kind and number. If the shape is cut, finds the layer that contains a height.
///
/// # Errors
/// If there is no such shape, or if it has several layers and no height is given.
pub fn named<'s>(
    all: &'s [CollisionShape],
    (link, kind, number): (&str, &str, usize),
    height: Option<&Decimal>,
) -> Result<&'s CollisionShape, CheckError> {
    let is_at = |own: &CollisionShape| match (height.map(Interval::from), &own.around.heights) {
        (Some(at), Some([low, high])) => low.lower <= at.upper && at.lower <= high.upper,
        _ => true,
    };
    let is_named = |own: &&CollisionShape| own.link == link && own.kind == kind && own.number == number && is_at(own);
    let mut found = all.iter().filter(is_named);
    match (found.next(), found.next()) {
        (Some(_), Some(_)) if height.is_none() => {
            CheckError::fails(format!("{kind} {number} of link \"{link}\" has several layers: it needs a height"))
        }
        (Some(one), _) => Ok(one),
        (None, _) => CheckError::fails(format!("link \"{link}\" has no {kind} shape number {number} that counts")),
    }
}
