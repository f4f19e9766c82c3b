//! Line charts.

use crate::page::Axis;
use cplan_theme::{FAINT, GRAY, INK, PATH_COLORS};
use cplan_view::figure::{Anchor, Item, Pen, Step, Style, bold, chain, label, upwards};

/// Width and height of the plot, in pixels.
const PLOT_SIZE: [f64; 2] = [400.0, 250.0];
/// Room left of the plot, for the ticks and the title of the vertical axis, in pixels.
const LEFT_MARGIN: f64 = 74.0;
/// Room above the plot, for the title, in pixels.
const TOP_MARGIN: f64 = 34.0;
/// Room right of the plot, for the names of lines, in pixels.
const RIGHT_MARGIN: f64 = 186.0;
/// Room below the plot, for the ticks and the title of the horizontal axis, in pixels.
const BOTTOM_MARGIN: f64 = 52.0;
/// Distance between the names of two lines, in pixels.
const NAME_SPACING: f64 = 19.0;
/// Sizes of names and of values at ticks, in pixels.
const NAME_SIZE: f64 = 12.0;
const TICK_SIZE: f64 = 11.0;

/// Width and height of a chart with its margins, in pixels.
pub const CHART_SIZE: [f64; 2] = [LEFT_MARGIN + PLOT_SIZE[0] + RIGHT_MARGIN, TOP_MARGIN + PLOT_SIZE[1] + BOTTOM_MARGIN];

/// Dashes of lines, in pixels. They distinguish lines of one colour.
const DASHES: [&[f64]; 4] = [&[], &[7.0, 3.0], &[2.0, 3.0], &[7.0, 3.0, 2.0, 3.0]];

/// Returns the pen of a line with this index. When all colours have been used, the next dashes follow.
pub fn pen(line: usize) -> Pen {
    pen_of(line, line / PATH_COLORS.len())
}

/// Returns the pen with the colour and the dashes of these indices.
pub fn pen_of(color: usize, dashes: usize) -> Pen {
    Pen { color: PATH_COLORS[color % PATH_COLORS.len()].0, width: 1.6, dash: DASHES[dashes % DASHES.len()] }
}

/// Lines over a horizontal axis.
pub struct LineChart {
    pub title: String,
    /// Titles of the axes.
    pub axes: [&'static str; 2],
    pub lines: Vec<Line>,
    /// Values on the horizontal axis to mark, with their names.
    pub marks: Vec<(f64, &'static str)>,
}

/// A line with its name.
pub struct Line {
    pub name: String,
    pub pen: Pen,
    pub points: Vec<[f64; 2]>,
    /// True to draw a dot at each point.
    pub dots: bool,
}

impl LineChart {
    /// Draws the chart with its upper left corner at `corner`. Draws nothing without points. An axis is logarithmic if its values
    /// differ greatly; values that cannot be shown on it are omitted.
    pub fn items(&self, corner: [f64; 2]) -> Vec<Item> {
        let of = |k: usize| self.lines.iter().flat_map(|line| &line.points).map(move |point| point[k]);
        let marks = self.marks.iter().map(|mark| mark.0);
        // An error may be zero, which has no place on a logarithmic axis.
        let positive = of(1).filter(|&value| value > 0.0);
        let (Some(x), Some(y)) = (Axis::over(of(0).chain(marks), None), Axis::over(positive, None)) else {
            return Vec::new();
        };
        let [left, top] = [corner[0] + LEFT_MARGIN, corner[1] + TOP_MARGIN];
        let [width, height] = PLOT_SIZE;
        let [right, bottom] = [left + width, top + height];
        let column = |value: f64| left + width * x.place(value);
        let row = |value: f64| top + height * (1.0 - y.place(value));
        let rule =
            |from: [f64; 2], to: [f64; 2], style: Style| Item::Outline(vec![Step::Move(from), Step::Line(to)], style);
        let mut items = vec![bold([left, corner[1] + 20.0], &self.title, 14.0, Anchor::Start, INK)];
        for (value, written) in x.ticks() {
            let at = column(value);
            items.push(rule([at, top], [at, bottom], Style::line(FAINT, 1.0)));
            items.push(label([at, bottom + 17.0], written, TICK_SIZE, Anchor::Middle, GRAY));
        }
        for (value, written) in y.ticks() {
            let at = row(value);
            items.push(rule([left, at], [right, at], Style::line(FAINT, 1.0)));
            items.push(label([left - 7.0, at + 4.0], written, TICK_SIZE, Anchor::End, GRAY));
        }
        let sides = chain([[left, top], [left, bottom], [right, bottom]], false);
        items.push(Item::Outline(sides, Style::line(GRAY, 1.0)));
        items.push(label([left + width / 2.0, bottom + 38.0], self.axes[0], NAME_SIZE, Anchor::Middle, INK));
        items.push(upwards([corner[0] + 16.0, top + height / 2.0], self.axes[1], NAME_SIZE, INK));
        for (value, name) in &self.marks {
            let at = column(*value);
            items.push(rule([at, top], [at, bottom], Style::line(GRAY, 1.0).dashed(&[3.0, 3.0])));
            items.push(label([at - 3.0, top + 11.0], *name, TICK_SIZE, Anchor::End, GRAY));
        }
        for (k, line) in self.lines.iter().enumerate() {
            let style = Style { pen: Some(line.pen), ..Style::line(line.pen.color, line.pen.width) };
            let shown = line.points.iter().filter(|point| point[1] > 0.0 || !y.is_logarithmic);
            let places: Vec<[f64; 2]> = shown.map(|point| [column(point[0]), row(point[1])]).collect();
            let path = Item::Outline(chain(places.iter().copied(), false), style);
            items.push(Item::Titled(line.name.clone(), vec![path]));
            let dots = places.iter().filter(|_| line.dots);
            items.extend(dots.map(|&at| Item::Disc(at, 2.2, Style::fill(line.pen.color))));
            let [x, y] = [right + 12.0, top + 8.0 + NAME_SPACING * k as f64];
            items.push(rule([x, y - 4.0], [x + 22.0, y - 4.0], style));
            items.push(label([x + 28.0, y], &line.name, NAME_SIZE, Anchor::Start, INK));
        }
        items
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_view::Figure;

    fn chart(points: &[[f64; 2]]) -> String {
        let line = Line { name: "<a>".into(), pen: pen_of(1, 1), points: points.to_vec(), dots: true };
        let axes = ["x", "y"];
        let chart = LineChart { title: "t".into(), axes, lines: vec![line], marks: vec![(1.0, "here")] };
        Figure { width: 10.0, height: 10.0, items: chart.items([0.0; 2]), is_dark: false }.svg()
    }

    /// Returns the centres of the dots.
    fn dots(svg: &str) -> Vec<[f64; 2]> {
        let document = roxmltree::Document::parse(svg).unwrap();
        let dots = document.descendants().filter(|node| node.has_tag_name("circle"));
        dots.map(|dot| ["cx", "cy"].map(|key| dot.attribute(key).unwrap().parse().unwrap())).collect()
    }

    #[test]
    fn equal_factors_are_equally_far_apart_where_values_differ_much() {
        let svg = chart(&[[1.0, 1.0], [10.0, 1e-3], [100.0, 1e-6]]);
        let [a, b, c] = dots(&svg)[..] else { panic!("{svg}") };
        for k in [0, 1] {
            assert!((a[k] + c[k] - 2.0 * b[k]).abs() < 0.02, "{a:?} {b:?} {c:?}");
        }
        assert!(a[0] < c[0] && a[1] < c[1], "sweeps go to the right, small errors lie below");
        assert!(svg.contains("&lt;a&gt;") && svg.contains("stroke-dasharray=\"7 3\"") && svg.contains("here"));
    }

    #[test]
    fn points_without_a_place_are_omitted() {
        // An error of zero has no logarithm.
        let svg = chart(&[[1.0, 1.0], [2.0, 1e-3], [3.0, 0.0]]);
        assert_eq!(dots(&svg).len(), 2);
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert!(!chart(&[]).contains("<text"));
    }
}
