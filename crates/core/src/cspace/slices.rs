//! Slices of the configuration space: the values of joint 2 that are forbidden at one value of joint 1, exactly.

use crate::model::{Contacts, on_axis};
use cplan_geometry::merge_in_place;
use cplan_interrupt::checkpoint;

impl Contacts<'_> {
    /// Computes all values of joint 2, within the axis's domain, at which link 2 is within `grow` of an obstacle at
    /// `q1`. Link 1 is not considered. The result replaces the contents of `slice`, whose memory is reused.
    /// `O(m log m)` in the contacts.
    pub fn slice(&self, q1: f64, grow: f64, slice: &mut Slice) {
        checkpoint();
        slice.clear();
        let (elbow, heading) = self.elbow(q1);
        let joint = &self.scene().arm().joints[1];
        let mut near = std::mem::take(&mut slice.near);
        for part in self.second_link_parts() {
            self.near(part, elbow, grow, &mut near);
            for &index in &near {
                slice.scratch.clear();
                let index = index as usize;
                let hits = self.at_elbow(index, elbow, heading, grow, &mut slice.scratch);
                let Slice { forbidden, scratch, .. } = slice;
                on_axis(joint, hits, scratch, |interval| forbidden.push(ForbiddenInterval { pair: index, interval }));
            }
        }
        slice.near = near;
        slice.merge();
    }

    /// Computes all values of joint 1, within the axis's domain, at which link 1 is within `grow` of an obstacle.
    pub fn bands(&self, grow: f64) -> Slice {
        let mut slice = Slice::default();
        for index in 0..self.second_link_pairs().start {
            slice.scratch.clear();
            let hits = self.first_link(index, grow, &mut slice.scratch);
            let Slice { forbidden, scratch, .. } = &mut slice;
            let joint = &self.scene().arm().joints[0];
            on_axis(joint, hits, scratch, |interval| forbidden.push(ForbiddenInterval { pair: index, interval }));
        }
        slice.merge();
        slice
    }
}

/// A forbidden interval of one pair, within the axis's domain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForbiddenInterval {
    /// Number of the pair in [`crate::model::Scene::pairs`].
    pub pair: usize,
    /// The closed interval of joint values.
    pub interval: [f64; 2],
}

/// The forbidden intervals of one slice, or for link 1 of joint 1. On a circle, an interval across the seam is split
/// in two.
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
    /// Returns true if the joint value is forbidden. `O(log n)`.
    #[must_use]
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
