//! Laplace's equation: 1 at the goals, 0 on obstacles and beyond limits, periodic on circles.

use super::{Component, OverRelaxation, Potential, Progress, Room};
use std::f64::consts::{LN_2, PI};

/// A harmonic potential: the probability that a random walk from a cell comes to a goal before it comes to a wall. It has
/// no local maximum but the goals (Connolly, Grupen 1993).
#[derive(Debug, Clone)]
pub struct Field {
    /// Its values: the greater, the nearer to a goal in that sense.
    pub potential: Potential,
    /// How far it was relaxed. All sweeps are counted, also those of an attempt that was given up.
    pub progress: Progress,
}

/// The harmonic potential on a component, relaxed by over-relaxation in the order of the wave; `factor: None` takes a
/// good one for each room and corridor.
///
/// Guarantee: every cell that is no goal has a strictly greater neighbour, however early the relaxation ended: this is
/// checked, and a field that fails (over-relaxed and far from converged) is replaced by one relaxed with factor 1 from a
/// subharmonic start, where it holds at any time; `progress.converged` is then false. (A torus without walls is such a
/// case: there the only harmonic function is constant.) Costs some nanoseconds a cell and
/// sweep; the sweeps needed grow like the width of the widest room in cells.
#[must_use]
pub fn harmonic(component: &Component, factor: Option<f64>, tolerance: f64, max_sweeps: usize) -> Field {
    let room = component.room();
    let factors = match factor {
        Some(factor) => vec![factor; component.len()],
        None => room.widest.iter().map(|&widest| over_relaxation(widest)).collect(),
    };
    let mut potential = Potential::from_log2(&decay_guess(component, &room));
    let mut progress = OverRelaxation { factors, tolerance, max_sweeps }.run(component, &mut potential);
    for limit in CAUTIOUS_SWEEPS {
        if potential.navigates(component) {
            break;
        }
        potential = Potential::from_log2(&subharmonic_guess(component));
        let cautious = OverRelaxation { factors: vec![1.0; component.len()], tolerance: 0.0, max_sweeps: limit };
        let again = cautious.run(component, &mut potential);
        progress = Progress { sweeps: progress.sweeps + again.sweeps, change: again.change, converged: false };
    }
    Field { potential, progress }
}

/// The guess that [`harmonic`] starts from: a positive potential that falls with the steps from the goal and faster in
/// narrow places. For a picture of where the goal can be reached from.
#[must_use]
pub fn rough_harmonic(component: &Component) -> Potential {
    Potential::from_log2(&decay_guess(component, &component.room()))
}

/// Sweeps spent on the field that navigates at any time: enough to smooth it, not to converge it. Without walls it tends
/// to a constant and would be flat up to rounding on a small grid: then the start itself, which navigates as it is.
const CAUTIOUS_SWEEPS: [usize; 2] = [64, 0];

/// A factor near the best one for a room of this greatest clearance.
///
/// The best factor is `2 / (1 + sqrt(1 - rho^2))` (Young 1954), `rho` the spectral radius of Jacobi's iteration:
/// `cos(pi / w)` in a square room of `w - 1` cells, `(1 + cos(pi / w)) / 2` in a long one. A factor somewhat too great
/// costs little, one too small a lot, hence the long room. One factor for all would be wrong: over-relaxation amplifies
/// relative errors by up to `f / (2 - f)` for each cell of a narrow corridor, where the potential falls fast, so that the
/// factor of a wide room needs tens of thousands of sweeps to get through one (measured), or never does.
fn over_relaxation(widest: u32) -> f64 {
    let width = 2.0 * f64::from(widest);
    let rho = 0.5 * (1.0 + (PI / width).cos());
    2.0 / (1.0 + (1.0 - rho * rho).sqrt())
}

/// Binary logarithms of a first guess: along the wave, the decay that the potential has in a straight corridor as wide as
/// the place is clear: `theta` a cell with `cosh theta = 2 - cos(pi / w)`.
fn decay_guess(component: &Component, room: &Room) -> Vec<f64> {
    let clearance = &room.clearance;
    let widest = clearance.iter().copied().max().unwrap_or(0);
    let decay: Vec<f64> =
        (0..=widest).map(|clearance| (2.0 - (PI / (2.0 * f64::from(clearance.max(1)))).cos()).acosh() / LN_2).collect();
    let mut log2 = vec![0.0; component.len()];
    for i in component.goals..component.len() {
        // The neighbours that the wave came to earlier; there is one at least.
        let before = component.neighbors[i].iter().map(|&n| n as usize).filter(|&n| n < i);
        log2[i] = before.map(|n| log2[n]).fold(f64::NEG_INFINITY, f64::max) - decay[clearance[i] as usize];
    }
    log2
}

/// Binary logarithms of `4^-steps`: subharmonic, since one neighbour alone has four times the value.
fn subharmonic_guess(component: &Component) -> Vec<f64> {
    let mut log2 = vec![0.0; component.len()];
    for i in component.goals..component.len() {
        let before = component.neighbors[i].iter().map(|&n| n as usize).filter(|&n| n < i);
        log2[i] = before.map(|n| log2[n]).fold(f64::NEG_INFINITY, f64::max) - 2.0;
    }
    log2
}
