//! Redraws the pictures of the documentation: each planner on one workspace, one workspace without a path, the demo's cell,
//! and two tasks.
//!
//! ```text
//! cargo run --release --example pictures
//! ```

mod drawn;

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
    }
    Ok(())
}
