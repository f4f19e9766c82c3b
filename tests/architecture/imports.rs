//! Holds that the checker of certificates shares no code with the planner. All other boundaries are Cargo's: a crate can use only
//! what its manifest names.

use std::path::Path;

#[test]
fn the_checker_depends_on_nothing_of_ours() {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/check/Cargo.toml");
    let manifest: toml::Table = toml::from_str(&std::fs::read_to_string(manifest).unwrap()).unwrap();
    let names = |table: &str| -> Vec<String> { manifest[table].as_table().expect("a table").keys().cloned().collect() };
    let ours = |name: &String| name.starts_with("cplan");
    assert!(names("dependencies").len() > 3, "the test reads the wrong table");
    assert_eq!(names("dependencies").into_iter().filter(ours).count(), 0);
    // Its tests share only the choice of random cases.
    assert_eq!(names("dev-dependencies").into_iter().filter(ours).collect::<Vec<_>>(), ["cplan-cases"]);
}
