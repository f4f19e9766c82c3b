//! Redraws the pictures of the documentation: each planner on one workspace, one workspace without a path, the demo's
//! cell, two tasks, and the animated one.
//!
//! ```text
//! cargo run --release --example pictures
//! ```

mod drawn;

use cplan::PlanOutput as _;
use cplan::motion::write_whole;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures");
    std::fs::create_dir_all(&docs)?;
    for (name, subject) in drawn::PICTURES {
        let file = docs.join(name).with_extension("svg");
        write_whole(&file, subject.svg()?.as_bytes())?;
        println!("{}", file.display());
        if name == drawn::MOVING.1 {
            let file = docs.join(drawn::MOVING.0).with_extension("gif");
            subject.plan()?.save(&file)?;
            println!("{}", file.display());
        }
    }
    Ok(())
}
