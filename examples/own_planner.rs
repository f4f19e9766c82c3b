//! A planner of one's own: a breadth-first search over the free cells of a `cspace.json`. It prints waypoints as CSV.
//!
//! ```text
//! cargo run --example own_planner -- cspace.json > results/own/shelf.csv
//! ```

use serde_json::Value;
use std::collections::{HashMap, VecDeque};

/// Returns the waypoints with the names of the joints in the first line.
pub fn csv(cspace: &Value) -> Option<String> {
    let name = |k: usize| cspace["axes"][k]["joint"].as_str().expect("a name");
    let lines = waypoints(cspace)?.into_iter().map(|[q1, q2]| format!("{q1},{q2}\n"));
    Some(lines.fold(format!("{},{}\n", name(0), name(1)), |text, line| text + &line))
}

/// Returns waypoints from the start to the goal through the centers of free cells, or `None` if the cells have no path.
fn waypoints(cspace: &Value) -> Option<Vec<[f64; 2]>> {
    let (space, grid) = (&cspace["spaces"][0], &cspace["spaces"][0]["grid"]);
    let pair = |value: &Value| [0, 1].map(|k| value[k].as_f64().expect("a number"));
    let (lower, size, shape) = (pair(&grid["lower"]), pair(&grid["size"]), pair(&grid["shape"]).map(|n| n as i64));
    let (start, goal) = (pair(&space["start"]), pair(&space["goals"][0][0]));
    let cell = |q: [f64; 2]| [0, 1].map(|k| ((q[k] - lower[k]) / size[k]) as i64);
    let center = |c: [i64; 2]| [0, 1].map(|k| lower[k] + (c[k] as f64 + 0.5) * size[k]);
    let is_free = |c: [i64; 2]| {
        let is_inside = (0..2).all(|k| (0..shape[k]).contains(&c[k]));
        is_inside && grid["blocked"][(c[0] * shape[1] + c[1]) as usize] == 0
    };
    // The search begins at the goal, so that the next cells lead there.
    let (mut next, mut queue) = (HashMap::from([(cell(goal), cell(goal))]), VecDeque::from([cell(goal)]));
    while let Some(c) = queue.pop_front() {
        for neighbor in [[c[0] - 1, c[1]], [c[0] + 1, c[1]], [c[0], c[1] - 1], [c[0], c[1] + 1]] {
            if is_free(neighbor) && !next.contains_key(&neighbor) {
                next.insert(neighbor, c);
                queue.push_back(neighbor);
            }
        }
    }
    let (mut path, mut at) = (vec![start], cell(start));
    while next.get(&at)? != &at {
        path.push(center(at));
        at = next[&at];
    }
    path.extend([center(at), goal]);
    Some(path)
}

fn main() {
    let file = std::env::args().nth(1).expect("usage: own_planner CSPACE.json");
    let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{file}: {error}"));
    let cspace: Value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{file}: {error}"));
    print!("{}", csv(&cspace).expect("the cells have no path"));
}
