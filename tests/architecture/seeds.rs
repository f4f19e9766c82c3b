//! Checks that random tests are the same in every run: every `proptest!` takes its configuration from the crate
//! `cplan_cases`.

use crate::rust_files;
use std::path::{Path, PathBuf};

/// Files that may choose seeds and numbers of cases: the crate `cplan_cases`, which does so for all tests, and this
/// file.
const HERE: [&str; 2] = ["crates/cases/src/lib.rs", "tests/architecture/seeds.rs"];

/// Folders with tests.
const FOLDERS: [&str; 3] = ["crates", "src", "tests"];

/// Patterns of code that chooses its own seed, or a random one.
const ELSEWHERE: [&str; 7] =
    ["ProptestConfig", "with_cases", "test_runner::Config", "TestRunner::", "RngSeed", "from_entropy", "rand::"];

/// Environment variables that tests may read besides the two variables of `cplan_cases`. They configure long campaigns,
/// which are separate runs (`tests/planning/random_worlds`), and name folders for published data and for pictures.
const VARIABLES: [&str; 8] = [
    "CPLAN_WORLDS",
    "CPLAN_FIRST",
    "CPLAN_KIND",
    "CPLAN_LEVELS",
    "CPLAN_LATTICE",
    "CPLAN_SHARE",
    "CPLAN_THREADS",
    "CPLAN_PICTURES",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the numbers of the lines that choose random cases which differ from run to run.
fn unseeded_lines(text: &str) -> Vec<usize> {
    let code: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
    let wrong = |at: usize| {
        let opens = code[at].contains("proptest! {");
        let next = code[at + 1..].iter().map(|line| line.trim()).find(|line| !line.is_empty()).unwrap_or_default();
        let is_fixed = next.starts_with("#![proptest_config(cplan_cases::cases(");
        (opens && !is_fixed) || ELSEWHERE.iter().any(|word| code[at].contains(word))
    };
    (0..code.len()).filter(|&at| wrong(at)).map(|at| at + 1).collect()
}

#[test]
fn no_random_test_is_left_to_chance() {
    let (mut wrong, mut blocks) = (Vec::new(), 0);
    for folder in FOLDERS {
        for file in rust_files(&root().join(folder)) {
            if HERE.iter().any(|here| file.ends_with(here)) {
                continue;
            }
            let text = std::fs::read_to_string(&file).unwrap();
            blocks += text.matches("proptest! {").count();
            let name = file.strip_prefix(root()).unwrap().display();
            wrong.extend(unseeded_lines(&text).into_iter().map(|line| format!("{name}:{line}")));
        }
    }
    assert!(
        wrong.is_empty(),
        "begin with #![proptest_config(cplan_cases::cases(100))], and use no other source of chance:\n{}",
        wrong.join("\n")
    );
    assert!(blocks > 50, "only {blocks} random tests were found: the test reads the wrong files");
}

#[test]
fn numbers_of_cases_have_no_variables_of_their_own() {
    let others = ["CPLAN_SEED", "CPLAN_TIMES", "CPLAN_REFERENCE", "CPLAN_WRITE_SCHEMAS"];
    let known = |name: &str| others.iter().chain(&VARIABLES).any(|v| *v == name);
    let mut wrong = Vec::new();
    let files = ["crates", "tests"].iter().flat_map(|folder| rust_files(&root().join(folder)));
    // Benchmarks read how long they may take.
    for file in files.filter(|file| !file.components().any(|part| part.as_os_str() == "benches")) {
        let text = std::fs::read_to_string(&file).unwrap();
        for (at, _) in text.match_indices("\"CPLAN_").filter(|_| !file.ends_with("tests/architecture/seeds.rs")) {
            let is_part = |c: char| c.is_ascii_uppercase() || c == '_';
            let name = text[at + 1..].split(|c| !is_part(c)).next().unwrap_or_default();
            if !known(name) {
                wrong.push(format!("{}: {name}", file.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "use cplan_cases::times or cplan_cases::seeds:\n{}", wrong.join("\n"));
}

#[test]
fn nothing_is_left_behind_by_a_failure() {
    let of_failures = |folder: &Path| -> Vec<PathBuf> {
        let mut found = Vec::new();
        let mut folders = vec![folder.to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                match path.is_dir() {
                    true => folders.push(path),
                    false => {
                        found.extend(path.extension().is_some_and(|e| e == "proptest-regressions").then_some(path))
                    }
                }
            }
        }
        found
    };
    let found: Vec<_> = FOLDERS.iter().flat_map(|folder| of_failures(&root().join(folder))).collect();
    assert!(found.is_empty(), "make these cases tests with names: {found:?}");
}

#[test]
fn the_search_for_chance_sees_all_forms() {
    let fixed = "proptest! {\n    // why\n    #![proptest_config(cplan_cases::cases(9))]\n";
    assert!(unseeded_lines(fixed).is_empty());
    assert!(unseeded_lines("proptest! {\n    #![proptest_config(cplan_cases::cases(9))]\n").is_empty());
    assert_eq!(unseeded_lines("proptest! {\n    #[test]\n    fn f() {}\n}"), [1]);
    assert_eq!(
        unseeded_lines("let x = 1;\nproptest! {\n    #![proptest_config(ProptestConfig::with_cases(9))]"),
        [2, 3]
    );
    assert_eq!(unseeded_lines("let runner = TestRunner::default();"), [1]);
    assert!(unseeded_lines("// not TestRunner::default()").is_empty());
}
