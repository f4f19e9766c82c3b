//! All shipped worlds and tasks, and random ones.

use super::{Certified, Extremes, FORMATS, Run, files, judge, root};
use cplan::input::load_scene;
use cplan::model::Joint;
use cplan_cases::dice::Dice;
use cplan_cases::{seeds, uses_default_cases};
use cplan_testkit::shipped::{self, Shipped};
use std::path::{Path, PathBuf};

fn joints(robot: &Path, world: &Path) -> [Joint; 2] {
    load_scene(robot, world).unwrap().scene.into_parts().0.joints
}

/// Compares all formats of a run with its JSON.
fn judge_all(what: &str, run: &Run, joints: &[Joint; 2]) -> Extremes {
    let certified = Certified::of(&run.json());
    let mut all = Extremes::default();
    let mut note = |found: Extremes| {
        all.velocity = all.velocity.max(found.velocity);
        all.acceleration = all.acceleration.max(found.acceleration);
        all.off = all.off.max(found.off);
        all.dwells += found.dwells;
    };
    note(judge(&format!("{what}, CSV"), &files::csv(&run.text("csv")), 0, &certified, joints));
    note(judge(&format!("{what}, YAML"), &files::yaml(&run.text("yaml")), 0, &certified, joints));
    #[cfg(feature = "mcap")]
    {
        let file = run.bytes("mcap");
        for (begin, message) in files::mcap(&file) {
            note(judge(&format!("{what}, MCAP"), &message, begin, &certified, joints));
        }
        // States belong to the motion, and times increase.
        let mut before = None;
        for (stamp, names, position) in files::states(&file) {
            assert!(before.replace(stamp).is_none_or(|before| before < stamp), "{what}: two states at {stamp} ns");
            for (k, joint) in joints.iter().enumerate() {
                let named = names.iter().position(|name| *name == joint.name).unwrap();
                let off = (position[named] - certified.at(stamp as f64 * 1e-9, k)).abs();
                assert!(off < 1e-10 * (1.0 + position[named].abs()), "{what}: the state at {stamp} ns is {off} off");
            }
        }
    }
    all
}

/// Returns shipped worlds with their robots.
fn shipped_worlds() -> Vec<[PathBuf; 2]> {
    let text = std::fs::read_to_string(root("workspaces/suite.toml")).unwrap();
    let manifest: toml::Table = text.parse().unwrap();
    let problems = manifest["problem"].as_array().unwrap();
    let file = |problem: &toml::Value, key: &str| root("workspaces").join(problem[key].as_str().unwrap());
    problems.iter().map(|problem| [file(problem, "robot"), file(problem, "world")]).collect()
}

/// Returns the names of a world's objects.
fn objects(world: &Path) -> Vec<String> {
    let world: toml::Table = std::fs::read_to_string(world).unwrap().parse().unwrap();
    let objects = world["object"].as_array().unwrap().iter().enumerate();
    let name = |(i, object): (usize, &toml::Value)| match object.get("name") {
        Some(name) => name.as_str().unwrap().to_owned(),
        None => format!("object {}", i + 1),
    };
    objects.map(name).collect()
}

#[test]
fn interpolated_motions_of_shipped_worlds_are_certified() {
    let mut found = 0;
    for [robot, world] in shipped_worlds() {
        let name = world.file_stem().unwrap().to_str().unwrap().to_owned();
        let run = Run::of(&robot, &world, &[]);
        if run.code != 0 {
            assert!([3, 4].contains(&run.code), "{name}: {}", run.errors);
            continue;
        }
        let extremes = judge_all(&name, &run, &joints(&robot, &world));
        // The motion is as fast as the limits allow, not merely slow enough.
        assert!(extremes.acceleration > 0.99 || extremes.velocity > 0.99, "{name}: {extremes:?}");
        for format in FORMATS {
            let (code, report) = run.verified(&robot, &world, format);
            assert_eq!(code, 0, "{name}.{format}: {report}");
        }
        found += 1;
    }
    assert!(found >= 15, "only {found} worlds have a path");
}

#[test]
fn interpolated_motions_of_shipped_tasks_are_certified() {
    let (mut found, mut dwells, mut accepted) = (0, 0, 0);
    for Shipped { name, robot, world, .. } in shipped::worlds("tasks") {
        let run = Run::of(&robot, &world, &[]);
        if run.code != 0 {
            assert!([3, 4].contains(&run.code), "{name}: {}", run.errors);
            continue;
        }
        dwells += judge_all(&name, &run, &joints(&robot, &world)).dwells;
        let (code, report) = run.verified(&robot, &world, "json");
        assert_eq!(code, 0, "{name}: {report}");
        // Without its steps, the file is a motion among objects at their initial places. The output says so, and the
        // motion touches nothing else.
        let objects = objects(&world);
        for format in FORMATS.into_iter().filter(|format| *format != "json") {
            let (code, report) = run.verified(&robot, &world, format);
            assert!(report.contains("with all objects at their initial positions"), "{name}.{format}: {report}");
            let contact = report.lines().find(|line| line.starts_with("contact "));
            let is_object =
                |line: &str| objects.iter().any(|object| line.contains(&format!("and obstacle \"{object}\"")));
            let is_kept = code == 0 || (code == 3 && contact.is_some_and(is_object));
            let breaks_limits = report.lines().any(|line| line.starts_with("limit "));
            assert!(is_kept && !breaks_limits, "{name}.{format}: {report}");
            accepted += usize::from(code == 0);
        }
        found += 1;
    }
    assert!(found >= 8 && dwells >= 40, "only {found} tasks are done, with {dwells} dwells");
    assert!(accepted >= 2 * found / 3, "only {accepted} files of {found} tasks are free as they stand");
}

#[test]
fn interpolated_motions_in_random_worlds_are_certified() {
    let seeds = seeds(12);
    let count = seeds.end - seeds.start;
    let robot = root("robots/planar_2r.urdf");
    let (mut found, mut blended) = (0, 0);
    for seed in seeds {
        let mut dice = Dice::new(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) + 1);
        let text = world(&mut dice);
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("world.toml");
        std::fs::write(&file, &text).unwrap();
        let period = ["0.01", "0.004", "0.037", "0.25"][(seed % 4) as usize];
        let run = Run::of(&robot, &file, &["--period", period]);
        if run.code != 0 {
            continue;
        }
        let what = format!("seed {seed}, period {period}\n{text}");
        judge_all(&what, &run, &joints(&robot, &file));
        for format in FORMATS {
            let (code, report) = run.verified(&robot, &file, format);
            assert_eq!(code, 0, "{what}\n{format}: {report}");
        }
        found += 1;
        blended += usize::from(run.json()["blends"]["count"].as_u64().unwrap() > 0);
    }
    assert!(
        !uses_default_cases() || found * 3 > count && blended > 0,
        "{found} of {count} worlds have a path, {blended} with blends"
    );
}

/// Returns a world of discs around the arm, and limits from weak to strong.
fn world(dice: &mut Dice) -> String {
    let [v1, v2] = [0, 1].map(|_| 10f64.powf(dice.within(-0.5, 0.8)));
    let [a1, a2] = [0, 1].map(|_| 10f64.powf(dice.within(0.0, 1.6)));
    let start = [dice.within(-2.5, 2.5), dice.within(-2.0, 2.0)];
    let goal = [dice.within(-2.5, 2.5), dice.within(-2.0, 2.0)];
    let mut text = format!(
        "[robot]\nvelocity = {{ shoulder = {v1}, elbow = {v2} }}\nacceleration = {{ shoulder = {a1}, elbow = {a2} }}\n\
         [start]\njoints = {start:?}\n[goal]\njoints = {goal:?}\n"
    );
    for _ in 0..3 {
        let (angle, radius) = (dice.within(-3.1, 3.1), dice.within(0.9, 2.0));
        let size = dice.within(0.02, 0.25);
        let center = [radius * angle.cos(), radius * angle.sin()];
        text += &format!("[[obstacle]]\ncircle = {{ center = {center:?}, radius = {size} }}\n");
    }
    text
}
