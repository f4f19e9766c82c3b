//! Holds the table of imports: every module may use only what lies below it.

use crate::rust_files;
use std::collections::BTreeSet;
use std::path::Path;

/// They import nothing, and all may import them.
const EVERYWHERE: [&str; 2] = ["interrupt", "text"];

/// Who may import whom, besides [`EVERYWHERE`].
const MAY_IMPORT: [(&str, &[&str]); 17] = [
    (EVERYWHERE[0], &[]),
    (EVERYWHERE[1], &[]),
    ("geometry", &[]),
    ("space", &["geometry"]),
    ("model", &["geometry", "space"]),
    ("input", &["geometry", "space", "model"]),
    ("cspace", &["geometry", "space", "model"]),
    ("field", &["geometry", "space", "cspace"]),
    ("planner", &["geometry", "space", "cspace", "field"]),
    ("check", &["geometry", "space", "model"]),
    ("search", &["geometry", "space", "model", "check"]),
    ("motion", &["geometry", "space", "model", "check"]),
    ("engine", &["geometry", "space", "model", "input", "cspace", "field", "planner", "check", "search", "motion"]),
    ("draw", &["geometry", "space", "model", "cspace", "planner", "check", "motion", "engine"]),
    ("report", &["geometry", "space", "model", "planner", "check", "motion", "engine"]),
    ("output", &["space", "model", "cspace", "check", "motion", "engine", "draw"]),
    (
        "cli",
        &[
            "geometry", "space", "model", "input", "cspace", "field", "planner", "check", "search", "motion", "engine",
            "draw", "report", "output",
        ],
    ),
];

/// The modules that a file names as `crate::module`, in code; `//` comments may name any.
fn imports(text: &str) -> BTreeSet<String> {
    let code = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    let mut found = BTreeSet::new();
    for line in code {
        for (at, _) in line.match_indices("crate::") {
            let rest = &line[at + "crate::".len()..];
            let grouped: Vec<&str> =
                if let Some(list) = rest.strip_prefix('{') { list.split(',').collect() } else { vec![rest] };
            for name in grouped {
                let name: String = name.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                found.insert(name);
            }
        }
    }
    found
}

#[test]
fn modules_import_only_what_lies_below_them() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let modules: BTreeSet<&str> = MAY_IMPORT.iter().map(|m| m.0).collect();
    let mut wrong = Vec::new();
    let mut seen = 0;
    for (module, allowed) in MAY_IMPORT {
        for file in rust_files(&src.join(module)) {
            for import in imports(&std::fs::read_to_string(&file).unwrap()) {
                seen += 1;
                let known =
                    modules.contains(import.as_str()) && import != module && !EVERYWHERE.contains(&import.as_str());
                if known && !allowed.contains(&import.as_str()) {
                    wrong.push(format!("{} imports {import}", file.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "against the direction of the architecture:\n{}", wrong.join("\n"));
    assert!(seen > 50, "only {seen} imports were found: the test reads the wrong files");
}

#[test]
fn every_module_is_in_the_table() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for entry in std::fs::read_dir(src).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            assert!(MAY_IMPORT.iter().any(|m| m.0 == name), "{name} is missing from the table of imports");
        }
    }
}

/// The map of the code has the same table: a row a module, in the order of the pipeline.
#[test]
fn the_map_shows_the_same_table() {
    let map = include_str!("../../docs/architecture.md");
    let names = |cell: &str| -> Vec<String> { cell.split('`').skip(1).step_by(2).map(str::to_owned).collect() };
    let rows = map.lines().filter_map(|line| line.strip_prefix("| `")?.strip_suffix(" |"));
    let shown: Vec<(String, Vec<String>)> = rows
        .map(|row| {
            let cells: Vec<&str> = row.split(" | ").collect();
            (cells[0].trim_end_matches('`').to_owned(), names(cells.last().expect("three cells")))
        })
        .collect();
    let owned = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
    let held = MAY_IMPORT.map(|(module, allowed)| (module.to_owned(), owned(allowed)));
    assert_eq!(shown, held);
}

#[test]
fn the_reader_of_imports_sees_all_forms() {
    let text =
        "use crate::model::{Arm, Pair};\nlet x = crate::planner::Run; // crate::draw\nuse crate::{cspace, field::A};";
    let expected: Vec<&str> = vec!["cspace", "field", "model", "planner"];
    assert_eq!(imports(text).into_iter().collect::<Vec<_>>(), expected);
}
