//! Coordinate frames: they map values to places on the page, and draw ticks.

use super::figure::{Anchor, Item, Rect, Step, Style, label as text, upwards};
use cplan_theme::{FAINT, GRAY, INK, PALE};

/// Lower and upper value along an axis.
pub type Range = (f64, f64);

/// Unit of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Metres.
    Meters,
    /// Radians, written in degrees with the degree sign.
    Degrees,
    /// Seconds.
    Seconds,
    /// Fractions, written in per cent.
    Percent,
}

/// A rectangle of the page with values along its sides; `y` increases upwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Rectangle on the page.
    pub rect: Rect,
    /// Values along the lower side.
    pub x: Range,
    /// Values along the left side.
    pub y: Range,
}

/// Returns the least and the greatest value.
pub fn span(values: impl IntoIterator<Item = f64>) -> Range {
    let all = (f64::INFINITY, f64::NEG_INFINITY);
    values.into_iter().fold(all, |(least, greatest), value| (least.min(value), greatest.max(value)))
}

/// Returns a finite range of positive length. Widens a range that is too short about its middle, and replaces one that is not
/// finite.
fn sound((lower, upper): Range) -> Range {
    if !(lower.is_finite() && upper.is_finite()) {
        return (-1.0, 1.0);
    }
    // A millimetre, or a twentieth of a degree. Shorter ranges would only lengthen the labels.
    let least = f64::max(1e-3, 1e-9 * lower.abs().max(upper.abs()));
    if upper - lower >= least { (lower, upper) } else { (lower - least / 2.0, lower + least / 2.0) }
}

impl Frame {
    /// Returns the largest frame in `area` that shows exactly these ranges. If `equal_scale`, both axes have the same scale, and
    /// the frame is at the top of the area, in the middle horizontally.
    pub fn fitted(area: Rect, x: Range, y: Range, equal_scale: bool) -> Self {
        let (x, y) = (sound(x), sound(y));
        let mut rect = area;
        if equal_scale {
            let scale = (area.width / (x.1 - x.0)).min(area.height / (y.1 - y.0));
            rect.width = (x.1 - x.0) * scale;
            rect.height = (y.1 - y.0) * scale;
            rect.x += (area.width - rect.width) / 2.0;
        }
        Self { rect, x, y }
    }

    /// Returns a frame that fills `area`, has the same scale along both axes, and shows at least these ranges.
    pub fn filling(area: Rect, x: Range, y: Range) -> Self {
        let (x, y) = (sound(x), sound(y));
        let scale = (area.width / (x.1 - x.0)).min(area.height / (y.1 - y.0));
        let about = |(lower, upper): Range, length: f64| {
            let (middle, half) = ((lower + upper) / 2.0, length / scale / 2.0);
            (middle - half, middle + half)
        };
        Self { rect: area, x: about(x, area.width), y: about(y, area.height) }
    }

    /// Returns the place of the point `(x, y)` on the page.
    pub fn at(&self, x: f64, y: f64) -> [f64; 2] {
        let Rect { width, height, .. } = self.rect;
        [
            self.rect.x + (x - self.x.0) / (self.x.1 - self.x.0) * width,
            self.rect.bottom() - (y - self.y.0) / (self.y.1 - self.y.0) * height,
        ]
    }

    /// Returns the number of pixels per unit along the lower side.
    pub fn scale(&self) -> f64 {
        self.rect.width / (self.x.1 - self.x.0)
    }

    /// Draws light lines across the frame at the ticks. Callers draw them first, below everything else.
    pub fn grid(&self, units: [Unit; 2]) -> Vec<Item> {
        let line = |from, to| Item::Outline(vec![Step::Move(from), Step::Line(to)], Style::line(FAINT, 1.0));
        let [x, y] = self.ticks(units);
        let upright = x.into_iter().map(|(value, _)| self.at(value, self.y.0)[0]);
        let level = y.into_iter().map(|(value, _)| self.at(self.x.0, value)[1]);
        let upright = upright.map(|x| line([x, self.rect.y], [x, self.rect.bottom()]));
        upright.chain(level.map(|y| line([self.rect.x, y], [self.rect.right(), y]))).collect()
    }

    /// Draws sides, ticks and titles. Callers draw them last, above everything else. A dashed side is a seam, across which the
    /// space continues on the opposite side.
    pub fn border(&self, units: [Unit; 2], titles: [String; 2], seams: [bool; 2]) -> Vec<Item> {
        let mut items = self.sides(seams);
        items.extend(self.tick_marks(units, [true; 2]));
        items.extend(self.titles(self.rect, units, titles));
        items
    }

    /// Draws only the sides.
    pub fn sides(&self, seams: [bool; 2]) -> Vec<Item> {
        let Rect { x: left, y: top, .. } = self.rect;
        let (right, bottom) = (self.rect.right(), self.rect.bottom());
        let side = |a: [f64; 2], b: [f64; 2], seam: bool| {
            let pen = Style::line(INK, 1.2);
            let pen = if seam { pen.dashed(&[7.0, 5.0]) } else { pen };
            Item::Outline(vec![Step::Move(a), Step::Line(b)], pen)
        };
        vec![
            side([left, top], [left, bottom], seams[0]),
            side([right, top], [right, bottom], seams[0]),
            side([left, top], [right, top], seams[1]),
            side([left, bottom], [right, bottom], seams[1]),
        ]
    }

    /// Draws marks at the ticks of both axes. Axes for which `values` is true also have values there.
    pub fn tick_marks(&self, units: [Unit; 2], values: [bool; 2]) -> Vec<Item> {
        let (left, bottom) = (self.rect.x, self.rect.bottom());
        let mark = |a: [f64; 2], b: [f64; 2]| Item::Outline(vec![Step::Move(a), Step::Line(b)], Style::line(PALE, 1.0));
        let mut items = Vec::new();
        let [x_ticks, y_ticks] = self.ticks(units);
        for (value, name) in x_ticks {
            let [x, _] = self.at(value, self.y.0);
            items.push(mark([x, bottom], [x, bottom + 5.0]));
            items.extend(values[0].then(|| text([x, bottom + 19.0], name, 13.0, Anchor::Middle, GRAY)));
        }
        for (value, name) in y_ticks {
            let [_, y] = self.at(self.x.0, value);
            items.push(mark([left - 5.0, y], [left, y]));
            items.extend(values[1].then(|| text([left - 8.0, y + 4.5], name, 13.0, Anchor::End, GRAY)));
        }
        items
    }

    /// Draws the titles of the axes in the middle of the sides of `around`, outside the values at the ticks. `around` is the
    /// rectangle of this frame, or of several frames with common titles.
    pub fn titles(&self, around: Rect, units: [Unit; 2], [x_title, y_title]: [String; 2]) -> [Item; 2] {
        let [_, y_ticks] = self.ticks(units);
        let widest = y_ticks.iter().map(|(_, name)| super::figure::text_width(name, 13.0)).fold(0.0, f64::max);
        let middle = [around.x + around.width / 2.0, around.y + around.height / 2.0];
        [
            text([middle[0], around.bottom() + 38.0], x_title, 14.0, Anchor::Middle, INK),
            upwards([around.x - 16.0 - widest, middle[1]], y_title, 14.0, INK),
        ]
    }

    fn ticks(&self, units: [Unit; 2]) -> [Vec<(f64, String)>; 2] {
        [
            ticks(self.x, units[0], (self.rect.width / 65.0) as usize),
            ticks(self.y, units[1], (self.rect.height / 45.0) as usize),
        ]
    }
}

/// Returns round values in the range, with their labels: at most `at_most`, and at least two if the range contains two.
fn ticks(range: Range, unit: Unit, at_most: usize) -> Vec<(f64, String)> {
    let few = sparse_ticks(range, unit, at_most.max(2));
    if few.len() >= 2 { few } else { sparse_ticks(range, unit, 2 * at_most.max(2)) }
}

fn sparse_ticks(range: Range, unit: Unit, at_most: usize) -> Vec<(f64, String)> {
    let (factor, sign, round): (f64, &str, fn(f64) -> f64) = match unit {
        Unit::Meters | Unit::Seconds => (1.0, "", decimal_step),
        Unit::Degrees => (180.0 / std::f64::consts::PI, "\u{b0}", degree_step),
        Unit::Percent => (100.0, " %", decimal_step),
    };
    let (lower, upper) = (range.0 * factor, range.1 * factor);
    let step = round((upper - lower) / at_most as f64);
    // Half a per mille of a step. A limit that rounding has moved slightly off a round number still gets its tick.
    let slack = 5e-4;
    let (first, last) = ((lower / step - slack).ceil(), (upper / step + slack).floor());
    let decimals = (-step.log10()).ceil().clamp(0.0, 9.0) as usize;
    let count = (last - first).clamp(-1.0, 1e3) as i64;
    (0..=count)
        .map(|k| {
            let value = (first + k as f64) * step;
            (value / factor, label(value, decimals) + sign)
        })
        .collect()
}

fn label(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    let is_zero = text.chars().all(|c| matches!(c, '0' | '.'));
    if value < 0.0 && !is_zero { format!("\u{2212}{text}") } else { text }
}

/// Returns the smallest number of at least `least` that is 1, 2 or 5 times a power of ten.
fn decimal_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|m| m * power).find(|&s| s >= least * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

/// Returns the smallest step of at least `least` degrees that divides a turn or is a multiple of a turn.
fn degree_step(least: f64) -> f64 {
    const DEGREE_STEPS: [f64; 10] = [1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0, 180.0, 360.0];
    if least < 0.5 {
        return decimal_step(least);
    }
    let turns = || 360.0 * decimal_step(least / 360.0).ceil();
    DEGREE_STEPS.into_iter().find(|&s| s >= least * (1.0 - 1e-9)).unwrap_or_else(turns)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn names(range: Range, unit: Unit, at_most: usize) -> Vec<String> {
        ticks(range, unit, at_most).into_iter().map(|(_, name)| name).collect()
    }

    #[test]
    fn a_turn_is_divided_evenly() {
        let expected = ["\u{2212}180\u{b0}", "\u{2212}90\u{b0}", "0\u{b0}", "90\u{b0}", "180\u{b0}"];
        assert_eq!(names((-PI, PI), Unit::Degrees, 5), expected);
        assert_eq!(names((-PI, PI), Unit::Degrees, 9).len(), 9);
        assert_eq!(names((-PI / 2.0, PI / 2.0), Unit::Degrees, 7).len(), 7);
    }

    #[test]
    fn metres_have_round_steps() {
        assert_eq!(names((-0.31, 0.52), Unit::Meters, 6), ["\u{2212}0.2", "0.0", "0.2", "0.4"]);
        assert_eq!(names((0.0, 12.0), Unit::Meters, 4), ["0", "5", "10"]);
    }

    #[test]
    fn short_axes_have_two_ticks() {
        assert_eq!(names((-2.9, 2.9), Unit::Degrees, 2), ["\u{2212}90\u{b0}", "0\u{b0}", "90\u{b0}"]);
        assert_eq!(names((0.1, 0.9), Unit::Meters, 1), ["0.2", "0.4", "0.6", "0.8"]);
    }

    #[test]
    fn extreme_ranges_have_few_finite_ticks() {
        for range in [(0.0, 0.0), (5.0, 5.0), (1e9, 1e9), (-1e12, 1e12), (0.0, 1e-9), (f64::NAN, 1.0), (3.0, -3.0)] {
            for unit in [Unit::Meters, Unit::Degrees] {
                let range = sound(range);
                let all = ticks(range, unit, 8);
                assert!((1..=10).contains(&all.len()), "{range:?}: {all:?}");
                let slack = 0.01 * (range.1 - range.0);
                assert!(all.iter().all(|t| (range.0 - slack..=range.1 + slack).contains(&t.0)), "{range:?}: {all:?}");
            }
        }
    }

    #[test]
    fn equal_scale_keeps_shapes() {
        let area = Rect { x: 10.0, y: 20.0, width: 300.0, height: 100.0 };
        for frame in [Frame::fitted(area, (0.0, 2.0), (0.0, 1.0), true), Frame::filling(area, (0.0, 2.0), (0.0, 1.0))] {
            let ([x0, y0], [x1, y1]) = (frame.at(0.0, 0.0), frame.at(1.0, 1.0));
            assert!(((x1 - x0) - (y0 - y1)).abs() < 1e-9);
            assert!((x1 - x0 - frame.scale()).abs() < 1e-9);
        }
    }
}
