//! Checks that every test runs: a library without test targets must have neither tests nor examples in its
//! documentation.

use crate::{files_of, rust_files};
use std::path::Path;

/// Returns the documentation text of a line, or `None` if it is not a doc comment.
fn documentation(line: &str) -> Option<&str> {
    let line = line.trim_start();
    line.strip_prefix("///").or(line.strip_prefix("//!")).map(str::trim_start)
}

/// Returns true if the documentation has an example that rustdoc would run, which is one that opens with a fence
/// without a language or with Rust. A closing fence has no language either, so each fence with another language
/// accounts for one plain fence.
fn has_example(text: &str) -> bool {
    let fences = text.lines().filter_map(|line| documentation(line)?.strip_prefix("```"));
    let (plain, of_rust): (Vec<&str>, Vec<&str>) =
        fences.partition(|language| !language.is_empty() && !language.starts_with("rust"));
    of_rust.len() > plain.len()
}

#[test]
fn libraries_without_test_targets_have_no_tests() {
    let (mut wrong, mut left_out) = (Vec::new(), 0);
    for manifest in files_of(&Path::new(env!("CARGO_MANIFEST_DIR")).join("crates"), &["toml"]) {
        let Some(folder) = manifest.parent().filter(|_| manifest.ends_with("Cargo.toml")) else { continue };
        let manifest: toml::Table = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap().parse().unwrap();
        let is_off = |key: &str| manifest.get("lib").and_then(|lib| lib.get(key)?.as_bool()) == Some(false);
        left_out += usize::from(is_off("test")) + usize::from(is_off("doctest"));
        for file in rust_files(&folder.join("src")) {
            let text = std::fs::read_to_string(&file).unwrap();
            if is_off("test") && text.contains("#[test]") || is_off("doctest") && has_example(&text) {
                wrong.push(file);
            }
        }
    }
    assert!(wrong.is_empty(), "remove `test = false` or `doctest = false` from the manifests of {wrong:?}");
    assert!(left_out > 5, "the test reads the wrong manifests");
}

#[test]
fn examples_are_distinguished_from_plain_text() {
    assert!(has_example("/// ```\n/// f();\n/// ```\n") && has_example("//! ```rust\n//! ```\n"));
    assert!(!has_example("//! ```text\n//! a -> b\n//! ```\n") && !has_example("fn f() {}\n"));
}
