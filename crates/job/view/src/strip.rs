//! The strip below a picture among moving obstacles: progress along the motion against time. Regions that an obstacle blocks have
//! its colour; the motion passes between them.

use super::axes::{Frame, Unit};
use super::figure::{Anchor, Item, Pen, Rect, Step, Style, bold, chain, label, lines};
use super::labels::{NamedRegion, Placer};
use super::named::Named;
use super::view::{StripView, View};
use cplan_model::space::Configuration;
use cplan_theme::{ACCENT, GRAY, INK, Rgb};

/// Height of the strip with its heading and its axes, in pixels.
pub const HEIGHT: f64 = 226.0;
/// Room above the strip for its heading, in pixels.
const HEADING_HEIGHT: f64 = 26.0;
/// Room below the strip for values and the title of its axis, in pixels.
const AXIS_HEIGHT: f64 = 52.0;
/// Least height of a region, in pixels.
const LEAST_HEIGHT: f64 = 10.0;
/// Pen of the motion.
const MOTION_PEN: Pen = Pen { color: INK, width: 2.4, dash: &[] };
/// Pen of the motion while it waits.
const WAIT_PEN: Pen = Pen { color: ACCENT, width: 4.0, dash: &[] };

/// Returns the outline of a region. A region too low to be seen is drawn higher; it grows towards the side on which the motion
/// does not pass.
fn visible(strip: &StripView, frame: &Frame, corners: &[Configuration]) -> Vec<Step> {
    let begin = corners.iter().map(|q| q[0]).fold(f64::INFINITY, f64::min);
    let [low, high] = [f64::min, f64::max].map(|pick| corners.iter().map(|q| q[1]).reduce(pick).unwrap_or_default());
    let missing = (LEAST_HEIGHT / frame.rect.height - (high - low)).max(0.0);
    // The motion only advances. If it is beyond the region when the region begins, it stays beyond it.
    let passed = strip.motion.0.iter().take_while(|q| q[0] <= begin).last().is_some_and(|q| q[1] > high);
    let middle = f64::midpoint(low, high);
    let shifted = |q: &Configuration| {
        let by = match (passed, q[1] > middle) {
            (true, false) => -missing,
            (false, true) => missing,
            _ => 0.0,
        };
        frame.at(q[0], q[1] + by)
    };
    chain(corners.iter().map(shifted), true)
}

/// Draws the strip into a part of the page, [`HEIGHT`] pixels high.
pub fn items(strip: &StripView, view: &View, area: Rect) -> Vec<Item> {
    let rect = Rect { y: area.y + HEADING_HEIGHT, height: HEIGHT - HEADING_HEIGHT - AXIS_HEIGHT, ..area };
    let frame = Frame { rect, x: (0.0, strip.duration), y: (0.0, 1.0) };
    let units = [Unit::Seconds, Unit::Percent];
    let mut placer = Placer::new(rect);
    let mut inside = frame.grid(units);
    let surface = |color: Rgb| Style::line(color.darker(0.25), 1.2).filled(color.lighter(0.35)).faded(0.85);
    let outline = |corners: &[Configuration], closed: bool| chain(corners.iter().map(|q| frame.at(q[0], q[1])), closed);
    let regions: Vec<NamedRegion> = strip
        .obstacles
        .iter()
        .map(|obstacle| NamedRegion {
            text: format!("{} blocks", obstacle.name),
            outline: obstacle.regions.iter().flat_map(|region| visible(strip, &frame, &region.0)).collect(),
        })
        .collect();
    inside.extend(
        regions
            .iter()
            .zip(&strip.obstacles)
            .map(|(region, obstacle)| Item::Outline(region.outline.clone(), surface(obstacle.color))),
    );
    let motion = outline(&strip.motion.0, false);
    placer.block_line(&motion);
    let waits = strip
        .waits
        .iter()
        .map(|wait| vec![Step::Move(frame.at(wait.from, wait.at)), Step::Line(frame.at(wait.to, wait.at))]);
    inside.extend(lines(std::iter::once((motion, MOTION_PEN)).chain(waits.map(|steps| (steps, WAIT_PEN)))));
    if view.still.now.is_some() {
        let time = view.still.time;
        let steps = vec![Step::Move(frame.at(time, 0.0)), Step::Line(frame.at(time, 1.0))];
        inside.push(Item::Outline(steps, Style::line(ACCENT, 1.5)));
    }
    let words: Vec<_> = strip
        .waits
        .iter()
        .map(|wait| {
            let ([x, y], [right, _]) = (frame.at(wait.from, wait.at), frame.at(wait.to, wait.at));
            Named::of_box(wait.text.clone(), Rect { x, y: y - 2.0, width: right - x, height: 4.0 })
        })
        .collect();
    placer.beside_among(&words, &regions);
    placer.on_bars(&regions);
    inside.extend(placer.into_items());
    let mut items = vec![Item::Clip(rect, inside)];
    items.extend(frame.border(units, ["time (s)", "progress"].map(str::to_owned), [false; 2]));
    let heading = "Times at which moving obstacles block the motion";
    items.push(bold([rect.x + rect.width / 2.0, rect.y - 10.0], heading, 15.0, Anchor::Middle, INK));
    if strip.obstacles.is_empty() {
        let middle = [rect.x + rect.width / 2.0, rect.y + rect.height / 2.0];
        items.push(label(middle, "no moving obstacle comes near the motion", 13.0, Anchor::Middle, GRAY));
    }
    items
}
