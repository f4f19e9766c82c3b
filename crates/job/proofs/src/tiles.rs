//! Collision boxes for the colliding intervals of slabs, as few as possible.
//!
//! A colliding interval of a slab needs some dozens of boxes, because the height of a box is limited by the overlap of the
//! shapes, which falls towards the ends of the interval. Narrow slabs would repeat all these boxes. So adjacent slabs share
//! boxes: a rectangle over several slabs is one box if it collides everywhere. Otherwise it is halved, along the joint that moves
//! the shapes more.

use super::slab::is_collision;
use cplan_interrupt::checkpoint;
use cplan_judge::{Cell, CollisionBox, Deviation, Posture};
use cplan_model::{Pair, Scene};

/// Largest number of boxes for a colliding interval of a slab. Where shapes overlap little, the height of boxes must be about the
/// width of the slab.
const MAX_TILES_PER_INTERVAL: usize = 4096;

/// A slab `from <= q1 <= to` with its collisions: the pair, and the interval of joint 2.
pub(super) struct SlabCollision {
    pub from: f64,
    pub to: f64,
    pub by: Vec<(Pair, [f64; 2])>,
}

/// Adds boxes that cover all collisions of adjacent slabs, within the range of joint 2. Returns false if there are more than
/// `most` boxes, or if the check of a proof would refuse one.
pub(super) fn add_boxes(
    scene: &Scene,
    clearance: f64,
    slabs: &[SlabCollision],
    range: [f64; 2],
    most: usize,
    boxes: &mut Vec<CollisionBox>,
) -> bool {
    let mut open = vec![(slabs, range)];
    while let Some((slabs, [lower, upper])) = open.pop() {
        checkpoint();
        let [first, .., last] = slabs else {
            for slab in slabs {
                for &(pair, [from, to]) in &slab.by {
                    let (part, across) = ([from.max(lower), to.min(upper)], [slab.from, slab.to]);
                    if part[0] < part[1] && !tile(scene, clearance, across, pair, part, boxes) || boxes.len() > most {
                        return false;
                    }
                }
            }
            continue;
        };
        let parts = slabs.iter().flat_map(|slab| &slab.by);
        let parts = parts.map(|&(pair, [from, to])| (pair, to.min(upper) - from.max(lower)));
        let Some((pair, height)) = parts.filter(|part| part.1 > 0.0).max_by(|a, b| a.1.total_cmp(&b.1)) else {
            continue;
        };
        let cell = Cell { lower: [first.from, lower], upper: [last.to, upper] };
        if height == upper - lower && is_collision(scene, pair, &cell, clearance) {
            boxes.push(CollisionBox { cell, pair });
            continue;
        }
        let (posture, half) = (Posture::new(scene, cell.center()), cell.half());
        let [along, across] =
            [[half[0], 0.0], [0.0, half[1]]].map(|half| posture.farthest_motion(pair, Deviation::Box(half)));
        let middle = lower.midpoint(upper);
        if across > along && lower < middle && middle < upper {
            open.extend([(slabs, [middle, upper]), (slabs, [lower, middle])]);
        } else {
            let middle = first.from.midpoint(last.to);
            let at = slabs.partition_point(|slab| slab.to <= middle).clamp(1, slabs.len() - 1);
            let (before, after) = slabs.split_at(at);
            open.extend([(after, [lower, upper]), (before, [lower, upper])]);
        }
    }
    true
}

/// Adds boxes that cover the slab `from <= q1 <= to` for `q2` in `interval`, where a pair collides. Returns false if the check of
/// a proof would refuse one.
pub(super) fn tile(
    scene: &Scene,
    clearance: f64,
    [from, to]: [f64; 2],
    pair: Pair,
    interval: [f64; 2],
    boxes: &mut Vec<CollisionBox>,
) -> bool {
    let begin = boxes.len();
    let mut open = vec![interval];
    while let Some([lower, upper]) = open.pop() {
        checkpoint();
        let cell = Cell { lower: [from, lower], upper: [to, upper] };
        if is_collision(scene, pair, &cell, clearance) {
            boxes.push(CollisionBox { cell, pair });
            continue;
        }
        let middle = (lower + upper) / 2.0;
        if open.len() + boxes.len() - begin > MAX_TILES_PER_INTERVAL || middle <= lower || middle >= upper {
            return false;
        }
        open.push([middle, upper]);
        open.push([lower, middle]);
    }
    true
}
