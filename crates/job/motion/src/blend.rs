//! Blends: parabolas that round the corners of a path.

use cplan_handling::Piece;
use cplan_model::space::{Configuration, Path};

/// Greatest deviation of a motion from a blend's parabola, in each joint, as a share of the blend's radius.
/// Certificates cover this whole tube around the parabola. So they are also valid if a program joins the samples by
/// cubics.
pub const BLEND_TOLERANCE: f64 = 1e-6;

/// Number of points of a blend in pictures.
const POINTS_PER_BLEND: u8 = 12;

/// A parabola that leaves one straight piece at `from` and joins the next at `to`, tangent to both pieces. It is the
/// quadratic Bézier curve whose middle control point is the corner. Both ends are equally far from the corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blend {
    /// The point where the blend leaves the first leg.
    pub from: Configuration,
    /// The point where the legs meet. It is not on the curve.
    pub corner: Configuration,
    /// The point where the blend joins the second leg.
    pub to: Configuration,
}

impl Blend {
    /// Makes the blend of the corner between the legs `before`-`corner` and `corner`-`after`. Its ends are at the
    /// distance
    /// `radius` from the corner. The radius is positive and not longer than either leg.
    pub fn new([before, corner, after]: [Configuration; 3], radius: f64) -> Self {
        let toward = |end: Configuration| corner + (end - corner) * (radius / (end - corner).norm());
        Self { from: toward(before), corner, to: toward(after) }
    }

    /// Returns the Euclidean distance from the corner to either end, in joint space.
    pub fn radius(&self) -> f64 {
        (self.corner - self.from).norm()
    }

    /// Returns the point at a share `u` of the curve. It is exact at both ends.
    pub fn at(&self, u: f64) -> Configuration {
        let mix = |a: Configuration, b: Configuration| a * (1.0 - u) + b * u;
        mix(mix(self.from, self.corner), mix(self.corner, self.to))
    }

    /// Returns the same curve in cubic form.
    pub fn piece(&self) -> Piece {
        Piece::quadratic(0.0, 1.0, [self.from, self.corner, self.to])
    }
}

/// A part of a motion along a path with blends. If one straight piece directly follows another, the motion stops at the
/// corner between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stretch {
    /// A straight piece between two corners or their blends.
    Line {
        /// The configuration at which the piece begins.
        from: Configuration,
        /// The configuration at which the piece ends.
        to: Configuration,
    },
    /// A blend, which rounds a corner.
    Blend(Blend),
}

/// A path some of whose corners are blended.
#[derive(Debug, Clone, PartialEq)]
pub struct BlendedPath {
    path: Path,
    /// Radius of the blend at each waypoint; 0 where the motion stops at the corner, and at both ends of the path.
    radii: Vec<f64>,
}

impl From<Path> for BlendedPath {
    /// Converts the path without blends.
    fn from(path: Path) -> Self {
        Self { radii: vec![0.0; path.waypoints().len()], path }
    }
}

impl BlendedPath {
    /// Returns the straight path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the radius of the blend at each waypoint, in joint space (radians and metres mixed); 0 if there is none.
    pub fn radii(&self) -> &[f64] {
        &self.radii
    }

    /// Returns the blend at a waypoint, if there is one.
    pub fn blend(&self, waypoint: usize) -> Option<Blend> {
        let q = self.path.waypoints();
        let radius = self.radii[waypoint];
        (radius > 0.0).then(|| Blend::new([q[waypoint - 1], q[waypoint], q[waypoint + 1]], radius))
    }

    /// Sets the radius at an inner waypoint; 0 removes the blend.
    ///
    /// # Panics
    /// If the waypoint is an end of the path, or if the radii at both ends of a leg add up to at least its length.
    #[must_use]
    pub fn with(mut self, waypoint: usize, radius: f64) -> Self {
        let q = self.path.waypoints();
        assert!(0 < waypoint && waypoint + 1 < q.len(), "only corners are blended");
        for other in [waypoint - 1, waypoint + 1] {
            let leg = (q[other] - q[waypoint]).norm();
            assert!(radius == 0.0 || radius + self.radii[other] < leg, "blends of one leg overlap");
        }
        self.radii[waypoint] = radius;
        self
    }

    /// Appends another path, which starts where this one ends, with a corner between the two.
    #[must_use]
    pub fn then(self, next: &BlendedPath) -> Self {
        let waypoints = self.path.waypoints().iter().chain(next.path.waypoints()).copied().collect();
        let last = self.radii.len() - 1;
        let radii = self.radii[..last].iter().chain(&next.radii).copied().collect();
        Self { path: Path::new(waypoints), radii }
    }

    /// Returns the straight pieces and blends from start to goal.
    pub fn stretches(&self) -> Vec<Stretch> {
        let q = self.path.waypoints();
        let mut stretches = Vec::new();
        let mut from = self.path.start();
        for (waypoint, &corner) in q.iter().enumerate().skip(1) {
            let blend = self.blend(waypoint);
            stretches.push(Stretch::Line { from, to: blend.map_or(corner, |b| b.from) });
            stretches.extend(blend.map(Stretch::Blend));
            from = blend.map_or(corner, |b| b.to);
        }
        stretches
    }

    /// Returns a polyline for pictures, with points on the blends.
    pub fn outline(&self) -> Path {
        let mut points = vec![self.path.start()];
        for stretch in self.stretches() {
            match stretch {
                Stretch::Line { to, .. } => points.push(to),
                Stretch::Blend(blend) => {
                    points.extend((1..=POINTS_PER_BLEND).map(|i| blend.at(f64::from(i) / f64::from(POINTS_PER_BLEND))));
                }
            }
        }
        Path::new(points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn q(a: f64, b: f64) -> Configuration {
        Configuration::new(a, b)
    }

    #[test]
    fn stretches_join() {
        let path = Path::new(vec![q(0.0, 0.0), q(1.0, 0.0), q(1.0, 2.0), q(-1.0, 2.0)]);
        let straight = BlendedPath::from(path.clone());
        assert_eq!((straight.stretches().len(), straight.outline()), (3, path));
        let blended = straight.with(1, 0.25);
        assert_eq!(blended.radii(), [0.0, 0.25, 0.0, 0.0]);
        let stretches = blended.stretches();
        let corner = Blend { from: q(0.75, 0.0), corner: q(1.0, 0.0), to: q(1.0, 0.25) };
        let line = |from, to| Stretch::Line { from, to };
        let expected = [
            line(q(0.0, 0.0), corner.from),
            Stretch::Blend(corner),
            line(corner.to, q(1.0, 2.0)),
            line(q(1.0, 2.0), q(-1.0, 2.0)),
        ];
        assert_eq!(stretches, expected);
        assert_eq!(blended.with(1, 0.0).stretches().len(), 3);
    }

    #[test]
    #[should_panic(expected = "overlap")]
    fn blends_do_not_overlap() {
        let path = Path::new(vec![q(0.0, 0.0), q(1.0, 0.0), q(1.0, 1.0), q(2.0, 1.0)]);
        let _ = BlendedPath::from(path).with(1, 0.6).with(2, 0.6);
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(256))]

        /// Tests that a parabola is tangent to both legs: its ends lie on them, and its middle is halfway between the
        /// corner and the middle of the ends. Its cubic form is the same curve.
        #[test]
        fn blends_are_parabolas(legs in prop::array::uniform4(-2.0..2.0_f64), radius in 0.01..0.2_f64, u in 0.0..1.0_f64) {
            let (corner, before, after) = (q(0.3, -0.2), q(legs[0], legs[1]), q(legs[2], legs[3]));
            prop_assume!((before - corner).norm() > radius && (after - corner).norm() > radius);
            let blend = Blend::new([before, corner, after], radius);
            prop_assert!((blend.radius() - radius).abs() < 1e-14);
            let on_leg = |p: Configuration, end: Configuration| (p - corner).perp(&(end - corner)).abs() < 1e-14;
            prop_assert!(on_leg(blend.from, before) && on_leg(blend.to, after));
            prop_assert_eq!((blend.at(0.0), blend.at(1.0)), (blend.from, blend.to));
            prop_assert!((blend.at(0.5) - (corner + (blend.from + blend.to) / 2.0) / 2.0).norm() < 1e-14);
            prop_assert!((blend.at(u) - blend.piece().at(u)).norm() < 1e-14);
        }
    }
}
