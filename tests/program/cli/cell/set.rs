//! The set of a hundred cells, and its recorded answers.

use super::super::{Place, number};
use super::{answer, read, shipped};
use cplan_cases::cells::{CellCase, cell_set};

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
        let (CellCase { name, text, .. }, recorded) = (&cells[drawn], &recorded[drawn]);
        let text = text.replace("urdf = \"robots/", &format!("urdf = \"{}/", shipped("robots")));
        let done = Place::new().with("cell.toml", text).run(&["cell", "cell.toml", "--json", "--quiet"], "");
        let answer = answer(&done);
        assert_eq!(answer["status"], *recorded.status, "{name}: {}", done.stderr);
        if let Some(cycle) = recorded.cycle {
            let duration = number(&answer["duration"]);
            assert!(duration <= cycle * (1.0 + SLACK), "{name}: {duration} s, recorded {cycle} s");
            assert!(number(&answer["lower_bound"]) <= cycle + 1e-3, "{name}: {answer:.200}");
        }
    }
}
