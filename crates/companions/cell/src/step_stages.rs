//! The stages of an arm that does steps. Bodies move with the arm or rest, and this changes from step to step.

use crate::body::{Body, Frame};
use crate::stage::{Awaited, Left, Stage};
use cplan_geometry::{Convex, Pose};
use cplan_handling::{Object, Presence, Step, Task};
use cplan_legs::Event;
use cplan_model::space::Configuration;
use cplan_model::{AttachedPart, Grip, Heights, Part, Scene};
use std::collections::BTreeSet;
use std::rc::Rc;

/// A step, as far as the bodies depend on it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StepScene<'a> {
    pub step: &'a Step,
    /// The scene of its motion, with the payload.
    pub scene: &'a Scene,
    /// Configuration at the end of the motion.
    pub end: Configuration,
    /// The grasp or the release.
    pub event: Option<Event>,
    /// True if the wrist turns the object while the arm rests.
    pub turns: bool,
    /// Depths of the lowered tool before the motion and at its end, metres. `None` if it is raised.
    pub depths: [Option<f64>; 2],
}

/// Collects the stages of the steps of an arm, in the order of their execution. Steps are numbered in this order, from 0.
pub(crate) struct StageBuilder<'a> {
    task: &'a Task,
    /// The objects that the arm moves.
    moved: BTreeSet<usize>,
    /// The objects that the arm takes from the other one, each with the number of the step that picks it.
    taken: Vec<(usize, usize)>,
    /// The objects that the arm has placed for the other one, each with the number of the step that has placed it.
    left: Vec<(usize, usize, Vec<Body>)>,
    pub stages: Vec<Stage>,
    /// Distance by which the heights of the tool and of its payload may deviate, metres.
    height_tolerance: f64,
}

impl<'a> StageBuilder<'a> {
    /// Begins the stages of these steps.
    pub fn new<'s>(task: &'a Task, steps: impl Iterator<Item = &'s Step>) -> Self {
        let picked = |(number, step): (usize, &Step)| Some((step.action.picked()?, number));
        let picks: Vec<(usize, usize)> = steps.enumerate().filter_map(picked).collect();
        let is_taken = |(object, _): &(usize, usize)| task.objects[*object].presence == Some(Presence::FromPick);
        let taken = picks.iter().filter(|pick| is_taken(pick)).copied().collect();
        let moved = picks.iter().map(|(object, _)| *object).collect();
        Self { task, moved, taken, left: Vec::new(), stages: Vec::new(), height_tolerance: 0.0 }
    }

    /// Lets the heights of the tool and of its payload deviate by a distance, metres.
    pub fn with_height_tolerance(self, height_tolerance: f64) -> Self {
        Self { height_tolerance, ..self }
    }

    /// Adds the stage in which the tool is raised before a motion, and returns its index. `None` if the tool is raised already.
    pub fn raising(&mut self, number: usize, step: &StepScene) -> Option<usize> {
        let depth = step.depths[0]?;
        let bodies = self.links(step.scene, Some(depth)).into_iter().chain(self.resting(step.scene, None)).collect();
        Some(self.stage(number, true, bodies))
    }

    /// Adds the stage of a motion, and returns its index.
    pub fn motion(&mut self, number: usize, step: &StepScene) -> usize {
        let bodies = self.links(step.scene, None).into_iter().chain(payload(step.scene, self.height_tolerance));
        let bodies = bodies.chain(self.resting(step.scene, None)).collect();
        self.stage(number, true, bodies)
    }

    /// Adds the stage of the strokes, the turn and the rest after a motion, and returns its index.
    pub fn acts(&mut self, number: usize, step: &StepScene) -> usize {
        let object = step.event.map(|event| event.object());
        let mut bodies = self.links(step.scene, step.depths[1]);
        bodies.extend(step.event.into_iter().flat_map(|event| self.handled(step, event)));
        bodies.extend(self.resting(step.scene, object));
        self.stage(number, false, bodies)
    }

    /// Ends a step. If it has placed an object for the other arm, the object rests for both arms from now on.
    pub fn end(&mut self, number: usize, step: &StepScene) {
        if let Some(Event::Release { object, .. }) = step.event
            && self.task.objects[object].presence == Some(Presence::UntilPlaced)
        {
            self.left.push((object, number, self.released(step).collect()));
        }
    }

    /// Adds the stage after the last step, with the tool raised, and returns its index. `None` if that step lowers no tool at a
    /// place. `number` is the number of steps.
    pub fn rest_at_end(&mut self, number: usize, step: &StepScene) -> Option<usize> {
        let Some(Event::Release { object, .. }) = step.event else { return None };
        let mut bodies = self.links(step.scene, None);
        bodies.extend(self.resting(step.scene, Some(object)));
        if self.task.objects[object].presence != Some(Presence::UntilPlaced) {
            bodies.extend(self.released(step).map(Rc::new));
        }
        Some(self.stage(number, false, bodies))
    }

    /// Adds the only stage of an arm without steps, and returns its scene.
    pub fn stand(&mut self) -> Scene {
        let poses: Vec<_> = self.task.objects.iter().map(Object::initial_static_pose).collect();
        let scene = self.task.scene(&poses, &[], None, []);
        let links = self.links(&scene, None);
        self.stage(0, false, links);
        scene
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

    /// Returns the links, with the tool raised, or at all heights down to a depth, metres.
    fn links(&self, scene: &Scene, depth: Option<f64>) -> Vec<Rc<Body>> {
        let by = self.height_tolerance;
        let stroke = self.task.stroke.as_ref().filter(|_| depth.is_some() || by > 0.0);
        let swept = stroke.map(|stroke| stroke.swept(&self.task.arm, &[depth.unwrap_or(0.0), by, -by]));
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
    fn released(&self, step: &StepScene) -> impl Iterator<Item = Body> {
        let place = step.event.and_then(|event| match event {
            Event::Release { object, pose } => Some((&self.task.objects[object], pose)),
            Event::Grasp { .. } => None,
        });
        let elevation = step.step.elevation;
        place.into_iter().flat_map(move |(object, pose)| {
            let heights = object.heights_at(elevation);
            object
                .pieces
                .iter()
                .map(move |piece| Body::of_object(Frame::Cell, &object.name, piece.at(&pose), heights, true))
        })
    }

    /// Returns the object of a step while it is lowered, grasped or released, turned and raised.
    fn handled(&self, step: &StepScene, event: Event) -> Vec<Rc<Body>> {
        let object = &self.task.objects[event.object()];
        let lies = &step.scene.workspace().obstacles[self.task.obstacle_number(event.object())];
        let pieces: Vec<Convex> = match event {
            Event::Release { pose, .. } => object.pieces.iter().map(|piece| piece.at(&pose)).collect(),
            Event::Grasp { .. } if lies.pieces.is_empty() => {
                object.pieces.iter().map(|piece| piece.at(&object.at)).collect()
            }
            Event::Grasp { .. } => lies.pieces.clone(),
        };
        let elevation = step.step.elevation;
        let Heights { lower, upper } = object.handled_heights([elevation]);
        let heights = Heights { lower, upper: upper + self.height_tolerance };
        let is_exact = !step.turns && heights == object.heights_at(elevation);
        let tip = self.task.arm.tip_at(step.end);
        let shape = |piece: Convex| match step.turns {
            // The piece turns about the tip.
            true => Convex::disc(tip, piece.reach_from(tip)).unwrap_or(piece),
            false => piece,
        };
        let body = |piece| Rc::new(Body::of_object(Frame::Cell, &object.name, shape(piece), heights, is_exact));
        pieces.into_iter().map(body).collect()
    }
}

/// Returns the carried object of a scene, whose heights may deviate by a distance, metres.
fn payload(scene: &Scene, by: f64) -> Vec<Rc<Body>> {
    let Some(attachment) = scene.attachment() else { return Vec::new() };
    let (frame, pose) = match attachment.grip {
        Grip::Rigid(in_link) => (Frame::Link(1), in_link),
        Grip::Level { angle, point } => (Frame::Tip, Pose::rotation(angle).shifted_in_frame(-point)),
    };
    let Heights { lower, upper } = attachment.heights;
    let heights = Heights { lower: lower - by, upper: upper + by };
    let parts = attachment.parts.iter().filter(|part| !part.on_supports);
    let body = |part: &AttachedPart| {
        let shape = part.shape.at(&pose);
        Rc::new(Body::of_object(frame, &attachment.name, shape, heights, part.is_never_empty))
    };
    parts.map(body).collect()
}
