//! Checks that every motion found in a random world has a valid certificate.
//!
//! ```sh
//! CPLAN_TIMES=100 cargo test --profile quick --test planning certificates::motions -- --nocapture
//! ```

use super::drawn::{Drawn, Goal};
use super::{ENDS, KINDS};
use cplan::engine::Method;
use cplan::input::Overrides;
use cplan::model::Status;
use cplan::{Options, plan};
use cplan_cases::dice::Dice;
use cplan_cases::{seeds, uses_default_cases};
use cplan_check_files::check;
use cplan_testkit::problems::problem_of_texts;
use std::time::{Duration, Instant};

#[derive(Debug, Default)]
struct Tally {
    found: [usize; KINDS as usize],
    tips: usize,
    /// Number of bounds on the paths to several configurations at once.
    to_tips: usize,
    oblique: usize,
    largest: usize,
    checking: Duration,
    longest: Duration,
}

/// Plans in the world of this seed, and checks the certificates of the motions. The requested path is in turn the
/// shortest one, the first one found, and one far from obstacles.
fn check_motions_in_world(seed: u64, tally: &mut Tally) {
    let mut dice = Dice::new(seed.wrapping_mul(0x9e6c_63d0_876a_1b1d));
    let kind = seed % KINDS;
    let mut drawn = Drawn::new(&mut dice, kind);
    let urdf = drawn.urdf();
    let Some(scene) = drawn.scene() else { return };
    for turn in 0..ENDS {
        let mut free = || drawn.free(&mut dice, &scene, 1e-9 * drawn.scale);
        let (Some(start), Some(goal)) = (free(), free()) else { continue };
        drawn.start = start;
        drawn.goal = if dice.chance(0.7) { Goal::Joints(goal) } else { Goal::Tip(drawn.tip(goal)) };
        let world = drawn.world(true);
        let Ok(problem) = problem_of_texts(&urdf, &world) else { continue };
        let options = [Options::default(), Method::First.into(), Method::Voronoi.into()][turn % 3];
        let answer = plan(&problem, &options).unwrap();
        if answer.status() != Status::Found {
            continue;
        }
        let certificate = answer.certificate(&Overrides::default(), None).unwrap();
        let begun = Instant::now();
        let judged = check(&urdf, &world, &certificate);
        let took = begun.elapsed();
        let Ok(report) = judged else { panic!("seed {seed}, {turn}: {judged:?}\n{urdf}\n{world}") };
        tally.to_tips += usize::from(
            report.contains("to the goal, a position of the tip \"tool\", with clearance")
                && report.contains("is shorter"),
        );
        tally.found[kind as usize] += 1;
        tally.oblique += usize::from(drawn.has_oblique_cylinder());
        tally.tips += usize::from(matches!(drawn.goal, Goal::Tip(_)));
        tally.largest = tally.largest.max(certificate.len());
        tally.checking += took;
        tally.longest = tally.longest.max(took);
    }
}

#[test]
fn certificates_of_random_motions_hold() {
    let mut tally = Tally::default();
    for seed in seeds(40) {
        check_motions_in_world(seed, &mut tally);
    }
    println!("{tally:?}");
    assert!(!uses_default_cases() || tally.found.iter().all(|count| *count > 3) && tally.to_tips > 0, "{tally:?}");
}
