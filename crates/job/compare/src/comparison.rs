//! Several planners on one problem.

use super::best::Better;
use super::row::Row;
use super::table::{Align, Column, Emphasis, MAX_TABLE_WIDTH, Table, fixed, quoted};
use cplan_model::Status;
use cplan_model::space::Configuration;
use cplan_planners::planner::{PathKind, Size};
use cplan_text::{percent, plain, round_down, wrapped};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The results of planners on one problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Name of the problem.
    pub problem: String,
    /// Unit of the lengths: `rad`, `m`, or both for an arm with a joint of each kind.
    pub length_unit: String,
    /// Start and goal. `None` if they are those of the world file.
    pub query: Option<[Configuration; 2]>,
    /// Proven lower bound on the length of every motion from start to goal, in the unit of lengths; `None` if unknown.
    pub bound: Option<f64>,
    /// One row per planner, in the order of the table.
    pub rows: Vec<Row>,
}

impl Comparison {
    /// Returns the least length of all paths. `None` if no planner found a path.
    pub fn best(&self) -> Option<f64> {
        self.rows.iter().filter_map(|r| r.length).filter(|l| l.is_finite()).min_by(f64::total_cmp)
    }

    /// Returns the ratio of this row's length to the least length: 1 for the shortest path. If the least length is zero (the goal
    /// is the start), 1 for paths of length zero and `None` for longer ones. `None` without a path.
    pub fn ratio(&self, row: &Row) -> Option<f64> {
        quotient(row.length?, self.best()?)
    }

    /// Returns the ratio of this row's length to the proven lower bound, which bounds the ratio to the optimum.
    pub fn over_optimum(&self, row: &Row) -> Option<f64> {
        quotient(row.length?, self.bound?)
    }

    /// Returns true if one planner found a certified path and another one proved that there is none. One of them is then wrong.
    pub fn is_contradictory(&self) -> bool {
        let has = |outcome| self.rows.iter().any(|row| row.outcome == outcome);
        has(Status::Found) && has(Status::Infeasible)
    }

    /// Summarises the results in words.
    pub fn outcome(&self) -> String {
        let all = self.rows.len();
        let [found, proved, unknown] =
            Status::ALL.map(|outcome| self.rows.iter().filter(|row| row.outcome == outcome).count());
        match (found, proved) {
            (0, 0) => format!("{unknown} of {all} answered \"unknown\""),
            (0, _) => format!("{proved} of {all} proved infeasibility"),
            (_, 0) => format!("{found} of {all} found a certified path"),
            _ => format!("{found} of {all} found a certified path, {proved} proved infeasibility"),
        }
    }

    /// Describes the contradiction between two planners. `None` if there is none.
    pub fn alarm(&self) -> Option<String> {
        let named = |outcome| {
            let names = self.rows.iter().filter(|row| row.outcome == outcome).map(|row| row.planner.as_str());
            names.collect::<Vec<_>>().join(", ")
        };
        self.is_contradictory().then(|| {
            format!(
                "the planners contradict each other on {}: {} found a certified path, {} proved that there is none; this is a defect of cplan, please report it with the robot and the world",
                self.problem,
                named(Status::Found),
                named(Status::Infeasible)
            )
        })
    }

    /// Returns a table for a terminal, with an emphasis on the best value of each column, and the planners' remarks below it.
    /// Unless `is_wide`, the table has only the leading columns. Control characters in names are escaped, and the text ends in a
    /// newline.
    pub fn to_text(&self, is_wide: bool, emphasis: Emphasis) -> String {
        let remarks = self.rows.iter().flat_map(Row::remarks);
        if is_wide {
            let remarks = remarks.map(|line| plain(&line).into_owned() + "\n");
            return self.table().to_text_within(usize::MAX, emphasis) + &remarks.collect::<String>();
        }
        let remarks = remarks.map(|line| wrapped(&plain(&line), MAX_TABLE_WIDTH, 2) + "\n");
        self.table().of_columns(&LEADING_COLUMNS).to_text_within(MAX_TABLE_WIDTH, emphasis)
            + &remarks.collect::<String>()
    }

    /// Returns the table in Markdown.
    pub fn to_markdown(&self) -> String {
        self.table().to_markdown()
    }

    /// Returns comma-separated values (RFC 4180) in SI units with full precision; missing values are empty.
    pub fn to_csv(&self) -> String {
        let rows = self.rows.iter().map(|row| self.csv_row(row) + "\n");
        format!("{CSV_HEADER}\n{}", rows.collect::<String>())
    }

    /// Returns a row's fields in the order of [`CSV_HEADER`].
    pub(super) fn csv_row(&self, row: &Row) -> String {
        let number = |v: Option<f64>| v.filter(|v| v.is_finite()).map_or_else(String::new, |v| v.to_string());
        let counts = row.counts().map(|n| n.map_or_else(String::new, |n| n.to_string()));
        let mut fields = vec![quoted(&row.planner), row.outcome.name().to_owned()];
        fields.extend([row.length, self.ratio(row), row.clearance, row.duration].map(number));
        fields.extend(counts);
        fields.extend([row.build, row.query, row.certify].map(number));
        fields.push(row.note.map_or_else(String::new, |note| quoted(&note.to_string())));
        fields.extend([self.bound, self.over_optimum(row), row.prove, row.total].map(number));
        fields.push(row.memory.map_or_else(String::new, |bytes| bytes.to_string()));
        fields.push(row.reason.as_deref().map_or_else(String::new, quoted));
        fields.join(",")
    }

    /// Returns a JSON object in SI units; missing values are null.
    pub fn to_json(&self) -> Value {
        let mut object = json!({
            "problem": self.problem,
            "length_unit": self.length_unit,
            "lower_bound": self.bound,
            "contradictory": self.is_contradictory(),
            "planners": self.rows.iter().map(|row| self.json_row(row)).collect::<Vec<_>>(),
        });
        if let Some([start, goal]) = self.query {
            object["start"] = json!([start[0], start[1]]);
            object["goal"] = json!([goal[0], goal[1]]);
        }
        object
    }

    fn json_row(&self, row: &Row) -> Value {
        let figures = |size: Size| size.figures().into_iter().collect::<BTreeMap<_, _>>();
        json!({
            "planner": row.planner,
            "path_kind": row.path_kind.name(),
            "outcome": row.outcome.name(),
            "length": row.length,
            "paths": row.other_path.map(|_| paths(row)),
            "ratio": self.ratio(row),
            "over_optimum": self.over_optimum(row),
            "pieces": row.pieces,
            "clearance": row.clearance,
            "duration": row.duration,
            "size": row.size.map(figures),
            "time": {
                "build": row.build,
                "query": row.query,
                "certify": row.certify,
                "prove": row.prove,
                "total": row.total,
            },
            "memory": row.memory,
            "note": row.note.map(|note| note.to_string()),
            "reason": row.reason,
        })
    }

    pub(super) fn table(&self) -> Table {
        let length = format!("length [{}]", self.length_unit);
        let right = [length.as_str(), "ratio", "over optimum", "clearance [mm]", "motion [s]"];
        let costs = ["build [ms]", "query [ms]", "certify [ms]", "total [ms]", "memory [MiB]"];
        let mut columns = vec![Column::new("planner", Align::Left), Column::new("outcome", Align::Left)];
        columns.extend(right.map(|name| Column::new(name, Align::Right)));
        columns.push(Column::new("size", Align::Left));
        columns.extend(costs.map(|name| Column::new(name, Align::Right)));
        // If any planner has paths of both kinds, both kinds have columns.
        let has_both = self.rows.iter().any(|row| row.other_path.is_some());
        let kinds = if has_both { &PathKind::ALL[..] } else { &[] };
        for kind in kinds {
            columns.push(Column::new(&format!("{kind} [{}]", self.length_unit), Align::Right));
            columns.push(Column::new(&format!("{kind} [mm]"), Align::Right));
        }
        let milliseconds = |v: Option<f64>| fixed(v.map(|v| v * 1e3), 3);
        // A clearance is a proven lower bound, so it is rounded down.
        let millimetres = |v: Option<f64>| v.filter(|v| v.is_finite()).map(|v| round_down(v * 1e3, 3));
        let cells = |row: &Row| {
            let mut cells = vec![
                Some(row.planner.clone()),
                Some(row.outcome.to_string()),
                fixed(row.length, 4),
                fixed(self.ratio(row), 3),
                self.over_optimum(row).map(|ratio| percent(ratio - 1.0)),
                millimetres(row.clearance),
                fixed(row.duration, 3),
                row.size.map(|size| size.to_string()),
                milliseconds(row.build),
                milliseconds(row.query),
                milliseconds(row.certify),
                milliseconds(row.total),
                fixed(row.memory.map(|bytes| bytes as f64 / f64::from(1 << 20)), 2),
            ];
            for &kind in kinds {
                let path = row.of_kind(kind);
                cells.push(fixed(path.map(|path| path.0), 4));
                cells.push(millimetres(path.and_then(|path| path.1)));
            }
            cells
        };
        let rows: Vec<Vec<Option<String>>> = self.rows.iter().map(cells).collect();
        let columns = columns.into_iter().enumerate().map(|(k, column)| {
            let shown: Vec<Option<String>> = rows.iter().map(|row| row[k].clone()).collect();
            column.with_best(self.best_rows(k, &shown))
        });
        Table { columns: columns.collect(), rows }
    }

    /// Returns the rows with the best value of a column of the table, given the column's texts. A planner without a path or a
    /// proof cannot be the best.
    fn best_rows(&self, column: usize, shown: &[Option<String>]) -> Vec<usize> {
        let better = match column {
            0 | 1 | SIZE_COLUMN => return Vec::new(),
            CLEARANCE_COLUMN => Better::More,
            // The last columns alternate between length and clearance, for each kind of path.
            k if k > MEMORY_COLUMN && (k - MEMORY_COLUMN).is_multiple_of(2) => Better::More,
            _ => Better::Less,
        };
        let value = |(row, text): (&Row, &Option<String>)| {
            text.as_deref().filter(|_| row.outcome != Status::Unknown)?.trim_end_matches(" %").parse().ok()
        };
        better.that_stand_out(&self.rows.iter().zip(shown).map(value).collect::<Vec<_>>(), shown)
    }
}

/// Indices of columns of the table.
const CLEARANCE_COLUMN: usize = 5;
const SIZE_COLUMN: usize = 7;
const MEMORY_COLUMN: usize = 12;

/// Indices of the table's columns within 80 characters: planner, outcome, length, length over the optimum, clearance, motion,
/// time, memory.
const LEADING_COLUMNS: [usize; 8] = [0, 1, 2, 4, 5, 6, 11, 12];

/// Returns length and clearance of each kind of path.
fn paths(row: &Row) -> Value {
    let figures =
        |kind| row.of_kind(kind).map(|(length, clearance)| json!({ "length": length, "clearance": clearance }));
    json!({ "own": figures(PathKind::Own), "taut": figures(PathKind::Taut) })
}

/// Names of the columns of [`Comparison::to_csv`].
pub(super) const CSV_HEADER: &str = "planner,outcome,length,ratio,clearance_m,duration_s,nodes,edges,cells,sweeps,expanded,\
                                     build_s,query_s,certify_s,note,lower_bound,over_optimum,prove_s,total_s,memory_bytes,reason";

/// Returns `a / b`, or 1 if both are equal. `None` if the quotient is not finite.
fn quotient(a: f64, b: f64) -> Option<f64> {
    if a == b { Some(1.0) } else { Some(a / b).filter(|r| r.is_finite()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Family;
    use crate::PLAIN;
    use cplan_planners::planner::Note;

    fn example() -> Comparison {
        let visibility = Row {
            length: Some(4.0),
            pieces: Some(12),
            clearance: Some(0.0011),
            duration: Some(3.25),
            size: Some(Size::Graph { nodes: 512, edges: 2300 }),
            build: Some(0.0021),
            query: Some(0.000_412),
            certify: Some(0.001),
            total: Some(0.0036),
            memory: Some(3 << 19),
            ..Row::new("visibility", Family::Roadmap, Status::Found)
        };
        let harmonic = Row {
            length: Some(5.0),
            clearance: Some(0.0125),
            duration: Some(4.0),
            size: Some(Size::Grid { cells: 65_536, sweeps: 40 }),
            build: Some(0.0),
            query: Some(1.5),
            note: Some(Note::Floor { sweeps: 40, change: 2.5e-4 }),
            ..Row::new("harmonic", Family::Field, Status::Found)
        };
        let odd = Row {
            query: Some(f64::NAN),
            prove: Some(0.25),
            reason: Some("too coarse, or \"so\"".to_owned()),
            ..Row::new("a, \"b\" | c", Family::Field, Status::Unknown)
        };
        Comparison {
            problem: "shelf".to_owned(),
            length_unit: "rad".to_owned(),
            query: None,
            bound: Some(3.2),
            rows: vec![visibility, harmonic, odd],
        }
    }

    #[test]
    fn text_is_aligned() {
        assert_eq!(example().to_text(true, PLAIN), include_str!("expected/table.txt"));
    }

    #[test]
    fn the_best_value_of_each_column_stands_out() {
        let mut example = example();
        example.rows[2].total = Some(1e-9);
        let marked = example.to_text(false, ["<", ">"]);
        for best in ["<4.0000>", "<25.00 %>", "<12.500>", "<3.250>"] {
            assert!(marked.contains(best), "no {best} in {marked}");
        }
        assert!(!marked.contains("<0.000>"), "an unknown outcome is never the best: {marked}");
        assert_eq!(marked.replace(['<', '>'], ""), example.to_text(false, PLAIN));
    }

    #[test]
    fn leading_columns_fit_a_terminal() {
        let text = example().to_text(false, PLAIN);
        assert!(text.lines().all(|line| line.chars().count() <= MAX_TABLE_WIDTH), "{text}");
        assert!(text.contains("25.00 %") && !text.contains("65536") && text.ends_with("or \"so\"\n"), "{text}");
    }

    #[test]
    fn markdown_has_a_rule_with_alignment_and_escaped_bars() {
        assert_eq!(example().to_markdown(), include_str!("expected/table.md"));
    }

    #[test]
    fn csv_is_quoted_and_has_empty_fields() {
        assert_eq!(example().to_csv(), include_str!("expected/table.csv"));
    }

    #[test]
    fn json_has_nulls() {
        let json = example().to_json();
        assert_eq!(json["planners"][0]["size"]["nodes"], 512);
        assert_eq!(json["planners"][0]["memory"], 3 << 19);
        assert_eq!(json["planners"][1]["ratio"], 1.25);
        assert_eq!(json["planners"][1]["over_optimum"], 1.5625);
        assert_eq!(json["planners"][1]["size"]["sweeps"], 40);
        assert!(json["planners"][2]["length"].is_null() && json["planners"][2]["size"].is_null());
        assert!(json["planners"][2]["time"]["query"].is_null(), "NaN is written as null");
        assert!(json.get("start").is_none());
    }

    #[test]
    fn the_best_has_ratio_one_even_if_it_stays_where_it_is() {
        let mut all = example();
        let ratios: Vec<Option<f64>> = all.rows.iter().map(|r| all.ratio(r)).collect();
        assert_eq!(ratios, [Some(1.0), Some(1.25), None]);
        all.rows[1].length = Some(0.0);
        all.bound = Some(0.0);
        let ratios: Vec<_> = all.rows.iter().map(|r| [all.ratio(r), all.over_optimum(r)]).collect();
        assert_eq!(ratios, [[None; 2], [Some(1.0); 2], [None; 2]]);
        all.rows.clear();
        assert_eq!(all.best(), None);
        assert_eq!(all.to_text(true, PLAIN).lines().count(), 2);
    }

    #[test]
    fn a_path_and_a_proof_are_a_contradiction() {
        let mut all = example();
        assert!(!all.is_contradictory() && all.alarm().is_none());
        assert_eq!(all.outcome(), "2 of 3 found a certified path");
        all.rows[2].outcome = Status::Infeasible;
        assert_eq!(all.outcome(), "2 of 3 found a certified path, 1 proved infeasibility");
        let alarm = all.alarm().unwrap();
        assert!(alarm.contains("on shelf: visibility, harmonic found") && alarm.contains("| c proved"), "{alarm}");
        all.rows.remove(0);
        all.rows.remove(0);
        assert!(!all.is_contradictory(), "proofs alone agree");
        assert_eq!(all.outcome(), "1 of 1 proved infeasibility");
    }
}
