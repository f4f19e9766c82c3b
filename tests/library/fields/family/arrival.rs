//! Directions in which paths of oriented fields arrive, against the closed form for open space.
//!
//! Without obstacles, the field is `exp(-e <v, x> / 2) K0(e r / 2)`. Here `x` is the place relative to the goal, `r`
//! its distance, and `e` the drift per cell. Far from the goal, its lines are parabolas about the goal with their axis
//! along `v`. So the path turns towards `v`. It arrives along `v` if `e (r - <v, x>)` is well above 1 at the start.
//! Straight behind the goal, `e (r - <v, x>)` is 0, and the path arrives against `v`.

use super::planner::{found, grid, planner, run, scene};
use cplan::cspace::ZonedGrid;
use cplan::field::{Difference, Direction, Lines, Order, Relaxation};
use cplan::planner::EquationChoice;
use std::f64::consts::PI;

/// Number of cells along each axis. The distance from the middle to the walls is half a cell more, which is far enough.
const N: usize = 81;

/// Returns the path relative to the goal, in cells.
fn path(direction: f64, epsilon: f64, from: [i64; 2]) -> Vec<[f64; 2]> {
    let zoned = ZonedGrid::new(grid([N, N], [false; 2], vec![false; N * N]), &scene(Vec::new()));
    let middle = (N / 2) as i64;
    let cell = |[i, j]: [i64; 2]| ((middle + i) * N as i64 + middle + j) as usize;
    let equation = EquationChoice::Oriented {
        direction: Direction::of([direction.cos(), direction.sin()]).unwrap(),
        epsilon,
        difference: Difference::Central,
    };
    let relaxation = Relaxation::gauss_seidel(Order::Corners(Lines::Rows));
    let out = run(planner(equation, relaxation), &zoned, cell(from), cell([0, 0]));
    let points = found(&out).waypoints();
    let goal = points[points.len() - 1];
    points.iter().map(|p| [p[0] - goal[0], p[1] - goal[1]]).collect()
}

/// Returns the direction, as seen from the goal, of the place at which a path first comes within a distance of the
/// goal.
fn bearing(path: &[[f64; 2]], distance: f64) -> f64 {
    let far = path.iter().rposition(|p| p[0].hypot(p[1]) >= distance).expect("it starts farther away");
    let (a, b) = (path[far], path[far + 1]);
    // The piece is sampled finely, because distances along it are not linear.
    let on = (0..=1000).map(|k| f64::from(k) / 1000.0).map(|t| [0, 1].map(|k| a[k] + t * (b[k] - a[k])));
    let at = on.min_by(|p, q| {
        let off = |p: &[f64; 2]| (p[0].hypot(p[1]) - distance).abs();
        off(p).total_cmp(&off(q))
    });
    at.map_or(f64::NAN, |p| p[1].atan2(p[0]))
}

/// Returns the direction in which a path arrives, over its last one and a half cells.
fn arrival(direction: f64, epsilon: f64, from: [i64; 2]) -> f64 {
    bearing(&path(direction, epsilon, from), 1.5) + PI
}

/// Returns the size of the turn from one direction to another.
fn angle_between(a: f64, b: f64) -> f64 {
    ((a - b + PI).rem_euclid(2.0 * PI) - PI).abs()
}

/// Returns the quotient of Bessel functions `K1(x) / K0(x)`, from the integrals of `exp(-x cosh t) cosh(n t)`.
fn ratio(x: f64) -> f64 {
    let step = 1e-3;
    let terms = (0..12_000).map(|k| (f64::from(k) + 0.5) * step).map(|t| ((-x * (t.cosh() - 1.0)).exp(), t.cosh()));
    let (k0, k1) = terms.fold((0.0, 0.0), |(k0, k1), (e, cosh)| (k0 + e, k1 + e * cosh));
    k1 / k0
}

/// Returns the bearing that a path has in open space at this distance. Along a path, the angle `f` between `x` and `v`
/// changes by `sin f / (cos f + K1/K0)` for each factor `1 / e` of the distance.
fn expected_bearing(direction: f64, epsilon: f64, from: [i64; 2], distance: f64) -> f64 {
    let [x, y] = from.map(|k| k as f64);
    let (r, at) = (x.hypot(y), y.atan2(x));
    let side = (at - direction + PI).rem_euclid(2.0 * PI) - PI;
    let (mut f, steps) = (side.abs(), 4_000);
    let h = (r / distance).ln() / f64::from(steps);
    for k in 0..steps {
        let here = r * (-h * (f64::from(k) + 0.5)).exp();
        f = (f + h * f.sin() / (f.cos() + ratio(epsilon * here / 2.0))).min(PI);
    }
    direction + side.signum() * f
}

#[test]
fn paths_arrive_along_the_drift_unless_they_start_behind_the_goal() {
    let epsilon = 1.0;
    let starts = [[-16, 0], [-10, 9], [0, 14], [3, -13], [9, 10], [-7, -3]];
    let (mut along, mut others) = (0, 0);
    for from in starts {
        for degrees in [0_i32, 90, 180, 225] {
            let direction = f64::from(degrees).to_radians();
            let [x, y] = from.map(|k| k as f64);
            let behind = epsilon * (x.hypot(y) - x * direction.cos() - y * direction.sin());
            let arrives = arrival(direction, epsilon, from);
            let off = angle_between(arrives, direction);
            let straight = angle_between((-y).atan2(-x), direction);
            assert!(off <= straight + 0.2, "from {from:?}, {degrees} degrees: the path turns away from the drift");
            if behind >= 6.0 {
                along += 1;
                assert!(off < 25_f64.to_radians(), "from {from:?}, {degrees} degrees: {} off", off.to_degrees());
            }
            if behind < 1.0 {
                others += 1;
                assert!(off > 75_f64.to_radians(), "from {from:?}, {degrees} degrees: {} off", off.to_degrees());
            }
        }
    }
    assert!(along >= 12 && others >= 2, "{along} {others}");
}

/// Checks the example of docs/fields.md whose path does not arrive along `v`, and some other starts, whose paths do.
#[test]
fn path_bearings_agree_with_the_closed_form() {
    for (degrees, from) in [(180, [-7, -3]), (225, [-7, -3]), (0, [-7, -3]), (90, [-12, 0]), (0, [4, 12]), (0, [8, 4])]
    {
        let direction = f64::from(degrees).to_radians();
        let path = path(direction, 1.0, from);
        for distance in [5.0, 3.0] {
            let (ours, theory) = (bearing(&path, distance), expected_bearing(direction, 1.0, from, distance));
            assert!(
                angle_between(ours, theory) < 12_f64.to_radians(),
                "{degrees} degrees from {from:?}, at {distance}: {}, not {}",
                ours.to_degrees(),
                theory.to_degrees()
            );
        }
    }
}
