//! Drawings of a comparison for pages. Large ones show all paths, and a page can light up each of them; small ones come in parts.

use super::arm::{self, GOAL_LOOK, START_LOOK};
use super::axes::Frame;
use super::chart::Chart;
use super::figure::{Figure, Item, Rect, Style};
use super::view::{View, WorldView};
use super::{cspace, shapes, svg_writer, workspace};
use cplan_theme::{INK, Rgb, WHITE};

/// Width and height of a large drawing, in pixels. A page shows two side by side, or one below the other.
const LARGE_SIZE: [f64; 2] = [520.0, 380.0];
/// Room around a large drawing's panel for the values and titles of the axes: left, above, right, below.
const LARGE_MARGINS: [f64; 4] = [64.0, 6.0, 14.0, 48.0];
/// Width and height of a small drawing, in pixels.
const SMALL_SIZE: [f64; 2] = [120.0, 100.0];
/// Margin of a small drawing, in pixels.
const SMALL_MARGIN: f64 = 1.0;

/// Drawings of the paths of a comparison. Their colours are variables of the page's style sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedPaths {
    /// Workspace and configuration space. Elements of path `k` have the attribute `data-path` with the value `k`.
    pub large: [String; 2],
    /// Small drawings of workspace and configuration space.
    pub small: [SmallPicture; 2],
    /// Colours, on a light background, without a name in the style sheet. The variable of `#rrggbb` is `--xrrggbb`.
    pub colors: Vec<Rgb>,
}

/// The parts of a small drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct SmallPicture {
    /// Width and height, in pixels.
    pub size: [f64; 2],
    /// Everything below the paths, as SVG elements.
    pub ground: String,
    /// Data of each path, for an SVG element `path`.
    pub paths: Vec<String>,
    /// Everything above the paths, as SVG elements.
    pub markers: String,
}

/// Draws a comparison. `id` distinguishes the names in its drawings from those in other drawings of the page. The paths with the
/// indices `top` lie above the others. `None` if the view has no configuration space.
pub fn compared(view: &View, id: &str, top: &[usize]) -> Option<ComparedPaths> {
    let mut view = view.clone();
    view.still.lights_paths = true;
    view.still.top_paths = top.to_vec();
    let panel = view.still.panels.first()?;
    let [left, top, right, bottom] = LARGE_MARGINS;
    let [width, height] = [LARGE_SIZE[0] - left - right, LARGE_SIZE[1] - top - bottom];
    let area = Rect { x: left, y: top, width, height };
    let large = [workspace::panel(&view, area), cspace::panel(&view, panel, area)];
    let (mut colors, mut numbers) = (Vec::new(), 0..);
    let large = large.map(|items| {
        let figure = Figure { width: LARGE_SIZE[0], height: LARGE_SIZE[1], items, is_dark: false };
        svg_writer::write_for_page(&figure, &format!("{id}-{}", numbers.next().unwrap_or_default()), &mut colors)
    });
    let small = [small_workspace(&view, &mut colors), small_cspace(&view, &mut colors)];
    Some(ComparedPaths { large, small, colors })
}

fn small_area() -> Rect {
    let [width, height] = SMALL_SIZE.map(|side| side - 2.0 * SMALL_MARGIN);
    Rect { x: SMALL_MARGIN, y: SMALL_MARGIN, width, height }
}

fn small_workspace(view: &View, colors: &mut Vec<Rgb>) -> SmallPicture {
    let [x, y] = view.frame;
    let frame = Frame::filling(small_area(), x.into(), y.into());
    let world = view.first_world();
    let mut ground: Vec<Item> = world
        .obstacles
        .iter()
        .filter(|obstacle| obstacle.lies())
        .map(|obstacle| shapes::solid(&frame, obstacle))
        .collect();
    let goal = view.still.end.map(|(q, _)| (q, &GOAL_LOOK));
    for (q, look) in [(view.start, &START_LOOK)].into_iter().chain(goal) {
        ground.extend(arm::items(&frame, &view.arm, None, q.into(), &look.thin()));
    }
    let paths = view.paths.iter().map(|path| svg_writer::commands(&workspace::tip_trace(&frame, &view.arm, path)));
    let [ground, markers] = [&ground[..], &[]].map(|items| svg_writer::elements(items, colors));
    SmallPicture { size: SMALL_SIZE, ground, paths: paths.collect(), markers }
}

fn small_cspace(view: &View, colors: &mut Vec<Rgb>) -> SmallPicture {
    // The picture is as wide as the joint space, with no room beside it.
    let Rect { width, height, .. } = Chart::new(&view.arm, small_area()).frame.rect;
    let chart = Chart::new(&view.arm, Rect { width, height, ..small_area() });
    let worlds: [&WorldView; 1] = [view.first_world()];
    let mut ground = cspace::c_obstacles(&worlds, &chart);
    ground.extend(chart.frame.sides([false; 2]));
    let ring = Item::Disc(chart.place(view.start.into()), 3.6, Style::line(INK, 1.6).filled(WHITE));
    let goals = view.goals.iter().map(|&q| Item::Disc(chart.place(q.into()), 3.6, Style::line(WHITE, 1.0).filled(INK)));
    let markers: Vec<Item> = goals.chain([ring]).collect();
    let paths = view.paths.iter().map(|path| svg_writer::commands(&chart.outline(&path.points.0))).collect();
    let [ground, markers] = [ground, markers].map(|items| svg_writer::elements(&items, colors));
    SmallPicture { size: [width, height].map(|side| side + 2.0 * SMALL_MARGIN), ground, paths, markers }
}
