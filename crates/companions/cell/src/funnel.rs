//! Lower bounds on the time that both arms need: proofs that no motions of both arms end by a given time.
//!
//! Suppose that there were such motions. At each of some times, each joint would be in an interval: it begins and ends at
//! rest, and its acceleration and speed are limited (`reach`). These intervals of all four joints form a box for each pair of times
//! that the clocks may show at once. If the arms collide in a whole box, the motions do not exist. Otherwise the box that is nearest
//! to a proof is halved, and both halves must be refuted. Halving an interval at one time also narrows those at other times.

use crate::between::{Between, Swept, proven_hit};
use crate::reach::Reach;
use cplan_interrupt::checkpoint;
use cplan_judge::Deviation;
use cplan_model::Scene;
use cplan_model::space::{Configuration, JointRange};
use std::rc::Rc;

/// Greatest number of times.
const MAX_TIMES: usize = 24;

/// Least motion of the links in a box that is halved, as a share of the reach of the arms. Smaller boxes hardly lead to
/// a proof.
const LEAST_BOX: f64 = 0.003;

/// Cost of a box of one metre in whose middle the arms are apart. It exceeds that of boxes in whose middle they collide.
const APART_COST: f64 = 1e6;

/// Looks for proofs.
pub(crate) struct Funnels<'a> {
    between: &'a Between<'a>,
    /// Scenes for proofs of collisions.
    inner: [Scene; 2],
    skew: f64,
    /// Motion of the links per unit of each joint, metres.
    levers: [f64; 4],
    /// Number of boxes that may be examined.
    pub budget: usize,
}

/// Motions that are not refuted: for each joint its interval at each time.
#[derive(Clone)]
struct Motions {
    intervals: [Rc<Vec<[f64; 2]>>; 4],
    /// For each arm, the links at each time, as far as they were needed.
    swept: [Vec<Option<Rc<Swept>>>; 2],
    /// The times of both arms whose box was halved last.
    halved: [usize; 2],
}

impl<'a> Funnels<'a> {
    pub fn new(between: &'a Between<'a>, skew: f64, budget: usize) -> Self {
        let inner = between.scenes.map(|scene| scene.inner().into_owned());
        Self { between, inner, skew, levers: between.levers(), budget }
    }

    /// Returns true if it is proven that no motions from the starts to the goals end by this time. The goals are configurations up to whole turns.
    pub fn refute(&mut self, starts: [Configuration; 2], goals: [Configuration; 2], duration: f64) -> bool {
        let times =
            if self.skew > 0.0 { (duration / self.skew).ceil().min(MAX_TIMES as f64) as usize } else { MAX_TIMES };
        let times = times.max(4);
        let step = duration / times as f64;
        let reaches = self.reaches(starts, goals, duration);
        // Every combination of turns must be refuted.
        let mut choices: Vec<Vec<Reach>> = vec![vec![]];
        for of_joint in reaches {
            choices = choices
                .iter()
                .flat_map(|known| of_joint.iter().map(|reach| known.iter().cloned().chain([reach.clone()]).collect()))
                .collect();
        }
        choices.into_iter().all(|reaches| self.refute_funnel(&reaches, step, times))
    }

    /// Returns the possible displacements of each joint.
    fn reaches(&self, starts: [Configuration; 2], goals: [Configuration; 2], duration: f64) -> [Vec<Reach>; 4] {
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

    fn refute_funnel(&mut self, reaches: &[Reach], step: f64, times: usize) -> bool {
        let mut intervals = Vec::new();
        for reach in reaches {
            let mut own = vec![reach.range; times + 1];
            if !reach.narrow(&mut own, step) {
                return true;
            }
            intervals.push(Rc::new(own));
        }
        let Ok(intervals) = <[Rc<Vec<[f64; 2]>>; 4]>::try_from(intervals) else { return false };
        let swept = [vec![None; times + 1], vec![None; times + 1]];
        let mut open = vec![Motions { intervals, swept, halved: [times / 2; 2] }];
        let least = LEAST_BOX * self.between.scenes.map(|scene| scene.arm().reach()).into_iter().fold(0.0, f64::max);
        while let Some(mut motions) = open.pop() {
            checkpoint();
            if self.budget == 0 {
                return false;
            }
            self.budget -= 1;
            let Some([k, l]) = self.nearest_to_a_proof(&mut motions, step, times, least) else { continue };
            let at = [k, k, l, l];
            let motion = |joint: usize| self.motion(&motions, joint, at[joint]);
            let joint = (0..4).max_by(|a, b| motion(*a).total_cmp(&motion(*b))).unwrap_or(0);
            if motion(joint) < least {
                return false;
            }
            let [lower, upper] = motions.intervals[joint][at[joint]];
            let middle = f64::midpoint(lower, upper);
            for half in [[lower, middle], [middle, upper]] {
                let mut own = (*motions.intervals[joint]).clone();
                own[at[joint]] = half;
                if reaches[joint].narrow(&mut own, step) {
                    let mut next = motions.clone();
                    next.intervals[joint] = Rc::new(own);
                    next.swept[joint / 2] = vec![None; times + 1];
                    next.halved = [k, l];
                    open.push(next);
                }
            }
        }
        true
    }

    /// Returns the times of both arms whose box is nearest to a proof. `None` if a collision is proven.
    fn nearest_to_a_proof(&self, motions: &mut Motions, step: f64, times: usize, least: f64) -> Option<[usize; 2]> {
        // Rounding must not let a pair of times exceed the skew.
        let shift = ((self.skew * (1.0 - 1e-9) / step) as usize).min(times);
        let mut best = (f64::INFINITY, motions.halved);
        // A proof is likely near the box that was halved.
        let middle = motions.halved[0];
        let mut order: Vec<usize> = (1..=times).collect();
        order.sort_by_key(|k| k.abs_diff(middle));
        for k in order {
            let others = [k.saturating_sub(shift), (k + shift).min(times)];
            for l in others.into_iter().take(if shift > 0 { 2 } else { 1 }) {
                let motion = (0..4).map(|joint| self.motion(motions, joint, if joint < 2 { k } else { l }));
                let (total, greatest) = motion.fold((0.0, 0.0_f64), |(sum, most), x| (sum + x, most.max(x)));
                for (arm, time) in [(0, k), (1, l)] {
                    if motions.swept[arm][time].is_none() {
                        let joints = [0, 1].map(|joint| motions.intervals[2 * arm + joint][time]);
                        motions.swept[arm][time] = Some(Rc::new(self.swept(arm, joints)?));
                    }
                }
                let (Some(one), Some(two)) = (&motions.swept[0][k], &motions.swept[1][l]) else { continue };
                let share = self.between.motion_per_depth([one, two]);
                if share < 1.0 {
                    return None;
                }
                // If the arms are apart in the middle of all boxes, the largest box counts.
                let cost = if share.is_finite() { share } else { APART_COST / total.max(f64::MIN_POSITIVE) };
                if cost < best.0 && greatest >= least {
                    best = (cost, [k, l]);
                }
            }
        }
        Some(best.1)
    }

    /// Returns the motion of the links in the interval of a joint at a time, metres.
    fn motion(&self, motions: &Motions, joint: usize, time: usize) -> f64 {
        let [lower, upper] = motions.intervals[joint][time];
        self.levers[joint] * (upper - lower)
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
            let refute = |duration: f64| Funnels::new(&between, skew, 2000).refute(starts, goals, duration);
            if best.is_finite() {
                found += 1;
                for factor in [1.0, 1.000_01, 1.0001, 1.001, 1.01, 1.1, 1.5] {
                    assert!(!refute(factor * best), "seed {seed}: {factor} of {best} s");
                }
                let alone = starts.iter().zip(&goals).flat_map(|(from, to)| {
                    (0..2).map(move |k| {
                        let by = (to[k] - from[k]).abs();
                        if by * 4.0 <= 1.5 * 1.5 { 2.0 * (by / 4.0).sqrt() } else { by / 1.5 + 1.5 / 4.0 }
                    })
                });
                let alone = alone.fold(0.0, f64::max);
                raised += usize::from(best > 1.03 * alone && refute(1.01 * alone));
            }
        }
        if cplan_cases::uses_default_cases() {
            assert!(found >= 10 && raised >= 3, "{found} {raised}");
        }
    }
}
