//! A panel with a configuration space.

use super::axes::Frame;
use super::chart::{self, Chart};
use super::figure::{Item, Pen, Rect, Step, Style, lines, lines_by_path};
use super::shapes::ABSENT_DASH;
use super::view::{ContourView, NameView, PanelView, View, WorldView};
use super::{blocking, boxes, checked, labels, preferences, reach, tags, trace};
use cplan_theme::{ACCENT, INK, Rgb, WHITE};

/// Pen for goals along a segment.
const GOAL_SEGMENT_PEN: Pen = Pen { color: INK, width: 2.0, dash: &[1.5, 3.5] };

/// Width of the markers of start and goals, in pixels.
const MARKER_WIDTH: f64 = 16.0;

/// Draws the panel in this part of the page, with room for a scale of colours to the right of it.
#[must_use]
pub fn panel(view: &View, panel: &PanelView, area: Rect) -> Vec<Item> {
    let chart = Chart::new(&view.arm, area);
    let mut items = self::items(view, panel, &chart);
    items.extend(chart.frame.tick_marks(chart.units, [true; 2]));
    items.extend(chart.frame.titles(chart.frame.rect, chart.units, chart::titles(&view.arm)));
    items
}

/// Draws everything except values and titles of the axes.
#[must_use]
pub fn items(view: &View, panel: &PanelView, chart: &Chart) -> Vec<Item> {
    let frame = &chart.frame;
    let worlds: Vec<&WorldView> = panel.worlds.iter().map(|&index| &view.worlds[index]).collect();
    let paths = panel.paths.iter().map(|&index| &view.paths[index]);
    let world = worlds[0];
    let mut inside = frame.grid(chart.units);
    inside.extend(world.trace.iter().flat_map(|trace| trace::items_below_obstacles(trace, chart)));
    inside.extend(c_obstacles(&worlds, chart));
    inside.extend(moving_obstacle_items(view, world, chart));
    inside.extend(
        world.trace.iter().flat_map(|trace| trace::items_above_obstacles(trace, view.still.field_lines, chart)),
    );
    inside.extend(view.still.reach.iter().flat_map(|reach| reach::in_cspace(reach, chart)));
    inside.extend(preferences::in_cspace(&world.regions, chart));
    inside.extend(boxes::proof(&world.proof, frame));
    let blocking = view.still.stuck.iter().filter_map(|blocking| Some(blocking.at?.0));
    let marked = view.ends(panel).into_iter().map(|(q, ..)| q).chain([panel.start.into()]).chain(blocking);
    let markers = marked.map(|q| labels::centered_rect(chart.place(q), [MARKER_WIDTH; 2])).collect();
    inside.extend(names(world, frame, markers));
    inside.extend(lines(view.goal_lines.iter().map(|goals| (chart.outline(&goals.0), GOAL_SEGMENT_PEN))));
    let outlines = paths.map(|path| (chart.outline(&path.points.0), path.pen()));
    inside.extend(if view.still.lights_paths { lines_by_path(outlines) } else { lines(outlines) });
    inside.extend(world.trace.iter().flat_map(|trace| trace::items_above_path(trace, chart)));
    let mut items = vec![Item::Clip(frame.rect, inside)];
    items.extend(frame.sides(chart.seams()));
    items.extend(world.scale.iter().flat_map(|scale| trace::color_bar(scale, &frame.rect)));
    // If there are paths, the marker of a goal that no path reached is hollow.
    let mut numbers = Vec::new();
    for (q, number, reached) in view.ends(panel) {
        items.extend(goal_marker(chart.place(q), reached));
        tags::add(&mut numbers, chart.place(q), number);
    }
    items.extend(start_marker(chart.place(panel.start.into())));
    if let Some((q, world)) = view.still.now
        && panel.worlds.contains(&world)
    {
        items.push(Item::Disc(chart.place(q.into()), 4.8, Style::line(WHITE, 1.2).filled(ACCENT)));
    }
    items.extend(view.still.stuck.iter().flat_map(|blocking| blocking::in_cspace(blocking, chart)));
    items.extend(view.still.checked.iter().filter_map(|checked| checked::in_cspace(checked, chart)));
    if view.is_task() && numbers.len() > 1 {
        items.extend(tags::items(&numbers, frame.rect, &[], &[]));
    }
    items
}

/// Draws the C-obstacles. If link 2 may reach into an obstacle in one of the worlds, some part of its C-obstacle is
/// free there. That part is dashed.
#[must_use]
pub fn c_obstacles(worlds: &[&WorldView], chart: &Chart) -> Vec<Item> {
    let (mut dashed, mut solid) = (Vec::new(), Vec::new());
    for (number, obstacle) in worlds[0].obstacles.iter().enumerate() {
        let open = |world: &&&WorldView| world.open.iter().any(|c| c.obstacle == number);
        let world = worlds.iter().find(open).unwrap_or(&worlds[0]);
        let of = |contours| <[_]>::iter(contours).filter(|c: &&ContourView| c.obstacle == number);
        dashed.push(chart.c_obstacle(of(&world.open), passable(obstacle.color)));
        solid.push(chart.c_obstacle(of(&world.c_obstacles), c_obstacle_style(obstacle.color)));
    }
    dashed.extend(solid);
    dashed
}

/// Draws the C-obstacles of moving obstacles at the current time. A still picture also shows them, dashed, at each stop
/// of their trajectories.
fn moving_obstacle_items(view: &View, world: &WorldView, chart: &Chart) -> Vec<Item> {
    let mut items = Vec::new();
    for (number, mover) in world.movers.iter().enumerate() {
        let mut draw = |time: f64, style: fn(Rgb) -> Style| {
            let contours = world.moment(time).into_iter().flat_map(|moment| &moment.c_obstacles);
            items.push(chart.c_obstacle(contours.filter(|c| c.obstacle == number), style(mover.obstacle.color)));
        };
        if let (None, Some(duration)) = (view.still.now, view.duration()) {
            mover.moments(duration).into_iter().for_each(|time| draw(time, passable));
        }
        draw(view.still.time, c_obstacle_style);
    }
    items
}

/// Draws the names of obstacles within their C-obstacles, or numbers if there are many obstacles.
fn names(world: &WorldView, frame: &Frame, markers: Vec<Rect>) -> Vec<Item> {
    let room = frame.rect.width * frame.rect.height;
    let name = |name: &NameView| (world.called(name.obstacle), frame.at(name.at[0], name.at[1]), name.area * room);
    labels::shape_labels(&frame.rect, markers, world.names.iter().map(name))
}

/// Returns the style of a C-obstacle.
fn c_obstacle_style(color: Rgb) -> Style {
    let style = Style::line(color.darker(0.25), 2.0).filled(color.lighter(0.35)).faded(0.85);
    Style { pen_below: true, ..style }
}

/// Returns the style of the C-obstacle of an obstacle that link 2 may reach into.
fn passable(color: Rgb) -> Style {
    let style = Style::line(color.darker(0.25), 2.6).dashed(ABSENT_DASH).filled(color.lighter(0.85)).faded(0.85);
    Style { pen_below: true, ..style }
}

/// Draws the start of a motion: a ring, which leaves room for the arm's current configuration.
#[must_use]
pub fn start_marker(at: [f64; 2]) -> Vec<Item> {
    vec![Item::Disc(at, 9.5, Style::fill(WHITE).faded(0.85)), Item::Disc(at, 7.0, Style::line(INK, 2.2).filled(WHITE))]
}

/// Draws the goal of a motion: a diamond, hollow if no path ended there.
#[must_use]
pub fn goal_marker([x, y]: [f64; 2], reached: bool) -> Vec<Item> {
    let diamond = |r: f64| {
        vec![
            Step::Move([x, y - r]),
            Step::Line([x + r, y]),
            Step::Line([x, y + r]),
            Step::Line([x - r, y]),
            Step::Close,
        ]
    };
    let inside = if reached { INK } else { WHITE };
    vec![
        Item::Outline(diamond(10.5), Style::fill(WHITE).faded(0.85)),
        Item::Outline(diamond(7.0), Style::line(INK, 1.6).filled(inside)),
    ]
}
