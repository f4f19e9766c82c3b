//! Finds obstacles that overlap in a layout.

use cplan_geometry::{Bounds, BoxTree, Convex, separation};
use cplan_model::Obstacle;

/// Depth up to which obstacles count as touching, in metres. It covers the rounding of numbers in files and of moved shapes.
const TOUCHING_DEPTH: f64 = 1e-9;

/// Describes two obstacles that overlap in the layout (`now`), but not in the files (`before`). Only pairs with an
/// obstacle that differs from the files are examined.
pub(super) fn overlap(before: &[Obstacle], now: &[Obstacle]) -> Option<String> {
    let differs = |k: usize| before.get(k) != Some(&now[k]);
    let moved: Vec<usize> = (0..now.len()).filter(|&k| differs(k)).collect();
    // Often a study moves only the robot. Then there are no boxes to compute.
    let around: Vec<Bounds> = if moved.is_empty() { Vec::new() } else { now.iter().map(bounds).collect() };
    for (done, &moved_one) in moved.iter().enumerate() {
        for other in (0..now.len()).filter(|k| !moved[..=done].contains(k)) {
            let files = before.get(moved_one).zip(before.get(other));
            let is_new = || files.is_none_or(|(a, b)| !are_in_each_other(a, b));
            if meet(&around[moved_one], &around[other]) && are_in_each_other(&now[moved_one], &now[other]) && is_new() {
                return Some(format!("\"{}\" overlaps \"{}\"", now[moved_one].name, now[other].name));
            }
        }
    }
    None
}

/// Returns true if two obstacles have more than boundary points in common at some height, and neither lies on top of the other.
fn are_in_each_other(a: &Obstacle, b: &Obstacle) -> bool {
    if !(a.heights.object_definitely_meets(b.heights) && b.heights.object_definitely_meets(a.heights)) {
        return false;
    }
    // Maps have many pieces, so use a tree of boxes.
    let tree = BoxTree::new(b.pieces.iter().map(Convex::bounds).collect());
    let mut near = Vec::new();
    a.pieces.iter().any(|piece| {
        near.clear();
        tree.meeting(&piece.bounds(), &mut near);
        near.iter().any(|&k| separation(piece, &b.pieces[k as usize]).distance < -TOUCHING_DEPTH)
    })
}

fn bounds(obstacle: &Obstacle) -> Bounds {
    let none = [[f64::INFINITY; 2].into(), [f64::NEG_INFINITY; 2].into()];
    let boxes = obstacle.pieces.iter().map(Convex::bounds);
    boxes.fold(none, |[lower, upper]: Bounds, [low, high]| [lower.inf(&low), upper.sup(&high)])
}

fn meet(a: &Bounds, b: &Bounds) -> bool {
    (0..2).all(|k| a[0][k] <= b[1][k] && b[0][k] <= a[1][k])
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_model::Heights;
    use cplan_model::space::SplitMix64;

    fn square(name: &str, at: [f64; 2]) -> Obstacle {
        let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
        Obstacle::polygon(name, corners.map(|[x, y]| [at[0] + x, at[1] + y])).unwrap()
    }

    /// Compares the result with the distance of the centres. Squares of side 1 overlap if this distance is less than 1
    /// along both axes. Discs overlap if it is less than the sum of the radii.
    #[test]
    fn overlaps_agree_with_centres() {
        let mut numbers = SplitMix64::nth(5, 0);
        let files = [square("a", [9.0, 0.0]), square("b", [0.0, 0.0])];
        let round = |name: &str, at: [f64; 2]| Obstacle::circle(name, at, 0.5).unwrap();
        let discs = [round("a", [9.0, 0.0]), round("b", [0.0, 0.0])];
        let mut overlapping = [0; 2];
        for k in 0..400 {
            // Some of the pairs touch, or nearly touch.
            let [x, y] = [0, 1].map(|_| match k % 3 {
                0 => (numbers.unit() * 5.0).floor() * 0.5 - 1.0,
                _ => numbers.unit() * 3.0 - 1.5,
            });
            let overlapping_pair = overlap(&files, &[square("a", [x, y]), square("b", [0.0, 0.0])]);
            assert_eq!(overlapping_pair.is_some(), x.abs() < 1.0 && y.abs() < 1.0, "{x} {y}");
            let disc = overlap(&discs, &[round("a", [x, y]), round("b", [0.0, 0.0])]);
            assert_eq!(disc.is_some(), x.hypot(y) < 1.0, "{x} {y}");
            overlapping[0] += usize::from(overlapping_pair.is_some());
            overlapping[1] += usize::from(disc.is_some());
        }
        assert!(overlapping.iter().all(|&n| n > 50 && n < 350), "{overlapping:?}");
    }

    #[test]
    fn overlaps_of_the_original_files_are_ignored() {
        let [a, b, c] = [square("a", [0.0, 0.0]), square("b", [0.5, 0.0]), square("c", [5.0, 0.0])];
        let files = [a.clone(), b.clone(), c.clone()];
        assert_eq!(overlap(&files, &files), None);
        // The first two overlap in the files already.
        let moved = [square("a", [0.1, 0.0]), b.clone(), c.clone()];
        assert_eq!(overlap(&files, &moved), None);
        let into = [a.clone(), b.clone(), square("c", [1.2, 0.0])];
        assert_eq!(overlap(&files, &into).as_deref(), Some("\"c\" overlaps \"b\""));
        let touching = [a.clone(), b.clone(), square("c", [1.5, 0.0])];
        assert_eq!(overlap(&files, &touching), None);
        // An obstacle may be above another one.
        let mut above = into.clone();
        above[2].heights = Heights { lower: 1.0, upper: 2.0 };
        (0..2).for_each(|k| above[k].heights = Heights { lower: 0.0, upper: 1.0 });
        assert_eq!(overlap(&files, &above), None);
        above[2].heights.lower = 0.9;
        assert_eq!(overlap(&files, &above).as_deref(), Some("\"b\" overlaps \"c\""));
        // A wall has no area, but overlaps shapes that it passes through.
        let wall = |y: f64| Obstacle::polyline("wall", [[-2.0, y], [2.0, y]]).unwrap();
        let files = [wall(3.0), a.clone()];
        assert_eq!(overlap(&files, &[wall(0.5), a.clone()]), None);
        assert!(overlap(&files, &[wall(0.4), a]).is_some());
    }
}
