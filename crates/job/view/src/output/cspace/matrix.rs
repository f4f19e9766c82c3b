//! The values of a grid as a matrix.

use super::FieldGrid;

impl FieldGrid {
    /// Returns the values as lines of text, arranged as in a picture and separated by commas. Joint 1 increases from left to
    /// right, and joint 2 from the last line to the first. Blocked cells have `inf`, and free cells without a value have `nan`.
    pub(super) fn matrix(&self) -> String {
        self.arranged(|cell| match self.values.get(cell) {
            _ if self.blocked[cell] => "inf".to_owned(),
            Some(value) if value.is_finite() => value.to_string(),
            _ => "nan".to_owned(),
        })
    }

    /// Returns the potential in the same arrangement: 0 at goals, 1 at obstacles and in cells from which no goal is reached.
    /// `None` if the values are not logarithms of a potential.
    pub(super) fn potential_matrix(&self) -> Option<String> {
        let is_potential = self.quantity == "ln_potential" && !self.values.is_empty();
        // `exp_m1` keeps the digits of potentials near 0.
        let potential = |cell: usize| if self.blocked[cell] { 1.0 } else { 0.0 - self.values[cell].exp_m1() };
        is_potential.then(|| self.arranged(|cell| potential(cell).to_string()))
    }

    /// Returns the estimates of the search in the same arrangement, with `inf` in blocked cells. `None` if the search has no
    /// estimates.
    pub(super) fn estimate_matrix(&self) -> Option<String> {
        let estimate = |cell: usize| if self.blocked[cell] { f64::INFINITY } else { self.heuristic[cell] };
        (!self.heuristic.is_empty()).then(|| self.arranged(|cell| estimate(cell).to_string()))
    }

    fn arranged(&self, text: impl Fn(usize) -> String) -> String {
        let [columns, rows] = self.shape;
        let line = |row: usize| (0..columns).map(|column| text(column * rows + row)).collect::<Vec<_>>().join(",");
        (0..rows).rev().map(|row| line(row) + "\n").collect()
    }
}
