//! Particle swarm optimisation (Kennedy and Eberhart 1995), with the coefficients of Clerc's standard swarm (2006).

use cplan_model::space::SplitMix64;
use std::f64::consts::LN_2;

/// Fraction of its speed that a particle keeps from one generation to the next (Clerc's value).
const SPEED_SHARE: f64 = 0.5 / LN_2;

/// Greatest pull towards a best place, as a multiple of the distance to it (Clerc's value).
const MAX_PULL: f64 = 0.5 + LN_2;

/// Greatest initial speed, as a fraction of the range of a coordinate.
const MAX_FIRST_SPEED: f64 = 0.2;

/// A particle of the swarm, with the best place that it has visited.
struct Particle {
    place: Vec<f64>,
    speed: Vec<f64>,
    best: Vec<f64>,
    least: f64,
}

impl Particle {
    fn new((place, cost): (Vec<f64>, f64), rooms: &[[f64; 2]], numbers: &mut SplitMix64) -> Self {
        let speed = |[lower, upper]: &[f64; 2]| (upper - lower) * MAX_FIRST_SPEED * (2.0 * numbers.unit() - 1.0);
        Self { speed: rooms.iter().map(speed).collect(), best: place.clone(), place, least: cost }
    }

    /// Moves the particle. It keeps a part of its speed, and is pulled at random towards its own best place and the
    /// best place of the whole swarm. It stops at the ends of the ranges `rooms`.
    fn move_on(&mut self, best_of_all: &[f64], rooms: &[[f64; 2]], numbers: &mut SplitMix64) {
        for (k, [lower, upper]) in rooms.iter().enumerate() {
            let place = self.place[k];
            let mut pull = |best: f64| MAX_PULL * numbers.unit() * (best - place);
            self.speed[k] = SPEED_SHARE * self.speed[k] + pull(self.best[k]) + pull(best_of_all[k]);
            let next = place + self.speed[k];
            self.place[k] = next.clamp(*lower, *upper);
            // Clerc's rule: without it, a particle would stay at the end for generations.
            if self.place[k] != next {
                self.speed[k] = 0.0;
            }
        }
    }

    /// Records the current place as the best one if its cost is less than all earlier ones.
    fn learn(&mut self, cost: f64) {
        if cost < self.least {
            self.least = cost;
            self.best.clone_from(&self.place);
        }
    }
}

/// Minimises the cost within the ranges of the coordinates. Each place with a known cost becomes a particle. `costs`
/// evaluates all places of a generation at once. Costs may be infinite.
///
/// # Errors
/// The error of `costs`.
pub(super) fn minimize<E>(
    rooms: &[[f64; 2]],
    known: Vec<(Vec<f64>, f64)>,
    generations: usize,
    numbers: &mut SplitMix64,
    mut costs: impl FnMut(&[Vec<f64>]) -> Result<Vec<f64>, E>,
) -> Result<(), E> {
    let mut particles: Vec<Particle> = known.into_iter().map(|known| Particle::new(known, rooms, numbers)).collect();
    for _ in 0..generations {
        let Some(best) = particles.iter().min_by(|a, b| a.least.total_cmp(&b.least)) else { break };
        let best = best.best.clone();
        particles.iter_mut().for_each(|particle| particle.move_on(&best, rooms, numbers));
        let places: Vec<Vec<f64>> = particles.iter().map(|particle| particle.place.clone()).collect();
        for (particle, cost) in particles.iter_mut().zip(costs(&places)?) {
            particle.learn(cost);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOMS: [[f64; 2]; 3] = [[-2.0, 1.0], [0.0, 5.0], [-1.0, 1.0]];

    /// Returns all places that a swarm of twenty particles tries, in order, and the least cost.
    fn tried_places(seed: u64, cost: impl Fn(&[f64]) -> f64) -> (Vec<Vec<f64>>, f64) {
        let mut numbers = SplitMix64::new(seed);
        let known: Vec<(Vec<f64>, f64)> = (0..20)
            .map(|_| {
                let place: Vec<f64> =
                    ROOMS.iter().map(|[lower, upper]| lower + (upper - lower) * numbers.unit()).collect();
                let cost = cost(&place);
                (place, cost)
            })
            .collect();
        let (mut all, mut least) = (Vec::new(), f64::INFINITY);
        let done = minimize(&ROOMS, known, 60, &mut numbers, |places| {
            all.extend_from_slice(places);
            let costs: Vec<f64> = places.iter().map(|place| cost(place)).collect();
            least = costs.iter().copied().fold(least, f64::min);
            Ok::<_, ()>(costs)
        });
        assert_eq!(done, Ok(()));
        (all, least)
    }

    /// Returns a function of the place: the squared distance to a target, which may lie outside the ranges.
    fn squared_distance(to: [f64; 3]) -> impl Fn(&[f64]) -> f64 {
        move |place| place.iter().zip(to).map(|(x, to)| (x - to).powi(2)).sum()
    }

    #[test]
    fn the_swarm_finds_minima_inside_and_at_the_bounds() {
        for seed in 0..20 {
            let (all, least) = tried_places(seed, squared_distance([0.3, 4.0, -0.5]));
            assert!(least < 1e-6, "seed {seed}: {least}");
            let is_within =
                |place: &Vec<f64>| ROOMS.iter().zip(place).all(|([lower, upper], x)| (*lower..=*upper).contains(x));
            assert!(all.len() == 1200 && all.iter().all(is_within));
            // The place in the ranges that is nearest to the target is (1, 4, -0.5).
            let (_, least) = tried_places(seed, squared_distance([3.0, 4.0, -0.5]));
            assert!((least - 4.0).abs() < 1e-6, "seed {seed}: {least}");
        }
    }

    #[test]
    fn the_swarm_leaves_excluded_regions() {
        // Half of the range has infinite costs.
        let cost =
            |place: &[f64]| if place[0] < -0.5 { f64::INFINITY } else { squared_distance([-0.5, 1.0, 0.0])(place) };
        for seed in 0..20 {
            let (_, least) = tried_places(seed, cost);
            assert!(least < 1e-4, "seed {seed}: {least}");
        }
        assert_eq!(tried_places(0, |_| f64::INFINITY).1, f64::INFINITY);
    }

    #[test]
    fn a_seed_decides_all() {
        let cost = squared_distance([0.3, 4.0, -0.5]);
        assert_eq!(tried_places(7, &cost), tried_places(7, &cost));
        assert_ne!(tried_places(7, &cost), tried_places(8, &cost));
    }

    #[test]
    fn the_swarm_ends_with_the_first_refusal() {
        let mut calls = 0;
        let known = vec![(vec![0.0, 1.0, 0.0], 1.0)];
        let done = minimize(&ROOMS, known, 10, &mut SplitMix64::new(1), |places| {
            calls += 1;
            if calls == 3 { Err("enough") } else { Ok(vec![1.0; places.len()]) }
        });
        assert_eq!((done, calls), (Err("enough"), 3));
    }
}
