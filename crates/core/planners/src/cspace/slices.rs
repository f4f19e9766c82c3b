//! Slices of the configuration space: the exact values of joint 2 that are forbidden at one value of joint 1.

use cplan_geometry::{Hits, merge_in_place};
use cplan_interrupt::checkpoint;
use cplan_model::{Contacts, Joint, on_axis};

/// A forbidden interval of one pair, within the axis's domain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForbiddenInterval {
    /// Number of the pair in [`cplan_model::Scene::pairs`].
    pub pair: usize,
    /// The closed interval of joint values.
    pub interval: [f64; 2],
}

/// The forbidden intervals of one slice, or of joint 1 for link 1. On a circle, an interval across the seam is split in two.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Slice {
    /// The intervals of each pair, in the order of the pairs.
    pub forbidden: Vec<ForbiddenInterval>,
    /// The union of all intervals, as disjoint, ascending intervals.
    pub merged: Vec<[f64; 2]>,
    scratch: Vec<[f64; 2]>,
    near: Vec<u32>,
}

impl Slice {
    /// Computes all values of joint 2, within the axis's domain, at which link 2 is within `grow` of an obstacle while joint 1
    /// is at `q1`. Ignores link 1. The result replaces the contents, and reuses their memory. `O(m log m)` for `m` contacts.
    pub fn compute(&mut self, contacts: &Contacts, q1: f64, grow: f64) {
        checkpoint();
        self.clear();
        let (elbow, heading) = contacts.elbow(q1);
        let joint = &contacts.scene().arm().joints[1];
        let mut near = std::mem::take(&mut self.near);
        for part in contacts.second_link_parts() {
            contacts.near(part, elbow, grow, &mut near);
            for &index in &near {
                self.scratch.clear();
                let index = index as usize;
                let hits = contacts.at_elbow(index, elbow, heading, grow, &mut self.scratch);
                self.forbid(joint, index, hits);
            }
        }
        self.near = near;
        self.merge();
    }

    /// Returns all values of joint 1, within the axis's domain, at which link 1 is within `grow` of an obstacle.
    pub fn bands(contacts: &Contacts, grow: f64) -> Self {
        let mut slice = Self::default();
        let joint = &contacts.scene().arm().joints[0];
        for index in 0..contacts.second_link_pairs().start {
            slice.scratch.clear();
            let hits = contacts.first_link(index, grow, &mut slice.scratch);
            slice.forbid(joint, index, hits);
        }
        slice.merge();
        slice
    }

    /// Adds the intervals of one pair from `scratch`.
    fn forbid(&mut self, joint: &Joint, pair: usize, hits: Hits) {
        let Self { forbidden, scratch, .. } = self;
        on_axis(joint, hits, scratch, |interval| forbidden.push(ForbiddenInterval { pair, interval }));
    }

    /// Returns true if the joint value is forbidden. `O(log n)`.
    pub fn forbids(&self, value: f64) -> bool {
        let after = self.merged.partition_point(|i| i[0] <= value);
        after > 0 && value <= self.merged[after - 1][1]
    }

    fn clear(&mut self) {
        self.forbidden.clear();
        self.merged.clear();
    }

    fn merge(&mut self) {
        self.merged.extend(self.forbidden.iter().map(|f| f.interval));
        merge_in_place(&mut self.merged);
    }
}
