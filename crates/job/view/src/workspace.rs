//! The workspace with the arm, the obstacles and the objects.

use super::arm::{self, ArmStyle, CURRENT_LOOK, GHOST_LOOK, GOAL_LOOK, START_LOOK, UNREACHED_LOOK};
use super::axes::{Frame, Unit};
use super::figure::{Anchor, Item, Rect, Step, Style, chain, label, lines, lines_by_path, text_width};
use super::labels::{self, Placer};
use super::named::Named;
use super::tags::{self, Tag};
use super::view::{ObstacleView, PathView, View, bounding_box, reach_shape, titles};
use super::{blocking, checked, followed, frames, preferences, shapes};
use cplan_model::space::Configuration;
use cplan_model::{Arm, Shape};
use cplan_theme::{GRAY, INFEASIBLE, INK, PALE, WHITE};

/// Radius of the dot at the end of a step, in pixels.
const STEP_END_RADIUS: f64 = 3.6;
/// Half the width of the disc of a joint, in pixels.
const JOINT_HALF_WIDTH: f64 = 5.5;
/// Half the width of the marks of contacts and narrow places, in pixels.
const MARKER_HALF_WIDTH: f64 = 8.0;

/// Draws the panel, which fills this part of the page.
pub fn panel(view: &View, area: Rect) -> Vec<Item> {
    let View { arm, still, .. } = view;
    let focus = still.line.as_ref().and_then(|line| line.focus);
    let [x, y] = focus.map_or(view.frame, |focus| focus.ranges);
    let frame = Frame::filling(area, x.into(), y.into());
    let first = view.first_world();
    let lying = || first.obstacles.iter().chain(&still.placed).filter(|obstacle| obstacle.lies());
    let mut inside = ground(&frame, arm);
    inside.extend(still.sections.iter().filter_map(|section| section.in_workspace(&frame)));
    inside.extend(view.world_now().obstacles.iter().map(|obstacle| shapes::solid(&frame, obstacle)));
    inside.extend(movers(view, &frame));
    inside.extend(still.placed.iter().map(|object| shapes::dashed(&frame, object)));
    inside.extend(preferences::in_workspace(&first.regions, &frame));
    let mut placer = Placer::new(frame.rect);
    let is_followed = still.line.is_some();
    if let ([path], false) = (&view.paths[..], view.is_task() || is_followed) {
        inside.extend(path.ghosts.0.iter().flat_map(|&q| pose(view, &frame, &mut placer, 0, q, &GHOST_LOOK)));
    }
    inside.extend(view.unreached().flat_map(|(world, q)| pose(view, &frame, &mut placer, world, q, &UNREACHED_LOOK)));
    // The arm would hide the line.
    if !is_followed {
        inside.extend(pose(view, &frame, &mut placer, 0, view.start.into(), &START_LOOK));
        if let Some((q, world)) = still.end {
            inside.extend(pose(view, &frame, &mut placer, world, q.into(), &GOAL_LOOK));
        }
    }
    inside.extend(still.line.iter().flat_map(|line| followed::arms(line, view, &frame)));
    inside.extend(still.line.iter().flat_map(|line| followed::in_workspace(line, &frame)));
    inside.extend(still.line.iter().flat_map(|line| followed::tip_path(line, view, &frame)));
    let paths = still.panels.iter().flat_map(|panel| &panel.paths).map(|&index| &view.paths[index]);
    let traces = paths.filter(|_| !is_followed).map(|path| (tip_trace(&frame, arm, path), path.pen()));
    let traces: Vec<_> = traces.collect();
    traces.iter().for_each(|(steps, _)| placer.block_line(steps));
    inside.extend(if still.lights_paths { lines_by_path(traces, &still.top_paths) } else { lines(traces) });
    let tags = if view.is_task() { step_ends(view, &frame, &mut inside) } else { Vec::new() };
    if let Some((q, world)) = still.now {
        inside.extend(pose(view, &frame, &mut placer, world, q.into(), &CURRENT_LOOK));
    }
    inside.extend(marks(view, &frame, &mut placer));
    inside.extend(still.line.iter().flat_map(|line| followed::place(line, &frame)));
    let overview = still.line.as_ref().and_then(|line| followed::overview(line, view, &frame));
    if let Some((place, _)) = &overview {
        placer.block_box(*place);
    }
    inside.extend(hidden_note(&frame, lying(), &mut placer));
    tags.iter().for_each(|tag| placer.block_spot(tag.at, STEP_END_RADIUS + 1.0));
    placer.beside(&tags::names(&tags, STEP_END_RADIUS + 1.0));
    if !view.is_task() && !view.still.panels.is_empty() {
        walls(view, &frame).for_each(|wall| placer.block_line(&wall));
        placer.beside(&names(view, &frame));
    }
    inside.extend(placer.into_items());
    inside.extend(overview.into_iter().flat_map(|(_, items)| items));
    let mut items = vec![Item::Clip(frame.rect, inside)];
    items.extend(frame.border([Unit::Meters; 2], titles(&arm.plane), [false; 2]));
    items.extend(frames::items(&frame, &view.frames));
    items
}

/// Draws the arm at a configuration. Names avoid it.
fn pose(view: &View, frame: &Frame, placer: &mut Placer, world: usize, q: Configuration, look: &ArmStyle) -> Vec<Item> {
    let payload = view.worlds[world].payload.as_ref();
    for shape in arm::placed_shapes(&view.arm, payload, q) {
        if look.blocks() {
            placer.block_shape(frame, &shape);
        } else {
            placer.block_line(&shapes::outline(frame, &shape));
        }
    }
    if look.blocks() {
        // The shapes of a link may leave its joint uncovered.
        for joint in [view.arm.base, view.arm.elbow_at(q[0])] {
            placer.block_spot(frame.at(joint.x, joint.y), JOINT_HALF_WIDTH);
        }
    }
    arm::items(frame, &view.arm, payload, q, look)
}

/// Draws the obstacles that block a motion, and the findings about a checked configuration. Names avoid both.
fn marks(view: &View, frame: &Frame, placer: &mut Placer) -> Vec<Item> {
    let (first, mut items) = (view.first_world(), Vec::new());
    let block_arm = |placer: &mut Placer, q: Configuration| {
        let shapes = arm::placed_shapes(&view.arm, first.payload.as_ref(), q);
        shapes.iter().for_each(|shape| placer.block_shape(frame, shape));
    };
    if let Some(blocking) = &view.still.stuck {
        items.extend(blocking::in_workspace(blocking, &view.arm, first, frame));
        if let Some((q, point)) = blocking.at {
            block_arm(placer, q);
            placer.block_spot(frame.at(point.x, point.y), MARKER_HALF_WIDTH);
        }
    }
    if let Some(checked) = &view.still.checked {
        items.extend(checked::in_workspace(checked, &view.arm, first, frame));
        checked.drawn_arms().for_each(|q| block_arm(placer, q));
        checked.contacts().iter().for_each(|&[x, y]| placer.block_spot(frame.at(x, y), MARKER_HALF_WIDTH));
    }
    items
}

/// Draws moving obstacles at their current poses. In a still picture, also draws their trajectories, dashed.
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

/// Returns the names of the arm's poses and of the obstacles. Many obstacles have numbers instead.
fn names(view: &View, frame: &Frame) -> Vec<Named> {
    let arm = |name: &str, q: [f64; 2]| {
        let [tip, elbow] = [view.arm.tip_at(q.into()), view.arm.elbow_at(q[0])].map(|p| frame.at(p.x, p.y));
        let shapes = arm::placed_shapes(&view.arm, view.first_world().payload.as_ref(), q.into());
        Named::of_pieces(name.to_owned(), labels::label_box_beyond(name, tip, elbow), frame, &shapes)
    };
    // An arm that does not move needs no name.
    let ends = view.still.end.filter(|_| view.still.line.is_none());
    let ends = ends.map(|(q, _)| [arm("goal", q), arm("start", view.start)]);
    let arms = ends.into_iter().flatten();
    let world = view.first_world();
    let lying = world.obstacles.iter().enumerate().filter(|(_, obstacle)| obstacle.lies());
    let obstacles = lying.map(|(number, o)| Named::of_shape(world.called(number), frame, &o.outline, o.own()));
    // A moving obstacle may begin outside the picture. Then its name is where it enters.
    let end = view.duration().filter(|_| view.still.now.is_none());
    let movers = world.movers.iter().map(|mover| {
        let now = mover.at(view.still.time);
        let later = end.map_or_else(Vec::new, |end| mover.moments(end)).into_iter().map(|time| mover.at(time));
        std::iter::once(now.clone()).chain(later).find(|o| is_inside(frame, o)).unwrap_or(now)
    });
    let movers = movers.map(|o| Named::of_shape(o.name.clone(), frame, &o.outline, o.own()));
    arms.chain(obstacles).chain(movers).collect()
}

/// Returns the outlines of the walls, which names avoid.
fn walls<'a>(view: &'a View, frame: &'a Frame) -> impl Iterator<Item = Vec<Step>> + 'a {
    let lying = view.first_world().obstacles.iter().filter(|obstacle| obstacle.lies());
    lying.filter_map(|obstacle| match &obstacle.outline {
        Shape::Polyline(points) => Some(chain(points.iter().map(|p| frame.at(p.x, p.y)), false)),
        _ => None,
    })
}

/// Draws a dot where each step ends, or should end if it fails. Returns the places with the numbers of the steps.
fn step_ends(view: &View, frame: &Frame, items: &mut Vec<Item>) -> Vec<Tag> {
    let mut tags = Vec::new();
    for (q, number, reached) in view.still.panels.iter().flat_map(|panel| view.ends(panel)) {
        let tip = view.arm.tip_at(q);
        let spot = frame.at(tip.x, tip.y);
        let (line, fill) = if reached { (Style::line(WHITE, 1.2), INK) } else { (Style::line(INFEASIBLE, 1.4), WHITE) };
        items.push(Item::Disc(spot, STEP_END_RADIUS, line.filled(fill)));
        tags::add(&mut tags, spot, number);
    }
    tags.sort_by_key(|tag| tag.numbers.first().copied());
    tags
}

/// Returns true if a part of the obstacle lies inside the panel.
fn is_inside(frame: &Frame, obstacle: &ObstacleView) -> bool {
    let [x, y] = bounding_box(obstacle.own());
    x.1 >= frame.x.0 && x.0 <= frame.x.1 && y.1 >= frame.y.0 && y.0 <= frame.y.1
}

/// Returns a note if obstacles lie outside the panel.
fn hidden_note<'a>(
    frame: &Frame,
    obstacles: impl Iterator<Item = &'a ObstacleView>,
    placer: &mut Placer,
) -> Option<Item> {
    let text = match obstacles.filter(|obstacle| !is_inside(frame, obstacle)).count() {
        0 => return None,
        1 => "1 obstacle lies outside this picture".to_owned(),
        n => format!("{n} obstacles lie outside this picture"),
    };
    let at = [frame.rect.x + 10.0, frame.rect.bottom() - 10.0];
    placer.block_box(Rect { x: at[0], y: at[1] - 13.0, width: text_width(&text, 13.0), height: 18.0 });
    Some(label(at, text, 13.0, Anchor::Start, GRAY))
}

/// Draws the lowest layer: grid and reach.
fn ground(frame: &Frame, arm: &Arm) -> Vec<Item> {
    let mut items = frame.grid([Unit::Meters; 2]);
    let reach = Style::line(PALE, 1.0).dashed(&[2.0, 4.0]);
    items.push(Item::Outline(shapes::outline(frame, &reach_shape(arm)), reach));
    items
}

/// Returns the path of the tip. Straight motions in joint space are curves here, and are drawn in small steps.
pub fn tip_trace(frame: &Frame, arm: &Arm, path: &PathView) -> Vec<Step> {
    /// Step in radians. A chord then deviates from its arc by at most 2e-5 of the reach, which is a hundredth of a pixel.
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
