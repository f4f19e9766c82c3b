//! Removes corners of a path. This makes the path a little longer, and the motion along it faster.
//!
//! Shortest paths follow obstacles in many short pieces. If a path turns to the same side at both ends of a piece, the pieces
//! before and after it can be extended until they meet. The new corner is farther from the obstacle, and the path has one corner
//! less.

use cplan_geometry::OpenList;
use cplan_judge::{CertifiedPath, Rejection, certify};
use cplan_model::Scene;
use cplan_model::space::{Configuration, Metric, Path, Topology};

/// Largest number of attempts to certify a path with fewer corners. Each attempt keeps the pieces whose removal brought the
/// refused path too near to an obstacle.
const MAX_ATTEMPTS: usize = 6;

/// Longest extension of a piece, as a multiple of the removed piece's length. Without it, pieces that meet at a small angle would
/// become very long.
const MAX_EXTENSION: f64 = 8.0;

/// Returns a certified path with fewer corners that is longer than `path` by at most `budget`. `None` if no corner can
/// be removed.
///
/// The pieces whose removal adds the least length are removed first. Costs `O(n log n)` for `n` corners, and one
/// certificate per attempt.
pub(super) fn fewer_corners(scene: &Scene, path: &Path, metric: Metric, budget: f64) -> Option<CertifiedPath> {
    let topology = scene.arm().topology();
    let mut too_near = Vec::new();
    for _ in 0..MAX_ATTEMPTS {
        let fewer = remove_pieces(&topology, path.waypoints(), metric, budget, &too_near);
        if fewer.len() == path.waypoints().len() {
            return None;
        }
        match certify(scene, Path::new(fewer)) {
            Ok(path) => return Some(path),
            Err(Rejection::TooClose(nearest) | Rejection::Undecided(nearest)) => too_near.push(nearest.at),
            Err(Rejection::OutOfLimits { .. }) => return None,
        }
    }
    None
}

/// A piece of a path, as an entry in the linked list of the pieces that remain.
struct Piece {
    before: usize,
    after: usize,
    /// Number of changes of the piece and its neighbours so far.
    version: u32,
    is_removed: bool,
}

/// Removes pieces and returns the remaining waypoints. Keeps a piece if its removal would lead past a configuration in
/// `too_near`.
fn remove_pieces(
    topology: &Topology,
    waypoints: &[Configuration],
    metric: Metric,
    budget: f64,
    too_near: &[Configuration],
) -> Vec<Configuration> {
    let mut at = waypoints.to_vec();
    let n = at.len();
    let mut left: Vec<Piece> =
        (0..n).map(|i| Piece { before: i.wrapping_sub(1), after: i + 1, version: 0, is_removed: false }).collect();
    // A piece has the index of its first corner.
    let offer = |at: &[Configuration], left: &[Piece], i: usize| {
        let (h, j) = (left[i].before, left[i].after);
        let k = left.get(j)?.after;
        if h >= n || k >= n {
            return None;
        }
        let corner = meeting([at[h], at[i], at[j], at[k]])?;
        let ends = [at[i], at[j], corner];
        if !topology.contains(corner) || too_near.iter().any(|q| is_near(*q, &ends)) {
            return None;
        }
        let longer = metric.norm(corner - at[i]) + metric.norm(at[j] - corner) - metric.norm(at[j] - at[i]);
        Some((longer.max(0.0), corner))
    };
    let mut open = OpenList::default();
    for i in 0..n {
        if let Some((longer, _)) = offer(&at, &left, i) {
            open.push(longer, (i, 0));
        }
    }
    let mut spent = 0.0;
    while let Some((longer, (i, version))) = open.pop() {
        if left[i].is_removed || left[i].version != version {
            continue;
        }
        if spent + longer > budget {
            break;
        }
        let Some((_, corner)) = offer(&at, &left, i) else { continue };
        spent += longer;
        at[i] = corner;
        let (h, j) = (left[i].before, left[i].after);
        let k = left[j].after;
        left[j].is_removed = true;
        left[i].after = k;
        left[k].before = i;
        let hh = left[h].before;
        for changed in [hh, h, i, k] {
            if changed < n {
                left[changed].version += 1;
                if let Some((longer, _)) = offer(&at, &left, changed) {
                    open.push(longer, (changed, left[changed].version));
                }
            }
        }
    }
    (0..n).filter(|&i| !left[i].is_removed).map(|i| at[i]).collect()
}

/// Returns the point where the line `a b` beyond `b` meets the line `d c` beyond `c`. `None` if they do not meet, or only far
/// away.
fn meeting([a, b, c, d]: [Configuration; 4]) -> Option<Configuration> {
    let (first, second, base) = (b - a, c - d, c - b);
    let cross = |u: Configuration, v: Configuration| u[0] * v[1] - u[1] * v[0];
    let turned = cross(first, second);
    let [along, back] = [cross(base, second) / turned, cross(base, first) / turned];
    let corner = b + first * along;
    let near = |from: Configuration| (corner - from).norm() <= MAX_EXTENSION * base.norm();
    (along >= 0.0 && back >= 0.0 && along.is_finite() && back.is_finite() && near(b) && near(c)).then_some(corner)
}

/// Returns true if a configuration is near some others: within their bounding box, widened by its own extent.
fn is_near(q: Configuration, others: &[Configuration; 3]) -> bool {
    (0..2).all(|k| {
        let (least, greatest) =
            others.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, g), at| (l.min(at[k]), g.max(at[k])));
        let slack = greatest - least;
        least - slack <= q[k] && q[k] <= greatest + slack
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_model::space::JointRange;
    use std::f64::consts::FRAC_PI_2;

    const WIDE: Topology = Topology::new([JointRange::Interval { lower: -2.0, upper: 2.0 }; 2]);

    /// Returns a quarter of a circle as `chords` chords, with a tangent line at each end.
    fn quarter(chords: usize) -> Vec<Configuration> {
        let at = |k: usize| {
            let (sin, cos) = (FRAC_PI_2 * k as f64 / chords as f64).sin_cos();
            Configuration::new(sin, cos)
        };
        let mut waypoints = vec![Configuration::new(-1.0, 1.0)];
        waypoints.extend((0..=chords).map(at));
        waypoints.push(Configuration::new(1.0, -1.0));
        waypoints
    }

    fn length(waypoints: &[Configuration]) -> f64 {
        Metric::Euclidean.length(&Path::new(waypoints.to_vec()))
    }

    #[test]
    fn an_arc_keeps_about_as_many_corners_as_the_budget_asks_for() {
        let arc = quarter(200);
        let mut before = arc.len();
        for budget in [1e-5, 1e-4, 1e-3, 1e-2] {
            let fewer = remove_pieces(&WIDE, &arc, Metric::Euclidean, budget, &[]);
            assert!(length(&fewer) <= length(&arc) + budget + 1e-12, "{budget}: {}", length(&fewer));
            // A tangent over an angle `a` is longer than its arc by about a^3 / 12. So the least number n of tangents within the
            // budget satisfies (pi / 2)^3 / (12 n^2) = budget. Greedy removal leaves fewer than twice as many.
            let least = (FRAC_PI_2.powi(3) / 12.0 / budget).sqrt();
            assert!((fewer.len() as f64) < 2.0 * least + 4.0 && fewer.len() < before, "{budget}: {}", fewer.len());
            before = fewer.len();
            // The path stays outside the circle that the arc follows.
            let inside = arc[1].norm() * (FRAC_PI_2 / 400.0).cos() - 1e-12;
            for ends in fewer.windows(2).filter(|ends| ends[0][0] >= 0.0 && ends[1][1] >= 0.0) {
                let across = (ends[0][0] * ends[1][1] - ends[0][1] * ends[1][0]).abs() / (ends[1] - ends[0]).norm();
                assert!(across >= inside, "{budget}: {across}");
            }
            assert_eq!((fewer[0], fewer[fewer.len() - 1]), (arc[0], arc[arc.len() - 1]));
        }
    }

    #[test]
    fn corners_stay_within_limits_and_clear() {
        let arc = quarter(8);
        let all = remove_pieces(&WIDE, &arc, Metric::Euclidean, 10.0, &[]);
        assert_eq!(all, [arc[0], Configuration::new(1.0, 1.0), arc[arc.len() - 1]]);
        let narrow = Topology::new([
            JointRange::Interval { lower: -2.0, upper: 1.01 },
            JointRange::Interval { lower: -2.0, upper: 1.0 },
        ]);
        assert!(remove_pieces(&narrow, &arc, Metric::Euclidean, 10.0, &[]).iter().all(|q| narrow.contains(*q)));
        // The corner where all pieces would meet is in an obstacle.
        let others = remove_pieces(&WIDE, &arc, Metric::Euclidean, 10.0, &[Configuration::new(0.999, 0.999)]);
        assert!(others.len() > 3 && !others.contains(&all[1]), "{others:?}");
    }

    #[test]
    fn a_zigzag_stays_unchanged() {
        let zigzag: Vec<_> = (0..9).map(|k| Configuration::new(0.2 * f64::from(k), f64::from(k % 2) * 0.3)).collect();
        assert_eq!(remove_pieces(&WIDE, &zigzag, Metric::Euclidean, 10.0, &[]), zigzag);
    }
}
