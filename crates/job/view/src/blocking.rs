//! The obstacles that block a motion, and the configuration where the arm gets stuck.

use super::arm::{self, UNREACHED_LOOK};
use super::axes::Frame;
use super::chart::Chart;
use super::figure::{Item, Pen, Step, Style};
use super::key::{Key, Sign};
use super::shapes;
use super::view::WorldView;
use cplan_geometry::Point;
use cplan_model::Arm;
use cplan_model::space::Configuration;
use cplan_theme::{INFEASIBLE, WHITE};
use serde::{Serialize, Serializer};

/// Dashes of the outlines of blocking obstacles, in pixels.
const BLOCKING_DASH: &[f64] = &[7.0, 3.0];

/// Width of the outlines of blocking obstacles, in pixels.
const OUTLINE_WIDTH: f64 = 3.0;

/// The obstacles that block a motion, and the place where the arm gets stuck.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BlockingView {
    /// Indices of the blocking obstacles.
    pub blockers: Vec<usize>,
    /// The configuration where the arm gets stuck, and the point where it touches an obstacle there. `None` if there is no such
    /// configuration.
    #[serde(serialize_with = "pair", skip_serializing_if = "Option::is_none")]
    pub at: Option<(Configuration, Point)>,
}

fn pair<S: Serializer>(at: &Option<(Configuration, Point)>, serializer: S) -> Result<S::Ok, S::Error> {
    at.map(|(q, p)| [[q[0], q[1]], [p.x, p.y]]).serialize(serializer)
}

/// Draws the outlines of the blocking obstacles, the arm where it gets stuck, and the place.
pub fn in_workspace(stuck: &BlockingView, of: &Arm, world: &WorldView, frame: &Frame) -> Vec<Item> {
    let blockers = stuck.blockers.iter().filter_map(|&number| world.obstacles.get(number));
    let mut items: Vec<Item> = blockers.map(|obstacle| shapes::marked(frame, obstacle, pen())).collect();
    if let Some((at, point)) = stuck.at {
        items.extend(arm::items(frame, of, world.payload.as_ref(), at, &UNREACHED_LOOK));
        items.extend(cross(frame.at(point.x, point.y)));
    }
    items
}

/// Draws the configuration where the arm gets stuck.
pub fn in_cspace(stuck: &BlockingView, chart: &Chart) -> Vec<Item> {
    stuck.at.iter().flat_map(|(at, _)| cross(chart.place(*at))).collect()
}

/// Returns the legend of the marks.
pub fn keys(stuck: &BlockingView) -> Vec<Key> {
    let blocking = (!stuck.blockers.is_empty()).then(|| (Sign::Dashed(INFEASIBLE), "in the way".to_owned()));
    let place = stuck.at.map(|_| {
        let pen = Pen { color: INFEASIBLE, width: 1.2, dash: &[] };
        (Sign::Line(pen), "x: the narrowest place, and the arm there".to_owned())
    });
    blocking.into_iter().chain(place).collect()
}

fn pen() -> Style {
    Style::line(INFEASIBLE, OUTLINE_WIDTH).dashed(BLOCKING_DASH)
}

/// Draws a cross on a white ground.
pub fn cross([x, y]: [f64; 2]) -> Vec<Item> {
    let strokes = |r: f64| {
        vec![
            Step::Move([x - r, y - r]),
            Step::Line([x + r, y + r]),
            Step::Move([x - r, y + r]),
            Step::Line([x + r, y - r]),
        ]
    };
    vec![
        Item::Outline(strokes(7.5), Style::line(WHITE, 6.0)),
        Item::Outline(strokes(6.0), Style::line(INFEASIBLE, 2.6)),
    ]
}
