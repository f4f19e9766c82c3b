//! Successive relaxation of Laplace's equation, in relative precision.

use super::potential::{Scaled, is_normal};
use super::{Component, Potential};

/// Positions handled together. With 256, a mantissa in the range of `potential::is_normal` cannot leave the doubles
/// within a chunk: an update at most doubles it and leaves at least an eighth, and `2^(192 + 3 * 256) < 2^1022`.
const CHUNK: usize = 256;

/// The relative change is looked at in every so many-th sweep: it costs a division a cell.
const MEASURED: usize = 4;

/// How a field is relaxed, and when it ends.
#[derive(Debug, Clone, PartialEq)]
pub struct OverRelaxation {
    /// One a position: 1 is Gauss-Seidel; greater is over-relaxation, less than 2.
    pub factors: Vec<f64>,
    /// Ends when no value changes by more than this part of itself in a sweep.
    pub tolerance: f64,
    /// Ends after this many sweeps anyway.
    pub max_sweeps: usize,
}

/// How a relaxation ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Passes over all cells.
    pub sweeps: usize,
    /// Greatest relative change of a value in the last sweep that was measured.
    pub change: f64,
    /// Whether the tolerance was met.
    pub converged: bool,
}

impl OverRelaxation {
    /// Relaxes `potential` towards the mean of its four neighbours, goals fixed, walls 0, in the order of the component.
    ///
    /// Values stay positive. With factor 1 and a start that is nowhere greater than the mean of its neighbours
    /// (subharmonic) no value ever falls, and the field stays subharmonic, so goals remain its only local maxima
    /// wherever it is stopped; both hold in floating point too, since rounding is monotone.
    pub fn run(&self, component: &Component, potential: &mut Potential) -> Progress {
        let mut uniform = vec![false; component.len().div_ceil(CHUNK)];
        let mut progress = Progress { sweeps: 0, change: f64::INFINITY, converged: component.len() == component.goals };
        if progress.converged {
            progress.change = 0.0;
        }
        while !progress.converged && progress.sweeps < self.max_sweeps {
            progress.sweeps += 1;
            if progress.sweeps.is_multiple_of(MEASURED) || progress.sweeps == self.max_sweeps {
                progress.change = sweep::<true>(component, potential, &mut uniform, &self.factors);
                progress.converged = progress.change <= self.tolerance;
            } else {
                sweep::<false>(component, potential, &mut uniform, &self.factors);
            }
        }
        progress
    }
}

/// One pass; the greatest relative change if `MEASURE`. `uniform` tells for which chunks all values and their neighbours
/// are known to share one exponent, cell by cell.
fn sweep<const MEASURE: bool>(
    component: &Component,
    potential: &mut Potential,
    uniform: &mut [bool],
    factors: &[f64],
) -> f64 {
    let mut change = 0.0_f64;
    for chunk in 0..uniform.len() {
        let range = (chunk * CHUNK).max(component.goals)..((chunk + 1) * CHUNK).min(component.len());
        if range.is_empty() {
            continue;
        }
        let moved = if uniform[chunk] {
            let moved = relax_plain::<MEASURE>(&component.neighbors, &mut potential.mantissa, range.clone(), factors);
            if !potential.mantissa[range.clone()].iter().all(|&m| is_normal(m)) {
                for i in range {
                    let value = potential.at(i).normalized();
                    store(component, potential, uniform, i, value);
                }
            }
            moved
        } else {
            relax_scaled(component, potential, uniform, range, factors)
        };
        change = change.max(moved);
    }
    change
}

/// The new value from the old one and the mean of the neighbours. Over-relaxation may shoot below zero in the first
/// sweeps: half the mean is then the better guess, and keeps all values positive.
fn relaxed(old: f64, mean: f64, factor: f64) -> f64 {
    if factor == 1.0 { mean } else { (old + factor * (mean - old)).max(0.5 * mean) }
}

/// A chunk whose values and neighbours share one exponent: plain doubles.
fn relax_plain<const MEASURE: bool>(
    neighbors: &[[u32; 4]],
    value: &mut [f64],
    range: std::ops::Range<usize>,
    factors: &[f64],
) -> f64 {
    let mut change = 0.0_f64;
    for i in range {
        let [a, b, c, d] = neighbors[i].map(|n| value[n as usize]);
        let (old, new) = (value[i], relaxed(value[i], 0.25 * ((a + b) + (c + d)), factors[i]));
        value[i] = new;
        if MEASURE {
            change = change.max((new - old).abs() / new);
        }
    }
    change
}

/// A chunk with various exponents. Finds out whether it is uniform.
fn relax_scaled(
    component: &Component,
    potential: &mut Potential,
    uniform: &mut [bool],
    range: std::ops::Range<usize>,
    factors: &[f64],
) -> f64 {
    let chunk = range.start / CHUNK;
    uniform[chunk] = true;
    let mut same = true;
    let mut change = 0.0_f64;
    for i in range {
        let around = component.neighbors[i].map(|n| potential.at(n as usize));
        let old = potential.at(i);
        // At least one neighbour is no wall: the one from which the wave came.
        let free = around.iter().filter(|value| value.mantissa > 0.0);
        let exponent = free.map(|value| value.exponent).fold(i32::MIN, i32::max);
        let [a, b, c, d] = around.map(|value| if value.mantissa > 0.0 { value.mantissa_at(exponent) } else { 0.0 });
        let before = old.mantissa_at(exponent);
        let mantissa = relaxed(before, 0.25 * ((a + b) + (c + d)), factors[i]);
        change = change.max((mantissa - before).abs() / mantissa);
        let new = Scaled { mantissa, exponent }.keeping(old.exponent);
        same &= around.iter().all(|value| value.mantissa == 0.0 || value.exponent == new.exponent);
        store(component, potential, uniform, i, new);
    }
    uniform[chunk] &= same;
    change
}

/// Writes a value; where the exponent is a new one the chunks around are no longer known to be uniform.
fn store(component: &Component, potential: &mut Potential, uniform: &mut [bool], i: usize, value: Scaled) {
    potential.mantissa[i] = value.mantissa;
    if potential.exponent[i] != value.exponent {
        potential.exponent[i] = value.exponent;
        uniform[i / CHUNK] = false;
        for n in component.neighbors[i].map(|n| n as usize).into_iter().filter(|&n| n < component.len()) {
            uniform[n / CHUNK] = false;
        }
    }
}
