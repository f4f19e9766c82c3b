//! Laplace's equation. The value is 1 at goals, and 0 on obstacles and beyond limits. Circles are periodic.

use super::peeling::Peeling;
use super::{Component, Potential};
use std::f64::consts::{LN_2, PI};

/// A harmonic potential: the probability that a random walk from a cell reaches a goal before a wall. It has no local
/// maximum except the goals (Connolly, Grupen 1993).
#[derive(Debug, Clone)]
pub struct Field {
    /// The values.
    pub potential: Potential,
    /// Number of windows (sets of cells that are solved together) in which the potential was solved.
    pub windows: usize,
}

/// Weight of the value 0 in the mean, in addition to the weights 1 of the four neighbours: at each step, a random walk ends with
/// a quarter of this probability, 3e-14. So every value is less than the mean of its neighbours by more than all rounding errors,
/// and at least one neighbour is strictly greater. This holds even where the harmonic function is level: without walls, or where
/// symmetry makes all four neighbours equal. Each step of a walk lowers the value by a fraction of 3e-14, and ten million steps
/// by less than a millionth.
pub(super) const WALK_LOSS: f64 = f64::EPSILON * 512.0;

/// Computes the harmonic potential on a component with full relative precision at any distance. Values may be as small as
/// `1e-50000`. The potential is solved in windows in order of falling values: narrow windows by elimination without subtractions,
/// wide rooms by multigrid. Each value agrees with the mean of its neighbours to a relative 1.5e-14 ([`residual`]), which is less
/// than the loss per step, so every cell except the goals has a strictly greater neighbour ([`Potential::navigates`]). Takes
/// about 300 ns per cell in mazes and corridors. Wide rooms cost a few solves by [`Multigrid`](cplan_multigrid::Multigrid).
pub fn harmonic(component: &Component) -> Field {
    let Peeling { potential, windows, .. } = Peeling::new(component, WALK_LOSS).run();
    Field { potential, windows }
}

/// Returns the positions from `from` to a goal by steepest ascent of [`harmonic`]. Solves only the part of the potential that the
/// ascent needs, so it is faster near the goal.
pub fn harmonic_path(component: &Component, from: usize) -> Option<Vec<usize>> {
    Peeling::new(component, WALK_LOSS).run_to(from).potential.ascend(component, from)
}

/// Estimates [`harmonic`] in a fraction of the time. The result is positive, and falls with the number of steps from the goal,
/// faster in narrow places. It serves pictures that show from which cells the goal is reachable.
pub fn estimated_harmonic(component: &Component) -> Potential {
    let clearance = component.room().clearance;
    let mut log2 = vec![0.0; component.len()];
    for i in component.goals..component.len() {
        // Neighbours that the wave reached earlier. There is at least one.
        let before = component.neighbors(i).into_iter().filter(|&n| n < i);
        log2[i] = before.map(|n| log2[n]).fold(f64::NEG_INFINITY, f64::max) - decay(clearance[i]) / LN_2;
    }
    Potential::from_log2(&log2)
}

/// Returns the fall of the potential per cell, as a natural logarithm, along the middle of a straight corridor of width `w`:
/// `theta` with `cosh theta = 2 - cos(pi / w)`. `clearance` is half of the width.
pub(super) fn decay(clearance: u32) -> f64 {
    (2.0 - (PI / (2.0 * f64::from(clearance.max(1)))).cos()).acosh()
}

/// Returns the greatest relative difference between a value and the value that its neighbours imply.
pub fn residual(component: &Component, potential: &Potential) -> f64 {
    let mut worst = 0.0_f64;
    for i in component.goals..component.len() {
        let at = potential.at(i);
        let mut sum = -WALK_LOSS * at.mantissa;
        for n in component.neighbors(i) {
            let value = if n == component.wall() { 0.0 } else { potential.at(n).mantissa_at(at.exponent) };
            sum += value - at.mantissa;
        }
        worst = worst.max((sum / (4.0 * at.mantissa)).abs());
    }
    worst
}
