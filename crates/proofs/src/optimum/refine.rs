//! Where a shortest way passes what is closed: there strips are too wide.

use super::Motions;
use super::search::Mixed;
use super::strips::Strips;
use crate::slab::OUTWARD;
use cplan_core::check::Vicinity;
use cplan_core::check::{Deviation, Posture};
use cplan_core::model::{Pair, Scene};
use cplan_core::space::Measure;
use cplan_geometry::{Point, Pose, Vector, gap_along, separation};
use std::collections::{BTreeMap, HashSet};
use std::convert::Infallible;
use std::hash::BuildHasherDefault;

/// Distance of the configurations, radians or metres, at which ways are looked at for what is thinner than a strip.
const STEP: f64 = 0.01;

/// Ratio of the distances from an end at which they are looked at.
const NEARER: f64 = 0.1;

/// How near to a tip strips are cut at once, as a multiple of the detour that a strip may leave open: a way around the tip
/// is as much longer, at the most twice.
const DETOUR: f64 = 16.0;

/// A strip with fewer cuts than this towards where something begins is cut all along, too: so near by, what the way goes round may be
/// many small things side by side.
const FEW: usize = 4;

/// Places along a piece of a way are not told apart more finely than doubles tell shares of it.
const FINEST_SHARE: f64 = 1e-15;

/// How far ways may lead through what is closed.
#[derive(Debug, Clone, Copy)]
pub(super) enum Allowed {
    /// As far as a way around it would be longer by no more than this.
    Detour(f64),
    /// So deep, metres.
    Depth(f64),
}

/// What a way looks like in one strip.
struct Crossing {
    /// The strip's place among all.
    index: usize,
    /// Whole turns by which joint 1 is ahead of the strip's own values.
    turns: f64,
    /// Where the way enters it and leaves it, or the other way round; by joint 1.
    ends: [Point; 2],
    /// The way halfway between the strip's slices; none if it does not get there.
    middle: Option<Point>,
}

/// The strips that a way crosses. Ways along a slice lie in no strip; those beside it are put on `beside`, each cut towards the
/// tip that the way may lead around.
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

/// Where to cut the strips beside a way along a slice: towards the tip that it leads around, if there is one. Nothing where that
/// tip is near enough.
fn around_tip(strips: &mut Strips, ends: &[Point], finest: f64) -> Vec<(usize, Vec<f64>)> {
    let q1 = ends[0].x;
    let mut cuts = Vec::new();
    for strip in strips.around(q1) {
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

/// Straight pieces of ways within a strip that are known to pass nothing by more than is allowed: their ends, and the strip's. Most
/// of a way is where the last one was.
pub(super) type Fine = HashSet<[u64; 6], BuildHasherDefault<Mixed>>;

/// Where to cut strips: those in which a way passes what is closed by more than is allowed, by their index. What is overlooked
/// makes no bound wrong, only lower. What is `fine` is not looked at.
pub(super) fn passed(
    motions: &Motions,
    vicinity: &Vicinity,
    strips: &mut Strips,
    corners: &[Point],
    allowed: Allowed,
    fine: &mut Fine,
) -> Vec<(usize, Vec<f64>)> {
    let Motions { scene, clearance, metric, .. } = *motions;
    let measure = Measure::from(metric);
    // What lies beside a way along a slice is not known well enough.
    let mut passed = BTreeMap::new();
    let finest = match allowed {
        Allowed::Detour(worth) => worth * DETOUR,
        Allowed::Depth(depth) => depth / scene.arm().reach().max(1.0),
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
            let via = nalgebra::center(&left, &right) + Vector::new(0.0, by);
            measure.norm(via - left) + measure.norm(right - via) - measure.norm(right - left)
        };
        // What is overlooked at the places that are looked at may show halfway through the strip, where the next slice would be.
        let is_barred_halfway = |strips: &mut Strips, worth: f64| {
            let way_out = middle.and_then(|middle| strips.way_out_of_middle(index, middle.y));
            way_out.is_some_and(|ways| ways.map(detour).into_iter().all(|detour| detour > worth))
        };
        if let Some(Deepest { by, share, pair }) = deepest(scene, vicinity, clearance, [left, right], allowed) {
            let at = left + (right - left) * share - Vector::new(turns, 0.0);
            let mut cuts = strips.towards_jumps(index, pair, at, finest);
            if cuts.len() < FEW {
                let n = pieces(by, allowed);
                cuts.extend((1..n).map(|k| left.x - turns + (right.x - left.x) * (k as f64 / n as f64)));
            }
            cuts.push(at.x);
            cuts.sort_unstable_by(f64::total_cmp);
            passed.entry(index).or_insert(cuts);
        } else if matches!(allowed, Allowed::Detour(worth) if is_barred_halfway(strips, worth)) {
            passed.entry(index).or_default();
        } else {
            fine.insert(known);
        }
    }
    passed.into_iter().collect()
}

/// The place of a straight motion that is deepest in what is closed.
struct Deepest {
    /// How much deeper than allowed, metres.
    by: f64,
    /// Where, as a share of the motion.
    share: f64,
    /// What is too near there.
    pair: Pair,
}

/// Where a straight motion comes nearest to an obstacle, as a share of it, if it comes too near, as far as looking in places
/// tells: at regular distances, and towards the ends, where a way may turn at what is closed, closer and closer together. Not
/// where keeping away would make a bulge of it that is hardly longer, by the detour that is allowed.
fn deepest(scene: &Scene, vicinity: &Vicinity, clearance: f64, ends: [Point; 2], allowed: Allowed) -> Option<Deepest> {
    let (way, middle) = (ends[1] - ends[0], nalgebra::center(&ends[0], &ends[1]));
    let length = way.norm();
    let steps = (length / STEP).ceil().max(1.0);
    let regular = (0..steps as usize).map(|i| (i as f64 + 0.5) / steps);
    let (Allowed::Detour(finest) | Allowed::Depth(finest)) = allowed;
    let near = std::iter::successors(Some(NEARER), |share| Some(share * NEARER));
    let towards_ends = near.take_while(|share| share * length > finest).flat_map(|share| [share, 1.0 - share]);
    let mut shares: Vec<f64> = regular.chain(towards_ends).collect();
    // Most of it is in order.
    shares.sort_by(f64::total_cmp);

    // Walls are made of shapes that are smaller by this.
    let least = clearance - 2.0 * OUTWARD;
    let posture = Posture::new(scene, middle.coords);
    let along = Deviation::Along(way / 2.0);
    let may_meet = |pair: Pair| posture.apart(pair, along) < least && posture.bound(pair, along).least < least;
    let pose = |pair: Pair, share: f64| scene.arm().pose(pair.link, (ends[0] + way * share).coords);
    let here = |pair: Pair, pose: &Pose| separation(&scene.part(pair).at(pose), scene.piece(pair));
    let depth = |share: f64| match allowed {
        Allowed::Detour(worth) => scene.arm().reach() * (worth * length * share.min(1.0 - share)).sqrt(),
        Allowed::Depth(depth) => depth,
    };
    // How much deeper than allowed.
    let beyond = |pair: Pair, share: f64| least - here(pair, &pose(pair, share)).distance - depth(share);
    let mut deepest: Option<(f64, Pair, usize)> = None;
    let looked_at: Result<(), Infallible> = vicinity.near(&posture, along, least.max(0.0), |pair| {
        if may_meet(pair) {
            // As far as nothing moves so far that it could be too near, there is no need to look.
            let speed = 2.0 * posture.farthest_motion(pair, along);
            let mut next = 0.0;
            let mut direction = None;
            for (k, &share) in shares.iter().enumerate() {
                if share < next {
                    continue;
                }
                let pose = pose(pair, share);
                let most = depth(share) + deepest.map_or(0.0, |(by, ..)| by);
                // The direction of the distance at the last place often shows already that this one is no deeper.
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
    looked_at.unwrap_or_else(|never| match never {});
    let (_, pair, k) = deepest?;
    // Near there it is one hump.
    let mut from = k.checked_sub(1).map_or(0.0, |before| shares[before]);
    let mut to = shares.get(k + 1).copied().unwrap_or(1.0);
    let finest = (finest / length).max(FINEST_SHARE);
    while to - from > finest {
        let [a, b] = [from + (to - from) / 3.0, to - (to - from) / 3.0];
        if beyond(pair, a) >= beyond(pair, b) { to = b } else { from = a }
    }
    let share = f64::midpoint(from, to);
    Some(Deepest { by: beyond(pair, share), share, pair })
}

/// In how many parts a strip is cut in which a way is by so much deeper in what is closed than allowed: what is cut off from a
/// smooth boundary falls with the square of the width.
fn pieces(by: f64, allowed: Allowed) -> usize {
    match allowed {
        Allowed::Depth(depth) => (1.1 * ((by.max(0.0) + depth) / depth).sqrt()).ceil().min(16.0) as usize,
        Allowed::Detour(_) => 1,
    }
}
