//! The outline of a link.

use super::Heights;
use super::workspace::resized;
use cplan_geometry::{Convex, ConvexError, Point};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// The source of a link's outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutlineSource {
    /// The URDF's `<collision>` geometry.
    Collision,
    /// The URDF's `<visual>` geometry, since there is no collision geometry.
    Visual,
    /// A capsule between the joints, as requested by the user.
    Bar,
    /// No outline: the link cannot collide.
    None,
}

/// One convex piece of a link's outline, in the link's frame. The origin of that frame is at the joint that carries
/// the link. At the zero configuration its axes are parallel to the plane's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// The part's projection on the plane, or a shape that covers the projection. If this shape is free of
    /// collisions, so is the part.
    pub shape: Convex,
    /// A shape inside the real part, for proofs of collisions. `None` if `shape` without its padding is exact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inner: Option<Convex>,
    /// Distance by which `shape` has been grown to cover errors of the robot, metres.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub padding: f64,
    /// Number of the shape from which this part was made. It counts the shapes of the URDF link that have a size, or
    /// for an attached part the attachment's pieces.
    #[serde(default, skip_serializing_if = "is_first")]
    pub number: usize,
    /// True if this is the URDF link's `<visual>` geometry, because the link has no `<collision>` geometry.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_visual: bool,
    /// Extent along the plane's normal in the root frame.
    pub heights: Heights,
    /// The URDF link that the geometry belongs to.
    pub body: String,
}

fn is_first(number: &usize) -> bool {
    *number == 0
}

fn is_zero(length: &f64) -> bool {
    *length == 0.0
}

impl Part {
    /// Grows the shape by this distance more, metres, to cover errors of the robot.
    pub(super) fn pad(&mut self, distance: f64) {
        self.shape = self.shape.grown(distance);
        self.padding += distance;
    }

    /// Removes the padding.
    pub(super) fn unpad(&mut self) {
        if self.padding > 0.0 {
            self.shape = resized(&self.shape, -std::mem::take(&mut self.padding));
        }
    }

    /// Returns a shape that lies inside the real part.
    pub fn inner_shape(&self) -> Cow<'_, Convex> {
        match &self.inner {
            Some(inner) => Cow::Borrowed(inner),
            None if self.padding > 0.0 => Cow::Owned(resized(&self.shape, -self.padding)),
            None => Cow::Borrowed(&self.shape),
        }
    }

    /// Replaces the shape by one that lies inside the real part.
    pub(super) fn restrict_to_inner(&mut self) {
        self.shape = self.inner_shape().into_owned();
        (self.inner, self.padding) = (None, 0.0);
    }
}

/// A rigid body between two joints: all parts that one joint moves and the next does not, including URDF links that
/// are fixed to it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Link {
    /// The URDF link that the joint carries.
    pub name: String,
    /// The outline: a union of convex parts.
    pub parts: Vec<Part>,
    /// The source of the outline.
    pub source: OutlineSource,
}

impl Link {
    /// Creates a link of these shapes, at all heights. A link without shapes cannot collide.
    pub fn of(name: &str, shapes: impl IntoIterator<Item = Convex>) -> Self {
        let part = |shape| Part {
            shape,
            inner: None,
            padding: 0.0,
            number: 0,
            is_visual: false,
            heights: Heights::ALL,
            body: name.into(),
        };
        let parts: Vec<Part> = shapes.into_iter().map(part).collect();
        let source = if parts.is_empty() { OutlineSource::None } else { OutlineSource::Collision };
        Self { name: name.into(), parts, source }
    }

    /// Creates a bar with round ends along x, from the joint on. Length and width in metres; with width 0 it is a
    /// line.
    ///
    /// ```
    /// use cplan_model::Link;
    ///
    /// assert!(Link::bar("thin", 0.8, 0.0).is_ok());
    /// assert!(Link::bar("backwards", -0.8, 0.06).is_err() && Link::bar("hollow", 0.8, -0.06).is_err());
    /// ```
    ///
    /// # Errors
    /// If the length is not finite and positive, or the width is negative or not finite.
    pub fn bar(name: &str, length: f64, width: f64) -> Result<Self, ConvexError> {
        if !(length > 0.0 && length.is_finite()) {
            return Err(ConvexError::Length { length });
        }
        Ok(Self::of(name, [Convex::new(vec![Point::zeros(), Point::new(length, 0.0)], width / 2.0)?]))
    }
}
