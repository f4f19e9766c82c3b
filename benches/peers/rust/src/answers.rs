//! cplan as a library: from the loaded problem to a certified path or a checked proof.

use crate::rounds::Rounds;
use crate::{Result, scenes};
use cplan::check::CheckedProof;
use cplan::engine::{decide, solve};
use cplan::space::Path;
use cplan::{Options, Outcome};
use serde_json::{Value, json};

/// Largest number of boxes that a search may examine.
const BOXES: usize = 10_000;

pub fn run(urdf: &str, world: &str, rounds: usize) -> Result<Value> {
    let problem = scenes::problem(urdf, world)?;
    let mut times = Rounds::default();
    let (mut decided, mut shortest, mut proven) = (None, None, None);
    let answer = |bounded| solve(&problem, &Options { bounded, ..Options::default() }, &mut |_| {});
    for _ in 0..rounds {
        decided = Some(times.time("decide", || decide(&problem, BOXES).map(|found| found.path().clone())));
        shortest = Some(times.time("shortest", || answer(false).outcome.map(|found| found.path().clone())));
        proven = Some(times.time("proven", || {
            let answer = answer(true);
            let gap = answer.bound().map(|bound| bound.gap());
            (answer.outcome.map(|found| found.path().clone()), gap)
        }));
    }
    let (proven, gap) = proven.map_or((None, None), |(verdict, gap)| (Some(verdict), gap));
    let mut proven = output(proven);
    proven["gap"] = gap.into();
    Ok(json!({"times": times.into_json(), "decide": output(decided), "shortest": output(shortest), "proven": proven}))
}

/// Returns an outcome as JSON; the status is "unknown" if nothing was run.
fn output<U>(outcome: Option<Outcome<Path, CheckedProof, U>>) -> Value {
    match outcome {
        Some(Outcome::Found(path)) => {
            let waypoints: Vec<[f64; 2]> = path.waypoints().iter().map(|q| [q[0], q[1]]).collect();
            json!({"status": "found", "path": waypoints})
        }
        Some(Outcome::Infeasible(_)) => json!({"status": "infeasible"}),
        Some(Outcome::Unknown(_)) | None => json!({"status": "unknown"}),
    }
}
