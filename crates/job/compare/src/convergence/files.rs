//! Convergence as text, CSV and JSON.

use super::{Convergence, ParameterScan, Point, RelaxationRun};
use crate::table::{Align, Column, Table, fixed, quoted};
use cplan_fields::{Ending, Factor, Measure, Relaxation, Sample, Scheme};
use cplan_text::plain_line;
use serde_json::{Value, json};

/// The columns of the CSV file.
const CSV_COLUMNS: &str =
    "series,equation,relaxation,order,factor,epsilon,stage,sweep,squared_change,relative_change,error,ending";

impl Convergence {
    /// Returns the result as text, 80 characters wide.
    pub fn to_text(&self) -> String {
        let [rows, columns] = self.cells;
        let mut text = format!("{}\n", plain_line(&self.title));
        text += &format!(
            "{rows} x {columns} cells, {} free; until the {} of a sweep\nis below {:e}, {} sweeps at the most\n",
            self.free,
            measure_words(self.stopping.measure),
            self.stopping.below,
            self.stopping.max_sweeps
        );
        text += "\nrate: final error factor per sweep; error: greatest, over the initial greatest\n";
        text += &self.table().to_text();
        text +=
            &format!("\nsweeps of SOR ({}) by its factor: best of a scan, by the formula for an empty\n", self.order);
        text += "rectangle, by Jacobi's measured rate\n";
        text += &self.factor_table().to_text();
        text += "\nsweeps of weighted Jacobi by its factor: best of a scan by twentieths, at 1\n";
        text += "(Jacobi itself), and the first factor that does not converge\n";
        text += &self.weight_table().to_text();
        let leaps = self.leap_table();
        if !leaps.rows.is_empty() {
            text += "\nwhere preferences begin: squared changes of the sweeps before and after, and\nsweeps from there on\n";
            text += &leaps.to_text();
        }
        let [a, b] = self.direction;
        text +=
            &format!("\nsweeps of Gauss-Seidel ({}) by epsilon, drift along ({a:.3}, {b:.3}) in cells\n", self.order);
        text += &self.strength_table().to_text();
        text + &self
            .strengths
            .iter()
            .map(|(difference, scan)| describe_divergence(&difference.to_string(), scan))
            .collect::<String>()
    }

    /// Returns a table with one row per relaxation.
    pub fn table(&self) -> Table {
        let row = |run: &RelaxationRun| {
            let RelaxationRun { equation, relaxation, trace } = run;
            vec![
                Some(equation.clone()),
                Some(relaxation.to_string()),
                Some(sweeps(trace.sweeps, trace.ending)),
                fixed(trace.rate(), 5),
                trace.error().map(|error| format!("{error:.1e}")),
            ]
        };
        let columns = columns(&["equation", "relaxation", "sweeps", "rate", "error"], 2);
        Table { columns, rows: self.runs.iter().map(row).collect() }
    }

    /// Returns a table with one row per equation: the numbers of sweeps with the best factor of the scan, with the formula's
    /// factor, and with Young's factor.
    pub fn factor_table(&self) -> Table {
        let cells =
            |point: Option<Point>| [point.map(|p| format!("{:.3}", p.at)), point.map(|p| sweeps(p.sweeps, p.ending))];
        let row = |scan: &ParameterScan| {
            let points = [scan.best(), scan.formula, scan.by_rate];
            [Some(scan.equation.clone())].into_iter().chain(points.into_iter().flat_map(cells)).collect()
        };
        let columns = columns(&["equation", "best", "sweeps", "formula", "sweeps", "by rate", "sweeps"], 1);
        Table { columns, rows: self.factors.iter().map(row).collect() }
    }

    /// Returns a table with one row per equation: the best factor of weighted Jacobi, Jacobi itself (factor 1), and the
    /// first factor that does not converge.
    pub fn weight_table(&self) -> Table {
        let row = |scan: &ParameterScan| {
            let best = scan.best();
            let jacobi = scan.points.iter().find(|point| point.at == 1.0);
            vec![
                Some(scan.equation.clone()),
                best.map(|p| format!("{:.2}", p.at)),
                best.map(|p| sweeps(p.sweeps, p.ending)),
                jacobi.map(|p| sweeps(p.sweeps, p.ending)),
                scan.divergence_start().map(|p| format!("{:.2}", p.at)),
            ]
        };
        let columns = columns(&["equation", "best", "sweeps", "at 1", "lost from"], 1);
        Table { columns, rows: self.weights.iter().map(row).collect() }
    }

    /// Returns a table of the relaxations with two stages, with the jump of the changes when the second stage adds preferences.
    pub fn leap_table(&self) -> Table {
        let row = |run: &RelaxationRun| {
            let leap = run.trace.leap()?;
            let cells = [leap.sweep.to_string(), format!("{:.1e}", leap.before), format!("{:.1e}", leap.after)];
            let names = [run.equation.clone(), run.relaxation.to_string()];
            Some(names.into_iter().chain(cells).chain([leap.more.to_string()]).map(Some).collect())
        };
        let columns = columns(&["equation", "relaxation", "at sweep", "before", "after", "more"], 2);
        Table { columns, rows: self.runs.iter().filter_map(row).collect() }
    }

    /// Returns a table with one row for every fifth strength of the scan.
    pub fn strength_table(&self) -> Table {
        let names = self.strengths.iter().map(|(difference, _)| difference.to_string());
        let columns = std::iter::once("epsilon".to_owned()).chain(names).map(|name| Column::new(&name, Align::Right));
        let count = self.strengths.first().map_or(0, |(_, scan)| scan.points.len());
        let row = |k: usize| {
            let epsilon = self.strengths.first().map(|(_, scan)| format!("{:.1}", scan.points[k].at));
            let points = self.strengths.iter().map(|(_, scan)| scan.points[k]);
            [epsilon].into_iter().chain(points.map(|p| Some(sweeps(p.sweeps, p.ending)))).collect()
        };
        Table { columns: columns.collect(), rows: (0..count).step_by(5).map(row).collect() }
    }

    /// Returns CSV with one line per sample, in full precision. The `series` are: `error` (samples after sweeps), `factor`
    /// (factors of SOR), `weight` (factors of weighted Jacobi) and `epsilon` (strengths of the drift). In the last three, `sweep`
    /// is the total number of sweeps. Columns that do not apply are empty. The last line of a relaxation has its `ending`.
    pub fn to_csv(&self) -> String {
        let mut text = format!("{CSV_COLUMNS}\n");
        for RelaxationRun { equation, relaxation, trace } in &self.runs {
            let head = format!("error,{},{}", quoted(equation), self.relaxation_cells(relaxation));
            for Sample { stage, sweep, squares, relative, error } in &trace.samples {
                let error = error.map_or_else(String::new, |error| format!("{error:e}"));
                let ending = if *sweep == trace.sweeps { word(trace.ending) } else { "" };
                text += &format!("{head},,{stage},{sweep},{squares:e},{relative:e},{error},{ending}\n");
            }
            // Sweeps without finite values leave no samples, but the ending must be reported.
            if trace.samples.last().is_none_or(|sample| sample.sweep != trace.sweeps) {
                text += &format!("{head},,,{},,,,{}\n", trace.sweeps, word(trace.ending));
            }
        }
        // Columns of a point: factor and epsilon, one of which the scan varies.
        let mut add = |series: &str, relaxation: &str, scan: &ParameterScan, columns: fn(f64) -> String| {
            for point in scan.all_points() {
                let (equation, columns, ending) = (quoted(&scan.equation), columns(point.at), word(point.ending));
                text += &format!("{series},{equation},{relaxation},{columns},,{},,,,{ending}\n", point.sweeps);
            }
        };
        let factor = |at: f64| format!("{at},");
        self.factors.iter().for_each(|scan| add("factor", &format!("sor,{}", self.order), scan, factor));
        self.weights.iter().for_each(|scan| add("weight", "weighted-jacobi,", scan, factor));
        for (_, scan) in &self.strengths {
            add("epsilon", &format!("gauss-seidel,{}", self.order), scan, |at| format!("1,{at}"));
        }
        text
    }

    /// Returns all data as a JSON object. A sample is a list of numbers, with null for a value that is unknown or infinite, so
    /// that all samples have the same length.
    pub fn to_json(&self) -> Value {
        let run = |RelaxationRun { equation, relaxation, trace }: &RelaxationRun| {
            let list = |of: &dyn Fn(&Sample) -> Value| trace.samples.iter().map(of).collect::<Vec<_>>();
            let (name, order, factor) = self.parts(relaxation);
            json!({
                "equation": equation,
                "relaxation": name,
                "order": order,
                "factor": factor,
                "sweeps": trace.sweeps,
                "ending": word(trace.ending),
                "rate": trace.rate(),
                "leap": trace.leap().map(|leap| json!({
                    "sweep": leap.sweep, "before": leap.before, "after": leap.after, "more": leap.more,
                })),
                "samples": {
                    "stage": list(&|s| s.stage.into()),
                    "sweep": list(&|s| s.sweep.into()),
                    "squared_change": list(&|s| s.squares.into()),
                    "relative_change": list(&|s| s.relative.into()),
                    "error": list(&|s| s.error.into()),
                },
            })
        };
        let scan = |name: &str, scan: &ParameterScan| {
            let points: Vec<Value> = scan.points.iter().map(|p| point(name, p)).collect();
            json!({ "equation": scan.equation, "points": points })
        };
        let with_best = |of: &ParameterScan| {
            let mut object = scan("factor", of);
            object["best"] = of.best().map(|p| point("factor", &p)).into();
            object
        };
        let factor = |of: &ParameterScan| {
            let mut object = with_best(of);
            object["formula"] = of.formula.map(|p| point("factor", &p)).into();
            object["by_rate"] = of.by_rate.map(|p| point("factor", &p)).into();
            object
        };
        json!({
            "title": self.title,
            "cells": self.cells,
            "free": self.free,
            "measure": measure_word(self.stopping.measure),
            "below": self.stopping.below,
            "max_sweeps": self.stopping.max_sweeps,
            "order": self.order.to_string(),
            "direction": self.direction,
            "relaxations": self.runs.iter().map(run).collect::<Vec<_>>(),
            "factors": self.factors.iter().map(factor).collect::<Vec<_>>(),
            "weights": self.weights.iter().map(with_best).collect::<Vec<_>>(),
            "epsilons": self.strengths.iter().map(|(_, of)| scan("epsilon", of)).collect::<Vec<_>>(),
        })
    }

    /// Returns the name, the order and the factor of a relaxation on this domain.
    fn parts(&self, relaxation: &Relaxation) -> (&'static str, Option<String>, f64) {
        let factor = relaxation.factor(self.cells);
        match relaxation.scheme {
            Scheme::Simultaneous { factor: 1.0 } => ("jacobi", None, factor),
            Scheme::Simultaneous { .. } => ("weighted-jacobi", None, factor),
            Scheme::Successive { factor: Factor::Given(1.0), order } => {
                ("gauss-seidel", Some(order.to_string()), factor)
            }
            Scheme::Successive { order, .. } => ("sor", Some(order.to_string()), factor),
        }
    }

    fn relaxation_cells(&self, relaxation: &Relaxation) -> String {
        let (name, order, factor) = self.parts(relaxation);
        format!("{name},{},{factor}", order.unwrap_or_default())
    }
}

fn point(name: &str, point: &Point) -> Value {
    json!({ name: point.at, "sweeps": point.sweeps, "ending": word(point.ending) })
}

fn columns(names: &[&str], words: usize) -> Vec<Column> {
    let align = |k: usize| if k < words { Align::Left } else { Align::Right };
    names.iter().enumerate().map(|(k, name)| Column::new(name, align(k))).collect()
}

fn sweeps(count: usize, ending: Ending) -> String {
    match ending {
        Ending::Converged => count.to_string(),
        Ending::Unconverged => format!("> {count}"),
        Ending::Diverged => "diverges".to_owned(),
    }
}

fn describe_divergence(name: &str, scan: &ParameterScan) -> String {
    match scan.divergence_start() {
        None => format!("{name}: converge at the last epsilon tried\n"),
        Some(point) => {
            let how = if point.ending == Ending::Diverged { "diverge" } else { "do not converge" };
            format!("{name}: {how} from epsilon {:.1} on\n", point.at)
        }
    }
}

fn word(ending: Ending) -> &'static str {
    match ending {
        Ending::Converged => "converged",
        Ending::Unconverged => "unconverged",
        Ending::Diverged => "diverged",
    }
}

fn measure_word(measure: Measure) -> &'static str {
    match measure {
        Measure::SumOfChange => "sum",
        Measure::SumOfSquares => "squares",
        Measure::DifferenceOfSums => "sums",
        Measure::GreatestChange => "greatest",
        Measure::GreatestRelativeChange => "relative",
    }
}

fn measure_words(measure: Measure) -> &'static str {
    match measure {
        Measure::SumOfChange => "sum of changes",
        Measure::SumOfSquares => "sum of squared changes",
        Measure::DifferenceOfSums => "difference to the sum of changes of the previous sweep",
        Measure::GreatestChange => "greatest change",
        Measure::GreatestRelativeChange => "greatest relative change",
    }
}
