//! The cells of gantries that are wholly free, compared with distances between swept polygons.

use cplan::cspace::{Proves, outer_grid};
use cplan::geometry::{Convex, Point, Vector};
use cplan::model::Scene;
use cplan_testkit::shapes::{self, convex};
use cplan_testkit::{arms, scenes};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Depth below which either verdict about a cell is accepted, metres.
const BOUNDARY: f64 = 1e-7;

fn polygon() -> impl Strategy<Value = Convex> {
    let shape = ((-1.0..1.0, -1.0..1.0), 0.05..0.5f64, 1usize..6, 0.0..TAU, prop_oneof![Just(0.0), 0.01..0.2f64]);
    shape.prop_map(|((x, y), size, corners, turn, radius)| {
        let corner = |k: usize| {
            let angle = turn + TAU * k as f64 / corners as f64;
            Point::new(x + size * angle.cos(), y + size * angle.sin())
        };
        convex((0..corners).map(corner).collect(), radius)
    })
}

/// Returns a gantry whose slides make an angle, with one shape on its second link, among obstacles.
fn gantry(angles: [f64; 2], part: Convex, pieces: Vec<Convex>) -> Scene {
    let mut arm = arms::slides([angles[0], angles[0] + angles[1]], [-1.3, 1.5], vec![part]);
    arm.offset = Vector::new(0.1, -0.2);
    scenes::scene(arm, pieces)
}

/// Returns the greatest gap between two convex polygons over the directions normal to their sides and between their
/// corners. The gap is negative if they overlap; it is then the negative depth.
fn gap(a: &[Point], b: &[Point]) -> f64 {
    let mut directions = Vec::new();
    for polygon in [a, b] {
        for (i, p) in polygon.iter().enumerate() {
            let along = polygon[(i + 1) % polygon.len()] - p;
            directions.extend([Vector::new(along.y, -along.x), Vector::new(-along.y, along.x)]);
        }
    }
    directions.extend(a.iter().flat_map(|p| b.iter().map(move |q| q - p)));
    let spread = |d: &Vector| {
        let most = a.iter().map(|p| d.dot(p)).fold(f64::NEG_INFINITY, f64::max);
        b.iter().map(|p| d.dot(p)).fold(f64::INFINITY, f64::min) - most
    };
    let gaps = directions.iter().filter_map(|d| d.try_normalize(1e-12)).map(|d| spread(&d));
    gaps.fold(f64::NEG_INFINITY, f64::max)
}

/// Returns the convex hull by the definition: a corner has all others on one side of some line through it.
fn hull(points: &[Point]) -> Vec<Point> {
    let middle = points.iter().sum::<Vector>() / points.len() as f64;
    let is_side = |p: &Point, q: &Point| {
        let along = q - p;
        along.norm() > 1e-9 && points.iter().all(|r| along.x * (r.y - p.y) - along.y * (r.x - p.x) >= -1e-12)
    };
    let mut corners: Vec<Point> =
        points.iter().filter(|p| points.iter().any(|q| is_side(p, q) || is_side(q, p))).copied().collect();
    corners.sort_by(|p, q| (p - middle).y.atan2((p - middle).x).total_cmp(&(q - middle).y.atan2((q - middle).x)));
    corners
}

proptest! {
    #![proptest_config(cplan_cases::cases(60))]

    /// Compares each cell with the shape that the link sweeps while the configuration ranges over the cell.
    #[test]
    fn a_cell_is_blocked_if_and_only_if_the_swept_link_overlaps_an_obstacle(
        first in 0.0..TAU, between in prop_oneof![Just(TAU / 4.0), 0.4..2.7f64, -2.7..-0.4f64], part in polygon(),
        pieces in prop::collection::vec(polygon(), 1..4), clearance in prop_oneof![Just(0.0), 0.0..0.1f64],
    ) {
        let scene = gantry([first, between], part.clone(), pieces.clone());
        let grid = outer_grid(&scene, [13, 11], clearance);
        let is_outer = matches!(grid.proves, Proves::Outer { .. });
        prop_assert!(is_outer);
        let directions = [first, first + between].map(|angle| Vector::new(angle.cos(), angle.sin()));
        let (step, arm) = (grid.step(), scene.arm());
        for index in 0..grid.blocked.len() {
            let center = grid.center(index);
            let at = |s: f64, t: f64| {
                let [q1, q2] = [center[0] + s * step[0], center[1] + t * step[1]];
                arm.base + arm.offset + q1 * directions[0] + q2 * directions[1]
            };
            let places = [at(-0.5, -0.5), at(0.5, -0.5), at(0.5, 0.5), at(-0.5, 0.5)];
            let swept: Vec<Point> = places.iter().flat_map(|place| part.core().iter().map(move |p| p + place)).collect();
            let swept = hull(&swept);
            let overlap = |piece: &Convex| part.radius() + piece.radius() + clearance - gap(&swept, piece.core());
            let depth = pieces.iter().map(overlap).fold(f64::NEG_INFINITY, f64::max);
            prop_assert!(depth.abs() < BOUNDARY || grid.blocked[index] == (depth > 0.0), "cell {}: depth {}", index, depth);
        }
    }
}

/// Checks cells whose sides lie on the sides of a C-obstacle. The coordinates are decimals that doubles cannot represent.
#[test]
fn a_c_obstacle_that_ends_where_a_cell_begins_leaves_the_cell_free() {
    let part = shapes::rectangle(-0.05, 0.05, -0.05, 0.05);
    let scene = gantry_along_axes(part, vec![shapes::rectangle(0.35, 0.55, -0.15, 0.05)]);
    let grid = outer_grid(&scene, [20, 20], 0.0);
    // The cells have sides of 0.1 m, and the C-obstacle fills three by three of them.
    let blocked: Vec<[usize; 2]> =
        (0..400).filter(|&index| grid.blocked[index]).map(|index| [index / 20, index % 20]).collect();
    let expected: Vec<[usize; 2]> = (13..16).flat_map(|i| (8..11).map(move |j| [i, j])).collect();
    assert_eq!(blocked, expected);
}

/// Checks a wall without thickness on the side between two columns of cells, for a tool that is a point. It is a
/// C-obstacle without width.
#[test]
fn a_wall_between_cells_blocks_both() {
    for (wall, turned) in [([0.3, -0.25, 0.3, 0.25], false), ([-0.25, 0.3, 0.25, 0.3], true)] {
        let wall = Convex::segment(Point::new(wall[0], wall[1]), Point::new(wall[2], wall[3])).unwrap();
        let scene = gantry_along_axes(convex(vec![Point::zeros()], 0.0), vec![wall]);
        let grid = outer_grid(&scene, [20, 20], 0.0);
        let blocked = |i: usize, j: usize| grid.blocked[if turned { 20 * j + i } else { 20 * i + j }];
        for j in 0..20 {
            let is_beside = (7..13).contains(&j);
            assert_eq!([11, 12, 13, 14].map(|i| blocked(i, j)), [false, is_beside, is_beside, false], "{j}");
        }
    }
}

fn gantry_along_axes(part: Convex, pieces: Vec<Convex>) -> Scene {
    scenes::scene(arms::gantry([-1.0, 1.0], vec![part]), pieces)
}
