//! A search for a better layout: particle swarm optimisation (Kennedy and Eberhart 1995; `argmin`'s) that begins with the best layouts known.

use super::Study;
use super::measure::Objective;
use super::row::Row;
use argmin::core::{CostFunction, Error, Executor};
use argmin::solver::particleswarm::{Particle, ParticleSwarm};
use cplan_core::space::Draws;
use cplan_parallel::in_order;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;
use std::borrow::Borrow;
use std::cell::RefCell;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Layouts of a generation, if the search may try ten times as many.
const SWARM: usize = 40;

/// How fast layouts move at first, as a share of the room.
const SPEED: f64 = 0.2;

/// What a layout costs that does not count.
const NOTHING: f64 = f64::INFINITY;

impl Study {
    /// What a row is worth to the search: less is better; infinite for a layout without a motion, or one that does not meet the conditions.
    #[must_use]
    pub fn cost(&self, row: &Row) -> f64 {
        let value = |objective: Objective| Some(objective.cost(row.measured[self.column(objective.measure)?]?));
        self.objective.filter(|_| row.fits).and_then(value).unwrap_or(NOTHING)
    }

    /// Searches on from `known` rows, those of all layouts of the study, on so many threads, and hands each row to `each`, in order. Rows that
    /// `done` has of an earlier search, which was stopped, are not planned again, and a layout that has a row gets no other one. The same
    /// rows whatever the number of threads.
    ///
    /// # Errors
    /// What `each` refuses with.
    pub fn search<E>(
        &self,
        known: &[Row],
        done: &[Row],
        jobs: usize,
        each: impl FnMut(Row) -> Result<(), E>,
    ) -> Result<(), E> {
        let swarm = (self.searched / 10).clamp(1, SWARM);
        let generations = self.searched / swarm;
        if generations == 0 || self.objective.is_none() {
            return Ok(());
        }
        let rooms: Vec<[f64; 2]> = self.parameters.iter().map(|parameter| parameter.values.room()).collect();
        let [lower, upper] = [0, 1].map(|end| rooms.iter().map(|room| room[end]).collect::<Vec<_>>());
        let state = RefCell::new(State {
            each,
            costs: known.iter().map(|row| (key(&row.values), self.cost(row))).collect(),
            tried: 0,
            refused: None,
        });
        let landscape = Landscape { study: self, done, jobs, first: known.len(), state: &state };
        let solver = ParticleSwarm::<Vec<f64>, f64, _>::new((lower, upper), swarm)
            .with_rng_generator(Xoshiro256PlusPlus::seed_from_u64(self.seed));
        let particles = self.best_particles(known, swarm);
        // A swarm that is drawn takes a generation.
        let generations = generations - usize::from(particles.is_none());
        let executor = Executor::new(landscape, solver).configure(|state| {
            let state = state.max_iters(generations as u64);
            match particles {
                Some(particles) => state.population(particles),
                None => state,
            }
        });
        // It fails where a row is refused, and for nothing else.
        let _ = executor.timer(false).run();
        state.into_inner().refused.map_or(Ok(()), Err)
    }

    /// The best rows as a swarm; none if there are too few.
    fn best_particles(&self, known: &[Row], swarm: usize) -> Option<Vec<Particle<Vec<f64>, f64>>> {
        let mut order: Vec<&Row> = known.iter().collect();
        order.sort_by(|a, b| self.cost(a).total_cmp(&self.cost(b)).then(a.layout.cmp(&b.layout)));
        let mut numbers = Draws::nth(self.seed, u64::MAX);
        let particle = |row: &&Row| {
            let values = self.parameters.iter().map(|parameter| &parameter.values);
            let place = values.clone().zip(&row.values).map(|(values, value)| values.place(*value)).collect();
            let speed = values.map(|values| {
                let [lower, upper] = values.room();
                (upper - lower) * SPEED * (2.0 * numbers.unit() - 1.0)
            });
            Particle::new(place, self.cost(row), speed.collect())
        };
        (order.len() >= swarm).then(|| order[..swarm].iter().map(particle).collect())
    }
}

/// What layouts cost, by their places in the rooms of the parameters.
struct Landscape<'a, F, E> {
    study: &'a Study,
    /// Rows of an earlier search, in order.
    done: &'a [Row],
    jobs: usize,
    /// The number of the first layout that is tried.
    first: usize,
    state: &'a RefCell<State<F, E>>,
}

struct State<F, E> {
    each: F,
    /// Costs of all layouts that have a row, by their values.
    costs: HashMap<Vec<u64>, f64>,
    tried: usize,
    refused: Option<E>,
}

impl<F: FnMut(Row) -> Result<(), E>, E> Landscape<'_, F, E> {
    /// Costs of layouts, whose rows are handed on.
    fn costs(&self, places: &[&Vec<f64>]) -> Result<Vec<f64>, Error> {
        let Self { study, done, jobs, first, state } = self;
        let State { each, costs, tried, refused } = &mut *state.borrow_mut();
        let values = |place: &Vec<f64>| -> Vec<f64> {
            study.parameters.iter().zip(place).map(|(parameter, place)| parameter.values.at(*place)).collect()
        };
        let places: Vec<Vec<f64>> = places.iter().map(|place| values(place)).collect();
        let mut new: Vec<&Vec<f64>> = Vec::new();
        for values in &places {
            // Places of listed values are often the same, and so are those at the ends of ranges.
            if let Entry::Vacant(entry) = costs.entry(key(values)) {
                entry.insert(NOTHING);
                new.push(values);
            }
        }
        let before = *tried;
        let row = |i: usize| {
            let values = new[i].clone();
            match done.get(before + i).filter(|row| row.values == values) {
                Some(row) => row.clone(),
                None => study.row_of(first + before + i, values),
            }
        };
        let handed = in_order(new.len(), *jobs, row, |row| {
            costs.insert(key(&row.values), study.cost(&row));
            *tried += 1;
            each(row)
        });
        handed.map_err(|error| {
            *refused = Some(error);
            Error::msg("a row is refused")
        })?;
        Ok(places.iter().map(|values| costs.get(&key(values)).copied().unwrap_or(NOTHING)).collect())
    }
}

/// Values as a key: those of zero are the same.
fn key(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| (value + 0.0).to_bits()).collect()
}

impl<F: FnMut(Row) -> Result<(), E>, E> CostFunction for Landscape<'_, F, E> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, place: &Vec<f64>) -> Result<f64, Error> {
        Ok(self.costs(&[place])?[0])
    }

    fn bulk_cost<P: Borrow<Vec<f64>>>(&self, places: &[P]) -> Result<Vec<f64>, Error> {
        self.costs(&places.iter().map(Borrow::borrow).collect::<Vec<_>>())
    }
}
