//! The strip below the picture of a motion along a line. A lens shows the place where the tip is farthest from the line. Two
//! plots show the speed of the tip and its distance from the line against time.

use super::view::{LENS_TOLERANCES, color};
use super::{FollowedMotion, LineView};
use crate::axes::{Frame, Range, Unit};
use crate::figure::{Anchor, Item, Pen, Rect, Step, Style, bold, chain, label, lines, rectangle};
use crate::view::View;
use cplan_text::{chosen_length, length};
use cplan_theme::{ACCENT, FAINT, GHOST, GRAY, INK, WHITE};
use cplan_toolpath::Curve;

/// Height of the strip with its headings and its axes, in pixels.
pub const HEIGHT: f64 = 318.0;
/// Room for headings above the parts, in pixels.
const HEADING: f64 = 28.0;
/// Width and height of the lens, in pixels.
const LENS: f64 = 224.0;
/// Room to the left of the plots for values and titles of the axes, in pixels.
const LEFT: f64 = 104.0;
/// Heights of the plots of speed and distance, and the room between them, in pixels.
const SPEED: f64 = 118.0;
const BETWEEN: f64 = 18.0;
const DISTANCE: f64 = 88.0;
/// Room above the greatest value of a plot, as a share of this value.
const ROOM: f64 = 0.12;
/// Number of chords for a curve in the lens, and number of points between two samples of the motion.
const LENS_CHORDS: u32 = 32;
const LENS_POINTS: u32 = 12;
/// Greatest number of points of the path that the lens shows on each side of its middle.
const MAX_LENS_POINTS: usize = 20_000;

/// Draws the strip at the top of an area. Draws nothing without a motion.
pub fn items(line: &LineView, view: &View, area: Rect) -> Vec<Item> {
    let Some((motion, _)) = &line.motion else { return Vec::new() };
    let top = area.y + HEADING;
    let mut items = lens(line, motion, view, Rect { y: top, width: LENS, height: LENS, ..area });
    let left = area.x + LENS + LEFT;
    let plot = Rect { x: left, y: top, width: area.right() - left, height: SPEED };
    items.extend(speed_plot(motion, plot));
    let below = Rect { y: top + SPEED + BETWEEN, height: DISTANCE, ..plot };
    items.extend(distance_plot(motion, line.tolerance, below));
    items
}

/// Returns the frame of a plot over the time of the motion.
fn frame(motion: &FollowedMotion, rect: Rect, y: Range) -> Frame {
    Frame { rect, x: (0.0, motion.speeds.last().map_or(1.0, |last| last[0])), y }
}

fn heading(rect: Rect, text: &str) -> Item {
    bold([rect.x + rect.width / 2.0, rect.y - 10.0], text, 15.0, Anchor::Middle, INK)
}

fn speed_plot(motion: &FollowedMotion, rect: Rect) -> Vec<Item> {
    let greatest = motion.speeds.iter().map(|point| point[1]).fold(f64::MIN_POSITIVE, f64::max);
    let frame = frame(motion, rect, (0.0, (1.0 + ROOM) * greatest));
    let units = [Unit::Seconds, Unit::Meters];
    let mut inside = frame.grid(units);
    let parts = motion.stretches.iter().map(|stretch| {
        let points = within(&motion.speeds, stretch.from, stretch.to);
        let steps = chain(points.into_iter().map(|[time, speed]| frame.at(time, speed)), false);
        (steps, Pen { color: color(stretch.limit), width: 2.4, dash: &[] })
    });
    inside.extend(parts.map(|(steps, pen)| Item::Outline(steps, Style { pen: Some(pen), ..Style::line(INK, 1.0) })));
    let mut items =
        vec![Item::Clip(rect, inside), heading(rect, "Speed of the tip, coloured by the limit that it reaches")];
    items.extend(frame.sides([false; 2]));
    items.extend(frame.tick_marks(units, [false, true]));
    let [_, title] = frame.titles(rect, units, ["".to_owned(), "m/s".to_owned()]);
    items.push(title);
    items
}

/// Returns the points of a plot between two times. Both ends are interpolated.
fn within(points: &[[f64; 2]], from: f64, to: f64) -> Vec<[f64; 2]> {
    let value = |time: f64| {
        let next = points.partition_point(|point| point[0] < time).clamp(1, points.len().max(2) - 1);
        let [a, b] = [points[next - 1], points[next.min(points.len() - 1)]];
        let part = ((time - a[0]) / (b[0] - a[0]).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        [time, a[1] + (b[1] - a[1]) * part]
    };
    let inner = points.iter().filter(|point| from < point[0] && point[0] < to);
    std::iter::once(value(from)).chain(inner.copied()).chain([value(to)]).collect()
}

fn distance_plot(motion: &FollowedMotion, tolerance: f64, rect: Rect) -> Vec<Item> {
    let greatest = (1.0 + 2.0 * ROOM) * tolerance * 1e3;
    let frame = frame(motion, rect, (-greatest, greatest));
    let units = [Unit::Seconds, Unit::Meters];
    let tube = [(0.0, tolerance), (frame.x.1, -tolerance)].map(|(time, value)| frame.at(time, 1e3 * value));
    let tube = Rect { x: tube[0][0], y: tube[0][1], width: rect.width, height: tube[1][1] - tube[0][1] };
    let mut inside = vec![Item::Outline(rectangle(rect), Style::fill(FAINT))];
    inside.push(Item::Outline(rectangle(tube), Style::fill(WHITE)));
    let count = motion.deviations.len() as f64;
    let place = |(i, value): (usize, f64)| frame.at((i as f64 + 0.5) / count * frame.x.1, 1e3 * value);
    let upper = motion.deviations.iter().map(|ends| ends[1]).enumerate();
    let lower = motion.deviations.iter().map(|ends| ends[0]).enumerate().rev();
    inside.push(Item::Outline(chain(upper.chain(lower).map(place), true), Style::line(ACCENT, 1.0).filled(ACCENT)));
    let [x, y] = frame.at(motion.farthest.time, 1e3 * motion.farthest.offset);
    let mark = Rect { x: x - 5.0, y: y - 5.0, width: 10.0, height: 10.0 };
    inside.push(Item::Outline(rectangle(mark), Style::line(INK, 1.6)));
    let mut items = vec![Item::Clip(rect, inside)];
    let titles = ["time (s)", "off the line (mm)"].map(str::to_owned);
    items.extend(frame.border(units, titles, [false; 2]));
    items
}

/// Draws the lens: the line, a tube around it whose radius is the tolerance, and the path of the tip.
fn lens(line: &LineView, motion: &FollowedMotion, view: &View, rect: Rect) -> Vec<Item> {
    let radius = LENS_TOLERANCES * line.tolerance;
    let center = motion.farthest.tip;
    let frame =
        Frame { rect, x: (center[0] - radius, center[0] + radius), y: (center[1] - radius, center[1] + radius) };
    let spots = |points: Vec<[f64; 2]>| chain(points.into_iter().map(|p| frame.at(p[0], p[1])), false);
    let parts: Vec<Vec<Step>> =
        line.curves.iter().filter_map(|curve| near_part(curve, center, 2.0 * radius)).map(spots).collect();
    let tube = 2.0 * line.tolerance * frame.scale();
    let mut inside: Vec<Item> =
        parts.iter().map(|part| Item::Outline(part.clone(), Style::line(GHOST, tube))).collect();
    inside.extend(parts.into_iter().map(|part| Item::Outline(part, Style::line(GRAY, 1.2).dashed(&[6.0, 4.0]))));
    let path = tip_near(line, view, motion.farthest.time, 2.0 * radius);
    inside.extend(lines([(spots(path), Pen { color: INK, width: 2.2, dash: &[] })]));
    inside.push(Item::Disc(frame.at(center[0], center[1]), 4.5, Style::line(WHITE, 1.2).filled(ACCENT)));
    inside.extend(scale_bar(&frame));
    let below = [rect.x + rect.width / 2.0, rect.bottom() + 19.0];
    let text = format!(
        "{} off at {:.2} s; tube: \u{b1} {}",
        length(motion.farthest.offset.abs()),
        motion.farthest.time,
        chosen_length(line.tolerance)
    );
    vec![
        Item::Clip(rect, inside),
        Item::Outline(rectangle(rect), Style::line(INK, 1.2)),
        heading(rect, "Greatest deviation from the line, magnified"),
        label(below, text, 13.0, Anchor::Middle, GRAY),
    ]
}

/// Draws a scale bar and its length, which is a round number.
fn scale_bar(frame: &Frame) -> Vec<Item> {
    let room = 0.4 * (frame.x.1 - frame.x.0);
    let power = 10_f64.powf(room.log10().floor());
    let size = [5.0, 2.0, 1.0].into_iter().map(|m| m * power).find(|size| *size <= room).unwrap_or(power);
    let (x, y, width) = (frame.rect.x + 12.0, frame.rect.bottom() - 12.0, size * frame.scale());
    let steps = vec![
        Step::Move([x, y - 4.0]),
        Step::Line([x, y]),
        Step::Line([x + width, y]),
        Step::Line([x + width, y - 4.0]),
    ];
    vec![
        Item::Outline(steps, Style::line(INK, 1.4)),
        label([x + width + 7.0, y + 1.0], chosen_length(size), 13.0, Anchor::Start, INK),
    ]
}

/// Returns the part of a curve within `distance` of a point, as chords. `None` if the curve is farther away.
fn near_part(curve: &Curve, center: [f64; 2], distance: f64) -> Option<Vec<[f64; 2]>> {
    let foot = curve.nearest(center, 0.0);
    let at = curve.at(foot);
    if (at[0] - center[0]).hypot(at[1] - center[1]) > distance {
        return None;
    }
    let half = (1.5 * distance / curve.length()).min(1.0);
    let (from, to) = ((foot - half).max(0.0), (foot + half).min(1.0));
    let point = |k: u32| curve.at(from + (to - from) * f64::from(k) / f64::from(LENS_CHORDS));
    Some((0..=LENS_CHORDS).map(point).collect())
}

/// Returns the path of the tip before and after a time, as long as it is within `distance` of its position at that time.
fn tip_near(line: &LineView, view: &View, time: f64, distance: f64) -> Vec<[f64; 2]> {
    let Some((motion, _)) = &line.motion else { return Vec::new() };
    let tip = |q| -> [f64; 2] { view.arm.tip_at(q).into() };
    let center = tip(motion.played.at(time));
    let is_near = |p: &[f64; 2]| (p[0] - center[0]).hypot(p[1] - center[1]) <= distance;
    let before: Vec<_> =
        motion.played.before(time, LENS_POINTS).map(tip).take_while(is_near).take(MAX_LENS_POINTS).collect();
    let after = motion.played.after(time, LENS_POINTS).map(tip).take_while(is_near).take(MAX_LENS_POINTS);
    before.into_iter().rev().chain([center]).chain(after).collect()
}
