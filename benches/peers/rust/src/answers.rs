//! cplan as a library: from the loaded problem to a certified path or a checked proof.

use crate::rounds::Rounds;
use crate::{Result, scenes};
use cplan::solve::{Verdict, bound, decide, shorten};
use cplan::space::Metric;
use serde_json::{Value, json};

/// Slabs of joint 1 that a search may look at.
const SLABS: usize = 10_000;

/// How far the path of `shorten` may be from the shortest in the channel.
const TOLERANCE: f64 = 1e-4;

pub fn run(urdf: &str, world: &str, rounds: usize) -> Result<Value> {
    let problem = scenes::problem(urdf, world)?;
    let mut times = Rounds::default();
    let (mut decided, mut shortened, mut proven) = (None, None, None);
    for _ in 0..rounds {
        decided = Some(times.time("decide", || decide(&problem, SLABS)));
        shortened = Some(times.time("shorten", || shorten(&problem, TOLERANCE, SLABS)));
        proven = Some(times.time("proven", || {
            let verdict = shorten(&problem, TOLERANCE, SLABS);
            let gap = match &verdict {
                Verdict::Found(path) => Some(bound(&problem, path.path(), Metric::Euclidean, TOLERANCE).gap()),
                Verdict::Infeasible(_) | Verdict::Unknown(_) => None,
            };
            (verdict, gap)
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
    Ok(json!({"times": times.into_json(), "decide": told(decided), "shorten": told(shortened), "proven": proven}))
}
