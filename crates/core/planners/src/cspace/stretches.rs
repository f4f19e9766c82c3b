//! Finds the free parts of a segment along one joint, exactly.

use super::slices::Slice;
use cplan_geometry::{Features, Vector, merge_in_place, separation};
use cplan_model::space::{Configuration, Segment};
use cplan_model::{CarriedPart, Contacts, Scene, on_axis};

/// Returns the parts of a segment in the domain on which all pairs are more than `grow` apart, beginning at the lesser
/// end. The result is exact up to [`cplan_geometry::ROUNDING`] if only one joint moves along the segment. Otherwise the
/// segment is returned unchanged.
///
/// If joint 2 moves, the result is the free part of a slice. If joint 1 moves, link 2 is treated as a part of link 1,
/// and the contact angles of joint 1 decide. `O(m log m)` for `m` contacts.
pub fn free_stretches(scene: &Scene, segment: &Segment, grow: f64) -> Vec<Segment> {
    let [from, to] = segment.ends();
    let moved = match (from[0] == to[0], from[1] == to[1]) {
        (true, _) => 1,
        (_, true) => 0,
        (false, false) => return vec![*segment],
    };
    let forbidden = if moved == 1 {
        forbidden_second_values(scene, from[0], grow)
    } else {
        forbidden_first_values(scene, from[1], grow)
    };
    let (least, greatest) = (from[moved].min(to[moved]), from[moved].max(to[moved]));
    let at = |value: f64| {
        let mut q = from;
        q[moved] = value;
        q
    };
    let mut free = Vec::new();
    let mut reached = least;
    for [lower, upper] in forbidden.into_iter().chain([[f64::INFINITY; 2]]) {
        if reached < lower.min(greatest) {
            free.push(Segment::new(at(reached), at(lower.min(greatest))));
        }
        reached = reached.max(upper);
    }
    free
}

/// Returns the forbidden values of joint 2 at a value of joint 1. These are all values if link 1 is in contact.
fn forbidden_second_values(scene: &Scene, q1: f64, grow: f64) -> Vec<[f64; 2]> {
    let slices = Contacts::new(scene);
    if Slice::bands(&slices, grow).forbids(q1) {
        return vec![[f64::NEG_INFINITY, f64::INFINITY]];
    }
    let mut slice = Slice::default();
    slice.compute(&slices, q1, grow);
    slice.merged
}

/// Returns the forbidden values of joint 1 at a value of joint 2.
fn forbidden_first_values(scene: &Scene, q2: f64, grow: f64) -> Vec<[f64; 2]> {
    let arm = scene.arm();
    let joint = &arm.joints[0];
    let [first, second] = arm.poses(Configuration::new(0.0, q2));
    let in_first = first.inverse() * second;
    let (mut forbidden, mut scratch) = (Vec::new(), Vec::new());
    for &pair in scene.pairs() {
        let part = scene.part(pair);
        if pair.link == 2 {
            // Joint 1 carries both shapes.
            if separation(&part.at(&second), scene.piece(pair)).distance <= grow {
                return vec![[f64::NEG_INFINITY, f64::INFINITY]];
            }
            continue;
        }
        let part = if pair.link == 0 {
            CarriedPart::new(joint.joint_type, part)
        } else {
            CarriedPart::new(joint.joint_type, &part.at(&in_first))
        };
        scratch.clear();
        let hits = part.hits(arm.base, Vector::x(), &Features::new(scene.piece(pair)), grow, &mut scratch);
        on_axis(joint, hits, &scratch, |interval| forbidden.push(interval));
    }
    merge_in_place(&mut forbidden);
    forbidden
}
