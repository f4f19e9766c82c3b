//! Text tables.

use cplan_text::plain_line;

/// Width of tables in characters, unless the full width is requested.
pub const MAX_TABLE_WIDTH: usize = 80;

/// Side at which the text of a column's cells begins or ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// Left-aligned, for words.
    Left,
    /// Right-aligned, for numbers.
    Right,
}

/// A column's header.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    name: String,
    align: Align,
    /// Indices of the rows that have the best value of this column, which stands out.
    best: Vec<usize>,
}

impl Column {
    /// Creates a column with a name.
    pub fn new(name: &str, align: Align) -> Self {
        Self { name: name.to_owned(), align, best: Vec::new() }
    }

    /// Returns this column with the indices of the rows that have its best value.
    #[must_use]
    pub fn with_best(self, best: Vec<usize>) -> Self {
        Self { best, ..self }
    }

    /// Returns the name of the column.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the alignment of the column.
    pub fn align(&self) -> Align {
        self.align
    }
}

/// The texts before and after the best value of each column.
pub type Emphasis<'a> = [&'a str; 2];

/// The emphasis of plain text.
pub const PLAIN: Emphasis = ["", ""];

/// Columns and rows of cells; a missing cell is shown as `-`.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// The headers, one for each column.
    pub columns: Vec<Column>,
    /// Rows with one cell per column.
    pub rows: Vec<Vec<Option<String>>>,
}

impl Table {
    /// Returns the table as aligned text. The text ends in a newline. Control characters in cells are escaped.
    pub fn to_text(&self) -> String {
        self.to_text_within(usize::MAX, PLAIN)
    }

    /// Returns the table as aligned text of at most this width, with an emphasis, which takes no room, on the best values. If the
    /// table is too wide, its headings have two lines. If that does not suffice, the table is split, and each part begins with
    /// the first column.
    pub fn to_text_within(&self, width: usize, emphasis: Emphasis) -> String {
        let table = self.with_cells(|cell| plain_line(cell).into_owned());
        let whole = |emphasis| table.text_under(&[table.header()], emphasis);
        if table.columns.len() < 2 || whole(PLAIN).lines().all(|line| line.chars().count() <= width) {
            return whole(emphasis);
        }
        let broken = |k: usize| {
            let name = table.columns[k].name.as_str();
            let is_widest = table.rows.iter().all(|row| shown_cells(row)[k].chars().count() < name.chars().count());
            name.rsplit_once(' ').filter(|_| is_widest).unwrap_or((name, ""))
        };
        let (upper, lower): (Vec<&str>, Vec<&str>) = (0..table.columns.len()).map(broken).unzip();
        let widths = table.widths(&[upper.clone(), lower.clone()]);
        let mut parts: Vec<Vec<usize>> = Vec::new();
        for k in 1..widths.len() {
            let fits = |part: &&mut Vec<usize>| {
                let whole = part.iter().map(|&k| widths[k] + 2).sum::<usize>() + widths[k];
                whole <= width
            };
            match parts.last_mut().filter(fits) {
                Some(part) => part.push(k),
                None => parts.push(vec![0, k]),
            }
        }
        let part = |part: Vec<usize>| {
            let heads = [&upper, &lower].map(|head| part.iter().map(|&k| head[k]).collect::<Vec<_>>());
            let heads = if heads[1].iter().all(|head| head.is_empty()) { &heads[..1] } else { &heads[..] };
            table.of_columns(&part).text_under(heads, emphasis)
        };
        parts.into_iter().map(part).collect::<Vec<_>>().join("\n")
    }

    /// Returns a table with only these columns.
    pub(super) fn of_columns(&self, columns: &[usize]) -> Self {
        let row = |row: &Vec<Option<String>>| columns.iter().map(|&k| row[k].clone()).collect();
        Self {
            columns: columns.iter().map(|&k| self.columns[k].clone()).collect(),
            rows: self.rows.iter().map(row).collect(),
        }
    }

    fn text_under(&self, heads: &[Vec<&str>], [before, after]: Emphasis) -> String {
        let widths = self.widths(heads);
        let line = |cells: Vec<String>| format!("{}\n", cells.join("  ").trim_end());
        let mut text: String = heads.iter().map(|head| line(self.padded(head, &widths))).collect();
        text += &line(widths.iter().map(|&w| "-".repeat(w)).collect());
        for (number, row) in self.rows.iter().enumerate() {
            let mut cells = self.padded(&shown_cells(row), &widths);
            for (cell, _) in cells.iter_mut().zip(&self.columns).filter(|(_, column)| column.best.contains(&number)) {
                let value = cell.trim();
                *cell = cell.replacen(value, &format!("{before}{value}{after}"), 1);
            }
            text += &line(cells);
        }
        text
    }

    /// Replaces each cell by the result of `change`.
    fn with_cells(&self, change: impl Fn(&str) -> String) -> Self {
        let row = |row: &Vec<Option<String>>| row.iter().map(|cell| cell.as_deref().map(&change)).collect();
        Self { columns: self.columns.clone(), rows: self.rows.iter().map(row).collect() }
    }

    /// Returns a table in GitHub's Markdown, with columns that are aligned in the source, too. The best values are bold.
    pub fn to_markdown(&self) -> String {
        let escaped = self.with_cells(|cell| plain_line(&cell.replace('|', "\\|").replace('<', "&lt;")).into_owned());
        let escaped = escaped.with_bold_best_cells();
        // A rule has at least three characters.
        let widths: Vec<usize> = escaped.widths(&[escaped.header()]).into_iter().map(|w| w.max(3)).collect();
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let mut text = line(escaped.padded(&escaped.header(), &widths));
        let rule = |(column, &width): (&Column, &usize)| match column.align {
            Align::Left => "-".repeat(width),
            Align::Right => "-".repeat(width - 1) + ":",
        };
        text += &line(escaped.columns.iter().zip(&widths).map(rule).collect());
        for row in &escaped.rows {
            text += &line(escaped.padded(&shown_cells(row), &widths));
        }
        text
    }

    /// Returns the table with asterisks around the best values.
    fn with_bold_best_cells(mut self) -> Self {
        for (number, row) in self.rows.iter_mut().enumerate() {
            let best = row.iter_mut().zip(&self.columns).filter(|(_, column)| column.best.contains(&number));
            best.filter_map(|(cell, _)| cell.as_mut()).for_each(|cell| *cell = format!("**{cell}**"));
        }
        self
    }

    fn header(&self) -> Vec<&str> {
        self.columns.iter().map(|c| c.name.as_str()).collect()
    }

    fn widths(&self, heads: &[Vec<&str>]) -> Vec<usize> {
        let of = |k: usize| {
            let cells = self.rows.iter().map(|row| shown_cells(row)[k]).chain(heads.iter().map(|head| head[k]));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        (0..self.columns.len()).map(of).collect()
    }

    fn padded(&self, cells: &[&str], widths: &[usize]) -> Vec<String> {
        let pad = |((cell, &width), column): ((&&str, &usize), &Column)| match column.align {
            Align::Left => format!("{cell:<width$}"),
            Align::Right => format!("{cell:>width$}"),
        };
        cells.iter().zip(widths).zip(&self.columns).map(pad).collect()
    }
}

fn shown_cells(row: &[Option<String>]) -> Vec<&str> {
    row.iter().map(|cell| cell.as_deref().unwrap_or("-")).collect()
}

/// Formats a number with fixed decimals. `None` if it is not finite.
pub(super) fn fixed(value: Option<f64>, decimals: usize) -> Option<String> {
    value.filter(|v| v.is_finite()).map(|v| format!("{v:.decimals$}"))
}

/// Quotes a text field of a CSV file.
pub fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(names: &[&str]) -> Table {
        let columns = names.iter().enumerate();
        let columns = columns.map(|(k, name)| Column::new(name, if k == 0 { Align::Left } else { Align::Right }));
        let row = |name: &str| std::iter::once(name.to_owned()).chain(names[1..].iter().map(|_| "1.25".to_owned()));
        let rows = ["a", "second"].map(|name| row(name).map(Some).collect());
        Table { columns: columns.collect(), rows: rows.into() }
    }

    #[test]
    fn wide_tables_are_split() {
        let table = table(&["planner", "length [rad]", "total [ms]"]);
        assert_eq!(table.to_text_within(33, PLAIN), table.to_text());
        let folded = "planner  length  total\n          [rad]   [ms]\n-------  ------  -----\na          1.25   1.25\nsecond     1.25   1.25\n";
        assert_eq!(table.to_text_within(32, PLAIN), folded);
        let parts = table.to_text_within(20, PLAIN);
        assert_eq!(parts.lines().filter(|line| line.starts_with("planner")).count(), 2, "{parts}");
        assert!(parts.lines().all(|line| line.chars().count() <= 20), "{parts}");
    }

    #[test]
    fn the_best_values_stand_out_and_keep_the_columns() {
        let mut table = table(&["planner", "total"]);
        table.columns[1] = table.columns[1].clone().with_best(vec![1]);
        let [plain, marked] = [PLAIN, ["<", ">"]].map(|emphasis| table.to_text_within(30, emphasis));
        assert!(marked.ends_with("second    <1.25>\n") && marked.contains("a         1.25\n"), "{marked}");
        assert_eq!(marked.replace(['<', '>'], ""), plain);
        assert!(table.to_markdown().ends_with("| second  | **1.25** |\n"), "{}", table.to_markdown());
    }

    #[test]
    fn too_wide_cells_are_shown_whole() {
        let table = table(&["planner", "a value"]);
        assert!(table.to_text_within(3, PLAIN).contains("second"));
        let alone =
            Table { columns: vec![Column::new("planner", Align::Left)], rows: vec![vec![Some("a planner".into())]] };
        assert_eq!(alone.to_text_within(3, PLAIN), alone.to_text());
    }
}
