//! A task: its worlds, what happens when, and which motions a still picture shows together.

use super::arm;
use super::motion::{Clock, MotionView, PathView};
use super::numbers::Grain;
use super::states::{PayloadState, describe, payload_states, rounds};
use super::steps::{Order, rows, words};
use super::world::{ContourView, ObstacleView, WorldView, contours};
use super::{PanelView, Still, View, extent};
use crate::{FieldLines, color};
use cplan_core::cspace::CObstacle;
use cplan_core::model::{Obstacle, Scene, Status};
use cplan_engine::task::{Event, Impossible, Leg, Sequence, TaskAnswer};
use cplan_geometry::Pose;
use cplan_handling::{Object, Task};
use std::sync::Arc;

/// Poses nearer than this, metres and radians, look the same; rounding of those that are.
const SAME: f64 = 1e-6;

/// C-obstacles at some times.
pub type Moments = Vec<(f64, Vec<CObstacle>)>;

/// What there is to show of a task. Objects count as obstacles, numbered after those that stay: they have the same
/// colour wherever they are, and in every world.
#[derive(Debug, Clone)]
pub struct TaskPicture<'a> {
    /// The first line is the title; the others follow in smaller type.
    pub title: Vec<String>,
    /// How it ended, in a word or two. Where a step fails, its number comes before, and the reason below the title.
    pub status: String,
    /// The same for colours and symbols.
    pub ending: Option<Status>,
    /// What is to be said of the result: names and values.
    pub facts: Vec<[String; 2]>,
    /// What was asked.
    pub task: &'a Task,
    /// What came of it.
    pub answer: &'a TaskAnswer,
    /// Contours of a scene in joint space. Asked for each world, and once more where link 2 reaches into an object.
    pub c_obstacles: fn(&Scene) -> Vec<CObstacle>,
    /// Those of what moves, at some times from one to another, so many at the most.
    pub in_time: fn(&Scene, [f64; 2], usize) -> Moments,
}

/// Times at which C-obstacles of what moves are drawn, at the most, all worlds together.
const MOST_MOMENTS: usize = 120;

impl View {
    /// The view of a task: a world for each set of motions that share one.
    #[must_use]
    pub fn of_task(picture: &TaskPicture) -> Self {
        let (task, legs) = (picture.task, &picture.answer.legs);
        let (grain, order) = (Grain::of(&task.arm), Order::of(picture.answer));
        let mut worlds = Worlds { picture, grain, scenes: Vec::new(), views: Vec::new() };
        let (mut paths, mut motions) = (Vec::new(), Vec::new());
        let mut from = 0.0;
        // Of each world, from when to when it is there.
        let mut spans: Vec<[f64; 2]> = Vec::new();
        for leg in legs {
            let name = order.named(&leg.step, &task.objects);
            let world = worlds.of(&leg.scene);
            motions.push(MotionView { world, path: Some(paths.len()), from, label: name.clone(), replay: None });
            let carried = leg.carried.map(|object| color::obstacle(task.obstacle_number(object)));
            let outline = leg.timed.curve.outline();
            paths.push(PathView::of_step(name, &outline, world, order.number(&leg.step), carried, grain));
            let until = leg.event_time().unwrap_or_else(|| leg.end());
            spans.resize(worlds.views.len(), [from, until]);
            (spans[world], from) = ([spans[world][0], until], until);
        }
        let (world, label) = match picture.answer.impossible() {
            Some(fails) => {
                let label = format!("{} fails", order.named(&fails.step, &task.objects));
                (worlds.failing(fails), label)
            }
            None => {
                let (poses, moving) = at_the_end(task, legs);
                let scene = Scene::trusted(task.arm.clone(), task.surroundings(&poses, &moving));
                (worlds.of(&Arc::new(scene)), "done".to_owned())
            }
        };
        motions.push(MotionView { world, path: None, from, label, replay: None });
        worlds.put_in_time(&spans);
        let placed = placed(task, legs);
        let at_first: Vec<_> = task.objects.iter().map(Object::standing_at_first).collect();
        let mut everything = task.obstacles(&at_first);
        everything.obstacles.extend(placed.iter().map(|(_, obstacle)| obstacle.clone()));
        let overview = Scene::trusted(task.arm.clone(), everything);
        let ends = legs.iter().map(|leg| leg.timed.curve.curve().path().goal());
        let shown: Vec<_> = [task.start].into_iter().chain(ends).collect();
        let placed = placed.iter().map(|(object, o)| ObstacleView::new(o, task.obstacle_number(*object), grain));
        let last = legs.last().map(|leg| (leg, motions[legs.len() - 1].world));
        let still = Still {
            time: 0.0,
            now: None,
            reach: None,
            stuck: None,
            field_lines: FieldLines::default(),
            panels: panels(picture, &order, &paths, world, grain),
            placed: placed.collect(),
            // What was let go of at the end lies there.
            end: last
                .zip(paths.last())
                .map(|((leg, world), path)| (path.goal().into(), if leg.event.is_some() { 0 } else { world })),
            steps: rows(picture),
        };
        let (title, status) = words(picture);
        Self {
            title,
            status,
            ending: picture.ending,
            facts: picture.facts.clone(),
            arm: arm::empty_handed(&overview, grain),
            frame: extent::sides(&overview, &shown).map(|(lower, upper)| [lower, upper].map(|x| grain.length(x))),
            start: grain.configuration(task.start),
            goals: Vec::new(),
            goal_lines: Vec::new(),
            worlds: worlds.views,
            paths,
            motions,
            clock: Sequence::of(legs).map(|sequence| Clock::new(&sequence.trajectory, grain)),
            frames: Vec::new(),
            replay: Vec::new(),
            replays: Vec::new(),
            still,
        }
    }
}

/// A configuration space for each payload state, then that of the step that fails, in the world `last`.
fn panels(picture: &TaskPicture, order: &Order, paths: &[PathView], last: usize, grain: Grain) -> Vec<PanelView> {
    let (task, legs) = (picture.task, &picture.answer.legs);
    let states = payload_states(legs, &task.arm.topology());
    let rounds = rounds(legs);
    let panel = |state: &PayloadState| {
        let numbers: Vec<usize> = state.motions.iter().map(|(index, _)| *index).collect();
        let worlds = numbers.iter().map(|&index| paths[index].world).collect();
        let start = paths[numbers[0]].start().into();
        PanelView { title: state.title(rounds, order), worlds, paths: numbers, start, fails: None }
    };
    let mut panels: Vec<PanelView> = states.iter().map(panel).collect();
    let fails = picture.answer.impossible();
    if let Some(fails) = fails {
        let payload = describe(fails.scene.payload().map(|payload| payload.object.as_str()));
        let (number, cycle) = (order.number(&fails.step), fails.step.cycle);
        let round = if cycle > 1 { format!(", round {cycle}") } else { String::new() };
        let title = format!("{number} fails: {payload}{round}");
        let start = grain.configuration(fails.from);
        panels.push(PanelView { title, worlds: vec![last], paths: Vec::new(), start, fails: Some(number) });
    }
    if panels.is_empty() {
        let start = grain.configuration(task.start);
        panels.push(PanelView { title: describe(None), worlds: vec![last], paths: Vec::new(), start, fails: None });
    }
    panels
}

/// The worlds of a task, each once.
struct Worlds<'a> {
    picture: &'a TaskPicture<'a>,
    grain: Grain,
    scenes: Vec<Arc<Scene>>,
    views: Vec<WorldView>,
}

impl Worlds<'_> {
    /// The number of a scene's world. Scenes of repetitions are often one, or else alike.
    fn of(&mut self, scene: &Arc<Scene>) -> usize {
        let known = |other: &Arc<Scene>| Arc::ptr_eq(other, scene) || other == scene;
        self.scenes.iter().position(known).unwrap_or_else(|| self.add(scene))
    }

    fn add(&mut self, scene: &Arc<Scene>) -> usize {
        let c_obstacles = (self.picture.c_obstacles)(scene);
        let label = describe(scene.payload().map(|payload| payload.object.as_str()));
        let open = self.open(scene);
        self.views.push(WorldView { open, ..WorldView::new(scene, label, &c_obstacles, self.grain) });
        self.scenes.push(scene.clone());
        self.views.len() - 1
    }

    /// Shows the worlds, which are there from one time to another, with what moves.
    fn put_in_time(&mut self, spans: &[[f64; 2]]) {
        let legs = &self.picture.answer.legs;
        let picked = |name: &str| {
            let grasps = |leg: &&Leg| matches!(leg.event, Some(Event::Grasp { object }) if self.picture.task.objects[object].name == name);
            legs.iter().find(grasps).and_then(Leg::event_time)
        };
        for (number, view) in self.views.iter_mut().enumerate().filter(|(_, view)| !view.movers.is_empty()) {
            view.movers.iter_mut().for_each(|mover| mover.until = picked(&mover.obstacle.name));
            let Some(span) = spans.get(number) else { continue };
            let moments = (self.picture.in_time)(&self.scenes[number], *span, MOST_MOMENTS / spans.len());
            *view = view.clone().timed(&moments, self.grain);
        }
    }

    /// What link 2 may reach into, as it were if it may not.
    fn open(&self, scene: &Scene) -> Vec<ContourView> {
        let mut workspace = scene.workspace().clone();
        let whole = |workspace| {
            Scene::handling_trusted(self.picture.task.arm.clone(), workspace, scene.payload().cloned(), &[])
        };
        let closed = whole(workspace.clone());
        let pairs = |scene: &Scene, obstacle| scene.pairs().iter().filter(|pair| pair.obstacle == obstacle).count();
        let mut any = false;
        for (number, obstacle) in workspace.obstacles.iter_mut().enumerate() {
            if pairs(scene, number) < pairs(&closed, number) {
                any = true;
            } else {
                obstacle.pieces.clear();
            }
        }
        if !any {
            return Vec::new();
        }
        let all = (self.picture.c_obstacles)(&whole(workspace));
        contours(all.iter().filter(|c| c.link == 1), self.grain)
    }

    /// The world of the step that fails, with what proves that.
    fn failing(&mut self, fails: &Impossible) -> usize {
        let world = self.add(&fails.scene);
        let proofs = fails.ik_solutions.iter().filter_map(|to| to.proof.as_ref());
        let unreached = fails.ik_solutions.iter().map(|to| self.grain.configuration(to.ik_solution)).collect();
        self.views[world] = WorldView { unreached, ..self.views[world].clone().proven(proofs, self.grain) };
        world
    }
}

/// Where the objects lie after all steps, and those that move as yet; what is carried then lies nowhere.
fn at_the_end(task: &Task, legs: &[Leg]) -> (Vec<Option<Pose>>, Vec<usize>) {
    let mut poses: Vec<Option<Pose>> = task.objects.iter().map(Object::standing_at_first).collect();
    let mut moving: Vec<usize> = task.moving_at_first().collect();
    for event in legs.iter().filter_map(|leg| leg.event) {
        moving.retain(|&object| object != event.object());
        poses[event.object()] = match event {
            Event::Grasp { .. } => None,
            Event::Release { pose, .. } => Some(pose),
        };
    }
    (poses, moving)
}

/// Where objects are put, by the object's number; each place once, and none where the object lay at first.
fn placed(task: &Task, legs: &[Leg]) -> Vec<(usize, Obstacle)> {
    let mut seen: Vec<(usize, Pose)> = task.objects.iter().map(|object| object.at).enumerate().collect();
    let first = seen.len();
    for leg in legs {
        let Some(Event::Release { object, pose }) = leg.event else { continue };
        let same = |known: &(usize, Pose)| {
            let by = known.1.inv_mul(&pose);
            known.0 == object && by.translation.vector.norm() <= SAME && by.rotation.angle().abs() <= SAME
        };
        if !seen.iter().any(same) {
            seen.push((object, pose));
        }
    }
    seen[first..].iter().map(|(object, pose)| (*object, task.objects[*object].lying(Some(pose)))).collect()
}
