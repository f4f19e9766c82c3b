//! Cholesky factorisation within the envelope of a small symmetric matrix, for the coarsest level.

/// The factor `L` of `A = L L^T`. Row `i` of `L` is stored from the first column in which row `i` of `A` has an entry. Entries to
/// the left of it are 0 (Jennings 1966).
#[derive(Debug, Clone)]
pub(super) struct Envelope {
    first: Vec<usize>,
    start: Vec<usize>,
    lower: Vec<f64>,
}

impl Envelope {
    /// Factorises a matrix. `entries` has its lower triangle as `(row, column, value)`, in any order; entries at the same place
    /// are added. Rows without a positive pivot are removed, and their unknowns are 0.
    pub fn new(rows: usize, entries: &[(usize, usize, f64)]) -> Self {
        let mut first: Vec<usize> = (0..rows).collect();
        entries.iter().for_each(|&(i, j, _)| first[i] = first[i].min(j));
        let mut start = vec![0];
        for (i, &first) in first.iter().enumerate() {
            start.push(start[i] + i - first + 1);
        }
        let mut lower = vec![0.0; start[rows]];
        entries.iter().for_each(|&(i, j, value)| lower[start[i] + j - first[i]] += value);
        for i in 0..rows {
            let scale = lower[start[i + 1] - 1];
            for j in first[i]..i {
                let from = first[i].max(first[j]);
                let (a, b) = (&lower[start[i] + from - first[i]..], &lower[start[j] + from - first[j]..]);
                let dot: f64 = a[..j - from].iter().zip(b).map(|(a, b)| a * b).sum();
                lower[start[i] + j - first[i]] = (lower[start[i] + j - first[i]] - dot) * lower[start[j + 1] - 1];
            }
            let squares: f64 = lower[start[i]..start[i + 1] - 1].iter().map(|a| a * a).sum();
            let pivot = scale - squares;
            // The diagonal has the reciprocal of the pivot.
            lower[start[i + 1] - 1] = if pivot > MIN_PIVOT * scale { 1.0 / pivot.sqrt() } else { 0.0 };
        }
        Self { first, start, lower }
    }

    /// Replaces the right-hand side `x` by the solution.
    pub fn solve(&self, x: &mut [f64]) {
        for i in 0..self.first.len() {
            let row = &self.lower[self.start[i]..self.start[i + 1]];
            let (inverse, row) = row.split_last().map_or((0.0, row), |(last, row)| (*last, row));
            let dot: f64 = row.iter().zip(&x[self.first[i]..]).map(|(a, b)| a * b).sum();
            x[i] = (x[i] - dot) * inverse;
        }
        for i in (0..self.first.len()).rev() {
            let row = &self.lower[self.start[i]..self.start[i + 1]];
            let (inverse, row) = row.split_last().map_or((0.0, row), |(last, row)| (*last, row));
            x[i] *= inverse;
            let value = x[i];
            for (x, a) in x[self.first[i]..].iter_mut().zip(row) {
                *x -= a * value;
            }
        }
    }
}

/// Least pivot, as a fraction of the diagonal entry. If a pivot is smaller, the matrix is singular, and the pivot is only a
/// rounding error of the entries, which are in single precision.
const MIN_PIVOT: f64 = 1e-6;
