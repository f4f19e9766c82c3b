//! Stencils: the value that neighbours imply for a cell.

use super::{Difference, Domain, Neighbor};

/// A rule for the value that a cell's neighbours imply for the cell.
pub(super) trait Stencil {
    /// Returns the implied value for the unknown at `position` with the value `own`, from its neighbours in the order
    /// `-q1, +q1, -q2, +q2`.
    fn target(&self, position: usize, own: f64, around: [f64; 4]) -> f64;
}

/// The mean of the four neighbours. At reflecting limits, [`WeightedMean`] is needed instead.
pub(super) struct Mean;

impl Stencil for Mean {
    fn target(&self, _: usize, _: f64, [a, b, c, d]: [f64; 4]) -> f64 {
        0.25 * ((a + b) + (c + d))
    }
}

/// A mean with weights at each position, which add up to 1. A neighbour that is the cell itself has the weight 0, and the others
/// have greater ones, because the equation is solved for the cell's value.
pub(super) struct WeightedMean(Vec<[f64; 4]>);

impl WeightedMean {
    /// Computes the weights for a drift at each of the unknowns (indices of cells).
    pub fn new(domain: &Domain, unknowns: &[u32], drift: impl Fn(usize) -> [f64; 2], difference: Difference) -> Self {
        let weights = unknowns.iter().map(|&cell| {
            let weights = weights(domain, cell as usize, drift(cell as usize), difference);
            let sum: f64 = weights.iter().sum();
            weights.map(|weight| weight / sum)
        });
        Self(weights.collect())
    }

    /// Returns the weights of the unknown at `position`, in the order of its neighbours.
    pub fn at(&self, position: usize) -> [f64; 4] {
        self.0[position]
    }
}

impl Stencil for WeightedMean {
    fn target(&self, position: usize, _: f64, around: [f64; 4]) -> f64 {
        let weights = &self.0[position];
        (weights[0] * around[0] + weights[1] * around[1]) + (weights[2] * around[2] + weights[3] * around[3])
    }
}

/// Returns the weights of a cell's neighbours for a drift. `lap p + <b, grad p>` is the weighted sum of their values, minus the
/// cell's value times the sum of the weights.
pub(super) fn weights(domain: &Domain, cell: usize, drift: [f64; 2], difference: Difference) -> [f64; 4] {
    let mut weights = sides(domain.beta(), drift, difference);
    for (weight, neighbor) in weights.iter_mut().zip(domain.neighbors(cell)) {
        if neighbor == Neighbor::Mirror {
            *weight = 0.0;
        }
    }
    weights
}

/// Does the same as [`weights`] for a cell that is not its own neighbour. Along axis 2, second differences have the
/// factor `beta^2`, and first differences the factor `beta`.
pub(super) fn sides(beta: f64, drift: [f64; 2], difference: Difference) -> [f64; 4] {
    let side = |beta: f64, b: f64| match difference {
        Difference::Central => beta * (beta + 0.5 * b),
        Difference::Upwind => beta * (beta + b.max(0.0)),
    };
    [side(1.0, -drift[0]), side(1.0, drift[0]), side(beta, -drift[1]), side(beta, drift[1])]
}

/// The value `h + strength d` of altered preferences, where `strength` is `epsilon / 4` with the sign that fits the levels.
/// Beyond a reflecting limit, the neighbour has the cell's own value. If cells are not square, `h` is the weighted mean, the
/// slope along axis 2 has the factor `beta`, and `2 + 2 beta^2`, the sum of the weights, replaces 4.
pub(super) struct AlteredMean {
    /// `epsilon / 4` at each position.
    pub strength: Vec<f64>,
    /// Width of a cell along axis 1 divided by its width along axis 2.
    pub beta: f64,
}

impl Stencil for AlteredMean {
    fn target(&self, position: usize, own: f64, around: [f64; 4]) -> f64 {
        let [a, b, c, d] = around;
        if self.beta == 1.0 {
            let slope = 0.5 * ((b - a).abs() + (d - c).abs());
            return Mean.target(position, own, around) + self.strength[position] * slope;
        }
        let (square, sum) = (self.beta * self.beta, 2.0 + 2.0 * self.beta * self.beta);
        let slope = 0.5 * ((b - a).abs() + self.beta * (d - c).abs());
        ((a + b) + square * (c + d) + 4.0 * self.strength[position] * slope) / sum
    }
}
