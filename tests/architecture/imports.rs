//! Checks that the checker of certificates shares no code with the planner, and that the judge sees no planner. Cargo
//! checks all other boundaries: a crate can use only the dependencies in its manifest.

use std::path::Path;

/// Returns the dependencies of a crate that are crates of this repository.
fn workspace_dependencies(folder: &str, table: &str) -> Vec<String> {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder).join("Cargo.toml");
    let manifest: toml::Table = toml::from_str(&std::fs::read_to_string(manifest).unwrap()).unwrap();
    let names = manifest
        .get(table)
        .map_or_else(Vec::new, |table| table.as_table().expect("a table").keys().cloned().collect::<Vec<_>>());
    assert!(table != "dependencies" || !names.is_empty(), "the test reads the wrong table");
    names.into_iter().filter(|name| name.starts_with("cplan")).collect()
}

#[test]
fn the_checker_shares_no_crate_with_the_planner() {
    assert_eq!(workspace_dependencies("crates/check", "dependencies"), [""; 0]);
    assert_eq!(workspace_dependencies("crates/check", "dev-dependencies"), [""; 0]);
    assert_eq!(workspace_dependencies("crates/check-line", "dependencies"), ["cplan-check"]);
    assert_eq!(workspace_dependencies("crates/check-line", "dev-dependencies"), [""; 0]);
    assert_eq!(workspace_dependencies("crates/check-files", "dependencies"), ["cplan-check", "cplan-check-line"]);
    // Its tests share only the choice of random cases.
    assert_eq!(workspace_dependencies("crates/check-files", "dev-dependencies"), ["cplan-cases"]);
}

/// Crates of the core, and those without knowledge of robots that it uses.
const CORE: [&str; 8] = ["geometry", "harmonic", "interrupt", "judge", "model", "multigrid", "planners", "text"];

#[test]
fn the_core_uses_only_the_core() {
    for name in CORE {
        let used = workspace_dependencies(&format!("crates/{name}"), "dependencies");
        let outside = used.iter().find(|used| !CORE.iter().any(|core| **used == format!("cplan-{core}")));
        assert_eq!(outside, None, "{name}");
    }
}

#[test]
fn the_judge_sees_only_shapes_and_joints() {
    assert_eq!(workspace_dependencies("crates/judge", "dependencies"), ["cplan-geometry", "cplan-model"]);
    assert_eq!(workspace_dependencies("crates/judge", "dev-dependencies"), [""; 0]);
}
