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

/// Returns the least time to the end of both motions among all monotone routes along multiples of `1 / parts`. Arms wait
/// between legs. All rectangles are grown by `growth`.
fn brute_force(diagram: &Diagram, parts: usize, growth: f64) -> Option<f64> {
    let step = 1.0 / parts as f64;
    let half = step / 2.0;
    let ends = diagram.legs.each_ref().map(|legs| legs[legs.len() - 1]);
    let [n, m] = ends.map(|end| end as usize * parts);
    let covers = |i: f64, j: f64| {
        let is_in = |[from, to]: [f64; 2], at: f64| from - growth < at && at < to + growth;
        diagram.rectangles.iter().any(|r| is_in(r.times[0], i) && is_in(r.times[1], j))
    };
    // Beyond the border of the diagram, everything is blocked.
    let is_blocked = |i: f64, j: f64| i < 0.0 || j < 0.0 || i > ends[0] || j > ends[1] || covers(i, j);
    let is_stop =
        |arm: usize, at: usize| at.is_multiple_of(parts) && diagram.legs[arm].contains(&((at / parts) as f64));
    let mut least = vec![vec![f64::INFINITY; m + 1]; n + 1];
    least[0][0] = 0.0;
    for (i, j) in (0..=n).flat_map(|i| (0..=m).map(move |j| (i, j))) {
        let (x, y, here) = (i as f64 * step, j as f64 * step, least[i][j]);
        // A route through the only common point of two rectangles does not count.
        let is_pinched = is_blocked(x - half, y + half) && is_blocked(x + half, y - half) && (i, j) != (0, 0);
        let mut offer = |i: usize, j: usize| least[i][j] = least[i][j].min(here + step);
        if i < n && j < m && !is_blocked(x + half, y + half) && !is_pinched {
            offer(i + 1, j + 1);
        }
        if i < n && is_stop(1, j) && !(is_blocked(x + half, y - half) && is_blocked(x + half, y + half)) {
            offer(i + 1, j);
        }
        if j < m && is_stop(0, i) && !(is_blocked(x - half, y + half) && is_blocked(x + half, y + half)) {
            offer(i, j + 1);
        }
    }
    Some(least[n][m]).filter(|least| least.is_finite())
}

#[test]
fn waits_between_legs_are_the_shortest_that_brute_force_finds() {
    let (mut delayed, mut blocked, mut narrow, mut all) = (0, 0, 0, 0);
    for seed in cplan_cases::seeds(200) {
        let diagram = random_legs(&mut cplan_cases::dice::Dice::new(seed));
        let ends = diagram.legs.each_ref().map(|legs| legs[legs.len() - 1]);
        let best = brute_force(&diagram, 1, 0.0);
        all += 1;
        let found = diagram.route(Waits::BetweenLegs, 0.0).and_then(|route| diagram.departures(&route, 0.0));
        let lasts = found.as_ref().map(|departures| {
            let end = |arm: usize| {
                let last = diagram.legs[arm].len() - 2;
                departures[arm][last] + ends[arm] - diagram.legs[arm][last]
            };
            end(0).max(end(1))
        });
        match (lasts, best) {
            (Some(lasts), Some(best)) if (lasts - best).abs() < 0.05 => {
                delayed += usize::from(best > ends[0].max(ends[1]));
            }
            (None, None) => blocked += 1,
            // The best route passes through a corridor without width, which departures with a margin cannot use.
            (lasts, Some(best)) if lasts.is_none_or(|lasts| lasts > best) => {
                let wide = brute_force(&diagram, 8, 0.125).unwrap_or(f64::INFINITY);
                let lasts = lasts.unwrap_or(f64::INFINITY);
                assert!(lasts <= wide + 0.05, "seed {seed}: {lasts} instead of {best} to {wide}, {diagram:?}");
                narrow += 1;
            }
            other => panic!("seed {seed}: {other:?}, {diagram:?}"),
        }
    }
    assert!(20 * narrow <= all, "{narrow} corridors without width in {all} diagrams");
    if cplan_cases::uses_default_cases() {
        assert!(delayed >= 15 && blocked >= 15, "{delayed} {blocked}");
    }
}
