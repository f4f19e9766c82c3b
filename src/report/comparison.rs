//! Several planners on one problem.

use super::table::{Align, Column, Table};
use crate::plan::{Note, Size};

/// What one planner did. What it did not come to is missing.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name on the command line.
    pub planner: String,
    /// How it ended: `found`, `infeasible` or `unknown`.
    pub outcome: String,
    /// Euclidean length in joint space (rad and m as they come).
    pub length: Option<f64>,
    /// Proven least distance between arm and obstacles along the path, metres.
    pub clearance: Option<f64>,
    /// Time that the motion takes, seconds.
    pub duration: Option<f64>,
    /// How much was built.
    pub size: Option<Size>,
    /// Computing time to prepare the space, seconds.
    pub build: Option<f64>,
    /// Computing time to answer the query, seconds.
    pub query: Option<f64>,
    /// Computing time of the certificate, seconds.
    pub certify: Option<f64>,
    /// What the planner has to add.
    pub note: Option<Note>,
}

/// The rows, and what they are about.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Name of the problem.
    pub problem: String,
    /// Unit of the lengths: `rad`, `m`, or both for an arm with a joint of each kind.
    pub length_unit: String,
    /// One a planner, in the order of the table.
    pub rows: Vec<Row>,
}

impl Comparison {
    /// The least length of all, if a path was found.
    #[must_use]
    pub fn best(&self) -> Option<f64> {
        self.rows.iter().filter_map(|r| r.length).filter(|l| l.is_finite()).min_by(f64::total_cmp)
    }

    /// How many times as long as the shortest path this row's is; 1 for the best. A path of length zero (the goal is
    /// the start) is as good as any other such path, and no other has a ratio to it.
    #[must_use]
    pub fn ratio(&self, row: &Row) -> Option<f64> {
        let (length, best) = (row.length?, self.best()?);
        if length == best { Some(1.0) } else { Some(length / best).filter(|r| r.is_finite()) }
    }

    /// An aligned table for a terminal, units in the header, `-` where there is nothing; below it the planners' notes,
    /// a line each. Ends in a newline.
    #[must_use]
    pub fn to_text(&self) -> String {
        let noted = self.rows.iter().filter_map(|row| row.note.map(|note| format!("{}: {note}\n", row.planner)));
        self.table().to_text() + &noted.collect::<String>()
    }

    /// The same table in Markdown.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        self.table().to_markdown()
    }

    /// Comma-separated values (RFC 4180) in SI units with full precision; empty where there is nothing.
    #[must_use]
    pub fn to_csv(&self) -> String {
        const HEADER: &str = "planner,outcome,length,ratio,clearance_m,duration_s,nodes,edges,cells,sweeps,expanded,\
                              build_s,query_s,certify_s,note\n";
        let mut text = HEADER.to_owned();
        for row in &self.rows {
            let number = |v: Option<f64>| v.filter(|v| v.is_finite()).map_or_else(String::new, |v| v.to_string());
            let [nodes, edges, cells, sweeps, expanded] =
                counts(row.size).map(|n| n.map_or_else(String::new, |n| n.to_string()));
            let fields = [
                quoted(&row.planner),
                quoted(&row.outcome),
                number(row.length),
                number(self.ratio(row)),
                number(row.clearance),
                number(row.duration),
                nodes,
                edges,
                cells,
                sweeps,
                expanded,
                number(row.build),
                number(row.query),
                number(row.certify),
                row.note.map_or_else(String::new, |note| quoted(&note.to_string())),
            ];
            text.push_str(&fields.join(","));
            text.push('\n');
        }
        text
    }

    /// A JSON object in SI units; null where there is nothing.
    #[must_use]
    pub fn to_json(&self) -> serde_json::Value {
        let row = |row: &Row| {
            let size = match row.size {
                None => serde_json::Value::Null,
                Some(Size::Graph { nodes, edges }) => serde_json::json!({ "nodes": nodes, "edges": edges }),
                Some(Size::Windows { cells, windows }) => serde_json::json!({ "cells": cells, "windows": windows }),
                Some(Size::Grid { cells, sweeps }) => serde_json::json!({ "cells": cells, "sweeps": sweeps }),
                Some(Size::Search { expanded, labelled }) => {
                    serde_json::json!({ "cells": labelled, "expanded": expanded })
                }
            };
            serde_json::json!({
                "planner": row.planner,
                "outcome": row.outcome,
                "length": row.length,
                "ratio": self.ratio(row),
                "clearance": row.clearance,
                "duration": row.duration,
                "size": size,
                "time": { "build": row.build, "query": row.query, "certify": row.certify },
                "note": row.note.map(|note| note.to_string()),
            })
        };
        serde_json::json!({
            "problem": self.problem,
            "length_unit": self.length_unit,
            "planners": self.rows.iter().map(row).collect::<Vec<_>>(),
        })
    }

    fn table(&self) -> Table {
        let length = format!("length [{}]", self.length_unit);
        let right = [length.as_str(), "ratio", "clearance [mm]", "motion [s]"];
        let times = ["build [ms]", "query [ms]", "certify [ms]"];
        let mut columns = vec![Column::new("planner", Align::Left), Column::new("outcome", Align::Left)];
        columns.extend(right.map(|name| Column::new(name, Align::Right)));
        columns.push(Column::new("size", Align::Left));
        columns.extend(times.map(|name| Column::new(name, Align::Right)));
        let cells = |row: &Row| {
            vec![
                Some(row.planner.clone()),
                Some(row.outcome.clone()),
                fixed(row.length, 4),
                fixed(self.ratio(row), 3),
                fixed(row.clearance.map(|v| v * 1e3), 3),
                fixed(row.duration, 3),
                row.size.map(|size| size.to_string()),
                fixed(row.build.map(|v| v * 1e3), 3),
                fixed(row.query.map(|v| v * 1e3), 3),
                fixed(row.certify.map(|v| v * 1e3), 3),
            ]
        };
        Table { columns, rows: self.rows.iter().map(cells).collect() }
    }
}

fn fixed(value: Option<f64>, decimals: usize) -> Option<String> {
    value.filter(|v| v.is_finite()).map(|v| format!("{v:.decimals$}"))
}

/// Nodes, edges, cells, sweeps, expanded cells.
fn counts(size: Option<Size>) -> [Option<usize>; 5] {
    match size {
        None => [None; 5],
        Some(Size::Graph { nodes, edges }) => [Some(nodes), Some(edges), None, None, None],
        Some(Size::Windows { cells, .. }) => [None, None, Some(cells), None, None],
        Some(Size::Grid { cells, sweeps }) => [None, None, Some(cells), Some(sweeps), None],
        Some(Size::Search { expanded, labelled }) => [None, None, Some(labelled), None, Some(expanded)],
    }
}

/// A text field of a CSV file.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Comparison {
        Comparison {
            problem: "shelf".to_owned(),
            length_unit: "rad".to_owned(),
            rows: vec![
                Row {
                    planner: "visibility".to_owned(),
                    outcome: "found".to_owned(),
                    length: Some(4.0),
                    clearance: Some(0.0011),
                    duration: Some(3.25),
                    size: Some(Size::Graph { nodes: 512, edges: 2300 }),
                    build: Some(0.0021),
                    query: Some(0.000_412),
                    certify: Some(0.001),
                    note: None,
                },
                Row {
                    planner: "harmonic".to_owned(),
                    outcome: "found".to_owned(),
                    length: Some(5.0),
                    clearance: Some(0.0125),
                    duration: Some(4.0),
                    size: Some(Size::Grid { cells: 65_536, sweeps: 40 }),
                    build: Some(0.0),
                    query: Some(1.5),
                    certify: None,
                    note: Some(Note::Unconverged { sweeps: 40, change: 2.5e-4 }),
                },
                Row {
                    planner: "a, \"b\" | c".to_owned(),
                    outcome: "unknown".to_owned(),
                    length: None,
                    clearance: None,
                    duration: None,
                    size: None,
                    build: None,
                    query: Some(f64::NAN),
                    certify: None,
                    note: None,
                },
            ],
        }
    }

    #[test]
    fn text_is_aligned() {
        insta::assert_snapshot!(example().to_text(), @r#"
    planner     outcome  length [rad]  ratio  clearance [mm]  motion [s]  size                    build [ms]  query [ms]  certify [ms]
    ----------  -------  ------------  -----  --------------  ----------  ----------------------  ----------  ----------  ------------
    visibility  found          4.0000  1.000           1.100       3.250  512 nodes, 2300 edges        2.100       0.412         1.000
    harmonic    found          5.0000  1.250          12.500       4.000  65536 cells, 40 sweeps       0.000    1500.000             -
    a, "b" | c  unknown             -      -               -           -  -                                -           -             -
    harmonic: not converged: relaxation stopped after 40 sweeps, at a relative change of 2.5e-4
    "#);
    }

    #[test]
    fn markdown_has_a_rule_with_alignment_and_escaped_bars() {
        insta::assert_snapshot!(example().to_markdown(), @r#"
    | planner     | outcome | length [rad] | ratio | clearance [mm] | motion [s] | size                   | build [ms] | query [ms] | certify [ms] |
    | ----------- | ------- | -----------: | ----: | -------------: | ---------: | ---------------------- | ---------: | ---------: | -----------: |
    | visibility  | found   |       4.0000 | 1.000 |          1.100 |      3.250 | 512 nodes, 2300 edges  |      2.100 |      0.412 |        1.000 |
    | harmonic    | found   |       5.0000 | 1.250 |         12.500 |      4.000 | 65536 cells, 40 sweeps |      0.000 |   1500.000 |            - |
    | a, "b" \| c | unknown |            - |     - |              - |          - | -                      |          - |          - |            - |
    "#);
    }

    #[test]
    fn csv_is_quoted_and_has_empty_fields() {
        insta::assert_snapshot!(example().to_csv(), @r#"
    planner,outcome,length,ratio,clearance_m,duration_s,nodes,edges,cells,sweeps,expanded,build_s,query_s,certify_s,note
    visibility,found,4,1,0.0011,3.25,512,2300,,,,0.0021,0.000412,0.001,
    harmonic,found,5,1.25,0.0125,4,,,65536,40,,0,1.5,,"not converged: relaxation stopped after 40 sweeps, at a relative change of 2.5e-4"
    "a, ""b"" | c",unknown,,,,,,,,,,,,,
    "#);
    }

    #[test]
    fn json_has_nulls() {
        let json = example().to_json();
        assert_eq!(json["planners"][0]["size"]["nodes"], 512);
        assert_eq!(json["planners"][1]["ratio"], 1.25);
        assert_eq!(json["planners"][1]["size"]["sweeps"], 40);
        assert!(json["planners"][2]["length"].is_null() && json["planners"][2]["size"].is_null());
        assert!(json["planners"][2]["time"]["query"].is_null(), "what is not a number is null");
    }

    #[test]
    fn the_best_has_ratio_one_even_if_it_stays_where_it_is() {
        let mut all = example();
        let ratios: Vec<Option<f64>> = all.rows.iter().map(|r| all.ratio(r)).collect();
        assert_eq!(ratios, [Some(1.0), Some(1.25), None]);
        all.rows[1].length = Some(0.0);
        let ratios: Vec<Option<f64>> = all.rows.iter().map(|r| all.ratio(r)).collect();
        assert_eq!(ratios, [None, Some(1.0), None]);
        all.rows.clear();
        assert_eq!(all.best(), None);
        assert_eq!(all.to_text().lines().count(), 2);
    }
}
