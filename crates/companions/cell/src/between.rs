//! Distances between two arms, with bounds while both move.

use crate::body::{Body, Frame, disc_around, poses};
use crate::contact::{contact_point, rates};
use crate::overlap::{Corner, Moving, Overlap, overlap};
use crate::proof::LinkPart;
use cplan_geometry::{Convex, Point, Pose, Vector, separation, separation_at};
use cplan_judge::{Deviation, Posture};
use cplan_model::space::Configuration;
use cplan_model::{JointType, Obstacle, Pair, Scene, Shape};
use std::rc::Rc;

/// Rounding error of a distance and of bounds on motions, as a fraction of the lengths in it: a few dozen operations at
/// 1.1e-16 each, with a wide margin.
const ROUNDING: f64 = 1e-12;

/// The set of deviations that contains only the configuration itself.
const NO_DEVIATION: Deviation = Deviation::Box([0.0; 2]);

/// The bodies of two arms, and the pairs that can meet.
#[derive(Debug)]
pub(crate) struct Between<'a> {
    pub scenes: [&'a Scene; 2],
    bodies: [Vec<Rc<Body>>; 2],
    /// Pairs of bodies, one of each arm, whose heights meet.
    pairs: Vec<[usize; 2]>,
    /// True for each pair whose heights certainly overlap.
    is_definite: Vec<bool>,
    /// Distance to keep between the arms, metres.
    pub clearance: f64,
}

/// The links of one arm during a span of a motion: at one configuration, with bounds on their motion from there.
#[derive(Debug, Clone)]
pub(crate) struct Placed {
    shapes: Vec<Convex>,
    /// A disc around each shape.
    discs: Vec<(Point, f64)>,
    /// For each body, an upper bound on the motion of its points, metres.
    moves: Vec<f64>,
    /// Bound on the lengths in computations with these shapes, metres.
    scale: f64,
}

/// An arm at one configuration.
#[derive(Debug, Clone)]
pub(crate) struct Stance {
    at: Configuration,
    poses: [Pose; 4],
    /// For each body, the centre of its disc.
    centers: Vec<Point>,
}

/// An arm that deviates from a configuration.
#[derive(Debug, Clone)]
pub(crate) struct Swept {
    at: Configuration,
    deviation: Deviation,
    poses: [Pose; 4],
    /// For each body, the centre of its disc, and an upper bound on the motion of its points, metres.
    bodies: Vec<(Point, f64)>,
    /// Bound on the lengths in computations, metres.
    scale: f64,
}

impl Placed {
    /// Returns the greatest motion of a link in the span, metres.
    pub fn farthest_motion(&self) -> f64 {
        self.moves.iter().copied().fold(0.0, f64::max)
    }
}

/// The distance of two arms at one pair of configurations, and a lower bound on it for all deviations.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ArmDistance {
    /// Lower bound for all deviations, metres; infinite if no links can meet.
    pub least: f64,
    /// The least distance at the configurations themselves, as far as it was computed, and its pair.
    pub here: Option<(f64, [usize; 2])>,
}

impl<'a> Between<'a> {
    /// Prepares two arms without payloads. Shapes of one robot whose heights only touch cannot meet.
    pub fn new(scenes: [&'a Scene; 2], is_one_robot: bool, clearance: f64) -> Self {
        Self::of_bodies(scenes, scenes.map(Self::links), is_one_robot, clearance)
    }

    /// Returns the links of an arm.
    pub fn links(scene: &Scene) -> Vec<Rc<Body>> {
        let of = |link: usize| {
            scene.arm().links[link].parts.iter().map(move |part| Rc::new(Body::of_link(link, part, true)))
        };
        of(0).chain(of(1)).collect()
    }

    /// Prepares the bodies of two arms.
    pub fn of_bodies(scenes: [&'a Scene; 2], bodies: [Vec<Rc<Body>>; 2], is_one_robot: bool, clearance: f64) -> Self {
        let mut pairs = Vec::new();
        for (i, a) in bodies[0].iter().enumerate() {
            let met = bodies[1].iter().enumerate().filter(|(_, b)| a.may_meet(b, is_one_robot));
            pairs.extend(met.map(|(j, _)| [i, j]));
        }
        let is_definite = pairs.iter().map(|[i, j]| bodies[0][*i].surely_meets(&bodies[1][*j])).collect();
        Self { scenes, is_definite, bodies, pairs, clearance }
    }

    /// Returns the pairs of parts that can meet, one of each arm. Parts are numbered as in the list of those of the first link,
    /// followed by those of the second.
    pub fn pairs(&self) -> &[[usize; 2]] {
        &self.pairs
    }

    /// Places the links of an arm at a configuration, with bounds on their motion for a set of deviations from there.
    pub fn placed(&self, side: usize, at: Configuration, deviation: Deviation) -> Placed {
        let scene = self.scenes[side];
        let (posture, poses) = (Posture::new(scene, at), poses(scene.arm(), at));
        let base = scene.arm().base.norm();
        let mut placed = Placed { shapes: Vec::new(), discs: Vec::new(), moves: Vec::new(), scale: base };
        for body in &self.bodies[side] {
            let shape = body.part.shape.at(&poses[body.frame.index()]);
            placed.discs.push(disc_around(&shape));
            placed.moves.push(body.farthest_motion(scene, &posture, deviation));
            placed.scale = placed.scale.max(base + shape.reach_from(Point::zeros()) + body.reach);
            placed.shapes.push(shape);
        }
        placed
    }

    /// Places the links of an arm that does not move.
    pub fn at_rest(&self, side: usize, at: Configuration) -> Placed {
        self.placed(side, at, NO_DEVIATION)
    }

    /// Returns the distance of the arms, and a lower bound for all deviations. `enough` is the bound that suffices: pairs
    /// that are farther apart are only bounded by discs.
    pub fn distance(&self, [a, b]: [&Placed; 2], enough: f64) -> ArmDistance {
        let rounding = ROUNDING * (a.scale + b.scale);
        let mut distance = ArmDistance { least: f64::INFINITY, here: None };
        for &pair in &self.pairs {
            let [i, j] = pair;
            let moves = a.moves[i] + b.moves[j] + rounding;
            let ((p, r), (q, s)) = (a.discs[i], b.discs[j]);
            let apart = (p - q).norm() - r - s - moves;
            if apart >= enough && apart > 0.0 {
                distance.least = distance.least.min(apart);
                continue;
            }
            let here = separation(&a.shapes[i], &b.shapes[j]).distance;
            distance.least = distance.least.min(here - moves);
            if distance.here.is_none_or(|(least, _)| here < least) {
                distance.here = Some((here, pair));
            }
        }
        distance
    }

    /// Returns an arm at a configuration, for [`Between::near`].
    pub fn stance(&self, side: usize, at: Configuration) -> Stance {
        let poses = poses(self.scenes[side].arm(), at);
        let center = |body: &Rc<Body>| poses[body.frame.index()].point(body.disc.0);
        Stance { at, poses, centers: self.bodies[side].iter().map(center).collect() }
    }

    /// Visits the pairs of links that are nearer than `within`, metres, with their distance and its derivatives by the joints
    /// of both arms.
    pub fn near(&self, stances: [&Stance; 2], within: f64, mut visit: impl FnMut(f64, [[f64; 2]; 2])) {
        for &pair in &self.pairs {
            let [(p, r, one), (q, s, two)] = [0, 1].map(|side| {
                let body = &*self.bodies[side][pair[side]];
                (stances[side].centers[pair[side]], body.disc.1, body)
            });
            let far = within + r + s;
            if (p - q).norm_squared() >= far * far {
                continue;
            }
            let shape = |side: usize, body: &Body| body.part.shape.at(&stances[side].poses[body.frame.index()]);
            let shapes = [shape(0, one), shape(1, two)];
            let here = separation(&shapes[0], &shapes[1]);
            if here.distance < within {
                let at = contact_point(&shapes[0], &shapes[1], here);
                let rates = |side: usize, body: &Body| {
                    let (arm, q) = (self.scenes[side].arm(), stances[side].at);
                    match body.frame {
                        Frame::Link(link) => rates(arm, link, q, at, here.direction),
                        Frame::Tip => rates(arm, 1, q, arm.tip_at(q), here.direction),
                        Frame::Cell => [0.0; 2],
                    }
                };
                visit(here.distance, [rates(0, one).map(|rate| -rate), rates(1, two)]);
            }
        }
    }

    /// Returns an arm that deviates from a configuration, for [`Between::overlap`].
    pub fn swept(&self, side: usize, at: Configuration, deviation: Deviation) -> Swept {
        let scene = self.scenes[side];
        let (posture, poses) = (Posture::new(scene, at), poses(scene.arm(), at));
        let base = scene.arm().base.norm();
        let mut scale = base;
        let bodies = self.bodies[side].iter().map(|body| {
            let center = poses[body.frame.index()].point(body.disc.0);
            scale = scale.max(base + center.norm() + body.disc.1 + body.reach);
            (center, body.farthest_motion(scene, &posture, deviation))
        });
        let bodies = bodies.collect();
        Swept { at, deviation, poses, bodies, scale }
    }

    /// Returns true if the arms are proven to collide, or to be nearer than the clearance, for all deviations.
    pub fn surely_collide(&self, swept: [&Swept; 2]) -> bool {
        self.overlap(swept).share < 1.0
    }

    /// Returns the bodies that are proven to collide, or to be nearer than the clearance, for all deviations. If there are
    /// several pairs, returns the one with the widest margin.
    pub fn colliding_pair(&self, swept: [&Swept; 2]) -> Option<[usize; 2]> {
        let shares = self.definite_pairs().map(|pair| (self.motion_per_depth(swept, pair), pair));
        let least = shares.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (least.0 < 1.0).then_some(least.1)
    }

    /// Returns the overlap of the pair of links whose motion for the deviations is the least share of their depth. If the share is
    /// below 1, the arms are proven to collide, or to be nearer than the clearance, for all deviations. It is infinite if no links are
    /// too near.
    pub fn overlap(&self, swept: [&Swept; 2]) -> Overlap {
        let rounding = rounding_of(swept);
        let mut best = Overlap::NONE;
        for pair in self.definite_pairs() {
            let share = self.motion_per_depth(swept, pair);
            if share < 1.0 {
                return Overlap { share, ..Overlap::NONE };
            }
            if share.is_infinite() {
                continue;
            }
            let moving = [0, 1].map(|side| self.moving(side, pair[side], swept[side]));
            let overlap = overlap(moving.each_ref(), self.clearance, rounding);
            if overlap.share < best.share {
                best = overlap;
            }
            if best.share < 1.0 {
                break;
            }
        }
        best
    }

    /// Iterates over the pairs of bodies that are at common heights for certain.
    fn definite_pairs(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.pairs.iter().zip(&self.is_definite).filter(|(_, is_definite)| **is_definite).map(|(pair, _)| *pair)
    }

    /// Returns the bound on the motion of two bodies for the deviations, as a share of the depth by which they are too near to each
    /// other at the configurations themselves. Below 1, they are proven to collide, or to be nearer than the clearance, for all
    /// deviations. Infinite if they are not too near.
    fn motion_per_depth(&self, [a, b]: [&Swept; 2], [i, j]: [usize; 2]) -> f64 {
        let (one, two) = (&self.bodies[0][i], &self.bodies[1][j]);
        let ((p, first), (q, second)) = (a.bodies[i], b.bodies[j]);
        let rounding = rounding_of([a, b]);
        // Shapes at this distance have no point in common.
        let far = one.disc.1 + two.disc.1 + self.clearance + rounding;
        if (p - q).norm_squared() > far * far {
            return f64::INFINITY;
        }
        let (own, other) = (one.part.inner_shape(), two.part.inner_shape());
        if own.is_sliver() || other.is_sliver() {
            return f64::INFINITY;
        }
        let pose = b.poses[two.frame.index()].inverse() * a.poses[one.frame.index()];
        let depth = self.clearance - separation_at(&own, &pose, &other, |_, here| here.distance);
        if depth > 0.0 { (first + second + rounding) / depth } else { f64::INFINITY }
    }

    /// Returns the corners of a body of an arm that deviates from a configuration.
    fn moving(&self, side: usize, body: usize, swept: &Swept) -> Moving {
        let (arm, body) = (self.scenes[side].arm(), &*self.bodies[side][body]);
        let shape = body.part.inner_shape();
        let posture = Posture::new(self.scenes[side], swept.at);
        let corner = |p: &Point| {
            let at = swept.poses[body.frame.index()].point(*p);
            let (link, moved, own) = match body.frame {
                Frame::Link(link) => (link, at, *p),
                Frame::Tip => (1, arm.tip_at(swept.at), arm.tip),
                Frame::Cell => return Corner { at, rates: [Vector::zeros(); 2], bend: 0.0 },
            };
            let [x, y] = [Vector::x(), Vector::y()].map(|n| rates(arm, link, swept.at, moved, n));
            let bend = posture.curvature_in_plane(link, swept.deviation).of(own) / 2.0;
            Corner { at, rates: [0, 1].map(|k| Vector::new(x[k], y[k])), bend }
        };
        Moving {
            corners: shape.core().iter().map(corner).collect(),
            radius: shape.radius(),
            deviation: swept.deviation,
        }
    }

    /// Returns the motion of the links per unit of each joint, metres: those of the first arm, then those of the second.
    pub fn levers(&self) -> [f64; 4] {
        [0, 1, 2, 3].map(|k| {
            let (own, joint) = (self.scenes[k / 2].arm(), k % 2);
            let reach = own.reach() - if joint == 1 { own.offset.norm() } else { 0.0 };
            match own.joints[joint].joint_type {
                JointType::Revolute { .. } => reach.max(0.0),
                JointType::Prismatic { .. } => 1.0,
            }
        })
    }

    /// Returns a point of the first link of a pair that is nearest to the second, or deepest in it, while both arms rest.
    pub fn contact(&self, pair: [usize; 2], at: [Configuration; 2]) -> Point {
        let [a, b] = [0, 1].map(|side| {
            let Body { frame, part, .. } = &*self.bodies[side][pair[side]];
            part.shape.at(&poses(self.scenes[side].arm(), at[side])[frame.index()])
        });
        contact_point(&a, &b, separation(&a, &b))
    }

    /// Names the links of a pair: `"forearm" of left and "upper arm" of right`.
    pub fn describe(&self, [i, j]: [usize; 2], names: [&str; 2]) -> String {
        let link = |side: usize, body: usize| format!("\"{}\" of {}", self.bodies[side][body].part.body, names[side]);
        format!("{} and {}", link(0, i), link(1, j))
    }

    /// Returns the parts of the links of a pair. `None` if one of the bodies is an object.
    pub fn link_parts(&self, pair: [usize; 2]) -> Option<[LinkPart; 2]> {
        let part = |side: usize| {
            let is_of = |body: &Body, link: usize| !body.is_object && body.frame == Frame::Link(link);
            let body = &self.bodies[side][pair[side]];
            let link = (0..2).find(|link| is_of(body, *link))?;
            let part = self.bodies[side][..pair[side]].iter().filter(|body| is_of(body, link)).count();
            Some(LinkPart { link, part })
        };
        Some([part(0)?, part(1)?])
    }

    /// Returns the links of an arm at a configuration, as obstacles of the other arm. Omits links that
    /// the other arm cannot meet.
    pub fn obstacles(&self, side: usize, name: &str, at: Configuration) -> Vec<Obstacle> {
        let poses = poses(self.scenes[side].arm(), at);
        let mut obstacles = Vec::new();
        for (number, body) in self.bodies[side].iter().enumerate() {
            if !self.pairs.iter().any(|pair| pair[side] == number) {
                continue;
            }
            let (part, shape) = (&body.part, body.part.shape.at(&poses[body.frame.index()]));
            let Ok(mut obstacle) = Obstacle::polyline(&format!("{name}: {}", part.body), [[0.0; 2]]) else { continue };
            (obstacle.shape, obstacle.pieces, obstacle.heights) = (Shape::Pieces, vec![shape], part.heights);
            obstacles.push(obstacle);
        }
        obstacles
    }
}

/// Returns the rounding error of distances between two arms, metres.
fn rounding_of([a, b]: [&Swept; 2]) -> f64 {
    ROUNDING * (a.scale + b.scale)
}

/// Returns a part of an arm and an obstacle that are proven to collide for all deviations. The scene is one for proofs of
/// collisions.
pub(crate) fn proven_hit(inner: &Scene, at: Configuration, deviation: Deviation) -> Option<Pair> {
    let posture = Posture::new(inner, at);
    let clearance = inner.workspace().clearance;
    let is_hit = |pair: &&Pair| {
        // A link meets its robot's own body only if they overlap.
        let is_own = inner.self_obstacle(pair.obstacle).is_some();
        posture.greatest(**pair, deviation) < if is_own { 0.0 } else { clearance }
    };
    inner.pairs().iter().find(is_hit).copied()
}
