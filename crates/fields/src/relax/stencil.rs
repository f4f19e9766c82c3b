//! What the neighbours of a cell ask for.

use super::{Difference, Domain, Neighbor};

/// The value that a cell should have.
pub(super) trait Stencil {
    /// For the unknown at `position` with the value `own`, from those `around` it in the order `-q1, +q1, -q2, +q2`.
    fn asked(&self, position: usize, own: f64, around: [f64; 4]) -> f64;
}

/// The mean of the four neighbours. With reflecting limits this is not what the equation says: see [`Weighted`].
pub(super) struct Mean;

impl Stencil for Mean {
    fn asked(&self, _: usize, _: f64, [a, b, c, d]: [f64; 4]) -> f64 {
        0.25 * ((a + b) + (c + d))
    }
}

/// A mean with weights of its own at each position, which add up to 1. Where the neighbour is the cell itself the weight
/// is 0 and the others are the greater for it: the equation is solved for the cell's value.
pub(super) struct Weighted(Vec<[f64; 4]>);

impl Weighted {
    /// For a drift at each of the unknowns (indices of cells).
    pub fn new(domain: &Domain, unknowns: &[u32], drift: impl Fn(usize) -> [f64; 2], difference: Difference) -> Self {
        let weights = unknowns.iter().map(|&cell| {
            let weights = weights(domain, cell as usize, drift(cell as usize), difference);
            let sum: f64 = weights.iter().sum();
            weights.map(|weight| weight / sum)
        });
        Self(weights.collect())
    }

    /// Those of the unknown at `position`, in the order of its neighbours.
    pub fn at(&self, position: usize) -> [f64; 4] {
        self.0[position]
    }
}

impl Stencil for Weighted {
    fn asked(&self, position: usize, _: f64, around: [f64; 4]) -> f64 {
        let weights = &self.0[position];
        (weights[0] * around[0] + weights[1] * around[1]) + (weights[2] * around[2] + weights[3] * around[3])
    }
}

/// The weights of a cell's neighbours for a drift: `lap p + <b, grad p>` is the weighted sum of their values, less the sum of the weights
/// times its own.
pub(super) fn weights(domain: &Domain, cell: usize, drift: [f64; 2], difference: Difference) -> [f64; 4] {
    let mut weights = sides(drift, difference);
    for (weight, neighbor) in weights.iter_mut().zip(domain.neighbors(cell)) {
        if neighbor == Neighbor::Mirror {
            *weight = 0.0;
        }
    }
    weights
}

/// The same where no neighbour is the cell itself.
pub(super) fn sides(drift: [f64; 2], difference: Difference) -> [f64; 4] {
    let side = |b: f64| match difference {
        Difference::Central => 1.0 + 0.5 * b,
        Difference::Upwind => 1.0 + b.max(0.0),
    };
    [side(-drift[0]), side(drift[0]), side(-drift[1]), side(drift[1])]
}

/// The altered preferences: `h + strength d`, `strength` being `epsilon / 4` with the sign that the levels ask for. Beyond
/// a reflecting limit there is the cell's own value as it is.
pub(super) struct Altered {
    /// One a position.
    pub strength: Vec<f64>,
}

impl Stencil for Altered {
    fn asked(&self, position: usize, own: f64, around: [f64; 4]) -> f64 {
        let [a, b, c, d] = around;
        let slope = 0.5 * ((b - a).abs() + (d - c).abs());
        Mean.asked(position, own, around) + self.strength[position] * slope
    }
}
