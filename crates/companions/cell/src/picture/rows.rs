//! The rows of time below a picture: the motion of each arm with its steps and waits, handovers, and signals.

use super::motions::ShownMotions;
use super::objects::ShownObject;
use super::{ARM_COLORS, Answer};
use crate::StepTimes;
use cplan_theme::{FAINT, GRAY, INK, Rgb};
use cplan_view::figure::{Anchor, Item, Rect, Step, Style, chain, label, rectangle, shortened, text_width};
use cplan_view::{Frame, Unit};

/// Heights of the row of an arm, and of that of a handover or a signal, pixels.
const HEIGHTS: [f64; 2] = [30.0, 22.0];

/// Height of the bar of an arm, pixels.
const BAR_HEIGHT: f64 = 20.0;

/// Sizes of the names of rows and of the texts in bars, pixels.
const TEXT_SIZES: [f64; 2] = [14.0, 12.0];

/// Room beside the text in a bar, pixels.
const TEXT_MARGIN: f64 = 6.0;

/// Room, pixels, from which a text is shortened instead of omitted.
const MIN_TEXT_WIDTH: f64 = 40.0;

/// Distance between the lines of a hatched bar, pixels.
const HATCH_DISTANCE: f64 = 6.0;

/// Returns the height of the rows, pixels.
pub fn height(motions: &ShownMotions) -> f64 {
    2.0 * HEIGHTS[0] + HEIGHTS[1] * (motions.handovers.len() + motions.signals.len()) as f64
}

/// The rows of an answer.
struct Rows<'a> {
    answer: &'a Answer<'a>,
    motions: &'a ShownMotions<'a>,
    objects: &'a [ShownObject<'a>],
    rect: Rect,
    frame: Frame,
}

impl Answer<'_> {
    /// Draws a row for each arm, and one for each handover and each signal, in a rectangle of the width of `rect`.
    pub(super) fn rows(&self, motions: &ShownMotions, objects: &[ShownObject], rect: Rect) -> Vec<Item> {
        let rect = Rect { height: height(motions), ..rect };
        let frame = Frame::fitted(rect, (0.0, motions.duration.max(1e-3)), (0.0, 1.0), false);
        let rows = Rows { answer: self, motions, objects, rect, frame };
        let mut items: Vec<Item> = [0, 1].into_iter().flat_map(|arm| rows.of_arm(arm)).collect();
        let names = self.names();
        for (number, times) in motions.handovers.iter().enumerate() {
            let [giver, taker] = [times.giver, 1 - times.giver].map(|arm| names[arm]);
            let text = format!("{giver} hands \"{}\" over to {taker}", times.object);
            let row = (2 + number, format!("handover {}", number + 1), text);
            items.extend(rows.link(row, times.giver, [times.placed, times.taken]));
        }
        for (number, signal) in motions.signals.iter().enumerate() {
            let [waits, sets] = [signal.waits, 1 - signal.waits].map(|arm| names[arm]);
            let text = format!("{waits} waits for signal {}, which {sets} sets", number + 1);
            let row = (2 + motions.handovers.len() + number, format!("signal {}", number + 1), text);
            items.extend(rows.link(row, 1 - signal.waits, [signal.set, signal.at]));
        }
        items.extend(frame.sides([false; 2]));
        items.extend(frame.tick_marks([Unit::Seconds; 2], [true, false]));
        items.push(label([rect.right(), rect.bottom() + 40.0], "time (s)", TEXT_SIZES[0], Anchor::End, INK));
        items
    }
}

impl Rows<'_> {
    fn x(&self, time: f64) -> f64 {
        self.frame.at(time, 0.0)[0]
    }

    /// Returns the height of the middle of a row on the page.
    fn middle(&self, row: usize) -> f64 {
        let [arm, other] = HEIGHTS;
        self.rect.y + if row < 2 { arm * (row as f64 + 0.5) } else { 2.0 * arm + other * (row as f64 - 1.5) }
    }

    fn name(&self, row: usize, text: &str, color: Rgb) -> Item {
        label([self.rect.x - 12.0, self.middle(row) + 5.0], text, TEXT_SIZES[0], Anchor::End, color)
    }

    fn bar(&self, arm: usize, [from, to]: [f64; 2]) -> Rect {
        let (x, y) = (self.x(from), self.middle(arm) - BAR_HEIGHT / 2.0);
        Rect { x, y, width: self.x(to) - x, height: BAR_HEIGHT }
    }

    /// Draws the motion of an arm: a bar for each step, or a single one, and its waits, hatched.
    fn of_arm(&self, arm: usize) -> Vec<Item> {
        let (name, color) = (self.answer.names()[arm], ARM_COLORS[arm]);
        let mut items = Vec::new();
        if self.motions.steps[arm].is_empty() {
            let bar = rectangle(self.bar(arm, [0.0, self.motions.trajectories[arm].duration()]));
            items.push(Item::Outline(bar, Style::fill(color.lighter(0.35))));
        }
        items.extend(self.motions.steps[arm].iter().map(|step| self.step(arm, step)));
        for wait in self.motions.waits[arm] {
            let text = format!("{name} waits from {:.3} s to {:.3} s", wait.from, wait.to);
            items.push(Item::Titled(text, hatched(self.bar(arm, [wait.from, wait.to]), color)));
        }
        items.push(self.name(arm, name, color));
        items
    }

    /// Draws a step: pale before a grasp, in the colour of the object while it is carried, with a mark at the grasp or release.
    fn step(&self, arm: usize, step: &StepTimes) -> Item {
        let about = self.objects.iter().find(|object| step.object.as_deref() == Some(object.name()));
        let color = about.map_or(ARM_COLORS[arm], ShownObject::color);
        let paleness = if about.is_some() && step.released.is_none() { 0.88 } else { 0.55 };
        let bar = self.bar(arm, [step.begin, step.end]);
        let style = Style::line(color.darker(0.2), 1.0).filled(color.lighter(paleness));
        let mut items = vec![Item::Outline(rectangle(bar), style)];
        items.extend(step.event.map(|time| {
            let corners = [[-3.0, 0.0], [0.0, -5.0], [3.0, 0.0]].map(|[x, y]| [self.x(time) + x, bar.bottom() + y]);
            Item::Outline(chain(corners, true), Style::fill(INK))
        }));
        // The text is in the widest part between the waits.
        let waits = self.motions.waits[arm].iter().flat_map(|wait| [wait.from, wait.to]);
        let mut ends: Vec<f64> = waits.filter(|time| step.begin < *time && *time < step.end).collect();
        ends.extend([step.begin, step.end]);
        ends.sort_by(f64::total_cmp);
        let is_wait =
            |ends: &&[f64]| self.motions.waits[arm].iter().any(|wait| wait.from <= ends[0] && ends[1] <= wait.to);
        let parts = ends.windows(2).filter(|ends| !is_wait(ends));
        let widest = parts.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
        if let Some(&[from, to]) = widest {
            let (words, room) = (words(step), self.x(to) - self.x(from) - 2.0 * TEXT_MARGIN);
            let text = shortened(&words, TEXT_SIZES[1], room);
            let at = [self.x(from) + TEXT_MARGIN, self.middle(arm) + 4.0];
            let text = label(at, text, TEXT_SIZES[1], Anchor::Start, INK);
            items.extend((room >= MIN_TEXT_WIDTH.min(text_width(&words, TEXT_SIZES[1]))).then_some(text));
        }
        let done = step.event.map_or_else(String::new, |time| format!(", at {time:.3} s"));
        let name = self.answer.names()[arm];
        Item::Titled(format!("{name}, step {}: {}{done}", step.number, step.action), items)
    }

    /// Draws a row about two arms: a line from a time of the first arm to a time of the second arm, with a disc for each arm.
    fn link(&self, (row, name, text): (usize, String, String), first: usize, times: [f64; 2]) -> [Item; 2] {
        let [from, to] = times.map(|time| [self.x(time), self.middle(row)]);
        let drawn = vec![
            Item::Outline(chain([from, to], false), Style::line(INK, 1.4)),
            Item::Disc(from, 3.5, Style::fill(ARM_COLORS[first])),
            Item::Disc(to, 5.0, Style::line(INK, 1.2).filled(ARM_COLORS[1 - first])),
        ];
        [Item::Titled(text, drawn), self.name(row, &name, GRAY)]
    }
}

/// Describes a step in a few words.
fn words(step: &StepTimes) -> String {
    match (&step.object, step.action.split_once(' ')) {
        (Some(object), Some((verb, _))) => format!("{verb} {object}"),
        _ => step.action.clone(),
    }
}

/// Draws a hatched bar.
fn hatched(bar: Rect, color: Rgb) -> Vec<Item> {
    let count = ((bar.width + bar.height) / HATCH_DISTANCE) as usize;
    let lines = (0..=count).flat_map(|k| {
        let x = bar.x + HATCH_DISTANCE * k as f64;
        [Step::Move([x - bar.height, bar.bottom()]), Step::Line([x, bar.y])]
    });
    let lines = Item::Outline(lines.collect(), Style::line(GRAY, 1.2));
    let around = Item::Outline(rectangle(bar), Style::line(color, 1.0));
    vec![Item::Outline(rectangle(bar), Style::fill(FAINT)), Item::Clip(bar, vec![lines]), around]
}
