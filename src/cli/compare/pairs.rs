//! Random start-goal pairs.

use crate::model::Scene;
use crate::space::{Configuration, SplitMix64};

/// Number of draws after which the search for free configurations gives up. It still finds pairs if 1 configuration in
/// 10,000 is free.
const MAX_DRAWS: usize = 200_000;

/// Draws `count` pairs of free configurations. All are independent and uniform over the free part of the joint space
/// (one turn on circles). One sequence of draws gives start, goal, start, goal and so on, joint 1 first. Configurations
/// that are not free are dropped. A configuration is free if it keeps more than the scene's clearance from every
/// obstacle. A smaller count gives the first pairs of a larger one.
///
/// Returns `None` if hardly any configuration is free.
pub fn free_pairs(scene: &Scene, count: usize, seed: u64) -> Option<Vec<[Configuration; 2]>> {
    let mut draws = SplitMix64::new(seed);
    (0..count).map(|_| Some([free(scene, &mut draws)?, free(scene, &mut draws)?])).collect()
}

fn free(scene: &Scene, draws: &mut SplitMix64) -> Option<Configuration> {
    let topology = scene.arm().topology();
    let is_free = |q: &Configuration| scene.clearance(*q) > scene.workspace().clearance;
    (0..MAX_DRAWS).map(|_| draws.configuration(&topology)).find(is_free)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::load_scene;
    use std::path::Path;

    fn scene(robot: &str, world: &str) -> Scene {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let urdf = root.join("robots").join(robot).with_extension("urdf");
        load_scene(&urdf, &root.join("workspaces").join(world).with_extension("toml")).unwrap().scene
    }

    #[test]
    fn pairs_are_free_within_the_limits_and_follow_from_the_seed() {
        let scene = scene("planar_2r", "shelf");
        let pairs = free_pairs(&scene, 40, 3).unwrap();
        for q in pairs.iter().flatten() {
            assert!(scene.arm().topology().contains(*q) && scene.clearance(*q) > 0.0, "{q:?}");
        }
        assert_eq!(free_pairs(&scene, 40, 3).unwrap(), pairs);
        assert_eq!(free_pairs(&scene, 7, 3).unwrap(), pairs[..7]);
        assert_ne!(free_pairs(&scene, 40, 4).unwrap(), pairs);
        assert_ne!(pairs[0][0], pairs[0][1]);
    }

    /// Compares the samples in each quarter of the joint space with its free space, which is counted on a grid. The
    /// fractions agree within five standard deviations.
    #[test]
    fn pairs_are_uniform_over_the_free_space_of_a_torus() {
        let scene = scene("planar_2r_continuous", "torus_open");
        let quarter = |q: &Configuration| usize::from(q[0] > 0.0) + 2 * usize::from(q[1] > 0.0);
        let (mut area, mut all) = ([0.0; 4], 0.0);
        for i in 0..200 {
            for k in 0..200 {
                let at = |i: usize| -std::f64::consts::PI + (i as f64 + 0.5) * std::f64::consts::TAU / 200.0;
                let q = Configuration::new(at(i), at(k));
                if scene.clearance(q) > scene.workspace().clearance {
                    area[quarter(&q)] += 1.0;
                    all += 1.0;
                }
            }
        }
        let pairs = free_pairs(&scene, 2000, 11).unwrap();
        let mut counts = [0.0; 4];
        pairs.iter().flatten().for_each(|q| counts[quarter(q)] += 1.0);
        for (area, count) in area.into_iter().zip(counts) {
            let share: f64 = area / all;
            let deviation = (4000.0 * share * (1.0 - share)).sqrt();
            assert!((count - 4000.0 * share).abs() < 5.0 * deviation + 20.0, "{share} {count}");
        }
    }

    #[test]
    fn a_world_without_room_has_no_pairs() {
        let scene = scene("planar_2r", "shelf").with_clearance(1e3).unwrap();
        assert_eq!(free_pairs(&scene, 1, 1), None);
    }
}
