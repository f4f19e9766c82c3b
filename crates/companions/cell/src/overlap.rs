//! Proofs that two convex bodies are too near to each other for all deviations of both arms.
//!
//! Two bodies are nearer than a distance `d` if for each unit vector `n`, the gap between their supporting lines along `n` is less
//! than `d`. Let `a` be a corner of the first body and `b` one of the second. The gap along `n` is at most `n . (b - a) - r`, with
//! the sum `r` of both radii. While the joints deviate, it grows by at most `|n . J| h` for each joint, with the rate `J` of the
//! corner and the greatest deviation `h`, and by half of a bound `K` on the curvature of both corners' motions. So it suffices that
//!
//! `n . (b - a) + sum |n . J| h + (K / 2 - r - d) |n| < 0`.
//!
//! Let `n` be the sum of two vectors along the ends of a sector of directions. The first two terms are convex and homogeneous: they
//! are at most the sum of their values for both vectors. `|n|` is at least the sum of both lengths, times the cosine of half of the
//! sector's angle. So a test at the ends of each sector suffices. The sectors end at the normals of all sides, and at further
//! directions. Each sector has its own pair of corners.

use cplan_geometry::{Point, Vector, perpendicular};
use cplan_judge::Deviation;
use cplan_model::space::Configuration;
use std::sync::LazyLock;

/// Number of sectors in which all directions are divided, in addition to the normals of sides.
const SECTORS: usize = 16;

/// The directions at which sectors end, in the order of [`angle`].
static DIRECTIONS: LazyLock<[Vector; SECTORS]> = LazyLock::new(|| {
    std::array::from_fn(|k| {
        let (sin, cos) = (std::f64::consts::TAU * (k as f64 / SECTORS as f64 - 0.5)).sin_cos();
        Vector::new(cos, sin)
    })
});

/// A corner of a body that moves.
pub(crate) struct Corner {
    pub at: Point,
    /// Its velocity per unit of each joint.
    pub rates: [Vector; 2],
    /// Half of the bound on the second derivative of its motion, metres.
    pub bend: f64,
}

/// A body of an arm that deviates from a configuration.
pub(crate) struct Moving {
    /// Counter-clockwise.
    pub corners: Vec<Corner>,
    pub radius: f64,
    pub deviation: Deviation,
}

/// The overlap of two bodies, compared with their motion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Overlap {
    /// Bound on the motion as a share of the depth: the greatest for all directions. Below 1, the bodies are proven to be too near
    /// for all deviations. Infinite if they are not too near at the configurations themselves.
    pub share: f64,
    /// Rates of the gap in this direction by the joints of both arms.
    pub rates: [[f64; 2]; 2],
}

impl Overlap {
    /// No overlap.
    pub const NONE: Self = Self { share: f64::INFINITY, rates: [[0.0; 2]; 2] };
}

impl Moving {
    /// Returns the corner that is farthest in a direction.
    fn farthest(&self, n: Vector) -> &Corner {
        let mut corners = self.corners.iter();
        let first = corners.next().expect("shapes have corners");
        corners
            .fold((first, n.dot(&first.at)), |best, corner| {
                let far = n.dot(&corner.at);
                if far > best.1 { (corner, far) } else { best }
            })
            .0
    }

    /// Appends the outward normals of the sides, times a sign.
    fn normals(&self, sign: f64, directions: &mut Vec<Vector>) {
        for (k, p) in self.corners.iter().enumerate() {
            let q = &self.corners[(k + 1) % self.corners.len()];
            directions.extend((-perpendicular(q.at - p.at) * sign).try_normalize(0.0));
        }
    }
}

/// Compares the overlap of two bodies with their motion. They are too near to each other if they are nearer than `clearance`.
pub(crate) fn overlap([one, two]: [&Moving; 2], clearance: f64, rounding: f64) -> Overlap {
    let mut directions: Vec<Vector> = Vec::with_capacity(SECTORS + 16);
    directions.extend(&*DIRECTIONS);
    one.normals(1.0, &mut directions);
    two.normals(-1.0, &mut directions);
    directions.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    let radius = one.radius + two.radius + clearance;
    let mut most = Overlap { share: 0.0, ..Overlap::NONE };
    for (k, first) in directions.iter().enumerate() {
        let ends = [*first, directions[(k + 1) % directions.len()]];
        let cosine = f64::midpoint(1.0, ends[0].dot(&ends[1])).sqrt();
        let middle = ends[0] + ends[1];
        let (a, b) = (one.farthest(middle), two.farthest(-middle));
        for n in ends {
            let rates = [a, b].map(|corner| corner.rates.map(|rate| n.dot(&rate)));
            let motion = linear(one.deviation, rates[0]) + linear(two.deviation, rates[1]) + a.bend + b.bend + rounding;
            let depth = radius * if radius > 0.0 { cosine } else { 1.0 } - n.dot(&(b.at - a.at));
            if depth <= 0.0 {
                return Overlap::NONE;
            }
            if motion > most.share * depth {
                most = Overlap { share: motion / depth, rates };
            }
        }
    }
    most
}

/// Returns a value that grows with the angle of a unit vector, from -2 to 2.
fn angle(n: &Vector) -> f64 {
    (1.0 - n.x).copysign(n.y)
}

/// Returns the greatest value of `|g_1 d_1 + g_2 d_2|` over deviations.
fn linear(deviation: Deviation, g: [f64; 2]) -> f64 {
    let along = |d: Configuration| (g[0] * d[0] + g[1] * d[1]).abs();
    let within = |h: [f64; 2]| g[0].abs() * h[0] + g[1].abs() * h[1];
    match deviation {
        Deviation::Along(d) => along(d),
        Deviation::Box(h) => within(h),
        Deviation::Tube(d, h) => along(d) + within(h),
    }
}

#[cfg(test)]
mod tests {
    use crate::between::Between;
    use cplan_cases::dice::Dice;
    use cplan_geometry::{Convex, Point, Vector, hull};
    use cplan_judge::Deviation;
    use cplan_model::space::Configuration;
    use cplan_model::{Arm, Joint, Link, Scene, Workspace};

    /// Number of directions in which the oracle compares shapes.
    const DIRECTIONS: usize = 360;

    /// Returns a random polygon or disc near a point.
    fn random_shape(dice: &mut Dice, near: Point) -> Convex {
        let corners = [1, 2, 4, 7][dice.below(4_usize)];
        let mut offset = |size: f64| Vector::new(dice.within(-size, size), dice.within(-size, size));
        let corners: Vec<Point> = (0..corners).map(|_| near + offset(0.3)).collect();
        Convex::new(hull(&corners), dice.within(0.01, 0.2)).unwrap()
    }

    /// Returns an arm with a shape on each link.
    fn random_scene(dice: &mut Dice, base: [f64; 2]) -> Scene {
        let joints = ["one", "two"].map(|name| match dice.chance(0.7) {
            true => Joint::turning(name, -3.0, 3.0),
            false => Joint::sliding(name, Vector::new(0.6, 0.8), -3.0, 3.0),
        });
        let link = |dice: &mut Dice, name: &str| Link::of(name, [random_shape(dice, Point::new(0.4, 0.0))]);
        let links = [link(dice, "one"), link(dice, "two")];
        let arm = Arm::new(joints.map(|joint| joint.at_most(1.0, 1.0)), links, [0.8, 0.0]);
        Scene::new(Arm { base: base.into(), ..arm }, Workspace::new([])).unwrap()
    }

    /// Returns the greatest gap between the shapes of two arms, seen from some directions.
    fn gap(scenes: [&Scene; 2], at: [Configuration; 2]) -> f64 {
        let corners = |side: usize, link: usize| {
            let (arm, shape) = (scenes[side].arm(), &scenes[side].arm().links[link].parts[0].shape);
            let pose = arm.pose(link, at[side]);
            (shape.core().iter().map(|p| pose.point(*p)).collect::<Vec<Point>>(), shape.radius())
        };
        let pairs = (0..4).map(|k| (corners(0, k / 2), corners(1, k % 2)));
        let gap = |((a, r), (b, s)): ((Vec<Point>, f64), (Vec<Point>, f64))| {
            let along = |k: usize| {
                let angle = std::f64::consts::TAU * k as f64 / DIRECTIONS as f64;
                let n = Vector::new(angle.cos(), angle.sin());
                let last = a.iter().map(|p| n.dot(p)).fold(f64::NEG_INFINITY, f64::max);
                b.iter().map(|p| n.dot(p)).fold(f64::INFINITY, f64::min) - last - r - s
            };
            (0..DIRECTIONS).map(along).fold(f64::NEG_INFINITY, f64::max)
        };
        pairs.map(gap).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn arms_are_too_near_for_all_deviations() {
        let (mut proven, mut by_motion) = (0, 0);
        for seed in cplan_cases::seeds(2000) {
            let mut dice = Dice::new(seed);
            let scenes = [random_scene(&mut dice, [0.0, 0.0]), random_scene(&mut dice, [0.9, 0.3])];
            let scenes = scenes.each_ref();
            let between = Between::new(scenes, false, [0.0, 0.02][dice.below(2_usize)]);
            let mut pair = |size: f64| [dice.within(-size, size), dice.within(-size, size)];
            let at = [0, 1].map(|_| Configuration::from(pair(1.5)));
            let (along, within) = ([0, 1].map(|_| pair(0.2)), [0, 1].map(|_| pair(0.2).map(f64::abs)));
            let kind = dice.below(3_usize);
            let deviations = [0, 1].map(|side| match kind {
                0 => Deviation::Along(along[side].into()),
                1 => Deviation::Box(within[side]),
                _ => Deviation::Tube(along[side].into(), within[side].map(|h| h / 4.0)),
            });
            let swept = [0, 1].map(|side| between.swept(side, at[side], deviations[side]));
            let overlap = between.overlap(swept.each_ref());
            if overlap.share >= 1.0 {
                continue;
            }
            proven += 1;
            by_motion += usize::from(overlap.rates == [[0.0; 2]; 2]);
            for _ in 0..40 {
                let moved = [0, 1].map(|side| {
                    // Extreme deviations are the most dangerous ones.
                    let mut part = || {
                        if dice.chance(0.5) { 1.0_f64.copysign(dice.within(-1.0, 1.0)) } else { dice.within(-1.0, 1.0) }
                    };
                    let (t, u, v) = (part(), part(), part());
                    let along = Configuration::from(along[side]) * t;
                    let within = |size: f64| Configuration::new(within[side][0] * u * size, within[side][1] * v * size);
                    at[side]
                        + match kind {
                            0 => along,
                            1 => within(1.0),
                            _ => along + within(0.25),
                        }
                });
                let gap = gap(scenes, moved);
                assert!(gap < between.clearance + 1e-9, "seed {seed}: {gap} m");
            }
        }
        if cplan_cases::uses_default_cases() {
            assert!(proven >= 200 && proven >= by_motion + 60, "{proven} {by_motion}");
        }
    }
}
