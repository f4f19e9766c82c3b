//! Cells whose arms have steps.

use cplan_cell::{Cell, Settings, plan_cell};
use std::path::Path;

#[test]
fn print() {
    let name = std::env::var("CELL").unwrap_or("handover".into());
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../../workspaces/cells/{name}.toml"));
    let cell = Cell::load(&path, &|path| path.into(), None).unwrap();
    let begun = std::time::Instant::now();
    let plan = plan_cell(&cell, &Settings::default(), &mut |line| eprintln!("{line}")).unwrap();
    eprintln!("{:?} {:?} {:?} {:?} {:?}", begun.elapsed(), plan.status(), plan.lower_bound, plan.alone, plan.assignment);
    plan.tried.iter().for_each(|tried| eprintln!("{tried}"));
    if let Some(found) = plan.outcome.found() {
        eprintln!("{} {} {:?}\n{:?}\n{:?}", found.duration, found.clearance, found.nearest, found.waits, found.interlocks);
        for steps in &found.steps { for step in steps { eprintln!("{step:?}"); } }
        eprintln!("{}", found.diagram.len());
    } else { eprintln!("{:?}", plan.outcome); }
}
