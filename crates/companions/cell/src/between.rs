//! Distances between two arms, with bounds while both move.

use crate::contact::{contact_point, rates};
use cplan_geometry::{Convex, Point, Pose, Vector, separation, separation_at};
use cplan_judge::{Deviation, Posture};
use cplan_model::space::Configuration;
use cplan_model::{Heights, JointType, Obstacle, Part, Scene, Shape};

/// Rounding error of a distance and of bounds on motions, as a fraction of the lengths in it: a few dozen operations at
/// 1.1e-16 each, with a wide margin.
const ROUNDING: f64 = 1e-12;

/// The set of deviations that contains only the configuration itself.
const NO_DEVIATION: Deviation = Deviation::Box([0.0; 2]);

/// A part of a link of an arm.
#[derive(Debug)]
struct Body<'a> {
    /// The link, 0 or 1.
    link: usize,
    part: &'a Part,
    /// Greatest distance of a point of the part from the origin of the link's frame, metres.
    reach: f64,
    /// A disc around the part's shape, in the link's frame.
    disc: (Point, f64),
}

/// The links of two arms, and the pairs that can meet.
#[derive(Debug)]
pub(crate) struct Between<'a> {
    pub scenes: [&'a Scene; 2],
    bodies: [Vec<Body<'a>>; 2],
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
    poses: [Pose; 2],
    /// For each body, the centre of its disc.
    centers: Vec<Point>,
}

/// An arm that deviates from a configuration.
#[derive(Debug, Clone)]
pub(crate) struct Swept {
    poses: [Pose; 2],
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
    /// Prepares two arms. Shapes of one robot whose heights only touch cannot meet.
    pub fn new(scenes: [&'a Scene; 2], is_one_robot: bool, clearance: f64) -> Self {
        let bodies = scenes.map(|scene| {
            let of = |link: usize| {
                let body =
                    move |part: &'a Part| Body { link, part, reach: part_reach(part), disc: disc_around(&part.shape) };
                scene.arm().links[link].parts.iter().map(body)
            };
            of(0).chain(of(1)).collect::<Vec<_>>()
        });
        let meet = |a: Heights, b: Heights| if is_one_robot { a.overlap(b) } else { a.meet(b) };
        let mut pairs = Vec::new();
        for (i, a) in bodies[0].iter().enumerate() {
            let met = bodies[1].iter().enumerate().filter(|(_, b)| meet(a.part.heights, b.part.heights));
            pairs.extend(met.map(|(j, _)| [i, j]));
        }
        let is_definite = pairs.iter().map(|[i, j]| bodies[0][*i].part.heights.overlap(bodies[1][*j].part.heights));
        Self { scenes, is_definite: is_definite.collect(), bodies, pairs, clearance }
    }

    /// Returns the pairs of parts that can meet, one of each arm. Parts are numbered as in the list of those of the first link,
    /// followed by those of the second.
    pub fn pairs(&self) -> &[[usize; 2]] {
        &self.pairs
    }

    /// Places the links of an arm at a configuration, with bounds on their motion for a set of deviations from there.
    pub fn placed(&self, side: usize, at: Configuration, deviation: Deviation) -> Placed {
        let posture = Posture::new(self.scenes[side], at);
        let base = self.scenes[side].arm().base.norm();
        let mut placed = Placed { shapes: Vec::new(), discs: Vec::new(), moves: Vec::new(), scale: base };
        for Body { link, part, reach, .. } in &self.bodies[side] {
            let shape = part.shape.at(&posture.pose(*link));
            placed.discs.push(disc_around(&shape));
            placed.moves.push(posture.farthest_motion_within(*link, *reach, deviation));
            placed.scale = placed.scale.max(base + shape.reach_from(Point::zeros()) + reach);
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
        let poses = self.scenes[side].arm().poses(at);
        let center = |body: &Body| poses[body.link].point(body.disc.0);
        Stance { at, poses, centers: self.bodies[side].iter().map(center).collect() }
    }

    /// Visits the pairs of links that are nearer than `within`, metres, with their distance and its derivatives by the joints
    /// of both arms.
    pub fn near(&self, stances: [&Stance; 2], within: f64, mut visit: impl FnMut(f64, [[f64; 2]; 2])) {
        for &pair in &self.pairs {
            let [(p, r, one), (q, s, two)] = [0, 1].map(|side| {
                let body = &self.bodies[side][pair[side]];
                (stances[side].centers[pair[side]], body.disc.1, body)
            });
            let far = within + r + s;
            if (p - q).norm_squared() >= far * far {
                continue;
            }
            let shape = |side: usize, body: &Body| body.part.shape.at(&stances[side].poses[body.link]);
            let shapes = [shape(0, one), shape(1, two)];
            let here = separation(&shapes[0], &shapes[1]);
            if here.distance < within {
                let at = contact_point(&shapes[0], &shapes[1], here);
                let rates = |side: usize, body: &Body| {
                    rates(self.scenes[side].arm(), body.link, stances[side].at, at, here.direction)
                };
                visit(here.distance, [rates(0, one).map(|rate| -rate), rates(1, two)]);
            }
        }
    }

    /// Returns an arm that deviates from a configuration, for [`Between::motion_per_depth`].
    pub fn swept(&self, side: usize, at: Configuration, deviation: Deviation) -> Swept {
        let posture = Posture::new(self.scenes[side], at);
        let poses = [0, 1].map(|link| posture.pose(link));
        let base = self.scenes[side].arm().base.norm();
        let mut scale = base;
        let bodies = self.bodies[side].iter().map(|Body { link, reach, disc: (center, radius), .. }| {
            let center = poses[*link].point(*center);
            scale = scale.max(base + center.norm() + radius + reach);
            (center, posture.farthest_motion_within(*link, *reach, deviation))
        });
        let bodies = bodies.collect();
        Swept { poses, bodies, scale }
    }

    /// Returns true if the arms are proven to collide, or to be nearer than the clearance, for all deviations.
    pub fn surely_collide(&self, swept: [&Swept; 2]) -> bool {
        self.motion_per_depth(swept) < 1.0
    }

    /// Returns the bound on the motion of two links for the deviations, as a share of the depth by which they are too near to each
    /// other at the configurations themselves: the least for all pairs of links. Below 1, the arms are proven to collide, or to be nearer
    /// than the clearance, for all deviations. Infinite if no links are too near.
    pub fn motion_per_depth(&self, [a, b]: [&Swept; 2]) -> f64 {
        let rounding = ROUNDING * (a.scale + b.scale);
        let share = |(&[i, j], is_definite): (&[usize; 2], &bool)| {
            let (one, two) = (&self.bodies[0][i], &self.bodies[1][j]);
            let ((p, first), (q, second)) = (a.bodies[i], b.bodies[j]);
            // Shapes at this distance have no point in common.
            let far = one.disc.1 + two.disc.1 + self.clearance + rounding;
            if !is_definite || (p - q).norm_squared() > far * far {
                return f64::INFINITY;
            }
            let shape = |part: &'a Part| part.inner.as_ref().unwrap_or(&part.shape);
            let (own, other) = (shape(one.part), shape(two.part));
            if own.is_sliver() || other.is_sliver() {
                return f64::INFINITY;
            }
            let pose = b.poses[two.link].inverse() * a.poses[one.link];
            let depth = self.clearance - separation_at(own, &pose, other, |_, here| here.distance);
            if depth > 0.0 { (first + second + rounding) / depth } else { f64::INFINITY }
        };
        self.pairs.iter().zip(&self.is_definite).map(share).fold(f64::INFINITY, f64::min)
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
            let Body { link, part, .. } = &self.bodies[side][pair[side]];
            part.shape.at(&self.scenes[side].arm().poses(at[side])[*link])
        });
        contact_point(&a, &b, separation(&a, &b))
    }

    /// Names the links of a pair: `"forearm" of left and "upper arm" of right`.
    pub fn describe(&self, [i, j]: [usize; 2], names: [&str; 2]) -> String {
        let link = |side: usize, body: usize| format!("\"{}\" of {}", self.bodies[side][body].part.body, names[side]);
        format!("{} and {}", link(0, i), link(1, j))
    }

    /// Returns the links of an arm at a configuration, as obstacles of the other arm. Omits links that
    /// the other arm cannot meet.
    pub fn obstacles(&self, side: usize, name: &str, at: Configuration) -> Vec<Obstacle> {
        let poses = self.scenes[side].arm().poses(at);
        let mut obstacles = Vec::new();
        for (number, Body { link, part, .. }) in self.bodies[side].iter().enumerate() {
            if !self.pairs.iter().any(|pair| pair[side] == number) {
                continue;
            }
            let shape = part.shape.at(&poses[*link]);
            let Ok(mut obstacle) = Obstacle::polyline(&format!("{name}: {}", part.body), [[0.0; 2]]) else { continue };
            (obstacle.shape, obstacle.pieces, obstacle.heights) = (Shape::Pieces, vec![shape], part.heights);
            obstacles.push(obstacle);
        }
        obstacles
    }
}

/// Returns true if an arm is proven to collide with an obstacle for all deviations. The scene is one for proofs of collisions.
pub(crate) fn surely_hits(inner: &Scene, at: Configuration, deviation: Deviation) -> bool {
    let posture = Posture::new(inner, at);
    let clearance = inner.workspace().clearance;
    inner.pairs().iter().any(|pair| {
        // A link meets its robot's own body only if they overlap.
        let is_own = inner.self_obstacle(pair.obstacle).is_some();
        posture.greatest(*pair, deviation) < if is_own { 0.0 } else { clearance }
    })
}

/// Returns a disc that contains a shape.
fn disc_around(shape: &Convex) -> (Point, f64) {
    let core = shape.core();
    let center = core.iter().sum::<Vector>() / core.len() as f64;
    (center, shape.reach_from(center))
}

fn part_reach(part: &Part) -> f64 {
    let own = part.shape.reach_from(Point::zeros());
    part.inner.as_ref().map_or(own, |inner| inner.reach_from(Point::zeros()).max(own))
}
