//! Shapes of the robot that can collide.

use crate::decimal::Decimal;
use crate::domain::Range;
use crate::error::CheckError;
use crate::interval::Interval;
use crate::obstacle::Obstacle;
use crate::overlap::Shape;
use std::collections::BTreeSet;
use std::fmt;

/// Number of decimals of the least overlap of heights with which two links can collide: `10^-9` m. Links often rest on
/// one another, and their rounded heights then overlap slightly. A shape and an obstacle that is not a link touch if
/// their heights are at most this far apart.
const MIN_OVERLAP_DECIMALS: u32 = 9;

/// Approximation of a link's shape, projected into the plane.
#[derive(Clone, Copy, PartialEq)]
pub enum Outline {
    /// A subset of the link's projection, for proofs that it collides.
    Within,
    /// A superset of the link's projection, for proofs that it is free.
    Around,
}

/// A collision shape in the plane, relative to the origin of its joint.
#[derive(Clone)]
pub struct Body {
    /// The last joint that moves the shape, 0 or 1. It has no meaning for static links.
    pub link: usize,
    /// The region that it covers.
    pub shape: Shape,
    /// Extent along the normal; `None` if unlimited.
    pub heights: Option<[Interval; 2]>,
}

impl Body {
    /// Returns this body's heights and the given heights as enclosures. `None` if one of them is unlimited.
    fn enclosures(&self, heights: Option<&Range>) -> Option<(&[Interval; 2], [Interval; 2])> {
        Some((self.heights.as_ref()?, heights?.each_ref().map(Interval::from)))
    }

    /// Returns true if this body's heights and the given heights certainly overlap.
    pub fn overlaps_heights(&self, heights: Option<&Range>) -> bool {
        self.enclosures(heights)
            .is_none_or(|(own, [low, high])| own[0].upper <= high.lower && low.upper <= own[1].lower)
    }

    /// Returns true if this body's heights and the given heights certainly overlap or touch.
    pub fn touches_heights(&self, heights: Option<&Range>) -> bool {
        let by = Interval::from(&Decimal::power_of_ten(MIN_OVERLAP_DECIMALS));
        let within = |low: &Interval, high: &Interval| low.upper <= (high + &by).lower;
        self.enclosures(heights).is_none_or(|(own, [low, high])| within(&own[0], &high) && within(&low, &own[1]))
    }

    /// Returns true if this body's heights and the given heights certainly do not overlap.
    pub fn misses_heights(&self, heights: Option<&Range>) -> bool {
        self.enclosures(heights).is_some_and(|(own, [low, high])| own[1].upper < low.lower || high.upper < own[0].lower)
    }

    /// Returns the heights at which other links can collide with this body: its own heights, reduced by the least
    /// overlap at both ends. [`Outline::Around`] gives a superset of them, and [`Outline::Within`] a subset. `None` if
    /// the heights are unlimited.
    pub fn inset_heights(&self, outline: Outline) -> Option<Range> {
        let by = Interval::from(&Decimal::power_of_ten(MIN_OVERLAP_DECIMALS));
        let [low, high] = self.heights.as_ref()?;
        let ([least, low], [high, most]) = ((low + &by).ends(), (high - &by).ends());
        Some(if outline == Outline::Around { [least, most] } else { [low, high] })
    }
}

/// A shape, or a layer of one, that is checked for collisions.
#[derive(Clone)]
pub struct CollisionShape {
    /// Name of the link to which the shape belongs.
    pub link: String,
    /// Kind of the shape: `collision`, `visual`, or `bar` for a bar that the world defines.
    pub kind: &'static str,
    /// Index among those shapes of this kind and link that have a size.
    pub number: usize,
    /// The last joint that moves the shape, 0 or 1; `None` if the shape is static.
    pub last: Option<usize>,
    /// Number of the layer, counted from the lowest. `None` if the shape is not cut into layers.
    pub layer: Option<usize>,
    /// A superset of the covered region.
    pub around: Body,
    /// A subset of the covered region.
    pub within: Body,
    /// Shapes of the robot that this shape may touch, by their names in messages.
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
    /// Describes the shape as the owner of an obstacle.
    pub fn owner(&self) -> Owner {
        Owner { shape: self.to_string(), is_carried: self.last.is_some() }
    }

    /// Returns true if `body` must keep away from an obstacle, that is, if the obstacle is at its height and is not a
    /// shape that may be touched. `body` is this shape, or the region that this shape sweeps when the tool turns.
    pub fn meets(&self, body: &Body, obstacle: &Obstacle) -> bool {
        let is_free = obstacle.own.as_ref().is_some_and(|own| self.ignored.contains(&own.shape));
        !is_free && !body.misses_heights(obstacle.heights.as_ref())
    }
}

/// A shape of the robot that is an obstacle for others.
#[derive(Clone)]
pub struct Owner {
    /// Name of the shape in messages.
    pub shape: String,
    /// True if joint 1 carries the shape. Then positions of the shape, and of shapes that can collide with it, are
    /// given with joint 1 at zero.
    pub is_carried: bool,
}

/// Finds a shape by its link, kind and number. If the shape is cut into layers, finds the layer at `height`.
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
        (Some(_), Some(_)) if height.is_none() => CheckError::fails(format!(
            "{kind} {number} of link \"{link}\" has several layers: choose one by its \"height\""
        )),
        (Some(one), _) => Ok(one),
        (None, _) => CheckError::fails(format!("link \"{link}\" has no {kind} shape {number} that could collide")),
    }
}
