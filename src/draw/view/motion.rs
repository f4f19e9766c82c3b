//! Paths, and motions in time.

use super::round::Grain;
use crate::draw::page::path_pen;
use crate::motion::Trajectory;
use crate::space::{Configuration, Path};
use serde::Serialize;

/// A path in a world.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PathView {
    pub name: String,
    pub world: usize,
    /// Colour, unless it is drawn in ink.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<String>,
    pub dash: Vec<f64>,
    /// Unwrapped configurations, one value after the other.
    pub points: Vec<f64>,
}

impl PathView {
    pub fn of_picture(paths: &[(String, &Path)], grain: Grain) -> Vec<Self> {
        let view = |(index, (name, path)): (usize, &(String, &Path))| {
            let pen = path_pen(index, paths.len());
            Self {
                name: name.clone(),
                world: 0,
                color: (paths.len() > 1).then(|| pen.color.to_string()),
                dash: pen.dash.to_vec(),
                points: grain.configurations(path.waypoints()),
            }
        };
        paths.iter().enumerate().map(view).collect()
    }
}

/// A motion from rest to rest.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotionView {
    pub world: usize,
    /// Which of the paths it follows; none of a world in which nothing moves any more.
    pub path: Option<usize>,
    /// When its world begins to be that which is there, seconds.
    pub from: f64,
    /// What it does, in words.
    pub label: String,
}

impl MotionView {
    /// The only motion of a plan.
    pub fn only(duration: f64) -> Self {
        Self { world: 0, path: Some(0), from: 0.0, label: format!("{duration:.3} s") }
    }
}

/// Where the arm is at which time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Clock {
    time: Vec<f64>,
    /// Of both joints, one after the other; radians or metres.
    position: Vec<f64>,
    /// The same a second.
    velocity: Vec<f64>,
    /// The same a second squared, at the beginning of the interval that begins here.
    acceleration: Vec<f64>,
}

impl Clock {
    pub fn new(trajectory: &Trajectory, grain: Grain) -> Self {
        let flat = |values: &[[f64; 2]]| -> Vec<f64> {
            values.iter().flat_map(|&q| grain.configuration(Configuration::from(q))).collect()
        };
        Self {
            time: trajectory.time.iter().map(|&t| (t * 1e6).round() / 1e6).collect(),
            position: flat(&trajectory.position),
            velocity: flat(&trajectory.velocity),
            acceleration: flat(&trajectory.acceleration),
        }
    }
}
