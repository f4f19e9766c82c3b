//! Outcomes of each problem, as a matrix.

use crate::{Comparison, Measure, Row, Study};
use cplan_model::Status;
use cplan_text::markup;

/// Returns the legend of the signs.
pub fn key() -> String {
    let meaning = |outcome| match outcome {
        Status::Found => "a certified path; the number is its length / the proven optimum",
        Status::Infeasible => "no path, proven",
        Status::Unknown => "neither a path nor a proof, at the finest resolution tried",
    };
    let entry =
        |outcome| format!("<li><span class=\"o-{outcome} sign\">{}</span> {}</li>", sign(outcome), meaning(outcome));
    format!("<ul class=\"key\">{}</ul>\n", Status::ALL.map(entry).concat())
}

/// Returns the sign of an outcome.
pub fn sign(outcome: Status) -> char {
    match outcome {
        Status::Found => '\u{2713}',
        Status::Infeasible => '\u{2715}',
        Status::Unknown => '?',
    }
}

/// Draws one line per problem and one column per planner. Each cell has a sign and a figure; its colour repeats the
/// sign.
pub fn matrix(study: &Study) -> String {
    let head: String = study.planners().iter().map(|name| format!("<th scope=\"col\">{}</th>", markup(name))).collect();
    let cell = |c: &Comparison, row: &Row| {
        let outcome = row.outcome;
        let figure = c.over_optimum(row).map_or_else(String::new, |v| format!(" {}", Measure::OverOptimum.format(v)));
        let title = row.reason.as_deref().map_or_else(String::new, |r| format!(" title=\"{}\"", markup(r)));
        format!("<td class=\"o-{outcome}\"{title}><span class=\"sign\">{}</span>{figure}</td>", sign(outcome))
    };
    let line = |c: &Comparison| {
        let cells: String = c.rows.iter().map(|row| cell(c, row)).collect();
        format!("<tr><th scope=\"row\">{}</th>{cells}</tr>\n", markup(&c.problem))
    };
    let lines: String = study.comparisons.iter().map(line).collect();
    format!(
        "<div class=\"wide\" tabindex=\"0\"><table class=\"matrix\">\n<thead><tr><th scope=\"col\">problem</th>{head}</tr></thead>\n\
         <tbody>\n{lines}</tbody>\n</table></div>\n"
    )
}
