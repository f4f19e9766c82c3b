//! Answers to random worlds against brute force, and against each other.
//!
//! `CPLAN_WORLDS=2000 cargo test --profile quick --test random_worlds -- --nocapture` looks at as many of each kind of
//! arm (or only of `CPLAN_KIND`), from seed `CPLAN_FIRST` on, at the finest effort, and prints counts.

mod oracle;
mod world;

use cplan::model::Problem;
use cplan::solve::{Answer, Effort, Method, Verdict, solve};
use oracle::{Oracle, Truth};
use std::time::{Duration, Instant};

/// Largest sum of rounding errors in a distance.
const ROUNDING: f64 = 1e-9;

/// Verdicts of one planner.
#[derive(Debug, Clone, Copy, Default)]
struct Count {
    found: usize,
    infeasible: usize,
    unknown: usize,
    time: Duration,
    longest: (Duration, u64),
}

/// What is wrong with an answer, if anything.
fn lie(problem: &Problem, oracle: &Oracle, truth: Truth, answer: &Answer) -> Option<String> {
    match &answer.verdict {
        Verdict::Unknown(_) => None,
        Verdict::Infeasible(_) => (truth == Truth::Connected).then(|| "infeasible, yet connected".into()),
        Verdict::Found(certified) => {
            let path = certified.path();
            let topology = problem.scene.arm.topology();
            if truth == Truth::Disconnected {
                return Some("found, yet disconnected".into());
            }
            if path.start() != problem.start {
                return Some(format!("starts at {:?}", path.start()));
            }
            if !problem.goals.iter().any(|&g| topology.distance(g, path.goal()) < ROUNDING) {
                return Some(format!("ends at {:?}", path.goal()));
            }
            for q in path.waypoints() {
                for (k, (lower, upper, circle)) in oracle.axes.into_iter().enumerate() {
                    if !q[k].is_finite() || (!circle && !(lower..=upper).contains(&q[k])) {
                        return Some(format!("{q:?} is outside the limits"));
                    }
                }
            }
            if certified.clearance() <= 0.0 || certified.clearance() < problem.scene.workspace.clearance {
                return Some(format!("proves {}", certified.clearance()));
            }
            let proven = certified.clearance() - problem.scene.workspace.clearance;
            let violation = oracle.violation(path, proven.min(1e9) - ROUNDING, 1e-4);
            violation.map(|(at, room)| format!("room {room} at {at:?}, proven {proven}"))
        }
    }
}

const PLANNERS: usize = Method::ALL.len();

/// Answers of all planners to one world; the lies among them.
fn look(problem: &Problem, seed: u64, effort: &Effort, lattice: usize, counts: &mut [Count; PLANNERS]) -> Vec<String> {
    let oracle = Oracle::new(&problem.scene);
    let truth = oracle.connected(problem.start, &problem.goals, lattice);
    let mut lies = Vec::new();
    let mut lengths = [None; PLANNERS];
    let mut infeasible = None;
    for (i, method) in Method::ALL.into_iter().enumerate() {
        let clock = Instant::now();
        let answer = solve(problem, method, effort, &mut |_| {});
        let time = clock.elapsed();
        let count = &mut counts[i];
        count.time += time;
        count.longest = count.longest.max((time, seed));
        if std::env::var_os("CPLAN_WORLDS").is_some() && time > Duration::from_secs(3) {
            println!("slow: {} {seed} {method} {time:.1?} {:?}", problem.scene.arm.kind(), answer.stages);
        }
        match &answer.verdict {
            Verdict::Found(path) => {
                count.found += 1;
                lengths[i] = Some((path.path().length(), path.clearance(), answer.history.len()));
            }
            Verdict::Infeasible(_) => {
                count.infeasible += 1;
                infeasible = Some(method);
            }
            Verdict::Unknown(why) => {
                count.unknown += 1;
                println!(
                    "unknown: {} {seed} {method} ({truth:?}): {why} {:?}",
                    problem.scene.arm.kind(),
                    answer.history
                );
            }
        }
        if let Some(lie) = lie(problem, &oracle, truth, &answer) {
            lies.push(format!("{} {seed} {method}: {lie}", problem.scene.arm.kind()));
        }
    }
    if let (Some(method), Some(_)) = (infeasible, lengths.iter().flatten().next()) {
        lies.push(format!("{} {seed}: infeasible by {method}, found by another", problem.scene.arm.kind()));
    }
    // Both roadmaps see the same polygons on the same level, and the visibility graph holds a shortest path in them.
    if let [Some((shortest, _, level)), Some((other, _, at)), ..] = lengths
        && level == at
        && shortest > other * (1.0 + ROUNDING)
    {
        lies.push(format!("{} {seed}: visibility {shortest}, trapezoid {other}", problem.scene.arm.kind()));
    }
    // A path that keeps more than three times the first margin lies in those polygons, unless it turns more often than
    // they do.
    if let Some((shortest, _, _)) = lengths[0] {
        let margin = 3.0 * effort.margin * problem.scene.arm.reach() + problem.scene.workspace.clearance;
        for (length, clearance, _) in lengths[1..].iter().flatten() {
            if *clearance > margin && shortest > length * (1.0 + ROUNDING) {
                lies.push(format!("{} {seed}: visibility {shortest}, another {length}", problem.scene.arm.kind()));
            }
        }
    }
    lies
}

#[test]
fn answers_agree_with_brute_force_and_each_other() {
    let number = |name: &str| std::env::var(name).ok().and_then(|n| n.parse().ok());
    let wanted: Option<u64> = number("CPLAN_WORLDS");
    let first = number("CPLAN_FIRST").unwrap_or(0);
    let effort = match wanted {
        Some(_) => Effort::default(),
        None => Effort { levels: 2, margin: 1e-3, cells: 128, boxes: 20_000 },
    };
    let lattice = if wanted.is_some() { 512 } else { 128 };
    let mut lies = Vec::new();
    let mut decided = 0;
    let kinds = std::env::var("CPLAN_KIND");
    for kind in world::KINDS.into_iter().filter(|kind| kinds.as_ref().is_ok_and(|k| k == kind) || kinds.is_err()) {
        let mut counts = [Count::default(); PLANNERS];
        let mut worlds = 0;
        for seed in first..first + wanted.unwrap_or(6) {
            if let Some(problem) = world::world(kind, seed) {
                worlds += 1;
                for lie in look(&problem, seed, &effort, lattice, &mut counts) {
                    println!("LIE: {lie}");
                    lies.push(lie);
                }
            }
        }
        for (method, count) in Method::ALL.into_iter().zip(counts) {
            println!("{kind} {method}: {worlds} worlds, {count:?}");
            decided += count.found + count.infeasible;
        }
    }
    assert!(lies.is_empty(), "{lies:#?}");
    assert!(decided > 0);
}
