//! Errors of cell files with steps: each names the line and what to do.

use cplan_cell::{Cell, Refutation, Settings, plan_cell};
use cplan_model::Outcome;
use cplan_robot::Source;
use std::path::Path;

/// Returns the error about `workspaces/cells/handover.toml` with a text replaced, and the number of the line where it was.
fn error_after(old: &str, new: &str) -> (String, usize) {
    let cells = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../workspaces/cells");
    let text = std::fs::read_to_string(cells.join("handover.toml")).unwrap();
    let at = text.find(old).unwrap_or_else(|| panic!("{old}"));
    let robots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../robots/scara.urdf");
    let written = format!("{}{new}{}", &text[..at], &text[at + old.len()..]);
    let written = written.replace("../../robots/scara.urdf", robots.to_str().unwrap());
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("cell.toml");
    std::fs::write(&path, written).unwrap();
    let error = Cell::load(&Source::read(&path).unwrap(), &Source::read, None).expect_err(old).to_string();
    (error, text[..at].matches('\n').count() + 1)
}

#[test]
fn a_step_that_cannot_be_done_is_proven_and_has_its_line() {
    let cells = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../workspaces/cells");
    let path = cells.join("walled_in.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let line = text[..text.find("place = ").unwrap()].matches('\n').count();
    let cell = Cell::load(&Source::read(&path).unwrap(), &Source::read, None).unwrap();
    let plan = plan_cell(&cell, &Settings::default(), &mut |_| ()).unwrap();
    let Outcome::Infeasible(Refutation::Step { arm: 0, failed }) = &plan.outcome else { panic!("{:?}", plan.tried) };
    assert!(failed.step.place.ends_with(&format!("walled_in.toml:{line}:1")), "{} {line}", failed.step.place);
}

#[test]
fn errors_about_steps_name_the_line_and_a_hint() {
    let first_place = "place = { at = [0.4, 0.0] }";
    for (old, new, lines_later, message, hint) in [
        ("from = \"left\"", "from = \"middle\"", 0, "`from` must be the name of the other arm", "from = \"left\""),
        ("pick = \"bracket 2\"", "pick = \"bracket 7\"", 0, "\"bracket 7\"", "bracket 1"),
        (first_place, "place = { at = [2.0, 0.0] }", 0, "step 2", "reach"),
        (first_place, "place = { on = \"tray 1,1\" }", 0, "tray", "pallet"),
        ("task = { dwell = 0.1 }", "task = { dwell = -0.1 }", 0, "dwell", "0"),
        ("lift = 0.1", "lift = 0.1\npayload = \"rigid\"", -1000, "held rigidly", "payload = \"level\""),
        (
            "pick = \"bracket 1\"\nfrom = \"left\"",
            "pick = \"bracket 1\"",
            0,
            "both arms pick \"bracket 1\"",
            "from = \"left\"",
        ),
        (
            "pick = \"bracket 1\"\nfrom = \"left\"",
            "move = { tip = [0.75, 0.3] }\nfrom = \"left\"",
            1,
            "`from` needs the object",
            "pick",
        ),
        (
            "[[object]]",
            "[[step]]\npick = \"bracket 1\"\n\n[[object]]",
            0,
            "pairs of a pick and a place",
            "[[arm.step]]",
        ),
    ] {
        let (error, line) = error_after(old, new);
        assert!(error.contains(message) && error.contains(hint), "{old} -> {new}: {error}");
        if let Ok(lines_later) = usize::try_from(lines_later) {
            assert!(error.contains(&format!("line {}, ", line + lines_later)), "{old} -> {new}, line {line}: {error}");
        }
    }
}
