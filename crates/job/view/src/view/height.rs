//! The strips of the tool's height and of the wrist's turns against time.

use super::numbers::{Chain, number};
use crate::{Object, object};
use cplan_handling::Task;
use cplan_legs::{Event, Leg, TimedTurn};
use cplan_model::space::Configuration;
use cplan_motion::recorded::{turn_angle, turn_profile};
use cplan_motion::{phase_at, single};
use serde::Serialize;

/// Number of straight lines that approximate a phase of constant jerk.
const LINES_PER_PHASE: u32 = 8;

/// Returns times that divide each phase of constant jerk into equal parts, each with the two ends of its phase. Includes the
/// beginning of a phase if `first` is 0, but not if it is 1.
fn divided(phases: &[[f64; 3]], first: u32) -> impl Iterator<Item = (f64, [[f64; 3]; 2])> {
    phases.windows(2).flat_map(move |phase| {
        let ends @ [[since, ..], [until, ..]] = [phase[0], phase[1]];
        let time = move |line| since + (until - since) * f64::from(line) / f64::from(LINES_PER_PHASE);
        (first..=LINES_PER_PHASE).map(move |line| (time(line), ends))
    })
}

/// Returns the height of the tool against time, for pages: the name of the joint that lowers it, and its values in
/// millimetres. `None` if the tool is never lowered.
pub fn height(task: &Task, legs: &[Leg]) -> Option<Object> {
    let tool = task.stroke.as_ref()?;
    let duration = legs.last()?.end();
    let mut corners = vec![[0.0, tool.lowered(task.start_tool.depth)]];
    for (begin, [from, to]) in legs.iter().flat_map(Leg::strokes) {
        corners.push([begin, from]);
        let phases = single((to - from).abs(), &tool.limits());
        let value = |(time, ends)| [begin + time, from + (to - from).signum() * phase_at(ends, time)[0]];
        corners.extend(divided(&phases, 1).map(value));
    }
    let last = corners.last().map_or(tool.joint.rest, |[_, value]| *value);
    corners.push([duration, last]);
    let rounded = |[time, value]: [f64; 2]| Configuration::new((time * 1e4).round() / 1e4, (value * 1e6).round() / 1e3);
    let motion = Chain(corners.into_iter().map(rounded).collect());
    (motion.0.len() > 2).then(|| object!("joint": tool.joint.name, "duration": number(duration), "motion": motion))
}

/// The turns of the wrist against time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TurnsView {
    /// Duration of the task, in seconds.
    pub duration: f64,
    /// Times in seconds, and angles in degrees by which the carried object has turned since its pick.
    pub motion: Chain,
    /// For each turn, times in seconds and orientations of the object in radians. During a turn, they replace the orientation in
    /// the world.
    pub turns: Vec<Chain>,
    /// True if the gripper is empty. Then angles are values of the wrist's joint.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub is_empty: bool,
}

impl TurnsView {
    /// Creates the strip of a task. `None` if the wrist never turns.
    pub fn of_task(task: &Task, legs: &[Leg]) -> Option<Self> {
        let duration = legs.last()?.end();
        if let Some(strip) = Self::of_empty_gripper(task, legs, duration) {
            return Some(strip);
        }
        let all = TimedTurn::all(task, legs);
        let (mut motion, mut turns) = (vec![[0.0, 0.0]], Vec::new());
        for turn in &all {
            let mut corners = vec![[turn.span[0], turn.ends[0]]];
            let times = divided(&turn.phases, 0).map(|(since, _)| turn.begin + since);
            corners.extend(times.map(|time| [time, turn.angle(time)]));
            corners.push([turn.span[1], turn.ends[1]]);
            let released = legs.iter().find_map(|leg| {
                let places = matches!(leg.event, Some(Event::Release { object, .. }) if object == turn.object);
                leg.event_time().filter(|time| places && *time >= turn.begin)
            });
            motion.extend(corners.iter().map(|[time, angle]| [*time, (angle - turn.ends[0]).to_degrees()]));
            let end = released.unwrap_or(duration);
            motion.extend([[end, (turn.ends[1] - turn.ends[0]).to_degrees()], [end, 0.0]]);
            turns.push(rounded(&corners, 1e4));
        }
        motion.push([duration, 0.0]);
        let motion = rounded(&motion, 1e2);
        (!all.is_empty()).then(|| Self { duration: number(duration), motion, turns, is_empty: false })
    }

    /// Creates the strip of a turn of the empty gripper to a value of the wrist's joint. `None` if there is no such turn.
    fn of_empty_gripper(task: &Task, legs: &[Leg], duration: f64) -> Option<Self> {
        let turn = legs.iter().find_map(|leg| leg.wrist).filter(|turn| turn.angle != 0.0)?;
        let (from, wrist) = (task.start_tool.wrist?, task.wrist?);
        let phases = turn_profile(&wrist, turn.angle.abs(), turn.seconds);
        let mut corners = vec![[0.0, from]];
        let angle = |since: f64| turn_angle(&phases, [from, from + turn.angle], since);
        corners.extend(divided(&phases, 0).map(|(since, _)| [turn.begin + since, angle(since)]));
        corners.push([duration, from + turn.angle]);
        let degrees: Vec<[f64; 2]> = corners.iter().map(|[time, angle]| [*time, angle.to_degrees()]).collect();
        let motion = rounded(&degrees, 1e2);
        Some(Self { duration: number(duration), motion, turns: Vec::new(), is_empty: true })
    }
}

impl TurnsView {
    /// Returns the orientation of the carried object during a turn, in radians, interpolated linearly between two corners. `None`
    /// at other times.
    pub fn angle_at(&self, time: f64) -> Option<f64> {
        let lasts = |turn: &&Chain| turn.0[0][0] <= time && time <= turn.0[turn.0.len() - 1][0];
        let Chain(corners) = self.turns.iter().find(lasts)?;
        let next = corners.partition_point(|corner| corner[0] <= time).clamp(1, corners.len() - 1);
        let [from, to] = [corners[next - 1], corners[next]];
        let share = ((time - from[0]) / (to[0] - from[0]).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        Some(from[1] + (to[1] - from[1]) * share)
    }
}

/// Rounds times to a tenth of a millisecond, and values to multiples of `1 / steps`.
fn rounded(corners: &[[f64; 2]], steps: f64) -> Chain {
    let round =
        |[time, value]: &[f64; 2]| Configuration::new((time * 1e4).round() / 1e4, (value * steps).round() / steps);
    Chain(corners.iter().map(round).collect())
}
