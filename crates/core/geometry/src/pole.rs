//! The pole of inaccessibility: the point of a polygon that is farthest from its outline.

use super::penetration::distance_to_segment;
use super::{OrderedF64, Point};
use std::collections::BinaryHeap;

/// Largest number of cells examined. In a sliver almost every point is near the optimum, and more cells hardly
/// improve it.
const MAX_CELLS: usize = 4096;

/// Finds the point of a polygon that is farthest from its outline, and its distance from the outline. This is the pole
/// of inaccessibility (Garcia-Castellanos and Lombardo 2007). No point inside is farther from the outline by more than
/// `precision`. Returns `None` if the polygon has no inside.
///
/// The outline may touch itself. The inside is where its winding number is odd. Squares that may contain a better point
/// are divided into four, the most promising first, as polylabel does (Agafonkin 2016).
pub fn pole_of_inaccessibility(corners: &[Point], precision: f64) -> Option<(Point, f64)> {
    let (mut low, mut high) = (*corners.first()?, *corners.first()?);
    for corner in corners {
        (low, high) = (low.inf(corner), high.sup(corner));
    }
    let half = (high - low).max() / 2.0;
    let mut best: Option<(Point, f64)> = None;
    let mut waiting: BinaryHeap<(OrderedF64, [OrderedF64; 3])> = BinaryHeap::new();
    let look = |[x, y, half]: [f64; 3], best: &mut Option<(Point, f64)>, waiting: &mut BinaryHeap<_>| {
        let middle = Point::new(x, y);
        let depth = depth(corners, middle);
        let known = best.map_or(0.0, |(_, depth)| depth);
        if depth > known {
            *best = Some((middle, depth));
        }
        waiting.push((OrderedF64(depth + half * std::f64::consts::SQRT_2), [x, y, half].map(OrderedF64)));
    };
    look([(low.x + high.x) / 2.0, (low.y + high.y) / 2.0, half], &mut best, &mut waiting);
    for _ in 0..MAX_CELLS {
        let Some((OrderedF64(most), [x, y, half])) = waiting.pop() else { break };
        if most <= best.map_or(0.0, |(_, depth)| depth) + precision {
            break;
        }
        let quarter = half.0 / 2.0;
        for (dx, dy) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            look([x.0 + dx * quarter, y.0 + dy * quarter, quarter], &mut best, &mut waiting);
        }
    }
    best
}

/// Returns the distance of `p` from the outline, negative outside.
fn depth(corners: &[Point], p: Point) -> f64 {
    let (mut is_inside, mut least) = (false, f64::INFINITY);
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            is_inside = !is_inside;
        }
        least = least.min(distance_to_segment(p, a, b));
    }
    if is_inside { least } else { -least }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn polygon(corners: &[(f64, f64)]) -> Vec<Point> {
        corners.iter().map(|c| Point::new(c.0, c.1)).collect()
    }

    #[test]
    fn the_pole_of_a_rectangle_lies_on_its_middle_line() {
        let (pole, depth) =
            pole_of_inaccessibility(&polygon(&[(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)]), 1e-3).unwrap();
        assert!((depth - 1.0).abs() <= 1e-3 && (pole.y - 1.0).abs() <= 1e-3, "{pole} {depth}");
    }

    #[test]
    fn the_pole_of_a_hook_is_inside() {
        // The centre of its bounding box is outside.
        let hook = polygon(&[(0.0, 0.0), (5.0, 0.0), (5.0, 1.0), (1.5, 1.0), (1.5, 5.0), (0.0, 5.0)]);
        let (pole, depth) = pole_of_inaccessibility(&hook, 1e-3).unwrap();
        assert!(depth > 0.75 && pole.x < 1.5, "{pole} {depth}");
    }

    #[test]
    fn polygons_without_area_have_no_pole() {
        assert_eq!(pole_of_inaccessibility(&[], 0.1), None);
        assert_eq!(pole_of_inaccessibility(&polygon(&[(1.0, 2.0)]), 0.1), None);
        assert_eq!(pole_of_inaccessibility(&polygon(&[(0.0, 0.0), (1.0, 1.0)]), 0.1), None);
    }

    /// Returns the depth of a point. Uses winding angles, and distances from points along the sides.
    fn sampled_depth(corners: &[Point], p: Point) -> f64 {
        const FINE: u32 = 100;
        let (mut turns, mut least) = (0.0, f64::INFINITY);
        for (i, a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            let (u, v) = (a - p, b - p);
            turns += (u.x * v.y - u.y * v.x).atan2(u.dot(&v));
            let along = |k: u32| a + (b - a) * (f64::from(k) / f64::from(FINE));
            least = (0..=FINE).map(|k| (along(k) - p).norm()).fold(least, f64::min);
        }
        if turns.abs() > 3.0 { least } else { -least }
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(24))]

        /// Tests that no point of a fine grid is deeper than the pole, and that the pole is as deep as stated.
        #[test]
        fn no_point_of_a_grid_is_deeper(radii in prop::collection::vec(0.1..1.0f64, 3..12), stretch in 0.2..3.0f64) {
            let angle = |i: usize| i as f64 / radii.len() as f64 * std::f64::consts::TAU;
            let star: Vec<Point> = radii
                .iter()
                .enumerate()
                .map(|(i, r)| Point::new(stretch * r * angle(i).cos(), r * angle(i).sin()))
                .collect();
            let (pole, depth) = pole_of_inaccessibility(&star, 1e-3).unwrap();
            // Half of the distance between two points along the longest side.
            let slack = 0.032;
            prop_assert!((sampled_depth(&star, pole) - depth).abs() < slack);
            for i in -10..=10 {
                for j in -10..=10 {
                    let p = Point::new(stretch * f64::from(i) / 10.0, f64::from(j) / 10.0);
                    prop_assert!(sampled_depth(&star, p) <= depth + 1e-3 + slack, "{p} is deeper than {pole}");
                }
            }
        }
    }
}
