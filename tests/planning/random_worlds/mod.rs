//! Answers to random worlds against brute force, and against each other.
//!
//! The worlds have 5 to 30 obstacles, arms of all kinds, and joints with and without limits. The brute force shares no
//! code with the library: a flood fill over up to 2048 x 2048 cells, wherever that is decisive. `cargo test` tries a
//! few worlds with little effort. The long run, with the default options and printed counts, is
//!
//! ```sh
//! CPLAN_WORLDS=2500 cargo test --profile quick --test planning random_worlds -- --nocapture
//! ```
//!
//! It tries this many worlds of each kind of arm, on all cores. Further environment variables:
//! - `CPLAN_KIND`: only this kind.
//! - `CPLAN_FIRST`: the first seed (default: that of `CPLAN_SEED`).
//! - `CPLAN_LATTICE`: cells along an axis (default: 2048).
//! - `CPLAN_SHARE`: interval between worlds in which planners other than shortest, visibility and subdivision answer
//!   (default: 20).
//! - `CPLAN_LEVELS`: attempts of a planner (default: that of [`Options::default`]).
//! - `CPLAN_THREADS`: number of threads.

mod body;
mod exploring;
mod flood;

use cplan::Outcome;
use cplan::engine::{Answer, Method, Options, Planner, solve};
use cplan::model::MotionProblem;
use cplan_cases::seeds;
use cplan_testkit::oracle::Oracle;
use cplan_testkit::world;
use flood::{Truth, connected};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Largest rounding error of a distance, in metres.
const ROUNDING: f64 = 1e-9;

/// An answer that takes longer than this is listed in the long run.
const SLOW: Duration = Duration::from_secs(2);

const PLANNERS: usize = Method::ALL.len();

/// Numbers of verdicts of one planner.
#[derive(Debug, Clone, Copy, Default)]
struct Count {
    found: usize,
    infeasible: usize,
    unknown: usize,
    /// Number of worlds in which the planner's answer is unknown although the flood fill decides them.
    unknown_yet_decided: usize,
    time: Duration,
    longest: (Duration, u64),
}

/// Verdicts on the worlds of one kind of arm.
#[derive(Debug, Default)]
struct Tally {
    worlds: usize,
    connected: usize,
    disconnected: usize,
    undecided: usize,
    oracle: Duration,
    planners: [Count; PLANNERS],
    lies: Vec<String>,
}

/// First margin of polygons, as a fraction of the reach.
const MARGIN: f64 = 1e-3;

/// Settings of a run.
struct Run {
    levels: usize,
    boxes: usize,
    cells: Option<usize>,
    lattice: usize,
    /// One world in this many is answered by all planners.
    share: u64,
    /// True to include arms whose own body is an obstacle.
    body: bool,
    long: bool,
}

impl Run {
    /// Returns the settings of a run with the defaults of each planner, and with this lattice.
    fn with_defaults(lattice: usize) -> Self {
        let Options { levels, boxes, .. } = Options::default();
        Self { levels, boxes, cells: None, lattice, share: u64::MAX, body: false, long: false }
    }

    fn options(&self, method: Method) -> Options {
        let planner = Planner::named(method);
        let planner = self.cells.map_or(planner, |n| planner.with_cells(n));
        Options { levels: self.levels, boxes: self.boxes, ..planner.into() }
    }
}

/// Describes a false statement of an answer. Returns `None` for a true answer.
fn false_answer(problem: &MotionProblem, oracle: &Oracle, truth: Truth, answer: &Answer) -> Option<String> {
    match &answer.outcome {
        Outcome::Unknown(_) => None,
        Outcome::Infeasible(_) => (truth == Truth::Connected).then(|| "infeasible, yet connected".into()),
        Outcome::Found(certified) => {
            let path = certified.path();
            let topology = problem.scene().arm().topology();
            if truth == Truth::Disconnected {
                return Some("found, yet disconnected".into());
            }
            if path.start() != problem.start() {
                return Some(format!("starts at {:?}", path.start()));
            }
            if !problem.goals().contains(&topology, path.goal(), ROUNDING) {
                return Some(format!("ends at {:?}", path.goal()));
            }
            for q in path.waypoints() {
                for (k, (lower, upper, circle)) in oracle.axes.into_iter().enumerate() {
                    if !q[k].is_finite() || (!circle && !(lower..=upper).contains(&q[k])) {
                        return Some(format!("{q:?} is outside the limits"));
                    }
                }
            }
            if certified.clearance() <= 0.0 || certified.clearance() < problem.scene().workspace().clearance {
                return Some(format!("proves {}", certified.clearance()));
            }
            let proven = certified.clearance() - problem.scene().workspace().clearance;
            let violation = oracle.violation(path, proven.min(1e9) - ROUNDING, 1e-4);
            violation.map(|(at, room)| format!("room {room} at {at:?}, proven {proven}"))
        }
    }
}

/// Compares the planners' answers to one world, and records false ones.
fn check_world(problem: &MotionProblem, seed: u64, run: &Run, tally: &Mutex<Tally>) {
    let kind = problem.scene().arm().kind();
    let clock = Instant::now();
    let oracle = Oracle::new(problem.scene());
    let truth = connected(&oracle, problem.start(), &problem.goals().points().collect::<Vec<_>>(), run.lattice);
    let oracle_time = clock.elapsed();
    let mut lies = Vec::new();
    let mut lengths = [None; PLANNERS];
    let mut infeasible = None;
    let mut lower = Vec::new();
    let mut counts = [Count::default(); PLANNERS];
    for (i, method) in Method::ALL.into_iter().enumerate() {
        let always = matches!(method, Method::Shortest | Method::Visibility | Method::Subdivision);
        if !always && !seed.is_multiple_of(run.share) {
            continue;
        }
        let clock = Instant::now();
        let answer = solve(problem, &run.options(method), &mut |_| {});
        let time = clock.elapsed();
        let count = &mut counts[i];
        count.time = time;
        count.longest = (time, seed);
        if run.long && time > SLOW {
            println!("slow: {kind} {seed} {method} {time:.1?} {:?}", answer.stages);
        }
        match &answer.outcome {
            Outcome::Found(path) => {
                count.found += 1;
                lengths[i] = Some((path.path().length(), path.clearance(), answer.history.len()));
            }
            Outcome::Infeasible(_) => {
                count.infeasible += 1;
                infeasible = Some(method);
            }
            Outcome::Unknown(why) => {
                count.unknown += 1;
                count.unknown_yet_decided += usize::from(truth != Truth::Undecided);
                println!("unknown: {kind} {seed} {method} ({truth:?}): {why} {:?}", answer.history);
            }
        }
        lower.extend(answer.bound().map(|bound| (bound.lower, method)));
        if let Some(lie) = false_answer(problem, &oracle, truth, &answer) {
            lies.push(format!("{kind} {seed} {method}: {lie}"));
        }
    }
    if let (Some(method), Some(_)) = (infeasible, lengths.iter().flatten().next()) {
        lies.push(format!("{kind} {seed}: infeasible by {method}, found by another"));
    }
    for (lower, method) in lower {
        for (length, ..) in lengths.iter().flatten() {
            if lower > length * (1.0 + ROUNDING) {
                lies.push(format!("{kind} {seed}: no path below {lower} by {method}, yet {length}"));
            }
        }
    }
    // On the same level, both roadmaps have the same polygons, and the visibility graph contains a shortest path among
    // them.
    let of = |method: Method| Method::ALL.into_iter().zip(lengths).find(|of| of.0 == method).and_then(|of| of.1);
    if let (Some((shortest, _, level)), Some((other, _, at))) = (of(Method::Visibility), of(Method::Trapezoid))
        && level == at
        && shortest > other * (1.0 + ROUNDING)
    {
        lies.push(format!("{kind} {seed}: visibility {shortest}, trapezoid {other}"));
    }
    // A path that keeps more than three times the first margin lies in those polygons, unless it turns more often than
    // they do. (Replacements of tight goals decide which of several goals is nearest, so no goal may be tight here.)
    let margin = 3.0 * MARGIN * problem.scene().arm().reach();
    if let Some((shortest, _, _)) = of(Method::Visibility)
        && problem.goals().points().all(|goal| oracle.room(goal) > margin)
    {
        let margin = margin + problem.scene().workspace().clearance;
        for (length, clearance, _) in lengths.iter().flatten() {
            if *clearance > margin && shortest > length * (1.0 + ROUNDING) {
                lies.push(format!("{kind} {seed}: visibility {shortest}, another {length}"));
            }
        }
    }
    lies.iter().for_each(|lie| println!("LIE: {lie}"));
    let mut tally = tally.lock().expect("no thread panicked");
    tally.worlds += 1;
    tally.oracle += oracle_time;
    match truth {
        Truth::Connected => tally.connected += 1,
        Truth::Disconnected => tally.disconnected += 1,
        Truth::Undecided => tally.undecided += 1,
    }
    tally.lies.extend(lies);
    for (all, one) in tally.planners.iter_mut().zip(counts) {
        all.found += one.found;
        all.infeasible += one.infeasible;
        all.unknown += one.unknown;
        all.unknown_yet_decided += one.unknown_yet_decided;
        all.time += one.time;
        all.longest = all.longest.max(one.longest);
    }
}

/// Tries all worlds of a kind with these seeds.
fn check_worlds(kind: &str, seeds: std::ops::Range<u64>, run: &Run, threads: usize) -> Tally {
    let next = AtomicU64::new(seeds.start);
    let tally = Mutex::new(Tally::default());
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if seed >= seeds.end {
                        break;
                    }
                    let of_body = || body::world_of_body(kind, seed);
                    let worlds = [world::world(kind, seed), run.body.then(of_body).flatten()];
                    worlds.iter().flatten().for_each(|problem| check_world(problem, seed, run, &tally));
                }
            });
        }
    });
    tally.into_inner().expect("no thread panicked")
}

fn print(kind: &str, tally: &Tally) {
    let worlds = tally.worlds;
    let mean = |time: Duration, n: usize| time.as_secs_f64() * 1e3 / n.max(1) as f64;
    println!(
        "{kind}: {worlds} worlds; flood fill: {} connected, {} disconnected, {} undecided, {:.1} ms each; {} lies",
        tally.connected,
        tally.disconnected,
        tally.undecided,
        mean(tally.oracle, worlds),
        tally.lies.len()
    );
    for (method, count) in Method::ALL.into_iter().zip(tally.planners) {
        let n = count.found + count.infeasible + count.unknown;
        println!(
            "{kind} {method}: {n} worlds; {} found, {} infeasible, {} unknown ({} of them decided by the flood fill); \
             {:.1} ms each, at most {:.2?} (seed {})",
            count.found,
            count.infeasible,
            count.unknown,
            count.unknown_yet_decided,
            mean(count.time, n),
            count.longest.0,
            count.longest.1
        );
    }
}

/// Checks worlds that revealed defects. In the first three (PP, PR), link 1 touches an obstacle wherever it slides.
/// That once filled the memory with columns, or left the start in a column that was not examined. In the last (RP), a
/// proof required less depth than its check.
#[test]
fn remembered_worlds_are_decided() {
    let run = Run::with_defaults(512);
    for (kind, seed) in [("PP", 2471), ("PP", 2434), ("PR", 54), ("RP", 2679)] {
        let tally = check_worlds(kind, seed..seed + 1, &run, 1);
        assert_eq!((tally.worlds, tally.lies.len()), (1, 0), "{kind} {seed}");
        assert!(tally.planners.iter().all(|count| count.unknown == 0), "{kind} {seed}: {:?}", tally.planners);
    }
}

#[test]
fn answers_agree_with_brute_force_and_each_other() {
    let number = |name: &str| std::env::var(name).ok().and_then(|n| n.parse::<u64>().ok());
    let wanted = number("CPLAN_WORLDS");
    let worlds = seeds(8);
    let first = number("CPLAN_FIRST").unwrap_or(worlds.start);
    let count = wanted.unwrap_or(worlds.end - worlds.start);
    let run = match wanted {
        Some(_) => Run {
            levels: number("CPLAN_LEVELS").map_or(Options::default().levels, |n| n as usize),
            share: number("CPLAN_SHARE").unwrap_or(20).max(1),
            body: true,
            long: true,
            ..Run::with_defaults(number("CPLAN_LATTICE").unwrap_or(2048) as usize)
        },
        None => Run { levels: 2, boxes: 20_000, cells: Some(128), share: 2, body: true, ..Run::with_defaults(512) },
    };
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let threads = number("CPLAN_THREADS").map_or(cores, |n| n as usize).max(1);
    let chosen = std::env::var("CPLAN_KIND");
    let mut lies = Vec::new();
    let (mut decided, mut decisive) = (0, 0);
    for kind in world::KINDS.into_iter().filter(|kind| chosen.as_ref().map_or(true, |k| k == kind)) {
        let tally = check_worlds(kind, first..first + count, &run, threads);
        print(kind, &tally);
        decided += tally.planners.iter().map(|count| count.found + count.infeasible).sum::<usize>();
        decisive += tally.connected + tally.disconnected;
        lies.extend(tally.lies);
    }
    assert!(lies.is_empty(), "{lies:#?}");
    assert!(decided > 0 && decisive > 0);
}
