//! Motions among moving obstacles: which certified path to take, when to depart, and where to wait.
//!
//! Position on a path and time form a plane, in which moving obstacles are forbidden regions. The steps are:
//! - A path past the static obstacles is certified first, without the moving ones.
//! - Along it, the arm moves from rest to rest between places where it may wait. `departures` computes at which times
//!   each of these motions must not begin, from the times at which obstacles block a configuration (`blocked`).
//! - A search over safe intervals finds the earliest motion (`schedule`).
//! - If it finds no motion, `refutation` tries to prove that no timing avoids the obstacles along this path.
//! - Further paths are planned around the moving obstacle, at the place where the motion meets it.
//! - The result is judged in time, like any recording, by [`cplan_motion::recorded::certify_in_time`].

mod blocked;
mod departures;
mod refutation;
mod schedule;

pub use blocked::MovingObstacles;
pub use schedule::TimingRequirements;

use cplan_engine::{MotionAmongMovers, MoverSearch};
use cplan_geometry::Interval;
use cplan_handling::{Interpolation, ObstacleTrajectory, Recording, TimedScene};
use cplan_interrupt::checkpoint;
use cplan_judge::{CertifiedPath, Nearest, certify};
use cplan_model::space::{Configuration, GoalSet, Segment};
use cplan_model::{MotionProblem, Outcome};
use cplan_motion::recorded::{CollisionCheck, certify_in_time, first_moving_contact};
use cplan_motion::{Limits, TimedMotion, Timing, TimingError, Trajectory};
use cplan_solver::{Options, solve};
use cplan_text::counted;
use refutation::has_no_timing;
use schedule::{Effort, ScheduledMotion, schedule};

/// Largest number of paths that are tried. The first is the planner's path. Each further path leads around a moving
/// obstacle that the motion along an earlier path meets.
const MAX_PATHS: usize = 3;

/// Gap of further paths, unless the user requests one. Such paths are found much faster than shortest ones. They have
/// fewer corners, so the arm usually moves faster along them.
const PATH_GAP: f64 = 0.03;

/// Largest difference of two times that count as equal, in seconds. Times are whole nanoseconds.
const TIME_ROUNDING: f64 = 1e-8;

/// The search for motions among moving obstacles, for plans.
#[derive(Debug)]
pub struct Search;

impl MoverSearch for Search {
    fn plan(
        &self,
        problem: &MotionProblem,
        trajectories: &[ObstacleTrajectory],
        certified: &CertifiedPath,
        first: TimedMotion,
        options: &Options,
    ) -> Result<MotionAmongMovers, TimingError> {
        let demand = TimingRequirements::UNCONSTRAINED;
        time_among_moving_obstacles(problem, trajectories, certified, first, options, &demand)
    }

    fn blocked_times(&self, timed: TimedScene, configurations: &[Configuration]) -> Vec<Vec<Vec<Interval>>> {
        let movers = MovingObstacles::new(timed, timed.scene.workspace().clearance);
        let times = |&q: &Configuration| {
            checkpoint();
            movers.blocked_times(q)
        };
        configurations.iter().map(times).collect()
    }
}

/// Returns the earliest motion along the certified path and a few other paths. The problem's loose obstacles follow
/// `trajectories`. `first` is the motion along the certified path without moving obstacles, at the required speed. The
/// clearance of the motion includes moving obstacles. If there is no motion, returns the reason in words.
///
/// # Errors
/// A path that cannot be timed.
pub fn time_among_moving_obstacles(
    problem: &MotionProblem,
    trajectories: &[ObstacleTrajectory],
    certified: &CertifiedPath,
    first: TimedMotion,
    options: &Options,
    demand: &TimingRequirements,
) -> Result<MotionAmongMovers, TimingError> {
    let scene = problem.scene();
    let timed = TimedScene { scene, trajectories };
    let movers = MovingObstacles::new(timed, scene.workspace().clearance);
    let mut around = problem.clone();
    let mut alternative = Some((certified.clone(), first));
    // The motions in the order in which they were found. Each is better than the ones before.
    let mut found: Vec<ScheduledMotion> = Vec::new();
    let (mut refuted, mut ways) = (0, 0);
    while let Some((path, whole)) = alternative.take() {
        ways += 1;
        let best = found.last();
        let for_good = best.filter(|best| best.may_stay_forever()).map(ScheduledMotion::duration);
        // If the arm can stay for ever where the best motion ends, only earlier motions are better. So a path is
        // skipped if its motion takes longer even without waits.
        let latest = demand.arrival.map_or(f64::INFINITY, |[_, ends]| ends + TIME_ROUNDING);
        let before = for_good.unwrap_or(f64::INFINITY).min(latest);
        if whole.trajectory.duration() < before {
            let along = |effort: Effort| {
                // If jerks are limited, rounding corners takes half of the computing time, and a thorough search times
                // many motions.
                let stops = effort == Effort::THOROUGH && Limits::from(scene.arm()).stops_at_corners();
                let drive = if stops { options.drive.stopping_at_corners() } else { options.drive };
                let along = schedule(&movers, &path, &whole, &drive, demand, effort, before)?;
                Ok::<_, TimingError>(along.filter(|it| best.is_none_or(|best| it.is_better_than(best))))
            };
            let mut better = along(Effort::QUICK)?;
            if better.is_none() && for_good.is_none() {
                let is_closed = has_no_timing(&movers, path.path());
                refuted += usize::from(is_closed);
                if !is_closed {
                    better = along(Effort::THOROUGH)?;
                }
            }
            found.extend(better);
        }
        // A motion that ends as early as allowed cannot be improved.
        let soonest = demand.until.or(demand.arrival.map(|[begins, _]| begins)).unwrap_or(0.0);
        let is_best = |best: &ScheduledMotion| {
            best.may_stay_forever() && (best.waits.is_empty() || best.duration() <= soonest + TIME_ROUNDING)
        };
        if ways == MAX_PATHS || found.last().is_some_and(is_best) {
            break;
        }
        let Some(next) = around_what_is_met(&around, trajectories, &whole.trajectory) else { break };
        around = next;
        let planner = options.planner.with_gap(options.planner.gap().unwrap_or(PATH_GAP));
        let looser = Options { bounded: false, planner, ..*options };
        let Outcome::Found(other) = solve(&around, &looser, &mut |_| ()).outcome else { break };
        let Ok(other) = certify(scene, other.path().clone()) else { break };
        let whole = options.drive.along(scene, &other, demand.speed)?;
        alternative = Some((other, whole));
    }
    let certified = found.into_iter().rev().find_map(|found| certified_in_time(timed, found, ways));
    Ok(certified.ok_or_else(|| reason(ways, refuted, trajectories.len())))
}

fn reason(ways: usize, refuted: usize, movers: usize) -> String {
    let moves = if movers == 1 { "an obstacle moves".into() } else { format!("{movers} obstacles move") };
    let tried = if ways == 1 { "the one route tried".into() } else { format!("the {ways} routes tried") };
    let known = match refuted {
        _ if refuted == ways => format!("no timing along {tried} avoids the moving obstacles (proven)"),
        0 => format!("no timing that avoids the moving obstacles was found along {tried}"),
        _ => format!(
            "no timing that avoids the moving obstacles was found along {tried}; along {}, none exists (proven)",
            counted(refuted, "route")
        ),
    };
    format!("a path exists past the static obstacles, but {moves}; {known}")
}

/// Certifies a motion for both interpolations that programs use between samples.
fn certified_in_time(timed: TimedScene, found: ScheduledMotion, ways: usize) -> Option<(TimedMotion, Timing)> {
    let ScheduledMotion { timed: TimedMotion { curve, trajectory }, waits, free_until } = found;
    let (mut clearance, mut nearest) = (f64::INFINITY, None);
    // Without rounded corners, both interpolations give the same motion.
    let is_curved = curve.radii().iter().any(|radius| *radius > 0.0);
    for recording in recordings(&trajectory)?.into_iter().take(if is_curved { 2 } else { 1 }) {
        match certify_in_time(timed, &recording, timed.scene.workspace().clearance) {
            CollisionCheck::Free { clearance: proven, nearest: seen } => {
                clearance = clearance.min(proven);
                nearest = seen.map(|seen| Nearest { at: seen.moment.at, contact: seen.contact });
            }
            CollisionCheck::Collision { .. } | CollisionCheck::Undecided(_) => return None,
        }
    }
    let curve = curve.among_movers(clearance, nearest);
    let obstacles = timed.trajectories.len();
    let [clearance, free_until] = [clearance, free_until].map(|value| Some(value).filter(|value| value.is_finite()));
    let figures = Timing { obstacles, ways, waits, clearance, free_until };
    Some((TimedMotion { curve, trajectory }, figures))
}

/// Returns a proven lower bound on the distance between moving obstacles and the arm while it stands at `q` for some
/// seconds, from time 0. `None` if the bound does not exceed the required clearance.
pub fn clearance_at_rest(timed: TimedScene, q: Configuration, seconds: f64) -> Option<f64> {
    let times = if seconds > 0.0 { vec![0.0, seconds] } else { vec![0.0] };
    let (positions, velocities) = (vec![q; times.len()], vec![Configuration::zeros(); times.len()]);
    let standing = Recording::new(positions, Some(times), Some(velocities)).ok()?;
    certify_in_time(timed, &standing, timed.scene.workspace().clearance).clearance()
}

/// Returns a motion as recordings for both interpolations: by cubics, and by the polynomials of the trajectory.
pub fn recordings(trajectory: &Trajectory) -> Option<[Recording; 2]> {
    let rows = |values: &[[f64; 2]]| values.iter().map(|&row| Configuration::from(row)).collect::<Vec<_>>();
    let (position, velocity) = (rows(&trajectory.position), rows(&trajectory.velocity));
    let cubic = Recording::new(position, Some(trajectory.time.clone()), Some(velocity)).ok()?;
    let quartic = cubic.clone().accelerated(rows(&trajectory.acceleration), Interpolation::Quartic).ok()?;
    Some([cubic, quartic])
}

/// Returns the problem with one moving obstacle made static: the first one that the motion meets, at the place where they meet.
fn around_what_is_met(
    problem: &MotionProblem,
    trajectories: &[ObstacleTrajectory],
    trajectory: &Trajectory,
) -> Option<MotionProblem> {
    let scene = problem.scene();
    let [cubic, _] = recordings(trajectory)?;
    let timed = TimedScene { scene, trajectories };
    let met = first_moving_contact(timed, &cubic, scene.workspace().clearance)?;
    let scene = scene.with_static_obstacle(timed.obstacle(met.contact.pair, met.moment.time)?);
    let is_open = |goal: &&Segment| !goal.is_point() || scene.obstructions(goal.ends()[0]).is_empty();
    let goals: GoalSet = problem.goals().pieces().iter().filter(is_open).copied().collect();
    let is_clear = TimedScene { scene: &scene, trajectories }.obstructions(problem.start(), 0.0).is_empty();
    MotionProblem::new(scene, problem.start(), goals).ok().filter(|_| is_clear)
}
