//! Masses of an arm, and the torques that move it.
//!
//! Let a body of mass `m` have its centre of mass at `p`, orientation `theta`, and inertia `I` about its centre and the plane's
//! normal. Its contribution to the torque of joint `k` is
//!
//! ```text
//! tau_k = m dp/dq_k . (p'' - g) + I dtheta/dq_k theta''
//! ```
//!
//! and the torque is the sum over all bodies (d'Alembert; Siciliano, Sciavicco, Villani, Oriolo, *Robotics*, 2009, section 7.1).
//! "Torque" means a torque in N m for a revolute joint, and a force in N for a prismatic one. Friction, gears and the inertia of
//! rotors are not included.

use cplan_geometry::{Convex, Point, Vector, perpendicular};
use cplan_model::space::Configuration;
use cplan_model::{Arm, Body, Dynamics, JointType, Scene};

/// Greatest magnitudes, on a part of a curve, of the derivatives of each joint's value by the parameter of the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rates {
    /// Greatest magnitude of the first derivative, for each joint.
    pub first: [f64; 2],
    /// Greatest magnitude of the second derivative, for each joint.
    pub second: [f64; 2],
    /// Greatest magnitude of the third derivative, for each joint.
    pub third: [f64; 2],
}

/// Upper bounds on the curvature of torques along a curve. Each joint's torque is a sum of three parts. The fields are bounds on
/// the second derivatives of these parts by the parameter of the curve.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Curvature {
    /// Bound for the first part: the torque that accelerates the joints along the curve's first derivative.
    pub inertial: [f64; 2],
    /// Bound for the second part: the torque that the curve's second derivative, and the square of its first one, require.
    pub bent: [f64; 2],
    /// Bound for the third part: the torque that holds the arm at rest.
    pub holding: [f64; 2],
}

/// Returns the body that two rigidly joined bodies form. All three have the same frame.
pub fn joined(a: &Body, b: &Body) -> Body {
    let mass = a.mass + b.mass;
    if mass == 0.0 {
        return Body { inertia: a.inertia + b.inertia, ..*a };
    }
    let center = (a.center * a.mass + b.center * b.mass) / mass;
    let about = |body: &Body| body.inertia + body.mass * (body.center - center).norm_squared();
    Body { mass, center, inertia: about(a) + about(b) }
}

/// Returns a body with this mass, in kg, evenly distributed over pieces that do not overlap. A rounded piece counts as its core,
/// without the radius, unless it is a disc.
pub fn spread(mass: f64, pieces: &[Convex]) -> Body {
    let sheets = pieces.iter().map(sheet).fold(Body::NONE, |sum, piece| joined(&sum, &piece));
    // Pieces have density 1, so their mass is their area.
    let density = if sheets.mass > 0.0 { mass / sheets.mass } else { 0.0 };
    Body { mass, inertia: density * sheets.inertia, ..sheets }
}

/// Returns a piece as a body of density 1.
fn sheet(piece: &Convex) -> Body {
    let core = piece.core();
    if let [center] = core[..] {
        let square = piece.radius() * piece.radius();
        let mass = std::f64::consts::PI * square;
        return Body { mass, center, inertia: mass * square / 2.0 };
    }
    // A fan of triangles. The inertia of a triangle about its centre is its mass times the sum of its squared sides, divided by
    // 36.
    let triangles = core.windows(2).skip(1).map(|side| {
        let corners = [core[0], side[0], side[1]];
        let [a, b, c] = [corners[1] - corners[0], corners[2] - corners[0], corners[2] - corners[1]];
        let mass = a.perp(&b).abs() / 2.0;
        let center = corners.iter().sum::<Vector>() / 3.0;
        Body { mass, center, inertia: mass * (a.norm_squared() + b.norm_squared() + c.norm_squared()) / 36.0 }
    });
    triangles.fold(Body::NONE, |sum, triangle| joined(&sum, &triangle))
}

/// Sets the dynamics of an arm so that its motions respect the joints' efforts, which also replace unspecified acceleration
/// limits. Changes nothing if masses or efforts are unknown.
pub fn keep_efforts(arm: &mut Arm) {
    let Some(mut dynamics) = arm.dynamics else { return };
    dynamics.limits = true;
    let greatest = Torques { arm, dynamics }.greatest_accelerations();
    for (k, joint) in arm.joints.iter_mut().enumerate().filter(|(k, _)| dynamics.assumed[*k]) {
        // Upper bound on the acceleration that this jerk allows between one top speed and the opposite one.
        let by_jerk = joint.jerk.map_or(f64::MAX, |jerk| (2.0 * jerk * joint.velocity).sqrt());
        joint.acceleration = greatest[k].min(by_jerk);
    }
    arm.dynamics = Some(dynamics);
}

/// Computes the torques of an arm's motions, from the arm and the masses that its joints move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Torques<'a> {
    /// The arm.
    pub arm: &'a Arm,
    /// Masses of the arm and of its load, and the efforts of the joints.
    pub dynamics: Dynamics,
}

/// A limited torque: a weighted sum of the torques of both joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitedTorque {
    /// Weights of the joints' torques.
    pub weights: [f64; 2],
    /// Greatest magnitude of the sum, N m or N.
    pub effort: f64,
    /// Index of the joint that has this torque. `None` for the first motor, if the elbow's motor is mounted on the base.
    pub joint: Option<usize>,
}

impl LimitedTorque {
    /// Returns the sum.
    pub fn of(&self, torques: Configuration) -> f64 {
        self.weights[0] * torques[0] + self.weights[1] * torques[1]
    }

    /// Returns the greatest magnitude of the sum, given the greatest magnitudes of the joints' torques.
    pub fn bound(&self, torques: [f64; 2]) -> f64 {
        self.weights[0].abs() * torques[0] + self.weights[1].abs() * torques[1]
    }
}

impl<'a> Torques<'a> {
    /// Iterates over the limited torques: those of both joints, and that of the first motor if it is limited. This motor also
    /// bears the torque of an elbow's motor on the base, which the belt transmits.
    pub fn limited_torques(&self) -> impl Iterator<Item = LimitedTorque> + use<> {
        let joint = |k: usize, weights| LimitedTorque { weights, effort: self.dynamics.effort[k], joint: Some(k) };
        let motor = self.arm.motors.and_then(|motors| {
            Some(LimitedTorque { weights: [1.0, -motors.ratio], effort: motors.effort?, joint: None })
        });
        [joint(0, [1.0, 0.0]), joint(1, [0.0, 1.0])].into_iter().chain(motor)
    }

    /// Returns the torques of a scene's arm. `None` if motions need not respect its efforts.
    pub fn limited(scene: &'a Scene) -> Option<Self> {
        let arm = scene.arm();
        let dynamics = arm.dynamics.filter(|dynamics| dynamics.limits)?;
        Some(Self { arm, dynamics })
    }

    /// Computes the torques of a motion at `q` with these joint speeds and accelerations.
    pub fn torque(&self, q: Configuration, velocity: Configuration, acceleration: Configuration) -> Configuration {
        let here = self.at(q);
        here.inertial(acceleration) + here.centrifugal(velocity) + here.holding()
    }

    /// Prepares the computation of torques in a configuration.
    pub fn at(&self, q: Configuration) -> TorquesAt<'_> {
        let columns = [0, 1].map(|link| self.arm.jacobian(link, self.dynamics.bodies[link].center, q));
        TorquesAt { torques: self, columns }
    }

    /// Returns an upper bound on the rate of change of torques along a part of a motion, which is within `reach` seconds of
    /// `middle` and has these derivatives.
    pub fn change(&self, middle: Configuration, reach: f64, rates: &Rates) -> [f64; 2] {
        let mut change = [0.0; 2];
        for (link, body) in self.dynamics.bodies.iter().enumerate() {
            let Bounds { column, motion } = bounds(self.arm, link, body.center, middle, reach, rates);
            let turn = is_turned(self.arm, link);
            let turning = turn[0] * rates.third[0] + turn[1] * rates.third[1];
            for (k, change) in change.iter_mut().enumerate() {
                let moved = column[k][1] * (motion[1] + self.dynamics.gravity.norm()) + column[k][0] * motion[2];
                *change += body.mass * moved + body.inertia * turn[k] * turning;
            }
        }
        change
    }

    /// Returns upper bounds on the curvature of torques along a part of a curve without third derivatives, which is within
    /// `reach` of `middle`, measured in the parameter.
    pub fn curvature(&self, middle: Configuration, reach: f64, rates: &Rates) -> Curvature {
        let mut curvature = Curvature::default();
        for (link, body) in self.dynamics.bodies.iter().enumerate() {
            let Bounds { column, motion } = bounds(self.arm, link, body.center, middle, reach, rates);
            for (k, column) in column.iter().enumerate() {
                // Bound on the second derivative of the product of a column and a derivative of the curve.
                let of = |n: usize| column[2] * motion[n] + 2.0 * column[1] * motion[n + 1] + column[0] * motion[n + 2];
                curvature.inertial[k] += body.mass * of(0);
                curvature.bent[k] += body.mass * of(1);
                curvature.holding[k] += body.mass * column[2] * self.dynamics.gravity.norm();
            }
        }
        curvature
    }

    /// Returns upper bounds on the magnitudes of the inertia matrix's entries in all configurations.
    pub fn greatest_inertia(&self) -> [[f64; 2]; 2] {
        let mut greatest = [[0.0; 2]; 2];
        for (link, body) in self.dynamics.bodies.iter().enumerate() {
            let (bounds, turn) = (everywhere(self.arm, link, body.center), is_turned(self.arm, link));
            for (k, row) in greatest.iter_mut().enumerate() {
                for (l, entry) in row.iter_mut().enumerate() {
                    *entry += body.mass * bounds.column[k][0] * bounds.column[l][0] + body.inertia * turn[k] * turn[l];
                }
            }
        }
        greatest
    }

    /// Returns upper bounds on the accelerations, in all configurations, of motions within speeds and efforts. Infinite for a
    /// joint that moves no mass.
    pub fn greatest_accelerations(&self) -> [f64; 2] {
        let mut pull = self.dynamics.effort;
        for (link, body) in self.dynamics.bodies.iter().enumerate() {
            let bounds = everywhere(self.arm, link, body.center);
            for (k, pull) in pull.iter_mut().enumerate() {
                *pull += body.mass * bounds.column[k][0] * (bounds.motion[1] + self.dynamics.gravity.norm());
            }
        }
        let (inertia, determinant) = (self.greatest_inertia(), self.least_determinant());
        [0, 1].map(|k| (inertia[1 - k][1 - k] * pull[k] + inertia[0][1] * pull[1 - k]) / determinant)
    }

    /// Returns a lower bound on the determinant of the inertia matrix in all configurations.
    pub fn least_determinant(&self) -> f64 {
        use JointType::{Prismatic, Revolute};
        let (arm, [a, b]) = (self.arm, &self.dynamics.bodies);
        let about = |body: &Body| body.inertia + body.mass * body.center.norm_squared();
        match (arm.joints[0].joint_type, arm.joints[1].joint_type) {
            (Revolute { .. }, Revolute { .. }) => about(a) * about(b) + b.mass * arm.offset.norm_squared() * b.inertia,
            (Revolute { .. }, Prismatic { .. }) => b.mass * (about(a) + b.inertia),
            (Prismatic { .. }, Revolute { .. }) => a.mass * about(b) + b.mass * b.inertia,
            (Prismatic { direction: first }, Prismatic { direction: second }) => {
                a.mass * b.mass + (b.mass * first.perp(&second)).powi(2)
            }
        }
    }
}

/// Computes torques in one configuration.
#[derive(Debug, Clone, Copy)]
pub struct TorquesAt<'a> {
    torques: &'a Torques<'a>,
    /// For each link, the derivative of its centre of mass by each joint.
    columns: [[Vector; 2]; 2],
}

impl TorquesAt<'_> {
    /// Computes the torques of accelerations alone: the inertia matrix times the accelerations.
    pub fn inertial(&self, acceleration: Configuration) -> Configuration {
        self.sum(|link, [first, second]| {
            let turning = turns(self.torques.arm, link).map(|turn| turn.unwrap_or(0.0));
            let along = first * acceleration[0] + second * acceleration[1];
            (along, turning[0] * acceleration[0] + turning[1] * acceleration[1])
        })
    }

    /// Computes the torques due to speeds alone: centrifugal and Coriolis forces.
    pub fn centrifugal(&self, velocity: Configuration) -> Configuration {
        self.sum(|link, columns| (bending(self.torques.arm, link, velocity, columns), 0.0))
    }

    /// Computes the torques that hold the arm at rest against gravity.
    pub fn holding(&self) -> Configuration {
        self.sum(|_, _| (-self.torques.dynamics.gravity, 0.0))
    }

    /// Computes the torques for given accelerations of each link's centre of mass and orientation.
    fn sum(&self, accelerations: impl Fn(usize, [Vector; 2]) -> (Vector, f64)) -> Configuration {
        let mut torque = Configuration::zeros();
        for (link, (body, columns)) in self.torques.dynamics.bodies.iter().zip(self.columns).enumerate() {
            let (moved, turned) = accelerations(link, columns);
            for (k, turn) in turns(self.torques.arm, link).into_iter().enumerate() {
                torque[k] += body.mass * columns[k].dot(&moved) + body.inertia * turn.unwrap_or(0.0) * turned;
            }
        }
        torque
    }
}

/// Returns the acceleration of a link's centre of mass at constant joint speeds.
fn bending(arm: &Arm, link: usize, v: Configuration, columns: [Vector; 2]) -> Vector {
    use JointType::{Prismatic, Revolute};
    let [first, second] = arm.joints.each_ref().map(|joint| joint.joint_type);
    // The lever from a joint's axis to the centre is the column, turned back by a quarter turn.
    let lever = |sign: f64, column: Vector| -perpendicular(column) * sign;
    match (first, second) {
        (Revolute { sign }, _) if link == 0 => -lever(sign, columns[0]) * (v[0] * v[0]),
        (Prismatic { .. }, _) if link == 0 => Vector::zeros(),
        (Revolute { sign: s1 }, Revolute { sign: s2 }) => {
            let outer = lever(s2, columns[1]);
            let inner = lever(s1, columns[0]) - outer;
            let turning = s1 * v[0] + s2 * v[1];
            -inner * (v[0] * v[0]) - outer * (turning * turning)
        }
        (Revolute { sign }, Prismatic { .. }) => {
            -lever(sign, columns[0]) * (v[0] * v[0]) + perpendicular(columns[1]) * (2.0 * sign * v[0] * v[1])
        }
        (Prismatic { .. }, Revolute { sign }) => -lever(sign, columns[1]) * (v[1] * v[1]),
        (Prismatic { .. }, Prismatic { .. }) => Vector::zeros(),
    }
}

/// Returns the derivative of a link's orientation by each joint: `None` for a joint that does not turn it.
fn turns(arm: &Arm, link: usize) -> [Option<f64>; 2] {
    [0, 1].map(|k| match arm.joints[k].joint_type {
        JointType::Revolute { sign } if k <= link => Some(sign),
        _ => None,
    })
}

/// Returns 1 for each joint that turns a link, and 0 for any other joint.
fn is_turned(arm: &Arm, link: usize) -> [f64; 2] {
    turns(arm, link).map(|turn| f64::from(u8::from(turn.is_some())))
}

/// Upper bounds on magnitudes for a point of a link, along a part of a curve.
struct Bounds {
    /// For each joint, bounds for the derivative of the point's position by the joint's value, and for the first two derivatives
    /// of this along the curve.
    column: [[f64; 3]; 2],
    /// Bounds on the first four derivatives of the point along the curve. The fourth is valid if the curve has no third
    /// derivative.
    motion: [f64; 4],
}

/// Returns bounds that are valid in all configurations, at constant speeds up to the joints' top speeds.
fn everywhere(arm: &Arm, link: usize, point: Point) -> Bounds {
    let velocity = arm.joints.each_ref().map(|joint| joint.velocity);
    let domains = arm.joints.each_ref().map(|joint| joint.range.domain());
    let middle = Configuration::from(domains.map(|(lower, upper)| f64::midpoint(lower, upper)));
    // Time in which each joint could move from the middle to an end of its range at top speed.
    let time = (0..2).map(|k| (domains[k].1 - domains[k].0) / 2.0 / velocity[k]).fold(0.0, f64::max);
    bounds(arm, link, point, middle, time, &Rates { first: velocity, second: [0.0; 2], third: [0.0; 2] })
}

fn bounds(arm: &Arm, link: usize, point: Point, middle: Configuration, reach: f64, rates: &Rates) -> Bounds {
    use JointType::{Prismatic, Revolute};
    const NO_MOTION: [f64; 3] = [0.0; 3];
    let Rates { first: v, second: a, third: j } = *rates;
    // Derivatives of a turning lever, from those of its angle.
    let lever = |length: f64, v: f64, a: f64, j: f64| {
        let fourth = v * v * v * v + 6.0 * v * v * a + 3.0 * a * a;
        [v, v * v + a, v * v * v + 3.0 * v * a + j, fourth].map(|by| length * by)
    };
    let column = |length: f64, motion: [f64; 4]| [length, motion[0], motion[1]];
    let slide = |k: usize| [v[k], a[k], j[k], 0.0];
    let plus = |x: [f64; 4], y: [f64; 4]| [0, 1, 2, 3].map(|n| x[n] + y[n]);
    let length = point.norm();
    let inner = arm.offset.norm();
    match (arm.joints[0].joint_type, arm.joints[1].joint_type) {
        (Revolute { .. }, _) if link == 0 => {
            let motion = lever(length, v[0], a[0], j[0]);
            Bounds { column: [column(length, motion), NO_MOTION], motion }
        }
        (Prismatic { .. }, _) if link == 0 => Bounds { column: [[1.0, 0.0, 0.0], NO_MOTION], motion: slide(0) },
        (Revolute { .. }, Revolute { .. }) => {
            let outer = lever(length, v[0] + v[1], a[0] + a[1], j[0] + j[1]);
            let motion = plus(lever(inner, v[0], a[0], j[0]), outer);
            Bounds { column: [column(inner + length, motion), column(length, outer)], motion }
        }
        (Revolute { .. }, Prismatic { direction }) => {
            let r = (arm.offset + direction * middle[1] + point).norm() + v[1] * reach;
            let turned = lever(1.0, v[0], a[0], j[0]);
            // Derivatives of the product of a turning lever and a changing length.
            let mixed = [
                0.0,
                2.0 * turned[0] * v[1],
                3.0 * turned[1] * v[1] + 3.0 * turned[0] * a[1],
                4.0 * turned[2] * v[1] + 6.0 * turned[1] * a[1],
            ];
            let motion = plus(plus(turned.map(|by| r * by), mixed), slide(1));
            Bounds { column: [column(r, motion), column(1.0, turned)], motion }
        }
        (Prismatic { .. }, Revolute { .. }) => {
            let outer = lever(length, v[1], a[1], j[1]);
            Bounds { column: [[1.0, 0.0, 0.0], column(length, outer)], motion: plus(slide(0), outer) }
        }
        (Prismatic { .. }, Prismatic { .. }) => {
            Bounds { column: [[1.0, 0.0, 0.0]; 2], motion: plus(slide(0), slide(1)) }
        }
    }
}
