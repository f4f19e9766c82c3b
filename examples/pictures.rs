//! Redraws the pictures of the documentation: each planner on one workspace, one workspace without a path, the demo's
//! cell, two tasks, and the animated one.
//!
//! ```text
//! cargo run --release --example pictures
//! ```

use cplan::PlanOutput as _;
use cplan::motion::write_whole;
use cplan_testkit::pictures::{MOVING, PICTURES};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures");
    std::fs::create_dir_all(&docs)?;
    for (name, subject) in PICTURES {
        let file = docs.join(name).with_extension("svg");
        write_whole(&file, subject.svg()?.as_bytes())?;
        println!("{}", file.display());
        if name == MOVING.1 {
            let file = docs.join(MOVING.0).with_extension("gif");
            subject.plan()?.save(&file)?;
            println!("{}", file.display());
        }
    }
    Ok(())
}
