//! Finds strips that are too wide, in which a shortest path enters a closed region.

use super::MotionQuery;
use super::search::MixingHasher;
use super::strips::Strips;
use crate::slab::CLOSED_FORM_ERROR;
use cplan_geometry::{Point, Pose, Vector, gap_along, separation};
use cplan_judge::{Deviation, Posture, Vicinity};
use cplan_model::space::Measure;
use cplan_model::{Pair, Scene};
use std::collections::{BTreeMap, HashSet};
use std::convert::Infallible;
use std::hash::BuildHasherDefault;

/// Distance between configurations at which a path is tested for obstacles thinner than a strip, radians or metres.
const TEST_STEP: f64 = 0.01;

/// Tested configurations approach the ends of a path's piece: their distance from the end falls by this factor from one to the
/// next.
const TEST_STEP_RATIO: f64 = 0.1;

/// A strip is cut at once until its distance from the tip of a wall is this multiple of the detour that a strip may leave open. A
/// path around the tip is longer by at most twice the distance.
const CUT_DISTANCE_RATIO: f64 = 16.0;

/// If fewer cuts lead towards a jump, the strip is also cut into equal parts. The strip is then narrow, and the path may have to
/// go around many small obstacles side by side.
const FEW_CUTS: usize = 4;

/// Resolution of positions along a piece of a path in double precision, as a share of the piece's length.
const POSITION_RESOLUTION: f64 = 1e-15;

/// The allowed error of paths through closed regions.
#[derive(Debug, Clone, Copy)]
pub(super) enum PathTolerance {
    /// The path may be shorter than one around the region by this, in units of the metric.
    Detour(f64),
    /// The path may enter the region up to this depth, metres.
    Depth(f64),
}

/// The part of a path within one strip.
struct Crossing {
    /// Index of the strip.
    index: usize,
    /// Value of joint 1 on the path minus its value in the strip: whole turns, radians.
    turns: f64,
    /// The points where the path enters and leaves the strip, ordered by joint 1.
    ends: [Point; 2],
    /// The point of the path halfway between the strip's slices; `None` if the path does not reach it.
    middle: Option<Point>,
}

/// Returns the parts of a path within strips. A part along a slice is in no strip. For such a part, adds to `beside` the strips
/// next to it, with the values of joint 1 at which to cut them. These values approach the tip that the path may go around.
fn crossings(
    strips: &mut Strips,
    corners: &[Point],
    finest: f64,
    beside: &mut BTreeMap<usize, Vec<f64>>,
) -> Vec<Crossing> {
    let mut crossings = Vec::new();
    for ends in corners.windows(2) {
        let (from, to) = if ends[0].x <= ends[1].x { (ends[0], ends[1]) } else { (ends[1], ends[0]) };
        if from.x == to.x {
            beside.extend(around_tip(strips, ends, finest));
            continue;
        }
        let (first, last) = (strips.locate(from.x), strips.locate(to.x));
        let at = |q1: f64| Point::new(q1, from.y + (to.y - from.y) * ((q1 - from.x) / (to.x - from.x)));
        for strip in first..=last {
            let slices = [strips.q1(strip), strips.q1(strip + 1)];
            let (left, right) = (slices[0].max(from.x), slices[1].min(to.x));
            let middle = f64::midpoint(slices[0], slices[1]);
            if left < right {
                crossings.push(Crossing {
                    index: strips.index(strip),
                    turns: strips.turns(strip),
                    ends: [left, right].map(at),
                    middle: (left < middle && middle < right).then(|| at(middle)),
                });
            }
        }
    }
    crossings
}

/// Returns the strips next to a part of a path along a slice, with the values of joint 1 at which to cut them. These values
/// approach the tip that the path goes around. Returns nothing if there is no such tip, or if it is near enough.
fn around_tip(strips: &mut Strips, ends: &[Point], finest: f64) -> Vec<(usize, Vec<f64>)> {
    let q1 = ends[0].x;
    let mut cuts = Vec::new();
    for strip in strips.strips_at(q1) {
        let (index, after) = (strips.index(strip), strips.q1(strip + 1) == q1);
        let of_tip = ends.iter().map(|end| strips.towards_tip(index, after, end.y, finest));
        let tip = of_tip.max_by_key(Vec::len).unwrap_or_default();
        if !tip.is_empty() {
            return vec![(index, tip)];
        }
        let [from, to] = strips.ends(index);
        if to - from > finest {
            cuts.push((index, Vec::new()));
        }
    }
    cuts
}

/// Straight pieces of paths within a strip that need no refinement. The key has the ends of the piece and of the strip. Most
/// pieces of a path are the same as in the previous path.
pub(super) type RefinedPieces = HashSet<[u64; 6], BuildHasherDefault<MixingHasher>>;

/// Returns the strips, by index, in which a path enters a closed region by more than the tolerance, with the values of joint 1 at
/// which to cut them. If it overlooks a strip, the bound is lower, but not wrong. Skips pieces in `fine`.
pub(super) fn crossed_strips(
    motions: &MotionQuery,
    vicinity: &Vicinity,
    strips: &mut Strips,
    corners: &[Point],
    allowed: PathTolerance,
    fine: &mut RefinedPieces,
) -> Vec<(usize, Vec<f64>)> {
    let MotionQuery { scene, clearance, metric, .. } = *motions;
    let measure = Measure::from(metric);
    // The surroundings of a part along a slice are not known well enough.
    let mut passed = BTreeMap::new();
    let finest = match allowed {
        PathTolerance::Detour(worth) => worth * CUT_DISTANCE_RATIO,
        PathTolerance::Depth(depth) => depth / scene.arm().reach().max(1.0),
    };
    let crossings = crossings(strips, corners, finest, &mut passed);
    for crossing in &crossings {
        let Crossing { index, turns, ends: [left, right], middle } = *crossing;
        let [from, to] = strips.ends(index);
        let known = [left.x, left.y, right.x, right.y, from, to].map(f64::to_bits);
        if fine.contains(&known) {
            continue;
        }
        let detour = |by: f64| {
            let via = (left + right) * 0.5 + Vector::new(0.0, by);
            measure.norm(via - left) + measure.norm(right - via) - measure.norm(right - left)
        };
        // Tests may miss a collision that is visible halfway through the strip, where the next slice would be.
        let is_barred_halfway = |strips: &mut Strips, worth: f64| {
            let way_out = middle.and_then(|middle| strips.distances_out_of_middle(index, middle.y));
            way_out.is_some_and(|ways| ways.map(detour).into_iter().all(|detour| detour > worth))
        };
        if let Some(DeepestPlace { by, share, pair }) = deepest(scene, vicinity, clearance, [left, right], allowed) {
            let at = left + (right - left) * share - Vector::new(turns, 0.0);
            let mut cuts = strips.towards_jumps(index, pair, at, finest);
            if cuts.len() < FEW_CUTS {
                let n = pieces(by, allowed);
                cuts.extend((1..n).map(|k| left.x - turns + (right.x - left.x) * (k as f64 / n as f64)));
            }
            cuts.push(at.x);
            cuts.sort_unstable_by(f64::total_cmp);
            passed.entry(index).or_insert(cuts);
        } else if matches!(allowed, PathTolerance::Detour(worth) if is_barred_halfway(strips, worth)) {
            passed.entry(index).or_default();
        } else {
            fine.insert(known);
        }
    }
    passed.into_iter().collect()
}

/// The place where a straight motion is deepest inside a closed region.
struct DeepestPlace {
    /// Depth in excess of the allowed depth, metres.
    by: f64,
    /// Position as a share of the motion.
    share: f64,
    /// The pair that is too near there.
    pair: Pair,
}

/// Finds the place where a straight motion is deepest inside a closed region. `None` if it stays within the tolerance. Tests
/// configurations at regular distances, and ever closer ones towards the ends, where a path may turn at a closed region.
fn deepest(
    scene: &Scene,
    vicinity: &Vicinity,
    clearance: f64,
    ends: [Point; 2],
    allowed: PathTolerance,
) -> Option<DeepestPlace> {
    let (displacement, middle) = (ends[1] - ends[0], (ends[0] + ends[1]) * 0.5);
    let length = displacement.norm();
    let steps = (length / TEST_STEP).ceil().max(1.0);
    let regular = (0..steps as usize).map(|i| (i as f64 + 0.5) / steps);
    let (PathTolerance::Detour(finest) | PathTolerance::Depth(finest)) = allowed;
    let near = std::iter::successors(Some(TEST_STEP_RATIO), |share| Some(share * TEST_STEP_RATIO));
    let towards_ends = near.take_while(|share| share * length > finest).flat_map(|share| [share, 1.0 - share]);
    let mut shares: Vec<f64> = regular.chain(towards_ends).collect();
    // The shares are almost sorted already.
    shares.sort_by(f64::total_cmp);

    // Walls are made of shapes that are eroded by this length.
    let least = clearance - 2.0 * CLOSED_FORM_ERROR;
    let posture = Posture::new(scene, middle);
    let along = Deviation::Along(displacement / 2.0);
    let may_meet = |pair: Pair| posture.disc_bound(pair, along) < least && posture.bound(pair, along).least < least;
    let pose = |pair: Pair, share: f64| scene.arm().pose(pair.link, ends[0] + displacement * share);
    let here = |pair: Pair, pose: &Pose| separation(&scene.part(pair).at(pose), scene.piece(pair));
    let depth = |share: f64| match allowed {
        PathTolerance::Detour(worth) => scene.arm().reach() * (worth * length * share.min(1.0 - share)).sqrt(),
        PathTolerance::Depth(depth) => depth,
    };
    // Depth in excess of the allowed depth.
    let beyond = |pair: Pair, share: f64| least - here(pair, &pose(pair, share)).distance - depth(share);
    let mut deepest: Option<(f64, Pair, usize)> = None;
    let examined_paths: Result<(), Infallible> = vicinity.near(&posture, along, least.max(0.0), |pair| {
        if may_meet(pair) {
            // Skips places up to which no shape can have moved far enough to be too near.
            let speed = 2.0 * posture.farthest_motion(pair, along);
            let mut next = 0.0;
            let mut direction = None;
            for (k, &share) in shares.iter().enumerate() {
                if share < next {
                    continue;
                }
                let pose = pose(pair, share);
                let most = depth(share) + deepest.map_or(0.0, |(by, ..)| by);
                // The direction of the distance at the last place often shows that this one is no deeper.
                let along = |n: Vector| least - gap_along(scene.part(pair), &pose, scene.piece(pair), n);
                let near = direction.map(along).filter(|near| *near <= most).unwrap_or_else(|| {
                    let here = here(pair, &pose);
                    direction = Some(here.direction);
                    least - here.distance
                });
                if near > most {
                    deepest = Some((near - depth(share), pair, k));
                }
                next = share - near.min(0.0) / speed;
            }
        }
        Ok(())
    });
    examined_paths.unwrap_or_else(|never| match never {});
    let (_, pair, k) = deepest?;
    // Near there, the depth has a single maximum.
    let mut from = k.checked_sub(1).map_or(0.0, |before| shares[before]);
    let mut to = shares.get(k + 1).copied().unwrap_or(1.0);
    let finest = (finest / length).max(POSITION_RESOLUTION);
    while to - from > finest {
        let [a, b] = [from + (to - from) / 3.0, to - (to - from) / 3.0];
        if beyond(pair, a) >= beyond(pair, b) { to = b } else { from = a }
    }
    let share = f64::midpoint(from, to);
    Some(DeepestPlace { by: beyond(pair, share), share, pair })
}

/// Returns the number of parts into which to cut a strip. Along a smooth boundary, the error falls with the square of the strip's
/// width.
fn pieces(by: f64, allowed: PathTolerance) -> usize {
    match allowed {
        PathTolerance::Depth(depth) => (1.1 * ((by.max(0.0) + depth) / depth).sqrt()).ceil().min(16.0) as usize,
        PathTolerance::Detour(_) => 1,
    }
}
