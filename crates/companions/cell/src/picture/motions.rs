//! The motions that a picture shows: those of the answer, or else the fastest motion of each arm alone.

use super::Answer;
use crate::between::Between;
use crate::coordinate::Coordinator;
use crate::curve::Curve;
use crate::diagram::rectangles;
use crate::stage::StagePairs;
use crate::{Cell, HandoverTimes, Interlock, StepTimes};
use cplan_model::Outcome;
use cplan_model::space::Configuration;
use cplan_motion::{Drive, Trajectory, Wait};

/// Number of times at which the first collision is sought.
const COLLISION_TIMES: usize = 400;

/// Motions of both arms on one clock.
pub struct ShownMotions<'a> {
    pub trajectories: [&'a Trajectory; 2],
    curves: [Curve; 2],
    pub waits: [&'a [Wait]; 2],
    /// Time until both arms are at their goals, seconds.
    pub duration: f64,
    pub signals: &'a [Interlock],
    /// For each arm, its steps.
    pub steps: [&'a [StepTimes]; 2],
    pub handovers: &'a [HandoverTimes],
    /// For each arm, the times of rectangles in which the arms may be too near to each other.
    pub rectangles: Vec<[[f64; 2]; 2]>,
    /// True for the motions of the answer. False if they are those of each arm alone, which are not coordinated.
    pub are_certified: bool,
    /// The first time, seconds, at which the arms are too near to each other if both begin at 0.
    pub collides: Option<f64>,
}

impl<'a> ShownMotions<'a> {
    /// Returns the motions to show. `None` if an arm has none, even alone.
    pub fn of(answer: &Answer<'a>, pairs: &StagePairs) -> Option<Self> {
        let (trajectories, waits, signals) = if let Outcome::Found(found) = &answer.plan.outcome {
            let motions = found.motions.each_ref().map(|motion| &motion.trajectory);
            (motions, found.waits.each_ref().map(Vec::as_slice), found.interlocks.as_deref().unwrap_or_default())
        } else {
            let [one, two] = answer.plan.alone.each_ref().map(|alone| alone.as_ref()?.trajectory.as_ref());
            ([one?, two?], [&[][..]; 2], &[][..])
        };
        let curves = trajectories.map(|trajectory| Curve::of_legs([trajectory]));
        let duration = trajectories.map(Trajectory::duration).into_iter().fold(0.0, f64::max);
        let found = answer.plan.outcome.found();
        let rectangles = found.map_or_else(
            || {
                let coordinator = Coordinator { pairs, drive: Drive::default(), skew: answer.skew };
                let all = rectangles(pairs, curves.each_ref(), 0.0, coordinator.resolution());
                all.iter().map(|rectangle| rectangle.times).collect()
            },
            |found| found.diagram.clone(),
        );
        let steps = found.map_or([&[][..]; 2], |found| found.steps.each_ref().map(Vec::as_slice));
        let handovers = found.map_or(&[][..], |found| found.handovers.as_slice());
        let mut motions = Self {
            trajectories,
            curves,
            waits,
            duration,
            signals,
            steps,
            handovers,
            rectangles,
            are_certified: found.is_some(),
            collides: None,
        };
        motions.collides = (!motions.are_certified).then(|| motions.first_collision(pairs.between([0, 0]))).flatten();
        Some(motions)
    }

    /// Returns the configuration of an arm at a time on the clock.
    pub fn place(&self, arm: usize, time: f64) -> Configuration {
        self.curves[arm].at(time)
    }

    /// Returns the time for which an arm has moved until a time on the clock, without its waits.
    pub fn moved(&self, arm: usize, time: f64) -> f64 {
        let waited: f64 = self.waits[arm].iter().map(|wait| (time.min(wait.to) - wait.from).max(0.0)).sum();
        time.min(self.trajectories[arm].duration()) - waited
    }

    /// Returns the rectangles of the diagram on the axes of the moved times, by the arm that passes them first; those that neither
    /// passes first come last. Neighbours are merged.
    pub fn regions(&self) -> [Vec<[[f64; 2]; 2]>; 3] {
        let mut regions = [const { Vec::new() }; 3];
        for times in &self.rectangles {
            let [one, two] = *times;
            let first = match self.are_certified {
                true if one[1] <= two[0] => 0,
                true if two[1] <= one[0] => 1,
                _ => 2,
            };
            let sides = [0, 1].map(|arm| times[arm].map(|time| self.moved(arm, time)));
            if sides.iter().all(|[from, to]| to > from) {
                regions[first].push(sides);
            }
        }
        regions.map(|sides| merged(merged(sides, 0), 1))
    }

    /// Returns the first time at which the arms are too near to each other, and the parts that are nearest then.
    pub fn first_contact(&self, between: &Between) -> Option<(f64, [usize; 2])> {
        let time = self.collides?;
        let (_, pair) = met(between, [0, 1].map(|arm| self.place(arm, time)))?;
        Some((time, pair))
    }

    fn first_collision(&self, between: &Between) -> Option<f64> {
        let times = (0..=COLLISION_TIMES).map(|k| self.duration * k as f64 / COLLISION_TIMES as f64);
        times.into_iter().find(|time| is_too_near(between, [0, 1].map(|arm| self.place(arm, *time))))
    }
}

/// Returns true if the arms touch at these configurations, or are nearer than their clearance.
fn is_too_near(between: &Between, at: [Configuration; 2]) -> bool {
    met(between, at).is_some_and(|(distance, _)| distance <= 0.0 || distance < between.clearance)
}

/// Returns the distance of the arms, metres, and the nearest parts, one of each arm. `None` if no links can meet.
pub fn met(between: &Between, at: [Configuration; 2]) -> Option<(f64, [usize; 2])> {
    let placed = [0, 1].map(|arm| between.at_rest(arm, at[arm]));
    between.distance(placed.each_ref(), f64::INFINITY).here
}

/// Returns the pairs of links of a cell that can meet, without objects.
pub fn pairs_of_links(cell: &Cell) -> StagePairs<'_> {
    let scenes = cell.arms.each_ref().map(|arm| arm.problem.scene());
    StagePairs::single(Between::new(scenes, cell.is_one_robot, scenes[0].workspace().clearance))
}

/// Merges rectangles that are neighbours along an axis and have the same range along the other one.
fn merged(mut all: Vec<[[f64; 2]; 2]>, axis: usize) -> Vec<[[f64; 2]; 2]> {
    let across = 1 - axis;
    let key = |sides: &[[f64; 2]; 2]| [sides[across][0], sides[across][1], sides[axis][0]];
    all.sort_by(|a, b| key(a).iter().zip(key(b)).fold(std::cmp::Ordering::Equal, |o, (a, b)| o.then(a.total_cmp(&b))));
    let mut merged: Vec<[[f64; 2]; 2]> = Vec::new();
    for sides in all {
        match merged.last_mut() {
            Some(last) if last[across] == sides[across] && last[axis][1] == sides[axis][0] => {
                last[axis][1] = sides[axis][1];
            }
            _ => merged.push(sides),
        }
    }
    merged
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_merged_along_both_axes() {
        let cell = |x: f64, y: f64| [[x, x + 1.0], [y, y + 1.0]];
        let square = vec![cell(1.0, 1.0), cell(0.0, 0.0), cell(0.0, 1.0), cell(1.0, 0.0), cell(5.0, 0.0)];
        let all = merged(merged(square, 0), 1);
        assert_eq!(all, [[[0.0, 2.0], [0.0, 2.0]], [[5.0, 6.0], [0.0, 1.0]]]);
    }
}
