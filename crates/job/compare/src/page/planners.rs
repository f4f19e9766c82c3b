//! The tables of planners: on one problem, and over many.

use super::cards::short_names;
use super::markup::number;
use super::outcomes::sign;
use super::paths::PathPictures;
use super::quantities::{clearance, computing_time, duration, excess, memory, path_length};
use super::ranking::{RankedColumn, RankedRow, table};
use crate::{Better, Comparison, Family, Measure, Purpose, Row, Study, hue};
use cplan_model::Status;
use cplan_text::markup;

/// Writes the pictures and the table of one problem. Each lights up the paths in the other.
pub fn of_problem(comparison: &Comparison, picture: Option<&PathPictures>) -> String {
    let pictures = picture.map_or_else(String::new, |picture| {
        format!(
            "{}<div class=\"pictures\">\n{}{}</div>\n",
            picture.shared_parts(),
            picture.large(&comparison.problem),
            hint(comparison)
        )
    });
    let columns = columns(comparison);
    let rows = rows(comparison, picture);
    format!(
        "<div class=\"compared\">\n{pictures}{}{}</div>\n",
        families(comparison),
        table(&format!("Planners on {}", comparison.problem), "outcome", &rows, &columns)
    )
}

/// Returns the line below the pictures, which a script replaces by the description of the lit path.
fn hint(comparison: &Comparison) -> String {
    if comparison.rows.iter().all(|row| row.length.is_none()) {
        return String::new();
    }
    "<p class=\"lit-path\" role=\"status\" data-hint=\"Point at a row or a path to light it up; click to keep it lit.\"></p>\n".to_owned()
}

/// Returns the legend of the families' hues.
fn families(comparison: &Comparison) -> String {
    let of = |family: &Family| {
        let (hue, name) = (hue(*family).name(), family.name());
        format!("<li><span class=\"hue\" style=\"background: var(--{hue}-0)\"></span>{name}</li>")
    };
    let is_there = |family: &Family| comparison.rows.iter().any(|row| row.family == *family);
    let all: Vec<String> = Family::ALL.iter().filter(|family| is_there(family)).map(of).collect();
    if all.len() < 2 { String::new() } else { format!("<ul class=\"families\">{}</ul>\n", all.concat()) }
}

fn rows(comparison: &Comparison, picture: Option<&PathPictures>) -> Vec<RankedRow> {
    let (names, pens) = (short_names(comparison), comparison.pens());
    let row = |(index, row): (usize, &Row)| {
        let path = comparison.path_index(index);
        let small = picture.zip(path).map(|(picture, path)| picture.small(1, path, pens[index], ""));
        let title = row.reason.as_deref().map_or_else(String::new, |reason| format!(" title=\"{}\"", markup(reason)));
        let (outcome, sign) = (row.outcome, sign(row.outcome));
        let order = Status::ALL.iter().position(|status| *status == outcome).unwrap_or_default();
        RankedRow {
            name: row.planner.clone(),
            label: names[index].clone(),
            pen: pens[index],
            path,
            picture: small.unwrap_or_default(),
            outcome: (
                order as f64,
                format!("<span class=\"o-{outcome}\"{title}><span class=\"sign\">{sign}</span> {outcome}</span>"),
            ),
            description: description(comparison, row, &names[index]),
            is_ranked: row.outcome != Status::Unknown,
        }
    };
    comparison.rows.iter().enumerate().map(row).collect()
}

/// Describes a row's path in one line.
fn description(comparison: &Comparison, row: &Row, name: &str) -> String {
    let facts = [
        row.length.map(|length| path_length(length, &comparison.length_unit)),
        comparison.over_optimum(row).map(|ratio| format!("at most {} longer than the optimum", excess(ratio))),
        row.clearance.map(|metres| format!("keeps {}", clearance(metres))),
        row.duration.map(|seconds| format!("moves {}", duration(seconds))),
    ];
    format!("{name}: {}", facts.into_iter().flatten().collect::<Vec<_>>().join(", "))
}

fn columns(comparison: &Comparison) -> Vec<RankedColumn> {
    let unit = comparison.length_unit.as_str();
    let of = |value: fn(&Row) -> Option<f64>| -> Vec<Option<f64>> { comparison.rows.iter().map(value).collect() };
    let over = comparison.rows.iter().map(|row| comparison.over_optimum(row)).collect();
    let all = vec![
        RankedColumn::new("length", "Euclidean length in joint space", Better::Less, of(|row| row.length), |v| {
            path_length(v, unit)
        }),
        RankedColumn::new(
            "over optimum",
            "Proven bound on how much longer the path is than the shortest one",
            Better::Less,
            over,
            excess,
        )
        .measured_from(1.0),
        RankedColumn::new(
            "clearance",
            "Proven distance from all obstacles along the motion",
            Better::More,
            of(|row| Purpose::Safest.value(row)),
            clearance,
        ),
        RankedColumn::new("motion", "Duration of the motion", Better::Less, of(|row| row.duration), duration),
        RankedColumn::new(
            "computed in",
            "Computing time from the problem to the answer",
            Better::Less,
            of(|row| row.total),
            computing_time,
        ),
        RankedColumn::new(
            "memory",
            "Greatest amount of memory at a time",
            Better::Less,
            of(|row| row.memory.map(|bytes| bytes as f64)),
            memory,
        ),
    ];
    all.into_iter().filter(has_values).collect()
}

fn has_values(column: &RankedColumn) -> bool {
    column.values.iter().any(Option::is_some)
}

/// Writes the table of planners over all problems of a study.
pub fn of_study(study: &Study) -> String {
    let Some(first) = study.comparisons.first() else { return String::new() };
    let (names, pens, all) = (short_names(first), first.pens(), study.comparisons.len());
    let row = |index: usize| {
        let [found, infeasible, unknown] = study.tally(index);
        let share = |count: usize| number(100.0 * count as f64 / all as f64);
        let piece = |status: Status, count: usize| {
            (count > 0).then(|| format!("<i class=\"o-{status}\" style=\"width: {}%\"></i>", share(count)))
        };
        let pieces: String = Status::ALL
            .into_iter()
            .zip([found, infeasible, unknown])
            .filter_map(|(status, count)| piece(status, count))
            .collect();
        let open = if unknown > 0 { format!(", <span class=\"o-unknown\">{unknown} ?</span>") } else { String::new() };
        RankedRow {
            name: first.rows[index].planner.clone(),
            label: names[index].clone(),
            pen: pens[index],
            path: None,
            picture: String::new(),
            outcome: (
                unknown as f64,
                format!(
                    "<span class=\"o-found\">{found} {}</span>, <span class=\"o-infeasible\">{infeasible} {}</span>{open}<span \
                     class=\"bar outcome\">{pieces}</span>",
                    sign(Status::Found),
                    sign(Status::Infeasible)
                ),
            ),
            description: String::new(),
            is_ranked: true,
        }
    };
    let planners = 0..first.rows.len();
    let rows: Vec<RankedRow> = planners.clone().map(row).collect();
    let wins = |heading, hint, purpose| {
        let values = planners.clone().map(|planner| Some(study.wins(planner, purpose) as f64)).collect();
        RankedColumn::new(heading, hint, Better::More, values, |wins| format!("{wins}"))
    };
    let median = |heading, hint, measure: Measure, show: fn(f64) -> String| {
        let values =
            planners.clone().map(|planner| study.spread(planner, measure).map(|spread| spread.median)).collect();
        RankedColumn::new(heading, hint, measure.better(), values, show)
    };
    let columns = vec![
        wins("shortest", "Number of problems with no shorter path", Purpose::Shortest),
        wins("safest", "Number of problems with no greater clearance", Purpose::Safest),
        wins("quickest", "Number of problems with no quicker path", Purpose::Quickest),
        median(
            "over optimum",
            "Median of the proven bounds on how much longer the paths are than the optimum",
            Measure::OverOptimum,
            excess,
        )
        .measured_from(1.0),
        median("clearance", "Median of the proven clearance", Measure::Clearance, clearance),
        median("motion", "Median of the motions' durations", Measure::Duration, duration),
        median("computed in", "Median of the computing times", Measure::Total, computing_time),
        median("memory", "Median of the greatest memory at a time", Measure::Memory, memory),
    ];
    let columns: Vec<RankedColumn> = columns.into_iter().filter(has_values).collect();
    format!(
        "{}{}<p class=\"sub\">Shortest, safest, quickest: the number of problems in which no planner is better. The other columns are medians.</p>\n",
        families(first),
        table("Planners over all problems", "outcomes", &rows, &columns)
    )
}
