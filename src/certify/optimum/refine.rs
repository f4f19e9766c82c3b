//! Where a shortest way passes what is closed: there strips are too wide.

use super::strips::Strips;
use crate::certify::deviation::{Deviation, Posture};
use crate::certify::slab::OUTWARD;
use crate::certify::vicinity::Vicinity;
use crate::geometry::{Point, Vector, separation};
use crate::model::{Pair, Scene};
use crate::space::Measure;

/// Distance of the configurations, radians or metres, at which ways are looked at for what is thinner than a strip.
const STEP: f64 = 0.005;

/// Ratio of the distances from an end at which they are looked at.
const NEARER: f64 = 0.25;

/// What a way looks like in one strip.
struct Crossing {
    /// The strip's place among all.
    index: usize,
    /// Where the way enters it and leaves it, or the other way round; by joint 1.
    ends: [Point; 2],
    /// The way halfway between the strip's rows; none if it does not get there.
    middle: Option<Point>,
}

/// The strips that a way crosses. Ways along a row lie in no strip; those beside it are put on `beside`.
fn crossings(strips: &Strips, corners: &[Point], beside: &mut Vec<usize>) -> Vec<Crossing> {
    let mut crossings = Vec::new();
    for ends in corners.windows(2) {
        let (from, to) = if ends[0].x <= ends[1].x { (ends[0], ends[1]) } else { (ends[1], ends[0]) };
        if from.x == to.x {
            beside.extend(strips.around(from.x).into_iter().map(|strip| strips.index(strip)));
            continue;
        }
        let (first, last) = (strips.locate(from.x), strips.locate(to.x));
        let at = |q1: f64| Point::new(q1, from.y + (to.y - from.y) * ((q1 - from.x) / (to.x - from.x)));
        for strip in first..=last {
            let rows = [strips.q1(strip), strips.q1(strip + 1)];
            let (left, right) = (rows[0].max(from.x), rows[1].min(to.x));
            let middle = f64::midpoint(rows[0], rows[1]);
            if left < right {
                crossings.push(Crossing {
                    index: strips.index(strip),
                    ends: [left, right].map(at),
                    middle: (left < middle && middle < right).then(|| at(middle)),
                });
            }
        }
    }
    crossings
}

/// The strips, ascending, in which a way passes what is closed, and would be longer by more than `worth` if it did not. What
/// is overlooked makes no bound wrong, only lower.
pub(super) fn passed(
    scene: &Scene,
    vicinity: &Vicinity,
    clearance: f64,
    strips: &mut Strips,
    corners: &[Point],
    measure: Measure,
    worth: f64,
) -> Vec<usize> {
    // What lies beside a way along a row is not known well enough.
    let mut passed = Vec::new();
    let crossings = crossings(strips, corners, &mut passed);
    for crossing in &crossings {
        let Crossing { index, ends: [left, right], middle } = *crossing;
        // Halfway through the strip first: this is where the next row will be.
        let way_out = middle.and_then(|middle| strips.way_out_of_middle(index, middle.y));
        let detour = |by: f64| {
            let via = nalgebra::center(&left, &right) + Vector::new(0.0, by);
            measure.norm(via - left) + measure.norm(right - via) - measure.norm(right - left)
        };
        if way_out.is_some_and(|way_out| way_out.map(detour).into_iter().fold(f64::INFINITY, f64::min) > worth)
            || meets(scene, vicinity, clearance, [left, right], worth)
        {
            passed.push(index);
        }
    }
    passed.sort_unstable();
    passed.dedup();
    passed
}

/// Whether a straight motion comes too near an obstacle, as far as looking in places tells: at regular distances, and towards
/// the ends, where a way may turn at what is closed, closer and closer together. Not where keeping away would make a bulge
/// of it that is hardly longer, by `worth`.
fn meets(scene: &Scene, vicinity: &Vicinity, clearance: f64, ends: [Point; 2], worth: f64) -> bool {
    let (way, middle) = (ends[1] - ends[0], nalgebra::center(&ends[0], &ends[1]));
    let length = way.norm();
    let steps = (length / STEP).ceil().max(1.0);
    let regular = (0..steps as usize).map(|i| (i as f64 + 0.5) / steps);
    let near = std::iter::successors(Some(NEARER), |share| Some(share * NEARER));
    let towards_ends = near.take_while(|share| share * length > worth).flat_map(|share| [share, 1.0 - share]);
    let shares: Vec<f64> = regular.chain(towards_ends).collect();

    // Walls are made of shapes that are smaller by this.
    let least = clearance - 2.0 * OUTWARD;
    let posture = Posture::new(scene, middle.coords);
    let along = Deviation::Along(way / 2.0);
    let may_meet = |pair: Pair| posture.apart(pair, along) < least && posture.bound(pair, along).least < least;
    let does_meet = |pair: Pair| {
        shares.iter().any(|&share| {
            let part = scene.part(pair).at(&scene.arm().pose(pair.link, (ends[0] + way * share).coords));
            let bulge = scene.arm().reach() * (worth * length * share.min(1.0 - share)).sqrt();
            separation(&part, scene.piece(pair)).distance < least - bulge
        })
    };
    let apart = |pair: Pair| if may_meet(pair) && does_meet(pair) { Err(()) } else { Ok(()) };
    vicinity.near(&posture, along, least.max(0.0), apart).is_err()
}
