//! Possible next steps among moving obstacles, and their times.

use super::super::least_time::least_time;
use super::super::refusal::Refusal;
use super::super::state::{Candidate, State};
use super::passing::{Passage, passages};
use cplan_geometry::Interval;
use cplan_handling::{Action, ObstacleTrajectory, Step, Task, TimedScene};
use cplan_judge::Posture;
use cplan_model::Scene;
use cplan_model::space::Configuration;
use cplan_motion::{MIN_INTERVAL, nanoseconds, nearest_within, round_down, round_up, seconds};
use cplan_movers::MovingObstacles;

/// Largest number of intervals of arrival for each IK solution.
const MAX_ARRIVALS: usize = 3;

/// Least time between the latest arrival of the arm and the moment of a pick for which it waits, in seconds. Shorter
/// waits cannot be represented in a trajectory.
const MIN_WAIT: f64 = 2.0 * MIN_INTERVAL;

/// A candidate for the next step, with times from the beginning of the task in seconds.
#[derive(Debug, Clone)]
pub(super) struct TimedCandidate<'a> {
    pub candidate: Candidate<'a>,
    /// Interval within which the motion may arrive.
    pub arrival: Interval,
    /// The moment at which the object is picked. `None` if the object is at rest at that time, or if the step is no
    /// pick.
    pub moment: Option<Moment>,
    /// Index of the candidate.
    pub branch: usize,
    /// Lower bound on the end of the step, in seconds.
    pub ends: f64,
}

/// The moment at which a passing object is picked.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment {
    pub time: f64,
    /// Start of the time in which a pick may be possible as well, unless obstacles prevent it.
    pub since: f64,
}

/// The reason why a step cannot be done, with one IK solution or with any.
pub(super) struct Reason<'a> {
    pub step: &'a Step,
    pub to: Option<Configuration>,
    pub refusal: Refusal,
}

/// Candidates for the next step, and the reasons why other steps cannot be done.
#[derive(Default)]
pub(super) struct Choices<'a> {
    pub ways: Vec<TimedCandidate<'a>>,
    pub refused: Vec<Reason<'a>>,
}

/// A state and the time at which it is reached.
#[derive(Clone, Copy)]
pub(super) struct TimedState<'a, 's> {
    pub task: &'a Task,
    pub state: &'s State,
    pub time: f64,
}

impl<'a> TimedState<'a, '_> {
    /// Returns the scene during the motion of a step, with trajectories of its loose obstacles. Their times count from
    /// the beginning of the motion.
    pub fn scene(&self, step: &Step) -> (Scene, Vec<ObstacleTrajectory>) {
        let scene = self.state.scene(self.task, step.action.picked());
        (scene, self.task.trajectories_since(&self.state.moving, self.time))
    }

    /// Returns the scene while the arm stands at the end of a candidate's step, with trajectories of its loose
    /// obstacles. Their times count from `time`.
    pub fn scene_at_rest(&self, candidate: &Candidate, time: f64) -> (Scene, Vec<ObstacleTrajectory>) {
        let left = self.state.after_step(self.task, candidate, candidate.to);
        (left.scene(self.task, self.state.released), self.task.trajectories_since(&left.moving, time))
    }

    fn movers<'m>(&self, scene: &'m Scene, trajectories: &'m [ObstacleTrajectory]) -> MovingObstacles<'m> {
        MovingObstacles::new(TimedScene { scene, trajectories }, self.task.workspace.fixed.clearance)
    }

    /// Returns all candidates for the next step.
    pub fn choices(&self) -> Choices<'a> {
        let mut choices = Choices::default();
        for candidates in self.state.candidates(self.task) {
            let step = candidates.step;
            let (scene, trajectories) = self.scene(step);
            let movers = self.movers(&scene, &trajectories);
            let (mut ways, mut refused) = (Vec::new(), Vec::new());
            match &step.action {
                Action::Pick { object, grasp, when, .. } if self.state.moving.contains(object) => {
                    let passed = |from| passages(&self.task.arm, &self.task.objects[*object], *grasp, when, from);
                    self.pick(&movers, step, *object, &passed(self.time), &mut ways);
                    let reason = || self.explain_missed_pick(step, *object, passed);
                    refused.extend(ways.is_empty().then(|| (None, reason())));
                }
                _ if candidates.ways.is_empty() => {
                    let reason = "no IK solution within the joint limits reaches its target";
                    refused.push((None, Refusal::new(reason, candidates.all)));
                }
                _ => {
                    for candidate in &candidates.ways {
                        let before = ways.len();
                        self.arrivals(&movers, candidate, [0.0, f64::INFINITY], &mut ways);
                        let reason = "whenever the arm could arrive, a moving obstacle or object is there, or comes while the arm rests";
                        let is_barred = ways.len() == before;
                        refused.extend(is_barred.then(|| (Some(candidate.to), Refusal::new(reason, false))));
                    }
                }
            }
            choices.ways.append(&mut ways);
            choices.refused.extend(refused.into_iter().map(|(to, refusal)| Reason { step, to, refusal }));
        }
        choices
    }

    /// Returns the same pick at another moment, with the IK solution nearest to that of `choice`.
    pub fn at_moment(&self, choice: &TimedCandidate<'a>, moment: Moment) -> Option<TimedCandidate<'a>> {
        let object = choice.candidate.step.action.picked()?;
        let (scene, trajectories) = self.scene(choice.candidate.step);
        let movers = self.movers(&scene, &trajectories);
        let ways = self.passing(&movers, choice.candidate.step, object, moment);
        let far = |other: &TimedCandidate| self.task.arm.topology().distance(other.candidate.to, choice.candidate.to);
        ways.into_iter().min_by(|a, b| far(a).total_cmp(&far(b)))
    }

    /// Adds the candidates for picking a moving object, at several moments of each passage.
    fn pick(
        &self,
        movers: &MovingObstacles,
        step: &'a Step,
        object: usize,
        passages: &[Passage],
        ways: &mut Vec<TimedCandidate<'a>>,
    ) {
        for passage in passages {
            let [mut since, _] = passage.times;
            for time in passage.moments() {
                if passage.is_still {
                    for candidate in self.candidates(step, object, time) {
                        self.arrivals(movers, &candidate, passage.times, ways);
                    }
                    continue;
                }
                // Times are whole nanoseconds. The one nearest to the beginning of the interval may lie before it.
                let [begins, ends] = passage.times;
                let instant = || (begins == ends).then(|| seconds(nanoseconds(time)));
                let Some(time) = nearest_within(time, passage.times).or_else(instant) else { continue };
                let moment = Moment { time, since };
                ways.extend(self.passing(movers, step, object, moment));
                since = moment.time;
            }
        }
    }

    /// Returns the candidates for a pick at a given time.
    fn candidates(&self, step: &Step, object: usize, time: f64) -> Vec<Candidate<'a>> {
        let stopped = self.state.at_pick(self.task, object, time);
        let same = |other: &Step| (other.number, other.cycle) == (step.number, step.cycle);
        let all = stopped.candidates(self.task).into_iter().filter(|candidates| same(candidates.step));
        all.flat_map(|candidates| candidates.ways).collect()
    }

    /// Returns the candidates for picking a passing object at a moment. The arm arrives before that moment and waits
    /// for the object.
    fn passing(&self, movers: &MovingObstacles, step: &Step, object: usize, moment: Moment) -> Vec<TimedCandidate<'a>> {
        let choice = |(branch, candidate): (usize, Candidate<'a>)| {
            let [safe, stays] = self.safe(movers, &candidate);
            let stays_until = moment.time + step.dwell;
            let before = safe.into_iter().find(|[from, to]| *from <= moment.time && moment.time <= *to)?;
            stays.into_iter().find(|[from, to]| *from <= moment.time && stays_until <= *to)?;
            let arrival = [round_up(before[0]), moment.time - MIN_WAIT];
            let is_in_time = arrival[0].max(self.arrival_bound(&candidate)) <= arrival[1];
            // The bound takes into account that an earlier moment may be found.
            let ends = moment.since + step.dwell;
            is_in_time.then_some(TimedCandidate { candidate, arrival, moment: Some(moment), branch, ends })
        };
        self.candidates(step, object, moment.time).into_iter().enumerate().filter_map(choice).collect()
    }

    /// Adds the candidates that arrive at a target within an interval and stay there as long as the step requires. The
    /// intervals of arrival begin and end at whole nanoseconds.
    fn arrivals(
        &self,
        movers: &MovingObstacles,
        candidate: &Candidate<'a>,
        within: Interval,
        ways: &mut Vec<TimedCandidate<'a>>,
    ) {
        let [safe, stays] = self.safe(movers, candidate);
        let (dwell, soonest) = (candidate.step.dwell, self.arrival_bound(candidate));
        let both = |a: &Interval| {
            let within = [a[0].max(within[0]), a[1].min(within[1])];
            let common = |b: &Interval| [round_up(within[0].max(b[0])), round_down(within[1].min(b[1] - dwell))];
            stays.iter().map(common).collect::<Vec<_>>()
        };
        let arrivals = safe.iter().flat_map(both).filter(|[from, to]| from.max(soonest) <= *to).take(MAX_ARRIVALS);
        ways.extend(arrivals.map(|arrival| {
            let ends = arrival[0].max(soonest) + dwell;
            TimedCandidate { candidate: *candidate, arrival, moment: None, branch: 0, ends }
        }));
    }

    /// Returns a lower bound on the time at which the arm can be at a candidate's target.
    fn arrival_bound(&self, candidate: &Candidate) -> f64 {
        self.time + least_time(&self.task.arm, self.state.q, candidate.to, candidate.step.speed)
    }

    /// Returns the times at which no moving obstacle comes too near to the arm at a candidate's target: first before
    /// the step's event, then after it.
    fn safe(&self, movers: &MovingObstacles, candidate: &Candidate) -> [Vec<Interval>; 2] {
        let (after, trajectories) = self.scene_at_rest(candidate, self.time);
        let then = self.movers(&after, &trajectories);
        [movers, &then].map(|movers| {
            let mut safe = movers.safe_intervals(&Posture::new(movers.scene(), candidate.to));
            safe.iter_mut().flatten().for_each(|time| *time += self.time);
            safe
        })
    }

    /// Explains why a moving object cannot be picked any more. `passed` returns the object's passages after a time.
    fn explain_missed_pick(&self, step: &Step, object: usize, passed: impl Fn(f64) -> Vec<Passage>) -> Refusal {
        let name = &self.task.objects[object].name;
        let (all, left) = (passed(0.0), passed(self.time));
        let is_reached = |passage: &Passage| {
            passage.moments().into_iter().any(|time| !self.candidates(step, object, time).is_empty())
        };
        let begins = format!("the step begins at {:.3} s", self.time);
        let reason = if !all.iter().any(is_reached) {
            format!("no IK solution within the joint limits reaches \"{name}\" along its path")
        } else if !left.iter().any(is_reached) {
            format!("\"{name}\" has passed: {begins}")
        } else {
            format!(
                "\"{name}\" has passed when the arm can arrive, or another moving obstacle or object is there: {begins}"
            )
        };
        Refusal::new(reason, false)
    }
}
