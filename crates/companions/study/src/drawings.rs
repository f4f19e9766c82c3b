//! Small drawings of layouts, as data for the page's script: the obstacles, and the arm at the start and at the goal.

use super::Study;
use super::row::Row;
use cplan_geometry::Convex;
use cplan_model::space::{Configuration, Metric};
use cplan_model::{Arm, Scene};
use cplan_parallel::caught;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Largest number of layouts that are drawn. Drawing a layout takes about a millisecond and some hundred bytes.
const MAX_DRAWN_LAYOUTS: usize = 2500;

/// Rounding of coordinates, as a fraction of the arm's reach. This is a tenth of a pixel on a phone.
const ROUNDING: f64 = 2e-4;

/// Role of the arm at the start. Obstacles have their numbers instead.
const START: i64 = -1;
/// Role of the arm at the goal.
const GOAL: i64 = -2;

/// Drawings of layouts. A shape that several layouts share, up to its place, is stored once.
#[derive(Debug, Default)]
pub struct Drawings {
    /// Rounding of all coordinates, in metres. Zero before the first drawing.
    unit: f64,
    /// Radius and corners of each shape, relative to its first corner, in units.
    shapes: Vec<Vec<i64>>,
    known: BTreeMap<Vec<i64>, usize>,
    /// For each layout: role, shape, and place of the first corner, in units.
    layouts: BTreeMap<usize, Vec<[i64; 4]>>,
    /// Least and greatest coordinates of everything that is drawn, in units. `None` before the first shape.
    extent: Option<[[i64; 2]; 2]>,
    obstacles: usize,
}

impl Drawings {
    /// Draws these layouts. Skips those that cannot be read.
    pub fn new<'a>(study: &Study, rows: impl Iterator<Item = &'a Row>) -> Self {
        let mut drawings = Self::default();
        for row in rows {
            if drawings.layouts.len() < MAX_DRAWN_LAYOUTS && !drawings.layouts.contains_key(&row.layout) {
                drawings.add(study, row);
            }
        }
        drawings
    }

    fn add(&mut self, study: &Study, row: &Row) {
        // Skip the drawing of a layout in which an error occurs.
        let Ok(Ok(problem)) = caught(|| study.problem(&row.values)) else { return };
        let scene = problem.scene();
        if self.unit == 0.0 {
            self.unit = ROUNDING * scene.arm().reach();
        }
        let mut placed = Vec::new();
        for (number, obstacle) in scene.workspace().obstacles.iter().enumerate() {
            for piece in &obstacle.pieces {
                placed.push(self.place(number as i64, piece));
            }
        }
        self.obstacles = self.obstacles.max(scene.workspace().obstacles.len());
        let (start, goals) = (problem.query().start(), problem.query().goals());
        let goal = goals.nearest(&scene.arm().topology(), Metric::Euclidean, start);
        for (role, q) in [(GOAL, goal), (START, Some(start))] {
            if let Some(q) = q {
                placed.extend(outlines(scene.arm(), scene, q).map(|outline| self.place(role, &outline)));
            }
        }
        self.layouts.insert(row.layout, placed);
    }

    /// Stores a shape, and returns its role, its index and its place.
    fn place(&mut self, role: i64, shape: &Convex) -> [i64; 4] {
        let whole = |x: f64| (x / self.unit).round() as i64;
        let radius = whole(shape.radius().max(0.0));
        let corners: Vec<[i64; 2]> = shape.core().iter().map(|p| [whole(p.x), whole(p.y)]).collect();
        let [x, y] = corners[0];
        for [a, b] in &corners {
            let [low, high] = self.extent.get_or_insert([[*a, *b], [*a, *b]]);
            *low = [low[0].min(a - radius), low[1].min(b - radius)];
            *high = [high[0].max(a + radius), high[1].max(b + radius)];
        }
        let relative = corners.iter().flat_map(|[a, b]| [a - x, b - y]);
        let key: Vec<i64> = std::iter::once(radius).chain(relative).collect();
        let next = self.shapes.len();
        let index = *self.known.entry(key.clone()).or_insert(next);
        if index == next {
            self.shapes.push(key);
        }
        [role, index as i64, x, y]
    }

    /// Returns the drawings in the format of the page's script.
    pub fn to_json(&self) -> Value {
        let colors: Vec<String> = (0..self.obstacles).map(|number| cplan_theme::obstacle(number).to_string()).collect();
        let flat = |placed: &Vec<[i64; 4]>| placed.iter().flatten().copied().collect::<Vec<i64>>();
        let layouts: BTreeMap<&usize, Vec<i64>> = self.layouts.iter().map(|(n, placed)| (n, flat(placed))).collect();
        json!({ "shapes": self.shapes, "layouts": layouts, "extent": self.extent, "colors": colors })
    }
}

/// Returns the parts of the arm in a configuration, without a payload.
fn outlines<'a>(arm: &'a Arm, scene: &'a Scene, q: Configuration) -> impl Iterator<Item = Convex> + use<'a> {
    let poses = arm.poses(q);
    (0..2).flat_map(move |k| scene.own_parts(k).iter().map(move |part| part.shape.at(&poses[k])))
}
