//! Approximates a curve by fewer points.

use cplan_planners::cspace::Grid;
use cplan_planners::planner::grid_path::Line;
use cplan_planners::planner::shortcut::{fewer_points, is_clear};

/// Returns a line through some of the points of a line, including its ends. Each omitted point is within `tolerance` (in cells)
/// of the segment that replaces it. New segments pass only through free cells. Computes about `n log n` distances for `n` points.
pub(crate) fn simplified(grid: &Grid, line: &[[f64; 2]], tolerance: f64) -> Line {
    fewer_points(line, |from, to| {
        let (a, b) = (line[from], line[to]);
        line[from + 1..to].iter().all(|&p| distance(p, a, b) <= tolerance) && is_clear(grid, a, b)
    })
}

/// Returns the distance between a point and a segment.
fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (d, r) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = d[0] * d[0] + d[1] * d[1];
    let t = if square > 0.0 { ((r[0] * d[0] + r[1] * d[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (r[0] - t * d[0]).hypot(r[1] - t * d[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_model::space::{JointRange, Topology};
    use cplan_planners::cspace::Proves;

    fn empty() -> Grid {
        let topology = Topology::new([JointRange::Interval { lower: 0.0, upper: 100.0 }; 2]);
        Grid { topology, proves: Proves::Sampled, cells: [100, 100], blocked: vec![false; 10_000] }
    }

    #[test]
    fn a_circle_keeps_as_many_points_as_the_tolerance_asks_for() {
        // A chord of an arc of angle `a` on a circle of radius 40 is at most 40 (1 - cos(a / 2)) from the arc.
        let circle: Line = (0..=2000)
            .map(|k| (f64::from(k) / 2000.0 * std::f64::consts::TAU).sin_cos())
            .map(|(sin, cos)| [50.0 + 40.0 * cos, 50.0 + 40.0 * sin])
            .collect();
        let kept = simplified(&empty(), &circle, 0.02);
        let needed = std::f64::consts::TAU / (2.0 * (1.0 - 0.02 / 40.0_f64).acos());
        assert!((kept.len() as f64 - 1.0 - needed).abs() < 2.0, "{} points, {needed} pieces", kept.len());
        assert_eq!((kept[0], kept[kept.len() - 1]), (circle[0], circle[2000]));
    }

    #[test]
    fn straight_lines_become_one_piece_unless_they_touch_a_wall() {
        let line: Line = (0..=50).map(|k| [10.5 + f64::from(k), 20.0]).collect();
        assert_eq!(simplified(&empty(), &line, 0.02).len(), 2);
        let mut grid = empty();
        grid.blocked[30 * 100 + 20] = true;
        let kept = simplified(&grid, &line, 0.02);
        assert!(kept.len() > 2 && kept.len() < 6, "{kept:?}");
    }
}
