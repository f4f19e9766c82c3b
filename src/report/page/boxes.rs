//! Box plots, a line a planner.

use super::axis::Axis;
use super::markup::{escaped, number};
use crate::report::{Measure, Spread, Study};

/// Width of a chart, pixels: about that of a phone, where charts are not made smaller then.
const WIDTH: f64 = 460.0;
/// Left of the plot, for the names.
const LEFT: f64 = 104.0;
/// Right of the plot.
const RIGHT: f64 = 14.0;
/// Height of a planner's line.
const LINE: f64 = 30.0;
/// Above the first line.
const TOP: f64 = 6.0;
/// Below the last one, for the axis.
const BOTTOM: f64 = 26.0;
/// Runs that are shown as dots, too; more make a grey surface.
const DOTS: usize = 250;
/// Characters of a name that fit in front of its line.
const NAME: usize = 15;

/// The chart of one measure; none where no run has a value.
pub fn chart(study: &Study, measure: Measure) -> Option<String> {
    let values: Vec<Vec<f64>> = (0..study.planners().len())
        .map(|i| study.runs(i).filter_map(|(c, row)| measure.of(c, row)).map(|v| v * measure.scale()).collect())
        .collect();
    // Nothing is shorter than the optimum.
    let base = (measure == Measure::OverOptimum).then_some(1.0);
    let axis = Axis::over(values.iter().flatten().copied(), base)?;
    let height = TOP + LINE * values.len() as f64 + BOTTOM;
    let x = |value: f64| LEFT + (WIDTH - LEFT - RIGHT) * axis.place(value);
    let floor = height - BOTTOM;
    let mut svg = format!(
        "<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Box plots: {}\">\n",
        number(WIDTH),
        number(height),
        escaped(measure.heading())
    );
    for (value, text) in axis.ticks() {
        let at = number(x(value));
        svg += &format!("<path class=\"grid\" d=\"M{at} {}V{}\"/>", number(TOP), number(floor));
        svg += &format!("<text class=\"tick\" x=\"{at}\" y=\"{}\">{text}</text>\n", number(floor + 17.0));
    }
    for (i, (name, values)) in study.planners().into_iter().zip(&values).enumerate() {
        let middle = TOP + LINE * (i as f64 + 0.5);
        svg += &format!(
            "<text class=\"name\" x=\"{}\" y=\"{}\">{}</text>\n",
            number(LEFT - 10.0),
            number(middle + 4.0),
            escaped(&shortened(name))
        );
        if let Some(spread) = Spread::of(values.iter().copied()) {
            svg +=
                &format!("<g class=\"p{}\"><title>{}</title>", i % super::COLORS, escaped(&described(name, &spread)));
            svg += &drawn(&spread, values, middle, &x);
            svg += "</g>\n";
        }
    }
    Some(svg + "</svg>\n")
}

/// Whiskers from the least to the greatest, the box between the quartiles, the median across it, and all runs as dots.
fn drawn(spread: &Spread, values: &[f64], middle: f64, x: &impl Fn(f64) -> f64) -> String {
    let [min, low, median, high, max] =
        [spread.min, spread.lower_quartile, spread.median, spread.upper_quartile, spread.max].map(x);
    let mut svg = String::new();
    if values.len() > 1 {
        let [y, top, bottom] = [middle, middle - 4.0, middle + 4.0].map(number);
        svg += &format!(
            "<path class=\"whisker\" d=\"M{0} {y}H{1}M{2} {y}H{3}",
            number(min),
            number(low),
            number(high),
            number(max)
        );
        svg += &format!("M{0} {top}V{bottom}M{1} {top}V{bottom}\"/>", number(min), number(max));
        svg += &format!(
            "<rect class=\"box\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"16\"/>",
            number(low),
            number(middle - 8.0),
            number((high - low).max(1.0))
        );
    }
    let stride = values.len().div_ceil(DOTS).max(1);
    for (k, value) in values.iter().enumerate().step_by(stride) {
        // Beside each other by a fixed pattern, so that equal values do not hide each other.
        let aside = if values.len() > 1 { ((k * 7) % 11) as f64 - 5.0 } else { 0.0 };
        let radius = if values.len() > 1 { "1.6" } else { "4" };
        svg += &format!(
            "<circle class=\"dot\" cx=\"{}\" cy=\"{}\" r=\"{radius}\"/>",
            number(x(*value)),
            number(middle + aside)
        );
    }
    if values.len() > 1 {
        svg += &format!(
            "<path class=\"median\" d=\"M{} {}V{}\"/>",
            number(median),
            number(middle - 9.0),
            number(middle + 9.0)
        );
    }
    svg
}

/// What the chart shows, for who hovers over it or has it read out.
fn described(name: &str, spread: &Spread) -> String {
    let [min, low, median, high, max, _] = spread.numbers().map(|v| format!("{v:.4}"));
    format!("{name}: {} runs, median {median}, quartiles {low} and {high}, least {min}, greatest {max}", spread.n)
}

fn shortened(name: &str) -> String {
    match name.chars().count() {
        n if n > NAME => name.chars().take(NAME - 1).chain(['\u{2026}']).collect(),
        _ => name.to_owned(),
    }
}
