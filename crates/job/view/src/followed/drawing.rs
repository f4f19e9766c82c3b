//! Pictures of a line that the tip follows: in the workspace and in the configuration space.

use super::LineView;
use super::view::{MoveMark, color};
use crate::arm::{self, GHOST_LOOK, UNREACHED_LOOK};
use crate::axes::{Frame, span};
use crate::blocking::cross;
use crate::chart::Chart;
use crate::figure::{Item, Pen, Rect, Step, Style, chain, lines, rectangle};
use crate::key::{Key, Sign};
use crate::named::Named;
use crate::shapes;
use crate::view::{View, reach_shape};
use cplan_geometry::Point;
use cplan_model::space::Configuration;
use cplan_theme::{GHOST, GRAY, INFEASIBLE, INK, PALE, WHITE};

/// Width of a followed line below the path of the tip, and width of that path, in pixels.
const WIDTH: f64 = 7.0;
const TRACE_WIDTH: f64 = 3.0;

/// Pens of the images of the line in joint space.
const FREE_PEN: Pen = Pen { color: GRAY, width: 2.2, dash: &[] };
const EXCLUDED_PEN: Pen = Pen { color: INFEASIBLE, width: 2.2, dash: &[5.0, 3.0] };

/// Greatest number of consecutive points of a path that a drawing may skip.
const MAX_SKIPPED: usize = 200;

/// Largest detail of a path that may be lost in a drawing, in pixels.
const MAX_CHORD: f64 = 1.0;

/// Half the width of the square that marks what the lens shows, in pixels.
const LENS_MARK: f64 = 7.0;

/// Size of the overview as a share of the workspace's panel, and its distance from the panel's sides in pixels.
const OVERVIEW_SHARE: f64 = 0.3;
const OVERVIEW_GAP: f64 = 10.0;

/// Returns the width of the line, which is wide if the path of the tip lies on it.
fn width(line: &LineView) -> f64 {
    if line.marked.is_some() { TRACE_WIDTH } else { WIDTH }
}

/// Draws the line in the workspace.
pub fn in_workspace(line: &LineView, frame: &Frame) -> Vec<Item> {
    let color = if line.motion.is_some() { GHOST } else { GRAY };
    let steps = |stroke: &Vec<Point>| chain(stroke.iter().map(|p| frame.at(p.x, p.y)), false);
    let strokes = line.strokes.iter().map(|stroke| Item::Outline(steps(stroke), Style::line(color, width(line))));
    let marked = line.marked.iter().flatten();
    let marked = marked.map(|(mark, points)| Item::Outline(steps(points), Style::line(mark.look().0, TRACE_WIDTH)));
    strokes.chain(marked).collect()
}

/// Returns the path of a point that moves with the arm, in stretches. Each stretch has the colour of the limit that the motion
/// reaches there.
fn by_limit(line: &LineView, place: impl Fn(&[Configuration]) -> Vec<Step>) -> Vec<(Vec<Step>, Pen)> {
    let Some((motion, _)) = &line.motion else { return Vec::new() };
    let path = |from: f64, to: f64| place(&motion.played.between(from, to));
    let pen = |limit| Pen { color: color(limit), width: TRACE_WIDTH, dash: &[] };
    motion.stretches.iter().map(|stretch| (path(stretch.from, stretch.to), pen(stretch.limit))).collect()
}

/// Draws the path of the tip in the colours of the limits that the motion reaches, the stops of the motion, and the square around
/// the lens.
pub fn tip_path(line: &LineView, view: &View, frame: &Frame) -> Vec<Item> {
    let spot = |q: &Configuration| {
        let tip = view.arm.tip_at(*q);
        frame.at(tip.x, tip.y)
    };
    let mut items = lines(by_limit(line, |path| straightened(path.iter().map(spot))));
    let Some((motion, _)) = &line.motion else { return items };
    let stop = |time: &f64| Item::Disc(spot(&motion.played.at(*time)), 3.0, Style::line(INK, 1.4).filled(WHITE));
    items.extend(motion.stops.iter().map(stop));
    let [x, y] = frame.at(motion.farthest.tip[0], motion.farthest.tip[1]);
    let mark = Rect { x: x - LENS_MARK, y: y - LENS_MARK, width: 2.0 * LENS_MARK, height: 2.0 * LENS_MARK };
    items.push(Item::Outline(rectangle(mark), Style::line(INK, 1.6)));
    items
}

/// Returns the outline of a path on the page, without invisible details.
fn straightened(spots: impl Iterator<Item = [f64; 2]>) -> Vec<Step> {
    let spots: Vec<Configuration> = spots.map(Configuration::from).collect();
    chain(thinned(&spots, 1.0).into_iter().map(Into::into), false)
}

/// Omits points within a tenth of `unit` of the line between their neighbours.
fn thinned(points: &[Configuration], unit: f64) -> Vec<Configuration> {
    let mut kept: Vec<Configuration> = points.first().copied().into_iter().collect();
    let mut from = 0;
    for to in 2..points.len() {
        let (a, b) = (points[from], points[to]);
        let along = (b - a) / (b - a).norm().max(f64::MIN_POSITIVE);
        let is_off = |p: &Configuration| cplan_geometry::cross(along, p - a).abs() > 0.1 * unit;
        if to - from > MAX_SKIPPED || points[from + 1..to].iter().any(is_off) {
            from = to - 1;
            kept.push(points[from]);
        }
    }
    kept.extend(points.last().filter(|_| points.len() > 1));
    kept
}

/// Draws, above everything else, the place where no motion is possible.
pub fn place(line: &LineView, frame: &Frame) -> Vec<Item> {
    line.place.map_or_else(Vec::new, |at| cross(frame.at(at.x, at.y)))
}

/// Returns the arms to draw: the arm where the tip is farthest from the line, and the other IK solution there. If no motion is
/// possible, returns the excluded IK solutions.
pub fn arms(line: &LineView, view: &View, frame: &Frame) -> Vec<Item> {
    let payload = view.first_world().payload.as_ref();
    let excluded = line.excluded.iter().flat_map(|&q| arm::items(frame, &view.arm, payload, q, &UNREACHED_LOOK));
    let mut items: Vec<Item> = excluded.collect();
    if let Some(pose) = line.pose {
        if let Some((other, is_excluded)) = line.other {
            let look = if is_excluded { &UNREACHED_LOOK } else { &GHOST_LOOK };
            items.extend(arm::items(frame, &view.arm, payload, other, look));
        }
        items.extend(arm::items(frame, &view.arm, payload, pose, &arm::CURRENT_LOOK));
    }
    items
}

/// Draws the whole workspace, with the arm and the magnified part, in a corner of a magnified workspace. Also returns its place.
pub fn overview(line: &LineView, view: &View, panel: &Frame) -> Option<(Rect, Vec<Item>)> {
    let focus = line.focus?;
    let size = OVERVIEW_SHARE * panel.rect.width.min(panel.rect.height);
    let [x, y] = focus.corner;
    let rect = Rect {
        x: if x > 0.0 { panel.rect.right() - OVERVIEW_GAP - size } else { panel.rect.x + OVERVIEW_GAP },
        y: if y > 0.0 { panel.rect.y + OVERVIEW_GAP } else { panel.rect.bottom() - OVERVIEW_GAP - size },
        width: size,
        height: size,
    };
    let [across, up] = view.frame;
    let frame = Frame::filling(rect, across.into(), up.into());
    let mut inside = vec![Item::Outline(rectangle(rect), Style::fill(WHITE))];
    let reach = Style::line(PALE, 1.0).dashed(&[2.0, 4.0]);
    inside.push(Item::Outline(shapes::outline(&frame, &reach_shape(&view.arm)), reach));
    inside.extend(view.world_now().obstacles.iter().map(|obstacle| shapes::solid(&frame, obstacle)));
    let payload = view.first_world().payload.as_ref();
    if let Some(pose) = line.pose {
        if let Some((other, is_excluded)) = line.other {
            let look = if is_excluded { UNREACHED_LOOK.thin() } else { GHOST_LOOK.thin() };
            inside.extend(arm::items(&frame, &view.arm, payload, other, &look));
        }
        inside.extend(arm::items(&frame, &view.arm, payload, pose, &arm::CURRENT_LOOK.thin()));
    }
    let [left, top] = frame.at(panel.x.0, panel.y.1);
    let [right, bottom] = frame.at(panel.x.1, panel.y.0);
    let part = Rect { x: left, y: top, width: right - left, height: bottom - top };
    inside.push(Item::Outline(rectangle(part), Style::line(INK, 1.4)));
    let border = Item::Outline(rectangle(rect), Style::line(GRAY, 1.0));
    Some((rect, vec![Item::Clip(rect, inside), border]))
}

/// Draws the images of the line under both IK solutions, the motion coloured by the limits that it reaches, and the
/// excluded configurations.
pub fn in_cspace(line: &LineView, chart: &Chart) -> Vec<Item> {
    let images = line
        .solutions
        .iter()
        .map(|part| (chart.outline(&part.points), if part.is_excluded { EXCLUDED_PEN } else { FREE_PEN }));
    let mut items = lines(images);
    let path = |path: &[Configuration]| chart.outline(&thinned(path, MAX_CHORD / chart.frame.scale()));
    items.extend(lines(by_limit(line, path)));
    items.extend(line.excluded.iter().flat_map(|&q| cross(chart.place(q))));
    items
}

/// Returns the names of the IK solutions, at the images of the line in the configuration space.
pub fn solution_names(line: &LineView, chart: &Chart) -> Vec<Named> {
    (0..2)
        .filter_map(|solution| {
            let own = line.solutions.iter().filter(|part| part.solution == solution);
            let parts: Vec<Vec<[f64; 2]>> =
                own.map(|part| part.points.iter().map(|q| chart.place(*q)).collect()).collect();
            let [(x, right), (y, bottom)] = [0, 1].map(|k| span(parts.iter().flatten().map(|spot| spot[k])));
            let rect = Rect { x, y, width: right - x, height: bottom - y };
            let is_empty = parts.iter().all(Vec::is_empty);
            (!is_empty).then(|| Named::of_lines(line.solution_name(solution), rect, &parts))
        })
        .collect()
}

/// Returns the legend of the line.
pub fn keys(line: &LineView) -> Vec<Key> {
    let pen = |color, width| Sign::Line(Pen { color, width, dash: &[] });
    let color = if line.motion.is_some() { GHOST } else { GRAY };
    let name = if line.marked.is_some() { "drawing moves" } else { "line to follow" };
    let mut keys = vec![(pen(color, width(line)), name.to_owned())];
    let is_marked = |mark: &MoveMark| line.marked.iter().flatten().any(|(own, _)| own == mark);
    let marks = MoveMark::ALL.into_iter().filter(is_marked).map(MoveMark::look);
    keys.extend(marks.map(|(color, name)| (pen(color, TRACE_WIDTH), name.to_owned())));
    keys.extend(line.limits().into_iter().map(|(_, name, color)| (pen(color, TRACE_WIDTH), name)));
    if line.place.is_some() {
        keys.push((pen(INFEASIBLE, 2.6), "x: the tip cannot follow the line here".to_owned()));
    }
    keys
}

/// Returns the legend of the images of the line in the configuration space.
pub fn solution_keys(line: &LineView) -> Vec<Key> {
    let kinds = [(false, FREE_PEN, "IK solution of the line"), (true, EXCLUDED_PEN, "excluded IK solution")];
    let exists = |excluded: bool| line.solutions.iter().any(|part| part.is_excluded == excluded);
    let shown = kinds.into_iter().filter(|(excluded, ..)| exists(*excluded));
    shown.map(|(_, pen, text)| (Sign::Line(pen), text.to_owned())).collect()
}
