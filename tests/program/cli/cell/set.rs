//! The set of a hundred cells, and its recorded answers.

use super::super::{Place, number};
use super::proofs::verified;
use super::{answer, read, shipped};
use cplan_cases::cells::{CellCase, cell_set};
use std::collections::BTreeMap;
use std::time::Instant;

/// Share by which a cycle may exceed the recorded one. Another machine rounds differently, and finds other motions.
const SLACK: f64 = 0.02;

/// Number of cells that are planned.
const DRAWN: usize = 10;

/// The recorded answer about a cell.
struct Recorded {
    name: String,
    kind: String,
    status: String,
    is_blocked: bool,
    cycle: Option<f64>,
}

fn recorded() -> Vec<Recorded> {
    let table = read(shipped("workspaces/cells/answers.csv"));
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let [name, kind, status, _, blocked, cycle, _] = cells[..] else { panic!("{line}") };
        let cycle = (!cycle.is_empty()).then(|| cycle.parse().unwrap());
        let [name, kind, status] = [name, kind, status].map(str::to_owned);
        Recorded { name, kind, status, is_blocked: blocked == "yes", cycle }
    };
    table.lines().skip(1).map(row).collect()
}

/// Returns a place with a cell of the set.
pub fn place_of(case: &CellCase) -> Place {
    let text = case.text.replace("urdf = \"robots/", &format!("urdf = \"{}/", shipped("robots")));
    Place::new().with("cell.toml", text)
}

#[test]
fn the_set_has_its_kinds_and_answers() {
    let (cells, recorded) = (cell_set("robots"), recorded());
    assert_eq!((cells.len(), recorded.len()), (100, 100));
    for (cell, recorded) in cells.iter().zip(&recorded) {
        assert_eq!((&cell.name, cell.kind), (&recorded.name, &*recorded.kind));
        assert_eq!(recorded.cycle.is_some(), recorded.status == "found", "{}", cell.name);
    }
    let count = |is: &dyn Fn(&Recorded) -> bool| recorded.iter().filter(|recorded| is(recorded)).count();
    assert!(count(&|recorded| recorded.status == "infeasible") >= 20);
    assert!(count(&|recorded| recorded.kind == "swap" && recorded.is_blocked && recorded.status == "found") >= 10);
}

#[test]
fn cells_of_the_set_have_their_recorded_answers() {
    let (cells, recorded) = (cell_set("robots"), recorded());
    let mut random = cplan_cases::dice(100);
    for stratum in 0..DRAWN {
        let drawn = stratum * cells.len() / DRAWN + random.below(cells.len() / DRAWN);
        let (case, recorded) = (&cells[drawn], &recorded[drawn]);
        let (name, place) = (&case.name, place_of(case));
        let done = place.run(&["cell", "cell.toml", "--json", "--quiet"], "");
        let answer = answer(&done);
        assert_eq!(answer["status"], *recorded.status, "{name}: {}", done.stderr);
        if done.code == 3 {
            verified(&place, "cell.toml", &answer, "").exits(3).says(&["infeasible: proven"]);
        }
        if let Some(cycle) = recorded.cycle {
            let duration = number(&answer["duration"]);
            assert!(duration <= cycle * (1.0 + SLACK), "{name}: {duration} s, recorded {cycle} s");
            assert!(number(&answer["lower_bound"]) <= cycle + 1e-3, "{name}: {answer:.200}");
        }
    }
}

#[test]
#[ignore = "a measurement: cargo test --release --test program -- --ignored --nocapture infeasible_cells"]
fn infeasible_cells_are_verified() {
    // For each kind of proof: the number of cells, the largest proof in bytes, and the longest check in seconds.
    let mut kinds = BTreeMap::new();
    for (case, _) in cell_set("robots").iter().zip(recorded()).filter(|(_, recorded)| recorded.status == "infeasible") {
        let place = place_of(case);
        place.run(&["cell", "cell.toml", "--quiet", "--output", "cell.json"], "").exits(3);
        let proof = place.json("cell.json")["proof"].clone();
        let begun = Instant::now();
        place.run(&["verify", "cell.toml", "cell.json"], "").exits(3).says(&["infeasible: proven"]);
        let seconds = begun.elapsed().as_secs_f64();
        let known = kinds.entry(proof["kind"].to_string()).or_insert((0, 0, 0.0_f64));
        *known = (known.0 + 1, known.1.max(proof.to_string().len()), known.2.max(seconds));
    }
    println!("{kinds:?}");
    assert_eq!(kinds.values().map(|(count, ..)| count).sum::<i32>(), 27);
}
