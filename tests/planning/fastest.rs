//! Motions with limits on jerks, and the fastest ones, in random worlds. The trajectories are compared with brute
//! force.
//!
//! ```sh
//! CPLAN_TIMES=50 cargo test --profile quick --test planning fastest -- --nocapture
//! ```

use cplan::engine::{Method, Motion};
use cplan::model::Status;
use cplan::motion::{BlendReport, Drive, Objective, Trajectory};
use cplan::space::{Configuration, Path};
use cplan::{Options, Plan, Planner, Problem, plan};
use cplan_cases::dice::Dice;
use cplan_cases::{seeds, uses_default_cases};
use cplan_testkit::oracle::Oracle;
use cplan_testkit::world::{KINDS, world};

/// Largest difference between two computations of the same distance, in metres.
const ROUNDING: f64 = 1e-9;

/// Number of parts of each interval between samples at which a motion is checked.
const PARTS: u32 = 8;

/// Returns position, velocity, acceleration and jerk of both joints between two samples: the cubic through positions
/// and velocities, as controllers interpolate.
fn derivatives_between(trajectory: &Trajectory, i: usize, u: f64) -> [[f64; 2]; 4] {
    let h = trajectory.time[i + 1] - trajectory.time[i];
    let t = u * h;
    let of = |k: usize| {
        let ends = |rows: &[[f64; 2]]| [rows[i][k], rows[i + 1][k]];
        let ([a, b], [va, vb]) = (ends(&trajectory.position), ends(&trajectory.velocity));
        let c2 = (3.0 * (b - a) / h - 2.0 * va - vb) / h;
        let c3 = (va + vb - 2.0 * (b - a) / h) / (h * h);
        [a + t * (va + t * (c2 + t * c3)), va + t * (2.0 * c2 + 3.0 * t * c3), 2.0 * c2 + 6.0 * t * c3, 6.0 * c3]
    };
    let [first, second] = [of(0), of(1)];
    [0, 1, 2, 3].map(|order| [first[order], second[order]])
}

/// Checks that the trajectory keeps its limits and its distance, and starts and ends at rest.
fn judge(problem: &Problem, plan: &Plan, jerk: [Option<f64>; 2], what: &str) {
    let trajectory = plan.trajectory().expect("a motion");
    let motion = problem.motion().expect("a single motion");
    let (scene, joints) = (motion.scene(), &motion.scene().arm().joints);
    let n = trajectory.time.len();
    let goals = motion.goals().pieces();
    let end = Configuration::from(trajectory.position[n - 1]);
    let off = |k: usize, at: f64| (end[k] - at + 3.0).rem_euclid(std::f64::consts::TAU) - 3.0;
    let is_goal = goals.iter().any(|goal| {
        (0..2).all(|k| (end[k] - goal.ends()[0][k]).abs() < 1e-9 || off(k, goal.ends()[0][k]).abs() < 1e-9)
    });
    assert!(is_goal, "{what}: ends at {end}");
    assert_eq!(trajectory.velocity[0], [0.0; 2], "{what}");
    assert_eq!(trajectory.velocity[n - 1], [0.0; 2], "{what}");
    let is_smooth = jerk.iter().any(Option::is_some);
    let mut places = vec![motion.start()];
    let mut before = [0.0; 2];
    for i in 0..n.saturating_sub(1) {
        let h = trajectory.time[i + 1] - trajectory.time[i];
        for part in 0..=PARTS {
            let u = f64::from(part) / f64::from(PARTS);
            let [place, speed, pull, rate] = derivatives_between(trajectory, i, u);
            // The effect of rounding of positions on derivatives over the interval.
            let noise = 64.0 * f64::EPSILON * (1.0 + place[0].abs().max(place[1].abs()));
            for (k, joint) in joints.iter().enumerate() {
                assert!(speed[k].abs() <= joint.velocity * (1.0 + 1e-6) + noise / h, "{what}: speed {speed:?} at {i}");
                let pulls = joint.acceleration * (1.0 + 1e-6) + noise / (h * h);
                assert!(pull[k].abs() <= pulls, "{what}: acceleration {pull:?} at {i}");
                let most = jerk[k].unwrap_or(f64::INFINITY) * (1.0 + 1e-6) + noise / (h * h * h);
                assert!(rate[k].abs() <= most, "{what}: jerk {rate:?} at {i}, {h}");
                if part == 0 && jerk[k].is_some() {
                    let jump = (pull[k] - before[k]).abs();
                    assert!(
                        jump <= 1e-6 * joint.acceleration + 4.0 * noise / (h * h),
                        "{what}: a jump of {jump} at {i}"
                    );
                }
            }
            if part == PARTS {
                before = pull;
            }
            places.push(Configuration::from(place));
        }
    }
    assert!(!is_smooth || before.iter().all(|pull| pull.abs() < 1e-3), "{what}: ends with {before:?}");
    let stated = plan.clearance().unwrap_or(f64::INFINITY) - scene.workspace().clearance;
    let found = Oracle::new(scene).violation(&Path::new(places), stated.min(1e9) - ROUNDING, 1e-3);
    assert!(found.is_none(), "{what}: stated {stated}, {found:?}");
}

fn motion(plan: &Plan) -> &Motion {
    plan.motion().unwrap().1.outcome.found().unwrap()
}

#[test]
fn fastest_motions_of_random_worlds_keep_limits_and_clearance() {
    let (mut smooth, mut faster, mut stops, mut gains) = (0, 0, 0, Vec::new());
    for seed in seeds(32) {
        let mut dice = Dice::new(seed ^ 0x51_7e);
        let kind = KINDS[(seed % 4) as usize];
        let Some(problem) = world(kind, 7000 + seed).map(Problem::from) else { continue };
        let plain = plan(&problem, &Options { planner: Planner::named(Method::First), ..Options::default() }).unwrap();
        // A straight path is already the fastest one.
        if plain.status() != Status::Found || plain.waypoints().is_some_and(|path| path.len() < 3) {
            continue;
        }
        let what = format!("{kind} {seed}");
        let plain = plan(&problem, &Options::default()).unwrap();
        judge(&problem, &plain, [None; 2], &what);
        let draw = |dice: &mut Dice| 10_f64.powf(dice.within(0.0, 2.5));
        let jerk = [Some(draw(&mut dice)), dice.chance(0.7).then(|| draw(&mut dice))];
        let drive = Drive { optimize: Objective::Time, ..Drive::default() };
        let along = plan(&problem, &Options { jerk: Some(jerk), ..Options::default() }).unwrap();
        judge(&problem, &along, jerk, &format!("{what}, jerk {jerk:?}"));
        let fastest = plan(&problem, &Options { drive, ..Options::default() }).unwrap();
        judge(&problem, &fastest, [None; 2], &format!("{what}, fastest"));
        let gentle = plan(&problem, &Options { jerk: Some(jerk), drive, ..Options::default() }).unwrap();
        judge(&problem, &gentle, jerk, &format!("{what}, fastest, jerk {jerk:?}"));

        let duration = |plan: &Plan| plan.duration().unwrap();
        let bound = |plan: &Plan| motion(plan).fastest.unwrap().lower_bound;
        // No motion is faster than the lower bound, and limits on jerks never make a motion faster.
        assert!(bound(&fastest) <= duration(&fastest) * (1.0 + 1e-9), "{what}");
        assert!(bound(&fastest) <= duration(&plain).min(duration(&along)).min(duration(&gentle)), "{what}");
        assert!(bound(&gentle) <= duration(&gentle).min(duration(&along)), "{what}");
        assert!(bound(&fastest) <= bound(&gentle) * (1.0 + 1e-6), "{what}");
        assert!(duration(&fastest) <= duration(&plain) * (1.0 + 1e-9), "{what}");
        let drive = Drive { blend: 0.0, ..Drive::default() };
        let stopping = plan(&problem, &Options { jerk: Some(jerk), drive, ..Options::default() }).unwrap();
        assert!(duration(&along) <= duration(&stopping) * (1.0 + 1e-9), "{what}");
        smooth += usize::from(duration(&along) < duration(&stopping));
        faster += usize::from(duration(&fastest) < 0.99 * duration(&plain));
        let corners = along.waypoints().map_or(0, |path| path.len() - 2);
        stops += usize::from(corners > 0 && BlendReport::of(&motion(&along).timed.curve).count == 0);
        gains.push(1.0 - duration(&fastest) / duration(&plain));
    }
    gains.sort_by(f64::total_cmp);
    let median = gains.get(gains.len() / 2).copied().unwrap_or(0.0);
    println!("{} motions, {smooth} faster than with stops, {stops} with stops alone", gains.len());
    println!("{faster} faster by more than a hundredth, by {:.1} % in the median", 100.0 * median);
    assert!(
        !uses_default_cases() || gains.len() > 3 && smooth > 2 && faster > 2 && stops < 3,
        "{smooth} {faster} {stops} of {}",
        gains.len()
    );
}
