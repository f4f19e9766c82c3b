//! Outcomes of each problem, as bars and as a matrix.

use super::markup::{margin, name_before, number};
use crate::{Comparison, Measure, Row, Study, labels};
use cplan_core::model::Status;
use cplan_text::markup;

/// Width of the bars, in pixels.
const BAR_WIDTH: f64 = 460.0;
/// Height of a planner's line, in pixels.
const ROW_HEIGHT: f64 = 28.0;
/// Width in pixels that a number and a sign take.
const NUMBER_WIDTH: f64 = 44.0;

/// Draws one bar per planner, with three pieces: the problems that it solved, those that it proved infeasible, and
/// those that it left open. Each piece shows its sign, and its number if there is room.
pub fn bars(study: &Study) -> String {
    let planners = study.planners();
    let height = ROW_HEIGHT * planners.len() as f64 + 4.0;
    let mut svg = format!(
        "<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Outcomes of each planner\">\n",
        number(BAR_WIDTH),
        number(height)
    );
    let names = labels(&planners);
    let from = margin(&names.iter().map(String::as_str).collect::<Vec<_>>());
    let all = study.comparisons.len().max(1) as f64;
    for (i, name) in planners.iter().enumerate() {
        let top = ROW_HEIGHT * i as f64 + 4.0;
        svg += &name_before(&names[i], from - 10.0, top + 15.0);
        let mut left = from;
        for (outcome, count) in Status::ALL.into_iter().zip(study.tally(i)).filter(|(_, count)| *count > 0) {
            let width = (BAR_WIDTH - from) * count as f64 / all;
            svg += &format!("<g class=\"o-{outcome}\"><title>{}: {count} {outcome}</title>", markup(name));
            svg += &format!(
                "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"20\"/>",
                number(left),
                number(top),
                number((width - 1.0).max(0.5))
            );
            let sign = sign(outcome);
            let text = if width > NUMBER_WIDTH { format!("{sign} {count}") } else { sign.to_string() };
            if width > NUMBER_WIDTH / 4.0 {
                let middle = number(left + width / 2.0);
                svg += &format!("<text class=\"count\" x=\"{middle}\" y=\"{}\">{text}</text>", number(top + 14.5));
            }
            svg += "</g>\n";
            left += width;
        }
    }
    svg + "</svg>\n"
}

/// Returns the legend of the signs.
pub fn key() -> String {
    let meaning = |outcome| match outcome {
        Status::Found => "a certified path; the number is its length over the proven optimum",
        Status::Infeasible => "no path, proven",
        Status::Unknown => "neither, at the finest resolution tried",
    };
    let entry =
        |outcome| format!("<li><span class=\"o-{outcome} sign\">{}</span> {}</li>", sign(outcome), meaning(outcome));
    format!("<ul class=\"key\">{}</ul>\n", Status::ALL.map(entry).concat())
}

fn sign(outcome: Status) -> char {
    match outcome {
        Status::Found => '\u{2713}',
        Status::Infeasible => '\u{2205}',
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
