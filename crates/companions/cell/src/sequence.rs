//! The legs and stages of one arm's task. Bodies move with the arm or rest, and this changes from step to step.

use crate::body::{Body, Frame};
use crate::legs::{Leg, LegStep, Legs, Moving};
use crate::stage::{Awaited, Left, Precedence, Stage, StageTime};
use cplan_geometry::{Convex, Pose};
use cplan_handling::{Object, Presence, Task};
use cplan_judge::certify;
use cplan_legs::{Event, Leg as TaskLeg};
use cplan_model::space::{Configuration, Path};
use cplan_model::{AttachedPart, Grip, Part, Scene};
use cplan_motion::{CertifiedCurve, MIN_INTERVAL, Trajectory};
use std::collections::BTreeSet;
use std::rc::Rc;
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
        let mut builder = Builder::new(task, legs);
        if legs.is_empty() {
            builder.stand()?;
        }
        for (number, leg) in legs.iter().enumerate() {
            builder.step(number, leg);
        }
        if let Some((last, leg)) = legs.iter().enumerate().next_back() {
            builder.rest_at_end(last + 1, leg);
        }
        let Builder { out, stages, steps, .. } = builder;
        let events = legs.iter().map(|leg| leg.event).collect();
        Some(Self { legs: Legs { legs: out, steps: steps.into() }, stages, events })
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
    /// The objects that the arm moves.
    moved: BTreeSet<usize>,
    /// The objects that the arm takes from the other one, each with the number of the step that picks it.
    taken: Vec<(usize, usize)>,
    /// The objects that the arm has placed for the other one, each with the number of the step that has placed it.
    left: Vec<(usize, usize, Vec<Body>)>,
    out: Vec<Leg>,
    stages: Vec<Stage>,
    steps: Vec<LegStep>,
}

impl<'a> Builder<'a> {
    fn new(task: &'a Task, legs: &[TaskLeg]) -> Self {
        let picked = |(number, leg): (usize, &TaskLeg)| Some((leg.step.action.picked()?, number));
        let picks: Vec<(usize, usize)> = legs.iter().enumerate().filter_map(picked).collect();
        let is_taken = |(object, _): &(usize, usize)| task.objects[*object].presence == Some(Presence::FromPick);
        let taken = picks.iter().filter(|pick| is_taken(pick)).copied().collect();
        let moved = picks.iter().map(|(object, _)| *object).collect();
        Self { task, moved, taken, left: Vec::new(), out: Vec::new(), stages: Vec::new(), steps: Vec::new() }
    }

    /// Adds the legs of a step.
    fn step(&mut self, number: usize, leg: &TaskLeg) {
        let task = self.task;
        if let Some(raising) = leg.raising {
            let depth = task.stroke.as_ref().map(|stroke| stroke.depth_at(raising.lowered));
            let bodies = self.links(&leg.scene, depth).into_iter().chain(self.resting(&leg.scene, None)).collect();
            let stage = self.stage(number, true, bodies);
            self.rest(&leg.scene, leg.path().start(), raising.seconds, stage);
        }
        let bodies = self.links(&leg.scene, None).into_iter().chain(payload(&leg.scene));
        let bodies = bodies.chain(self.resting(&leg.scene, None)).collect();
        let moves = self.stage(number, true, bodies);
        let (timed, speed) = (&*leg.timed, leg.step.speed);
        let moving = Some(Moving { scene: leg.scene.clone(), curve: timed.curve.clone(), speed });
        self.out.push(Leg { stage: moves, trajectory: timed.trajectory.clone(), moving });
        let rest = leg.rest();
        let acts = (rest >= MIN_INTERVAL).then(|| {
            let depth = leg.stroke.zip(task.stroke.as_ref()).map(|(own, stroke)| stroke.depth_at(own.lowered));
            let object = leg.event.map(|event| event.object());
            let mut bodies = self.links(&leg.scene, depth);
            bodies.extend(leg.event.into_iter().flat_map(|event| self.handled(leg, event)));
            bodies.extend(self.resting(&leg.scene, object));
            let stage = self.stage(number, false, bodies);
            self.rest(&leg.scene, end_of(leg), rest, stage);
            stage
        });
        if let Some(Event::Release { object, .. }) = leg.event
            && task.objects[object].presence == Some(Presence::UntilPlaced)
        {
            self.left.push((object, number, self.released(leg).collect()));
        }
        let object = leg.event.map(|event| task.objects[event.object()].name.clone());
        let action = leg.step.action.describe(&task.objects);
        let released = leg.event.and_then(|event| match event {
            Event::Release { pose, .. } => Some(pose),
            Event::Grasp { .. } => None,
        });
        let turn = leg.turn.map(|(turn, seconds)| [turn.to - turn.from, seconds]);
        self.steps.push(LegStep { action, object, moves, acts, event_after: leg.event_after(), released, turn });
    }

    /// Adds a rest with the raised tool after the last step, if that step lowers the tool at a place.
    fn rest_at_end(&mut self, number: usize, leg: &TaskLeg) {
        let Some(Event::Release { object, .. }) = leg.event else { return };
        let mut bodies = self.links(&leg.scene, None);
        bodies.extend(self.resting(&leg.scene, Some(object)));
        if self.task.objects[object].presence != Some(Presence::UntilPlaced) {
            bodies.extend(self.released(leg).map(Rc::new));
        }
        let stage = self.stage(number, false, bodies);
        self.rest(&leg.scene, end_of(leg), LAST_REST, stage);
    }

    /// Adds a motion of no length, for an arm without steps.
    fn stand(&mut self) -> Option<()> {
        let task = self.task;
        let poses: Vec<_> = task.objects.iter().map(Object::initial_static_pose).collect();
        let scene = Arc::new(task.scene(&poses, &[], None, []));
        let curve = CertifiedCurve::from(certify(&scene, Path::new(vec![task.start; 2])).ok()?);
        let stage = self.stage(0, false, self.links(&scene, None));
        let trajectory = Trajectory::at_rest(&scene, task.start);
        self.out.push(Leg { stage, trajectory, moving: Some(Moving { scene, curve, speed: 1.0 }) });
        Some(())
    }

    /// Adds a stage of a step, and returns its index. `is_before` is true until the arm has arrived.
    fn stage(&mut self, number: usize, is_before: bool, bodies: Vec<Rc<Body>>) -> usize {
        let left = self.left.iter().map(|(object, placed, pieces)| Left {
            object: *object,
            pieces: pieces.clone(),
            is_released: number == placed + 1,
        });
        let waits = |(_, picked): &&(usize, usize)| number < *picked || is_before && number == *picked;
        let awaited = self.taken.iter().filter(waits);
        let awaited = awaited.map(|(object, picked)| Awaited { object: *object, is_next: number == *picked });
        self.stages.push(Stage { bodies, left: left.collect(), awaited: awaited.collect() });
        self.stages.len() - 1
    }

    fn rest(&mut self, scene: &Scene, at: Configuration, seconds: f64, stage: usize) {
        let mut trajectory = Trajectory::at_rest(scene, at);
        trajectory.append_rest(seconds);
        self.out.push(Leg { stage, trajectory, moving: None });
    }

    /// Returns the links, with the tool raised, or at all heights down to a depth, metres.
    fn links(&self, scene: &Scene, depth: Option<f64>) -> Vec<Rc<Body>> {
        let swept = self.task.stroke.as_ref().zip(depth).map(|(stroke, depth)| stroke.swept(&self.task.arm, &[depth]));
        let of = |link: usize| {
            let raised = scene.own_parts(link);
            let parts = swept.as_ref().map_or(raised, |arm| &arm.links[link].parts);
            let body = move |(part, raised): (_, &Part)| {
                let part: &Part = part;
                Rc::new(Body::of_link(link, part, part.heights == raised.heights))
            };
            parts.iter().zip(raised).map(body).collect::<Vec<_>>()
        };
        [of(0), of(1)].concat()
    }

    /// Returns the objects at rest that the arm moves at some time, except one.
    fn resting(&self, scene: &Scene, except: Option<usize>) -> Vec<Rc<Body>> {
        let at_rest = self.moved.iter().filter(|object| Some(**object) != except);
        let obstacle = |object: &usize| &scene.workspace().obstacles[self.task.obstacle_number(*object)];
        let bodies = at_rest.map(obstacle).flat_map(|lies| {
            let body = |piece: &Convex| Body::of_object(Frame::Cell, &lies.name, piece.clone(), lies.heights, true);
            lies.pieces.iter().map(body).map(Rc::new)
        });
        bodies.collect()
    }

    /// Returns the released object of a step at rest.
    fn released(&self, leg: &TaskLeg) -> impl Iterator<Item = Body> {
        let place = leg.event.and_then(|event| match event {
            Event::Release { object, pose } => Some((&self.task.objects[object], pose)),
            Event::Grasp { .. } => None,
        });
        let elevation = leg.step.elevation;
        place.into_iter().flat_map(move |(object, pose)| {
            let heights = object.heights_at(elevation);
            object
                .pieces
                .iter()
                .map(move |piece| Body::of_object(Frame::Cell, &object.name, piece.at(&pose), heights, true))
        })
    }

    /// Returns the object of a step while it is lowered, grasped or released, turned and raised.
    fn handled(&self, leg: &TaskLeg, event: Event) -> Vec<Rc<Body>> {
        let object = &self.task.objects[event.object()];
        let lies = &leg.scene.workspace().obstacles[self.task.obstacle_number(event.object())];
        let pieces: Vec<Convex> = match event {
            Event::Release { pose, .. } => object.pieces.iter().map(|piece| piece.at(&pose)).collect(),
            Event::Grasp { .. } if lies.pieces.is_empty() => {
                object.pieces.iter().map(|piece| piece.at(&object.at)).collect()
            }
            Event::Grasp { .. } => lies.pieces.clone(),
        };
        let heights = object.handled_heights([leg.step.elevation]);
        let is_exact = leg.turn.is_none() && heights == object.heights_at(leg.step.elevation);
        let tip = self.task.arm.tip_at(end_of(leg));
        let shape = |piece: Convex| match leg.turn {
            // The piece turns about the tip.
            Some(_) => Convex::disc(tip, piece.reach_from(tip)).unwrap_or(piece),
            None => piece,
        };
        let body = |piece| Rc::new(Body::of_object(Frame::Cell, &object.name, shape(piece), heights, is_exact));
        pieces.into_iter().map(body).collect()
    }
}

/// Returns the carried object of a scene.
fn payload(scene: &Scene) -> Vec<Rc<Body>> {
    let Some(attachment) = scene.attachment() else { return Vec::new() };
    let (frame, pose) = match attachment.grip {
        Grip::Rigid(in_link) => (Frame::Link(1), in_link),
        Grip::Level { angle, point } => (Frame::Tip, Pose::rotation(angle).shifted_in_frame(-point)),
    };
    let parts = attachment.parts.iter().filter(|part| !part.on_supports);
    let body = |part: &AttachedPart| {
        let shape = part.shape.at(&pose);
        Rc::new(Body::of_object(frame, &attachment.name, shape, attachment.heights, part.is_never_empty))
    };
    parts.map(body).collect()
}

/// Returns the configuration at the end of a step's motion.
fn end_of(leg: &TaskLeg) -> Configuration {
    let last = leg.timed.trajectory.position.last();
    last.map_or_else(|| leg.path().goal(), |q| Configuration::from(*q))
}
