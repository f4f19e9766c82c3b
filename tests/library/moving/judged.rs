//! Verification of recordings among moving obstacles, against checks at single moments.

use cplan::check::{CollisionCheck, check_collision};
use cplan::space::{Configuration, Recording};
use cplan::{Options, plan};
use cplan_cases::{seeds, uses_default_cases};
use cplan_testkit::moving::Moving;

const LOOKS: usize = 400;

#[test]
fn motions_planned_without_moving_obstacles_are_judged() {
    let (mut free, mut hit) = (0, 0);
    for world in Moving::all(seeds(6)) {
        let standing =
            plan(&world.static_problem(), &Options { bounded: false, ..Options::default() }).expect("a plan");
        let Some(trajectory) = standing.trajectory() else { continue };
        let rows = |values: &[[f64; 2]]| values.iter().map(|&row| Configuration::from(row)).collect::<Vec<_>>();
        // The times do not begin at 0. The trajectories of obstacles begin with the recording.
        let time = trajectory.time.iter().map(|time| 100.0 + time).collect();
        let recording = Recording::new(rows(&trajectory.position), Some(time), Some(rows(&trajectory.velocity)));
        let recording = recording.expect("a recording");
        let problem = world.problem();
        let scene = problem.scene();
        let pieces = recording.pieces();
        let least = (0..LOOKS).map(|look| {
            let at = look as f64 / LOOKS as f64 * pieces.len() as f64;
            let (piece, share) = (&pieces[at as usize], at.fract());
            world.room(piece.at(share), piece.time(share) - 100.0)
        });
        let least = least.fold(f64::INFINITY, f64::min);
        match check_collision(problem.timed(), &recording, scene.workspace().clearance) {
            CollisionCheck::Free { clearance, .. } => {
                free += 1;
                let proven = clearance - scene.workspace().clearance;
                assert!(least >= proven - 1e-9, "{}: {least} m seen, {proven} proven", world.name);
            }
            CollisionCheck::Collision { first, .. } => {
                hit += 1;
                let room = world.room(first.moment.at, first.moment.time - 100.0);
                assert!(room < 1e-9, "{}: {room} m at the first contact", world.name);
            }
            CollisionCheck::Undecided(at) => {
                assert!(least < 1e-3, "{}: undecided at {at:?}, least seen {least}", world.name);
            }
        }
    }
    println!("{free} free, {hit} hit");
    assert!(!uses_default_cases() || (free > 5 && hit > 5), "{free} free, {hit} hit");
}
