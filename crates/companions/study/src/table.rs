//! The rows of a study as a CSV table.

use super::Study;
use super::row::Row;
use cplan_compare::quoted;

/// Tables in CSV.
impl Study {
    /// Returns the names of the columns: the number of the layout, the parameters, the ending, the reason, the
    /// measures, and whether the layout satisfies all conditions.
    pub fn columns(&self) -> Vec<String> {
        let parameters = self.parameters.iter().map(|parameter| parameter.name.clone());
        let measures = self.measures.iter().map(|measure| measure.name().to_owned());
        let fixed = |name: &str| std::iter::once(name.to_owned());
        fixed("layout")
            .chain(parameters)
            .chain(fixed("outcome"))
            .chain(fixed("reason"))
            .chain(measures)
            .chain(fixed("fits"))
            .collect()
    }

    /// Returns the table as CSV: one line per row, and numbers with all digits.
    pub fn csv(&self, rows: &[Row]) -> String {
        let mut text = self.columns().iter().map(|name| quoted(name)).collect::<Vec<_>>().join(",") + "\n";
        for row in rows {
            text += &row.layout.to_string();
            row.values.iter().for_each(|value| text += &format!(",{value}"));
            text += &format!(",{},{}", row.ending.name(), quoted(row.reason.as_deref().unwrap_or_default()));
            for value in &row.measured {
                text += &value.map_or_else(|| ",".to_owned(), |value| format!(",{value}"));
            }
            text += &format!(",{}\n", row.fits);
        }
        text
    }
}
