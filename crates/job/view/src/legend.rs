//! The legend: the signs of a picture and their meanings.

use super::Object;
use super::figure::{Anchor, Item, Pen, Rect, Step, Style, label, rectangle, shortened, text_width};
use super::flow::FieldLines;
use super::key::{Key, Layered, Sign, document};
use super::section::Section;
use super::view::{MAX_NAMED_OBSTACLES, ObstacleView, PathView, TraceView, View};
use super::{blocking, boxes, channel, checked, cspace, followed, preferences, shapes, trace};
use cplan_theme::{GRAY, INFEASIBLE, INK, PALE};

/// Height of a row, in pixels.
pub const ROW_HEIGHT: f64 = 21.0;
const TEXT_SIZE: f64 = 13.0;
const SIGN_WIDTH: f64 = 26.0;
const KEY_GAP: f64 = 26.0;

/// Returns all signs of a picture with their meaning.
pub fn keys(view: &View) -> Vec<Key> {
    layered_keys(view, true).into_iter().map(|(key, _)| key).collect()
}

/// Returns the legend of a page. A page shows one world at a time, and fewer items than a picture does.
pub fn on_pages(view: &View) -> Vec<Object> {
    let mut keys: Vec<(Layered, bool)> = layered_keys(view, false).into_iter().map(|key| (key, false)).collect();
    for key in view.traces_of_steps().flat_map(|seen| of_trace(seen, FieldLines::default())).map(|key| (key, true)) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys.into_iter().map(|(key, think)| document(key, think)).collect()
}

/// Returns the legend of a planner's trace.
fn of_trace(seen: &TraceView, lines: FieldLines) -> Vec<Layered> {
    let layers: &[&str] = match seen {
        TraceView::Roadmap { .. } => &["roadmap"],
        TraceView::Slices { .. } => &["rows"],
        TraceView::Channel { .. } => &["channel", "cells", "expanded"],
        TraceView::Roads { .. } => &["roads", "expanded"],
        TraceView::Boxes { .. } => &["boxes"],
        TraceView::Wavefront(_) => &["wavefront"],
        TraceView::Field { .. } => &["equipotentials", "flow"],
    };
    trace::keys(seen, lines).into_iter().map(|key| (key, layers)).collect()
}

fn layered_keys(view: &View, still: bool) -> Vec<Layered> {
    let world = view.first_world();
    let goal = if view.is_task() { "end of a step" } else { "goal" };
    let always = |key: Key| -> Layered { (key, &[]) };
    let named = view.still.sections.iter().find_map(|section| section.start);
    let start = match (named, view.moves()) {
        (Some(name), _) => Some(name),
        (None, true) => Some("start"),
        // No configuration of an arm alone is of interest.
        (None, false) => (view.frames.is_empty() && view.still.line.is_none()).then_some("configuration"),
    };
    let mut keys: Vec<Layered> = start.map(|start| always((Sign::Start, start.to_owned()))).into_iter().collect();
    if view.moves() && named.is_none() {
        keys.push(always((Sign::Goal, goal.to_owned())));
    }
    if view.still.line.is_none() {
        keys.extend(paths(view).into_iter().map(|key| -> Layered { (key, &["path", "trace"]) }));
    }
    if still && view.worlds.iter().any(|world| !world.open.is_empty()) {
        keys.push(always((Sign::Dashed(GRAY), "open to link 2 (picked or placed)".to_owned())));
    }
    if view.unreached().next().is_some() {
        keys.push(always((Sign::Unreached, "not reached".to_owned())));
        let pen = Pen { color: INFEASIBLE, width: 1.2, dash: &[] };
        keys.push(((Sign::Line(pen), "the arm there".to_owned()), &["poses"]));
    }
    let lines = if still { view.still.field_lines } else { FieldLines::default() };
    keys.extend(world.trace.as_ref().map_or_else(Vec::new, |seen| of_trace(seen, lines)));
    let proof = view.worlds.iter().any(|world| !world.proof.0.is_empty());
    keys.extend(proof.then(|| -> Layered { (boxes::proof_key(), &["proof"]) }));
    keys.extend(preferences::keys(&world.regions).into_iter().map(|key| -> Layered { (key, &["regions"]) }));
    keys.extend(view.still.sections.iter().flat_map(Section::keys));
    if let Some(line) = &view.still.line {
        keys.extend(followed::keys(line).into_iter().map(|key| -> Layered { (key, &["path"]) }));
        keys.extend(followed::solution_keys(line).into_iter().map(|key| -> Layered { (key, &["solutions"]) }));
    }
    keys.extend(view.still.stuck.as_ref().map_or_else(Vec::new, blocking::keys).into_iter().map(always));
    keys.extend(view.still.checked.as_ref().map_or_else(Vec::new, checked::keys).into_iter().map(always));
    keys.push(always((Sign::Line(Pen { color: PALE, width: 1.0, dash: &[2.0, 4.0] }), "reach".to_owned())));
    keys.extend(obstacles(world.obstacles.iter().filter(|obstacle| obstacle.lies())).into_iter().map(always));
    let movers: Vec<ObstacleView> = world.movers.iter().map(|mover| mover.at(0.0)).collect();
    keys.extend(obstacles(movers.iter()).into_iter().map(|(sign, name)| always((sign, format!("{name}, moving")))));
    let payload = world.payload.iter().map(|held| (Sign::Swatch(held.color), format!("{}, carried", held.object)));
    keys.extend(payload.map(always));
    keys
}

/// Returns the legend of the obstacles by colour. Empty if there are too many obstacles.
pub fn obstacles<'a>(shown: impl Iterator<Item = &'a ObstacleView> + Clone) -> Vec<Key> {
    let count = shown.clone().count();
    shown.filter(|_| count <= MAX_NAMED_OBSTACLES).map(|o| (Sign::Swatch(o.color), o.name.clone())).collect()
}

/// Returns the legend of the paths by name. For a task, it has one entry for paths with a payload and one for those without.
fn paths(view: &View) -> Vec<Key> {
    let named = |path: &PathView, name: &str| (Sign::Line(path.pen()), name.to_owned());
    if view.is_task() {
        let kinds = [(false, "empty-handed"), (true, "carrying (object's colour)")];
        let first = |carrying| view.paths.iter().find(|path| path.is_colored() == carrying);
        return kinds.into_iter().filter_map(|(carrying, name)| Some(named(first(carrying)?, name))).collect();
    }
    match &view.paths[..] {
        [path] => vec![named(path, "path, and trace of the tip")],
        paths => paths.iter().map(|path| named(path, &path.name)).collect(),
    }
}

fn width(key: &Key) -> f64 {
    SIGN_WIDTH + 8.0 + text_width(&key.1, TEXT_SIZE)
}

/// Breaks the keys into rows of this width.
pub fn layout(keys: Vec<Key>, room: f64) -> Vec<Vec<Key>> {
    let mut rows: Vec<Vec<Key>> = vec![Vec::new()];
    let mut used = 0.0;
    for (sign, name) in keys {
        // Names of paths include the options of planners, so they get more room.
        let share = if let Sign::Line(_) = sign { 3.0 } else { 5.0 };
        let key = (sign, shortened(&name, TEXT_SIZE, room / share));
        let needed = width(&key) + KEY_GAP;
        let last = rows.len() - 1;
        if used + needed > room && !rows[last].is_empty() {
            rows.push(vec![key]);
            used = needed;
        } else {
            rows[last].push(key);
            used += needed;
        }
    }
    rows
}

/// Draws the rows, centred about `middle`, from `top` downwards.
pub fn items(rows: &[Vec<Key>], middle: f64, top: f64) -> Vec<Item> {
    let mut items = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        let total = row.iter().map(|k| width(k) + KEY_GAP).sum::<f64>() - KEY_GAP;
        let (mut x, y) = (middle - total / 2.0, top + ROW_HEIGHT * (i as f64 + 0.5));
        for key in row {
            items.extend(sign(&key.0, x, y));
            let at = [x + SIGN_WIDTH + 8.0, y + 4.5];
            items.push(label(at, &key.1, TEXT_SIZE, Anchor::Start, INK));
            x += width(key) + KEY_GAP;
        }
    }
    items
}

fn sign(sign: &Sign, x: f64, y: f64) -> Vec<Item> {
    match sign {
        Sign::Start => cspace::start_marker([x + SIGN_WIDTH - 9.0, y], 1.0),
        Sign::Goal => cspace::goal_marker([x + SIGN_WIDTH - 9.0, y], true, 1.0),
        Sign::Unreached => cspace::goal_marker([x + SIGN_WIDTH - 9.0, y], false, 1.0),
        Sign::Line(pen) => {
            let style = Style { pen: Some(*pen), ..Style::line(pen.color, pen.width) };
            vec![Item::Outline(vec![Step::Move([x, y]), Step::Line([x + SIGN_WIDTH, y])], style)]
        }
        Sign::Shade(part) => self::sign(&Sign::Swatch(cplan_theme::scale(*part)), x, y),
        Sign::Swatch(color) => {
            let style = Style::line(color.darker(0.25), 1.0).filled(color.lighter(0.25));
            vec![Item::Outline(rectangle(swatch(x, y)), style)]
        }
        Sign::Dashed(color) => {
            vec![Item::Outline(rectangle(swatch(x, y)), Style::line(*color, 1.4).dashed(shapes::ABSENT_DASH))]
        }
        Sign::Hatched => boxes::hatched(&[swatch(x, y)]),
        Sign::Contact => vec![checked::contact_marker([x + SIGN_WIDTH - 8.0, y])],
        Sign::Point { middle } => vec![channel::sign([x + SIGN_WIDTH - 8.0, y], *middle)],
    }
}

fn swatch(x: f64, y: f64) -> Rect {
    Rect { x: x + SIGN_WIDTH - 16.0, y: y - 6.0, width: 16.0, height: 12.0 }
}
