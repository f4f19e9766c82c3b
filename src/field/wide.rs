//! Wide windows: an iterative solver, refined until every value has its relative precision.

use super::network::SIDES;

/// No unknown.
pub(super) const NONE: u32 = u32::MAX;

/// Relative residual of a value at which it is precise: some roundings of the sum of four neighbours.
const PRECISE: f64 = 16.0 * f64::EPSILON;

/// Unknowns of a window: `(ground + number of neighbours) u = source + sum of the neighbours' u`.
#[derive(Debug, Clone, Default)]
pub(super) struct Wide {
    pub neighbors: Vec<[u32; 4]>,
    pub ground: Vec<f64>,
    pub source: Vec<[f64; SIDES]>,
}

/// Rounds of refinement.
const ROUNDS: usize = 24;

impl Wide {
    pub fn solve(&self, floor: f64) -> Option<Vec<[f64; SIDES]>> {
        let inner = Cholesky::new(self);
        let sides: [Option<Vec<f64>>; SIDES] = std::array::from_fn(|k| self.side(&inner, k, floor));
        let [u, e] = sides;
        Some(u?.into_iter().zip(e?).map(|(u, e)| [u, e + floor]).collect())
    }

    fn side(&self, inner: &Cholesky<'_>, side: usize, floor: f64) -> Option<Vec<f64>> {
        let source: Vec<f64> = self.source.iter().map(|source| source[side]).collect();
        let mut x = vec![0.0; source.len()];
        if source.iter().all(|&s| s == 0.0) {
            return Some(x);
        }
        let mut residual = source.clone();
        for _ in 0..ROUNDS {
            let correction = inner.conjugate_gradients(&residual, 1e-8);
            x.iter_mut().zip(&correction).for_each(|(x, c)| *x += c);
            let mut precise = true;
            for i in 0..x.len() {
                let at = x[i];
                let around = self.neighbors[i].iter().filter(|&&n| n != NONE);
                residual[i] = around.map(|&n| x[n as usize] - at).sum::<f64>() + (source[i] - self.ground[i] * at);
                if residual[i].abs() <= 4.0 * PRECISE * (at + floor) {
                    residual[i] = 0.0;
                } else {
                    precise = false;
                }
            }
            if precise {
                return Some(x);
            }
        }
        None
    }
}

/// Modified incomplete Cholesky factorisation (Gustafsson 1978).
struct Cholesky<'a> {
    system: &'a Wide,
    inverse: Vec<f64>,
}

impl<'a> Cholesky<'a> {
    fn new(system: &'a Wide) -> Self {
        let n = system.ground.len();
        let mut inverse = vec![0.0; n];
        for i in 0..n {
            let mut pivot = system.ground[i];
            for &j in system.neighbors[i].iter().filter(|&&n| n != NONE) {
                pivot += 1.0;
                let j = j as usize;
                if j < i {
                    let others = system.neighbors[j].iter().filter(|&&n| n != NONE && n as usize > j).count() - 1;
                    pivot -= inverse[j] * (1.0 + 0.97 * others as f64);
                }
            }
            inverse[i] = 1.0 / pivot;
        }
        Self { system, inverse }
    }

    fn apply(&self, r: &[f64], z: &mut [f64]) {
        for i in 0..r.len() {
            let before = self.system.neighbors[i].iter().filter(|&&n| (n as usize) < i);
            z[i] = (r[i] + before.map(|&n| z[n as usize]).sum::<f64>()) * self.inverse[i];
        }
        for i in (0..r.len()).rev() {
            let after = self.system.neighbors[i].iter().filter(|&&n| n != NONE && (n as usize) > i);
            z[i] += after.map(|&n| z[n as usize]).sum::<f64>() * self.inverse[i];
        }
    }

    fn conjugate_gradients(&self, b: &[f64], tolerance: f64) -> Vec<f64> {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let n = b.len();
        let (mut x, mut r, mut z, mut q) = (vec![0.0; n], b.to_vec(), vec![0.0; n], vec![0.0; n]);
        self.apply(&r, &mut z);
        let mut p = z.clone();
        let mut rz = dot(&r, &z);
        let end = rz * tolerance * tolerance;
        for _ in 0..1000 {
            for i in 0..n {
                let around = self.system.neighbors[i].iter().filter(|&&n| n != NONE);
                q[i] = around.map(|&n| p[i] - p[n as usize]).sum::<f64>() + self.system.ground[i] * p[i];
            }
            let alpha = rz / dot(&p, &q);
            for i in 0..n {
                x[i] += alpha * p[i];
                r[i] -= alpha * q[i];
            }
            self.apply(&r, &mut z);
            let next = dot(&r, &z);
            if next <= end {
                break;
            }
            let beta = next / rz;
            rz = next;
            for i in 0..n {
                p[i] = z[i] + beta * p[i];
            }
        }
        x
    }
}
