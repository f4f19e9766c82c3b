//! The values of joint 1 at which the structure of a C-obstacle's slices can change, in closed form.

use cplan_geometry::{Convex, Point, Vector, cross, perpendicular, separation};
use cplan_interrupt::checkpoint;
use cplan_model::space::Configuration;
use cplan_model::{Arm, JointType};
use std::f64::consts::TAU;

/// Tolerance, metres, of two decisions: whether the foot of a perpendicular lies on a side, and whether a distance
/// equals the level. A large tolerance only adds values that are no events, which cost a slice each. A missed event
/// would invalidate the guarantee.
const FOOT_SLACK: f64 = 1e-7;

/// Returns values of `q1` at which an interval of `q2` can appear or vanish. In such an interval, `part` (of link 2, in its
/// frame) and `piece` are at most `level` apart. The result includes all such values, for a revolute joint 1 up to whole turns.
///
/// A connected part of `{ q : distance <= level }` has a point of least `q1`, unless it runs around the axis or out of
/// its range. At that point, the distance as a function of `q2` has a minimum. While the cores are disjoint, the
/// distance is the least distance of two of their points. So the minimum is also one of the distance of two fixed
/// points, whose derivative is zero there. For a revolute joint 2, the contact normal then passes through the joint.
/// For a prismatic one, it is perpendicular to the joint's direction. Either condition is one equation in `q1` for each
/// pair of features. `level` plus both radii must be positive. `O(n m)`.
pub(super) fn events(arm: &Arm, part: &Convex, piece: &Convex, level: f64) -> Vec<f64> {
    let radius = level + part.radius() + piece.radius();
    match arm.joints[1].joint_type {
        JointType::Revolute { sign } => Turning { arm, sign, part, piece, level, radius, found: Vec::new() }.solve(),
        JointType::Prismatic { direction } => sliding(arm, direction, part, piece, radius),
    }
}

/// Returns the events of a prismatic joint 2: the piece passes beside the part at a distance of exactly `radius`.
fn sliding(arm: &Arm, direction: Vector, part: &Convex, piece: &Convex, radius: f64) -> Vec<f64> {
    // If both joints are prismatic, the distance across the slides never changes, and no slices are needed.
    let JointType::Revolute { sign } = arm.joints[0].joint_type else { return Vec::new() };
    // Across the direction, the part has a fixed extent. The extent of the piece turns with joint 1.
    let track = part.core().iter().map(|a| cross(direction, arm.offset + a));
    let (low, high) = extent(track);
    let mut found = Vec::new();
    for p in piece.core() {
        let at = p - arm.base;
        for target in [low - radius, high + radius] {
            // cross(R(theta) direction, at) = |at| sin(arg at - arg direction - theta)
            let sine = target / at.norm();
            if sine.abs() <= 1.0 {
                let angle = at.y.atan2(at.x) - direction.y.atan2(direction.x);
                found.extend([angle - sine.asin(), angle + sine.asin() - TAU / 2.0].map(|theta| sign * theta));
            }
        }
    }
    // Keep only values at which this corner is the outermost of the piece.
    found.retain(|&q1| {
        let turned = arm.pose(0, Configuration::new(q1, 0.0)).direction(direction);
        let (near, far) = extent(piece.core().iter().map(|b| cross(turned, b - arm.base)));
        (near - high - radius).abs() <= FOOT_SLACK || (low - radius - far).abs() <= FOOT_SLACK
    });
    found
}

fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}

/// A point of the part's outline whose normal passes through the joint. It is a corner, or lies on a side.
struct Radial {
    /// Distance from the joint, metres.
    distance: f64,
    /// Unit direction from the joint, in the link's frame. `None` for a corner on the joint itself.
    heading: Option<Vector>,
    /// True if the outward normal points away from the joint.
    outward: bool,
}

/// The search for the events of a revolute joint 2.
struct Turning<'a> {
    arm: &'a Arm,
    sign: f64,
    part: &'a Convex,
    piece: &'a Convex,
    level: f64,
    radius: f64,
    found: Vec<f64>,
}

impl Turning<'_> {
    fn solve(mut self) -> Vec<f64> {
        for feature in radial_features(self.part.core()) {
            checkpoint();
            // There, the piece has the opposite normal, at a point whose distance from the joint differs by `radius`.
            let distance =
                if feature.outward { feature.distance + self.radius } else { feature.distance - self.radius };
            if distance >= 0.0 {
                self.sides_at(distance, &feature);
                self.corners_at(distance, &feature);
            }
        }
        self.found
    }

    /// Adds the values at which a side of the piece is at `distance` from the elbow, and the foot of the perpendicular
    /// is on the side.
    fn sides_at(&mut self, distance: f64, feature: &Radial) {
        let facing = if feature.outward { -1.0 } else { 1.0 };
        for (p, q) in sides(self.piece.core()) {
            let along = (q - p).normalize();
            let normal = -perpendicular(along);
            for q1 in self.elbow_on_line(normal, normal.dot(&p) - facing * distance) {
                let foot = along.dot(&(self.arm.elbow_at(q1) - p));
                if (-FOOT_SLACK..=(q - p).norm() + FOOT_SLACK).contains(&foot) {
                    self.consider(q1, facing * normal, feature);
                }
            }
        }
    }

    /// Adds the values at which a corner of the piece is at `distance` from the elbow, and the direction between them
    /// is among the corner's normals.
    fn corners_at(&mut self, distance: f64, feature: &Radial) {
        let core = self.piece.core();
        let n = core.len();
        let facing = if feature.outward { -1.0 } else { 1.0 };
        for i in 0..n {
            let p = core[i];
            for q1 in self.elbow_on_circle(p, distance) {
                let heading = p - self.arm.elbow_at(q1);
                let normal = facing * heading;
                let outermost = |w: Point| normal.dot(&(w - p)) <= FOOT_SLACK * (w - p).norm();
                if outermost(core[(i + 1) % n]) && outermost(core[(i + n - 1) % n]) {
                    self.consider(q1, heading, feature);
                }
            }
        }
    }

    /// Adds `q1`, unless the shapes are nearer than `level` when the feature points to `heading`.
    fn consider(&mut self, q1: f64, heading: Vector, feature: &Radial) {
        if let (Some(at), true) = (feature.heading, heading.norm() > FOOT_SLACK) {
            let turn = heading.y.atan2(heading.x) - at.y.atan2(at.x);
            let first = self.arm.joints[0].joint_type.turn() * q1;
            let pose = self.arm.pose(1, Configuration::new(q1, self.sign * (turn - first)));
            if separation(&self.part.at(&pose), self.piece).distance < self.level - FOOT_SLACK {
                return;
            }
        }
        self.found.push(q1);
    }

    /// Returns the values at which the elbow crosses the line `normal . x = offset`.
    fn elbow_on_line(&self, normal: Vector, offset: f64) -> Vec<f64> {
        let arm = self.arm;
        match arm.joints[0].joint_type {
            JointType::Revolute { sign } => {
                turns_to(arm.offset, normal, offset - normal.dot(&arm.base)).map(|theta| sign * theta).to_vec()
            }
            JointType::Prismatic { direction } => {
                let speed = normal.dot(&direction);
                let gap = offset - normal.dot(&(arm.base + arm.offset));
                if speed == 0.0 { Vec::new() } else { vec![gap / speed] }
            }
        }
        .into_iter()
        .filter(|q1| q1.is_finite())
        .collect()
    }

    /// Returns the values at which the elbow is at `distance` from `p`.
    fn elbow_on_circle(&self, p: Point, distance: f64) -> Vec<f64> {
        let arm = self.arm;
        match arm.joints[0].joint_type {
            JointType::Revolute { sign } => {
                let to = p - arm.base;
                let dot = (arm.offset.norm_squared() + to.norm_squared() - distance * distance) / 2.0;
                turns_to(arm.offset, to, dot).map(|theta| sign * theta).to_vec()
            }
            JointType::Prismatic { direction } => {
                let to = p - (arm.base + arm.offset);
                let (along, across) = (direction.dot(&to), cross(direction, to));
                let half = (distance * distance - across * across).sqrt();
                vec![along - half, along + half]
            }
        }
        .into_iter()
        .filter(|q1| q1.is_finite())
        .collect()
    }
}

/// Returns the two angles by which `v` must be turned so that its dot product with `w` is `dot`. NaN if there are no
/// such angles.
fn turns_to(v: Vector, w: Vector, dot: f64) -> [f64; 2] {
    let middle = w.y.atan2(w.x) - v.y.atan2(v.x);
    let half = (dot / (v.norm() * w.norm())).acos();
    [middle - half, middle + half]
}

/// Returns the points of an outline whose normal passes through the origin.
fn radial_features(core: &[Point]) -> Vec<Radial> {
    let n = core.len();
    let mut features = Vec::new();
    for i in 0..n {
        let a = core[i];
        let distance = a.norm();
        let neighbors = [core[(i + 1) % n] - a, core[(i + n - 1) % n] - a];
        for (outward, sense) in [(true, 1.0), (false, -1.0)] {
            if neighbors.iter().all(|w| sense * a.dot(w) <= FOOT_SLACK * w.norm()) {
                let heading = (distance > FOOT_SLACK).then(|| a / distance);
                features.push(Radial { distance, heading, outward });
            }
        }
    }
    for (p, q) in sides(core) {
        let along = (q - p).normalize();
        let normal = -perpendicular(along);
        let (offset, foot) = (normal.dot(&p), -along.dot(&p));
        if !(-FOOT_SLACK..=(q - p).norm() + FOOT_SLACK).contains(&foot) {
            continue;
        }
        for (outward, sense) in [(true, 1.0), (false, -1.0)] {
            if sense * offset >= -FOOT_SLACK {
                features.push(Radial { distance: (sense * offset).max(0.0), heading: Some(sense * normal), outward });
            }
        }
    }
    features
}

/// Iterates over the sides of a core. A segment has two sides.
fn sides(core: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    let n = if core.len() > 1 { core.len() } else { 0 };
    (0..n).map(move |i| (core[i], core[(i + 1) % n]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_geometry::{Hits, hull, sliding as slid, turning};
    use cplan_model::Joint;
    use cplan_model::space::JointRange;
    use proptest::prelude::*;

    fn shape() -> impl Strategy<Value = Convex> {
        (prop::collection::vec((-0.5..0.5f64, -0.5..0.5f64), 1..6), 0.0..0.2f64).prop_map(|(points, radius)| {
            let points: Vec<Point> = points.into_iter().map(|(x, y)| Point::new(x, y)).collect();
            Convex::trusted(hull(&points), radius)
        })
    }

    /// Returns an arm without outlines.
    fn arm(joints: [Joint; 2], offset: Vector) -> Arm {
        let mut arm = Arm::rr([1.0; 2], 0.1).expect("an arm");
        (arm.joints, arm.offset) = (joints, offset);
        arm.links.iter_mut().for_each(|link| link.parts.clear());
        arm
    }

    fn motion() -> impl Strategy<Value = JointType> {
        let slide = (0.0..TAU).prop_map(|t: f64| JointType::Prismatic { direction: Vector::new(t.cos(), t.sin()) });
        prop_oneof![prop_oneof![Just(1.0), Just(-1.0)].prop_map(|sign| JointType::Revolute { sign }), slide]
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(48))]

        /// Tests that between two close slices without an event in between, no interval appears away from all others.
        #[test]
        fn no_interval_appears_without_an_event(
            motions in [motion(), motion()],
            (part, piece) in (shape(), shape()),
            at in (-1.0..1.0f64, -1.0..1.0f64),
            level in 0.01..0.1f64,
        ) {
            prop_assume!(motions.iter().any(|m| m.is_revolute()));
            const STEP: f64 = 0.004;
            const NEAR: f64 = 0.05;
            let joint = |motion: JointType| Joint {
                name: "joint".into(),
                joint_type: motion,
                range: if motion.is_revolute() { JointRange::Circle } else { JointRange::Interval { lower: -3.0, upper: 3.0 } },
                velocity: 1.0,
                acceleration: 1.0,
                jerk: None,
            };
            let core = piece.core().iter().map(|p| p + Vector::new(at.0, at.1)).collect();
            let piece = Convex::trusted(core, piece.radius());
            let arm = arm(motions.map(joint), Vector::new(0.7, 0.1));
            let turns = motions[1].is_revolute();
            let slice = |q1: f64| {
                let pose = arm.pose(0, Configuration::new(q1, 0.0));
                let pivot = pose.point(arm.offset);
                let mut out = Vec::new();
                match motions[1] {
                    JointType::Revolute { .. } => {
                        // Use angles of the link instead of joint values. The structure is the same.
                        if turning(&part, pivot, &piece, level, &mut out) == Hits::Always {
                            out.push([-4.0, 4.0]);
                        }
                    }
                    JointType::Prismatic { direction } => {
                        let moved = part.at(&pose.shifted_in_frame(arm.offset));
                        out.extend(slid(&moved, pose.direction(direction), &piece, level));
                    }
                }
                out
            };
            let found = events(&arm, &part, &piece, level);
            let (start, steps) = (-3.0, 1500);
            for k in 0..steps {
                let (u, v) = (start + f64::from(k) * STEP, start + f64::from(k + 1) * STEP);
                let before = slice(u);
                let appears = slice(v).iter().any(|new| !before.iter().any(|old| {
                    let shifts: &[f64] = if turns { &[-TAU, 0.0, TAU] } else { &[0.0] };
                    shifts.iter().any(|s| old[0] + s <= new[1] + NEAR && new[0] <= old[1] + s + NEAR)
                }));
                let event = found.iter().any(|&q1| {
                    let q1 = if motions[0].is_revolute() { u + (q1 - u + 1e-6).rem_euclid(TAU) - 1e-6 } else { q1 };
                    u - 1e-6 <= q1 && q1 <= v + 1e-6
                });
                prop_assert!(!appears || event, "{u} {:?} {:?}", before, slice(v));
            }
        }
    }
}
