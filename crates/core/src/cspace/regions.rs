//! Configuration space as polygons.

use super::coarse::coarse;
use super::curves::Curves;
use super::union::{blocked_space, free_space};
use super::{Proves, translation};
use crate::model::{Contacts, Joint, Pair, Scene};
use crate::space::{Configuration, JointRange, Topology};
use cplan_geometry::{Hits, Point, cross};
use cplan_interrupt::checkpoint;
use std::borrow::Cow;
use std::f64::consts::{PI, TAU};

/// Share of the margin that remains as proven distance on the contours of [`regions`] after flattening. Chords may cut
/// off the rest, which allows fewer corners.
const PROVEN_MARGIN_SHARE: f64 = 0.25;

/// Greatest simplification of shapes with many corners, as a multiple of the margin that contours keep.
const COARSENESS_PER_MARGIN: f64 = 2.0;

/// Overlap of bands across the seam of a turn, relative to the distance they are grown by: far above the rounding of the
/// union.
const SEAM_OVERLAP: f64 = 1e-3;

/// Share of the arm's reach by which rounded corners of [`exact_c_obstacles`] may be larger than their arcs: invisible in
/// pictures, and five corners a quarter of a turn for the most.
const ARC_TOLERANCE: f64 = 1e-3;

/// A simple polygon with holes: the outer contour counter-clockwise, holes clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    /// The outer contour, counter-clockwise.
    pub outer: Vec<Point>,
    /// Contours of the holes.
    pub holes: Vec<Vec<Point>>,
}

impl Polygon {
    /// Returns the area without the holes.
    #[must_use]
    pub fn area(&self) -> f64 {
        signed_area(&self.outer) + self.holes.iter().map(|hole| signed_area(hole)).sum::<f64>()
    }

    /// Returns true if `p` is inside, by the parity of crossings; points on a contour may give either result. Linear.
    #[must_use]
    pub fn contains(&self, p: Point) -> bool {
        let contours = std::iter::once(&self.outer).chain(&self.holes);
        contours.filter(|contour| crossings(contour, p) % 2 == 1).count() % 2 == 1
    }
}

fn signed_area(contour: &[Point]) -> f64 {
    let n = contour.len();
    (0..n).map(|i| cross(contour[i] - contour[0], contour[(i + 1) % n] - contour[0])).sum::<f64>() / 2.0
}

/// Returns how many sides the ray from `p` along the first axis crosses.
fn crossings(contour: &[Point], p: Point) -> usize {
    let n = contour.len();
    (0..n)
        .filter(|&i| {
            let (a, b) = (contour[i], contour[(i + 1) % n]);
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y))
        })
        .count()
}

/// The part of a C-obstacle that one obstacle contributes, as a simple polygon in unwrapped joint values; on a circle
/// axis its copies shifted by whole turns belong to it. For pictures and as input of the union.
#[derive(Debug, Clone, PartialEq)]
pub struct CObstacle {
    /// Index of the obstacle, as in [`Pair::obstacle`].
    pub obstacle: usize,
    /// The link that would touch it.
    pub link: usize,
    /// Counter-clockwise, coordinates `(q1, q2)`.
    pub contour: Vec<Point>,
}

/// Free space as polygons over a *window* of the universal cover: on an interval the joint's limits, on a circle some
/// turns around the start, in which obstacles repeat. A planner on a torus is so a planner in the plane, whose goals
/// are all copies of the goal within the window.
#[derive(Debug, Clone, PartialEq)]
pub struct Regions {
    /// Topology of the configuration space.
    pub topology: Topology,
    /// The fact that free and blocked regions prove.
    pub proves: Proves,
    /// Lower and upper value of each axis.
    pub window: [(f64, f64); 2],
    /// Each obstacle's contribution, once, not clipped to the window.
    pub obstacles: Vec<CObstacle>,
    /// The window less all obstacles: one polygon a connected component.
    pub free: Vec<Polygon>,
}

impl Regions {
    /// Returns the contours of free space, which lies to the left of them.
    #[must_use]
    pub fn contours(&self) -> Vec<&[Point]> {
        self.free.iter().flat_map(|p| std::iter::once(&p.outer).chain(&p.holes)).map(Vec::as_slice).collect()
    }

    /// Returns the component of free space that contains `q`, given within the window. Linear in the number of corners.
    #[must_use]
    pub fn component(&self, q: Configuration) -> Option<usize> {
        self.free.iter().position(|polygon| polygon.contains(q))
    }
}

/// Computes free space with obstacles grown by the scene's clearance and at most `margin` metres more, over the limits
/// of interval axes and `periods` turns to either side of `center` on circles.
///
/// On the whole boundary of the free space, and so within it, arm and obstacles are at least the clearance plus a
/// quarter of `margin` apart (see [`c_obstacles`] for the argument). Configurations with more than the clearance plus
/// three times `margin` are free here. The number of vertices grows like `1 / sqrt(margin)`.
///
/// # Panics
/// If `margin` is not positive.
#[must_use]
pub fn regions(scene: &Scene, margin: f64, center: Configuration, periods: usize) -> Regions {
    assert!(margin > 0.0, "a margin for the flattening of curves");
    let obstacles = c_obstacles(scene, PROVEN_MARGIN_SHARE * margin, (1.0 - PROVEN_MARGIN_SHARE) * margin);
    within_window(scene, Proves::Outer { margin }, window(scene, center, periods), obstacles)
}

/// Returns true if the C-obstacles of a scene are polygons, so that [`exact_c_obstacles`] has them: both joints are
/// prismatic, with directions that are not parallel.
#[must_use]
pub fn has_exact_polygons(scene: &Scene) -> bool {
    translation::joint_map(scene.arm()).is_some()
}

/// Computes the exact C-obstacles of a gantry by the sweep over the normals of both polygons (`B - A`), with their kind
/// of proof: nothing is grown and no corner is added. Returns `None` for arms with revolute joints.
///
/// Corners are differences of given corners, rounded once, in joint values. Circles, capsules and a clearance round the
/// corners of a C-obstacle; only these arcs are replaced by tangents, which lie outside of them.
#[must_use]
pub fn exact_c_obstacles(scene: &Scene) -> Option<(Vec<CObstacle>, Proves)> {
    let (level, tolerance) = (scene.workspace().clearance, ARC_TOLERANCE * scene.arm().reach());
    has_exact_polygons(scene).then(|| {
        let radius = |pair: &Pair| scene.part(*pair).radius() + scene.piece(*pair).radius() + level;
        let is_round = scene.pairs().iter().any(|pair| pair.link == 1 && radius(pair) > 0.0);
        let proves = if is_round { Proves::Outer { margin: tolerance } } else { Proves::Exact };
        (traced(scene, level, tolerance), proves)
    })
}

/// Computes the free space of a gantry among [`exact_c_obstacles`], over the limits of its joints. Returns `None` for
/// arms with revolute joints.
///
/// Configurations on its boundary touch an obstacle.
#[must_use]
pub fn exact_regions(scene: &Scene) -> Option<Regions> {
    let (obstacles, proves) = exact_c_obstacles(scene)?;
    Some(within_window(scene, proves, window(scene, Configuration::zeros(), 0), obstacles))
}

/// Computes the free space of a gantry, over the limits of its joints, with obstacles shrunk by at most `margin`
/// metres. It contains every configuration that keeps the scene's clearance, but no configuration that violates it by more than
/// `margin`.
///
/// Returns `None` for other arms, if link 1 can touch an obstacle, and for shapes too thin to be shrunk: walls without
/// thickness with a tool that is a point. The number of vertices grows like `1 / sqrt(margin)`.
#[must_use]
pub fn inner_regions(scene: &Scene, margin: f64) -> Option<Regions> {
    let map = translation::joint_map(scene.arm())?;
    let level = scene.workspace().clearance;
    let contour = |pair: &Pair| {
        checkpoint();
        if pair.link != 1 {
            return None;
        }
        let (part, piece) = (scene.part(*pair), scene.piece(*pair));
        let contour = translation::inner_contour(scene.arm(), &map, part, piece, level, margin)?;
        Some(CObstacle { obstacle: pair.obstacle, link: pair.link, contour })
    };
    let obstacles: Option<Vec<CObstacle>> = scene.pairs().iter().map(contour).collect();
    Some(within_window(scene, Proves::Inner { margin }, window(scene, Configuration::zeros(), 0), obstacles?))
}

/// Returns the limits of interval axes, and `periods` turns to either side of `center` on circles.
fn window(scene: &Scene, center: Configuration, periods: usize) -> [(f64, f64); 2] {
    let topology = scene.arm().topology();
    let turns = TAU * periods as f64;
    [0, 1].map(|k| match topology.ranges[k] {
        JointRange::Interval { lower, upper } => (lower, upper),
        JointRange::Circle => (center[k] - turns, center[k] + turns),
    })
}

fn within_window(scene: &Scene, proves: Proves, window: [(f64, f64); 2], obstacles: Vec<CObstacle>) -> Regions {
    let free = free_space(window, periods(scene), obstacles.iter().map(|o| o.contour.as_slice()));
    Regions { topology: scene.arm().topology(), proves, window, obstacles, free }
}

/// Returns the period of each joint after which poses repeat.
fn periods(scene: &Scene) -> [Option<f64>; 2] {
    scene.arm().joints.each_ref().map(|joint| joint.joint_type.is_revolute().then_some(TAU))
}

/// Returns the regions that each obstacle of the workspace, then each of the arm's self obstacles, blocks within the
/// limits, on a circle within `[-pi, pi]`, given the contours of the [`c_obstacles`]: disjoint polygons per obstacle,
/// cut at the seams of circles.
#[must_use]
pub fn united(scene: &Scene, contours: &[CObstacle]) -> Vec<Vec<Polygon>> {
    let window = scene.arm().topology().ranges.map(JointRange::domain);
    let of = |number: usize| contours.iter().filter(move |c| c.obstacle == number).map(|c| c.contour.as_slice());
    let obstacles = (0..scene.workspace().obstacles.len()).chain(scene.self_obstacles());
    obstacles.map(|number| blocked_space(window, periods(scene), of(number))).collect()
}

/// Returns contours that cover every configuration in which a pair of the scene is at most its clearance plus `margin`
/// apart, and almost none in which it is more than twice `tolerance` farther; metres, with `tolerance` positive.
///
/// Each obstacle appears once for every pair, strip or band; contours of one obstacle may overlap. Around shapes with
/// many corners, unless the margin is 0, contours may be another two margins away, because smaller details are not
/// traced.
///
/// Link 1 gives bands of `q1`, in closed form. Gantries give Minkowski differences, exact up to arcs: with margin,
/// clearance and radii zero they are the exact C-obstacles. Otherwise curves are flattened between exact slices.
///
/// The coverage is proven, not sampled. Let `S` be the set to cover. No point of `S` lies on the boundary of the union,
/// since chords keep their distance (proven in the module `chord`) and slices are exact. So every connected part of `S`
/// is either inside or outside as a whole. Each part has a point inside: it either reaches the end of the range of
/// `q1`, where there is a slice, or has a point of least `q1`, where there is one too (module `events`).
///
/// # Panics
/// If `tolerance` is not positive.
#[must_use]
pub fn c_obstacles(scene: &Scene, margin: f64, tolerance: f64) -> Vec<CObstacle> {
    assert!(tolerance > 0.0, "a tolerance for the flattening of curves");
    traced(&coarsened(scene, margin, tolerance), scene.workspace().clearance + margin, tolerance)
}

/// Returns the regions in which each pair of shapes is within `level`, flattened with this tolerance.
fn traced(scene: &Scene, level: f64, tolerance: f64) -> Vec<CObstacle> {
    let slices = Contacts::new(scene);
    let map = translation::joint_map(scene.arm());
    let mut obstacles = Vec::new();
    for (index, pair) in scene.pairs().iter().enumerate() {
        checkpoint();
        let contours = match (pair.link, &map) {
            (0 | 2, _) => bands(&slices, index, level + tolerance, SEAM_OVERLAP * level.min(1.0)),
            (_, Some(map)) => {
                let (part, piece) = (scene.part(*pair), scene.piece(*pair));
                vec![translation::contour(scene.arm(), map, part, piece, level, tolerance)]
            }
            (_, None) => Curves::new(&slices, index, level, tolerance).contours(),
        };
        let (obstacle, link) = (pair.obstacle, pair.link);
        obstacles.extend(contours.into_iter().map(|contour| CObstacle { obstacle, link, contour }));
    }
    obstacles
}

/// Returns the scene whose contours are traced.
fn coarsened(scene: &Scene, margin: f64, tolerance: f64) -> Cow<'_, Scene> {
    coarse(scene, COARSENESS_PER_MARGIN * margin, scene.workspace().clearance + margin + 4.0 * tolerance)
}

/// Returns the number of pairs of shapes that [`regions`] traces with that `margin`: a greater margin makes shapes with
/// many corners coarser.
#[must_use]
pub fn traced_pairs(scene: &Scene, margin: f64) -> usize {
    coarsened(scene, PROVEN_MARGIN_SHARE * margin, (1.0 - PROVEN_MARGIN_SHARE) * margin).pairs().len()
}

/// Returns the values of `q1` at which a pair of link 1 is within `level`, for all `q2` and `pad` more at either end:
/// the overlap closes the seam between copies a whole turn apart. For a pair of link 2 and link 1, returns the values
/// of `q2`, for all `q1`.
fn bands(slices: &Contacts, index: usize, level: f64, pad: f64) -> Vec<Vec<Point>> {
    let domain = |joint: &Joint| if joint.joint_type.is_revolute() { (-PI, PI) } else { joint.range.domain() };
    let folds = slices.scene().pairs()[index].link == 2;
    let mut joints: Vec<&Joint> = slices.scene().arm().joints.iter().collect();
    if folds {
        joints.reverse();
    }
    let mut spans = Vec::new();
    let hits = match folds {
        true => slices.second_link(index, 0.0, level, &mut spans),
        false => slices.first_link(index, level, &mut spans),
    };
    if hits == Hits::Always {
        spans = vec![<[f64; 2]>::from(domain(joints[0]))];
    }
    let (lower, upper) = domain(joints[1]);
    let corners = |[a, b]: [f64; 2]| {
        let corners = match folds {
            true => [(lower - pad, a), (upper + pad, a), (upper + pad, b), (lower - pad, b)],
            false => [(a, lower - pad), (b, lower - pad), (b, upper + pad), (a, upper + pad)],
        };
        corners.map(|(x, y)| Point::new(x, y)).to_vec()
    };
    spans.into_iter().map(corners).collect()
}
