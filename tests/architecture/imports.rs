//! Checks that the checker of certificates shares no code with the planner, and that crates use only what is inside their
//! ring. Cargo checks all other boundaries: a crate can use only the dependencies in its manifest.

use super::files_of;
use regex::Regex;
use std::path::Path;

/// Returns the dependencies of a crate that are crates of this repository.
fn workspace_dependencies(folder: &str, table: &str) -> Vec<String> {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder).join("Cargo.toml");
    let manifest: toml::Table = toml::from_str(&std::fs::read_to_string(manifest).unwrap()).unwrap();
    let names = manifest
        .get(table)
        .map_or_else(Vec::new, |table| table.as_table().expect("a table").keys().cloned().collect::<Vec<_>>());
    names.into_iter().filter(|name| name.starts_with("cplan")).collect()
}

#[test]
fn the_checker_shares_no_crate_with_the_planner() {
    assert_eq!(workspace_dependencies("crates/check", "dependencies"), [""; 0]);
    assert_eq!(workspace_dependencies("crates/check", "dev-dependencies"), [""; 0]);
    assert_eq!(workspace_dependencies("crates/check-line", "dependencies"), ["cplan-check"]);
    assert_eq!(workspace_dependencies("crates/check-line", "dev-dependencies"), [""; 0]);
    assert_eq!(workspace_dependencies("crates/check-files", "dependencies"), ["cplan-check", "cplan-check-line"]);
    // Its tests share only the choice of random cases, and distances in the plane.
    assert_eq!(workspace_dependencies("crates/check-files", "dev-dependencies"), ["cplan-cases"]);
}

/// The rings from the inside out, with their folders. A crate uses only crates of its own ring and of those inside it.
const RINGS: [&str; 3] = ["crates/core", "crates/job", "crates/companions"];

/// Crates of the main job that still use a companion, each with that companion. The list may only become shorter. Those
/// marked "optional" are behind a feature.
const LEAKS: [(&str, &str); 0] = [];

/// Returns the names of the crates in a ring.
fn crates_of(ring: &str) -> Vec<String> {
    let folders = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(ring)).unwrap();
    let mut names: Vec<String> =
        folders.map(|folder| folder.unwrap().file_name().into_string().expect("a name in ASCII")).collect();
    names.sort();
    names
}

#[test]
fn a_ring_uses_only_what_is_inside_it() {
    let (mut inside, mut leaks) = (Vec::new(), Vec::new());
    for ring in RINGS {
        let own = crates_of(ring);
        assert!(own.len() > 5, "{ring} has {own:?}");
        inside.extend(own.iter().map(|name| format!("cplan-{name}")));
        for name in own {
            let used = workspace_dependencies(&format!("{ring}/{name}"), "dependencies");
            leaks.extend(used.into_iter().filter(|used| !inside.contains(used)).map(|used| (name.clone(), used)));
        }
    }
    let known: Vec<(String, String)> =
        LEAKS.iter().map(|(name, used)| ((*name).to_owned(), format!("cplan-{used}"))).collect();
    assert_eq!(leaks, known, "left what crates use outside their ring, right what LEAKS lists");
}

/// Words of companions that the rings inside them must not know: two arms in one cell, and exploration. Scripts of pages may
/// name the cells of grids, but not the data of a cell.
const WORDS_OF_COMPANIONS: [(&[&str], &str); 2] = [
    (&["rs", "js", "ts", "css"], r"hand(ed)?[ _]?over|\bother arm\b|\b(two|both) arms\b"),
    (&["js", "ts"], r"\bexploration\b|\bsurvey\b|\b(model|view|this)\.cell\b|\bcell\?(: |\.motions)"),
];

#[test]
fn inner_rings_know_no_words_of_companions() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut wrong, mut count) = (Vec::new(), 0);
    for (extensions, pattern) in WORDS_OF_COMPANIONS {
        let pattern = Regex::new(&format!("(?i){pattern}")).unwrap();
        for file in RINGS[..2].iter().flat_map(|ring| files_of(&root.join(ring), extensions)) {
            let text = std::fs::read_to_string(&file).unwrap();
            let lines = text.lines().zip(1..).filter(|(line, _)| pattern.is_match(line));
            wrong.extend(lines.map(|(line, number)| format!("{}:{number}: {line}", file.display())));
            count += 1;
        }
    }
    assert!(wrong.is_empty(), "name these neutrally, or move them to the companion:\n{}", wrong.join("\n"));
    assert!(count > 500, "only {count} files were read");
}

#[test]
fn the_judge_sees_only_shapes_and_joints() {
    assert_eq!(workspace_dependencies("crates/core/judge", "dependencies"), ["cplan-geometry", "cplan-model"]);
    assert_eq!(workspace_dependencies("crates/core/judge", "dev-dependencies"), [""; 0]);
}
