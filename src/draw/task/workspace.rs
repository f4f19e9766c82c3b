//! The workspace with everything that a task does in it.

use super::states::PayloadState;
use super::{TaskPicture, motion_pen, object_color, tags};
use crate::draw::arm::{self, GOAL, START, UNREACHED};
use crate::draw::color::{self, BARRED, INK, WHITE};
use crate::draw::figure::{Item, Rect, Spot, Step, Style};
use crate::draw::workspace::{framed, ground, tip_trace};
use crate::draw::{extent, page, preferences, shapes};
use crate::engine::task::{Event, Leg};
use crate::geometry::Pose;
use crate::model::{Obstacle, Scene, Task, Workspace};

/// Poses nearer than this, metres and radians, look the same; rounding of those that are.
const SAME: f64 = 1e-6;

/// The panel in this part of the page, which it fills.
#[must_use]
pub fn panel(picture: &TaskPicture, states: &[PayloadState], area: Rect) -> Vec<Item> {
    let task = picture.task;
    let arm = &task.arm;
    let legs = &picture.answer.legs;
    let placed = placed(task, legs);
    let lying: Vec<Obstacle> = (0..task.objects.len()).map(|k| lying(task, k, &task.objects[k].at)).collect();
    let everything =
        task.workspace.obstacles.iter().chain(&lying).chain(placed.iter().map(|(_, object)| object)).cloned().collect();
    let workspace = Workspace { obstacles: everything, ..task.workspace.clone() };
    let overview = Scene::trusted(arm.clone(), workspace);
    let frame = extent::frame(&overview, &[task.start], area);

    let mut inside = ground(&frame, arm);
    let at_first = task.workspace.obstacles.iter().chain(&lying).enumerate();
    inside.extend(at_first.map(|(i, obstacle)| shapes::solid(&frame, obstacle, color::obstacle(i))));
    inside.extend(placed.iter().map(|(k, object)| shapes::dashed(&frame, object, object_color(task, *k))));
    inside.extend(preferences::in_workspace(&task.workspace.preferences, &frame));
    let fails = picture.answer.impossible();
    let unreached =
        || fails.into_iter().flat_map(|fails| fails.ik_solutions.iter().map(move |to| (fails, to.ik_solution)));
    inside.extend(unreached().flat_map(|(fails, q)| arm::items(&frame, &fails.scene, q, &UNREACHED)));
    inside.extend(arm::items(&frame, &overview, task.start, &START));
    if let Some(last) = legs.last() {
        // What was let go of at the end lies there.
        let scene = if last.event.is_some() { &overview } else { &*last.scene };
        inside.extend(arm::items(&frame, scene, last.timed.curve.curve().path().goal(), &GOAL));
    }
    let motions = || states.iter().flat_map(|state| &state.motions);
    let trace = |leg: &Leg| tip_trace(&frame, arm, &leg.timed.curve.curve().outline());
    let traces: Vec<_> = motions().map(|leg| (trace(leg), motion_pen(task, leg))).collect();
    let spots: Vec<Spot> = traces.iter().flat_map(|(steps, _)| steps.iter().filter_map(end)).collect();
    inside.extend(page::lines(traces));
    let mut numbers = Vec::new();
    for leg in motions() {
        let tip = arm.tip_at(leg.timed.curve.curve().path().goal());
        tags::add(&mut numbers, frame.at(tip.x, tip.y), leg.step.number);
    }
    let dot = Style::line(WHITE, 1.2).filled(INK);
    inside.extend(numbers.iter().map(|tag| Item::Disc(tag.at, 3.6, dot)));
    for (fails, q) in unreached() {
        let tip = arm.tip_at(q);
        let spot = frame.at(tip.x, tip.y);
        inside.push(Item::Disc(spot, 3.6, Style::line(BARRED, 1.4).filled(WHITE)));
        tags::add(&mut numbers, spot, fails.step.number);
    }
    let shapes: Vec<Rect> = overview.workspace().obstacles.iter().map(|o| extent::on_page(&frame, o)).collect();
    inside.extend(tags::items(&numbers, frame.rect, &shapes, &spots));
    inside.extend(extent::hidden_note(&frame, &overview.workspace().obstacles));
    framed(&frame, &arm.plane, inside)
}

/// Where a step of an outline leads.
fn end(step: &Step) -> Option<Spot> {
    match *step {
        Step::Move(spot) | Step::Line(spot) | Step::Arc(_, spot) => Some(spot),
        Step::Close => None,
    }
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
    seen[first..].iter().map(|(object, pose)| (*object, lying(task, *object, pose))).collect()
}

fn lying(task: &Task, object: usize, pose: &Pose) -> Obstacle {
    let object = &task.objects[object];
    let pieces = object.pieces.iter().map(|piece| piece.at(pose)).collect();
    Obstacle { name: object.name.clone(), shape: object.shape.at(pose), pieces, heights: object.heights }
}
