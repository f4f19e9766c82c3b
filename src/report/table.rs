//! Text tables.

use crate::text::plain_line;

/// Side to which a column's cells are moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// To the left side, for words.
    Left,
    /// To the right side, for numbers.
    Right,
}

/// A column's header.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    name: String,
    align: Align,
}

impl Column {
    /// A column of this name.
    pub fn new(name: &str, align: Align) -> Self {
        Self { name: name.to_owned(), align }
    }

    /// What stands above it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// To which side its cells are moved.
    #[must_use]
    pub fn align(&self) -> Align {
        self.align
    }
}

/// Columns and rows of cells; a missing cell is shown as `-`.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// The headers, one for each column.
    pub columns: Vec<Column>,
    /// As many cells as columns each.
    pub rows: Vec<Vec<Option<String>>>,
}

impl Table {
    /// Columns two spaces apart, a rule under the header, no trailing spaces.
    pub fn to_text(&self) -> String {
        let table = self.with_cells(|cell| plain_line(cell).into_owned());
        let widths = table.widths();
        let line = |cells: Vec<String>| format!("{}\n", cells.join("  ").trim_end());
        let mut text = line(table.padded(&table.header(), &widths));
        text += &line(widths.iter().map(|&w| "-".repeat(w)).collect());
        for row in &table.rows {
            text += &line(table.padded(&shown(row), &widths));
        }
        text
    }

    /// The same with other cells.
    fn with_cells(&self, change: impl Fn(&str) -> String) -> Self {
        let row = |row: &Vec<Option<String>>| row.iter().map(|cell| cell.as_deref().map(&change)).collect();
        Self { columns: self.columns.clone(), rows: self.rows.iter().map(row).collect() }
    }

    /// A table of GitHub's Markdown, aligned in the source too.
    pub fn to_markdown(&self) -> String {
        let escaped = self.with_cells(|cell| plain_line(&cell.replace('|', "\\|")).into_owned());
        // A rule needs three characters.
        let widths: Vec<usize> = escaped.widths().into_iter().map(|w| w.max(3)).collect();
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let mut text = line(escaped.padded(&escaped.header(), &widths));
        let rule = |(column, &width): (&Column, &usize)| match column.align {
            Align::Left => "-".repeat(width),
            Align::Right => "-".repeat(width - 1) + ":",
        };
        text += &line(escaped.columns.iter().zip(&widths).map(rule).collect());
        for row in &escaped.rows {
            text += &line(escaped.padded(&shown(row), &widths));
        }
        text
    }

    fn header(&self) -> Vec<&str> {
        self.columns.iter().map(|c| c.name.as_str()).collect()
    }

    fn widths(&self) -> Vec<usize> {
        let width = |s: &str| s.chars().count();
        let of = |(k, column): (usize, &Column)| {
            self.rows.iter().map(|row| width(shown(row)[k])).fold(width(&column.name), usize::max)
        };
        self.columns.iter().enumerate().map(of).collect()
    }

    fn padded(&self, cells: &[&str], widths: &[usize]) -> Vec<String> {
        let pad = |((cell, &width), column): ((&&str, &usize), &Column)| match column.align {
            Align::Left => format!("{cell:<width$}"),
            Align::Right => format!("{cell:>width$}"),
        };
        cells.iter().zip(widths).zip(&self.columns).map(pad).collect()
    }
}

fn shown(row: &[Option<String>]) -> Vec<&str> {
    row.iter().map(|cell| cell.as_deref().unwrap_or("-")).collect()
}

/// A number with so many decimals; none where it is not finite.
pub(super) fn fixed(value: Option<f64>, decimals: usize) -> Option<String> {
    value.filter(|v| v.is_finite()).map(|v| format!("{v:.decimals$}"))
}

/// A text field of a CSV file.
pub(crate) fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}
