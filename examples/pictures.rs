//! Redraws the pictures of the documentation: each planner on one workspace, one workspace without a path, the demo's
//! cell, two tasks, the animated one, and the small figures of the course.
//!
//! ```text
//! cargo run --release --example pictures
//! ```

use cplan::PlanOutput as _;
use cplan::motion::write_whole;
use cplan_testkit::course::FIGURES;
use cplan_testkit::pictures::{MOVING, PICTURES};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures");
    std::fs::create_dir_all(&docs)?;
    let course = docs.join("course");
    std::fs::create_dir_all(&course)?;
    for (name, draw) in FIGURES {
        let file = course.join(name).with_extension("svg");
        write_whole(&file, draw().svg().as_bytes())?;
        println!("{}", file.display());
    }
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
