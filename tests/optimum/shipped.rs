//! The shipped workspaces: how near bounds come to the best path that is known.

use crate::{ROUNDING, bound};
use cplan::input::{self, Overrides};
use cplan::model::Problem;
use cplan::solve::{Effort, Method, Verdict, solve};
use cplan::space::Metric;

/// The gap asked for, and to the best known path, which is itself within a thousandth of the optimum.
const GAP: f64 = 1e-4;
const NEAR: f64 = 2e-3;

fn feasible() -> Vec<(String, Problem)> {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files: Vec<_> =
        std::fs::read_dir(root.join("workspaces")).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    let problems: Vec<_> = files
        .iter()
        .filter_map(|file| {
            let text = std::fs::read_to_string(file).unwrap();
            let line = |key: &str| text.lines().find_map(|l| l.strip_prefix(key).map(str::trim).map(str::to_owned));
            (line("# expect:")? == "found").then(|| {
                let urdf = root.join("robots").join(format!("{}.urdf", line("# robot:").unwrap()));
                let loaded = input::load(&urdf, file, &Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
                (file.file_stem().unwrap().to_str().unwrap().to_owned(), loaded.problem)
            })
        })
        .collect();
    assert!(problems.len() >= 15, "only {} feasible workspaces", problems.len());
    problems
}

#[test]
fn bounds_come_near_the_best_known_paths() {
    let mut far = Vec::new();
    for (name, problem) in feasible() {
        let effort = Effort { gap: Some(1e-3), ..Effort::default() };
        let Verdict::Found(found) = solve(&problem, Method::Visibility, &effort, &mut |_| {}).verdict else {
            panic!("{name}: no path")
        };
        let length = found.path().length();
        let lower = bound(&problem, Metric::Euclidean, 2.0 * length, GAP);
        assert!(lower <= length * (1.0 + ROUNDING), "{name}: {lower} above {length}");
        if lower < length * (1.0 - NEAR) {
            far.push((name, lower, length));
        }
    }
    assert!(far.is_empty(), "{far:?}");
}
