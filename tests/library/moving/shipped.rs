//! The shipped worlds with moving obstacles, each with the outcome that its file states.

use cplan::motion::{Drive, Objective};
use cplan::{Options, Outcome, Problem, plan};
use std::path::Path;

#[test]
fn shipped_worlds_have_the_stated_outcome() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files: Vec<_> =
        std::fs::read_dir(root.join("workspaces/moving")).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    for file in &files {
        let text = std::fs::read_to_string(file).unwrap();
        let report = |key: &str| text.lines().find_map(|line| line.strip_prefix(key)).map(str::trim).expect(key);
        let problem = Problem::load(root.join(format!("robots/{}.urdf", report("# robot:"))), file).unwrap();
        let plan = plan(&problem, &Options::default()).unwrap();
        let name = file.file_stem().unwrap().to_string_lossy();
        match (report("# expect:"), plan.outcome()) {
            ("found", Outcome::Found(_)) => {
                let timing = plan.timing().expect("something moves");
                assert!(timing.free_until.is_none() && timing.clearance.is_some_and(|kept| kept > 0.0), "{name}");
            }
            ("unknown", Outcome::Unknown(reason)) => {
                assert!(reason.contains("no timing avoids the moving obstacles (proven)"), "{name}: {reason}")
            }
            (expected, outcome) => panic!("{name}: {outcome:?} instead of {expected}"),
        }
    }
    assert!(files.len() >= 5);
}

/// Checks that the printed duration is that of the whole motion, including waits, if the motion is optimised for time.
#[test]
fn the_duration_beside_its_bound_is_that_of_the_motion() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let problem =
        Problem::load(root.join("robots/planar_2r.urdf"), root.join("workspaces/moving/crossing.toml")).unwrap();
    let drive = Drive { optimize: Objective::Time, ..Drive::default() };
    let plan = plan(&problem, &Options { drive, ..Options::default() }).unwrap();
    let (duration, fastest) =
        (plan.trajectory().unwrap().duration(), plan.motion().unwrap().1.outcome.found().unwrap().fastest.unwrap());
    assert_eq!(fastest.duration, duration);
    assert!(duration > 2.9 && fastest.lower_bound < duration);
}
