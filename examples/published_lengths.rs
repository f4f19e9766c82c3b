//! Compares shortest lengths of a point robot with published ones (docs/published_lengths.md). The folder has the
//! folders `maps`, `scenarios` and `results`.
//!
//! ```text
//! cargo run --release --example published_lengths -- FOLDER [MAP ...]
//! ```

use cplan_testkit::published::grid_lengths::{Lengths, compare_files};
use std::error::Error;
use std::path::PathBuf;

/// Number of differences that are printed for each map.
const PRINTED_DIFFERENCES: usize = 3;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().ok_or("usage: published_lengths FOLDER [MAP ...]")?);
    let mut names: Vec<String> = arguments.collect();
    if names.is_empty() {
        let files = std::fs::read_dir(folder.join("results"))?.collect::<Result<Vec<_>, _>>()?;
        let name = |entry: &std::fs::DirEntry| entry.path().file_stem().map(|name| name.to_string_lossy().into_owned());
        names = files.iter().filter_map(name).collect();
        names.sort();
    }
    let mut all = Lengths::default();
    for name in names {
        let lengths = compare_files(&folder, &name)?;
        println!("{name}: {lengths}");
        for difference in lengths.differences.iter().take(PRINTED_DIFFERENCES) {
            let [published, ours] = [difference.published, difference.ours]
                .map(|length| length.map_or_else(|| "no path".into(), |length| format!("{length:.8}")));
            println!("  query {}: published {published}, ours {ours}", difference.number);
        }
        all.add(lengths);
    }
    println!("all maps: {all}");
    Ok(())
}
