//! A task: its worlds, the times of its events, and the motions that a still picture shows.

use super::content::{PanelView, StillContent, View};
use super::extent;
use super::height::{TurnsView, height};
use super::motion::{Clock, MotionView, PathView};
use super::numbers::RoundingSteps;
use super::picture::Picture;
use super::states::{PayloadState, describe, grouped, hand, payload_states, titles};
use super::steps::{Order, rounds, rows, words};
use super::strip::StripView;
use super::task_picture::TaskPicture;
use super::tool_angle;
use super::world::{ContourView, ObstacleView, WorldView, contours};
use cplan_geometry::Pose;
use cplan_handling::{Object, ObstacleTrajectory, Placement, Task, TimedScene};
use cplan_legs::{Event, FailedStep, Leg, Sequence};
use cplan_model::space::Configuration;
use cplan_model::{Additions, Obstacle, Outcome, Scene};
use std::sync::Arc;

/// Poses count as equal within this distance, in metres or radians. It covers rounding.
const EQUALITY_TOLERANCE: f64 = 1e-6;

/// Largest number of times, in all worlds together, at which C-obstacles of moving obstacles are computed.
const MAX_MOMENTS: usize = 120;

impl View {
    /// Returns the view of a task. Motions with the same scene share a world.
    pub fn of_task(picture: &TaskPicture) -> Self {
        let (task, legs) = (picture.task, &picture.answer.legs);
        let (grain, order) = (RoundingSteps::of(&task.arm), Order::of(picture.answer));
        let mut worlds = Worlds { picture, grain, scenes: Vec::new(), views: Vec::new() };
        let (mut paths, mut motions) = (Vec::new(), Vec::new());
        let mut from = 0.0;
        // For each world, the interval of time during which it is the current one.
        let mut spans: Vec<[f64; 2]> = Vec::new();
        for leg in legs {
            let name = order.named(&leg.step, &task.objects);
            let world = worlds.of(&leg.scene, &leg.moving);
            motions.push(MotionView {
                world,
                path: Some(paths.len()),
                from,
                label: name.clone(),
                round: leg.step.cycle,
                clearance: Some(leg.clearance()).filter(|clearance| clearance.is_finite()),
                replay: None,
            });
            let carried = leg.carried.map(|object| cplan_theme::obstacle(task.obstacle_number(object)));
            let outline = leg.timed.curve.outline();
            paths.push(PathView::of_step(name, &outline, world, order.number(&leg.step), carried, grain));
            let until = leg.event_time().unwrap_or_else(|| leg.end());
            spans.resize(worlds.views.len(), [from, until]);
            (spans[world], from) = ([spans[world][0], until], until);
        }
        let (world, label) = match picture.answer.failed() {
            Some(fails) => {
                let label = format!("{} fails", order.named(&fails.step, &task.objects));
                (worlds.add_failed_step(fails), label)
            }
            None => {
                let (poses, moving) = at_the_end(task, legs);
                let scene = task.scene(&poses, &moving, None, []);
                (worlds.of(&Arc::new(scene), &moving), "done".to_owned())
            }
        };
        motions.push(MotionView { world, path: None, from, label, round: 1, clearance: None, replay: None });
        worlds.add_moving_obstacles(&spans);
        let placed = placed(task, legs);
        let at_first: Vec<_> = task.objects.iter().map(Object::initial_static_pose).collect();
        let mut everything = task.obstacles(&at_first);
        everything.fixed.obstacles.extend(placed.iter().map(|(_, obstacle)| obstacle.clone()));
        let overview = everything.scene_trusted(task.arm.clone());
        let ends = legs.iter().map(|leg| leg.timed.curve.curve().path().goal());
        let shown: Vec<_> = [task.start].into_iter().chain(ends).collect();
        let placed = placed.iter().map(|(object, o)| ObstacleView::new(o, task.obstacle_number(*object), grain));
        let last = legs.last().map(|leg| (leg, motions[legs.len() - 1].world));
        let still = StillContent {
            panels: panels(picture, &order, (&paths, &worlds.views), world, grain),
            placed: placed.collect(),
            // In the final picture, an object that the last motion releases lies at its place.
            end: last
                .zip(paths.last())
                .map(|((leg, world), path)| (path.goal().into(), if leg.event.is_some() { 0 } else { world })),
            steps: rows(picture),
            ..StillContent::default()
        };
        let (title, status) = words(picture);
        let strip = strip(picture, &worlds.views);
        let (ending, facts) = (picture.ending, picture.facts.clone());
        Self {
            frame: extent::sides(&overview, &shown, &[]).map(|(lower, upper)| [lower, upper].map(|x| grain.length(x))),
            worlds: worlds.views,
            paths,
            motions,
            clock: (!legs.is_empty()).then(|| Clock::new(&Sequence::of(legs).trajectory, grain)),
            strip,
            height: height(task, legs),
            turns: TurnsView::of_task(task, legs),
            tool: tool_angle::of_task(task, legs),
            still,
            ..Self::of_picture(&Picture { title, status, ending, facts, ..Picture::new(&overview, task.start) })
        }
    }
}

/// Returns the strip of progress against time. `None` unless obstacles move.
fn strip(picture: &TaskPicture, worlds: &[WorldView]) -> Option<StripView> {
    let plane = picture.plane?;
    let waits = match &picture.answer.outcome {
        Outcome::Found(motion) => motion.timing.as_ref().map_or(&[][..], |timing| &timing.waits),
        _ => &[],
    };
    Some(StripView::new(plane, picture.answer.duration(), waits, worlds))
}

/// Returns a configuration space for each payload state with its C-obstacles, and finally one for the failed step, whose world is
/// `last`.
fn panels(
    picture: &TaskPicture,
    order: &Order,
    (paths, worlds): (&[PathView], &[WorldView]),
    last: usize,
    grain: RoundingSteps,
) -> Vec<PanelView> {
    let (task, legs) = (picture.task, &picture.answer.legs);
    let rounds = rounds(legs);
    let worlds_of =
        |state: &PayloadState| state.motions.iter().map(|&(index, _)| paths[index].world).collect::<Vec<usize>>();
    let effect = |state: &PayloadState| Effect::of(worlds, &worlds_of(state));
    let is_alike = |a: &PayloadState, b: &PayloadState| effect(a).is_same_as(&effect(b));
    let groups = grouped(payload_states(legs, &task.arm.topology()), is_alike);
    let panel = |group: &Vec<PayloadState>| {
        let numbers: Vec<usize> = group.iter().flat_map(|state| &state.motions).map(|(index, _)| *index).collect();
        let starts = free_starts(numbers.iter().map(|&index| &paths[index]));
        let worlds = group.iter().flat_map(worlds_of).collect();
        let [title, subtitle] = titles(group, rounds, order);
        PanelView { title, subtitle, worlds, paths: numbers, starts, fails: None }
    };
    let mut panels: Vec<PanelView> = groups.iter().map(panel).collect();
    let fails = picture.answer.failed();
    if let Some(fails) = fails {
        let payload = fails.scene.attachment().map(|payload| payload.name.as_str());
        let (number, cycle) = (order.number(&fails.step), fails.step.cycle);
        let round = if cycle > 1 { format!(", round {cycle}") } else { String::new() };
        let (title, subtitle) = (hand(payload.as_slice()), format!("step {number} fails{round}"));
        let starts = vec![grain.configuration(fails.from)];
        panels.push(PanelView { title, subtitle, worlds: vec![last], paths: Vec::new(), starts, fails: Some(number) });
    }
    if panels.is_empty() {
        let starts = vec![grain.configuration(task.start)];
        panels.push(PanelView {
            title: hand(&[]),
            subtitle: String::new(),
            worlds: vec![last],
            paths: Vec::new(),
            starts,
            fails: None,
        });
    }
    panels
}

/// Returns the starts of paths at which no other path ends. Each is listed once.
fn free_starts<'a>(paths: impl Iterator<Item = &'a PathView> + Clone) -> Vec<[f64; 2]> {
    let mut starts: Vec<[f64; 2]> = Vec::new();
    for start in paths.clone().map(PathView::start) {
        let is_at_start = |q: Configuration| (q - start).norm() <= EQUALITY_TOLERANCE;
        let is_known = starts.iter().any(|&known| is_at_start(known.into()));
        if !is_known && !paths.clone().any(|path| is_at_start(path.goal())) {
            starts.push(start.into());
        }
    }
    // In a cycle, each path begins where another one ends.
    if starts.is_empty() { paths.take(1).map(|path| path.start().into()).collect() } else { starts }
}

/// The content of a configuration space that depends on payload and obstacles.
#[derive(PartialEq)]
struct Effect<'a> {
    carries: bool,
    is_static: bool,
    /// C-obstacles of each obstacle, and those that it would have if link 2 had to keep out of it.
    obstacles: Vec<[Vec<&'a ContourView>; 2]>,
}

impl<'a> Effect<'a> {
    /// Returns the content for worlds that differ only in the obstacles into which link 2 may reach.
    fn of(worlds: &'a [WorldView], indices: &[usize]) -> Self {
        let first = &worlds[indices[0]];
        let of = |number: usize| {
            let is_open = |world: &&WorldView| world.open.iter().any(|c| c.obstacle == number);
            let world = indices.iter().map(|&index| &worlds[index]).find(is_open).unwrap_or(first);
            [&world.c_obstacles, &world.open].map(|all| all.iter().filter(|c| c.obstacle == number).collect())
        };
        Self {
            carries: first.payload.is_some(),
            is_static: first.movers.is_empty(),
            obstacles: (0..first.obstacles.len()).map(of).collect(),
        }
    }

    /// Returns true if both look the same. This is never the case with moving obstacles.
    fn is_same_as(&self, other: &Self) -> bool {
        self.is_static && self == other
    }
}

/// The worlds of a task, each once.
struct Worlds<'a> {
    picture: &'a TaskPicture<'a>,
    grain: RoundingSteps,
    /// The scene of each world, with the trajectories of its moving obstacles.
    scenes: Vec<(Arc<Scene>, Vec<ObstacleTrajectory>)>,
    views: Vec<WorldView>,
}

impl Worlds<'_> {
    /// Returns the index of the world with this scene, in which the objects `moving` move. Adds the world if it is new.
    /// Repetitions of a step often share a scene, or have equal ones.
    fn of(&mut self, scene: &Arc<Scene>, moving: &[usize]) -> usize {
        let known = |(other, _): &(Arc<Scene>, Vec<ObstacleTrajectory>)| Arc::ptr_eq(other, scene) || other == scene;
        self.scenes.iter().position(known).unwrap_or_else(|| self.add(scene, moving))
    }

    fn add(&mut self, scene: &Arc<Scene>, moving: &[usize]) -> usize {
        let trajectories = self.picture.task.trajectories(moving);
        let timed = TimedScene { scene, trajectories: &trajectories };
        let c_obstacles = (self.picture.c_obstacles)(scene);
        let label = describe(scene.attachment().map(|payload| payload.name.as_str()));
        let open = self.open(scene);
        self.views.push(WorldView { open, ..WorldView::new(timed, label, &c_obstacles, self.grain) });
        self.scenes.push((scene.clone(), trajectories));
        self.views.len() - 1
    }

    /// Adds the C-obstacles of moving obstacles to each world, for the time during which the world is current.
    fn add_moving_obstacles(&mut self, spans: &[[f64; 2]]) {
        let legs = &self.picture.answer.legs;
        let picked = |name: &str| {
            let grasps = |leg: &&Leg| matches!(leg.event, Some(Event::Grasp { object }) if self.picture.task.objects[object].name == name);
            legs.iter().find(grasps).and_then(Leg::event_time)
        };
        for (number, view) in self.views.iter_mut().enumerate().filter(|(_, view)| !view.movers.is_empty()) {
            view.movers.iter_mut().for_each(|mover| mover.until = picked(&mover.obstacle.name));
            let Some(span) = spans.get(number) else { continue };
            let (scene, trajectories) = &self.scenes[number];
            let moments = (self.picture.in_time)(TimedScene { scene, trajectories }, *span, MAX_MOMENTS / spans.len());
            *view = view.clone().timed(&moments, self.grain);
        }
    }

    /// Returns the C-obstacles of those obstacles into which link 2 may reach, as if it had to keep out of them.
    fn open(&self, scene: &Scene) -> Vec<ContourView> {
        let mut workspace = scene.workspace().clone();
        let whole = |workspace| {
            let additions = Additions { allowed_contacts: Vec::new(), ..scene.additions().clone() };
            Scene::with_trusted(self.picture.task.arm.clone(), workspace, additions)
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

    /// Adds the world of the failed step, with the proofs of its failure, and returns the world's index.
    fn add_failed_step(&mut self, fails: &FailedStep) -> usize {
        let world = self.add(&fails.scene, &fails.moving);
        let proofs = fails.ik_solutions.iter().filter_map(|to| to.proof.as_ref());
        let unreached = fails.ik_solutions.iter().map(|to| self.grain.configuration(to.ik_solution)).collect();
        self.views[world] = WorldView { unreached, ..self.views[world].clone().proven(proofs, self.grain) };
        world
    }
}

/// Returns the poses of the objects after all steps (`None` for a carried object), and the objects that still move.
fn at_the_end(task: &Task, legs: &[Leg]) -> (Vec<Option<Placement>>, Vec<usize>) {
    let mut poses: Vec<Option<Placement>> = task.objects.iter().map(Object::initial_static_pose).collect();
    let mut moving: Vec<usize> = task.initially_moving().collect();
    for (step, event) in legs.iter().filter_map(|leg| Some((&leg.step, leg.event?))) {
        moving.retain(|&object| object != event.object());
        poses[event.object()] = match event {
            Event::Grasp { .. } => None,
            Event::Release { pose, .. } => Some(Placement { pose, elevation: step.elevation }),
        };
    }
    (poses, moving)
}

/// Returns objects at their new places, with their indices. Each place occurs once.
fn placed(task: &Task, legs: &[Leg]) -> Vec<(usize, Obstacle)> {
    let mut seen: Vec<(usize, Pose)> = task.objects.iter().map(|object| object.at).enumerate().collect();
    let first = seen.len();
    for leg in legs {
        let Some(Event::Release { object, pose }) = leg.event else { continue };
        let same = |known: &(usize, Pose)| {
            let by = known.1.inverse_pose(&pose);
            known.0 == object
                && by.translation.norm() <= EQUALITY_TOLERANCE
                && by.rotation.angle().abs() <= EQUALITY_TOLERANCE
        };
        if !seen.iter().any(same) {
            seen.push((object, pose));
        }
    }
    let obstacle = |(object, pose): &(usize, Pose)| task.objects[*object].obstacle_at(Some(&(*pose).into()));
    seen[first..].iter().map(|placed| (placed.0, obstacle(placed))).collect()
}
