//! The line that the tip should follow, and the place where it cannot.

use super::axes::Frame;
use super::blocking::cross;
use super::figure::{Item, Pen, Style, chain};
use super::key::{Key, Sign};
use super::view::{Chain, RoundingSteps};
use cplan_geometry::Point;
use cplan_theme::{GRAY, INFEASIBLE};
use serde::Serialize;

/// Width of the line, in pixels. The trace of the tip, which is narrower, lies on it.
const WIDTH: f64 = 4.5;

/// A line that the tip should follow.
#[derive(Debug, Clone, PartialEq)]
pub struct LineView {
    /// Points of the line, metres. Each inner list is a stretch without a travel.
    pub strokes: Vec<Vec<Point>>,
    /// The place on the line where no motion is possible; `None` for other answers.
    pub at: Option<Point>,
}

/// The line as pages read it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LineDocument {
    strokes: Vec<Chain>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<[f64; 2]>,
}

impl LineDocument {
    pub fn new(line: &LineView, grain: RoundingSteps) -> Self {
        let strokes = line.strokes.iter().map(|stroke| Chain(grain.points(stroke))).collect();
        Self { strokes, at: line.at.map(|at| grain.point(at).into()) }
    }
}

/// Draws the line in the workspace.
#[must_use]
pub fn in_workspace(line: &LineView, frame: &Frame) -> Vec<Item> {
    let steps = |stroke: &Vec<Point>| chain(stroke.iter().map(|p| frame.at(p.x, p.y)), false);
    line.strokes.iter().map(|stroke| Item::Outline(steps(stroke), Style::line(GRAY, WIDTH))).collect()
}

/// Draws the place where no motion is possible. It is above everything else.
#[must_use]
pub fn place(line: &LineView, frame: &Frame) -> Vec<Item> {
    line.at.map_or_else(Vec::new, |at| cross(frame.at(at.x, at.y)))
}

/// Returns the legend of the line.
#[must_use]
pub fn keys(line: &LineView) -> Vec<Key> {
    let pen = |color, width| Sign::Line(Pen { color, width, dash: &[] });
    let place = line.at.map(|_| (pen(INFEASIBLE, 2.6), "x: the tip cannot follow the line here".to_owned()));
    [(pen(GRAY, WIDTH), "line to follow".to_owned())].into_iter().chain(place).collect()
}
