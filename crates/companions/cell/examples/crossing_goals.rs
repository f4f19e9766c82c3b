//! Measures fifty random cells of two SCARAs whose goals cross: `cargo run --release -p cplan-cell --example crossing_goals`.
//! Prints one row for each cell, and the percentiles of all. With a number, prints the attempts for that cell only.

use cplan_cases::dice::Dice;
use cplan_cell::{Cell, Settings, plan_cell};
use cplan_model::Status;
use std::error::Error;
use std::f64::consts::PI;
use std::sync::OnceLock;
use std::time::Instant;

/// Number of cells.
const CELLS: usize = 50;

/// Lengths of the links of `robots/scara.urdf`, metres.
const LENGTHS: [f64; 2] = [0.3, 0.25];

fn main() -> Result<(), Box<dyn Error>> {
    let robot = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../robots/scara.urdf");
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("cell.toml");
    let chosen = std::env::args().nth(1).map(|number| number.parse::<usize>()).transpose()?;
    let settings = Settings { boxes: 0, ..Settings::default() };
    let mut random = cplan_cases::dice(57);
    let (mut seconds, mut gaps, mut gaps_alone) = (Vec::new(), Vec::new(), Vec::new());
    while seconds.len() < CELLS && chosen.is_none_or(|chosen| seconds.len() <= chosen) {
        let Some(text) = cell_text(&mut random, robot) else { continue };
        std::fs::write(&path, text)?;
        // Goals that are out of reach.
        let Ok(cell) = Cell::load(&path, &|path| path.into(), None) else { continue };
        let begun = seconds_used();
        let plan = plan_cell(&cell, &settings, &mut |_| ())?;
        let lasted = seconds_used() - begun;
        // Starts that collide.
        if plan.status() == Status::Infeasible {
            continue;
        }
        let number = seconds.len();
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

/// Returns a random cell: each arm moves from one side of the table to the other, and the arms move in opposite directions.
/// Returns `None` if a start is out of reach.
fn cell_text(random: &mut Dice, robot: &str) -> Option<String> {
    let apart = random.within(0.6, 0.95);
    let mut tip = |side: f64| [apart / 2.0 + random.within(-0.12, 0.12), side * random.within(0.08, 0.3)];
    let (starts, goals) = ([tip(-1.0), tip(1.0)], [tip(1.0), tip(-1.0)]);
    let sides = [0, 1].map(|_| if random.chance(0.5) { 1.0 } else { -1.0 });
    let bases = [([0.0, 0.0], 0.0), ([apart, 0.0], PI)];
    let mut text = String::new();
    for (arm, name) in ["left", "right"].into_iter().enumerate() {
        let (base, angle) = bases[arm];
        let start = joints_at(base, angle, starts[arm], sides[arm])?;
        text += &format!(
            "[[arm]]\nname = \"{name}\"\nurdf = \"{robot}\"\nbase = {{ at = {base:?}, angle = {angle:?} }}\n\
             robot = {{ joints = [\"axis_1\", \"axis_2\"], tip = \"flange\", fixed = {{ axis_3 = -0.15 }} }}\n\
             start = {{ joints = {start:?} }}\ngoal = {{ tip = {:?} }}\n",
            goals[arm]
        );
    }
    Some(text)
}

/// Returns joint values that put the tip at a place, with the elbow on one side.
fn joints_at(base: [f64; 2], angle: f64, tip: [f64; 2], side: f64) -> Option<[f64; 2]> {
    let (sin, cos) = angle.sin_cos();
    let [x, y] = [tip[0] - base[0], tip[1] - base[1]];
    let [x, y] = [cos * x + sin * y, cos * y - sin * x];
    let [a, b] = LENGTHS;
    let bend = (x * x + y * y - a * a - b * b) / (2.0 * a * b);
    (bend.abs() < 1.0).then(|| {
        let elbow = side * bend.acos();
        let shoulder = y.atan2(x) - (b * elbow.sin()).atan2(a + b * elbow.cos());
        [(shoulder + PI).rem_euclid(2.0 * PI) - PI, elbow]
    })
}
