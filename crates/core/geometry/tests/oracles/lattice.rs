//! Shapes with small integer corners, on which plain integer arithmetic is exact, and an oracle that uses it.

use cplan_geometry::{Point, hull};
use proptest::prelude::*;

/// A corner on the lattice.
pub type Corner = (i64, i64);

pub fn cross(a: Corner, b: Corner, c: Corner) -> i64 {
    (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
}

pub fn point(p: Corner) -> Point {
    Point::new(p.0 as f64, p.1 as f64)
}

pub fn points(corners: &[Corner]) -> Vec<Point> {
    corners.iter().map(|&p| point(p)).collect()
}

/// Generates convex cores in a small box, where touching, collinear sides and shapes without area are frequent.
pub fn core() -> impl Strategy<Value = Vec<Corner>> {
    prop::collection::vec((-4..=4i64, -4..=4i64), 1..7)
        .prop_map(|list| hull(&points(&list)).iter().map(|p| (p.x as i64, p.y as i64)).collect())
}

/// Returns true if two convex cores meet, by separating axes in integers.
///
/// The axes are the normals of all sides and, for cores without area, the sides themselves and the coordinate axes.
pub fn meet(a: &[Corner], b: &[Corner]) -> bool {
    let mut axes = vec![(1, 0), (0, 1)];
    for core in [a, b] {
        for (i, p) in core.iter().enumerate() {
            let q = core[(i + 1) % core.len()];
            let side = (q.0 - p.0, q.1 - p.1);
            axes.extend([side, (-side.1, side.0)]);
        }
    }
    let extent = |core: &[Corner], axis: Corner| {
        let along = core.iter().map(|p| p.0 * axis.0 + p.1 * axis.1);
        (along.clone().min().unwrap(), along.max().unwrap())
    };
    axes.iter().all(|&axis| {
        let ((a_low, a_high), (b_low, b_high)) = (extent(a, axis), extent(b, axis));
        a_low <= b_high && b_low <= a_high
    })
}
