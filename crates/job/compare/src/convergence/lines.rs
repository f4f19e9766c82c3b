//! Line charts, as parts of an SVG document.

use crate::page::{Axis, number};
use cplan_text::markup;
use cplan_theme::{FAINT, GRAY, PATH_COLORS, Rgb};

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

/// Width and height of a chart with its margins, in pixels.
pub const CHART_SIZE: [f64; 2] = [LEFT_MARGIN + PLOT_SIZE[0] + RIGHT_MARGIN, TOP_MARGIN + PLOT_SIZE[1] + BOTTOM_MARGIN];

/// Dashes of lines, in pixels. They distinguish lines of one colour.
const DASHES: [&str; 4] = ["", "7 3", "2 3", "7 3 2 3"];

/// Returns indices of the colour and of the dashes of a line, given the line's index. After all colours have been used,
/// the next dashes follow.
pub fn pen(line: usize) -> [usize; 2] {
    [line % PATH_COLORS.len(), line / PATH_COLORS.len()]
}

/// Lines over a horizontal axis.
pub struct LineChart {
    pub title: String,
    /// Titles of the axes.
    pub axes: [&'static str; 2],
    pub lines: Vec<Line>,
    /// Values of the horizontal axis that are marked, with their names.
    pub marks: Vec<(f64, &'static str)>,
}

/// A line with its name.
pub struct Line {
    pub name: String,
    /// Indices into `PATH_COLORS` and `DASHES`.
    pub pen: [usize; 2],
    pub points: Vec<[f64; 2]>,
    /// True to draw a dot at each point.
    pub dots: bool,
}

impl LineChart {
    /// Draws the chart with its upper left corner at `[left, top]`. Returns an empty text if there are no points. An
    /// axis is logarithmic if its values differ greatly. Values that a logarithmic axis cannot show are omitted.
    pub fn svg(&self, [left, top]: [f64; 2]) -> String {
        let of = |k: usize| self.lines.iter().flat_map(|line| &line.points).map(move |point| point[k]);
        let marks = self.marks.iter().map(|mark| mark.0);
        // An error can be zero, which has no place on a logarithmic axis.
        let positive = of(1).filter(|&value| value > 0.0);
        let (Some(x), Some(y)) = (Axis::over(of(0).chain(marks), None), Axis::over(positive, None)) else {
            return String::new();
        };
        let [width, height] = PLOT_SIZE;
        let place = |point: &[f64; 2]| {
            [LEFT_MARGIN + width * x.place(point[0]), TOP_MARGIN + height * (1.0 - y.place(point[1]))]
        };
        let mut svg = format!("<g transform=\"translate({} {})\">\n", number(left), number(top));
        svg += &text([LEFT_MARGIN, 20.0], "start", " font-size=\"14\" font-weight=\"bold\"", &self.title);
        let [right, bottom] = [LEFT_MARGIN + width, TOP_MARGIN + height];
        for (value, written) in x.ticks() {
            let at = place(&[value, 0.0])[0];
            svg += &rule(&format!("M{} {}V{}", number(at), number(TOP_MARGIN), number(bottom)), FAINT);
            svg += &text([at, bottom + 17.0], "middle", &tick_style(), &written);
        }
        for (value, written) in y.ticks() {
            let at = TOP_MARGIN + height * (1.0 - y.place(value));
            svg += &rule(&format!("M{} {}H{}", number(LEFT_MARGIN), number(at), number(right)), FAINT);
            svg += &text([LEFT_MARGIN - 7.0, at + 4.0], "end", &tick_style(), &written);
        }
        svg += &rule(
            &format!("M{} {}V{}H{}", number(LEFT_MARGIN), number(TOP_MARGIN), number(bottom), number(right)),
            GRAY,
        );
        svg += &text([LEFT_MARGIN + width / 2.0, bottom + 38.0], "middle", "", self.axes[0]);
        let middle = number(TOP_MARGIN + height / 2.0);
        svg += &format!(
            "<text x=\"16\" y=\"{middle}\" text-anchor=\"middle\" transform=\"rotate(-90 16 {middle})\">{}</text>\n",
            markup(self.axes[1])
        );
        for (value, name) in &self.marks {
            let at = place(&[*value, 0.0])[0];
            let path = format!("M{} {}V{}", number(at), number(TOP_MARGIN), number(bottom));
            svg += &format!("<path d=\"{path}\" stroke=\"{GRAY}\" stroke-dasharray=\"3 3\"/>\n");
            svg += &text([at - 3.0, TOP_MARGIN + 11.0], "end", &tick_style(), name);
        }
        for (k, line) in self.lines.iter().enumerate() {
            let shown = line.points.iter().filter(|point| point[1] > 0.0 || !y.is_logarithmic);
            svg += &line.svg(&shown.map(place).collect::<Vec<_>>());
            svg += &line.key([right + 12.0, TOP_MARGIN + 8.0 + NAME_SPACING * k as f64]);
        }
        svg + "</g>\n"
    }
}

/// Returns the style of ticks.
fn tick_style() -> String {
    format!(" fill=\"{GRAY}\" font-size=\"11\"")
}

fn rule(path: &str, color: Rgb) -> String {
    format!("<path fill=\"none\" d=\"{path}\" stroke=\"{color}\"/>\n")
}

fn text([x, y]: [f64; 2], anchor: &str, style: &str, content: &str) -> String {
    format!(
        "<text x=\"{}\" y=\"{}\" text-anchor=\"{anchor}\"{style}>{}</text>\n",
        number(x),
        number(y),
        markup(content)
    )
}

impl Line {
    /// Draws the line through these places.
    fn svg(&self, places: &[[f64; 2]]) -> String {
        let mut path = String::new();
        let mut last = String::new();
        for [x, y] in places {
            // Precision of a tenth of a pixel. A point that rounds to the one before is left out.
            let place = format!("{x:.1} {y:.1}");
            if place != last {
                path += &format!("{}{place}", if path.is_empty() { 'M' } else { 'L' });
            }
            last = place;
        }
        let dots = |[x, y]: &[f64; 2]| {
            format!("<circle cx=\"{}\" cy=\"{}\" r=\"2.2\" fill=\"{}\"/>\n", number(*x), number(*y), self.color())
        };
        let dots: String = if self.dots { places.iter().map(dots).collect() } else { String::new() };
        format!("<path d=\"{path}\" {}><title>{}</title></path>\n{dots}", self.stroke(), markup(&self.name))
    }

    /// Draws a sample of the line and its name.
    fn key(&self, [x, y]: [f64; 2]) -> String {
        let piece = format!("<path d=\"M{} {}h22\" {}/>\n", number(x), number(y - 4.0), self.stroke());
        piece + &text([x + 28.0, y], "start", "", &self.name)
    }

    fn color(&self) -> Rgb {
        PATH_COLORS[self.pen[0] % PATH_COLORS.len()].0
    }

    fn stroke(&self) -> String {
        let dash = DASHES[self.pen[1] % DASHES.len()];
        let dash = if dash.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{dash}\"") };
        format!("fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" stroke-linejoin=\"round\"{dash}", self.color())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: &[[f64; 2]]) -> String {
        let line = Line { name: "<a>".into(), pen: [1, 1], points: points.to_vec(), dots: true };
        let axes = ["x", "y"];
        LineChart { title: "t".into(), axes, lines: vec![line], marks: vec![(1.0, "here")] }.svg([0.0, 0.0])
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
        assert!(svg.contains("&lt;a&gt;") && svg.contains("stroke-dasharray=\"7 3\"") && svg.contains(">here<"));
    }

    #[test]
    fn points_without_a_place_are_omitted() {
        // An error of zero has no logarithm.
        let svg = chart(&[[1.0, 1.0], [2.0, 1e-3], [3.0, 0.0]]);
        assert_eq!(dots(&svg).len(), 2);
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert_eq!(chart(&[]), "");
    }
}
