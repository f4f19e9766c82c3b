//! Minkowski differences of convex polygons: cplan's, which orders sides by exact predicates, beside the plain merge in
//! doubles that most people write first.

use crate::Result;
use crate::rounds::Rounds;
use cplan::geometry::{Convex, Point, Vector};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Number of differences per round, so that a round is long enough for the clock.
const BATCH: usize = 100;

/// Returns a regular polygon, turned by `phase` so that the sides of two polygons are not parallel.
fn regular(corners: usize, phase: f64) -> Vec<Point> {
    let angle = |k: usize| phase + k as f64 / corners as f64 * TAU;
    (0..corners).map(|k| Point::new(angle(k).cos(), angle(k).sin())).collect()
}

/// Computes `b - a` for convex counter-clockwise polygons: merges the sides of `b` and of `-a` by the sign of a cross
/// product.
fn plain(b: &[Point], a: &[Point]) -> Vec<Point> {
    let mirrored: Vec<Point> = a.iter().map(|p| -*p).collect();
    let lowest = |polygon: &[Point]| {
        let key = |k: &usize| (polygon[*k].y, polygon[*k].x);
        (0..polygon.len()).min_by(|i, j| key(i).partial_cmp(&key(j)).expect("finite")).unwrap_or(0)
    };
    let side =
        |polygon: &[Point], k: usize| -> Vector { polygon[(k + 1) % polygon.len()] - polygon[k % polygon.len()] };
    let (first, second) = (lowest(b), lowest(&mirrored));
    let (mut i, mut j) = (0, 0);
    let mut at = b[first] + mirrored[second];
    let mut out = Vec::with_capacity(b.len() + a.len());
    while i < b.len() || j < a.len() {
        out.push(at);
        let (u, v) = (side(b, first + i), side(&mirrored, second + j));
        let turn = u.x * v.y - u.y * v.x;
        let takes_first = j == a.len() || (i < b.len() && turn >= 0.0);
        let takes_second = i == b.len() || (j < a.len() && turn <= 0.0);
        if takes_first {
            at += u;
            i += 1;
        }
        if takes_second {
            at += v;
            j += 1;
        }
    }
    out
}

pub fn run(corners: usize, rounds: usize) -> Result<Value> {
    let (a, b) = (regular(corners, 0.001), regular(corners, 0.002));
    let (one, other) = (Convex::new(a.clone(), 0.0)?, Convex::new(b.clone(), 0.0)?);
    let ours = || other.minkowski_difference(&one);
    let mut times = Rounds::default();
    for _ in 0..rounds {
        times.time("cplan", || (0..BATCH).map(|_| ours().core().len()).sum::<usize>());
        times.time("plain", || (0..BATCH).map(|_| plain(&b, &a).len()).sum::<usize>());
    }
    let (ours, theirs) = (ours(), plain(&b, &a));
    let area = |polygon: &[Point]| {
        let next = polygon.iter().cycle().skip(1);
        polygon.iter().zip(next).map(|(p, q)| p.x * q.y - p.y * q.x).sum::<f64>() / 2.0
    };
    Ok(json!({
        "times": times.into_json(),
        "batch": BATCH,
        "corners": {"cplan": ours.core().len(), "plain": theirs.len()},
        "areas": {"cplan": area(ours.core()), "plain": area(&theirs)},
    }))
}
