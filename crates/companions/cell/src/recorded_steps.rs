//! The judgement of two recorded sequences of steps, on one clock.
//!
//! The steps of each arm are replayed from its motion ([`cplan_recordings::replay()`]). The replay states where the arm takes
//! and leaves objects, and which object it carries. These statements determine the bodies of both arms at all times.

use crate::Cell;
use crate::assignment::assigned_tasks;
use crate::curve::Curve;
use crate::recorded::{BetweenFinding, judged_between, with_rests};
use crate::schedule::{HandoverTimes, StepTimes, turn_span};
use crate::sequence::handed_over;
use crate::stage::{Stage, StagePairs};
use crate::step_stages::{StageBuilder, StepScene};
use cplan_geometry::Pose;
use cplan_handling::{Item, Recording, Task};
use cplan_judge::certify;
use cplan_legs::Event;
use cplan_model::Scene;
use cplan_model::space::Path;
use cplan_motion::MIN_INTERVAL;
use cplan_recordings::{Judgement, MotionFindings, PLACE_TOLERANCE, ReplayedStep, TIME_TOLERANCE, replay, verify_task};
use cplan_robot::InputError;
use cplan_world::{LoadedRecording, Overrides};

/// Difference of two times, seconds, below which they are one sample.
const SAME_TIME: f64 = 1e-9;

/// The times of a recorded step that the motion of the arm does not show, seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolTimes {
    /// The beginning of the stroke with which the tool is raised before the motion. `None` if there is no such stroke.
    pub raising: Option<f64>,
    /// The end of the step: the tool is raised, and the dwell is over.
    pub end: f64,
}

/// The judged steps of both arms.
#[derive(Debug, Clone)]
pub struct JudgedSteps {
    /// The findings about each arm, among the obstacles and the objects that the other arm does not move.
    pub arms: [MotionFindings; 2],
    /// The finding between the arms. It is undecided if the steps of an arm are not those of the cell.
    pub between: BetweenFinding,
    /// The steps of each arm with their times, from the motions.
    pub steps: [Vec<StepTimes>; 2],
    /// The handovers, from the motions.
    pub handovers: Vec<HandoverTimes>,
    /// For each arm, the names of the shared objects that it moves. `None` if the cell has no shared objects.
    pub assignment: Option<[Vec<String>; 2]>,
    /// Differences from the steps of the cell that concern both arms, or the times of the tools.
    pub faults: Vec<String>,
    /// True if the files have all steps of the cell, in an allowed order, and the tools act while the arms rest.
    pub is_whole: bool,
}

/// Judges the recorded steps of both arms: each arm alone, the order of handovers, and both arms between each other. Both
/// clocks may differ by up to `skew` seconds. `tools` has the times of each recorded step. `None` if the cell has no steps.
///
/// # Errors
/// A robot that cannot be judged.
pub fn judge_steps(
    cell: &Cell,
    recorded: [&LoadedRecording; 2],
    tools: [&[ToolTimes]; 2],
    skew: f64,
) -> Result<Option<JudgedSteps>, InputError> {
    let [Some(one), Some(two)] = cell.arms.each_ref().map(|arm| arm.task.as_ref()) else { return Ok(None) };
    let arms = assignment(cell, [one, two], recorded);
    let tasks = assigned_tasks(cell, [one, two], &arms);
    let scenes = cell.arms.each_ref().map(|arm| arm.problem.scene());
    let findings = |arm: usize| -> Result<MotionFindings, InputError> {
        let task = (&tasks[arm], scenes[arm]);
        verify_task(&cell.arms[arm].loaded, task, recorded[arm], &Overrides::default())
    };
    let mut findings = [findings(0)?, findings(1)?];
    let mut faults = Vec::new();
    let lines = [0, 1].map(|arm| TimeLine::new(&tasks[arm], recorded[arm], tools[arm]));
    for (arm, line) in lines.iter().enumerate() {
        let name = &cell.arms[arm].name;
        faults.extend(line.faults.iter().map(|fault| format!("{name}, {fault}")));
        if !line.stands_free {
            findings[arm].verdict = findings[arm].verdict.max(Judgement::Undecided);
            findings[arm].faults.push("the arm without steps is not proven to stand free".into());
        }
    }
    let handovers = handovers(cell, tasks.each_ref(), &lines, &mut faults);
    for HandoverTimes { object, giver, placed, taken } in &handovers {
        if placed + skew > taken + TIME_TOLERANCE {
            let [gives, takes] = [*giver, 1 - giver].map(|arm| &cell.arms[arm].name);
            let clocks = if skew > 0.0 { format!(", and the clocks may differ by {skew} s") } else { String::new() };
            faults.push(format!(
                "handover of \"{object}\": {takes} takes it from {taken:.6} s on, but {gives} has placed it only at {placed:.6} s{clocks}"
            ));
        }
    }
    let is_whole = lines.iter().all(|line| line.is_whole);
    let between = match is_whole {
        true => {
            let stages = lines.each_ref().map(|line| &line.stages[..]);
            let clearance = scenes[0].workspace().clearance;
            let pairs = StagePairs::new(scenes, stages, cell.is_one_robot, clearance, Vec::new());
            let curves = with_rests([0, 1].map(|arm| lines[arm].curve(&recorded[arm].recording)), skew);
            let curves = [0, 1].map(|arm| lines[arm].divided(curves[arm].clone()));
            judged_between(cell, &pairs, &curves, skew)
        }
        false => BetweenFinding::Undecided,
    };
    let names = |arm: usize| {
        let own = cell.shared.iter().zip(&arms).filter(|(_, of)| **of == arm);
        own.map(|(name, _)| name.clone()).collect()
    };
    let assignment = (!cell.shared.is_empty()).then(|| [names(0), names(1)]);
    let steps = lines.map(|line| line.steps);
    Ok(Some(JudgedSteps { arms: findings, between, steps, handovers, assignment, faults, is_whole }))
}

/// Returns for each object that either arm may move the arm whose steps pick it. If none does, an arm that could.
fn assignment(cell: &Cell, tasks: [&Task; 2], recorded: [&LoadedRecording; 2]) -> Vec<usize> {
    let picks = |arm: usize, pair: usize| {
        let Some(Item::AnyOrder(pairs)) = tasks[arm].items.first() else { return false };
        let pick = cell.arms[arm].shared[pair].and_then(|number| pairs.get(number));
        let steps = recorded[arm].steps.iter().flatten();
        pick.is_some_and(|[pick, _]| steps.clone().any(|step| step.number == pick.number))
    };
    let arm = |pair: usize| {
        let can = || (0..2).find(|arm| cell.arms[*arm].shared[pair].is_some());
        (0..2).find(|arm| picks(*arm, pair)).or_else(can).unwrap_or(0)
    };
    (0..cell.shared.len()).map(arm).collect()
}

/// Returns the handovers that both arms have done. Adds a fault if the second arm does not take an object from where the first arm
/// has left it.
fn handovers(cell: &Cell, tasks: [&Task; 2], lines: &[TimeLine; 2], faults: &mut Vec<String>) -> Vec<HandoverTimes> {
    let mut found = Vec::new();
    for (giver, taker) in [(0, 1), (1, 0)] {
        for object in handed_over(tasks[giver]) {
            let at = |arm: usize, is_place: bool| {
                let mut handled = lines[arm].handled.iter();
                handled.find(|handled| handled.object == object && handled.pose.is_some() == is_place)
            };
            let Some((place, pick)) = at(giver, true).zip(at(taker, false)) else { continue };
            let name = tasks[giver].objects[object].name.clone();
            let off = place.pose.map(|pose| pose.inverse() * tasks[taker].objects[object].at);
            let is_off = |off: &Pose| off.translation.norm().max(off.rotation.angle().abs()) > PLACE_TOLERANCE;
            if let Some(off) = off.filter(is_off) {
                let [gives, takes] = [giver, taker].map(|arm| &cell.arms[arm].name);
                let (apart, turned) = (1e3 * off.translation.norm(), off.rotation.angle());
                faults.push(format!(
                    "handover of \"{name}\": {gives} leaves it {apart:.3} mm and {turned:.6} rad from the place from which {takes} takes it"
                ));
            }
            found.push(HandoverTimes { object: name, giver, placed: place.times[1], taken: pick.times[0] });
        }
    }
    found
}

/// A pick or a place in time.
struct Handled {
    object: usize,
    /// The beginning of the strokes, and the end of the step, seconds.
    times: [f64; 2],
    /// Pose of the object after its release.
    pose: Option<Pose>,
}

/// The steps of an arm in time, with its stages.
struct TimeLine {
    stages: Vec<Stage>,
    /// The time at which each stage begins, seconds. The first one begins before all motions.
    begins: Vec<f64>,
    steps: Vec<StepTimes>,
    handled: Vec<Handled>,
    faults: Vec<String>,
    /// True if all steps of the task are there, and if the tool acts while the arm rests.
    is_whole: bool,
    /// False for an arm without steps that is not proven to stand free.
    stands_free: bool,
}

impl TimeLine {
    fn new(task: &Task, LoadedRecording { recording, steps, .. }: &LoadedRecording, tools: &[ToolTimes]) -> Self {
        let recorded = steps.as_deref().unwrap_or_default();
        let mut replay = replay(task, recording, recorded);
        let replayed: Vec<ReplayedStep> = replay.by_ref().collect();
        let is_whole =
            replay.departure().is_none() && replayed.len() == recorded.len() && tools.len() == recorded.len();
        let mut line = Self {
            stages: vec![],
            begins: vec![],
            steps: vec![],
            handled: vec![],
            faults: vec![],
            is_whole,
            stands_free: true,
        };
        let mut builder = StageBuilder::new(task, replayed.iter().map(|step| step.step));
        if replayed.is_empty() {
            let scene = builder.stand();
            line.stands_free = stands_free(&scene, recording);
            line.begins.push(f64::NEG_INFINITY);
        }
        let clock = recording.times().map_or(0.0, |times| times[0]);
        let mut last_end = f64::NEG_INFINITY;
        for (number, (step, tool)) in replayed.iter().zip(tools).enumerate() {
            let scene = step_scene(recording, step);
            let [begin, arrival, next] = step.times.map(|time| clock + time);
            let rises = builder.raising(number, &scene);
            let raising = rises.zip(tool.raising).map(|(_, from)| from);
            if let Some(stage) = rises {
                let seconds = scene.depths[0].zip(task.stroke.as_ref());
                let seconds = seconds.map_or(0.0, |(depth, stroke)| stroke.limits().least_seconds(depth.abs()));
                let from = raising.unwrap_or(begin - seconds);
                let is_in_time =
                    last_end.max(clock) <= from + TIME_TOLERANCE && from + seconds <= begin + TIME_TOLERANCE;
                line.check(
                    is_in_time,
                    number,
                    &format!("the tool is raised at {from:.6} s, but the arm needs it lowered, or moves"),
                );
                line.begin(stage, from.max(last_end));
                last_end = from + seconds;
            }
            line.begin(builder.motion(number, &scene), last_end);
            let acts = (step.rest >= MIN_INTERVAL).then(|| builder.acts(number, &scene));
            let acting = if acts.is_some() { tool.end - step.rest } else { arrival };
            last_end = arrival;
            if let Some(stage) = acts {
                let is_in_time = arrival <= acting + TIME_TOLERANCE && tool.end <= next + TIME_TOLERANCE;
                let why = format!(
                    "the tool needs {:.6} s at rest and ends at {:.6} s, but the arm rests from {arrival:.6} s to {next:.6} s",
                    step.rest, tool.end
                );
                line.check(is_in_time, number, &why);
                line.begin(stage, acting.max(arrival));
                last_end = tool.end;
            }
            builder.end(number, &scene);
            let released = scene.event.and_then(|event| match event {
                Event::Release { pose, .. } => Some(pose),
                Event::Grasp { .. } => None,
            });
            if let Some(event) = scene.event {
                line.handled.push(Handled { object: event.object(), times: [acting, last_end], pose: released });
            }
            let event = step.event.as_ref().map(|event| acting + event.time - step.times[1]);
            line.steps.push(StepTimes {
                number: number + 1,
                file_step: step.step.number,
                cycle: step.step.cycle,
                action: step.step.action.describe(&task.objects),
                object: step.object.map(|object| task.objects[object].name.clone()),
                raising,
                begin,
                arrival,
                event,
                end: last_end,
                released,
                turn: step.recorded.turn,
                turn_span: step.recorded.turn.map(|turn| turn_span(turn, [acting, last_end], released.is_some())),
                lowered: step.recorded.lowered,
                wrist: step.recorded.wrist,
            });
        }
        if let Some(step) = replayed.last()
            && let Some(stage) = builder.rest_at_end(replayed.len(), &step_scene(recording, step))
        {
            line.begin(stage, last_end);
        }
        Self { stages: builder.stages, ..line }
    }

    /// Notes a fault of a step unless a condition holds.
    fn check(&mut self, holds: bool, number: usize, why: &str) {
        if !holds {
            self.faults.push(format!("step {}: {why}", number + 1));
            self.is_whole = false;
        }
    }

    /// Begins the next stage.
    fn begin(&mut self, stage: usize, at: f64) {
        debug_assert_eq!(stage, self.begins.len(), "stages begin in order");
        self.begins.push(at);
    }

    /// Returns the curve of the motion, with samples at the times at which stages begin.
    fn curve(&self, recording: &Recording) -> Curve {
        let Some(samples) = recording.times() else { return Curve::of_pieces(recording.pieces()) };
        let mut times = samples.to_vec();
        let last = times[times.len() - 1];
        for at in self.begins.iter().filter(|at| (samples[0]..=last).contains(*at)) {
            if times.iter().all(|known| (known - at).abs() > SAME_TIME) {
                times.push(*at);
            }
        }
        times.sort_by(f64::total_cmp);
        Curve::of_pieces(recording.resampled(&times).pieces())
    }

    /// Divides a curve into the stages.
    fn divided(&self, curve: Curve) -> Curve {
        let stages: Vec<usize> = (0..self.begins.len()).collect();
        curve.divided(&self.begins[1..], &stages)
    }
}

/// Returns a replayed step, as far as the bodies depend on it.
fn step_scene<'a>(recording: &Recording, replayed: &'a ReplayedStep) -> StepScene<'a> {
    let event = replayed.event.as_ref().map(|event| match event.pose {
        Some(pose) => Event::Release { object: event.object, pose },
        None => Event::Grasp { object: event.object },
    });
    StepScene {
        step: replayed.step,
        scene: &replayed.scene,
        end: recording.positions()[*replayed.recorded.samples.end()],
        event,
        turns: replayed.recorded.turn.is_some(),
        depths: replayed.depths,
    }
}

/// Returns true if an arm that stays at its first place is proven free.
fn stands_free(scene: &Scene, recording: &Recording) -> bool {
    let at = recording.positions()[0];
    certify(scene, Path::new(vec![at; 2])).is_ok()
}
