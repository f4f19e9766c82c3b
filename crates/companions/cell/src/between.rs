//! Distances between two arms, with bounds while both move.

use cplan_geometry::{Convex, Point, Vector, separation};
use cplan_judge::{Deviation, Posture};
use cplan_model::space::Configuration;
use cplan_model::{Heights, Obstacle, Part, Scene, Shape};

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
    pub at: Configuration,
    shapes: Vec<Convex>,
    /// A disc around each shape.
    discs: Vec<(Point, f64)>,
    /// For each body, an upper bound on the motion of its points, metres.
    moves: Vec<f64>,
    /// Bound on the lengths in computations with these shapes, metres.
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
                let body = move |part| Body { link, part, reach: part_reach(part) };
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

    /// Places the links of an arm at a configuration, with bounds on their motion for a set of deviations from there.
    pub fn placed(&self, side: usize, at: Configuration, deviation: Deviation) -> Placed {
        let posture = Posture::new(self.scenes[side], at);
        let base = self.scenes[side].arm().base.norm();
        let mut placed = Placed { at, shapes: Vec::new(), discs: Vec::new(), moves: Vec::new(), scale: base };
        for Body { link, part, reach } in &self.bodies[side] {
            let shape = part.shape.at(&posture.pose(*link));
            let core = shape.core();
            let center = core.iter().sum::<Vector>() / core.len() as f64;
            placed.discs.push((center, shape.reach_from(center)));
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

    /// Returns true if the arms are proven to collide, or to be nearer than the clearance, for all deviations.
    pub fn surely_collide(&self, [a, b]: [&Placed; 2]) -> bool {
        let rounding = ROUNDING * (a.scale + b.scale);
        let collides = |(&[i, j], is_definite): (&[usize; 2], &bool)| {
            let moves = a.moves[i] + b.moves[j] + rounding;
            let ((p, r), (q, s)) = (a.discs[i], b.discs[j]);
            // Shapes at this distance have no point in common.
            if !is_definite || (p - q).norm() > r + s + self.clearance {
                return false;
            }
            let inner = |side: usize, body: usize, placed: &Placed| {
                let Body { link, part, .. } = &self.bodies[side][body];
                let inner = part.inner.as_ref().map(|inner| {
                    let pose = self.scenes[side].arm().pose(*link, placed.at);
                    inner.at(&pose)
                });
                inner.unwrap_or_else(|| placed.shapes[body].clone())
            };
            let (one, two) = (inner(0, i, a), inner(1, j, b));
            let is_solid = !one.is_sliver() && !two.is_sliver();
            is_solid && separation(&one, &two).distance + moves < self.clearance
        };
        self.pairs.iter().zip(&self.is_definite).any(collides)
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

fn part_reach(part: &Part) -> f64 {
    let own = part.shape.reach_from(Point::zeros());
    part.inner.as_ref().map_or(own, |inner| inner.reach_from(Point::zeros()).max(own))
}
