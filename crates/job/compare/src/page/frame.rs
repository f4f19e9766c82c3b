//! The frame of a chart with two axes.

use super::axis::Axis;
use super::markup::{self, number};

/// Width and height of a chart, in pixels.
const CHART_SIZE: [f64; 2] = [460.0, 380.0];
/// Room left of the plot, above it, right of it and below it, in pixels.
const PLOT_MARGINS: [f64; 4] = [78.0, 10.0, 14.0, 46.0];

/// A chart with its axes, to which the caller adds contents.
pub struct Frame<F> {
    /// The SVG text so far.
    pub svg: String,
    /// Maps positions on both axes to pixels.
    pub place: F,
}

/// Starts a chart with ticks and titles along both axes.
pub fn frame(axes: [Axis; 2], titles: [&str; 2], what: &str) -> Frame<impl Fn([f64; 2]) -> [f64; 2]> {
    let [left, top, right, bottom] = PLOT_MARGINS;
    let [width, height] = [CHART_SIZE[0] - left - right, CHART_SIZE[1] - top - bottom];
    let place = move |[x, y]: [f64; 2]| [left + width * x, top + height * (1.0 - y)];
    let label = format!("{what}: {} against {}", titles[1], titles[0]);
    let mut svg = markup::chart(CHART_SIZE, &label);
    let floor = top + height;
    for (value, text) in axes[0].ticks() {
        let x = place([axes[0].place(value), 0.0])[0];
        svg += &format!("<path class=\"grid\" d=\"M{} {}V{}\"/>", number(x), number(top), number(floor));
        svg += &markup::text("tick", [x, floor + 17.0], &text);
    }
    for (value, text) in axes[1].ticks() {
        let at = place([0.0, axes[1].place(value)])[1];
        svg += &format!("<path class=\"grid\" d=\"M{} {}H{}\"/>", number(left), number(at), number(left + width));
        svg += &markup::text("name", [left - 8.0, at + 4.0], &text);
    }
    svg += &markup::text("tick", [left + width / 2.0, CHART_SIZE[1] - 8.0], titles[0]);
    svg += &markup::upright_text(top + height / 2.0, titles[1]);
    Frame { svg, place }
}
