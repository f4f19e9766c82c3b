//! Bounds on distances for an arm that differs from its model.
//!
//! A point of link 2 is at `R0 (A + R1 (B + R2 C))`. `R0` is the rotation of the base, and `R1` and `R2` are those of
//! the joints. `A` leads to joint 1, `B` from there to joint 2, and `C` from joint 2 to the point. Errors of the model
//! and the motion change these rotations and vectors. If all of them change linearly, the term of a vector `w` has a
//! second derivative of at most `W^2 |w| + 2 W |w'|`, where `W` is the change of its angle. Taylor's formula then
//! bounds the distance, as in [`Posture::bound`].

use super::deviation::{Deviation, Posture, ROUNDING, SpanPair};
use cplan_geometry::{Point, Vector, perpendicular, separation_at};
use cplan_model::{Arm, Grip, Pair, Scene};

/// Greatest errors of an arm's model. They may have any sign, and occur at the same time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ArmErrors {
    /// Displacement of the base in any direction, metres.
    pub base: f64,
    /// Rotation of the base about the origin of the plane, radians.
    pub base_angle: f64,
    /// Errors of two distances, metres: from joint 1 to joint 2, and from joint 2 to the tip. Each point of a link
    /// moves along the link by at most this distance.
    pub lengths: [f64; 2],
    /// Error of the zero of each joint, radians or metres.
    pub zeros: [f64; 2],
}

/// A vector of the kinematic chain, with bounds on its changes.
#[derive(Clone, Copy, Default)]
struct Term {
    length: f64,
    /// Greatest change of its angle, radians.
    turn: f64,
    /// Greatest change of the unrotated vector, metres.
    change: f64,
}

impl Term {
    /// Returns a bound on the second derivative of the turned vector.
    fn curvature(self) -> f64 {
        self.turn * (self.turn * (self.length + self.change) + 2.0 * self.change)
    }

    /// Returns a bound on the change of the turned vector.
    fn motion(self) -> f64 {
        self.turn * (self.length + self.change) + self.change
    }
}

/// Bounds on the changes of a link through a deviation and errors of the arm.
struct Changes {
    /// The vectors to joint 1, and from there to joint 2.
    chain: [Term; 2],
    /// Displacement of the base, metres, and its rotation, radians.
    base: [f64; 2],
    /// Rotation of the link relative to the base, and relative to the previous link, radians.
    turns: [f64; 2],
    /// Displacement of the link's points along the link, metres.
    stretch: f64,
    /// Positions of joint 1 and of the link's joint, which are the pivots of both rotations when they are undone.
    pivots: [Point; 2],
}

impl Changes {
    fn new(posture: &Posture, link: usize, deviation: Deviation, errors: &ArmErrors) -> Self {
        let arm = posture.scene.arm();
        let greatest = deviation.greatest_components();
        let is_revolute = [0, 1].map(|k| arm.joints[k].joint_type.is_revolute());
        let zeros = |is: bool| [0, 1].map(|k| if is_revolute[k] == is { errors.zeros[k] } else { 0.0 });
        let moved = |is: bool| [0, 1].map(|k| if is_revolute[k] == is { greatest[k] + errors.zeros[k] } else { 0.0 });
        let (turns, slides) = (moved(true), moved(false));
        let sum = deviation.linear(arm.joints.each_ref().map(|joint| joint.joint_type.turn()))
            + zeros(true).iter().sum::<f64>();
        let first = posture.poses[0].translation;
        let to_first = Term { length: first.norm(), turn: errors.base_angle, change: slides[0] };
        let to_second = |from: Point, turn: f64| {
            let length = (posture.poses[link].translation - from).norm();
            Term { length, turn, change: errors.lengths[0] + slides[1] }
        };
        let (chain, turns) = match link {
            0 => ([to_first, Term::default()], [turns[0]; 2]),
            1 => ([to_first, to_second(first, errors.base_angle + turns[0])], [sum, turns[1]]),
            // The obstacle moves with joint 1.
            _ => ([Term::default(), to_second(arm.base, 0.0)], [turns[1]; 2]),
        };
        Self {
            chain,
            base: [errors.base, errors.base_angle],
            turns,
            stretch: errors.lengths[link.min(1)],
            pivots: [first, posture.poses[link].translation],
        }
    }

    /// Returns the term of a point of the link, at this distance from the link's joint.
    fn point(&self, distance: f64) -> Term {
        Term { length: distance, turn: self.base[1] + self.turns[0], change: self.stretch }
    }

    /// Returns a bound on the motion of the link's points up to this distance from its joint.
    fn motion(&self, reach: f64) -> f64 {
        self.base[0] + self.chain.into_iter().chain([self.point(reach)]).map(Term::motion).sum::<f64>()
    }

    /// Returns a bound on the second derivative of the position of a point of the link.
    fn curvature_in_plane(&self, distance: f64) -> f64 {
        self.chain.into_iter().chain([self.point(distance)]).map(Term::curvature).sum()
    }

    /// Returns a bound on the second derivative of the position of a point of the plane, as seen from the link.
    fn curvature_in_link(&self, link: usize, p: Point) -> f64 {
        let ([shift, angle], [turn, last], [first, second]) = (self.base, self.turns, self.pivots);
        let [to_first, to_second] = self.chain;
        let of = |length: f64, turn: f64, change: f64| Term { length, turn, change }.curvature();
        let before = match link {
            2 => return of((p - second).norm(), last, to_second.change),
            _ if angle == 0.0 => of((p - first).norm(), turn, shift + to_first.change),
            _ => of(p.norm(), angle + turn, shift) + of(to_first.length, turn, to_first.change),
        };
        if link == 0 { before } else { before + of(to_second.length, last, to_second.change) }
    }
}

impl Posture<'_> {
    /// Returns true if a pair is proven to be apart during a span of a motion ([`Posture::bound_during`]), for all arms
    /// within these errors. `known` is a distance, in metres, that the pair provably keeps without errors, or 0. Links
    /// of the robot move with its base.
    pub fn is_apart_with_errors(&self, during: SpanPair, deviation: Deviation, errors: &ArmErrors, known: f64) -> bool {
        let SpanPair { pair, part, drift } = during;
        let Pair { link, .. } = pair;
        let errors = match self.scene.self_obstacle(pair.obstacle) {
            Some(_) => ArmErrors { base: 0.0, base_angle: 0.0, ..*errors },
            None => *errors,
        };
        let local = part.unwrap_or(self.scene.part(pair));
        let (wrist, reach) = (wrist_motion(self.scene, pair, &errors), local.reach_from(Point::zeros()));
        if known > 0.0 && known > Changes::new(self, link, self.slides(deviation), &errors).motion(reach) + wrist {
            return true;
        }
        let changes = Changes::new(self, link, deviation, &errors);
        let motion = changes.motion(reach) + wrist;
        if self.disc_bound_during(during, Deviation::Box([0.0; 2])) > motion {
            return true;
        }
        let moved = drift.map(|drift| self.scene.piece(pair).at(&drift.middle));
        let piece = moved.as_ref().unwrap_or(self.scene.piece(pair));
        let lengthwise = self.lengthwise(link);
        separation_at(local, &self.poses[link], piece, |corners, here| {
            let n = here.direction;
            let room = ROUNDING * self.scale(corners, local.radius(), piece) + wrist;
            let drifts = drift.map_or(0.0, |drift| drift.farthest(piece.reach_from(drift.middle.translation)));
            if here.distance - motion - drifts > room {
                return true;
            }
            let room = room + local.radius() + piece.radius();
            // Errors move the point at `x` towards the obstacle by at most this, to first order.
            let toward = |x: Point, rates: [f64; 2]| {
                errors.base
                    + errors.base_angle * n.dot(&perpendicular(x)).abs()
                    + (0..2).map(|k| errors.zeros[k] * rates[k].abs()).sum::<f64>()
                    + (0..2).map(|k| errors.lengths[k] * n.dot(&lengthwise[k]).abs()).sum::<f64>()
            };
            let in_plane = corners.iter().zip(local.core()).all(|(&x, a)| {
                let rates = self.rates(link, x, n);
                let near = n.dot(&x) + toward(x, rates) + changes.curvature_in_plane(a.norm()) / 2.0 + room;
                piece.core().iter().all(|p| {
                    let (together, off) = match drift {
                        Some(drift) => (deviation.linear_less(rates, n.dot(&drift.of(*p))), drift.error_bound(*p)),
                        None => (deviation.linear(rates), 0.0),
                    };
                    n.dot(p) - together - off > near
                })
            });
            if in_plane || drift.is_some() {
                return in_plane;
            }
            let line = corners.iter().map(|x| n.dot(x)).fold(f64::NEG_INFINITY, f64::max);
            piece.core().iter().all(|&p| {
                let rates = self.rates(link, p, n);
                let toward = deviation.linear(rates) + toward(p, rates) + changes.curvature_in_link(link, p) / 2.0;
                n.dot(&p) - toward > line + room
            })
        })
    }

    /// Returns a box with the deviations of prismatic joints. Those of revolute joints are 0 in it, because rotations
    /// do not change by how much errors move a point.
    fn slides(&self, deviation: Deviation) -> Deviation {
        let greatest = deviation.greatest_components();
        let joints = &self.scene.arm().joints;
        Deviation::Box([0, 1].map(|k| if joints[k].joint_type.is_revolute() { 0.0 } else { greatest[k] }))
    }

    /// Returns, for each link, the direction in which an error of its length moves the parts of link `link`. The
    /// direction is from joint 1 to joint 2, or from joint 2 to the tip. It is zero for a link without a length, and
    /// for a link farther along the chain.
    fn lengthwise(&self, link: usize) -> [Vector; 2] {
        let arm: &Arm = self.scene.arm();
        let unit = |v: Vector| v.try_normalize(0.0).unwrap_or_default();
        let first = if link == 2 { unit(arm.offset) } else { self.poses[0].direction(unit(arm.offset)) };
        [first, if link == 0 { Vector::zeros() } else { self.poses[link].direction(unit(arm.tip)) }]
    }
}

/// Returns a bound on the additional motion of a pair's part, metres, that errors of angles cause if a wrist keeps it level.
fn wrist_motion(scene: &Scene, pair: Pair, errors: &ArmErrors) -> f64 {
    let level = scene.attachment().filter(|_| scene.is_attached(pair)).map(|attachment| (attachment, attachment.grip));
    let Some((attachment, Grip::Level { point, .. })) = level else { return 0.0 };
    let reach = attachment.parts.iter().map(|part| part.shape.reach_from(point)).fold(0.0, f64::max);
    let zeros = scene.arm().joints.iter().zip(errors.zeros);
    let turned = zeros.map(|(joint, zero)| joint.joint_type.turn().abs() * zero).sum::<f64>() + errors.base_angle;
    turned * reach
}
