//! Lower bounds on the time that both arms need: proofs that no motions of both arms end by a given time.
//!
//! Suppose that there were such motions. At each of some times, each joint would be in an interval: it begins and ends at
//! rest, and its acceleration and speed are limited (`reach`). These intervals of all four joints form a box for each pair of times
//! that the clocks may show at once. If the arms collide in a whole box, the motions do not exist. Otherwise the box that is nearest
//! to a proof is halved, and both halves must be refuted. Halving an interval at one time also narrows those at other times.
//!
//! The times are fixed shares of the duration. So the halves for one duration are also halves of all motions with a greater duration:
//! the next proof begins with the same halves.

use crate::between::{Between, Swept, proven_hit};
use crate::overlap::Overlap;
use crate::reach::{Reach, Tube};
use cplan_interrupt::checkpoint;
use cplan_judge::Deviation;
use cplan_model::Scene;
use cplan_model::space::{Configuration, JointRange};
use std::rc::Rc;

/// Least number of intervals between the times, and the greatest number that the skew may require.
const INTERVALS: [usize; 2] = [24, 64];

/// Least motion of the links in a box that is halved, as a share of the reach of the arms. Smaller boxes hardly lead to
/// a proof.
const LEAST_BOX: f64 = 0.003;

/// Cost of a box of one metre in whose middle the arms are apart. It exceeds that of boxes in whose middle they collide.
const APART_COST: f64 = 1e6;

/// Shares by which the duration is raised: the first one, and the least one. If a proof fails, the next share is half as large.
const DURATION_STEPS: [f64; 2] = [0.04, 0.005];

/// Share of its width by which an interval shrinks before its box is examined again.
const RENEWAL: f64 = 0.02;

/// Looks for proofs.
pub(crate) struct Funnels<'a> {
    between: &'a Between<'a>,
    /// Scenes for proofs of collisions.
    inner: [Scene; 2],
    /// Number of intervals between the times.
    count: usize,
    /// Pairs of times that the clocks may show at once.
    pairs: Vec<[usize; 2]>,
    /// Motion of the links per unit of each joint, metres.
    levers: [f64; 4],
    /// Least motion of the links in a box that is halved, metres.
    least: f64,
    /// The known duration that is too short, and the greatest one that matters, seconds.
    ends: [f64; 2],
    /// Number of boxes that may be examined.
    pub budget: usize,
}

/// A division of motions into halves.
#[derive(Clone)]
enum Division {
    /// The motions are not divided. States the pair of times whose box was halved or refuted last.
    Whole([usize; 2]),
    /// The value of a joint at a time is at most, or at least, the value in the middle.
    Halves { joint: usize, time: usize, middle: f64, halves: Box<[Division; 2]> },
}

/// Intervals of both joints of an arm, and its links in them.
type SweptBox = ([[f64; 2]; 2], Swept);

/// The boxes of motions with one duration.
#[derive(Clone)]
struct Boxes {
    tubes: [Rc<Tube>; 4],
    /// For each arm, the links at each time in these intervals, or in larger ones. `None` if they are not known.
    swept: [Vec<Option<Rc<SweptBox>>>; 2],
    /// For each pair of times, the overlap of the arms. `None` if it is not known.
    overlaps: Vec<Option<Overlap>>,
}

/// The result of an examination of boxes.
enum Verdict {
    /// The arms collide in a whole box.
    Refuted,
    /// The interval of this joint at this time is the next to be halved.
    Undecided { joint: usize, time: usize },
    /// All boxes are too small to be halved.
    TooSmall,
}

impl<'a> Funnels<'a> {
    /// Prepares proofs for durations between the one that is known to be too short, and the greatest one that matters, seconds.
    pub fn new(between: &'a Between<'a>, skew: f64, [known, greatest]: [f64; 2], budget: usize) -> Self {
        let inner = between.scenes.map(|scene| scene.inner().into_owned());
        let reach = between.scenes.map(|scene| scene.arm().reach()).into_iter().fold(0.0, f64::max);
        // The times of a pair differ by at most the skew, also for the greatest duration.
        let shift = (INTERVALS[0] as f64 * skew / greatest).ceil();
        let needed = (shift * greatest / skew * (1.0 + 1e-9)).ceil();
        let (count, shift) = match skew > 0.0 && needed <= INTERVALS[1] as f64 {
            true => (needed.max(4.0) as usize, shift as usize),
            false => (INTERVALS[0], 0),
        };
        let shifted = |k: usize| [[k, k.saturating_sub(shift)], [k, (k + shift).min(count)]];
        let mut pairs: Vec<[usize; 2]> = (0..=count).flat_map(shifted).collect();
        pairs.dedup();
        let ends = [known, greatest];
        Self { between, inner, count, pairs, levers: between.levers(), least: LEAST_BOX * reach, ends, budget }
    }

    /// Returns the greatest duration for which it is proven that no motions from the starts to one of the pairs of goals are
    /// as short. The goals are configurations up to whole turns.
    pub fn proven(&mut self, starts: [Configuration; 2], goals: impl IntoIterator<Item = [Configuration; 2]>) -> f64 {
        let [mut proven, greatest] = self.ends;
        let choices = goals.into_iter().flat_map(|goals| self.choices(starts, goals));
        let whole = Division::Whole([self.count / 2; 2]);
        let mut motions: Vec<(Vec<Reach>, Division)> = choices.map(|reaches| (reaches, whole.clone())).collect();
        let [mut step, least] = DURATION_STEPS;
        while proven < greatest && step >= least && self.budget > 0 {
            let duration = (proven.max(greatest / 8.0) * (1.0 + step)).min(greatest);
            // Motions that are hard to refute come first, because others are not needed if they fail.
            let failed = motions.iter_mut().position(|(reaches, division)| {
                let boxes = self.boxes(reaches, duration);
                boxes.is_some_and(|boxes| !self.refute(reaches, division, boxes))
            });
            match failed {
                None => proven = duration,
                Some(failed) => {
                    motions.swap(0, failed);
                    step /= 2.0;
                }
            }
        }
        proven
    }

    /// Divides motions until all parts are refuted. Returns false if it fails.
    fn refute(&mut self, reaches: &[Reach], division: &mut Division, mut boxes: Boxes) -> bool {
        checkpoint();
        if self.budget == 0 {
            return false;
        }
        self.budget -= 1;
        if let Division::Whole(at) = division {
            match self.verdict(&mut boxes, at) {
                Verdict::Refuted => return true,
                Verdict::TooSmall => return false,
                Verdict::Undecided { joint, time } => {
                    let [lower, upper] = boxes.tubes[joint].intervals[time];
                    let halves = Box::new([Division::Whole(*at), Division::Whole(*at)]);
                    *division = Division::Halves { joint, time, middle: f64::midpoint(lower, upper), halves };
                }
            }
        }
        let Division::Halves { joint, time, middle, halves } = division else { return false };
        let [lower, upper] = boxes.tubes[*joint].intervals[*time];
        let parts = [[lower, upper.min(*middle)], [lower.max(*middle), upper]];
        parts.into_iter().zip(halves.iter_mut()).all(|(half, division)| {
            let tube =
                if half[0] <= half[1] { reaches[*joint].halved(&boxes.tubes[*joint], *time, half) } else { None };
            tube.is_none_or(|tube| {
                let boxes = self.narrowed(&boxes, *joint, tube);
                self.refute(reaches, division, boxes)
            })
        })
    }

    /// Returns the possible displacements of the joints, for each combination of turns to the goals.
    fn choices(&self, starts: [Configuration; 2], goals: [Configuration; 2]) -> Vec<Vec<Reach>> {
        let mut choices: Vec<Vec<Reach>> = vec![vec![]];
        for of_joint in self.reaches(starts, goals) {
            choices = choices
                .iter()
                .flat_map(|known| of_joint.iter().map(|reach| known.iter().cloned().chain([reach.clone()]).collect()))
                .collect();
        }
        choices
    }

    /// Returns the possible displacements of each joint.
    fn reaches(&self, starts: [Configuration; 2], goals: [Configuration; 2]) -> [Vec<Reach>; 4] {
        let duration = self.ends[1];
        [0, 1, 2, 3].map(|k| {
            let (arm, joint) = (k / 2, k % 2);
            let own = &self.between.scenes[arm].arm().joints[joint];
            let (from, to) = (starts[arm][joint], goals[arm][joint]);
            let reach = |to: f64, range: [f64; 2]| Reach {
                ends: [from, to],
                velocity: own.velocity,
                acceleration: own.acceleration,
                range,
            };
            match own.range {
                JointRange::Interval { lower, upper } => vec![reach(to, [lower, upper])],
                JointRange::Circle => {
                    let turn = std::f64::consts::TAU;
                    let first = to - turn * ((to - from) / turn).round();
                    let most = (own.velocity * duration / turn).ceil() as i32 + 1;
                    let range = [f64::NEG_INFINITY, f64::INFINITY];
                    (-most..=most).map(|k| reach(first + turn * f64::from(k), range)).collect()
                }
            }
        })
    }

    /// Returns the boxes of all motions with a duration. `None` if there are no such motions.
    fn boxes(&self, reaches: &[Reach], duration: f64) -> Option<Boxes> {
        let whole = |reach: &Reach| vec![reach.range; self.count + 1];
        let tube = |reach: &Reach| reach.tube(whole(reach), duration / self.count as f64).map(Rc::new);
        let tubes: Vec<Rc<Tube>> = reaches.iter().map(tube).collect::<Option<_>>()?;
        let swept = [vec![None; self.count + 1], vec![None; self.count + 1]];
        Some(Boxes { tubes: tubes.try_into().ok()?, swept, overlaps: vec![None; self.pairs.len()] })
    }

    /// Returns boxes with narrower intervals of a joint.
    fn narrowed(&self, boxes: &Boxes, joint: usize, tube: Tube) -> Boxes {
        let mut next = boxes.clone();
        let arm = joint / 2;
        let mut is_changed = vec![false; self.count + 1];
        for (time, [lower, upper]) in tube.intervals.iter().enumerate() {
            let known = &mut next.swept[arm][time];
            if let Some((joints, _)) = known.as_deref()
                && upper - lower < (1.0 - RENEWAL) * (joints[joint % 2][1] - joints[joint % 2][0])
            {
                (*known, is_changed[time]) = (None, true);
            }
        }
        for (overlap, times) in next.overlaps.iter_mut().zip(&self.pairs) {
            if is_changed[times[arm]] {
                *overlap = None;
            }
        }
        next.tubes[joint] = Rc::new(tube);
        next
    }

    /// Examines the boxes, first those near the given pair of times. Replaces these times by those of the box that decides.
    fn verdict(&self, boxes: &mut Boxes, at: &mut [usize; 2]) -> Verdict {
        let mut best = (f64::INFINITY, Verdict::TooSmall, *at);
        // A proof is likely near the box that was halved.
        let mut order: Vec<usize> = (0..self.pairs.len()).collect();
        order.sort_by_key(|pair| (self.pairs[*pair][0].abs_diff(at[0]), self.pairs[*pair] != *at));
        for pair in order {
            let times = self.pairs[pair];
            let overlap = match boxes.overlaps[pair] {
                Some(overlap) => overlap,
                None => {
                    for (arm, time) in [0, 1].into_iter().zip(times) {
                        if boxes.swept[arm][time].is_none() {
                            let joints = [0, 1].map(|joint| boxes.tubes[2 * arm + joint].intervals[time]);
                            let Some(swept) = self.swept(arm, joints) else {
                                *at = times;
                                return Verdict::Refuted;
                            };
                            boxes.swept[arm][time] = Some(Rc::new((joints, swept)));
                        }
                    }
                    let (Some(one), Some(two)) = (&boxes.swept[0][times[0]], &boxes.swept[1][times[1]]) else {
                        continue;
                    };
                    let overlap = self.between.overlap([&one.1, &two.1]);
                    if overlap.share < 1.0 {
                        *at = times;
                        return Verdict::Refuted;
                    }
                    boxes.overlaps[pair] = Some(overlap);
                    overlap
                }
            };
            let width = |joint: usize| {
                let [lower, upper] = boxes.tubes[joint].intervals[times[joint / 2]];
                upper - lower
            };
            let motion = |joint: usize| self.levers[joint] * width(joint);
            let total: f64 = (0..4).map(motion).sum();
            let is_apart = overlap.share.is_infinite();
            // If the arms are apart in the middle of all boxes, the largest box counts.
            let cost = if is_apart { APART_COST / total.max(f64::MIN_POSITIVE) } else { overlap.share };
            if cost < best.0 && (0..4).any(|joint| motion(joint) >= self.least) {
                let part = |joint: usize| match is_apart {
                    true => motion(joint),
                    // The first order, and the bend.
                    false => {
                        overlap.rates[joint / 2][joint % 2].abs() * width(joint) + motion(joint) * width(joint) / 4.0
                    }
                };
                let joint = (0..4).max_by(|a, b| part(*a).total_cmp(&part(*b))).unwrap_or(0);
                best = (cost, Verdict::Undecided { joint, time: times[joint / 2] }, times);
            }
        }
        *at = best.2;
        best.1
    }

    /// Returns the links of an arm in a box of its joints. `None` if it is proven to collide with an obstacle in the whole box.
    fn swept(&self, arm: usize, joints: [[f64; 2]; 2]) -> Option<Swept> {
        let middle = joints.map(|[from, to]| f64::midpoint(from, to));
        let half = joints.map(|[from, to]| (to - from) / 2.0 + 8.0 * f64::EPSILON * from.abs().max(to.abs()));
        let (middle, deviation) = (Configuration::from(middle), Deviation::Box(half));
        proven_hit(&self.inner[arm], middle, deviation).is_none().then(|| self.between.swept(arm, middle, deviation))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint_tree::joint_route;
    use crate::shaping::Shaping;
    use cplan_cases::dice::Dice;
    use cplan_geometry::{Convex, Point, Vector};
    use cplan_model::{Arm, Joint, Link, Workspace};
    use cplan_motion::{Drive, TimedMotion};

    const RADIUS: f64 = 0.22;

    /// Half of the side of the square in which the centres of discs are.
    const SIDE: f64 = 0.6;

    /// Returns a disc that slides in a square.
    fn sliding_disc() -> Scene {
        let joints = [Joint::sliding("x", Vector::x(), -SIDE, SIDE), Joint::sliding("y", Vector::y(), -SIDE, SIDE)];
        let disc = Convex::disc(Point::zeros(), RADIUS).unwrap();
        let joints = joints.map(|joint| joint.at_most(1.5, 4.0));
        Scene::new(Arm::new(joints, [Link::of("x", []), Link::of("y", [disc])], [0.0, 0.0]), Workspace::new([]))
            .unwrap()
    }

    /// Returns the least distance of both discs if one clock is ahead of the other.
    fn least_distance(motions: &[TimedMotion; 2], skew: f64) -> f64 {
        let end = motions[0].trajectory.duration();
        let place =
            |arm: usize, time: f64| crate::curve::Curve::of_legs([&motions[arm].trajectory]).at(time.clamp(0.0, end));
        let times = (0..=600).map(|k| end * f64::from(k) / 600.0);
        let distances =
            times.flat_map(|time| [-skew, 0.0, skew].map(|shift| (place(0, time) - place(1, time + shift)).norm()));
        distances.fold(f64::INFINITY, f64::min) - 2.0 * RADIUS
    }

    #[test]
    fn bounds_are_below_the_duration_of_motions() {
        let (mut found, mut raised) = (0, 0);
        for seed in cplan_cases::seeds(20) {
            let mut dice = Dice::new(seed);
            let scene = sliding_disc();
            let between = Between::new([&scene, &scene], false, 0.0);
            let skew = [0.0, 0.1][dice.below(2_usize)];
            // One moves from left to right, and the other up.
            let mut place = |along: f64| [along * dice.within(0.4, SIDE), dice.within(-0.1, 0.1)];
            let [a, b, c, d] = [place(-1.0), place(1.0), place(-1.0), place(1.0)];
            let (starts, goals) =
                ([a, [c[1], c[0]]].map(Configuration::from), [b, [d[1], d[0]]].map(Configuration::from));
            let mut shaping = Shaping::new(&between, Drive::default(), skew).unwrap();
            let mut best = f64::INFINITY;
            for route in (0..8).filter_map(|seed| joint_route(&between, starts, goals, seed, 0)) {
                let Some(motions) = shaping.along(&route, best).and_then(|shape| shaping.certified(&shape)) else {
                    continue;
                };
                if least_distance(&motions, skew) > 0.0 {
                    best = motions[0].trajectory.duration();
                }
            }
            if best.is_finite() {
                found += 1;
                let alone = starts.iter().zip(&goals).flat_map(|(from, to)| {
                    (0..2).map(move |k| {
                        let by = (to[k] - from[k]).abs();
                        if by * 4.0 <= 1.5 * 1.5 { 2.0 * (by / 4.0).sqrt() } else { by / 1.5 + 1.5 / 4.0 }
                    })
                });
                let alone = alone.fold(0.0, f64::max);
                let bound = Funnels::new(&between, skew, [alone, 1.5 * best], 2000).proven(starts, [goals]);
                assert!(bound < best, "seed {seed}: {bound} of {best} s");
                for factor in [1.0, 1.0001, 1.01, 1.5] {
                    let ends = [0.999 * factor * best, factor * best];
                    let bound = Funnels::new(&between, skew, ends, 300).proven(starts, [goals]);
                    assert!(bound < ends[1], "seed {seed}: {factor} of {best} s");
                }
                raised += usize::from(best > 1.03 * alone && bound > 1.01 * alone);
            }
        }
        if cplan_cases::uses_default_cases() {
            assert!(found >= 10 && raised >= 3, "{found} {raised}");
        }
    }
}
