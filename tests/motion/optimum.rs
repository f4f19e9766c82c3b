//! Durations of motions, compared with an optimum on a fine grid. Its code shares nothing with the library's.

use crate::{certified, curve, empty, limits, waypoints};
use cplan::check::CertifiedCurve;
use cplan::model::Scene;
use cplan::motion::{Limits, TipSpeed, time};
use cplan::space::Configuration;
use cplan_testkit::arms;
use cplan_testkit::scenes::{self, q};
use proptest::prelude::*;

/// A path with its first and second derivative with respect to a parameter, at equal steps of that parameter.
struct Grid {
    step: f64,
    nodes: Vec<[Configuration; 3]>,
}

/// Returns grids along a curve, computed from its waypoints and radii, with `per_unit` steps per unit of length. If the
/// motion has to stop, there are several grids.
fn grids(curve: &CertifiedCurve, per_unit: f64) -> Vec<Vec<Grid>> {
    let (points, radii) = (curve.curve().path().waypoints(), curve.curve().radii());
    let mut runs = vec![vec![]];
    for i in 0..points.len() - 1 {
        let leg = points[i + 1] - points[i];
        let along = leg / leg.norm();
        let length = leg.norm() - radii[i] - radii[i + 1];
        let steps = (length * per_unit).ceil().max(200.0) as usize;
        let run = runs.last_mut().unwrap();
        let place = |j: usize| points[i] + along * (radii[i] + length * j as f64 / steps as f64);
        let nodes = (0..=steps).map(|j| [place(j), along, q(0.0, 0.0)]).collect();
        run.push(Grid { step: length / steps as f64, nodes });
        let r = radii[i + 1];
        if r > 0.0 {
            let next = points[i + 2] - points[i + 1];
            let onward = next / next.norm();
            let steps = (2.0 * r * per_unit).ceil().max(400.0) as usize;
            let node = |j: usize| {
                let u = j as f64 / steps as f64;
                let (from, to) = (points[i + 1] - along * r, points[i + 1] + onward * r);
                let at = from * ((1.0 - u) * (1.0 - u)) + points[i + 1] * (2.0 * u * (1.0 - u)) + to * (u * u);
                [at, along * (1.0 - u) + onward * u, (onward - along) / (2.0 * r)]
            };
            run.push(Grid { step: 2.0 * r / steps as f64, nodes: (0..=steps).map(node).collect() });
        } else if i + 2 < points.len() {
            runs.push(vec![]);
        }
    }
    runs
}

/// Returns the possible accelerations of the parameter at a node, as a range, for a squared speed `z`. Returns `None`
/// if the joints cannot follow the path at that speed.
fn acceleration_range([at, first, second]: [Configuration; 3], z: f64, limits: &Limits) -> Option<[f64; 2]> {
    let mut range = [f64::NEG_INFINITY, f64::INFINITY];
    if let Some(tip) = limits.tip {
        // Central differences: the tip's velocity by the parameter.
        let step = 1e-6;
        let way = (tip.arm.tip_at(at + first * step) - tip.arm.tip_at(at - first * step)).norm() / (2.0 * step);
        if way * way * z > tip.speed * tip.speed {
            return None;
        }
    }
    for k in 0..2 {
        if first[k] * first[k] * z > limits.velocity[k] * limits.velocity[k] {
            return None;
        }
        let rest = [-limits.acceleration[k] - second[k] * z, limits.acceleration[k] - second[k] * z];
        if first[k] == 0.0 {
            if rest[0] > 0.0 || rest[1] < 0.0 {
                return None;
            }
            continue;
        }
        let bounds = rest.map(|r| r / first[k]);
        range = [range[0].max(bounds[0].min(bounds[1])), range[1].min(bounds[0].max(bounds[1]))];
    }
    (range[0] <= range[1]).then_some(range)
}

/// Returns by bisection the greatest value for which `good` is true. `good` must be true below some limit, and false
/// above it.
fn greatest_by_bisection(good: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 1e6);
    for _ in 0..80 {
        let middle = (low + high) / 2.0;
        if good(middle) { low = middle } else { high = middle }
    }
    low
}

/// Returns the least time along the curve. Computes the controllable squared speeds backwards, and then the greatest of
/// them forwards.
fn optimum(curve: &CertifiedCurve, limits: &Limits, per_unit: f64) -> f64 {
    let mut total = 0.0;
    for run in grids(curve, per_unit) {
        // Steps with the node at which each begins; the last node of one grid is the first of the next.
        let steps: Vec<(f64, [Configuration; 3])> = run
            .iter()
            .flat_map(|grid| grid.nodes[..grid.nodes.len() - 1].iter().map(|node| (grid.step, *node)))
            .collect();
        let mut most = vec![0.0; steps.len() + 1];
        for (i, &(step, node)) in steps.iter().enumerate().rev() {
            most[i] = greatest_by_bisection(|z| {
                acceleration_range(node, z, limits).is_some_and(|[least, greatest]| {
                    z + 2.0 * step * least <= most[i + 1] && z + 2.0 * step * greatest >= 0.0
                })
            });
        }
        let mut z = 0.0;
        for (i, &(step, node)) in steps.iter().enumerate() {
            let greatest = acceleration_range(node, z, limits).map_or(0.0, |range| range[1]);
            let next = (z + 2.0 * step * greatest).min(most[i + 1]).max(0.0);
            total += 2.0 * step / (z.sqrt() + next.sqrt());
            z = next;
        }
    }
    total
}

fn duration(scene: &Scene, curve: impl Into<CertifiedCurve>) -> f64 {
    time(curve, &Limits::from(&scene.arm().joints), 0.01).unwrap().trajectory.duration()
}

/// Largest accepted ratio of the time of a random motion to the least time. The worst of 20 480 motions has the ratio
/// 1.019.
const MOST: f64 = 1.03;

/// Waypoints, limits of velocity and of acceleration, and radius of blends.
type Case = (&'static [[f64; 2]], [f64; 2], [f64; 2], f64);

/// Paths with right angles, gentle turns, hairpins, and short segments between long ones. In some, one joint is far
/// slower than the other.
const PATHS: [Case; 12] = [
    (&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [2.0, 3.0], [8.0, 12.0], 0.3),
    (&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [2.0, 3.0], [8.0, 12.0], 0.01),
    (&[[0.0, 0.0], [1.0, 0.2], [2.0, 0.0], [3.0, 0.3]], [2.0, 3.0], [8.0, 12.0], 0.4),
    (&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.1]], [1.0, 1.0], [4.0, 4.0], 0.3),
    (&[[0.0, 0.0], [1.0, 0.0], [0.3, 0.0]], [1.0, 1.0], [4.0, 4.0], 0.2),
    (&[[0.0, 0.0], [1.0, 0.0], [1.05, 0.05], [1.05, 1.0]], [2.0, 2.0], [5.0, 5.0], 1.0),
    (&[[0.0, 0.0], [1.0, 0.7], [0.2, 1.5], [-1.0, 1.0], [-1.5, -0.5]], [0.5, 3.0], [1.0, 20.0], 1.0),
    (&[[0.0, 0.0], [0.3, 0.0], [0.5, 0.2], [0.55, 0.5], [0.4, 0.8], [0.0, 0.9]], [2.0, 2.0], [9.0, 6.0], 1.0),
    (&[[0.0, 0.0], [2.0, 1.0], [2.5, -1.0], [-1.0, 0.5]], [10.0, 10.0], [3.0, 2.0], 1.0),
    (&[[0.0, 0.0], [0.02, 0.0], [0.02, 3.0], [0.0, 3.0]], [1.0, 2.0], [2.0, 30.0], 1.0),
    (&[[0.0, 0.0], [1.0, 1.0], [2.0, 1.0], [3.0, 0.0], [4.0, 0.0], [4.0, 2.0]], [1.5, 1.5], [40.0, 40.0], 1.0),
    (&[[0.5, 0.5], [0.4, 1.4], [0.45, 1.5], [1.3, 1.6], [1.4, 1.5], [1.5, 0.3]], [2.0, 3.0], [8.0, 12.0], 0.04),
];

#[test]
fn motions_are_within_a_hundredth_of_the_optimum() {
    for (i, (waypoints, velocity, acceleration, radius)) in PATHS.iter().enumerate() {
        let scene = empty(*velocity, *acceleration);
        let curve = curve(&scene, waypoints, *radius);
        assert!(
            curve.curve().radii().iter().filter(|radius| **radius > 0.0).count() == waypoints.len() - 2,
            "path {i}"
        );
        let limits = Limits::from(&scene.arm().joints);
        let [coarse, fine] = [500.0, 2000.0].map(|per_unit| optimum(&curve, &limits, per_unit));
        assert!((coarse - fine).abs() < 3e-3 * fine, "path {i}: the oracle itself is off: {coarse} {fine}");
        let took = duration(&scene, curve);
        assert!(took >= fine * (1.0 - 1e-3) && took <= fine * 1.005, "path {i}: {took} s, at least {fine} s");
        let stopping = duration(&scene, certified(&scene, waypoints));
        assert!(took < stopping, "path {i}: {took} s, with stops {stopping} s");
    }
}

#[test]
fn straight_motions_are_bang_bang() {
    // A distance of 1 m at 2 m/s2 and 0.5 m/s: top speed is reached after 0.25 s and 0.0625 m.
    let scene = empty([0.5, 0.5], [2.0, 2.0]);
    assert!((duration(&scene, curve(&scene, &[[0.0, 0.0], [1.0, 0.0]], 1.0)) - 2.25).abs() < 1e-12);
    // A waypoint at which the path does not turn costs almost nothing.
    let split = duration(&scene, curve(&scene, &[[0.0, 0.0], [0.4, 0.0], [1.0, 0.0]], 1.0));
    assert!((2.25..2.25 * 1.01).contains(&split), "{split}");
    assert!(duration(&scene, certified(&scene, &[[0.0, 0.0], [0.4, 0.0], [1.0, 0.0]])) > 2.49);
}

/// Checks a limit on the tip's speed. The program applies the limit to each part of the curve separately, which loses a
/// little time on straight pieces.
#[test]
fn a_slow_tip_is_as_fast_as_it_may() {
    for (kind, arm) in arms::all_kinds().into_iter().enumerate() {
        let scene = scenes::scene(arm, vec![]);
        let curve = curve(&scene, &[[-0.6, 0.2], [0.4, 0.7], [0.9, -0.1]], f64::INFINITY);
        for speed in [0.1, 0.4, 100.0] {
            let tip = Some(TipSpeed::new(scene.arm(), speed));
            let limits = Limits { tip, ..Limits::from(&scene.arm().joints) };
            for curve in [curve.clone(), curve.clone().without(1)] {
                let timed = time(curve.clone(), &limits, 0.002).unwrap();
                let (took, least) = (timed.trajectory.duration(), optimum(&timed.curve, &limits, 1000.0));
                assert!(took >= 0.999 * least && took <= 1.02 * least, "kind {kind} at {speed}: {took} {least}");
                let rows = |rows: &[[f64; 2]]| rows.iter().map(|row| q(row[0], row[1])).collect::<Vec<_>>();
                let (at, rate) = (rows(&timed.trajectory.position), rows(&timed.trajectory.velocity));
                let step = 1e-6;
                let moved = |(at, rate): (&Configuration, &Configuration)| {
                    (scene.arm().tip_at(at + rate * step) - scene.arm().tip_at(at - rate * step)).norm() / (2.0 * step)
                };
                let fastest = at.iter().zip(&rate).map(moved).fold(0.0, f64::max);
                assert!(fastest <= speed * (1.0 + 1e-6), "kind {kind} at {speed}: {fastest}");
                assert!(speed > 1.0 || fastest > 0.95 * speed, "kind {kind} at {speed}: {fastest}");
            }
        }
    }
}

proptest! {
    #![proptest_config(cplan_cases::cases(128))]

    #[test]
    fn blends_are_never_slower_than_stops(
        waypoints in waypoints(), [velocity, acceleration] in limits(), radius in -3.0..0.5_f64,
    ) {
        let scene = empty(velocity, acceleration);
        let stopping = duration(&scene, certified(&scene, &waypoints));
        let blended = duration(&scene, curve(&scene, &waypoints, 10f64.powf(radius)));
        prop_assert!(blended <= stopping * (1.0 + 1e-12), "{blended} {stopping}");
    }

    #[test]
    fn motions_on_random_paths_are_near_the_optimum(waypoints in waypoints(), [velocity, acceleration] in limits()) {
        let scene = empty(velocity, acceleration);
        let timed = time(curve(&scene, &waypoints, 10.0), &Limits::from(&scene.arm().joints), 0.01).unwrap();
        let least = |per_unit| optimum(&timed.curve, &Limits::from(&scene.arm().joints), per_unit);
        let took = timed.trajectory.duration();
        let close = |least: f64| took <= least * MOST && took >= least * 0.995;
        // If limits differ strongly, coarse steps make the comparison exact only to a hundredth.
        prop_assert!(close(least(300.0)) || close(least(3000.0)), "{took} {} {:?}", least(3000.0), timed.curve.curve().radii());
    }
}
