//! Places for the names of C-obstacles.

use super::numbers::{RoundingSteps, number};
use super::world::ContourView;
use crate::copies::Window;
use cplan_core::model::Arm;
use cplan_core::space::Configuration;
use cplan_geometry::{Point, pole_of_inaccessibility};
use serde::Serialize;

/// Largest number of obstacles with names. With more names, it would be unclear to which C-obstacle each belongs.
const MAX_NAMED_OBSTACLES: usize = 100;
/// Ratio of width to height of a typical name. It determines in which place a name has the most room.
const NAME_PROPORTION: f64 = 2.5;
/// Precision of the places for names, as a fraction of an axis.
const PLACE_PRECISION: f64 = 0.004;
/// Size of details of outlines that the search for a place may ignore, as a fraction of an axis.
const OUTLINE_PRECISION: f64 = 0.005;

/// A place for the name of a C-obstacle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NameView {
    pub obstacle: usize,
    pub at: [f64; 2],
    /// Area of the named part, as a fraction of the visible area.
    pub area: f64,
}

/// Returns one place for each obstacle that has a C-obstacle: in the largest visible part of the C-obstacle, as far
/// from its outline as possible.
pub fn places(arm: &Arm, count: usize, contours: &[ContourView], grain: RoundingSteps) -> Vec<NameView> {
    if count > MAX_NAMED_OBSTACLES {
        return Vec::new();
    }
    let ranges = arm.topology().ranges.map(|axis| axis.domain());
    let repeats = arm.joints.each_ref().map(|joint| joint.joint_type.is_revolute());
    let window = Window { ranges, repeats };
    let place = |obstacle: usize| {
        let own = contours.iter().filter(|contour| contour.obstacle == obstacle).map(|contour| &contour.contour.0);
        let parts = own.flat_map(|corners| {
            window.shifts(corners).into_iter().map(|shift| clipped(corners.iter().map(|q| unit(q + shift, &window))))
        });
        let largest = parts.map(|part| (area(&part), part)).max_by(|a, b| a.0.total_cmp(&b.0));
        let (area, part) = largest.filter(|(area, _)| *area > 0.0)?;
        let scaled: Vec<Point> = part.iter().map(|p| Point::new(p.x / NAME_PROPORTION, p.y)).collect();
        let (pole, _) = pole_of_inaccessibility(&coarsened(scaled), PLACE_PRECISION)?;
        let [x, y] = [pole.x * NAME_PROPORTION, pole.y];
        let q = |k: usize, part: f64| ranges[k].0 + part * (ranges[k].1 - ranges[k].0);
        let at = grain.configuration(Configuration::new(q(0, x), q(1, y)));
        Some(NameView { obstacle, at, area: number(area) })
    };
    (0..count).filter_map(place).collect()
}

/// Scales a configuration to fractions of both axes.
fn unit(q: Configuration, window: &Window) -> Point {
    let part = |k: usize| (q[k] - window.ranges[k].0) / (window.ranges[k].1 - window.ranges[k].0);
    Point::new(part(0), part(1))
}

/// Returns the part of a polygon in the unit square (Sutherland and Hodgman 1974).
fn clipped(corners: impl Iterator<Item = Point>) -> Vec<Point> {
    let mut corners: Vec<Point> = corners.collect();
    for (k, limit, side) in [(0, 0.0, 1.0), (0, 1.0, -1.0), (1, 0.0, 1.0), (1, 1.0, -1.0)] {
        let depth = |p: &Point| side * (p[k] - limit);
        let mut kept = Vec::with_capacity(corners.len() + 4);
        for (i, &b) in corners.iter().enumerate() {
            let a = corners[(i + corners.len() - 1) % corners.len()];
            let (before, after) = (depth(&a), depth(&b));
            if (before < 0.0) != (after < 0.0) {
                kept.push(a + (b - a) * (before / (before - after)));
            }
            if after >= 0.0 {
                kept.push(b);
            }
        }
        corners = kept;
    }
    corners
}

/// Returns the outline without corners that lie very near to the one before.
fn coarsened(corners: Vec<Point>) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for corner in corners {
        if kept.last().is_none_or(|last| (corner - last).norm() > OUTLINE_PRECISION) {
            kept.push(corner);
        }
    }
    kept
}

fn area(corners: &[Point]) -> f64 {
    let cross = |(i, a): (usize, &Point)| {
        let b = corners[(i + 1) % corners.len()];
        a.x * b.y - a.y * b.x
    };
    corners.iter().enumerate().map(cross).sum::<f64>().abs() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_clipped_to_the_panel() {
        let square = [(-1.0, 0.25), (0.5, 0.25), (0.5, 0.75), (-1.0, 0.75)].map(|(x, y)| Point::new(x, y));
        let inside = clipped(square.into_iter());
        assert!((area(&inside) - 0.25).abs() < 1e-12 && inside.iter().all(|p| p.x >= 0.0), "{inside:?}");
        assert!(clipped(square.iter().map(|p| p + nalgebra::Vector2::new(3.0, 0.0))).is_empty());
    }
}
