//! The view of a task: its worlds, and what happens when.

use super::View;
use super::arm::ArmView;
use super::motion::{Clock, MotionView, PathView};
use super::round::Grain;
use super::world::WorldView;
use crate::draw::task::{describe, motion_pen, words};
use crate::draw::{TaskPicture, extent};
use crate::engine::task::{Event, Impossible, Leg, Sequence};
use crate::geometry::Pose;
use crate::model::{Scene, Status, Task};
use std::sync::Arc;

/// See [`View::of_task`].
pub fn view(picture: &TaskPicture, ending: Option<Status>, facts: Vec<[String; 2]>) -> View {
    let (task, legs) = (picture.task, &picture.answer.legs);
    let grain = Grain::of(&task.arm);
    let mut worlds = Worlds { picture, grain, scenes: Vec::new(), views: Vec::new() };
    let (mut paths, mut motions) = (Vec::new(), Vec::new());
    let mut from = 0.0;
    for leg in legs {
        let name = format!("{}. {}", leg.step.number, leg.step.action.describe(&task.objects));
        let world = worlds.of(&leg.scene);
        motions.push(MotionView { world, path: Some(paths.len()), from, label: name.clone() });
        paths.push(path(task, leg, name, world, grain));
        from = leg.event_time().unwrap_or_else(|| leg.end());
    }
    let last = match picture.answer.impossible() {
        Some(fails) => {
            let label = format!("{}. {} fails", fails.step.number, fails.step.action.describe(&task.objects));
            MotionView { world: worlds.failing(fails), path: None, from, label }
        }
        None => {
            let scene = Scene::trusted(task.arm.clone(), task.obstacles(&at_the_end(task, legs)));
            MotionView { world: worlds.of(&Arc::new(scene)), path: None, from, label: "done".to_owned() }
        }
    };
    motions.push(last);
    let ends = legs.iter().map(|leg| leg.timed.curve.curve().path().goal());
    let shown: Vec<_> = [task.start].into_iter().chain(ends).collect();
    let at_first: Vec<_> = task.objects.iter().map(|object| Some(object.at)).collect();
    let overview = Scene::trusted(task.arm.clone(), task.obstacles(&at_first));
    let (title, status) = words(picture);
    View {
        title,
        status,
        ending,
        facts,
        arm: ArmView::new(&overview, grain),
        frame: extent::sides(&overview, &shown).map(|(lower, upper)| [lower, upper].map(|x| grain.length(x))),
        start: grain.configuration(task.start),
        goals: Vec::new(),
        goal_lines: Vec::new(),
        worlds: worlds.views,
        paths,
        motions,
        clock: Sequence::of(legs).map(|sequence| Clock::new(&sequence.trajectory, grain)),
        frames: Vec::new(),
    }
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
        let contours = (self.picture.c_obstacles)(scene);
        let label = describe(scene.payload().map(|payload| payload.object.as_str()));
        self.views.push(WorldView::new(scene, label, &contours, self.grain));
        self.scenes.push(scene.clone());
        self.views.len() - 1
    }

    /// The world of the step that fails, with what proves that.
    fn failing(&mut self, fails: &Impossible) -> usize {
        let world = self.add(&fails.scene);
        let proofs = fails.ik_solutions.iter().filter_map(|to| to.proof.as_ref());
        let unreached = fails.ik_solutions.iter().map(|to| self.grain.configuration(to.ik_solution)).collect();
        self.views[world] = self.views[world].clone().proven(proofs, self.grain).without(unreached);
        world
    }
}

/// The path of a step.
fn path(task: &Task, leg: &Leg, name: String, world: usize, grain: Grain) -> PathView {
    PathView {
        name,
        world,
        color: leg.carried.map(|_| motion_pen(task, leg).color.to_string()),
        dash: Vec::new(),
        points: grain.configurations(leg.timed.curve.curve().outline().waypoints()),
    }
}

/// Where the objects lie after all steps; what is carried then lies nowhere.
fn at_the_end(task: &Task, legs: &[Leg]) -> Vec<Option<Pose>> {
    let mut poses: Vec<Option<Pose>> = task.objects.iter().map(|object| Some(object.at)).collect();
    for event in legs.iter().filter_map(|leg| leg.event) {
        poses[event.object()] = match event {
            Event::Grasp { .. } => None,
            Event::Release { pose, .. } => Some(pose),
        };
    }
    poses
}
