//! Laplace's equation: 1 at the goals, 0 on obstacles and beyond limits, periodic on circles.

use super::peeling::Peeling;
use super::{Component, Potential};

/// A harmonic potential: the probability that a random walk from a cell comes to a goal before it comes to a wall. It has
/// no local maximum but the goals (Connolly, Grupen 1993).
#[derive(Debug, Clone)]
pub struct Field {
    /// Its values: the greater, the nearer to a goal in that sense.
    pub potential: Potential,
    /// In how many parts it was solved.
    pub windows: usize,
}

/// Added to a cell's number of neighbours.
pub(super) const LOSS: f64 = f64::EPSILON * 512.0;

/// The harmonic potential on a component.
#[must_use]
pub fn harmonic(component: &Component) -> Field {
    let Peeling { potential, windows, .. } = Peeling::new(component, LOSS).run();
    Field { potential, windows }
}

/// By which part of itself a value differs from what its neighbours ask for, at most.
#[must_use]
pub fn residual(component: &Component, potential: &Potential) -> f64 {
    let mut worst = 0.0_f64;
    for i in component.goals..component.len() {
        let at = potential.at(i);
        let mut sum = -LOSS * at.mantissa;
        for n in component.neighbors[i].map(|n| n as usize) {
            let value = if n == component.wall() { 0.0 } else { potential.at(n).mantissa_at(at.exponent) };
            sum += value - at.mantissa;
        }
        worst = worst.max((sum / (4.0 * at.mantissa)).abs());
    }
    worst
}
