//! A panel that shows a configuration space.

use super::chart::{self, Chart};
use super::checked::{self, CheckedView};
use super::figure::{Item, Pen, Rect, Step, Style, lines, lines_by_path};
use super::labels::{NamedRegion, Placer};
use super::shapes::ABSENT_DASH;
use super::view::{ContourView, MAX_NAMED_OBSTACLES, PanelView, View, WorldView};
use super::{blocking, boxes, followed, preferences, tags, trace};
use cplan_theme::{ACCENT, INK, Rgb, WHITE};

/// Pen of goals that are segments.
const GOAL_SEGMENT_PEN: Pen = Pen { color: INK, width: 2.0, dash: &[1.5, 3.5] };

/// Size of the markers on the image of a line that the tip follows. The image is often small.
const SMALL_MARKER: f64 = 0.7;

/// Half the width of the markers of starts and goals, in pixels.
const MARKER_HALF_WIDTH: f64 = 10.0;

/// Draws the panel in this part of the page. To its right, the page has room for a scale of colours.
pub fn panel(view: &View, panel: &PanelView, area: Rect) -> Vec<Item> {
    let chart = Chart::new(&view.arm, area);
    let mut items = self::items(view, panel, &chart);
    items.extend(chart.frame.tick_marks(chart.units, [true; 2]));
    items.extend(chart.frame.titles(chart.frame.rect, chart.units, chart::titles(&view.arm)));
    items
}

/// Draws everything except values and titles of the axes.
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
    inside.extend(view.still.sections.iter().flat_map(|section| section.in_cspace(chart)));
    inside.extend(preferences::in_cspace(&world.regions, chart));
    inside.extend(boxes::proof(&world.proof, frame));
    inside.extend(lines(view.goal_lines.iter().map(|goals| (chart.outline(&goals.0), GOAL_SEGMENT_PEN))));
    let paths: Vec<_> = paths.map(|path| (chart.outline(&path.points.0), path.pen())).collect();
    let names = names(view, panel, chart, &paths);
    inside.extend(if view.still.lights_paths { lines_by_path(paths, &view.still.top_paths) } else { lines(paths) });
    inside.extend(view.still.line.iter().flat_map(|line| followed::in_cspace(line, chart)));
    inside.extend(world.trace.iter().flat_map(|trace| trace::items_above_path(trace, chart)));
    let mut items = vec![Item::Clip(frame.rect, inside)];
    items.extend(frame.sides(chart.seams()));
    items.extend(world.scale.iter().flat_map(|scale| trace::color_bar(scale, &frame.rect)));
    let size = marker_size(panel) * if view.still.line.is_some() { SMALL_MARKER } else { 1.0 };
    // If there are paths, a goal that none of them reached has a hollow marker.
    for (q, _, reached) in view.ends(panel) {
        items.extend(goal_marker(chart.place(q), reached, size));
    }
    // Crosses mark the configurations where a line cannot be followed.
    let has_start = view.still.line.as_ref().is_none_or(|line| line.motion.is_some());
    items.extend(panel.starts.iter().filter(|_| has_start).flat_map(|&q| start_marker(chart.place(q.into()), size)));
    if let Some((q, world)) = view.still.now
        && panel.worlds.contains(&world)
    {
        items.push(Item::Disc(chart.place(q.into()), 4.8, Style::line(WHITE, 1.2).filled(ACCENT)));
    }
    items.extend(view.still.stuck.iter().flat_map(|blocking| blocking::in_cspace(blocking, chart)));
    items.extend(view.still.checked.iter().filter_map(|checked| checked::in_cspace(checked, chart)));
    items.extend(names);
    items
}

/// Draws the C-obstacles. If link 2 may reach into an obstacle in one of the worlds, the part of the C-obstacle that is free in
/// that world is dashed.
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

/// Draws the C-obstacles of moving obstacles at the current time. A still picture also shows them, dashed, at each stop of the
/// obstacles.
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

/// Draws the numbers of steps beside the places where the steps end, and the names of obstacles on the visible parts of their
/// C-obstacles (numbers if there are many obstacles). Names dodge `paths`, the outlines of the paths.
fn names(view: &View, panel: &PanelView, chart: &Chart, paths: &[(Vec<Step>, Pen)]) -> Vec<Item> {
    let (world, mut placer) = (&view.worlds[panel.worlds[0]], Placer::new(chart.frame.rect));
    let (ends, mut tags) = (view.ends(panel), Vec::new());
    let blocking = view.still.stuck.iter().filter_map(|blocking| Some(blocking.at?.0));
    let starts = panel.starts.iter().map(|&q| q.into());
    let current = view.still.now.filter(|(_, world)| panel.worlds.contains(world)).map(|(q, _)| q.into());
    let checked = view.still.checked.iter().flat_map(CheckedView::drawn_arms);
    let marked = ends.iter().map(|(q, ..)| *q).chain(starts).chain(blocking).chain(current).chain(checked);
    let half_width = MARKER_HALF_WIDTH * marker_size(panel);
    marked.for_each(|q| placer.block_spot(chart.place(q), half_width));
    paths.iter().for_each(|(steps, _)| placer.block_line(steps));
    view.goal_lines.iter().for_each(|goals| placer.block_line(&chart.outline(&goals.0)));
    if view.is_task() {
        ends.iter().for_each(|(q, number, _)| tags::add(&mut tags, chart.place(*q), *number));
        if tags.len() > 1 {
            placer.beside(&tags::names(&tags, half_width));
        }
    }
    let visible = (0..world.obstacles.len()).filter_map(|number| {
        let own = world.c_obstacles.iter().filter(|c| c.obstacle == number);
        let Item::Outline(outline, _) = chart.c_obstacle(own, Style::fill(WHITE)) else { return None };
        (!outline.is_empty()).then_some((number, outline))
    });
    let visible: Vec<_> = visible.collect();
    let is_crowded = visible.len() > MAX_NAMED_OBSTACLES;
    let regions = visible.into_iter().filter_map(|(number, outline)| {
        // Numbers of obstacles would look like those of steps.
        let text = if is_crowded { world.called(number) } else { world.obstacles[number].name.clone() };
        (!is_crowded || !view.is_task()).then_some(NamedRegion { text, outline })
    });
    // A moving obstacle may begin out of reach. Then its name is where it first comes within reach.
    let end = view.duration().filter(|_| view.still.now.is_none());
    let moving = world.movers.iter().enumerate().filter_map(|(number, mover)| {
        let later = end.map_or_else(Vec::new, |end| mover.moments(end));
        let outline = std::iter::once(view.still.time).chain(later).find_map(|time| {
            let own = world.moment(time)?.c_obstacles.iter().filter(|c| c.obstacle == number);
            let Item::Outline(outline, _) = chart.c_obstacle(own, Style::fill(WHITE)) else { return None };
            (!outline.is_empty()).then_some(outline)
        });
        Some(NamedRegion { text: mover.obstacle.name.clone(), outline: outline? })
    });
    if let Some(line) = &view.still.line {
        placer.beside(&followed::solution_names(line, chart));
    }
    placer.on_regions(&regions.chain(moving).collect::<Vec<_>>());
    placer.into_items()
}

fn c_obstacle_style(color: Rgb) -> Style {
    let style = Style::line(color.darker(0.25), 2.0).filled(color.lighter(0.35)).faded(0.85);
    Style { pen_below: true, ..style }
}

/// Returns the style of the C-obstacle of an obstacle into which link 2 may reach.
fn passable(color: Rgb) -> Style {
    let style = Style::line(color.darker(0.25), 2.6).dashed(ABSENT_DASH).filled(color.lighter(0.85)).faded(0.85);
    Style { pen_below: true, ..style }
}

/// Returns the size of the markers in a panel: smaller if the panel has many paths.
fn marker_size(panel: &PanelView) -> f64 {
    match panel.paths.len() {
        0..=3 => 1.0,
        4..=8 => 0.8,
        _ => 0.62,
    }
}

/// Draws the start of a motion: a ring, within which the arm's current configuration stays visible.
pub fn start_marker(at: [f64; 2], size: f64) -> Vec<Item> {
    let ring = Style::line(INK, 2.2 * size.sqrt()).filled(WHITE);
    vec![Item::Disc(at, 9.5 * size, Style::fill(WHITE).faded(0.85)), Item::Disc(at, 7.0 * size, ring)]
}

/// Draws the goal of a motion: a diamond, hollow unless a path ends there.
pub fn goal_marker([x, y]: [f64; 2], reached: bool, size: f64) -> Vec<Item> {
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
        Item::Outline(diamond(10.5 * size), Style::fill(WHITE).faded(0.85)),
        Item::Outline(diamond(7.0 * size), Style::line(INK, 1.6).filled(inside)),
    ]
}
