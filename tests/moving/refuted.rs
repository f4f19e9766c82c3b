//! What is said to be impossible along a path is impossible for brute force, too.

use crate::common::random::{seeds, usual};
use crate::drawn::Moving;
use cplan::space::{Configuration, Path};
use cplan::{Options, Outcome, plan};

/// Places on the path, and seconds between looks.
const PLACES: usize = 100;
const STEP: f64 = 0.02;

#[test]
fn where_no_timing_helps_a_flood_in_place_and_time_does_not_get_through() {
    let (mut refuted, mut unknown) = (0, 0);
    for world in Moving::all(seeds(10)) {
        let plan = plan(&world.asked(), &Options { bounded: false, ..Options::default() }).expect("a plan");
        let Outcome::Unknown(reason) = plan.outcome() else { continue };
        if !reason.contains("obstacle") || !reason.contains("move") {
            continue;
        }
        if !reason.contains("proven: along") {
            unknown += 1;
            continue;
        }
        refuted += 1;
        let standing =
            cplan::plan(&world.standing(), &Options { bounded: false, ..Options::default() }).expect("a plan");
        let Some(trajectory) = standing.trajectory() else { panic!("{}: there was a way", world.name) };
        assert!(trajectory.duration() > 0.0);
        let path = standing.report().path.as_ref().expect("a path");
        let path = Path::new(path.iter().map(|&q| q.into()).collect());
        assert!(!gets_through(&world, &path), "{}: a flood gets through", world.name);
    }
    println!("{refuted} refuted, {unknown} open");
    assert!(!usual() || refuted > 0, "nothing was refuted");
}

/// Whether steps from place to place and from look to look lead along the path, within the joints' speeds.
fn gets_through(world: &Moving, path: &Path) -> bool {
    let at = |k: usize| -> Configuration { path.part(path.length() * k as f64 / PLACES as f64, f64::MAX).start() };
    let speeds = world.problem.scene().arm().joints.each_ref().map(|joint| joint.velocity);
    let places: Vec<Configuration> = (0..=PLACES).map(at).collect();
    let takes =
        |a: Configuration, b: Configuration| (0..2).map(|j| (b - a)[j].abs() / speeds[j]).fold(0.0_f64, f64::max);
    // Those that can be gone on to within a step, by their distance.
    let reach: Vec<usize> = (0..=PLACES)
        .map(|k| (1..=PLACES - k).take_while(|n| takes(places[k], places[k + n]) <= STEP).count())
        .collect();
    // What is kept, so that nothing happens between two looks: as far as anything moves in half a step.
    let apart = STEP / 2.0 * (world.fastest() + world.movers_at(0.0).speed(speeds.into()));
    let mut there = vec![false; PLACES + 1];
    there[0] = true;
    let looks = (world.horizon() / STEP) as usize;
    for look in 1..=looks {
        let time = look as f64 * STEP;
        let mut next = vec![false; PLACES + 1];
        for k in (0..=PLACES).filter(|&k| there[k]) {
            next[k.saturating_sub(reach[k])..=(k + reach[k]).min(PLACES)].fill(true);
        }
        let movers = world.movers_at(time);
        for (k, place) in places.iter().enumerate() {
            next[k] = next[k] && movers.room(*place) > apart;
        }
        if next[PLACES] {
            return true;
        }
        there = next;
    }
    false
}
