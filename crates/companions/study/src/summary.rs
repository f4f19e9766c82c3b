//! Summary of a study: how many layouts have a motion, why others have none, and which are best.

use super::Study;
use super::answer::{label, measured, with_unit};
use super::measure::Measure;
use super::parameter::{Parameter, Values};
use super::row::{Ending, Row};
use cplan_compare::{Align, Column, MAX_TABLE_WIDTH, PLAIN, Table};
use cplan_text::counted;
use serde_json::{Value, json};
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// Largest number of reasons that are listed.
const MAX_REASONS: usize = 6;

/// Distance from an end of the range up to which a value counts as being at that end, as a fraction of the range.
const RANGE_END_SHARE: f64 = 0.05;

/// Indentation of tables.
const INDENT: &str = "  ";

/// Largest number of layouts that are listed as the best, and of those that are listed as the worst.
const LISTED_LAYOUTS: usize = 5;

/// The summary of all rows of a study.
#[derive(Debug, Clone)]
pub struct Summary<'a> {
    study: &'a Study,
    rows: &'a [Row],
    /// Number of rows of the study itself. The rows after them come from the search.
    designed: usize,
    /// Indices of the rows that have a motion and satisfy the conditions, the best first.
    ranked: Vec<usize>,
}

impl<'a> Summary<'a> {
    /// Summarises these rows. The rows of the search must follow those of the study's own layouts.
    pub fn new(study: &'a Study, rows: &'a [Row]) -> Self {
        let mut ranked: Vec<usize> = (0..rows.len()).filter(|&i| study.cost(&rows[i]).is_finite()).collect();
        ranked.sort_by(|&a, &b| study.cost(&rows[a]).total_cmp(&study.cost(&rows[b])).then(a.cmp(&b)));
        Self { study, rows, designed: study.count().min(rows.len()), ranked }
    }

    /// Returns the number of rows with each ending, in the order of [`Ending::ALL`].
    pub fn tally(&self) -> [usize; 4] {
        tally(self.rows)
    }

    /// Returns the number of rows of the search with each ending, in the same order.
    pub fn searched(&self) -> [usize; 4] {
        tally(&self.rows[self.designed..])
    }

    /// Returns the best layout. `None` if none has a motion that satisfies the conditions.
    pub fn best(&self) -> Option<&'a Row> {
        self.ranked.first().map(|&i| &self.rows[i])
    }

    /// Returns the worst layout that has a motion and satisfies the conditions.
    pub fn worst(&self) -> Option<&'a Row> {
        self.ranked.last().map(|&i| &self.rows[i])
    }

    /// Returns the reasons why layouts have no motion, the most frequent first. Each has the ending, the first cause
    /// with `#` for numbers, and the number of layouts.
    pub fn reasons(&self) -> Vec<(Ending, String, usize)> {
        let mut counts: BTreeMap<(Ending, String), usize> = BTreeMap::new();
        for row in self.rows {
            if let Some(reason) = &row.reason {
                *counts.entry((row.ending, first_cause(reason))).or_default() += 1;
            }
        }
        let mut reasons: Vec<_> = counts.into_iter().map(|((ending, reason), count)| (ending, reason, count)).collect();
        reasons.sort_by_key(|(.., count)| Reverse(*count));
        reasons
    }

    /// Returns the Pareto front of two measures, sorted by the first one. No other layout is better in both measures
    /// than a layout on the front. Of layouts that are equal in one measure, only the best in the other one is
    /// included. Less is better, except for the clearance.
    pub fn pareto(&self, measures: [Measure; 2]) -> Vec<&'a Row> {
        let cost = |row: &Row, k: usize| {
            let value = row.measured[self.study.column(measures[k])?]?;
            Some(if measures[k] == Measure::Clearance { -value } else { value })
        };
        let mut costs: Vec<([f64; 2], &Row)> = self
            .rows
            .iter()
            .filter(|row| row.fits)
            .filter_map(|row| Some(([cost(row, 0)?, cost(row, 1)?], row)))
            .collect();
        costs.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let mut least = f64::INFINITY;
        let is_front = |(cost, _): &([f64; 2], &'a Row)| {
            let is_less = cost[1] < least;
            least = least.min(cost[1]);
            is_less
        };
        costs.into_iter().filter(is_front).map(|(_, row)| row).collect()
    }

    /// Returns a line for each parameter whose value in the best layout is at an end of its range. A better layout may
    /// lie beyond.
    pub fn edges(&self) -> Vec<String> {
        let edge = |(parameter, value, _): (&Parameter, f64, _)| {
            let [from, to] = parameter.values.range();
            let which = if to - value <= value - from { format!("ends at {to}") } else { format!("begins at {from}") };
            // The digits of tables, without trailing zeros.
            let value = format_value(value).parse().unwrap_or(value);
            format!(
                "the best {} is {value}, and its range {which}: a wider range may give a better layout",
                parameter.name
            )
        };
        self.range_ends().into_iter().map(edge).collect()
    }

    /// Returns the parameters whose value in the best layout is at an end of the range, with that value, and with words
    /// that state whether it is exactly the end.
    pub(super) fn range_ends(&self) -> Vec<(&'a Parameter, f64, &'static str)> {
        let Some(best) = self.best() else { return Vec::new() };
        let end = |(parameter, &value): (&'a Parameter, &f64)| {
            let [from, to] = match parameter.values {
                Values::Stepped { from, to, .. } | Values::Drawn { from, to, .. } if from < to => [from, to],
                _ => return None,
            };
            let distance = (to - value).min(value - from);
            let at = if distance == 0.0 { "at the end of" } else { "near the end of" };
            (distance <= RANGE_END_SHARE * (to - from)).then_some((parameter, value, at))
        };
        self.study.parameters.iter().zip(&best.values).filter_map(end).collect()
    }

    /// Returns the summary for a terminal of 80 characters, or with full tables if `wide`. Ends in a newline.
    pub fn to_text(&self, wide: bool) -> String {
        let study = self.study;
        let [rows, parameters] = [counted(self.rows.len(), "layout"), counted(study.parameters.len(), "parameter")];
        let mut text = format!("{}: {rows}, {parameters}\n", study.name);
        for (ending, count) in Ending::ALL.into_iter().zip(self.tally()).filter(|(_, count)| *count > 0) {
            text += &format!("  {:<11} {count:>8}  {:5.1} %\n", ending.name(), percentage(count, self.rows.len()));
        }
        if !study.conditions.is_empty() {
            let fitting = self.rows.iter().filter(|row| row.fits).count();
            let conditions: Vec<String> = study.conditions.iter().map(ToString::to_string).collect();
            let (share, conditions) = (percentage(fitting, self.rows.len()), conditions.join(", "));
            text += &format!("  {:<11} {fitting:>8}  {share:5.1} %  ({conditions})\n", "fit");
        }
        if self.rows.len() > self.designed {
            let [found, infeasible, ..] = self.searched();
            let tried = counted(self.rows.len() - self.designed, "layout");
            text += &format!("  the search tried {tried}: {found} with a motion, {infeasible} proven infeasible\n");
        }
        if study.searched > 0 && self.rows.len() == study.count() {
            text += "  the search found no new layout to try\n";
        }
        let reasons = self.reasons();
        if !reasons.is_empty() {
            text += "why there is no motion:\n";
            for (ending, reason, count) in reasons.iter().take(MAX_REASONS) {
                text += &format!("  {count:>8}  {}: {reason}\n", ending.name());
            }
            let others: usize = reasons.iter().skip(MAX_REASONS).map(|(.., count)| count).sum();
            if others > 0 {
                let kinds = counted(reasons.len() - MAX_REASONS, "other cause");
                text += &format!("  {others:>8}  for {kinds}; see the table\n");
            }
        }
        if let (Some(objective), Some(_)) = (study.objective, self.best()) {
            let width = if wide { usize::MAX } else { MAX_TABLE_WIDTH - INDENT.len() };
            let table = |table: Table| table.to_text_within(width, PLAIN);
            let best = table(self.table(self.ranked.iter().take(LISTED_LAYOUTS)));
            text += &format!("best ({objective}):\n{}", indented(&best));
            self.edges().iter().for_each(|edge| text += &format!("  {edge}\n"));
            if self.ranked.len() > LISTED_LAYOUTS {
                let worst = table(self.table(self.ranked.iter().rev().take(1)));
                text += &format!("worst:\n{}", indented(&worst));
            }
        }
        text
    }

    /// Returns the summary as a JSON object.
    pub fn to_json(&self) -> Value {
        let counts = |tally: [usize; 4]| -> Value {
            Ending::ALL.into_iter().zip(tally).map(|(ending, count)| (ending.name().to_owned(), json!(count))).collect()
        };
        let reasons: Vec<Value> = self
            .reasons()
            .into_iter()
            .map(|(ending, reason, count)| json!({ "outcome": ending.name(), "reason": reason, "layouts": count }))
            .collect();
        json!({
            "name": self.study.name,
            "layouts": self.rows.len(),
            "outcomes": counts(self.tally()),
            "fit": self.rows.iter().filter(|row| row.fits).count(),
            "search": (self.rows.len() > self.designed).then(|| counts(self.searched())),
            "reasons": reasons,
            "objective": self.study.objective.map(|objective| objective.to_string()),
            "best": self.best().map(|row| self.object(row)),
            "worst": self.worst().map(|row| self.object(row)),
            "edges": self.edges(),
            "options": self.study.options(),
        })
    }

    fn object(&self, row: &Row) -> Value {
        let study = self.study;
        let values = study.parameters.iter().zip(&row.values).map(|(p, value)| (p.name.clone(), json!(value)));
        let measured = study.measures.iter().zip(&row.measured).map(|(m, value)| (m.name().to_owned(), json!(value)));
        json!({ "layout": row.layout, "parameters": Value::from_iter(values), "measured": Value::from_iter(measured) })
    }

    /// Iterates over the rows of the table of the best layouts.
    pub(super) fn best_rows(&self) -> impl Iterator<Item = &'a Row> {
        let rows = self.rows;
        self.ranked.iter().take(2 * LISTED_LAYOUTS).map(move |&i| &rows[i])
    }

    /// Returns the table of the best layouts for readers, with the names and units of the page.
    pub(super) fn best_table(&self) -> Table {
        let study = self.study;
        let order = self.measure_order();
        let mut columns = vec![Column::new("layout", Align::Right)];
        columns.extend(study.parameters.iter().map(|parameter| Column::new(&parameter.name, Align::Right)));
        columns.extend(order.iter().map(|&k| Column::new(label(study.measures[k]), Align::Right)));
        let cells = |row: &Row| {
            let values = study.parameters.iter().zip(&row.values);
            let values = values.map(|(parameter, value)| Some(with_unit(*value, parameter.unit.as_deref())));
            let shown = order.iter().map(|&k| row.measured[k].map(|value| measured(study.measures[k], value)));
            std::iter::once(Some(row.layout.to_string())).chain(values).chain(shown).collect()
        };
        Table { columns, rows: self.best_rows().map(cells).collect() }
    }

    /// Returns the indices of the measures, beginning with that of the objective.
    fn measure_order(&self) -> Vec<usize> {
        let study = self.study;
        let mut measures: Vec<usize> = (0..study.measures.len()).collect();
        measures.sort_by_key(|&k| study.objective.is_none_or(|objective| objective.measure != study.measures[k]));
        measures
    }

    fn table<'b>(&self, rows: impl Iterator<Item = &'b usize>) -> Table {
        let study = self.study;
        let measures = self.measure_order();
        let mut columns = vec![Column::new("layout", Align::Right)];
        columns.extend(study.parameters.iter().map(|parameter| Column::new(&parameter.titled(), Align::Right)));
        let titled = |m: &Measure| m.unit().map_or_else(|| m.name().to_owned(), |unit| format!("{}, {unit}", m.name()));
        columns.extend(measures.iter().map(|&k| Column::new(&titled(&study.measures[k]), Align::Right)));
        let cells = |&i: &usize| {
            let row = &self.rows[i];
            let values = row.values.iter().map(|value| Some(format_value(*value)));
            let measured = measures.iter().map(|&k| row.measured[k].map(format_value));
            std::iter::once(Some(row.layout.to_string())).chain(values).chain(measured).collect()
        };
        Table { columns, rows: rows.map(cells).collect() }
    }
}

fn tally(rows: &[Row]) -> [usize; 4] {
    Ending::ALL.map(|ending| rows.iter().filter(|row| row.ending == ending).count())
}

fn percentage(part: usize, all: usize) -> f64 {
    100.0 * part as f64 / all.max(1) as f64
}

/// Formats a value with five significant digits, which suffice to distinguish layouts. The tables have all digits.
pub(super) fn format_value(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let digits = 4 - value.abs().log10().floor() as i32;
    if (0..=9).contains(&digits) { format!("{value:.*}", digits as usize) } else { format!("{value:.4e}") }
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("{INDENT}{line}").trim_end().to_owned() + "\n").collect()
}

/// Replaces each number in a reason by `#`, so that layouts that fail for the same reason count together. Digits in
/// names remain.
fn without_numbers(reason: &str) -> String {
    let word = |word: &str| {
        let bare = word.trim_matches(|c: char| "()[],;:.%".contains(c));
        if bare.parse::<f64>().is_ok() { word.replacen(bare, "#", 1) } else { word.to_owned() }
    };
    reason.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// Returns the first cause in a reason, without numbers and joint values.
fn first_cause(reason: &str) -> String {
    let text = without_numbers(reason);
    let (mut cause, mut depth, mut is_quoted) = (String::new(), 0, false);
    let mut rest = text.as_str();
    while let Some(c) = rest.chars().next() {
        let ends = [", ", "; ", ". "].iter().any(|end| rest.starts_with(end));
        match c {
            '"' => is_quoted = !is_quoted,
            _ if is_quoted => {}
            '(' if depth == 0 && values_end(rest).is_some() => {
                rest = &rest[values_end(rest).unwrap_or(1)..];
                let kept = cause.trim_end().len();
                cause.truncate(kept);
                continue;
            }
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            _ if ends && depth == 0 => break,
            _ => {}
        }
        cause.push(c);
        rest = &rest[c.len_utf8()..];
    }
    cause
}

/// Returns the position after joint values such as `(shoulder # rad, elbow # rad)` at the beginning of a text. `None`
/// if the text does not begin with such values.
fn values_end(text: &str) -> Option<usize> {
    let end = text.find(')')? + 1;
    let inside = &text[..end];
    (inside.contains('#') && inside.contains(char::is_alphabetic)).then_some(end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_are_grouped_by_first_cause() {
        let hits = "the start (shoulder -0.9 rad, elbow 0.4 rad) is not free: link \"forearm\" hits obstacle \"crate, 2\", 0.0130 m deep; \
                    link \"upper arm\" hits obstacle \"b\", 0.2 m deep";
        assert_eq!(first_cause(hits), "the start is not free: link \"forearm\" hits obstacle \"crate, 2\"");
        let far = "step 3: (0.3, 0.1) m is out of reach of the tip \"flange\", for all joint values: it is 2 m from joint \"a\"";
        assert_eq!(first_cause(far), "step #: (#, #) m is out of reach of the tip \"flange\"");
        assert_eq!(first_cause("\"a (1)\" overlaps \"b\""), "\"a (1)\" overlaps \"b\"");
    }

    #[test]
    fn reasons_are_compared_without_numbers() {
        let reasons = ["link \"arm 2\" is 0.012 m deep in \"post 3\" (1.5, -2e-3).", "proven: 17 boxes of it"];
        let without = reasons.map(without_numbers);
        assert_eq!(without[1], "proven: # boxes of it");
        assert_eq!(without[0], "link \"arm 2\" is # m deep in \"post 3\" (#, #).");
    }

    #[test]
    fn numbers_have_five_digits() {
        assert_eq!(
            [0.0, 1.0, -12.345678, 123456.7, 1.5e-9].map(format_value),
            ["0", "1.0000", "-12.346", "1.2346e5", "1.5000e-9"]
        );
    }
}
