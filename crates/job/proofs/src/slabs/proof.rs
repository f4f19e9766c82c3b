//! Creates proofs by collision boxes from slabs without a connection.

use super::{LEVEL_TOLERANCE, Slab, Slabs, Span, half_of_level, index};
use crate::chain::{Mosaic, ends};
use crate::tiles::{SlabCollision, add_boxes};
use cplan_geometry::merge_in_place;
use cplan_interrupt::checkpoint;
use cplan_judge::{CollisionBox, Disconnection};
use cplan_model::space::{Configuration, GoalSet, Segment};

impl Slabs<'_> {
    /// Returns for each span whether free and undecided spans connect it with any of the places.
    fn reachable_spans(&self, places: &GoalSet) -> Vec<bool> {
        let mut reached = vec![false; self.spans.len()];
        let mut waiting: Vec<u32> = ends(self, places).into_iter().map(|end| end.0).collect();
        waiting.iter().for_each(|&index| reached[index as usize] = true);
        while let Some(index) = waiting.pop() {
            self.for_each_neighbor(index, |next| {
                if !std::mem::replace(&mut reached[next as usize], true) {
                    waiting.push(next);
                }
            });
        }
        reached
    }

    /// Returns the proof that start and goals are not connected, given that spans that may be free do not connect them. It has
    /// the collision boxes around the region that is reachable from the start, or from the goals, whichever are fewer. Returns
    /// `None` if there are more than `most` boxes, or if the check of a proof would refuse one.
    pub(super) fn disconnection(
        &mut self,
        start: Configuration,
        goals: &GoalSet,
        most: usize,
    ) -> Option<Disconnection> {
        let here = self.collision_boxes_around(&start.into(), most);
        let there = self.collision_boxes_around(goals, most);
        let boxes = match (here, there) {
            (Some(a), Some(b)) => Some(if b.len() < a.len() { b } else { a }),
            (a, b) => a.or(b),
        };
        boxes.map(Disconnection::new)
    }

    /// Returns the collision boxes beside the region that is reachable from the places, and those that contain places. `None` if
    /// there are more than `most` boxes, or if the check of a proof would refuse one.
    fn collision_boxes_around(&mut self, places: &GoalSet, most: usize) -> Option<Vec<CollisionBox>> {
        let reached = self.reachable_spans(places);
        let places: Vec<Segment> = places.wrapped(&self.topology).collect();
        let mut boxes = Vec::new();
        let mut stuck: Vec<SlabCollision> = Vec::new();
        let scene = self.second.contacts().scene();
        let (bottom, top) = self.topology.ranges[1].domain();
        for number in 0..index(self.slabs.len()) {
            checkpoint();
            let slab = self.slabs[number as usize];
            let own: Vec<u32> = self.spans_of(number).filter(|&s| reached[s as usize]).collect();
            let beside: Vec<u32> =
                self.neighbors(number).flat_map(|b| self.spans_of(b)).filter(|&s| reached[s as usize]).collect();
            let holds_places =
                |[lower, upper]: [f64; 2]| places.iter().any(|piece| piece.meets([slab.from, lower], [slab.to, upper]));
            let axis = self.topology.ranges[1];
            if own.is_empty() && beside.is_empty() && !holds_places([bottom, top]) {
                continue;
            }
            if let Some(wall) = slab.wall {
                boxes.push(self.walls[wall as usize].clone());
                continue;
            }
            if !slab.judged {
                continue;
            }
            self.judge_again(number);
            let mut merged: Vec<[f64; 2]> = self.verdicts.inner.iter().map(|i| i.1).collect();
            merge_in_place(&mut merged);
            let span = |s: &u32| self.spans[*s as usize];
            let touches = |&[lower, upper]: &[f64; 2]| {
                let across_seam = |s: Span| {
                    axis.is_circle() && (s.lower == bottom && upper == top || s.upper == top && lower == bottom)
                };
                own.iter().map(span).any(|s| s.lower <= upper && lower <= s.upper || across_seam(s))
                    || beside.iter().map(span).any(|s| s.lower < upper && lower < s.upper)
                    || holds_places([lower, upper])
            };
            merged.retain(touches);
            let needed = |[lower, upper]: [f64; 2]| merged.iter().any(|m| m[0] <= lower && upper <= m[1]);
            let by = self.verdicts.inner.iter().filter(|(_, interval)| needed(*interval));
            let by = by.map(|&(pair, interval)| (scene.pairs()[pair], interval)).collect();
            stuck.push(SlabCollision { from: slab.from, to: slab.to, by });
        }
        let side_by_side = |a: &SlabCollision, b: &SlabCollision| a.to == b.from;
        let mut runs = stuck.chunk_by(side_by_side);
        runs.all(|run| add_boxes(scene, self.second.clearance(), run, [bottom, top], most, &mut boxes)).then_some(boxes)
    }

    /// Computes the colliding intervals of a slab again.
    fn judge_again(&mut self, number: u32) {
        let Slab { from, to, level, .. } = self.slabs[number as usize];
        let half = half_of_level(&self.topology, level) * (1.0 + 2.0 * LEVEL_TOLERANCE);
        self.second.judge(from, to, level, half, &mut self.verdicts);
    }
}
