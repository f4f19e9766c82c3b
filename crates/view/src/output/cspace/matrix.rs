//! The values of a grid as a matrix.

use super::FieldGrid;

impl FieldGrid {
    /// Returns the values as lines of text, arranged as in a picture and separated by commas. Joint 1 increases from
    /// left to right, and joint 2 from the last line to the first. Blocked cells have `inf`, free ones without a value
    /// `nan`.
    pub(super) fn matrix(&self) -> String {
        let [columns, rows] = self.shape;
        let value = |cell: usize| match self.values.get(cell) {
            _ if self.blocked[cell] => "inf".to_owned(),
            Some(value) if value.is_finite() => value.to_string(),
            _ => "nan".to_owned(),
        };
        let line = |row: usize| (0..columns).map(|column| value(column * rows + row)).collect::<Vec<_>>().join(",");
        (0..rows).rev().map(|row| line(row) + "\n").collect()
    }
}
