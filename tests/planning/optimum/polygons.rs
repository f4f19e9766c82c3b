//! A point among convex polygons, compared with the visibility of all pairs of corners by brute force.

use super::gantry::{REACH, gantry};
use super::{LIMITS, ROUNDING, bound, metrics};
use cplan::geometry::{Convex, Vector};
use cplan::space::{Configuration, Metric};
use cplan_testkit::shapes::convex;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// A segment that enters a polygon by at most this depth counts as passing it, in metres.
const GRAZE: f64 = 1e-12;

/// Sides of polygons in joint space, as half-planes `n . q <= c`, in counterclockwise order.
type Sides = Vec<(Configuration, f64)>;

fn sides(corners: &[Configuration]) -> Sides {
    let side = |i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
        let along = (b - a).normalize();
        let normal = Configuration::new(along[1], -along[0]);
        (normal, normal.dot(&a))
    };
    (0..corners.len()).map(side).collect()
}

/// Returns true if a segment leads through the inside of a polygon: clips it by all sides moved inwards.
fn enters(sides: &Sides, a: Configuration, b: Configuration) -> bool {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (normal, offset) in sides {
        let (start, rate) = (normal.dot(&a) - offset + GRAZE, normal.dot(&(b - a)));
        if rate.abs() < 1e-15 {
            if start >= 0.0 {
                return false;
            }
        } else if rate > 0.0 {
            to = to.min(-start / rate);
        } else {
            from = from.max(-start / rate);
        }
    }
    from < to
}

/// Returns the length of the shortest path from the start to the nearest goal among the corners of polygons, by
/// Dijkstra's algorithm without a heap.
fn shortest(polygons: &[Vec<Configuration>], start: Configuration, goals: &[Configuration], metric: Metric) -> f64 {
    let all: Vec<Sides> = polygons.iter().map(|corners| sides(corners)).collect();
    let mut points = vec![start];
    points.extend(goals);
    points.extend(polygons.iter().flatten().filter(|q| q.amax() <= REACH));
    let mut cost = vec![f64::INFINITY; points.len()];
    let mut done = vec![false; points.len()];
    cost[0] = 0.0;
    while let Some(next) = (0..points.len()).filter(|&i| !done[i]).min_by(|&i, &j| cost[i].total_cmp(&cost[j])) {
        if (1..=goals.len()).contains(&next) || cost[next].is_infinite() {
            return cost[next];
        }
        done[next] = true;
        for other in 0..points.len() {
            let (a, b) = (points[next], points[other]);
            if !done[other] && !all.iter().any(|sides| enters(sides, a, b)) {
                cost[other] = cost[other].min(cost[next] + metric.norm(b - a));
            }
        }
    }
    f64::INFINITY
}

fn is_in_polygon(sides: &Sides, q: Configuration) -> bool {
    sides.iter().all(|(normal, offset)| normal.dot(&q) <= offset + 1e-6)
}

/// Returns a strategy for polygons of 3 to 6 corners, some of them thin, in joint space.
fn polygon() -> impl Strategy<Value = Vec<Configuration>> {
    let at = (-1.8..1.8_f64, -1.8..1.8_f64);
    (at, 3..7_u8, 0.05..0.8_f64, prop_oneof![Just(1.0), 0.01..0.3_f64], 0.0..TAU, 0.0..TAU).prop_map(
        |((x, y), n, size, flat, turn, first)| {
            let corner = |k: u8| {
                let t = first + TAU * f64::from(k) / f64::from(n);
                let (u, v) = (size * t.cos(), size * flat * t.sin());
                Configuration::new(x + u * turn.cos() - v * turn.sin(), y + u * turn.sin() + v * turn.cos())
            };
            (0..n).map(corner).collect()
        },
    )
}

/// Checks that bounds do not exceed the length of the shortest path.
fn check_bound(
    polygons: &[Vec<Configuration>],
    angles: [f64; 2],
    start: Configuration,
    goals: &[Configuration],
    gap: f64,
) {
    let directions = angles.map(|angle| Vector::new(angle.cos(), angle.sin()));
    let place = |q: &Configuration| directions[0] * q[0] + directions[1] * q[1];
    let pieces: Vec<Convex> = polygons.iter().map(|corners| convex(corners.iter().map(place).collect(), 0.0)).collect();
    let problem = gantry(angles, pieces, start, goals);
    for metric in metrics() {
        let length = shortest(polygons, start, goals, metric);
        let limit = if length.is_finite() { length * LIMITS[0] } else { 100.0 };
        let found = bound(&problem, metric, limit, gap);
        assert!(found <= length * (1.0 + ROUNDING), "{metric:?}: {found} above {length}");
    }
}

/// Checks a slanting side. In the slices along it, the ends of the closed intervals are in line. None of them may be
/// left out, although its neighbours imply its value.
#[test]
fn the_bound_along_a_slanting_side_holds() {
    let corners = [
        (1.0703667779167292, -0.283927995580206),
        (1.7643086878991947, -1.0208985780181092),
        (2.501279270337098, -0.3269566680356437),
        (1.8073373603546325, 0.41001391440225965),
    ];
    let diamond = corners.map(|(x, y)| Configuration::new(x, y)).to_vec();
    let start = Configuration::new(1.1574012277374817, -0.6843018950959452);
    let goal = Configuration::new(1.9617226256965494, 0.49656754518455704);
    check_bound(&[diamond], [0.0, 2.414414677611783], start, &[goal], 1e-2);
}

proptest! {
    #![proptest_config(cplan_cases::cases(200))]

    #[test]
    fn no_path_among_polygons_is_shorter_than_the_bound(
        polygons in prop::collection::vec(polygon(), 1..9), oblique in prop_oneof![Just(TAU / 4.0), 0.5..2.6_f64],
        first in prop_oneof![Just(0.0), 0.0..TAU], start in (-REACH..=REACH, -REACH..=REACH),
        goals in prop::collection::vec((-REACH..=REACH, -REACH..=REACH), 1..4),
        gap in prop_oneof![Just(1e-2), Just(1e-4)],
    ) {
        let start = Configuration::new(start.0, start.1);
        let goals: Vec<_> = goals.into_iter().map(|(x, y)| Configuration::new(x, y)).collect();
        let all: Vec<Sides> = polygons.iter().map(|corners| sides(corners)).collect();
        prop_assume!(goals.iter().chain([&start]).all(|&q| !all.iter().any(|sides| is_in_polygon(sides, q))));
        check_bound(&polygons, [first, first + oblique], start, &goals, gap);
    }
}
