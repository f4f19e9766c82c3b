//! Runs algorithms of the sources as printed and as corrected, as plain loops. The page of errata names them.

use std::f64::consts::PI;

const N: usize = 12;

/// Returns a room with walls (1), a goal in its middle (0), and free cells at 0; and whether a cell is free.
fn room() -> (Vec<f64>, Vec<bool>) {
    let is_wall = |c: usize| [c / N, c % N].iter().any(|&k| k == 0 || k == N - 1);
    let goal = 5 * N + 4;
    let values = (0..N * N).map(|c| f64::from(u8::from(is_wall(c)))).collect();
    (values, (0..N * N).map(|c| !is_wall(c) && c != goal).collect())
}

/// Sweeps in rows; `new` gets the values and a cell.
fn swept(sweeps: usize, new: impl Fn(&[f64], usize) -> f64) -> Vec<f64> {
    let (mut p, free) = room();
    for _ in 0..sweeps {
        for c in (0..N * N).filter(|&c| free[c]) {
            p[c] = new(&p, c);
        }
    }
    p
}

fn sum(p: &[f64], c: usize) -> f64 {
    p[c - N] + p[c + N] + p[c - 1] + p[c + 1]
}

/// Returns the greatest `|value - mean of the neighbours|` of a free cell.
fn residual(p: &[f64]) -> f64 {
    let free = room().1;
    (0..N * N).filter(|&c| free[c]).fold(0.0, |most: f64, c| most.max((p[c] - sum(p, c) / 4.0).abs()))
}

#[test]
fn printed_over_relaxation_diverges_and_the_corrected_one_is_harmonic() {
    let w = 2.0 / (1.0 + (PI / N as f64).sin());
    let printed = swept(200, |p, c| p[c] - w * (sum(p, c) - 4.0 * p[c]) / 4.0);
    assert!(printed.iter().any(|value| value.is_nan() || value.abs() >= 1e9), "{:?}", &printed[N..2 * N]);
    let corrected = swept(200, |p, c| p[c] + w * (sum(p, c) - 4.0 * p[c]) / 4.0);
    assert!(residual(&corrected) < 1e-12);
    // Line 18 of tables 10, 11, 14 and 15, with a preference of 0. A factor of 0.5 lets it converge at all.
    for w in [0.5, 1.0] {
        let printed = swept(500, |p, c| w / 4.0 * (sum(p, c) - 4.0 * p[c]));
        assert!(residual(&printed) > 1e-3);
    }
}

/// Checks the sign of section 3.4 in a corridor along x, where `p = h + epsilon / 8 d` and `v = (1, 0)` give a sequence
/// with the quotient `q` of differences.
#[test]
fn the_algorithm_of_preferences_solves_the_equation_with_a_plus() {
    let epsilon = 0.5;
    // p[k] = (p[k+1] + p[k-1] + 2 p[k]) / 4 + epsilon / 8 (p[k+1] - p[k-1]): values are equal across the corridor.
    let mut p: Vec<f64> = (0..20).map(f64::from).collect();
    for _ in 0..20_000 {
        for k in 1..19 {
            p[k] = (p[k + 1] + p[k - 1] + 2.0 * p[k]) / 4.0 + epsilon / 8.0 * (p[k + 1] - p[k - 1]);
        }
    }
    for k in 1..19 {
        let (second, slope) = (p[k + 1] - 2.0 * p[k] + p[k - 1], (p[k + 1] - p[k - 1]) / 2.0);
        assert!((second + epsilon * slope).abs() < 1e-9, "the equation with +");
        assert!((second - epsilon * slope).abs() > 1e-3, "the equation with -");
    }
}

#[test]
fn printed_weights_of_oriented_fields_are_not_those_of_their_equations() {
    for degrees in [10.0_f64, 75.0, 200.0, 290.0] {
        let angle = degrees.to_radians();
        let (vx, vy, epsilon) = (angle.cos(), angle.sin(), 0.5);
        let lambda = epsilon / 2.0;
        // Algorithm 3: right, left, top, bottom.
        let weights = |bottom: f64| [1.0 + lambda * vx, 1.0 - lambda * vx, 1.0 + lambda * vy, 1.0 - lambda * bottom];
        let total = |weights: [f64; 4]| weights.iter().sum::<f64>();
        assert!((total(weights(vx)) - 4.0).abs() > 0.05 && (total(weights(vy)) - 4.0).abs() < 1e-12);
        // Algorithm 4: the weights in the direction of v, which equation 3.11 states.
        let [printed_y, printed_x] = [vy.sin().abs(), vx.cos().abs()].map(|part| 1.0 + epsilon * part);
        let [y, x] = [vy.abs(), vx.abs()].map(|part| 1.0 + epsilon * part);
        assert!((printed_y - y).abs() + (printed_x - x).abs() > 0.05, "{degrees}");
    }
}

#[test]
fn the_printed_wave_labels_only_the_goal() {
    let labeled = |first: usize| {
        let free = room().1;
        let (goal, most) = (5 * N + 4, i64::MAX);
        let mut label: Vec<i64> = free.iter().map(|&free| if free { -most } else { most }).collect();
        label[goal] = 0;
        let mut lists = vec![vec![goal]];
        let mut i = first;
        while lists.get(i).is_some_and(|list| !list.is_empty()) {
            lists.push(Vec::new());
            for q in lists[i].clone() {
                for next in [q - N, q + N, q - 1, q + 1] {
                    if label[next] == -most {
                        label[next] = i as i64 + 1;
                        lists[i + 1].push(next);
                    }
                }
            }
            i += 1;
        }
        label.iter().filter(|label| (0..most).contains(*label)).count()
    };
    assert_eq!((labeled(1), labeled(0)), (1, (N - 2) * (N - 2)));
}

#[test]
fn the_page_of_errata_names_what_is_tested() {
    let page = include_str!("../../../docs/errata.md");
    for row in [
        "| tables 6 and 7, line 13 of tables 10, 11, 14 and 15 *",
        "| tables 10, 11, 14 and 15, line 18 *",
        "| 3.4 *",
        "| algorithm 3, line 14; algorithm 5, line 27 *",
        "| algorithm 4, lines 5 and 6; algorithm 6 *",
        "| 6.3.3, procedure *Manhattan* *",
    ] {
        assert!(page.contains(row), "{row}");
    }
    assert_eq!(page.lines().filter(|line| line.contains(" * |")).count(), 6);
}
