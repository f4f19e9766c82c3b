//! The quadratic model of the cost at a motion, and its least value.

/// A quadratic function. The last unknown borders a banded matrix.
pub(super) struct Model {
    /// Number of entries of a row beside the diagonal.
    width: usize,
    /// For each unknown but the last, the entries of its row: that on the diagonal, and those before it, from there on.
    rows: Vec<f64>,
    /// Entries of the last row, and the last entry.
    border: Vec<f64>,
    corner: f64,
    gradient: Vec<f64>,
    pub last_gradient: f64,
}

/// Returns a barrier at 0 and its derivatives. It is 0 from 1 on, and so is its derivative. `None` beyond the barrier.
pub(super) fn barrier(room: f64) -> Option<[f64; 3]> {
    (room > 0.0).then(|| [room - 1.0 - room.ln(), 1.0 - 1.0 / room, 1.0 / (room * room)])
}

impl Model {
    pub fn new(count: usize, width: usize) -> Self {
        let (rows, border, gradient) = (vec![0.0; count * (width + 1)], vec![0.0; count], vec![0.0; count]);
        Self { width, rows, border, corner: 0.0, gradient, last_gradient: 0.0 }
    }

    /// Adds a term that depends on one quantity. `slope` and `curvature` are its derivatives by the quantity, and `entries` and
    /// `by_last` those of the quantity by the unknowns.
    pub fn add(&mut self, slope: f64, curvature: f64, entries: &[(usize, f64)], by_last: f64) {
        for &(i, a) in entries {
            self.gradient[i] += slope * a;
            self.border[i] += curvature * a * by_last;
            for &(j, b) in entries.iter().filter(|(j, _)| *j <= i) {
                self.rows[i * (self.width + 1) + (i - j)] += curvature * a * b;
            }
        }
        self.corner += curvature * by_last * by_last;
        self.last_gradient += slope * by_last;
    }

    /// Returns the step to the least value of the model, if its diagonal is larger by the share `damping`. `None` if the matrix is
    /// not positive definite.
    pub fn step(&self, damping: f64) -> Option<(Vec<f64>, f64)> {
        let factor = self.factor(damping)?;
        let (y, z) = (self.solve(&factor, &self.gradient), self.solve(&factor, &self.border));
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let rest = self.corner * (1.0 + damping) - dot(&self.border, &z);
        let last = (dot(&self.border, &y) - self.last_gradient) / rest;
        (rest > 0.0).then(|| (y.iter().zip(&z).map(|(y, z)| -y - z * last).collect(), last))
    }

    /// Returns the factor of Cholesky of the banded matrix.
    fn factor(&self, damping: f64) -> Option<Vec<f64>> {
        let w = self.width;
        let mut factor = self.rows.clone();
        for i in 0..self.gradient.len() {
            factor[i * (w + 1)] *= 1.0 + damping;
            let first = i.saturating_sub(w);
            for j in first..=i {
                let from = first.max(j.saturating_sub(w));
                let known = (from..j).map(|k| factor[i * (w + 1) + i - k] * factor[j * (w + 1) + j - k]).sum::<f64>();
                let rest = factor[i * (w + 1) + i - j] - known;
                factor[i * (w + 1) + i - j] = match i == j {
                    true if rest <= 0.0 => return None,
                    true => rest.sqrt(),
                    false => rest / factor[j * (w + 1)],
                };
            }
        }
        Some(factor)
    }

    fn solve(&self, factor: &[f64], right: &[f64]) -> Vec<f64> {
        let (w, mut x) = (self.width, right.to_vec());
        for i in 0..x.len() {
            let known = (i.saturating_sub(w)..i).map(|k| factor[i * (w + 1) + i - k] * x[k]).sum::<f64>();
            x[i] = (x[i] - known) / factor[i * (w + 1)];
        }
        for i in (0..x.len()).rev() {
            x[i] /= factor[i * (w + 1)];
            for k in i.saturating_sub(w)..i {
                x[k] -= factor[i * (w + 1) + i - k] * x[i];
            }
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_cases::dice::Dice;

    #[test]
    fn a_step_ends_where_the_gradient_vanishes() {
        for seed in cplan_cases::seeds(20) {
            let mut dice = Dice::new(seed);
            let (count, width) = (dice.below(12_usize) + 1, dice.below(4_usize));
            let mut model = Model::new(count, width);
            let mut terms = Vec::new();
            for i in 0..3 * count {
                let last = i % count;
                let first = last.saturating_sub(width);
                let entries: Vec<(usize, f64)> = (first..=last).map(|k| (k, dice.within(-1.0, 1.0))).collect();
                terms.push((dice.within(-1.0, 1.0), dice.within(0.1, 1.0), entries, dice.within(-1.0, 1.0)));
            }
            for (slope, curvature, entries, by_last) in &terms {
                model.add(*slope, *curvature, entries, *by_last);
            }
            let Some((step, last)) = model.step(0.0) else { continue };
            let mut gradient = vec![0.0; count + 1];
            for (slope, curvature, entries, by_last) in &terms {
                let quantity = entries.iter().map(|(k, a)| a * step[*k]).sum::<f64>() + by_last * last;
                let slope = slope + curvature * quantity;
                entries.iter().for_each(|(k, a)| gradient[*k] += slope * a);
                gradient[count] += slope * by_last;
            }
            let largest = step.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
            assert!(gradient.iter().all(|g| g.abs() < 1e-6 * largest), "seed {seed}: {gradient:?}");
        }
    }
}
