//! Holds the table of imports: every module, and every crate of `crates`, may use only what lies below it.

use crate::rust_files;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// They import nothing, and all may import them; the last two are modules, which crates do not see.
const EVERYWHERE: [&str; 3] = ["cplan_interrupt", "text", "parallel"];

/// What the names of crates begin with.
const CRATE: &str = "cplan_";

/// Who may import whom, besides [`EVERYWHERE`].
const MAY_IMPORT: [(&str, &[&str]); 29] = [
    (EVERYWHERE[0], &[]),
    ("cplan_check", &[]),
    ("cplan_drawing", &[]),
    ("cplan_multigrid", &[]),
    ("cplan_gpu", &[]),
    ("cplan_harmonic", &["cplan_multigrid"]),
    ("cplan_xacro", &[]),
    (EVERYWHERE[1], &[]),
    (EVERYWHERE[2], &[]),
    ("geometry", &[]),
    ("space", &["geometry"]),
    ("model", &["geometry", "space"]),
    ("input", &["cplan_xacro", "geometry", "space", "model"]),
    ("cspace", &["geometry", "space", "model"]),
    ("field", &["cplan_multigrid", "cplan_gpu", "cplan_harmonic", "geometry", "space", "cspace"]),
    ("planner", &["geometry", "space", "cspace", "field"]),
    ("check", &["geometry", "space", "model"]),
    ("search", &["geometry", "space", "model", "check"]),
    ("motion", &["geometry", "space", "model", "check"]),
    ("engine", &["geometry", "space", "model", "input", "cspace", "field", "planner", "check", "search", "motion"]),
    ("explore", &["geometry", "space", "model", "input", "cspace", "field", "check", "motion", "engine"]),
    ("draw", &["geometry", "space", "model", "input", "cspace", "planner", "check", "motion", "engine", "explore"]),
    ("report", &["geometry", "space", "model", "field", "planner", "check", "motion", "engine"]),
    ("output", &["geometry", "space", "model", "cspace", "planner", "check", "motion", "engine", "draw"]),
    ("study", &["geometry", "space", "model", "input", "engine", "report"]),
    ("grammar", &["model", "field", "planner", "motion", "engine"]),
    (
        "live",
        &["geometry", "space", "model", "input", "cspace", "field", "planner", "engine", "draw", "output", "grammar"],
    ),
    ("serve", &["live"]),
    (
        "cli",
        &[
            "cplan_drawing",
            "geometry",
            "space",
            "model",
            "input",
            "cspace",
            "field",
            "planner",
            "check",
            "search",
            "motion",
            "engine",
            "explore",
            "draw",
            "report",
            "study",
            "output",
            "grammar",
            "live",
            "serve",
        ],
    ),
];

/// The modules that a file names as `crate::module`, and the crates of the workspace that it names, in code; `//` comments may name
/// any.
fn imports(text: &str) -> BTreeSet<String> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    let word = |text: &str| text.trim().chars().take_while(|&c| is_part(c)).collect::<String>();
    let mut found = BTreeSet::new();
    for line in text.lines().map(|line| line.split("//").next().unwrap_or_default()) {
        for (at, _) in line.match_indices("crate::") {
            let rest = &line[at + "crate::".len()..];
            match rest.strip_prefix('{') {
                Some(list) => found.extend(list.split(',').map(word)),
                None => found.extend([word(rest)]),
            }
        }
        let words = line.match_indices("cplan").filter(|(at, _)| !line[..*at].ends_with(is_part));
        found.extend(words.map(|(at, _)| word(&line[at..])).filter(|word| word.starts_with(CRATE)));
        found.extend(line.contains("cplan::").then(|| "cplan".to_owned()));
    }
    found
}

/// The folder of a module or a crate.
fn folder(name: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    name.strip_prefix(CRATE).map_or_else(|| root.join("src").join(name), |part| root.join("crates").join(part))
}

#[test]
fn modules_import_only_what_lies_below_them() {
    let names: BTreeSet<&str> = MAY_IMPORT.iter().map(|m| m.0).collect();
    let mut wrong = Vec::new();
    let mut seen = 0;
    for (name, allowed) in MAY_IMPORT {
        let is_crate = name.starts_with(CRATE);
        for file in rust_files(&folder(name)) {
            for import in imports(&std::fs::read_to_string(&file).unwrap()) {
                seen += 1;
                // Within a crate, `crate::` means its own modules, whatever their names.
                let known = if is_crate { import.starts_with("cplan") } else { names.contains(import.as_str()) };
                let is_below = allowed.contains(&import.as_str()) || EVERYWHERE.contains(&import.as_str());
                if known && import != name && !is_below {
                    wrong.push(format!("{} imports {import}", file.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "against the direction of the architecture:\n{}", wrong.join("\n"));
    assert!(seen > 50, "only {seen} imports were found: the test reads the wrong files");
}

/// Tests, benchmarks and examples of a crate may need another one, but nothing of the planner either.
#[test]
fn crates_depend_on_what_the_table_says() {
    for (name, allowed) in MAY_IMPORT.iter().filter(|m| m.0.starts_with(CRATE)) {
        let manifest = std::fs::read_to_string(folder(name).join("Cargo.toml")).unwrap();
        let manifest: toml::Table = toml::from_str(&manifest).unwrap();
        assert_eq!(manifest["package"]["name"].as_str(), Some(name.replace('_', "-").as_str()));
        for (kind, table) in manifest.iter().filter(|(key, _)| key.ends_with("dependencies")) {
            for other in table.as_table().expect("a table").keys().filter(|key| key.starts_with("cplan")) {
                let other = other.replace('-', "_");
                let is_below = allowed.contains(&other.as_str()) || EVERYWHERE.contains(&other.as_str());
                assert!(is_below, "{name} has {other} among its {kind}");
            }
        }
    }
}

#[test]
fn every_module_and_every_crate_is_in_the_table() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (folder, prefix) in [("src", ""), ("crates", CRATE)] {
        for entry in std::fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                let name = format!("{prefix}{}", path.file_name().unwrap().to_str().unwrap());
                assert!(MAY_IMPORT.iter().any(|m| m.0 == name), "{name} is missing from the table of imports");
            }
        }
    }
}

/// The map of the code has the same table: a row a crate or a module, in the order of the pipeline.
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
    let text = "use crate::model::{Arm, Pair};\nlet x = crate::planner::Run; // crate::draw\nuse crate::{cspace, field::A};\n\
                pub use cplan_harmonic::harmonic; // cplan_multigrid\nlet y = cplan::plan;";
    let expected = ["cplan", "cplan_harmonic", "cspace", "field", "model", "planner"];
    assert_eq!(imports(text).into_iter().collect::<Vec<_>>(), expected);
}
