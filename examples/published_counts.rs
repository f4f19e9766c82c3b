//! Searches for the reading of a source that explains most of its sweep counts. The text of Tables 17 to 19 (L. E.
//! Deicu 2012) leaves choices open; this program tries them with its own plain relaxation.
//!
//! ```text
//! cargo run --release --example published_counts [-- 100]
//! ```
//!
//! It searches on 100 x 100 cells, for the harmonic stage. Then it compares the best choice with all counts, on 100 x
//! 100 and, without the argument, on 250 x 250 cells. The maps are those of `published_tables`. The exit code is 1 if
//! another choice explains more than the one that the documentation names.

use cplan_testkit::published::deicu::{RELAXATIONS, SCALES, TABLES};
use cplan_testkit::published::plain::Choice;
use cplan_testkit::published::search::{self, Maps, OF_GAUSS_SEIDEL, OF_SOR, Tally};
use std::error::Error;
use std::process::ExitCode;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let maps = Maps::read()?;
    let small = std::env::args().nth(1).is_some_and(|scale| scale == "100");
    let scales = if small { 0..1 } else { 0..SCALES.len() };
    let mut as_said = true;
    let groups = [([0, 1], search::gauss_seidel(), OF_GAUSS_SEIDEL), ([2, 3], search::over_relaxation(), OF_SOR)];
    for (relaxations, choices, report) in groups {
        let names = relaxations.map(|of| RELAXATIONS[of]);
        println!("{} and {}, before preferences, 100 x 100 cells, all tables", names[0], names[1]);
        let tried: Vec<(Choice, Tally)> = choices
            .into_iter()
            .map(|choice| {
                let tally = search::together(maps.harmonic(relaxations, &choice, 0));
                println!("  {tally}  {choice}");
                (choice, tally)
            })
            .collect();
        as_said &= search::best(&tried) == Some(&report);
        println!("most is explained by: {report}\n");
        for scale in scales.clone() {
            println!("all stages, {0} x {0} cells: published and found", SCALES[scale]);
            for (table, tally) in TABLES.iter().zip(maps.all(relaxations, &report, scale)) {
                println!("  {}", table.title);
                for (name, counts) in names.iter().zip(tally.0.chunks(3)) {
                    let shown = |(printed, found): &(usize, Option<usize>)| {
                        format!("{printed} {}", found.map_or_else(|| "-".into(), |found| found.to_string()))
                    };
                    let [harmonic, bvp, altered] = [0, 1, 2].map(|stage| shown(&counts[stage]));
                    println!("    {name:<16} harmonic {harmonic:<12} BVP {bvp:<12} BVP 2 {altered}");
                }
                println!("    {tally}");
            }
            println!();
        }
    }
    Ok(if as_said { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
