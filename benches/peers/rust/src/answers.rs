//! cplan as a library: from the loaded problem to a certified path or a checked proof.

use crate::rounds::Rounds;
use crate::{Result, scenes};
use cplan::Options;
use cplan::engine::{Verdict, decide, solve};
use serde_json::{Value, json};

/// Boxes that a search may look at.
const BOXES: usize = 10_000;

pub fn run(urdf: &str, world: &str, rounds: usize) -> Result<Value> {
    let problem = scenes::problem(urdf, world)?;
    let mut times = Rounds::default();
    let (mut decided, mut shortest, mut proven) = (None, None, None);
    let answer = |bounded| solve(&problem, &Options { bounded, ..Options::default() }, &mut |_| {});
    for _ in 0..rounds {
        decided = Some(times.time("decide", || decide(&problem, BOXES)));
        shortest = Some(times.time("shortest", || answer(false).verdict));
        proven = Some(times.time("proven", || {
            let answer = answer(true);
            (answer.verdict, answer.bound.map(|bound| bound.gap()))
        }));
    }
    let told = |verdict: Option<Verdict>| match verdict {
        Some(Verdict::Found(path)) => {
            let waypoints: Vec<[f64; 2]> = path.path().waypoints().iter().map(|q| [q[0], q[1]]).collect();
            json!({"status": "found", "path": waypoints})
        }
        Some(Verdict::Infeasible(_)) => json!({"status": "infeasible"}),
        Some(Verdict::Unknown(_)) | None => json!({"status": "unknown"}),
    };
    let (proven, gap) = proven.map_or((None, None), |(verdict, gap)| (Some(verdict), gap));
    let mut proven = told(proven);
    proven["gap"] = gap.into();
    Ok(json!({"times": times.into_json(), "decide": told(decided), "shortest": told(shortest), "proven": proven}))
}
