//! Finds the nearest obstacle of every cell, by an exact Euclidean distance transform.

use super::Limits;
use cplan_planners::cspace::Grid;

/// Returns, for every cell, the displacement from its centre to the centre of the nearest blocked cell, radians or metres; for
/// continuous joints, in the shorter direction. It is zero for a blocked cell, and infinite if no cell is blocked. With
/// [`Limits::High`], cells beyond the limits of intervals are also blocked.
///
/// Exact up to rounding. Computed first along rows, then by the lower envelope of parabolas along columns (Felzenszwalb,
/// Huttenlocher 2012). Linear in the number of cells.
pub fn nearest_obstacles(grid: &Grid, limits: Limits) -> Vec<[f64; 2]> {
    let [rows, columns] = grid.cells;
    let step = grid.step();
    let solid = grid.topology.ranges.map(|axis| !axis.is_circle() && limits == Limits::High);
    let wraps = grid.topology.ranges.map(|axis| axis.is_circle());
    let along: Vec<Vec<Option<i64>>> =
        grid.blocked.chunks_exact(columns).map(|row| steps_in_row(row, wraps[1], solid[1])).collect();
    let mut nearest = vec![[f64::INFINITY; 2]; rows * columns];
    let mut envelope = Envelope::default();
    for j in 0..columns {
        envelope.clear();
        let n = rows as i64;
        let (first, last) = if wraps[0] { (-n, 2 * n) } else { (-1, n + 1) };
        for i in first..last {
            let inside = (0..n).contains(&i) || wraps[0];
            let offset = if inside { along[i.rem_euclid(n) as usize][j] } else { solid[0].then_some(0) };
            if let Some(offset) = offset {
                // Heights are in units of the squared step between rows.
                let height = offset as f64 * step[1] / step[0];
                envelope.add(Site { at: i, height: height * height, offset });
            }
        }
        for (i, site) in envelope.lowest(rows) {
            nearest[i * columns + j] = [(site.at - i as i64) as f64 * step[0], site.offset as f64 * step[1]];
        }
    }
    nearest
}

/// Returns, for each cell of a row, the number of steps to the nearest blocked cell in the row; of two equally near ones, that
/// with the lower index. `None` if no cell of the row is blocked.
fn steps_in_row(row: &[bool], wraps: bool, solid: bool) -> Vec<Option<i64>> {
    let n = row.len() as i64;
    let blocked = |j: i64| match (0..n).contains(&j) {
        true => row[j as usize],
        false => {
            if wraps {
                row[j.rem_euclid(n) as usize]
            } else {
                solid
            }
        }
    };
    let mut nearest: Vec<Option<i64>> = vec![None; row.len()];
    // A circle is scanned more than once, so that blocked cells across the seam are known.
    let (first, last) = if wraps { (-n, 2 * n) } else { (-1, n + 1) };
    let mut pass = |places: &mut dyn Iterator<Item = i64>| {
        let mut seen = None;
        for j in places {
            seen = if blocked(j) { Some(j) } else { seen };
            if let (Some(seen), true) = (seen, (0..n).contains(&j)) {
                let place = &mut nearest[j as usize];
                let steps = seen - j;
                *place = Some(place.filter(|other| other.abs() <= steps.abs()).unwrap_or(steps));
            }
        }
    };
    pass(&mut (first..last));
    pass(&mut (first..last).rev());
    nearest
}

/// The parabola `(x - at)^2 + height`.
#[derive(Clone, Copy)]
struct Site {
    at: i64,
    height: f64,
    offset: i64,
}

/// The lower envelope of parabolas of the same shape at different positions.
#[derive(Default)]
struct Envelope {
    sites: Vec<Site>,
    /// For each parabola, the beginning of the range in which it is lowest.
    from: Vec<f64>,
}

impl Envelope {
    fn clear(&mut self) {
        self.sites.clear();
        self.from.clear();
    }

    /// Adds a parabola to the right of all others.
    fn add(&mut self, site: Site) {
        let mut from = f64::NEG_INFINITY;
        while let Some(last) = self.sites.last() {
            from = crossing(last, &site);
            if self.from.last().is_some_and(|&begin| from > begin) {
                break;
            }
            self.sites.pop();
            self.from.pop();
            from = f64::NEG_INFINITY;
        }
        self.sites.push(site);
        self.from.push(from);
    }

    /// Iterates over the places `0..n`, with the lowest parabola at each. Empty if there are no parabolas.
    fn lowest(&self, n: usize) -> impl Iterator<Item = (usize, Site)> + '_ {
        let mut k = 0;
        (0..n).filter_map(move |i| {
            while self.from.get(k + 1).is_some_and(|&begin| begin <= i as f64) {
                k += 1;
            }
            self.sites.get(k).map(|&site| (i, site))
        })
    }
}

/// Returns the place from which on `b` is lower than `a`. `b` is to the right of `a`.
fn crossing(a: &Site, b: &Site) -> f64 {
    let (x, y) = (a.at as f64, b.at as f64);
    0.5 * ((b.height - a.height) / (y - x) + (x + y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_model::space::{JointRange, Topology};
    use cplan_planners::cspace::Proves;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cplan_cases::cases(300))]

        /// Compares the distances with the least one over all pairs of cells and their copies.
        #[test]
        fn distances_are_those_to_the_nearest_of_all_blocked_cells(
            (rows, columns, blocked) in (1..9_usize, 1..9_usize).prop_flat_map(|(rows, columns)| {
                (Just(rows), Just(columns), proptest::collection::vec(proptest::bool::weighted(0.15), rows * columns))
            }),
            circles in any::<[bool; 2]>(),
            high in any::<bool>(),
        ) {
            let axis = |circle: bool, upper: f64| match circle {
                true => JointRange::Circle,
                false => JointRange::Interval { lower: -1.0, upper },
            };
            let topology = Topology::new([axis(circles[0], 2.5), axis(circles[1], 0.3)]);
            let grid = Grid { topology, proves: Proves::Sampled, cells: [rows, columns], blocked };
            let limits = if high { Limits::High } else { Limits::Reflecting };
            let step = grid.step();
            let found = nearest_obstacles(&grid, limits);
            let turns = |circle: bool| if circle { -1..=1_i64 } else { 0..=0 };
            for (cell, [a, b]) in found.into_iter().enumerate() {
                let at = [(cell / columns) as i64, (cell % columns) as i64];
                let mut least = f64::INFINITY;
                for i in -1..=rows as i64 {
                    for j in -1..=columns as i64 {
                        let inside = [(0..rows as i64).contains(&i), (0..columns as i64).contains(&j)];
                        let beyond = [0, 1].map(|k| !inside[k] && !circles[k] && high);
                        let is_blocked = match inside {
                            [true, true] => grid.blocked[i as usize * columns + j as usize],
                            _ => beyond.contains(&true),
                        };
                        for u in turns(circles[0]) {
                            for v in turns(circles[1]) {
                                let there = [i + u * rows as i64, j + v * columns as i64];
                                let d = [0, 1].map(|k| (there[k] - at[k]) as f64 * step[k]);
                                if is_blocked {
                                    least = least.min(d[0].hypot(d[1]));
                                }
                            }
                        }
                    }
                }
                prop_assert!(
                    a.hypot(b) == least || (a.hypot(b) - least).abs() < 1e-12 * least,
                    "cell {cell}: {a}, {b} against {least}"
                );
            }
        }
    }
}
