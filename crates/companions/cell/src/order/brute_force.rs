//! Waits between legs against a brute-force search over whole times.

use super::{Diagram, Rectangle, Waits};

/// Returns a diagram of several legs with rectangles at whole times, each within a pair of legs.
fn random_legs(dice: &mut cplan_cases::dice::Dice) -> Diagram {
    let legs = [0, 1].map(|_| {
        let mut times = vec![0.0];
        for _ in 0..2 + dice.below(3_usize) {
            times.push(times[times.len() - 1] + 2.0 + dice.below(4_u32) as f64);
        }
        times
    });
    let mut rectangles = Vec::new();
    for _ in 0..dice.below(6_u32) {
        let of = [0, 1].map(|arm| dice.below(legs[arm].len() - 1));
        let times = [0, 1].map(|arm| {
            let [from, to] = [legs[arm][of[arm]], legs[arm][of[arm] + 1]];
            let begin = from + dice.below((to - from) as u32) as f64;
            [begin, begin + 1.0 + dice.below((to - begin) as u32) as f64]
        });
        rectangles.push(Rectangle { times, legs: of, is_collision: true });
    }
    Diagram { legs, rectangles }
}

/// Returns the least time to the end of both motions among all monotone routes along whole times. Arms wait between legs.
fn brute_force(diagram: &Diagram) -> Option<f64> {
    let [n, m] = diagram.legs.each_ref().map(|legs| legs[legs.len() - 1] as usize);
    let covers = |i: f64, j: f64| {
        let is_in = |[from, to]: [f64; 2], at: f64| from < at && at < to;
        diagram.rectangles.iter().any(|r| is_in(r.times[0], i) && is_in(r.times[1], j))
    };
    // Beyond the border of the diagram, everything is blocked.
    let is_blocked = |i: f64, j: f64| i < 0.0 || j < 0.0 || i > n as f64 || j > m as f64 || covers(i, j);
    let is_stop = |arm: usize, at: usize| diagram.legs[arm].contains(&(at as f64));
    let mut least = vec![vec![f64::INFINITY; m + 1]; n + 1];
    least[0][0] = 0.0;
    for (i, j) in (0..=n).flat_map(|i| (0..=m).map(move |j| (i, j))) {
        let (x, y, here) = (i as f64, j as f64, least[i][j]);
        // A route through the only common point of two rectangles does not count.
        let is_pinched = is_blocked(x - 0.5, y + 0.5) && is_blocked(x + 0.5, y - 0.5) && (i, j) != (0, 0);
        let mut offer = |i: usize, j: usize| least[i][j] = least[i][j].min(here + 1.0);
        if i < n && j < m && !is_blocked(x + 0.5, y + 0.5) && !is_pinched {
            offer(i + 1, j + 1);
        }
        if i < n && is_stop(1, j) && !(is_blocked(x + 0.5, y - 0.5) && is_blocked(x + 0.5, y + 0.5)) {
            offer(i + 1, j);
        }
        if j < m && is_stop(0, i) && !(is_blocked(x - 0.5, y + 0.5) && is_blocked(x + 0.5, y + 0.5)) {
            offer(i, j + 1);
        }
    }
    Some(least[n][m]).filter(|least| least.is_finite())
}

#[test]
fn waits_between_legs_are_the_shortest_that_brute_force_finds() {
    let (mut delayed, mut blocked) = (0, 0);
    for seed in cplan_cases::seeds(200) {
        let diagram = random_legs(&mut cplan_cases::dice::Dice::new(seed));
        let ends = diagram.legs.each_ref().map(|legs| legs[legs.len() - 1]);
        let best = brute_force(&diagram);
        let found = diagram.route(Waits::BetweenLegs, 0.0).and_then(|route| diagram.departures(&route, 0.0));
        let lasts = found.as_ref().map(|departures| {
            let end = |arm: usize| {
                let last = diagram.legs[arm].len() - 2;
                departures[arm][last] + ends[arm] - diagram.legs[arm][last]
            };
            end(0).max(end(1))
        });
        match (lasts, best) {
            (Some(lasts), Some(best)) => {
                assert!((lasts - best).abs() < 0.05, "seed {seed}: {lasts} instead of {best}, {diagram:?}");
                delayed += usize::from(best > ends[0].max(ends[1]));
            }
            (None, None) => blocked += 1,
            other => panic!("seed {seed}: {other:?}, {diagram:?}"),
        }
    }
    if cplan_cases::uses_default_cases() {
        assert!(delayed >= 15 && blocked >= 15, "{delayed} {blocked}");
    }
}
