//! The workspace, with the arm and everything in it.

use super::arm::{self, CURRENT_LOOK, GHOST_LOOK, GOAL_LOOK, START_LOOK, UNREACHED_LOOK};
use super::axes::{Frame, Unit};
use super::figure::{Anchor, Item, Rect, Step, Style, chain, label, lines, lines_by_path};
use super::labels::{self, Named};
use super::view::{ObstacleView, PathView, View, bounding_box, reach_shape, titles};
use super::{blocking, checked, frames, preferences, reach, shapes, tags};
use cplan_core::model::Arm;
use cplan_core::space::Configuration;
use cplan_theme::{GRAY, INFEASIBLE, INK, PALE, WHITE};

/// Draws the panel, which fills this part of the page.
#[must_use]
pub fn panel(view: &View, area: Rect) -> Vec<Item> {
    let View { arm, frame: [x, y], still, .. } = view;
    let frame = Frame::filling(area, (*x).into(), (*y).into());
    let first = view.first_world();
    let lying = || first.obstacles.iter().chain(&still.placed).filter(|obstacle| obstacle.lies());
    let mut inside = ground(&frame, arm);
    inside.extend(still.reach.as_ref().map(|reach| reach::in_workspace(reach, &frame)));
    inside.extend(view.world_now().obstacles.iter().map(|obstacle| shapes::solid(&frame, obstacle)));
    inside.extend(movers(view, &frame));
    inside.extend(still.placed.iter().map(|object| shapes::dashed(&frame, object)));
    inside.extend(preferences::in_workspace(&first.regions, &frame));
    let mut pose = |world: usize, q, look| {
        inside.extend(arm::items(&frame, arm, view.worlds[world].payload.as_ref(), q, look));
    };
    if let ([path], false) = (&view.paths[..], view.is_task()) {
        path.ghosts.0.iter().for_each(|&q| pose(0, q, &GHOST_LOOK));
    }
    view.unreached().for_each(|(world, q)| pose(world, q, &UNREACHED_LOOK));
    pose(0, view.start.into(), &START_LOOK);
    still.end.into_iter().for_each(|(q, world)| pose(world, q.into(), &GOAL_LOOK));
    let paths = still.panels.iter().flat_map(|panel| &panel.paths).map(|&index| &view.paths[index]);
    let traces: Vec<_> = paths.map(|path| (tip_trace(&frame, arm, path), path.pen())).collect();
    let spots: Vec<[f64; 2]> = traces.iter().flat_map(|(steps, _)| steps.iter().filter_map(end)).collect();
    inside.extend(if still.lights_paths { lines_by_path(traces) } else { lines(traces) });
    let named = if view.is_task() || view.still.panels.is_empty() { Vec::new() } else { names(view, &frame) };
    inside.extend(labels::items(&frame.rect, &named));
    if view.is_task() {
        let boxes: Vec<Rect> = lying().map(|obstacle| on_page(&frame, obstacle)).collect();
        inside.extend(numbers(view, &frame, &boxes, &spots));
    }
    if let Some((q, world)) = still.now {
        inside.extend(arm::items(&frame, arm, view.worlds[world].payload.as_ref(), q.into(), &CURRENT_LOOK));
    }
    inside.extend(
        still.stuck.iter().flat_map(|blocking| blocking::in_workspace(blocking, arm, view.first_world(), &frame)),
    );
    inside.extend(
        still.checked.iter().flat_map(|checked| checked::in_workspace(checked, arm, view.first_world(), &frame)),
    );
    inside.extend(hidden_note(&frame, lying()));
    let mut items = vec![Item::Clip(frame.rect, inside)];
    items.extend(frame.border([Unit::Meters; 2], titles(&arm.plane), [false; 2]));
    items.extend(frames::items(&frame, &view.frames));
    items
}

/// Draws moving obstacles at their current poses. A still picture also shows their trajectories, dashed.
fn movers(view: &View, frame: &Frame) -> Vec<Item> {
    let (movers, mut items) = (&view.world_now().movers, Vec::new());
    if let (None, Some(duration)) = (view.still.now, view.duration()) {
        for mover in movers {
            let moments = mover.moments(duration);
            let places = std::iter::once(&0.0).chain(&moments).map(|&time| mover.origin(time));
            let line = chain(places.map(|p| frame.at(p.x, p.y)), false);
            items.push(Item::Outline(line, Style::line(GRAY, 1.0).dashed(shapes::ABSENT_DASH)));
            items.extend(moments.iter().map(|&time| shapes::dashed(frame, &mover.at(time))));
        }
    }
    items.extend(movers.iter().map(|mover| shapes::solid(frame, &mover.at(view.still.time))));
    items
}

/// Returns the names of the arm's poses and of the obstacles. Obstacles have numbers instead of names if there are
/// many.
fn names(view: &View, frame: &Frame) -> Vec<Named> {
    let arm = |name: &str, q: [f64; 2]| {
        let [tip, elbow] = [view.arm.tip_at(q.into()), view.arm.elbow_at(q[0])].map(|p| frame.at(p.x, p.y));
        (name.to_owned(), labels::label_box_beyond(name, tip, elbow))
    };
    // An arm that does not move needs no name.
    let ends = view.still.end.map(|(q, _)| [arm("goal", q), arm("start", view.start)]);
    let arms = ends.into_iter().flatten();
    let world = view.first_world();
    let lying = world.obstacles.iter().enumerate().filter(|(_, obstacle)| obstacle.lies());
    let obstacles = lying.map(|(number, o)| (world.called(number), labels::place(frame, &o.outline, o.own())));
    let movers = world.movers.iter().map(|mover| mover.at(view.still.time));
    let movers = movers.map(|o| (o.name.clone(), labels::place(frame, &o.outline, o.own())));
    arms.chain(obstacles).chain(movers).collect()
}

/// Draws a dot with the step's number at the place where each step ends, or should end if it fails.
fn numbers(view: &View, frame: &Frame, boxes: &[Rect], spots: &[[f64; 2]]) -> Vec<Item> {
    let (mut items, mut tags) = (Vec::new(), Vec::new());
    for (q, number, reached) in view.still.panels.iter().flat_map(|panel| view.ends(panel)) {
        let tip = view.arm.tip_at(q);
        let spot = frame.at(tip.x, tip.y);
        let (line, fill) = if reached { (Style::line(WHITE, 1.2), INK) } else { (Style::line(INFEASIBLE, 1.4), WHITE) };
        items.push(Item::Disc(spot, 3.6, line.filled(fill)));
        tags::add(&mut tags, spot, number);
    }
    items.extend(tags::items(&tags, frame.rect, boxes, spots));
    items
}

/// Returns the place where a step of an outline ends. `None` for a step that closes the outline.
fn end(step: &Step) -> Option<[f64; 2]> {
    match *step {
        Step::Move(spot) | Step::Line(spot) | Step::Arc(_, spot) => Some(spot),
        Step::Close => None,
    }
}

/// Returns the box on the page around an obstacle that has a place.
fn on_page(frame: &Frame, obstacle: &ObstacleView) -> Rect {
    let [x, y] = bounding_box(obstacle.own());
    let ([left, bottom], [right, top]) = (frame.at(x.0, y.0), frame.at(x.1, y.1));
    Rect { x: left, y: top, width: right - left, height: bottom - top }
}

/// Returns a note if obstacles lie outside the panel.
fn hidden_note<'a>(frame: &Frame, obstacles: impl Iterator<Item = &'a ObstacleView>) -> Option<Item> {
    let outside = |o: &&ObstacleView| {
        let [x, y] = bounding_box(o.own());
        x.1 < frame.x.0 || x.0 > frame.x.1 || y.1 < frame.y.0 || y.0 > frame.y.1
    };
    let text = match obstacles.filter(outside).count() {
        0 => return None,
        1 => "1 obstacle lies outside this picture".to_owned(),
        n => format!("{n} obstacles lie outside this picture"),
    };
    let at = [frame.rect.x + 10.0, frame.rect.bottom() - 10.0];
    Some(label(at, text, 13.0, Anchor::Start, GRAY))
}

/// Draws the lowest layer: grid and reach.
fn ground(frame: &Frame, arm: &Arm) -> Vec<Item> {
    let mut items = frame.grid([Unit::Meters; 2]);
    let reach = Style::line(PALE, 1.0).dashed(&[2.0, 4.0]);
    items.push(Item::Outline(shapes::outline(frame, &reach_shape(arm)), reach));
    items
}

/// Returns the path of the tip. Straight motions in joint space are curves here, so they are drawn in small steps.
#[must_use]
pub fn tip_trace(frame: &Frame, arm: &Arm, path: &PathView) -> Vec<Step> {
    /// Step in radians. With it, a chord deviates from its arc by at most 2e-5 of the reach, which is a hundredth of a
    /// pixel.
    const ARC_STEP: f64 = 0.0125;
    const MAX_ARC_POINTS: f64 = 2000.0;
    let turns = [0, 1].map(|k| arm.joints[k].joint_type.is_revolute());
    let mut spots = vec![path.start()];
    for (a, b) in path.points.0.windows(2).map(|ends| (ends[0], ends[1])) {
        let angle = (0..2).filter(|&k| turns[k]).map(|k| (b[k] - a[k]).abs()).fold(0.0, f64::max);
        let n = (angle / ARC_STEP).ceil().clamp(1.0, MAX_ARC_POINTS) as usize;
        spots.extend((1..=n).map(|i| a + (b - a) * (i as f64 / n as f64)));
    }
    let place = |q: Configuration| {
        let tip = arm.tip_at(q);
        frame.at(tip.x, tip.y)
    };
    chain(spots.into_iter().map(place), false)
}
