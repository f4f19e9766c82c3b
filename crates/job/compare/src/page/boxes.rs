//! Box plots, one line per planner.

use super::axis::Axis;
use super::markup::{self, margin, name_before, number};
use crate::{Comparison, Measure, Spread, Study, labels};
use cplan_text::{counted, markup};

/// Width of a chart in pixels. It is about that of a phone's screen, so that phones need not scale charts.
const CHART_WIDTH: f64 = 460.0;
/// Room right of the plot, in pixels.
const RIGHT_MARGIN: f64 = 14.0;
/// Height of a planner's line, in pixels.
const ROW_HEIGHT: f64 = 30.0;
/// Room above the first line, in pixels.
const TOP_MARGIN: f64 = 6.0;
/// Room below the last line for the axis, in pixels.
const AXIS_HEIGHT: f64 = 26.0;
/// Largest number of dots. More would merge into a grey area. If there are more runs, only every second or third one has a dot,
/// and so on.
const MAX_DOTS: usize = 250;

/// Draws the chart of one measure. `None` if no run has a value.
pub fn chart(study: &Study, measure: Measure) -> Option<String> {
    let values: Vec<Vec<f64>> = (0..study.planners().len())
        .map(|i| study.runs(i).filter_map(|(c, row)| measure.of(c, row)).map(|v| v * measure.scale()).collect())
        .collect();
    if values.iter().all(Vec::is_empty) {
        return None;
    }
    // No path is shorter than the optimum, so the axis begins at 1.
    let base = (measure == Measure::OverOptimum).then_some(1.0);
    let axis = Axis::over(values.iter().flatten().copied(), base)?;
    let height = TOP_MARGIN + ROW_HEIGHT * values.len() as f64 + AXIS_HEIGHT;
    let names = labels(&study.planners());
    let left = margin(&names.iter().map(String::as_str).collect::<Vec<_>>());
    let x = |value: f64| left + (CHART_WIDTH - left - RIGHT_MARGIN) * axis.place(value);
    let floor = height - AXIS_HEIGHT;
    let mut svg = markup::chart([CHART_WIDTH, height], &format!("Box plots: {}", measure.heading()));
    for (value, text) in axis.ticks() {
        svg += &format!("<path class=\"grid\" d=\"M{} {}V{}\"/>", number(x(value)), number(TOP_MARGIN), number(floor));
        svg += &markup::text("tick", [x(value), floor + 17.0], &text);
    }
    let pens = study.comparisons.first().map_or_else(Vec::new, Comparison::pens);
    for (i, (name, values)) in study.planners().into_iter().zip(&values).enumerate() {
        let middle = TOP_MARGIN + ROW_HEIGHT * (i as f64 + 0.5);
        svg += &name_before(&names[i], left - 10.0, middle + 4.0);
        if let Some(spread) = Spread::of(values.iter().copied()) {
            let pen = pens[i].name();
            let title = markup(&describe_chart(name, &spread));
            svg += &format!("<g style=\"color: var(--{pen})\"><title>{title}</title>");
            svg += &drawn(&spread, values, middle, &x);
            svg += "</g>\n";
        }
    }
    Some(svg + "</svg>\n")
}

/// Least number of runs for a box. Quartiles of fewer runs would mean nothing, so these are drawn as dots.
pub const MIN_RUNS: usize = 5;

/// Draws one line: whiskers from the least to the greatest value, a box between the quartiles, the median across it, and a dot
/// for each run. With fewer than [`MIN_RUNS`] runs, only dots.
fn drawn(spread: &Spread, values: &[f64], middle: f64, x: &impl Fn(f64) -> f64) -> String {
    if values.len() < MIN_RUNS {
        let dot = |value: &f64| {
            format!("<circle class=\"only\" cx=\"{}\" cy=\"{}\" r=\"4.5\"/>", number(x(*value)), number(middle))
        };
        return values.iter().map(dot).collect();
    }
    let [min, low, median, high, max, _] = spread.numbers().map(x);
    let [y, top, bottom] = [middle, middle - 4.0, middle + 4.0].map(number);
    let width = number((high - low).max(1.0));
    let [min, low, high, max] = [min, low, high, max].map(number);
    let mut svg = format!("<path class=\"whisker\" d=\"M{min} {y}H{low}M{high} {y}H{max}");
    svg += &format!("M{min} {top}V{bottom}M{max} {top}V{bottom}\"/>");
    svg += &format!("<rect class=\"box\" x=\"{low}\" y=\"{}\" width=\"{width}\" height=\"16\"/>", number(middle - 8.0));
    let stride = values.len().div_ceil(MAX_DOTS).max(1);
    for (k, value) in values.iter().enumerate().step_by(stride) {
        // A fixed pattern spreads the dots vertically, so that equal values do not hide each other.
        let y = number(middle + ((k * 7) % 11) as f64 - 5.0);
        svg += &format!("<circle class=\"dot\" cx=\"{}\" cy=\"{y}\" r=\"1.6\"/>", number(x(*value)));
    }
    let [top, bottom] = [middle - 9.0, middle + 9.0].map(number);
    svg + &format!("<path class=\"median\" d=\"M{} {top}V{bottom}\"/>", number(median))
}

/// Describes the chart, for tooltips and screen readers.
fn describe_chart(name: &str, spread: &Spread) -> String {
    let [min, low, median, high, max, _] = spread.numbers().map(|v| format!("{v:.4}"));
    let runs = counted(spread.n, "run");
    format!("{name}: {runs}, median {median}, quartiles {low} and {high}, least {min}, greatest {max}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Family, Row};
    use cplan_model::Status;

    /// Returns a study of one planner with these durations.
    fn study(durations: &[f64]) -> Study {
        let comparison = |duration: &f64| Comparison {
            problem: "p".to_owned(),
            length_unit: "rad".to_owned(),
            query: None,
            bound: None,
            rows: vec![Row { duration: Some(*duration), ..Row::new("<planner>", Family::Field, Status::Found) }],
        };
        let comparisons = durations.iter().map(comparison).collect();
        Study { title: String::new(), sampling: None, comparisons, left_out: Vec::new(), refused: Vec::new() }
    }

    fn attribute(svg: &str, class: &str, name: &str) -> String {
        let document = roxmltree::Document::parse(svg).unwrap();
        let node = document.descendants().find(|node| node.attribute("class") == Some(class)).unwrap();
        node.attribute(name).unwrap().to_owned()
    }

    #[test]
    fn boxes_are_placed_by_their_values() {
        let svg = chart(&study(&[2.0, 1.0, 5.0, 3.0, 4.0]), Measure::Duration).unwrap();
        // The axis is from 0.84 to 5.16: the range of the values, and a twenty-fifth of it on either side.
        let left = margin(&["<planner>"]);
        let x = |value: f64| left + (CHART_WIDTH - left - RIGHT_MARGIN) * (value - 0.84) / 4.32;
        assert_eq!(attribute(&svg, "box", "x"), number(x(2.0)));
        let width: f64 = attribute(&svg, "box", "width").parse().unwrap();
        assert!((width - (x(4.0) - x(2.0))).abs() < 0.01);
        assert!(attribute(&svg, "median", "d").starts_with(&format!("M{} ", number(x(3.0)))));
        let whisker = attribute(&svg, "whisker", "d");
        assert!(
            whisker.starts_with(&format!("M{} ", number(x(1.0)))) && whisker.contains(&format!("H{}M", number(x(5.0))))
        );
        assert_eq!(svg.matches("class=\"dot\"").count(), 5);
        assert!(svg.contains("&lt;planner&gt;: 5 runs, median 3.0000"));
    }

    #[test]
    fn few_runs_are_dots_and_no_runs_no_chart() {
        let svg = chart(&study(&[2.0]), Measure::Duration).unwrap();
        assert!(svg.contains("class=\"only\"") && !svg.contains("class=\"box\""));
        let four = chart(&study(&[1.0, 2.0, 3.0, 4.0]), Measure::Duration).unwrap();
        assert_eq!((four.matches("class=\"only\"").count(), four.matches("class=\"box\"").count()), (4, 0));
        assert_eq!(chart(&study(&[2.0]), Measure::Clearance), None);
        assert_eq!(chart(&study(&[]), Measure::Duration), None);
        assert_eq!(chart(&study(&[2.0]), Measure::OverOptimum), None);
        let many: Vec<f64> = (0..1000).map(f64::from).collect();
        assert_eq!(chart(&study(&many), Measure::Duration).unwrap().matches("class=\"dot\"").count(), MAX_DOTS);
    }
}
