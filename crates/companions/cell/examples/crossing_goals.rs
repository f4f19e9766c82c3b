//! Measures fifty random cells of two SCARAs whose goals cross: `cargo run --release -p cplan-cell --example crossing_goals`.
//! Prints one row for each cell, and the percentiles of all. With a number, prints the attempts for that cell only. With a
//! folder, also writes the cells to it.

use cplan_cases::cells::crossing;
use cplan_cell::{Cell, Settings, plan_cell};
use cplan_model::Status;
use cplan_robot::Source;
use std::error::Error;
use std::path::PathBuf;
use std::sync::OnceLock;
use std::time::Instant;

/// Number of cells.
const CELLS: usize = 50;

fn main() -> Result<(), Box<dyn Error>> {
    let robots = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../robots");
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("cell.toml");
    let argument = std::env::args().nth(1);
    let chosen = argument.as_ref().and_then(|number| number.parse::<usize>().ok());
    let folder = argument.filter(|_| chosen.is_none()).map(PathBuf::from);
    if let Some(folder) = &folder {
        std::fs::create_dir_all(folder)?;
    }
    let settings = Settings { boxes: 0, ..Settings::default() };
    let mut random = cplan_cases::dice(57);
    let (mut seconds, mut gaps, mut gaps_alone) = (Vec::new(), Vec::new(), Vec::new());
    while seconds.len() < CELLS && chosen.is_none_or(|chosen| seconds.len() <= chosen) {
        let Some(text) = crossing(&mut random, robots) else { continue };
        std::fs::write(&path, text)?;
        // Goals that are out of reach.
        let Ok(cell) = Cell::load(&Source::read(&path)?, &Source::read, None) else { continue };
        let begun = seconds_used();
        let plan = plan_cell(&cell, &settings, &mut |_| ())?;
        let lasted = seconds_used() - begun;
        // Starts that collide.
        if plan.status() == Status::Infeasible {
            continue;
        }
        let number = seconds.len();
        if let Some(folder) = &folder {
            std::fs::copy(&path, folder.join(format!("{number:02}_crossing.toml")))?;
        }
        seconds.push(lasted);
        let alone = plan.alone.iter().flatten().filter_map(|alone| alone.lower_bound).fold(0.0, f64::max);
        let result = match (plan.outcome.found(), plan.lower_bound) {
            (Some(found), Some(bound)) => {
                let gap = 100.0 * (found.duration / bound - 1.0);
                gaps.push(gap);
                gaps_alone.push(100.0 * (found.duration / alone - 1.0));
                format!("{:.3} s, at least {bound:.3} s ({alone:.3} s alone), gap {gap:.1} %", found.duration)
            }
            _ => "unknown".to_owned(),
        };
        if chosen.is_none_or(|chosen| chosen == number) {
            println!("{number:2}: {result}, planned in {lasted:.3} s");
        }
        if chosen == Some(number) {
            plan.tried.iter().for_each(|attempt| println!("    {attempt}"));
        }
    }
    if chosen.is_none() {
        println!("found {} of {CELLS}; 10 %, 50 %, 75 %, 90 % and all of the cells have at most", gaps.len());
        println!("{} seconds of processor time", percentiles(seconds));
        println!("{} % gap", percentiles(gaps));
        println!("{} % above the bounds of the arms alone", percentiles(gaps_alone));
    }
    Ok(())
}

/// Returns percentiles as text.
fn percentiles(mut values: Vec<f64>) -> String {
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values[((values.len() - 1) as f64 * share).round() as usize];
    [0.1, 0.5, 0.75, 0.9, 1.0].map(|share| format!("{:.3}", at(share))).join("  ")
}

/// Returns the processor time of this thread, seconds. If it is not known, returns the time since the first call.
fn seconds_used() -> f64 {
    static BEGUN: OnceLock<Instant> = OnceLock::new();
    let begun = BEGUN.get_or_init(Instant::now);
    let used = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = used.and_then(|used| used.split_whitespace().next()?.parse::<u64>().ok());
    nanoseconds.map_or_else(|| begun.elapsed().as_secs_f64(), |nanoseconds| nanoseconds as f64 * 1e-9)
}
