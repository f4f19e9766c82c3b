//! Laplace's equation: 1 at the goals, 0 on obstacles and beyond limits, periodic on circles.

use super::peeling::Peeling;
use super::{Component, Potential};
use std::f64::consts::{LN_2, PI};

/// A harmonic potential: the probability that a random walk from a cell comes to a goal before it comes to a wall. It has
/// no local maximum but the goals (Connolly, Grupen 1993).
#[derive(Debug, Clone)]
pub struct Field {
    /// Its values: the greater, the nearer to a goal in that sense.
    pub potential: Potential,
    /// In how many windows it was solved.
    pub windows: usize,
}

/// What is added to a cell's four neighbours: a walk dies with a probability of a quarter of this, 3e-14, at each step. So
/// every value is less than the mean of its neighbours by more than all rounding, and one of them is strictly greater,
/// also where the harmonic function is level: without any walls, or where symmetry makes all four neighbours equal.
/// Values are less than the harmonic function's by that part of themselves for each step that a walk takes to the goal:
/// by less than a millionth for ten million steps.
pub(super) const LOSS: f64 = f64::EPSILON * 512.0;

/// The harmonic potential on a component, in relative precision at any distance: values may be `1e-50000`.
///
/// Solved in windows in order of falling values; narrow ones by elimination without subtractions, wide rooms by
/// multigrid. Each value agrees with its neighbours' mean to 1.5e-14 of itself ([`residual`]), which is less than what
/// walks lose a step: every cell that is no goal has a strictly greater neighbour ([`Potential::navigates`]).
/// Some 300 ns a cell in mazes and corridors; wide rooms cost a few solves by [`Multigrid`](cplan_multigrid::Multigrid).
#[must_use]
pub fn harmonic(component: &Component) -> Field {
    let Peeling { potential, windows, .. } = Peeling::new(component, LOSS).run();
    Field { potential, windows }
}

/// Positions from `from` to a goal by steepest ascent of [`harmonic`], which is solved no farther than that looks: the nearer the goal the
/// less it costs.
#[must_use]
pub fn harmonic_way(component: &Component, from: usize) -> Option<Vec<usize>> {
    Peeling::new(component, LOSS).run_to(from).potential.ascend(component, from)
}

/// A guess at [`harmonic`], in a small part of the time: a positive potential that falls with the steps from the goal, in
/// narrow places faster. For a picture of where the goal can be reached from.
#[must_use]
pub fn rough_harmonic(component: &Component) -> Potential {
    let clearance = component.room().clearance;
    let mut log2 = vec![0.0; component.len()];
    for i in component.goals..component.len() {
        // The neighbours that the wave came to earlier; there is one at least.
        let before = component.neighbors(i).into_iter().filter(|&n| n < i);
        log2[i] = before.map(|n| log2[n]).fold(f64::NEG_INFINITY, f64::max) - decay(clearance[i]) / LN_2;
    }
    Potential::from_log2(&log2)
}

/// Fall of the potential a cell, as a natural logarithm, along the middle of a straight corridor with this clearance:
/// `theta` with `cosh theta = 2 - cos(pi / w)`.
pub(super) fn decay(clearance: u32) -> f64 {
    (2.0 - (PI / (2.0 * f64::from(clearance.max(1)))).cos()).acosh()
}

/// By which part of itself a value differs from what its neighbours ask for, at most.
#[must_use]
pub fn residual(component: &Component, potential: &Potential) -> f64 {
    let mut worst = 0.0_f64;
    for i in component.goals..component.len() {
        let at = potential.at(i);
        let mut sum = -LOSS * at.mantissa;
        for n in component.neighbors(i) {
            let value = if n == component.wall() { 0.0 } else { potential.at(n).mantissa_at(at.exponent) };
            sum += value - at.mantissa;
        }
        worst = worst.max((sum / (4.0 * at.mantissa)).abs());
    }
    worst
}
