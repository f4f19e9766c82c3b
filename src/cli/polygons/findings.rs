//! The comparison of two polygons, as JSON.

use super::reader::GivenPolygon;
use crate::geometry::{CornerInside, Point, SimplePolygon, simple_difference, simple_polygon_test};
use serde::Serialize;

/// The comparison of two polygons. Corners and sides are numbered from 1. Side `i` begins at corner `i`.
#[derive(Debug, Serialize)]
pub struct Findings {
    /// True if the polygons have a point in common.
    pub meet: bool,
    /// Penetration depth: the length of the shortest translation of A that separates the polygons. `None` if they are
    /// apart.
    pub depth: Option<f64>,
    /// True if `depth` is exact up to rounding. False if it is only a lower bound, because a polygon is not convex.
    pub depth_is_exact: bool,
    /// Distance of the polygons, or 0 if they meet.
    pub distance: f64,
    pub a: PolygonFinding,
    pub b: PolygonFinding,
    /// First condition: corners of A in B, or on its boundary.
    pub a_corners_in_b: Vec<CornerFinding>,
    /// Second condition: corners of B in A, or on its boundary.
    pub b_corners_in_a: Vec<CornerFinding>,
    /// Third condition: sides that cross.
    pub crossing_sides: Vec<CrossingFinding>,
    /// Convex polygons whose union is B - A.
    pub difference: Vec<PartFinding>,
    pub notes: Vec<String>,
    /// The corners of `difference`, for pictures.
    #[serde(skip)]
    pub parts: Vec<Vec<Point>>,
}

/// A polygon.
#[derive(Debug, Serialize)]
pub struct PolygonFinding {
    /// Corners, counter-clockwise.
    pub corners: Vec<[f64; 2]>,
    pub convex: bool,
}

/// A corner of one polygon in the other.
#[derive(Debug, Serialize)]
pub struct CornerFinding {
    pub corner: usize,
    pub at: [f64; 2],
    /// Distance from the nearest side of the other polygon.
    pub depth: f64,
}

/// A side of A and a side of B that cross in a point interior to both.
#[derive(Debug, Serialize)]
pub struct CrossingFinding {
    pub a: usize,
    pub b: usize,
}

/// A convex part of B - A.
#[derive(Debug, Serialize)]
pub struct PartFinding {
    /// Corners, counter-clockwise.
    pub corners: Vec<[f64; 2]>,
    /// For each corner, the numbers of the corners of B and of A whose difference it is.
    pub of: Vec<[usize; 2]>,
}

impl Findings {
    /// Compares two polygons.
    pub fn new(a: &GivenPolygon, b: &GivenPolygon) -> Self {
        let notes = a.notes.iter().chain(&b.notes).cloned().collect();
        let (a, b) = (&a.polygon, &b.polygon);
        let test = simple_polygon_test(a, b);
        let difference = simple_difference(b, a);
        let inside = |polygon: &SimplePolygon, found: &[CornerInside]| {
            let finding = |&CornerInside { corner, depth }: &CornerInside| CornerFinding {
                corner: corner + 1,
                at: polygon.corners()[corner].into(),
                depth,
            };
            found.iter().map(finding).collect()
        };
        Self {
            meet: test.meet,
            depth: test.meet.then(|| difference.depth.max(0.0)),
            depth_is_exact: difference.parts.len() == 1,
            distance: if test.meet { 0.0 } else { (-difference.depth).max(0.0) },
            a: PolygonFinding::new(a),
            b: PolygonFinding::new(b),
            a_corners_in_b: inside(a, &test.a_inside),
            b_corners_in_a: inside(b, &test.b_inside),
            crossing_sides: test.crossings.iter().map(|&(a, b)| CrossingFinding { a: a + 1, b: b + 1 }).collect(),
            difference: difference.parts.iter().map(|part| PartFinding::new(part, a, b)).collect(),
            notes,
            parts: difference.parts,
        }
    }
}

impl PolygonFinding {
    fn new(polygon: &SimplePolygon) -> Self {
        Self { corners: polygon.corners().iter().map(|&p| p.into()).collect(), convex: polygon.is_convex() }
    }
}

impl PartFinding {
    fn new(part: &[Point], a: &SimplePolygon, b: &SimplePolygon) -> Self {
        let is_at = |corner: &Point, [j, i]: &[usize; 2]| b.corners()[j - 1] - a.corners()[i - 1] == *corner;
        let numbers = || (1..=b.corners().len()).flat_map(|j| (1..=a.corners().len()).map(move |i| [j, i]));
        let of = part.iter().filter_map(|corner| numbers().find(|pair| is_at(corner, pair))).collect();
        Self { corners: part.iter().map(|&p| p.into()).collect(), of }
    }
}
