//! Bounds on the distance between a link and an obstacle while the configuration deviates from a given one.
//!
//! Let `q` deviate from `m` by `d`, let `n` be the direction of least distance at `m`, and let `x(d)` be a corner of
//! the link. Taylor's formula gives `n . x(d) <= n . x(0) + |n . J d| + K / 2`, with the Jacobian `J` and a bound `K`
//! on the second derivative along the motion. The obstacle has a supporting line with the normal `n`. As long as this
//! sum is below that line for every corner, the link stays on its side of the line, which gives a lower bound on the
//! distance. To first order, only motion *towards* the obstacle matters.
//!
//! A second bound uses the link's frame, in which the obstacle's corners move and the link rests. A third bound is that no point
//! moves farther than some length (Schwarzer, Saha, Latombe 2005). The greatest of the three bounds counts. At large distances,
//! this is the third one. If a link moves along an obstacle, as on shortest paths, the other two are far better.

use super::drift::Drift;
use cplan_geometry::{Convex, Point, Pose, Separation, Vector, perpendicular, reach, separation_at};
use cplan_model::space::Configuration;
use cplan_model::{Arm, JointType, Pair, Scene};

/// Bound on the rounding of one evaluation, as a fraction of its lengths: a few dozen operations with 1.1e-16 each.
/// Bounds are lowered by it, so that they hold in floating point, too.
pub(super) const ROUNDING: f64 = 1e-13;

/// Allowance for rounding in proofs that shapes collide, as a fraction of the lengths. The independent check
/// ([`super::Disconnection::checked`]) accepts these proofs, because its own allowance is smaller (1e-12).
pub const COLLISION_ROUNDING: f64 = 2e-12;

/// A symmetric set of deviations from a configuration: for each deviation, it contains the opposite one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Deviation {
    /// The deviations `t d` of a straight motion, for `-1 <= t <= 1`. The value is `d`.
    Along(Configuration),
    /// All deviations `d` with `|d_1| <= h_1` and `|d_2| <= h_2`. The value is `h`.
    Box([f64; 2]),
    /// All sums of a deviation of [`Deviation::Along`] and one of [`Deviation::Box`]. For example, they cover a curve
    /// that stays near its chord.
    Tube(Configuration, [f64; 2]),
}

impl Deviation {
    /// Returns the greatest value of `|g_1 d_1 + g_2 d_2|` over the deviations.
    pub(super) fn linear(self, g: [f64; 2]) -> f64 {
        match self {
            Deviation::Along(d) => (g[0] * d[0] + g[1] * d[1]).abs(),
            Deviation::Box(h) => g[0].abs() * h[0] + g[1].abs() * h[1],
            Deviation::Tube(d, h) => Deviation::Along(d).linear(g) + Deviation::Box(h).linear(g),
        }
    }

    /// Returns the greatest value of `|g_1 d_1 + g_2 d_2 - t c|` over the deviations, with `t` as in
    /// [`Deviation::Along`].
    pub(super) fn linear_less(self, g: [f64; 2], c: f64) -> f64 {
        match self {
            Deviation::Along(d) => (g[0] * d[0] + g[1] * d[1] - c).abs(),
            Deviation::Box(_) => self.linear(g) + c.abs(),
            Deviation::Tube(d, h) => Deviation::Along(d).linear_less(g, c) + Deviation::Box(h).linear(g),
        }
    }

    /// Returns all sums of these deviations and deviations of each joint by at most `by`.
    #[must_use]
    pub fn widened(self, by: f64) -> Self {
        match self {
            Deviation::Along(d) => Deviation::Tube(d, [by; 2]),
            Deviation::Box(h) => Deviation::Box(h.map(|h| h + by)),
            Deviation::Tube(d, h) => Deviation::Tube(d, h.map(|h| h + by)),
        }
    }

    /// Returns the greatest values of `|d_1|` and of `|d_2|` over the deviations.
    pub(super) fn greatest_components(self) -> [f64; 2] {
        match self {
            Deviation::Along(d) => [d[0].abs(), d[1].abs()],
            Deviation::Box(h) => h,
            Deviation::Tube(d, h) => [d[0].abs() + h[0], d[1].abs() + h[1]],
        }
    }
}

/// An arm at one configuration, prepared for bounds on its distances at nearby configurations.
#[derive(Debug, Clone)]
pub struct Posture<'a> {
    pub(super) scene: &'a Scene,
    q: Configuration,
    pub(super) poses: [Pose; 3],
    /// Positions of joint 2 in the plane, with joint 1 as in the configuration, and with joint 1 at zero.
    elbows: [Point; 2],
}

/// The distance of a pair of shapes at one configuration, and a lower bound on it at nearby configurations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeparationBound {
    /// Signed distance at the posture, with its direction.
    pub here: Separation,
    /// Lower bound on the signed distance over all deviations, metres.
    pub least: f64,
}

/// A pair of shapes during a span of a motion.
#[derive(Debug, Clone, Copy)]
pub struct SpanPair<'s> {
    /// The pair.
    pub pair: Pair,
    /// A shape that contains the pair's part at all times of the span, in the link's frame. `None` if the part does not
    /// change its shape.
    pub part: Option<&'s Convex>,
    /// The motion of the obstacle. `None` if it is static.
    pub drift: Option<&'s Drift>,
}

impl From<Pair> for SpanPair<'_> {
    /// Converts a pair with a constant part and a static obstacle.
    fn from(pair: Pair) -> Self {
        Self { pair, part: None, drift: None }
    }
}

/// The shapes of a pair, and the drift of its obstacle, if any. When the arm has deviated by `t d`, the time is `t`
/// half spans after the middle of the drift.
#[derive(Clone, Copy)]
struct Shapes<'s> {
    link: usize,
    /// The link's shape, in the link's frame.
    local: &'s Convex,
    /// The obstacle's shape in plane coordinates, at the middle of the drift.
    piece: &'s Convex,
    drift: Option<&'s Drift>,
}

/// A bound on the acceleration of a moving point `p`, that is, on the second derivative of its position with respect to
/// the deviation's parameter. It is `(|p - center| + shift) factor^2 + constant`.
#[derive(Debug, Clone, Copy)]
pub struct Curvature {
    /// The point from which the distance of `p` is measured.
    center: Point,
    /// A length added to that distance, metres.
    shift: f64,
    /// Bound on the rotation, radians.
    factor: f64,
    /// The part of the bound that is the same for all points, metres.
    constant: f64,
}

impl Curvature {
    /// Returns the bound for the point `p`.
    pub fn of(&self, p: Point) -> f64 {
        ((p - self.center).norm() + self.shift) * self.factor * self.factor + self.constant
    }
}

impl<'a> Posture<'a> {
    /// Prepares the arm of `scene` at `q`.
    pub fn new(scene: &'a Scene, q: Configuration) -> Self {
        let poses = scene.arm().pair_poses(q);
        let offset = scene.arm().offset;
        let at_zero = scene.arm().pose(0, Configuration::new(0.0, q[1])).point(offset);
        Self { scene, q, poses, elbows: [poses[0].point(offset), at_zero] }
    }

    /// Returns the configuration.
    pub fn configuration(&self) -> Configuration {
        self.q
    }

    /// Returns the pose of the moving part of a pair, for each value of [`Pair::link`].
    pub fn pose(&self, link: usize) -> Pose {
        self.poses[link]
    }

    /// Returns the signed distance of a pair at the posture.
    pub fn separation(&self, pair: Pair) -> Separation {
        separation_at(self.scene.part(pair), &self.poses[pair.link], self.scene.piece(pair), |_, here| here)
    }

    /// Returns the distance of a pair at the posture, and a lower bound on it over `deviation`.
    pub fn bound(&self, pair: Pair, deviation: Deviation) -> SeparationBound {
        self.bound_up_to(pair, deviation, |_| f64::INFINITY)
    }

    /// Like [`Posture::bound`], but may stop early. `enough` receives the distance at the posture, and returns the
    /// bound that suffices.
    pub fn bound_up_to(&self, pair: Pair, deviation: Deviation, enough: impl Fn(f64) -> f64) -> SeparationBound {
        self.least(self.shapes(pair), deviation, enough)
    }

    /// Like [`Posture::bound_up_to`], during a span of a motion. The posture is that of the arm in the middle of the
    /// span, and the deviation is the motion of the arm in the span.
    pub fn bound_during(
        &self,
        SpanPair { pair, part, drift }: SpanPair,
        deviation: Deviation,
        enough: impl Fn(f64) -> f64,
    ) -> SeparationBound {
        let still = self.shapes(pair);
        let local = part.unwrap_or(still.local);
        match drift {
            None => self.least(Shapes { local, ..still }, deviation, enough),
            Some(Drift { middle, .. }) => {
                let piece = still.piece.at(middle);
                self.least(Shapes { local, piece: &piece, drift, ..still }, deviation, enough)
            }
        }
    }

    /// Like [`Posture::disc_bound`], during a span of a motion.
    pub fn disc_bound_during(&self, SpanPair { pair, part, drift }: SpanPair, deviation: Deviation) -> f64 {
        let (mut center, mut around) = disc(self.scene.piece(pair));
        if let Some(drift) = drift {
            around += drift.farthest(center.norm() + around);
            center = drift.middle.point(center);
        }
        self.disc_bound_from(pair.link, part.unwrap_or(self.scene.part(pair)), deviation, (center, around))
    }

    fn shapes(&self, pair: Pair) -> Shapes<'a> {
        Shapes { link: pair.link, local: self.scene.part(pair), piece: self.scene.piece(pair), drift: None }
    }

    fn least(&self, shapes: Shapes, deviation: Deviation, enough: impl Fn(f64) -> f64) -> SeparationBound {
        let Shapes { link, local, piece, drift } = shapes;
        separation_at(local, &self.poses[link], piece, |corners, here| {
            let rounding = ROUNDING * self.scale(corners, local.radius(), piece);
            let enough = enough(here.distance) + rounding;
            let drifts = drift.map_or(0.0, |drift| drift.farthest(piece.reach_from(drift.middle.translation)));
            let mut least = here.distance - self.farthest_motion_of(link, local, deviation) - drifts;
            let radii = local.radius() + piece.radius();
            if least < enough {
                least = least.max(self.least_in_plane(shapes, corners, here.direction, deviation) - radii);
            }
            if least < enough && drift.is_none() {
                least = least.max(self.least_in_link(shapes, corners, here.direction, deviation) - radii);
            }
            SeparationBound { here, least: least - rounding }
        })
    }

    /// Returns a lower bound on the distance of a pair over `deviation`, from discs around the two shapes. It is much
    /// faster than [`Posture::bound`], but far lower if the shapes are close.
    pub fn disc_bound(&self, pair: Pair, deviation: Deviation) -> f64 {
        self.disc_bound_during(pair.into(), deviation)
    }

    fn disc_bound_from(&self, link: usize, part: &Convex, deviation: Deviation, (fixed, around): (Point, f64)) -> f64 {
        let (at, extent) = self.place_of(link, part, deviation);
        let between = (at - fixed).norm();
        let scale = self.scene.arm().base.norm() + at.norm() + fixed.norm() + extent + around;
        between - extent - around - ROUNDING * scale
    }

    /// Returns centre and radius of a disc that contains the moving part of a pair over the whole `deviation`.
    pub fn place(&self, pair: Pair, deviation: Deviation) -> (Point, f64) {
        self.place_of(pair.link, self.scene.part(pair), deviation)
    }

    fn place_of(&self, link: usize, part: &Convex, deviation: Deviation) -> (Point, f64) {
        let (center, extent) = disc(part);
        (self.poses[link].point(center), extent + self.farthest_motion_of(link, part, deviation))
    }

    /// Returns an upper bound on the signed distance of a pair over `deviation`. If it is negative, the pair collides
    /// at every deviation. For suppose that the shapes are apart at some deviation. Then a line separates them there.
    /// On the motion back to the posture, no point moves farther than the greatest motion. So at the posture, the
    /// shapes overlap by at most that motion.
    pub fn greatest(&self, pair: Pair, deviation: Deviation) -> f64 {
        let (local, piece) = (self.scene.part(pair), self.scene.piece(pair));
        separation_at(local, &self.poses[pair.link], piece, |corners, here| {
            let room = here.distance + self.farthest_motion(pair, deviation);
            room + COLLISION_ROUNDING * self.scale(corners, local.radius(), piece)
        })
    }

    /// Returns a bound on all lengths in the computation of a distance. The rounding error of the distance is a
    /// fraction of this bound.
    pub fn scale(&self, corners: &[Point], radius: f64, piece: &Convex) -> f64 {
        let base = self.scene.arm().base;
        base.norm() + reach(corners, base) + radius.max(0.0) + piece.reach_from(base)
    }

    /// Returns a lower bound on the distance along a direction that is fixed in the plane. The corners of the link
    /// move, and so do those of a drifting obstacle.
    fn least_in_plane(&self, shapes: Shapes, corners: &[Point], n: Vector, deviation: Deviation) -> f64 {
        let Shapes { link, local, piece, drift } = shapes;
        let curvature = self.curvature_in_plane(link, deviation);
        let ahead = |p: &Point| n.dot(p);
        let Some(drift) = drift else {
            let line = piece.core().iter().map(ahead).fold(f64::INFINITY, f64::min);
            let mut least = f64::INFINITY;
            for (x, a) in corners.iter().zip(local.core()) {
                let toward = deviation.linear(self.rates(link, *x, n));
                least = least.min(line - ahead(x) - toward - curvature.of(*a) / 2.0);
            }
            return least;
        };
        // Both shapes move during the same fraction of the span, so common motion has no effect.
        let mut least = f64::INFINITY;
        for (x, a) in corners.iter().zip(local.core()) {
            let rates = self.rates(link, *x, n);
            for p in piece.core() {
                let toward = deviation.linear_less(rates, n.dot(&drift.of(*p)));
                least = least.min(ahead(p) - ahead(x) - toward - curvature.of(*a) / 2.0 - drift.error_bound(*p));
            }
        }
        least
    }

    /// Returns a lower bound on the distance along a direction that is fixed in the link. Seen from the link, the
    /// obstacle's corners move. Each corner has the opposite velocity of the link's point at the same place.
    fn least_in_link(&self, shapes: Shapes, corners: &[Point], n: Vector, deviation: Deviation) -> f64 {
        let Shapes { link, piece, .. } = shapes;
        let line = corners.iter().map(|p| n.dot(p)).fold(f64::NEG_INFINITY, f64::max);
        let mut least = f64::INFINITY;
        let curvature = self.curvature_in_link(link, deviation);
        for p in piece.core() {
            let gap = n.dot(p) - line;
            let toward = deviation.linear(self.rates(link, *p, n));
            least = least.min(gap - toward - curvature.of(*p) / 2.0);
        }
        least
    }

    /// Returns the velocity along `n`, per unit of each joint, of the point of link `link` that is currently at `x`.
    pub(super) fn rates(&self, link: usize, x: Point, n: Vector) -> [f64; 2] {
        let arm = self.scene.arm();
        let first = match arm.joints[0].joint_type {
            _ if link == 2 => 0.0,
            JointType::Revolute { sign } => sign * n.dot(&perpendicular(x - arm.base)),
            JointType::Prismatic { direction } => n.dot(&direction),
        };
        let second = match arm.joints[1].joint_type {
            _ if link == 0 => 0.0,
            JointType::Revolute { sign } => sign * n.dot(&perpendicular(x - self.elbows[link - 1])),
            JointType::Prismatic { direction } if link == 2 => n.dot(&direction),
            JointType::Prismatic { direction } => n.dot(&self.poses[0].direction(direction)),
        };
        [first, second]
    }

    /// Returns the bound on the acceleration in the plane of points that are fixed to the link.
    pub fn curvature_in_plane(&self, link: usize, deviation: Deviation) -> Curvature {
        use JointType::{Prismatic, Revolute};
        let arm = self.scene.arm();
        let [d1, d2] = deviation.greatest_components();
        let none = Curvature { center: Point::zeros(), shift: 0.0, factor: 0.0, constant: 0.0 };
        match (link, arm.joints[0].joint_type, arm.joints[1].joint_type) {
            (0, Revolute { .. }, _) => Curvature { factor: d1, ..none },
            (2, _, Revolute { .. }) => Curvature { factor: d2, ..none },
            (2, _, Prismatic { .. }) => none,
            (_, Revolute { .. }, Revolute { .. }) => {
                Curvature { factor: turn_of_link_2(arm, deviation), constant: arm.offset.norm() * d1 * d1, ..none }
            }
            (_, Revolute { .. }, Prismatic { direction }) => {
                let center = -(arm.offset + direction * self.q[1]);
                Curvature { center, shift: d2, factor: d1, constant: 2.0 * d1 * d2 }
            }
            (1, Prismatic { .. }, Revolute { .. }) => Curvature { factor: d2, ..none },
            _ => none,
        }
    }

    /// Returns the bound on the acceleration, as seen from the link, of points that are fixed in the plane.
    pub fn curvature_in_link(&self, link: usize, deviation: Deviation) -> Curvature {
        use JointType::{Prismatic, Revolute};
        let arm = self.scene.arm();
        let [d1, d2] = deviation.greatest_components();
        let about_base = Curvature { center: arm.base, shift: 0.0, factor: 0.0, constant: 0.0 };
        match (link, arm.joints[0].joint_type, arm.joints[1].joint_type) {
            (2, _, Revolute { .. }) => Curvature { center: self.elbows[1], factor: d2, ..about_base },
            (2, _, Prismatic { .. }) => about_base,
            (0, Revolute { .. }, _) | (_, Revolute { .. }, Prismatic { .. }) => Curvature { factor: d1, ..about_base },
            // y = R(-phi) (p - base) - R(-q2) offset
            (_, Revolute { .. }, Revolute { .. }) => {
                let constant = arm.offset.norm() * d2 * d2;
                Curvature { factor: turn_of_link_2(arm, deviation), constant, ..about_base }
            }
            (1, Prismatic { .. }, Revolute { .. }) => {
                Curvature { center: self.elbows[0], shift: d1, factor: d2, constant: 2.0 * d1 * d2 }
            }
            _ => about_base,
        }
    }

    /// Returns an upper bound on the motion over `deviation` of all points of the pair's part, metres.
    pub fn farthest_motion(&self, pair: Pair, deviation: Deviation) -> f64 {
        self.farthest_motion_of(pair.link, self.scene.part(pair), deviation)
    }

    fn farthest_motion_of(&self, link: usize, local: &Convex, deviation: Deviation) -> f64 {
        self.farthest_motion_within(link, local.reach_from(Point::zeros()), deviation)
    }

    /// Returns an upper bound on the motion over `deviation` of all points within `reach` of the origin of a link's frame,
    /// metres.
    pub fn farthest_motion_within(&self, link: usize, reach: f64, deviation: Deviation) -> f64 {
        use JointType::{Prismatic, Revolute};
        let arm = self.scene.arm();
        let [d1, d2] = deviation.greatest_components();
        match (link, arm.joints[0].joint_type, arm.joints[1].joint_type) {
            (0, first, _) => first.lever(reach) * d1,
            (2, _, second) => second.lever(reach) * d2,
            (_, Revolute { .. }, Revolute { .. }) => arm.offset.norm() * d1 + reach * turn_of_link_2(arm, deviation),
            (_, Revolute { .. }, Prismatic { direction }) => {
                ((arm.offset + direction * self.q[1]).norm() + d2 + reach) * d1 + d2
            }
            (_, Prismatic { .. }, Revolute { .. }) => d1 + reach * d2,
            (_, Prismatic { direction: one }, Prismatic { direction: two }) => match deviation {
                Deviation::Along(d) => (one * d[0] + two * d[1]).norm(),
                Deviation::Box(_) => d1 + d2,
                Deviation::Tube(d, h) => (one * d[0] + two * d[1]).norm() + h[0] + h[1],
            },
        }
    }
}

/// Returns centre and radius of a disc that contains a shape.
fn disc(shape: &Convex) -> (Point, f64) {
    let core = shape.core();
    let center = core.iter().sum::<Vector>() / core.len() as f64;
    let extent2 = core.iter().map(|p| (p - center).norm_squared()).fold(0.0, f64::max);
    (center, extent2.sqrt() + shape.radius())
}

/// Returns the greatest angle by which link 2 turns in the plane if both joints are revolute, radians.
fn turn_of_link_2(arm: &Arm, deviation: Deviation) -> f64 {
    deviation.linear(arm.joints.each_ref().map(|joint| joint.joint_type.turn()))
}
