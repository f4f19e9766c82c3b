//! The charts: one for each equation, one for the factor of SOR, one for the strength of the drift.

use super::lines::{self, CHART_SIZE, Line, LineChart};
use super::{Convergence, FactorScan, Point, RelaxationRun, StrengthScan, WeightScan, files};
use crate::page::number;
use cplan_fields::{Factor, Order, Sample, Scheme};
use cplan_text::markup;
use cplan_theme::{INK, PICTURE_FONTS, WHITE, on_dark, recolored};

/// Number of charts side by side.
const CHARTS_PER_ROW: usize = 2;
/// Height of the title above the charts, in pixels.
const TITLE_HEIGHT: f64 = 44.0;

impl Convergence {
    /// Draws all charts as one SVG document, on a dark background if `is_dark`. The same data give the same bytes.
    pub fn to_svg(&self, is_dark: bool) -> String {
        let light = self.light_svg();
        if is_dark { recolored(&light, |color| on_dark(color).to_string()) } else { light }
    }

    fn light_svg(&self) -> String {
        let charts = self.charts();
        let [width, height] = [
            CHART_SIZE[0] * CHARTS_PER_ROW as f64,
            TITLE_HEIGHT + CHART_SIZE[1] * charts.len().div_ceil(CHARTS_PER_ROW) as f64,
        ];
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\">\n\
             <rect width=\"{0}\" height=\"{1}\" fill=\"{WHITE}\"/>\n\
             <g font-family=\"{PICTURE_FONTS}\" font-size=\"12\" fill=\"{INK}\">\n",
            number(width),
            number(height)
        );
        let [rows, columns] = self.cells;
        let title = format!("{}: {rows} x {columns} cells, {} free", self.title, self.free);
        svg += &format!("<text x=\"20\" y=\"28\" font-size=\"17\">{}</text>\n", markup(&title));
        for (k, chart) in charts.iter().enumerate() {
            svg += &chart.svg([
                CHART_SIZE[0] * (k % CHARTS_PER_ROW) as f64,
                TITLE_HEIGHT + CHART_SIZE[1] * (k / CHARTS_PER_ROW) as f64,
            ]);
        }
        svg + "</g>\n</svg>\n"
    }

    fn charts(&self) -> Vec<LineChart> {
        let of_equations = self.runs.chunk_by(|a, b| a.equation == b.equation).map(errors);
        of_equations.chain([self.by_factor(), self.by_weight(), self.by_strength()]).collect()
    }

    fn by_factor(&self) -> LineChart {
        let line = |(k, scan): (usize, &FactorScan)| {
            let marked = [&scan.formula].into_iter().chain(&scan.by_rate);
            let mut points: Vec<Point> = scan.points.iter().chain(marked).copied().collect();
            points.sort_by(|a, b| a.at.total_cmp(&b.at));
            Line { name: scan.equation.clone(), pen: lines::pen(k), points: converged_points(&points), dots: true }
        };
        LineChart {
            title: format!("Sweeps of SOR ({}) by its factor", self.order),
            axes: ["factor", "sweeps until it converges"],
            lines: self.factors.iter().enumerate().map(line).collect(),
            marks: vec![(Factor::Formula.value(self.cells), "formula")],
        }
    }

    fn by_weight(&self) -> LineChart {
        let line = |(k, scan): (usize, &WeightScan)| Line {
            name: scan.equation.clone(),
            pen: lines::pen(k),
            points: converged_points(&scan.points),
            dots: true,
        };
        LineChart {
            title: "Sweeps of weighted Jacobi by its factor".to_owned(),
            axes: ["factor", "sweeps until it converges"],
            lines: self.weights.iter().enumerate().map(line).collect(),
            marks: vec![(1.0, "Jacobi")],
        }
    }

    fn by_strength(&self) -> LineChart {
        let line = |(k, scan): (usize, &StrengthScan)| Line {
            name: files::oriented_name(scan.difference),
            pen: lines::pen(k),
            points: converged_points(&scan.points),
            dots: true,
        };
        let [a, b] = self.direction;
        LineChart {
            title: format!("Sweeps of Gauss-Seidel ({}), drift along ({a:.2}, {b:.2})", self.order),
            axes: ["epsilon (per cell)", "sweeps until it converges"],
            lines: self.strengths.iter().enumerate().map(line).collect(),
            // Central differences are monotone below this strength.
            marks: vec![(2.0 / a.abs().max(b.abs()), "monotone")],
        }
    }
}

/// Returns the points of converged relaxations.
fn converged_points(points: &[Point]) -> Vec<[f64; 2]> {
    points.iter().filter_map(|point| Some([point.at, point.converged()? as f64])).collect()
}

/// Charts the relaxations of one equation: the error if it is known, otherwise the sum of squared changes of a sweep.
fn errors(runs: &[RelaxationRun]) -> LineChart {
    let known = runs.iter().flat_map(|run| &run.trace.samples).any(|sample| sample.error.is_some());
    let line = |run: &RelaxationRun| {
        let value = |sample: &Sample| if known { sample.error } else { Some(sample.squares) };
        let points = run.trace.samples.iter().filter_map(|sample| Some([sample.sweep as f64, value(sample)?]));
        let scheme = run.relaxation.scheme;
        let name = match scheme {
            Scheme::Successive { factor: Factor::Formula, order } => format!("sor, {order}"),
            Scheme::Successive { order, .. } => format!("gauss-seidel, {order}"),
            Scheme::Simultaneous { factor: 1.0 } => "jacobi".to_owned(),
            Scheme::Simultaneous { factor } => format!("weighted-jacobi {factor}"),
        };
        Line { name, pen: pen(scheme), points: points.collect(), dots: false }
    };
    let equation = runs.first().map_or("", |run| &run.equation);
    LineChart {
        title: format!("{} after each sweep: {equation}", if known { "Error" } else { "Squared changes" }),
        axes: ["sweeps", if known { "greatest error, over that at the start" } else { "sum of squared changes" }],
        lines: runs.iter().map(line).collect(),
        marks: Vec::new(),
    }
}

/// Returns indices of the colour and of the dashes of a relaxation. Each relaxation has its own colour, and each order
/// its own dashes.
fn pen(scheme: Scheme) -> [usize; 2] {
    match scheme {
        Scheme::Simultaneous { factor } => [0, usize::from(factor != 1.0)],
        Scheme::Successive { factor, order } => {
            let dashes = match order {
                Order::Lines(_) => 0,
                Order::Corners(_) => 1,
                Order::RedBlack => 2,
                Order::FourColors => 3,
            };
            [1 + usize::from(factor == Factor::Formula), dashes]
        }
    }
}
