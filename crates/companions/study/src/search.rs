//! The search for a better layout by a particle swarm that starts from the best known layouts.

use super::Study;
use super::measure::Objective;
use super::row::Row;
use super::swarm::minimize;
use cplan_model::space::SplitMix64;
use cplan_parallel::run_in_order;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Number of layouts per generation. A search with fewer than ten such generations has smaller ones.
const GENERATION_SIZE: usize = 40;

/// Cost of a layout that has no motion or violates a condition.
const EXCLUDED_COST: f64 = f64::INFINITY;

impl Study {
    /// Returns the cost of a row, where less is better. The cost is infinite for a layout that has no motion or
    /// violates a condition.
    pub fn cost(&self, row: &Row) -> f64 {
        let value = |objective: Objective| Some(objective.cost(row.measured[self.column(objective.measure)?]?));
        self.objective.filter(|_| row.fits).and_then(value).unwrap_or(EXCLUDED_COST)
    }

    /// Searches for a better layout on several threads. `known` has the rows of all listed and drawn layouts, and
    /// `done` those of an interrupted search. Passes the row of each new layout to `each`, in order and only once. No
    /// layout is planned twice. The rows do not depend on the number of threads.
    ///
    /// # Errors
    /// The error of `each`.
    pub fn search<E>(
        &self,
        known: &[Row],
        done: &[Row],
        jobs: usize,
        each: impl FnMut(Row) -> Result<(), E>,
    ) -> Result<(), E> {
        let swarm = (self.searched / 10).clamp(1, GENERATION_SIZE);
        let mut generations = self.searched / swarm;
        if generations == 0 || self.objective.is_none() {
            return Ok(());
        }
        let costs = known.iter().map(|row| (key(&row.values), self.cost(row))).collect();
        let mut landscape = Landscape { study: self, done, jobs, first: known.len(), each, costs, tried: 0 };
        let rooms: Vec<[f64; 2]> = self.parameters.iter().map(|parameter| parameter.values.room()).collect();
        let mut numbers = SplitMix64::nth(self.seed, u64::MAX);
        let mut places = self.best_places(known, swarm);
        if places.len() < swarm {
            // Fill the first generation with random places.
            let mut drawn = || rooms.iter().map(|[lower, upper]| lower + (upper - lower) * numbers.unit()).collect();
            let drawn: Vec<Vec<f64>> = (places.len()..swarm).map(|_| drawn()).collect();
            let costs = landscape.costs(&drawn)?;
            places.extend(drawn.into_iter().zip(costs));
            generations -= 1;
        }
        minimize(&rooms, places, generations, &mut numbers, |places| landscape.costs(places))
    }

    /// Returns the places and costs of at most `most` best rows, the best first.
    fn best_places(&self, known: &[Row], most: usize) -> Vec<(Vec<f64>, f64)> {
        let mut order: Vec<(&Row, f64)> = known.iter().map(|row| (row, self.cost(row))).collect();
        order.sort_by(|(a, a_cost), (b, b_cost)| a_cost.total_cmp(b_cost).then(a.layout.cmp(&b.layout)));
        let place = |row: &Row| {
            let values = self.parameters.iter().zip(&row.values);
            values.map(|(parameter, value)| parameter.values.place(*value)).collect()
        };
        order.into_iter().take(most).map(|(row, cost)| (place(row), cost)).collect()
    }
}

/// The cost of layouts as a function of the place in the search range.
struct Landscape<'a, F> {
    study: &'a Study,
    /// The rows of an earlier search, in order.
    done: &'a [Row],
    jobs: usize,
    /// Number of the first layout of the search.
    first: usize,
    each: F,
    /// Costs of all known layouts. The keys are the bits of the layouts' values.
    costs: HashMap<Vec<u64>, f64>,
    tried: usize,
}

impl<F> Landscape<'_, F> {
    /// Returns the costs of these places. Passes the rows of new layouts to `each`.
    fn costs<E>(&mut self, places: &[Vec<f64>]) -> Result<Vec<f64>, E>
    where
        F: FnMut(Row) -> Result<(), E>,
    {
        let Self { study, done, jobs, first, each, costs, tried } = self;
        let values = |place: &Vec<f64>| -> Vec<f64> {
            study.parameters.iter().zip(place).map(|(parameter, place)| parameter.values.at(*place)).collect()
        };
        let layouts: Vec<Vec<f64>> = places.iter().map(values).collect();
        let mut new: Vec<&Vec<f64>> = Vec::new();
        for values in &layouts {
            // Different places often have the same values, because values are listed, or because places lie beyond a range.
            if let Entry::Vacant(entry) = costs.entry(key(values)) {
                entry.insert(EXCLUDED_COST);
                new.push(values);
            }
        }
        let before = *tried;
        let row = |i: usize| match done.get(before + i).filter(|row| row.values == *new[i]) {
            Some(row) => row.clone(),
            None => study.row_of(*first + before + i, new[i].clone()),
        };
        run_in_order(new.len(), *jobs, row, |row| {
            costs.insert(key(&row.values), study.cost(&row));
            *tried += 1;
            each(row)
        })?;
        Ok(layouts.iter().map(|values| costs.get(&key(values)).copied().unwrap_or(EXCLUDED_COST)).collect())
    }
}

/// Returns the key of a layout's values. Positive and negative zero have the same key.
fn key(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| (value + 0.0).to_bits()).collect()
}
