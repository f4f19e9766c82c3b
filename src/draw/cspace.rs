//! The right panel: the configuration space.

use super::chart::{self, Chart};
use super::color::{self, INK, Rgb, WHITE};
use super::figure::{Item, Pen, Rect, Spot, Step, Style};
use super::{Picture, boxes, page, preferences, trace};
use crate::space::Path;

/// The pen for goals along a segment.
const GOALS: Pen = Pen { color: INK, width: 2.0, dash: &[1.5, 3.5] };

/// The panel in this part of the page, with room for a scale of colours to the right of it.
#[must_use]
pub fn panel(picture: &Picture, area: Rect) -> Vec<Item> {
    let chart = Chart::new(picture.scene.arm(), area);
    let Chart { frame, units, topology, paths, .. } = chart;

    let mut inside = frame.grid(units);
    inside.extend(picture.trace.into_iter().flat_map(|t| trace::below(t, &frame, &paths)));
    for index in 0..picture.scene.workspace().obstacles.len() {
        let contours = picture.c_obstacles.iter().filter(|c| c.obstacle == index);
        inside.push(chart.c_obstacle(contours, blocked(color::obstacle(index))));
    }
    inside.extend(picture.trace.into_iter().flat_map(|t| trace::above(t, &frame, &topology, &paths)));
    inside.extend(preferences::in_cspace(&picture.scene.workspace().preferences, &frame, &paths));
    if let Some(proof) = picture.proof {
        inside.push(boxes::proof(proof.stuck(), &frame));
    }
    let segments = picture.goals.iter().filter(|goal| !goal.is_point());
    inside.extend(page::lines(segments.map(|goals| (chart.outline(&Path::new(goals.ends().to_vec())), GOALS))));
    inside.extend(page::path_items(picture.paths.iter().map(|(_, path)| chart.outline(path)).collect()));
    let mut items = vec![Item::Clip(frame.rect, inside)];
    items.extend(frame.border(units, chart::titles(picture.scene.arm()), chart.seams()));
    items.extend(picture.trace.into_iter().flat_map(|t| trace::color_bar(t, &frame)));
    // Where paths were found, the goals that none of them reached are hollow.
    let reached: Vec<Spot> = picture.paths.iter().map(|(_, path)| chart.place(path.goal())).collect();
    items
        .extend(picture.single_goals().into_iter().flat_map(|q| goal_marker(chart.place(q), picture.paths.is_empty())));
    items.extend(reached.into_iter().flat_map(|spot| goal_marker(spot, true)));
    items.extend(start_marker(chart.place(picture.start)));
    items
}

/// How a C-obstacle is drawn.
#[must_use]
pub fn blocked(color: Rgb) -> Style {
    let style = Style::line(color.darker(0.25), 2.0).filled(color.lighter(0.35)).faded(0.85);
    Style { pen_below: true, ..style }
}

/// Where the motion begins: a ring.
#[must_use]
pub fn start_marker(at: Spot) -> Vec<Item> {
    vec![Item::Disc(at, 8.0, Style::fill(WHITE).faded(0.85)), Item::Disc(at, 5.5, Style::line(INK, 2.2).filled(WHITE))]
}

/// Where it ends: a diamond, hollow if no path ended there.
#[must_use]
pub fn goal_marker([x, y]: Spot, reached: bool) -> Vec<Item> {
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
