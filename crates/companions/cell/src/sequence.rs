//! The legs and stages of one arm's task.

use crate::legs::{Leg, LegStep, Legs, Moving};
use crate::stage::{Precedence, Stage, StageTime};
use crate::step_stages::{StageBuilder, StepScene};
use cplan_handling::{Object, Presence, RecordedTurn, RecordedWrist, Task};
use cplan_judge::certify;
use cplan_legs::{Event, Leg as TaskLeg, ToolStroke};
use cplan_model::Scene;
use cplan_model::space::{Configuration, Path};
use cplan_motion::{CertifiedCurve, MIN_INTERVAL, Trajectory};
use std::sync::Arc;

/// Duration of the rest after a last step that lowers the tool, seconds. In it, the tool is raised.
const LAST_REST: f64 = 1e-3;

/// The motion of an arm for all steps of its task, without waits.
#[derive(Debug, Clone)]
pub(crate) struct Sequence {
    pub legs: Legs,
    pub stages: Vec<Stage>,
    /// For each step, the grasp or the release.
    events: Vec<Option<Event>>,
}

impl Sequence {
    /// Returns the sequence of the steps of a task. Returns `None` if the task has no steps and the arm cannot be proven to
    /// stand free.
    pub fn new(task: &Task, legs: &[TaskLeg]) -> Option<Self> {
        Self::with_height_tolerance(task, legs, 0.0)
    }

    /// Does the same for a tool and a payload whose heights may deviate by a distance, metres.
    pub fn with_height_tolerance(task: &Task, legs: &[TaskLeg], height_tolerance: f64) -> Option<Self> {
        let bodies = StageBuilder::new(task, legs.iter().map(|leg| &leg.step));
        let bodies = bodies.with_height_tolerance(height_tolerance);
        let mut builder = Builder { task, bodies, out: Vec::new(), steps: Vec::new() };
        if legs.is_empty() {
            builder.stand()?;
        }
        for (number, leg) in legs.iter().enumerate() {
            builder.step(number, leg);
        }
        if let Some((last, leg)) = legs.iter().enumerate().next_back() {
            let step = step_scene(task, leg);
            if let Some(stage) = builder.bodies.rest_at_end(last + 1, &step) {
                builder.rest(&leg.scene, step.end, LAST_REST, stage);
            }
        }
        let Builder { out, bodies, steps, .. } = builder;
        let events = legs.iter().map(|leg| leg.event).collect();
        Some(Self { legs: Legs { legs: out, steps: steps.into() }, stages: bodies.stages, events })
    }

    /// Returns the precedences of all objects that one of two arms hands over to the other.
    pub fn precedences(both: [&Self; 2], tasks: [&Task; 2]) -> Vec<Precedence> {
        let mut precedences = Vec::new();
        for giver in 0..2 {
            for object in handed_over(tasks[giver]) {
                let place = both[giver].step_of(object, |event| matches!(event, Event::Release { .. }));
                let pick = both[1 - giver].step_of(object, |event| matches!(event, Event::Grasp { .. }));
                if let (Some(place), Some(pick)) = (place, pick) {
                    let placed = StageTime::End(place.acts.unwrap_or(place.moves));
                    let taken = pick.acts.map_or(StageTime::End(pick.moves), StageTime::Begin);
                    let name = tasks[giver].objects[object].name.clone();
                    precedences.push(Precedence { name, giver, placed, taken });
                }
            }
        }
        precedences
    }

    fn step_of(&self, object: usize, is_wanted: impl Fn(&Event) -> bool) -> Option<&LegStep> {
        let is_event = |event: &Option<Event>| event.is_some_and(|event| event.object() == object && is_wanted(&event));
        self.events.iter().position(is_event).map(|number| &self.legs.steps[number])
    }

    /// Returns the last configuration.
    pub fn end(&self) -> Configuration {
        let last = self.legs.legs.last().and_then(|leg| leg.trajectory.position.last());
        last.copied().unwrap_or_default().into()
    }
}

/// Iterates over the objects of a task that the arm hands over to another arm.
pub(crate) fn handed_over(task: &Task) -> impl Iterator<Item = usize> {
    let gives = |object: &Object| object.presence == Some(Presence::UntilPlaced);
    task.objects.iter().enumerate().filter(move |(_, object)| gives(object)).map(|(number, _)| number)
}

struct Builder<'a> {
    task: &'a Task,
    bodies: StageBuilder<'a>,
    out: Vec<Leg>,
    steps: Vec<LegStep>,
}

impl Builder<'_> {
    /// Adds the legs of a step.
    fn step(&mut self, number: usize, leg: &TaskLeg) {
        let task = self.task;
        let step = step_scene(task, leg);
        let raises = self.bodies.raising(number, &step);
        if let Some((stage, raising)) = raises.zip(leg.raising) {
            self.rest(&leg.scene, leg.path().start(), raising.seconds, stage);
        }
        let moves = self.bodies.motion(number, &step);
        let (timed, speed) = (&*leg.timed, leg.step.speed);
        let moving = Some(Moving { scene: leg.scene.clone(), curve: timed.curve.clone(), speed });
        self.out.push(Leg { stage: moves, trajectory: timed.trajectory.clone(), moving });
        let rest = leg.rest();
        let acts = (rest >= MIN_INTERVAL).then(|| {
            let stage = self.bodies.acts(number, &step);
            self.rest(&leg.scene, step.end, rest, stage);
            stage
        });
        self.bodies.end(number, &step);
        let wrist = leg.wrist.zip(task.start_tool.wrist).map(|(wrist, from)| {
            let to = leg.step.tool.wrist.unwrap_or(from + wrist.angle);
            RecordedWrist { from, to, begin: wrist.begin - leg.begin, seconds: wrist.seconds }
        });
        let turn = leg.turn.map(|(turn, seconds)| RecordedTurn {
            from: turn.from,
            to: turn.to,
            seconds,
            ..RecordedTurn::default()
        });
        self.steps.push(LegStep {
            file_step: leg.step.number,
            cycle: leg.step.cycle,
            action: leg.step.action.describe(&task.objects),
            object: leg.event.map(|event| task.objects[event.object()].name.clone()),
            raises,
            moves,
            acts,
            event_after: leg.event_after(),
            released: leg.event.and_then(|event| match event {
                Event::Release { pose, .. } => Some(pose),
                Event::Grasp { .. } => None,
            }),
            turn,
            lowered: [leg.raising, leg.stroke].map(|stroke| stroke.map(|stroke| stroke.lowered)),
            wrist,
        });
    }

    /// Adds a motion of no length, for an arm without steps.
    fn stand(&mut self) -> Option<()> {
        let scene = Arc::new(self.bodies.stand());
        let curve = CertifiedCurve::from(certify(&scene, Path::new(vec![self.task.start; 2])).ok()?);
        let trajectory = Trajectory::at_rest(&scene, self.task.start);
        self.out.push(Leg { stage: 0, trajectory, moving: Some(Moving { scene, curve, speed: 1.0 }) });
        Some(())
    }

    fn rest(&mut self, scene: &Scene, at: Configuration, seconds: f64, stage: usize) {
        let mut trajectory = Trajectory::at_rest(scene, at);
        trajectory.append_rest(seconds);
        self.out.push(Leg { stage, trajectory, moving: None });
    }
}

/// Returns a step, as far as the bodies depend on it.
fn step_scene<'a>(task: &Task, leg: &'a TaskLeg) -> StepScene<'a> {
    let last = leg.timed.trajectory.position.last();
    let depth = |stroke: Option<ToolStroke>| Some(task.stroke.as_ref()?.depth_at(stroke?.lowered));
    StepScene {
        step: &leg.step,
        scene: &leg.scene,
        end: last.map_or_else(|| leg.path().goal(), |q| Configuration::from(*q)),
        event: leg.event,
        turns: leg.turn.is_some(),
        depths: [leg.raising, leg.stroke].map(depth),
    }
}
