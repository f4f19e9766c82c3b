//! The planar two-joint arm and its kinematics.

use super::{Dynamics, Joint, JointType, Link, Motors, SelfObstacle};
use crate::space::{Configuration, LimitedValue, Metric, SumSpeed, Topology};
use cplan_geometry::{ConvexError, Point, Pose, Vector, perpendicular};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// The plane of motion, given by vectors in the URDF's root frame. A point `x` of that frame has the plane
/// coordinates `(x . u, x . v)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// First basis vector.
    pub u: Vector3<f64>,
    /// Second basis vector.
    pub v: Vector3<f64>,
    /// Direction along which heights are measured.
    pub normal: Vector3<f64>,
}

/// A planar arm with two joints in series.
///
/// Kinematics. `link 1` moves by joint 1 about (or along) `base`; joint 2 sits at `offset` from joint 1 in link 1's
/// frame. With `T(v)` a translation and `M_i(q_i)` the joint's motion, a rotation by `sign q_i` or a translation by
/// `q_i direction`,
///
/// ```text
/// pose of link 1 = T(base) M_1(q1)
/// pose of link 2 = T(base) M_1(q1) T(offset) M_2(q2)
/// ```
///
/// All frames are parallel to the plane's axes at the zero configuration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Arm {
    /// The robot's name.
    pub name: String,
    /// The joints, from base to tip.
    pub joints: [Joint; 2],
    /// The links: joint 1 carries the first, joint 2 the second.
    pub links: [Link; 2],
    /// Position of joint 1 in plane coordinates, metres.
    pub base: Point,
    /// Vector from joint 1 to joint 2 in link 1's frame, metres, with joint 2 at zero.
    pub offset: Vector,
    /// Position of the tip in link 2's frame, metres.
    pub tip: Point,
    /// Name of the tip's URDF link.
    pub tip_name: String,
    /// The plane of motion.
    pub plane: Plane,
    /// Masses, gravity and efforts; `None` if unknown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dynamics: Option<Dynamics>,
    /// Motors of two joints that turn; `None` if unknown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motors: Option<Motors>,
    /// Links of the robot that can collide with its other links.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub self_obstacles: Vec<SelfObstacle>,
}

impl Arm {
    /// Creates an arm whose joint 2 and tip lie on the x axis of the links at zero, with joint 1 at the origin. Joint 2
    /// is at `reaches[0]` from joint 1, and the tip at `reaches[1]` from joint 2, metres.
    pub fn new(joints: [Joint; 2], links: [Link; 2], reaches: [f64; 2]) -> Self {
        let plane = Plane { u: Vector3::x(), v: Vector3::y(), normal: Vector3::z() };
        let [offset, tip] = reaches;
        Self {
            name: "arm".into(),
            joints,
            links,
            base: Point::zeros(),
            offset: Vector::new(offset, 0.0),
            tip: Point::new(tip, 0.0),
            tip_name: "tip".into(),
            plane,
            dynamics: None,
            motors: None,
            self_obstacles: Vec::new(),
        }
    }

    /// Creates an arm of two bars of these lengths and this width with round ends, metres, on continuous joints.
    ///
    /// ```
    /// let arm = cplan_model::Arm::rr([1.0, 0.8], 0.06).expect("an arm");
    /// assert_eq!((arm.kind(), arm.reach()), ("RR", 1.83));
    /// ```
    ///
    /// # Errors
    /// Same as for [`Link::bar`].
    pub fn rr(lengths: [f64; 2], width: f64) -> Result<Self, ConvexError> {
        let links = [Link::bar("link 1", lengths[0], width)?, Link::bar("link 2", lengths[1], width)?];
        Ok(Self::new([Joint::continuous("joint 1"), Joint::continuous("joint 2")], links, lengths))
    }

    /// Returns the arm with its root frame moved to `place`: rotated first, then translated.
    #[must_use]
    pub fn placed(&self, place: &Pose) -> Self {
        let (mut arm, turn) = (self.clone(), place.rotation);
        arm.base = place.point(self.base);
        // Without a turn all numbers stay unchanged.
        if turn.angle() != 0.0 {
            (arm.offset, arm.tip) = (turn * self.offset, turn * self.tip);
            let turned = Pose { rotation: turn, translation: Vector::zeros() };
            for part in arm.links.iter_mut().flat_map(|link| &mut link.parts) {
                part.shape = part.shape.at(&turned);
                part.inner = part.inner.as_ref().map(|inner| inner.at(&turned));
            }
            for joint in &mut arm.joints {
                if let JointType::Prismatic { direction } = &mut joint.joint_type {
                    *direction = turn * *direction;
                }
            }
            for body in arm.dynamics.iter_mut().flat_map(|dynamics| &mut dynamics.bodies) {
                body.center = turn * body.center;
            }
        }
        arm.self_obstacles.iter_mut().for_each(|own| own.obstacle = own.obstacle.at(place));
        arm
    }

    /// Returns the space of configurations.
    pub fn topology(&self) -> Topology {
        let sum = self.motors.and_then(|motors| motors.sum_range());
        Topology { ranges: [self.joints[0].range, self.joints[1].range], sum }
    }

    /// Returns the angles of both motors' shafts at joint values, radians. Empty if the motors are unknown.
    pub fn motor_angles<'a>(&self, positions: impl IntoIterator<Item = &'a [f64; 2]>) -> Vec<[f64; 2]> {
        let angles = |motors: Motors| positions.into_iter().map(|q| motors.angles((*q).into())).collect();
        self.motors.map(angles).unwrap_or_default()
    }

    /// Returns the metric of travel time with the joints and the elbow's motor at their top speeds.
    pub fn time_metric(&self) -> Metric {
        let sum = self.motors.and_then(|motors| Some(SumSpeed { ratio: motors.ratio, speed: motors.velocity? }));
        Metric::Time { speeds: self.joints.each_ref().map(|joint| joint.velocity), sum }
    }

    /// Returns true if the jerk of a joint or of the elbow's motor is limited.
    pub fn limits_jerks(&self) -> bool {
        self.joints.iter().any(|joint| joint.jerk.is_some()) || self.motors.is_some_and(|motors| motors.jerk.is_some())
    }

    /// Names a limit in a message: `joint "elbow"`, `the elbow's motor`.
    pub fn describe_limit(&self, limited: LimitedValue) -> String {
        match limited {
            LimitedValue::Joint(joint) => format!("joint \"{}\"", self.joints[joint].name),
            LimitedValue::Sum => "the elbow's motor".into(),
        }
    }

    /// Returns true if both joints are revolute.
    pub fn only_turns(&self) -> bool {
        self.joints.iter().all(|joint| joint.joint_type.is_revolute())
    }

    /// Returns `RR`, `RP`, `PR` or `PP`: the types of joints 1 and 2, R for revolute and P for prismatic.
    pub fn kind(&self) -> &'static str {
        match (self.joints[0].joint_type.is_revolute(), self.joints[1].joint_type.is_revolute()) {
            (true, true) => "RR",
            (true, false) => "RP",
            (false, true) => "PR",
            (false, false) => "PP",
        }
    }

    /// Returns the unit of lengths in joint space: `rad` or `m`. `in joint space` if the joints have different units, because
    /// such a length has none.
    pub fn length_unit(&self) -> &'static str {
        let [first, second] = self.joints.each_ref().map(Joint::unit);
        if first == second { first } else { "in joint space" }
    }

    /// Returns the unit of lengths in a metric. `weighted` if the metric weighs the joints.
    pub fn unit_in(&self, metric: Metric) -> &'static str {
        match metric {
            Metric::Euclidean => self.length_unit(),
            Metric::Weighted { .. } => "weighted",
            Metric::Time { .. } => "s at top speed",
            Metric::Motor { .. } => "rad of the motors",
        }
    }

    /// Returns a length in joint space with its unit: `4.5534 rad`.
    pub fn format_length(&self, length: f64) -> String {
        format!("{length:.4} {}", self.length_unit())
    }

    /// Returns true if both joints are prismatic.
    pub fn is_gantry(&self) -> bool {
        !self.joints.iter().any(|joint| joint.joint_type.is_revolute())
    }

    /// Returns the pose of link 1 (`index` 0), of link 2 (1), or of link 2 while joint 1 stays at zero (2), which is
    /// its pose relative to link 1.
    pub fn pose(&self, index: usize, q: Configuration) -> Pose {
        let q = if index == 2 { Configuration::new(0.0, q[1]) } else { q };
        let first = motion(self.joints[0].joint_type, q[0]).shifted(self.base);
        if index == 0 {
            return first;
        }
        first.shifted_in_frame(self.offset) * motion(self.joints[1].joint_type, q[1])
    }

    /// Returns both link poses.
    pub fn poses(&self, q: Configuration) -> [Pose; 2] {
        let [first, second, _] = self.pair_poses(q);
        [first, second]
    }

    /// Returns the pose of the part of every kind of pair, indexed by [`super::Pair::link`].
    pub fn pair_poses(&self, q: Configuration) -> [Pose; 3] {
        let second = motion(self.joints[1].joint_type, q[1]).shifted(self.offset);
        let [first, at_zero] = [q[0], 0.0].map(|value| self.pose(0, Configuration::new(value, 0.0)));
        [first, first * second, at_zero * second]
    }

    /// Returns an upper bound, in metres and positive, on the distance from joint 1 to the tip and to any point of the
    /// links' outlines, with both joints at zero. Tolerances are multiples of this bound.
    pub fn reach(&self) -> f64 {
        let of = |link: usize| self.links[link].parts.iter().map(|p| p.shape.reach_from(Point::zeros()));
        let first = of(0).fold(self.offset.norm(), f64::max);
        let second = of(1).fold(self.tip.norm(), f64::max);
        (first.max(self.offset.norm() + second)).max(f64::MIN_POSITIVE)
    }

    /// Returns the position of the tip in the plane.
    pub fn tip_at(&self, q: Configuration) -> Point {
        self.pose(1, q).point(self.tip)
    }

    /// Returns the position of joint 2 in the plane. For a prismatic joint 2 this is the origin of its values.
    pub fn elbow_at(&self, q1: f64) -> Point {
        self.pose(0, Configuration::new(q1, 0.0)).point(self.offset)
    }

    /// Returns the two columns of the Jacobian for the point `p` of link `index` (0 or 1), given in that link's
    /// frame: its velocity in the plane per unit of each joint's speed.
    pub fn jacobian(&self, index: usize, p: Point, q: Configuration) -> [Vector; 2] {
        let poses = self.poses(q);
        let at = poses[index].point(p);
        let first = match self.joints[0].joint_type {
            JointType::Revolute { sign } => sign * perpendicular(at - self.base),
            JointType::Prismatic { direction } => direction,
        };
        if index == 0 {
            return [first, Vector::zeros()];
        }
        let second = match self.joints[1].joint_type {
            JointType::Revolute { sign } => sign * perpendicular(at - poses[0].point(self.offset)),
            JointType::Prismatic { direction } => poses[0].direction(direction),
        };
        [first, second]
    }
}

fn motion(joint_type: JointType, value: f64) -> Pose {
    match joint_type {
        JointType::Revolute { sign } => Pose::rotation(sign * value),
        JointType::Prismatic { direction } => Pose::translation(value * direction),
    }
}
