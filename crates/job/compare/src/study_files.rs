//! A study as tables, CSV and JSON.

use super::comparison::{CSV_HEADER, Comparison};
use super::measure::Measure;
use super::row::Row;
use super::study::{Refusal, Study};
use super::table::{Align, Column, Emphasis, MAX_TABLE_WIDTH, Table, quoted};
use super::words::words;
use cplan_model::Status;
use cplan_text::{plain, plain_line, wrapped};
use serde_json::{Value, json};

/// Largest number of problems that tables list one by one. CSV, JSON and the page always list all of them.
const MAX_LISTED_PROBLEMS: usize = 60;

/// Largest number of remarks of planners below the tables.
const MAX_REMARKS: usize = 12;

impl Study {
    /// Returns tables for a terminal: outcomes, the distribution of each measure, and the summary in words. Lists the problems
    /// one by one if they differ in more than start and goal. The text ends in a newline. Control characters in names are
    /// escaped, and the best value of each column is emphasised.
    pub fn to_text(&self, is_wide: bool, emphasis: Emphasis) -> String {
        let width = if is_wide { usize::MAX } else { MAX_TABLE_WIDTH };
        let mut text = format!("{}\n", plain_line(&self.title));
        for (heading, table) in self.tables() {
            text += &format!("\n{}\n{}", plain_line(&heading), table.to_text_within(width, emphasis));
        }
        let paragraphs = words(self).into_iter().map(|paragraph| wrapped(&plain(&paragraph), MAX_TABLE_WIDTH, 0));
        text += &format!("\n{}\n", paragraphs.collect::<Vec<_>>().join("\n"));
        text + &self.footnotes().map(|line| wrapped(&plain(&line), MAX_TABLE_WIDTH, 2) + "\n").collect::<String>()
    }

    /// Returns the same content as [`Study::to_text`] in Markdown.
    pub fn to_markdown(&self) -> String {
        let mut text = format!("# {}\n", escape_markdown(&self.title));
        for paragraph in words(self) {
            text += &format!("\n{}\n", escape_markdown(&paragraph));
        }
        for (heading, table) in self.tables() {
            text += &format!("\n## {}\n\n{}", escape_markdown(&heading), table.to_markdown());
        }
        let notes: String = self.footnotes().map(|line| format!("- {}\n", escape_markdown(&line))).collect();
        if notes.is_empty() { text } else { format!("{text}\n{notes}") }
    }

    /// Returns CSV with one line per run, in SI units with full precision: the problem, start and goal if they were drawn, and
    /// the columns of [`Comparison::to_csv`].
    pub fn to_csv(&self) -> String {
        let mut text = format!("problem,start_1,start_2,goal_1,goal_2,{CSV_HEADER}\n");
        for comparison in &self.comparisons {
            let ends = comparison.query.map_or_else(
                || ",,,".to_owned(),
                |[start, goal]| format!("{},{},{},{}", start[0], start[1], goal[0], goal[1]),
            );
            for row in &comparison.rows {
                text += &format!("{},{ends},{}\n", quoted(&comparison.problem), comparison.csv_row(row));
            }
        }
        let columns = CSV_HEADER.matches(',').count();
        for Refusal { problem, reason, .. } in &self.refused {
            // The columns of start, goal and planner are empty, and the last column has the reason.
            let empty = ",".repeat(columns - 1);
            text += &format!("{},,,,,,refused{empty}{}\n", quoted(problem), quoted(reason));
        }
        text
    }

    /// Returns a JSON object in SI units: all runs of all problems, each planner's outcomes and distributions, and the
    /// conclusions.
    pub fn to_json(&self) -> Value {
        let mut object = json!({
            "title": self.title,
            "problems": self.comparisons.iter().map(Comparison::to_json).collect::<Vec<_>>(),
            "planners": self.planners().iter().enumerate().map(|(i, name)| self.planner_json(i, name)).collect::<Vec<_>>(),
            "summary": words(self),
            "contradictions": self.alarms(),
            "left_out": self.left_out,
            "refused": self.refused.iter().map(Refusal::json).collect::<Vec<_>>(),
        });
        if let Some(sampling) = self.sampling {
            object["queries"] = json!(sampling.queries);
            object["seed"] = json!(sampling.seed);
        }
        object
    }

    fn planner_json(&self, planner: usize, name: &str) -> Value {
        let [found, infeasible, unknown] = self.tally(planner);
        let mut object = json!({
            "planner": name, "found": found, "infeasible": infeasible, "unknown": unknown, "total": self.comparisons.len(),
        });
        let spreads = Measure::ALL.iter().filter_map(|&m| Some((m, self.spread(planner, m)?)));
        let spreads: serde_json::Map<String, Value> = spreads
            .map(|(measure, s)| {
                let numbers = json!({
                    "n": s.n, "min": s.min, "lower_quartile": s.lower_quartile, "median": s.median,
                    "upper_quartile": s.upper_quartile, "max": s.max, "mean": s.mean,
                });
                (measure.key().to_owned(), numbers)
            })
            .collect();
        object["distributions"] = Value::Object(spreads);
        object
    }

    /// Returns all tables with their headings.
    pub fn tables(&self) -> Vec<(String, Table)> {
        let mut tables = vec![("outcomes".to_owned(), self.outcomes())];
        let spreads = Measure::ALL.into_iter().map(|m| (m.heading().to_owned(), self.spreads(m)));
        tables.extend(spreads.filter(|(_, table)| !table.rows.is_empty()));
        if self.sampling.is_none() && self.comparisons.len() <= MAX_LISTED_PROBLEMS {
            tables.push(("length over the proven optimum, problem by problem".to_owned(), self.problems()));
        }
        tables
    }

    fn outcomes(&self) -> Table {
        let mut columns = vec![Column::new("planner", Align::Left)];
        let refused = (!self.refused.is_empty()).then_some(self.refused.len());
        let names =
            ["found", "infeasible", "unknown"].into_iter().chain(refused.map(|_| "refused")).chain(["problems"]);
        columns.extend(names.map(|name| Column::new(name, Align::Right)));
        let row = |(i, name): (usize, &&str)| {
            let all = self.comparisons.len() + self.refused.len();
            let counts = self.tally(i).into_iter().chain(refused).chain([all]);
            [Some((*name).to_owned())].into_iter().chain(counts.map(|n| Some(n.to_string()))).collect()
        };
        Table { columns, rows: self.planners().iter().enumerate().map(row).collect() }
    }

    fn spreads(&self, measure: Measure) -> Table {
        const SPREAD_NAMES: [&str; 7] = ["n", "min", "quartile", "median", "quartile", "max", "mean"];
        let mut columns = vec![Column::new("planner", Align::Left)];
        columns.extend(SPREAD_NAMES.map(|name| Column::new(name, Align::Right)));
        let row = |(i, name): (usize, &&str)| -> Option<Vec<Option<String>>> {
            let spread = self.spread(i, measure)?;
            let numbers = spread.numbers().map(|value| measure.format(value));
            let cells = [(*name).to_owned(), spread.n.to_string()].into_iter().chain(numbers);
            Some(cells.map(Some).collect())
        };
        let rows: Vec<Vec<Option<String>>> = self.planners().iter().enumerate().filter_map(row).collect();
        let columns = columns.into_iter().enumerate().map(|(k, column)| {
            let shown: Vec<Option<String>> = rows.iter().map(|row| row[k].clone()).collect();
            let values: Vec<Option<f64>> = shown.iter().map(|text| text.as_ref()?.parse().ok()).collect();
            // The first column has names, the second one counts.
            column.with_best(if k < 2 { Vec::new() } else { measure.better().that_stand_out(&values, &shown) })
        });
        Table { columns: columns.collect(), rows }
    }

    fn problems(&self) -> Table {
        let mut columns = vec![Column::new("problem", Align::Left)];
        columns.extend(self.planners().iter().map(|name| Column::new(name, Align::Right)));
        let cell = |c: &Comparison, row: &Row| match (row.outcome, c.over_optimum(row)) {
            (Status::Found, Some(ratio)) => Measure::OverOptimum.format(ratio),
            (outcome, _) => outcome.to_string(),
        };
        let row = |c: &Comparison| {
            [Some(c.problem.clone())].into_iter().chain(c.rows.iter().map(|row| Some(cell(c, row)))).collect()
        };
        Table { columns, rows: self.comparisons.iter().map(row).collect() }
    }

    /// Iterates over the notes of planners, the omissions, and finally the contradictions, so that nobody overlooks them.
    pub(super) fn footnotes(&self) -> impl Iterator<Item = String> + '_ {
        let of = |c: &'_ Comparison| -> Vec<String> {
            c.rows.iter().flat_map(Row::remarks).map(|remark| format!("{}: {remark}", c.problem)).collect()
        };
        let mut remarks: Vec<String> = self.comparisons.iter().flat_map(of).collect();
        if remarks.len() > MAX_REMARKS {
            let more = format!("and {} more such remarks, in the CSV and JSON files", remarks.len() - MAX_REMARKS);
            remarks.truncate(MAX_REMARKS);
            remarks.push(more);
        }
        let refused =
            self.refused.iter().map(|Refusal { problem, reason, .. }| format!("{problem} was not run: {reason}"));
        remarks.into_iter().chain(self.left_out.iter().cloned()).chain(refused).chain(self.alarms())
    }
}

impl Refusal {
    fn json(&self) -> Value {
        json!({ "problem": self.problem, "kind": self.kind, "reason": self.reason })
    }
}

/// Escapes Markdown markup.
fn escape_markdown(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        if matches!(c, '\\' | '`' | '*' | '_' | '<' | '>' | '[' | ']' | '#' | '|') {
            escaped.push('\\');
        }
        escaped.push(if c == '\n' { ' ' } else { c });
    }
    escaped
}
