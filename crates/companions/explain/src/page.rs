//! An explanation on a page: a headline, and cards of changes with their effect.

use cplan_geometry::Point;
use cplan_model::Shape;
use cplan_view::{BlockingView, ContourView, ObstacleView, PathView, Section};
use serde::{Serialize, Serializer};

/// An explanation on a page.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExplanationView {
    /// The reason in a sentence.
    pub(crate) headline: String,
    /// A sentence about the proof.
    pub(crate) evidence: String,
    /// The title above the cards.
    pub(crate) title: &'static str,
    pub(crate) cards: Vec<CardView>,
    /// The visible part of the workspace, with all changed obstacles.
    pub(crate) frame: [[f64; 2]; 2],
    /// The obstacles in the way, and the narrowest place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) stuck: Option<BlockingView>,
}

impl ExplanationView {
    /// Returns the section of the page, whose data is this view.
    pub fn section(&self) -> Section {
        Section::of_data("explanation", self)
    }
}

/// A change of the world with the path that it opens, or a configuration to look at.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(crate) struct CardView {
    /// The change as an instruction: `Move it 614 mm right`.
    pub title: String,
    /// The amount with which there is a path, certified.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub opens: String,
    /// The amount with which no path exists, proven.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub closed: String,
    /// Anything else that is known about it.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub note: String,
    /// Index of the changed obstacle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub obstacle: Option<usize>,
    /// The obstacle after the change.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub changed: Option<ObstacleView>,
    /// Indices of the obstacles that are not in the world with the change.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub removed: Vec<usize>,
    /// C-obstacles of the changed obstacle; of all obstacles if only a limit changes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub c_obstacles: Vec<ContourView>,
    /// Least and greatest values of both joints after the change, if a limit changes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub domains: Option<[[f64; 2]; 2]>,
    /// The certified path in the world with the change.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<PathView>,
    /// True if the card shows a place, and nothing that helps.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub is_place: bool,
    /// A configuration to look at.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 2]>,
    /// The change of the world file, for pages that can apply it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edit: Option<Edit>,
}

/// A change of the world file. Its numbers are not rounded, because the path is certified for exactly these.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Edit {
    /// Another shape of the obstacle with this index.
    Obstacle { number: usize, shape: EditedShape },
    /// The obstacle with this index is deleted.
    Removal(usize),
    /// Another clearance, in metres.
    Clearance(f64),
    /// Another range of the joint with this index, in radians or metres.
    Limits { joint: usize, range: [f64; 2] },
}

/// A shape that a world file can describe, in the form that the live page edits.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum EditedShape {
    /// Corners of a polygon.
    Polygon(Vec<[f64; 2]>),
    /// A disc.
    Circle {
        #[serde(serialize_with = "pair")]
        center: Point,
        radius: f64,
    },
    /// Points of a wall.
    Polyline(Vec<[f64; 2]>),
}

impl EditedShape {
    /// Creates the edited form of a shape. `None` if a world file cannot describe it.
    pub fn new(shape: &Shape) -> Option<Self> {
        let pairs = |points: &[Point]| points.iter().map(|p| [p.x, p.y]).collect();
        match shape {
            Shape::Polygon(corners) => Some(Self::Polygon(pairs(corners))),
            Shape::Circle { center, radius } => Some(Self::Circle { center: *center, radius: *radius }),
            Shape::Polyline(points) => Some(Self::Polyline(pairs(points))),
            Shape::Pieces => None,
        }
    }
}

fn pair<S: Serializer>(p: &Point, serializer: S) -> Result<S::Ok, S::Error> {
    [p.x, p.y].serialize(serializer)
}
