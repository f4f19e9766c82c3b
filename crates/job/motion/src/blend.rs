//! Blends: parabolas that round the corners of a path. Also curved legs, which have given tangents at their ends.

use cplan_handling::Piece;
use cplan_model::space::{Configuration, Path};

/// Greatest deviation of a motion from a blend's parabola, in each joint, as a share of the blend's radius. Certificates cover
/// this tube around the parabola, so they remain valid if a program joins the samples by cubics.
pub const BLEND_TOLERANCE: f64 = 1e-6;

/// Number of points of a blend in pictures.
const POINTS_PER_BLEND: u8 = 12;

/// A parabola that leaves one straight piece at `from` and joins the next one at `to`, tangent to both. As a quadratic Bézier
/// curve, it has the corner as its middle control point. Both ends are equally far from the corner.
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
    /// Creates the blend of the corner between the legs `before`-`corner` and `corner`-`after`. Its ends are at the distance
    /// `radius` from the corner. The radius is positive and not longer than either leg.
    pub fn new([before, corner, after]: [Configuration; 3], radius: f64) -> Self {
        let toward = |end: Configuration| corner + (end - corner) * (radius / (end - corner).norm());
        Self { from: toward(before), corner, to: toward(after) }
    }

    /// Returns the Euclidean distance from the corner to either end, in joint space.
    pub fn radius(&self) -> f64 {
        (self.corner - self.from).norm()
    }

    /// Returns the point at the parameter `u`, from 0 to 1. Exact at both ends.
    pub fn at(&self, u: f64) -> Configuration {
        let mix = |a: Configuration, b: Configuration| a * (1.0 - u) + b * u;
        mix(mix(self.from, self.corner), mix(self.corner, self.to))
    }

    /// Returns the same curve as a cubic.
    pub fn piece(&self) -> Piece {
        Piece::quadratic(0.0, 1.0, [self.from, self.corner, self.to])
    }
}

/// A part of a motion along a path with blends. Between two consecutive straight pieces, the motion stops at the corner.
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

/// A curved part of a motion: a cubic between two configurations, with given unit tangents there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvedLeg {
    /// The configurations at both ends.
    pub ends: [Configuration; 2],
    /// The unit tangents at both ends.
    pub tangents: [Configuration; 2],
    /// Range of the parameter. It is about the length of the curve, because the derivative by the parameter has length 1 at
    /// both ends and in the middle.
    pub length: f64,
}

impl CurvedLeg {
    /// Creates the curve between two different configurations.
    pub fn new(ends: [Configuration; 2], tangents: [Configuration; 2]) -> Self {
        let (chord, mean) = (ends[1] - ends[0], (tangents[0] + tangents[1]) / 4.0);
        // The derivative in the middle is `3 chord / (2 length) - mean`.
        let (along, square) = (chord.dot(&mean), chord.norm_squared());
        let root = (along * along + square * (1.0 - mean.norm_squared())).max(0.0).sqrt();
        Self { ends, tangents, length: 1.5 * square / (along + root) }
    }

    /// Returns the curve as a piece of a motion, with its parameter as the time.
    pub fn piece(&self) -> Piece {
        let [from, to] = [0, 1].map(|end| [self.ends[end], self.tangents[end]]);
        Piece::hermite(0.0, self.length, from, to)
    }
}

/// A path with blends at some of its corners, and with curves instead of some of its legs.
#[derive(Debug, Clone, PartialEq)]
pub struct BlendedPath {
    path: Path,
    /// Radius of the blend at each waypoint; 0 where the motion stops at the corner, at smooth waypoints, and at both ends
    /// of the path.
    radii: Vec<f64>,
    /// Unit tangents at both ends of each curved leg; `None` for straight legs.
    tangents: Vec<Option<[Configuration; 2]>>,
    /// True for each waypoint that two curved legs pass with the same tangent.
    is_smooth: Vec<bool>,
}

impl From<Path> for BlendedPath {
    /// Converts the path without blends.
    fn from(path: Path) -> Self {
        let count = path.waypoints().len();
        Self { radii: vec![0.0; count], tangents: vec![None; count - 1], is_smooth: vec![false; count], path }
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
        let radius = self.radii[waypoint];
        (radius > 0.0).then(|| self.blend_of(waypoint, radius))
    }

    /// Returns the blend with this radius at an inner waypoint. Next to a curved leg, it begins or ends on the leg's tangent.
    pub(super) fn blend_of(&self, waypoint: usize, radius: f64) -> Blend {
        let q = self.path.waypoints();
        let mut blend = Blend::new([q[waypoint - 1], q[waypoint], q[waypoint + 1]], radius);
        if let Some([_, tangent]) = self.tangents[waypoint - 1] {
            blend.from = blend.corner - tangent * radius;
        }
        if let Some([tangent, _]) = self.tangents[waypoint] {
            blend.to = blend.corner + tangent * radius;
        }
        blend
    }

    /// Replaces legs by curves with these unit tangents at both ends; a leg with `None` stays straight. The motion passes smooth
    /// waypoints without a stop or a blend: both legs there are curved, with the same tangent.
    ///
    /// # Panics
    /// If a waypoint is wrongly marked as smooth, or if a list does not have an entry for each leg or waypoint.
    #[must_use]
    pub fn curved(self, tangents: Vec<Option<[Configuration; 2]>>, is_smooth: Vec<bool>) -> Self {
        assert!(tangents.len() == self.tangents.len() && is_smooth.len() == self.is_smooth.len(), "one entry each");
        for waypoint in (0..is_smooth.len()).filter(|&w| is_smooth[w]) {
            let ends = (tangents[waypoint - 1].map(|of| of[1]), tangents[waypoint].map(|of| of[0]));
            assert!(ends.0.is_some() && ends.0 == ends.1, "a smooth waypoint has one tangent");
        }
        Self { tangents, is_smooth, ..self }
    }

    /// Straightens a leg. Removes the blends at its ends, which begin on its tangents.
    #[must_use]
    pub fn without_curve(self, leg: usize) -> Self {
        let last = self.radii.len() - 1;
        let corners = [leg, leg + 1].into_iter().filter(|&w| 0 < w && w < last);
        corners.fold(self.straightened(leg), |curve, waypoint| curve.with(waypoint, 0.0))
    }

    /// Straightens a leg of a path without blends.
    #[must_use]
    pub fn straightened(mut self, leg: usize) -> Self {
        self.tangents[leg] = None;
        self.is_smooth[leg..=leg + 1].fill(false);
        self
    }

    /// Returns the curved part of a leg between the blends at its ends. `None` if the leg is straight.
    pub fn curved_leg(&self, leg: usize) -> Option<CurvedLeg> {
        let (q, [first, last]) = (self.path.waypoints(), self.tangents[leg]?);
        let ends = [q[leg] + first * self.radii[leg], q[leg + 1] - last * self.radii[leg + 1]];
        Some(CurvedLeg::new(ends, [first, last]))
    }

    /// Returns true if two curved legs pass a waypoint with the same tangent.
    pub fn is_smooth(&self, waypoint: usize) -> bool {
        self.is_smooth[waypoint]
    }

    /// Returns true if any leg is curved.
    pub fn has_curved_leg(&self) -> bool {
        self.tangents.iter().any(Option::is_some)
    }

    /// Returns true if any corner is blended, or any leg curved.
    pub fn is_curved(&self) -> bool {
        self.has_curved_leg() || self.radii.iter().any(|radius| *radius > 0.0)
    }

    /// Returns the greatest distance from each waypoint at which the motion is off the straight legs. For a blend, it is the
    /// radius. For a curved leg, the distances at both ends together cover the leg. Ends of the path have none.
    pub fn extents(&self) -> Vec<f64> {
        let (mut extents, last) = (self.radii.clone(), self.radii.len() - 1);
        for leg in 0..self.tangents.len() {
            let Some(curved) = self.curved_leg(leg) else { continue };
            let chord = (self.path.waypoints()[leg + 1] - self.path.waypoints()[leg]).norm();
            let length = curved.length + self.radii[leg] + self.radii[leg + 1];
            let is_inner = |w: &usize| 0 < *w && *w < last;
            let ends: Vec<usize> = [leg, leg + 1].into_iter().filter(is_inner).collect();
            let is_passed = |w: &usize| self.radii[*w] > 0.0 || self.is_smooth[*w];
            let passed: Vec<usize> = ends.iter().copied().filter(is_passed).collect();
            let used = if passed.is_empty() { ends } else { passed };
            for &waypoint in &used {
                // The leg's other end is on the path, and no part of the leg is farther away.
                extents[waypoint] = extents[waypoint].max((length / used.len() as f64).min(chord));
            }
        }
        extents
    }

    /// Returns half the length of the longest blend or curved leg, in joint space.
    pub fn greatest_half(&self) -> f64 {
        let legs = (0..self.tangents.len()).filter_map(|leg| Some(self.curved_leg(leg)?.length / 2.0));
        self.radii.iter().copied().chain(legs).fold(0.0, f64::max)
    }

    /// Sets the radius at an inner waypoint. The radius 0 removes the blend.
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

    /// Appends another path, which starts where this one ends. There is a corner between both.
    #[must_use]
    pub fn then(self, next: &BlendedPath) -> Self {
        let waypoints = self.path.waypoints().iter().chain(next.path.waypoints()).copied().collect();
        let last = self.radii.len() - 1;
        let radii = self.radii[..last].iter().chain(&next.radii).copied().collect();
        let tangents = self.tangents.iter().chain(&next.tangents).copied().collect();
        let is_smooth = self.is_smooth[..last].iter().chain(&next.is_smooth).copied().collect();
        Self { path: Path::new(waypoints), radii, tangents, is_smooth }
    }

    /// Returns the straight pieces and blends from start to goal. Curved legs count as straight.
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

        /// Checks that a parabola is tangent to both legs: its ends lie on them, and its middle is halfway between the corner and
        /// the middle of its ends. The cubic is the same curve.
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
