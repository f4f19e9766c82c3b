//! The charts: one for each equation, one for the factor of SOR, one for the strength of the drift.

use super::lines::{self, CHART_SIZE, Line, LineChart};
use super::{Convergence, ParameterScan, Point, RelaxationRun};
use cplan_fields::{Factor, Order, Sample, Scheme};
use cplan_theme::INK;
use cplan_view::figure::{Anchor, Figure, label};

/// Number of charts side by side.
const CHARTS_PER_ROW: usize = 2;
/// Height of the title above the charts, in pixels.
const TITLE_HEIGHT: f64 = 44.0;

impl Convergence {
    /// Draws all charts. The same data give the same figure.
    pub fn figure(&self) -> Figure {
        let charts = self.charts();
        let [width, height] = CHART_SIZE;
        let [rows, columns] = self.cells;
        let title = format!("{}: {rows} x {columns} cells, {} free", self.title, self.free);
        let mut items = vec![label([20.0, 28.0], title, 17.0, Anchor::Start, INK)];
        for (k, chart) in charts.iter().enumerate() {
            let row = (k / CHARTS_PER_ROW) as f64;
            items.extend(chart.items([width * (k % CHARTS_PER_ROW) as f64, TITLE_HEIGHT + height * row]));
        }
        let height = TITLE_HEIGHT + height * charts.len().div_ceil(CHARTS_PER_ROW) as f64;
        Figure { width: width * CHARTS_PER_ROW as f64, height, items, is_dark: false }
    }

    fn charts(&self) -> Vec<LineChart> {
        let [a, b] = self.direction;
        let scans = [
            (format!("Sweeps of SOR ({}) by its factor", self.order), &self.factors.iter().collect::<Vec<_>>()),
            ("Sweeps of weighted Jacobi by its factor".to_owned(), &self.weights.iter().collect()),
            (
                format!("Sweeps of Gauss-Seidel ({}), drift along ({a:.2}, {b:.2})", self.order),
                &self.strengths.iter().map(|(_, scan)| scan).collect(),
            ),
        ];
        // Below this strength, central differences are monotone.
        let monotone = 2.0 / a.abs().max(b.abs());
        let marks = [(Factor::Formula.value(self.cells), "formula"), (1.0, "Jacobi"), (monotone, "monotone")];
        let axes = ["factor", "factor", "epsilon (per cell)"].into_iter().zip(marks);
        let of_scans = scans.into_iter().zip(axes).map(|((title, scans), (axis, mark))| LineChart {
            title,
            axes: [axis, "sweeps until it converges"],
            lines: scans.iter().enumerate().map(line).collect(),
            marks: vec![mark],
        });
        self.runs.chunk_by(|a, b| a.equation == b.equation).map(errors).chain(of_scans).collect()
    }
}

/// Returns the line of a scan: its converged relaxations.
fn line((k, scan): (usize, &&ParameterScan)) -> Line {
    let mut points: Vec<Point> = scan.all_points().copied().collect();
    points.sort_by(|a, b| a.at.total_cmp(&b.at));
    let points = points.iter().filter_map(|point| Some([point.at, point.converged()? as f64])).collect();
    Line { name: scan.equation.clone(), pen: lines::pen(k), points, dots: true }
}

/// Draws the relaxations of one equation: their errors, or, if these are unknown, the sum of squared changes in a sweep.
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

/// Returns the pen of a relaxation. The colour depends on the relaxation, the dashes on the order.
fn pen(scheme: Scheme) -> cplan_view::figure::Pen {
    match scheme {
        Scheme::Simultaneous { factor } => lines::pen_of(0, usize::from(factor != 1.0)),
        Scheme::Successive { factor, order } => {
            let dashes = match order {
                Order::Lines(_) => 0,
                Order::Corners(_) => 1,
                Order::RedBlack => 2,
                Order::FourColors => 3,
            };
            lines::pen_of(1 + usize::from(factor == Factor::Formula), dashes)
        }
    }
}
