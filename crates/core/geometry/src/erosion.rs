//! Shapes shrunk on every side.

use super::{Convex, Point, cross, inset};

impl Convex {
    /// Returns the points that lie at least `distance` inside this shape. These are the centres of the discs of radius
    /// `distance` that fit into it. `None` if no disc fits. First the radius of a rounded outline is reduced, exactly.
    /// Then every side of the core moves inwards. Correct up to rounding; `O(n^2)`.
    #[must_use]
    pub fn eroded(&self, distance: f64) -> Option<Self> {
        if distance <= self.radius() {
            return Some(self.grown(-distance));
        }
        inset(self.core(), distance - self.radius()).map(|core| Self::trusted(core, 0.0))
    }

    /// Returns a lower bound on the greatest distance by which this shape can be eroded. The bound is the depth of the
    /// mean of its corners.
    pub fn depth(&self) -> f64 {
        let core = self.core();
        if core.len() < 3 {
            return self.radius();
        }
        let mean = mean(core);
        let to_side = |i: usize| {
            let (a, b) = (core[i], core[(i + 1) % core.len()]);
            cross(b - a, mean - a) / (b - a).norm()
        };
        (0..core.len()).map(to_side).fold(f64::INFINITY, f64::min).max(0.0) + self.radius()
    }
}

fn mean(points: &[Point]) -> Point {
    points.iter().sum::<super::Vector>() / points.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Vector, hull, separation};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        #[test]
        fn discs_fit_exactly_about_the_eroded_points(
            points in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 3..8), radius in 0.0..0.2f64,
            by in 0.0..0.6f64, at in (-1.0..1.0f64, -1.0..1.0f64),
        ) {
            let corners: Vec<Point> = points.into_iter().map(|(x, y)| Point::new(x, y)).collect();
            let shape = Convex::trusted(hull(&corners), radius);
            let eroded = shape.eroded(by);
            prop_assert!(by > shape.depth() || eroded.is_some());
            let point = Vector::new(at.0, at.1);
            // The depth of a point is the distance that the shape must move until the point is outside.
            let depth = -separation(&shape, &Convex::point(point)).distance;
            let inside = eroded.is_some_and(|e| separation(&e, &Convex::point(point)).distance <= 0.0);
            prop_assert!((depth - by).abs() < 1e-9 || inside == (depth >= by), "{depth} {by}");
        }
    }

    /// Generates shapes anywhere in a square.
    fn shapes() -> impl Strategy<Value = Convex> {
        let corners = prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 1..8);
        // Flat shapes have sharp corners.
        (corners, prop_oneof![Just(0.0), 0.0..0.1f64], prop_oneof![Just(1.0), 0.0..0.1f64]).prop_map(
            |(points, radius, flat)| {
                let corners: Vec<Point> = points.into_iter().map(|(x, y)| Point::new(x, y * flat)).collect();
                Convex::trusted(hull(&corners), radius)
            },
        )
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(2000))]

        /// Tests that a receding shape is farther away by `by`, also at its corners, and that growing restores it.
        #[test]
        fn receding_increases_every_distance(shape in shapes(), other in shapes(), by in 0.0..0.5f64) {
            let (near, far) = (separation(&other, &shape), separation(&other, &shape.with_distances_increased(by)));
            prop_assert!((far.distance - near.distance - by).abs() < 1e-12);
            let difference = shape.with_distances_increased(by).minkowski_difference(&other);
            let of_difference = separation(&Convex::point(Point::zeros()), &difference).distance;
            prop_assert!((of_difference - far.distance).abs() < 1e-9, "{of_difference} {}", far.distance);
            let again = shape.with_distances_increased(by).eroded(shape.radius() - by).expect("all of it");
            prop_assert!(again.core() == shape.core() && again.radius() < 1e-15);
        }
    }

    #[test]
    fn too_thin_shapes_erode_to_nothing() {
        let bar = Convex::trusted(
            vec![Point::new(0., 0.), Point::new(1., 0.), Point::new(1., 0.1), Point::new(0., 0.1)],
            0.0,
        );
        let left = bar.eroded(0.049).unwrap();
        for corner in [(0.049, 0.049), (0.951, 0.049), (0.951, 0.051), (0.049, 0.051)] {
            let is_there = |p: &Point| (p.x - corner.0).abs() < 1e-12 && (p.y - corner.1).abs() < 1e-12;
            assert!(left.core().iter().any(is_there), "{corner:?} of {left:?}");
        }
        assert_eq!((left.core().len(), left.radius()), (4, 0.0));
        assert!(bar.eroded(0.051).is_none());
        assert!(Convex::trusted(vec![Point::new(0., 0.), Point::new(1., 0.)], 0.0).eroded(1e-9).is_none());
        assert_eq!(Convex::point(Point::zeros()).grown(0.3).eroded(0.1).unwrap().radius(), 0.3 - 0.1);
        assert!(Convex::point(Point::zeros()).grown(0.3).eroded(0.31).is_none());
    }
}
