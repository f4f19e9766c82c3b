//! The configuration space as polygons.

use super::coarse::coarse;
use super::curves::Curves;
use super::union::{Window, blocked_space, corners, free_space};
use super::{Proves, translation};
use cplan_geometry::{Hits, Point, cross};
use cplan_interrupt::checkpoint;
use cplan_model::space::{Configuration, JointRange, JointSumRange, Topology};
use cplan_model::{Contacts, Joint, Pair, Scene};
use std::borrow::Cow;
use std::f64::consts::{PI, TAU};

/// Fraction of the margin that contours of [`regions`] provably keep from obstacles. Chords may use the rest, so that
/// fewer corners suffice.
const PROVEN_MARGIN_SHARE: f64 = 0.25;

/// Greatest simplification of shapes with many corners, as a multiple of the margin that contours keep.
const COARSENESS_PER_MARGIN: f64 = 2.0;

/// Overlap of bands at the seam of a turn, relative to the growth of obstacles. It is far greater than the rounding of
/// the union.
const SEAM_OVERLAP: f64 = 1e-3;

/// Distance of free space from the ends of the range of joint sums, radians.
const SUM_INSET: f64 = 1e-9;

/// A simple polygon with holes.
#[derive(Debug, Clone, PartialEq)]
pub struct PolygonWithHoles {
    /// The outer contour, counter-clockwise.
    pub outer: Vec<Point>,
    /// Contours of the holes, clockwise.
    pub holes: Vec<Vec<Point>>,
}

impl PolygonWithHoles {
    /// Returns the area of the polygon, its holes excluded, in the product of the axes' units.
    pub fn area(&self) -> f64 {
        signed_area(&self.outer) + self.holes.iter().map(|hole| signed_area(hole)).sum::<f64>()
    }

    /// Returns true if `p` is inside, by the parity of crossings. For points on a contour, the result is arbitrary.
    /// Linear in the number of corners.
    pub fn contains(&self, p: Point) -> bool {
        let contours = std::iter::once(&self.outer).chain(&self.holes);
        contours.filter(|contour| crossings(contour, p) % 2 == 1).count() % 2 == 1
    }
}

fn signed_area(contour: &[Point]) -> f64 {
    let n = contour.len();
    (0..n).map(|i| cross(contour[i] - contour[0], contour[(i + 1) % n] - contour[0])).sum::<f64>() / 2.0
}

/// Returns the number of sides that the ray from `p` along the first axis crosses.
fn crossings(contour: &[Point], p: Point) -> usize {
    let n = contour.len();
    (0..n)
        .filter(|&i| {
            let (a, b) = (contour[i], contour[(i + 1) % n]);
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y))
        })
        .count()
}

/// A polygon that one pair of shapes contributes to a C-obstacle, in unwrapped joint values. On a circle, its copies by
/// whole turns are implied. Used in pictures, and as input of the union.
#[derive(Debug, Clone, PartialEq)]
pub struct CObstacle {
    /// Index of the obstacle, as in [`Pair::obstacle`].
    pub obstacle: usize,
    /// The link that would touch the obstacle, as in [`Pair::link`].
    pub link: usize,
    /// Corners with coordinates `(q1, q2)`, counter-clockwise.
    pub contour: Vec<Point>,
}

/// Free space as polygons over a *window* of unwrapped joint values. On an interval, the window has the joint's limits.
/// On a circle, it has some turns around the start, in which obstacles repeat. So planning on a torus becomes planning
/// in the plane, with all copies of the goal in the window as goals.
#[derive(Debug, Clone, PartialEq)]
pub struct Regions {
    /// Topology of the configuration space.
    pub topology: Topology,
    /// What free and blocked configurations prove.
    pub proves: Proves,
    /// Lower and upper end of the window along each axis.
    pub window: [(f64, f64); 2],
    /// The polygons of all obstacles, without copies, and not clipped to the window.
    pub obstacles: Vec<CObstacle>,
    /// The window without obstacles: one polygon per connected component.
    pub free: Vec<PolygonWithHoles>,
}

impl Regions {
    /// Returns the contours of free space. Free space is to the left of each.
    pub fn contours(&self) -> Vec<&[Point]> {
        self.free.iter().flat_map(|p| std::iter::once(&p.outer).chain(&p.holes)).map(Vec::as_slice).collect()
    }

    /// Returns the component of free space that contains `q`, which must be within the window. Linear in the number
    /// of corners.
    pub fn component(&self, q: Configuration) -> Option<usize> {
        self.free.iter().position(|polygon| polygon.contains(q))
    }
}

/// Computes free space among obstacles that are grown by the scene's clearance, and by at most `margin` metres more. On
/// intervals, the window has the limits. On circles, it has `periods` turns to either side of `center`.
///
/// On the boundary of free space, and so within it, arm and obstacles are at least the clearance plus a quarter of
/// `margin` apart, as [`c_obstacles`] explains. Every configuration that keeps the clearance plus three times `margin`
/// is free. The number of vertices grows like `1 / sqrt(margin)`.
///
/// # Panics
/// If `margin` is not positive.
pub fn regions(scene: &Scene, margin: f64, center: Configuration, periods: usize) -> Regions {
    assert!(margin > 0.0, "a margin for the flattening of curves");
    let obstacles = c_obstacles(scene, PROVEN_MARGIN_SHARE * margin, (1.0 - PROVEN_MARGIN_SHARE) * margin);
    within_window(scene, Proves::Outer { margin }, window(scene, center, periods), obstacles)
}

/// The reason why C-obstacles are not polygons.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NotPolygons {
    /// The arm is not a gantry: a joint is revolute, or both joints slide in the same direction.
    Arm,
    /// The required clearance makes the corners of C-obstacles round.
    Clearance,
    /// The link's shape in this pair is round: a circle, or a shape with rounded corners.
    RoundLink(Pair),
    /// The obstacle's shape in this pair is round.
    RoundObstacle(Pair),
}

/// Returns the reason why the C-obstacles of a scene are not polygons. `None` if they are: both joints are prismatic,
/// and all shapes have straight sides.
pub fn not_polygons(scene: &Scene) -> Option<NotPolygons> {
    if translation::joint_map(scene.arm()).is_none() {
        return Some(NotPolygons::Arm);
    }
    // A pair that slides only along one axis has a band as its C-obstacle. The sides of a band are straight for all shapes.
    scene.pairs().iter().filter(|pair| pair.link == 1).find_map(|&pair| {
        if scene.part(pair).radius() > 0.0 {
            return Some(NotPolygons::RoundLink(pair));
        }
        if scene.piece(pair).radius() > 0.0 {
            return Some(NotPolygons::RoundObstacle(pair));
        }
        (scene.workspace().clearance > 0.0).then_some(NotPolygons::Clearance)
    })
}

/// Computes the exact C-obstacles of a gantry. Returns `None` if they are not polygons; [`not_polygons`] has the reason.
///
/// Each is the Minkowski difference of two polygons, found by a sweep over their normals. Each corner is a difference
/// of two given corners, rounded once, in joint values.
pub fn exact_c_obstacles(scene: &Scene) -> Option<Vec<CObstacle>> {
    not_polygons(scene).is_none().then(|| trace_contours(scene, scene.workspace().clearance, 0.0))
}

/// Computes the free space of a gantry among [`exact_c_obstacles`], within the limits of its joints. Returns `None`
/// without exact C-obstacles.
///
/// On the boundary of free space, the arm touches an obstacle.
pub fn exact_regions(scene: &Scene) -> Option<Regions> {
    let obstacles = exact_c_obstacles(scene)?;
    Some(within_window(scene, Proves::Exact, window(scene, Configuration::zeros(), 0), obstacles))
}

/// Computes the free space of a gantry, within the limits of its joints, with obstacles shrunk by at most `margin`
/// metres. It contains every configuration that keeps the scene's clearance. It contains no configuration that
/// violates the clearance by more than `margin`.
///
/// Returns `None` for other arms, if link 1 can touch an obstacle, and for shapes too thin to be shrunk: walls
/// without thickness together with a link that is a point. The number of vertices grows like `1 / sqrt(margin)`.
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

/// Returns the limits on intervals, and `periods` turns to either side of `center` on circles.
fn window(scene: &Scene, center: Configuration, periods: usize) -> [(f64, f64); 2] {
    let topology = scene.arm().topology();
    let turns = TAU * periods as f64;
    [0, 1].map(|k| match topology.ranges[k] {
        JointRange::Interval { lower, upper } => (lower, upper),
        JointRange::Circle => (center[k] - turns, center[k] + turns),
    })
}

fn within_window(scene: &Scene, proves: Proves, window: [(f64, f64); 2], obstacles: Vec<CObstacle>) -> Regions {
    let topology = scene.arm().topology();
    let contours = obstacles.iter().map(|o| o.contour.as_slice());
    let free = free_space(window, &allowed(window, topology.sum), periods(scene), contours);
    Regions { topology, proves, window, obstacles, free }
}

/// Returns the part of a window in which the sum of joint values is allowed, counter-clockwise. Empty if there is no such part.
fn allowed(window: Window, sum: Option<JointSumRange>) -> Vec<Point> {
    let corners = corners(window).to_vec();
    let Some(JointSumRange { ratio, lower, upper }) = sum else { return corners };
    // A point is allowed if both values are positive. The inset covers the rounding of the union.
    let above = |p: Point| ratio * p.x + p.y - (lower + SUM_INSET);
    let below = |p: Point| (upper - SUM_INSET) - (ratio * p.x + p.y);
    cut(&cut(&corners, above), below)
}

/// Returns the parts of the limits in which the sum of joint values is not allowed, for pictures.
pub fn beyond_sum(topology: &Topology) -> Vec<Vec<Point>> {
    let Some(JointSumRange { ratio, lower, upper }) = topology.sum else { return Vec::new() };
    let corners = corners(topology.ranges.map(JointRange::domain));
    let below = cut(&corners, |p| lower - (ratio * p.x + p.y));
    let above = cut(&corners, |p| ratio * p.x + p.y - upper);
    [below, above].into_iter().filter(|part| part.len() > 2).collect()
}

/// Returns the part of a convex polygon on which an affine function is not negative.
fn cut(corners: &[Point], value: impl Fn(Point) -> f64) -> Vec<Point> {
    let mut kept = Vec::new();
    for (k, &from) in corners.iter().enumerate() {
        let to = corners[(k + 1) % corners.len()];
        let [at_from, at_to] = [from, to].map(&value);
        if at_from >= 0.0 {
            kept.push(from);
        }
        if (at_from >= 0.0) != (at_to >= 0.0) {
            kept.push(from + (to - from) * (at_from / (at_from - at_to)));
        }
    }
    kept
}

/// Returns the period after which poses repeat, for each joint; `None` for prismatic joints.
fn periods(scene: &Scene) -> [Option<f64>; 2] {
    scene.arm().joints.each_ref().map(|joint| joint.joint_type.is_revolute().then_some(TAU))
}

/// Returns the blocked regions of each obstacle of the workspace, and then of each listed self obstacle
/// ([`Scene::listed_self_obstacles`]). `contours` are the scene's [`c_obstacles`]. The regions of an obstacle are
/// disjoint polygons within the limits. On circles they are within `[-pi, pi]`, and end at the seams.
pub fn united(scene: &Scene, contours: &[CObstacle]) -> Vec<Vec<PolygonWithHoles>> {
    let window = scene.arm().topology().ranges.map(JointRange::domain);
    let of = |number: usize| contours.iter().filter(move |c| c.obstacle == number).map(|c| c.contour.as_slice());
    let obstacles = (0..scene.workspace().obstacles.len()).chain(scene.listed_self_obstacles());
    obstacles.map(|number| blocked_space(window, periods(scene), of(number))).collect()
}

/// Returns contours that cover every configuration in which a pair of the scene is at most the clearance plus `margin`
/// apart. They cover hardly any configuration in which all pairs are farther apart than that by more than `2 *
/// tolerance`. `margin` and `tolerance` are in metres; `tolerance` must be positive.
///
/// A pair may have several contours, and contours of one obstacle may overlap. Unless the margin is 0, shapes with many
/// corners are simplified, which may move their contours away by another two margins.
///
/// The C-obstacles of link 1 are bands of `q1`, in closed form. Those of gantries are Minkowski differences, which are
/// exact except for arcs. In all other cases, chords approximate curves between exact slices.
///
/// The coverage is proven. Let `S` be the set to cover. Slices are exact, and chords keep their distance from `S`
/// (module `chord`). So no point of `S` lies on the boundary of the union, and each connected part of `S` is completely
/// inside or completely outside. It is inside, because it has a point on a slice: either it reaches the end of the
/// range of `q1`, or it has a point of least `q1` (module `events`).
///
/// # Panics
/// If `tolerance` is not positive.
pub fn c_obstacles(scene: &Scene, margin: f64, tolerance: f64) -> Vec<CObstacle> {
    assert!(tolerance > 0.0, "a tolerance for the flattening of curves");
    trace_contours(&coarsened(scene, margin, tolerance), scene.workspace().clearance + margin, tolerance)
}

/// Returns contours around the configurations in which a pair of shapes is within `level`, with this tolerance.
fn trace_contours(scene: &Scene, level: f64, tolerance: f64) -> Vec<CObstacle> {
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

/// Returns the scene whose contours are traced, with simpler shapes.
fn coarsened(scene: &Scene, margin: f64, tolerance: f64) -> Cow<'_, Scene> {
    coarse(scene, COARSENESS_PER_MARGIN * margin, scene.workspace().clearance + margin + 4.0 * tolerance)
}

/// Returns the number of pairs of shapes that [`regions`] traces with this `margin`. A greater margin makes shapes
/// with many corners coarser.
pub fn traced_pairs(scene: &Scene, margin: f64) -> usize {
    coarsened(scene, PROVEN_MARGIN_SHARE * margin, (1.0 - PROVEN_MARGIN_SHARE) * margin).pairs().len()
}

/// Returns the bands of `q1` in which a pair of link 1 is within `level`, over all values of `q2`. They extend by `pad`
/// beyond both ends of `q2`, so that copies a whole turn apart overlap. For a pair of link 2 and link 1, returns bands
/// of `q2` over all values of `q1`.
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
