//! Writes the reference of world files, `docs/world_reference.md`, from their schema.
//!
//! ```text
//! cargo run --example world_reference
//! ```

mod page;

use cplan::input::world_schema;
use cplan::motion::write_whole;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/world_reference.md");
    write_whole(&file, page::page(&world_schema()).as_bytes())?;
    println!("{}", file.display());
    Ok(())
}
