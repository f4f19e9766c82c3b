//! Writes the reference of world files, `docs/world_reference.md`, from their schema.
//!
//! ```text
//! cargo run --example world_reference
//! ```

use cplan::motion::write_whole;
use cplan_testkit::world_reference::page;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let schema = serde_json::from_str(&std::fs::read_to_string(docs.join("world.schema.json"))?)?;
    let file = docs.join("world_reference.md");
    write_whole(&file, page(&schema).as_bytes())?;
    println!("{}", file.display());
    Ok(())
}
