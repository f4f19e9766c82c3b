//! Sortable tables of planners, with bars.

use super::markup::number;
use cplan_text::markup;
use cplan_theme::PlannerPen;

use crate::Better;

/// A column of numbers.
pub struct RankedColumn {
    /// Text above the column.
    pub heading: String,
    /// Explanation of the column.
    pub hint: &'static str,
    /// The direction in which values are better.
    pub better: Better,
    /// Value at which a bar has no length.
    pub origin: f64,
    /// One value per row.
    pub values: Vec<Option<f64>>,
    /// The text of each value.
    pub shown: Vec<Option<String>>,
}

impl RankedColumn {
    /// Creates a column whose bars begin at zero.
    pub fn new(
        heading: &str,
        hint: &'static str,
        better: Better,
        values: Vec<Option<f64>>,
        show: impl Fn(f64) -> String,
    ) -> Self {
        let shown = values.iter().map(|value| value.map(&show)).collect();
        Self { heading: heading.to_owned(), hint, better, origin: 0.0, values, shown }
    }

    /// Makes the bars begin at another value.
    pub fn measured_from(self, origin: f64) -> Self {
        Self { origin, ..self }
    }

    /// Returns the rows with the best value. Rows for which `is_ranked` is false cannot be the best.
    fn best(&self, is_ranked: &[bool]) -> Vec<usize> {
        let of = |(value, ranked): (&Option<f64>, &bool)| value.filter(|_| *ranked);
        self.better.that_stand_out(&self.values.iter().zip(is_ranked).map(of).collect::<Vec<_>>(), &self.shown)
    }

    /// Returns the length of a bar as a fraction of the longest one. An infinite value has the whole length.
    fn share(&self, value: f64) -> f64 {
        let finite = self.values.iter().flatten().filter(|value| value.is_finite());
        let longest = finite.map(|value| value - self.origin).fold(0.0, f64::max);
        let share = if longest > 0.0 { (value - self.origin) / longest } else { 0.0 };
        share.clamp(0.0, 1.0)
    }
}

/// The first cells of a row, which name the planner and its outcome.
pub struct RankedRow {
    /// Name with all options.
    pub name: String,
    /// Name without options that all rows share.
    pub label: String,
    /// Colour and dashes of the planner.
    pub pen: PlannerPen,
    /// Index of the path in the pictures. `None` without a path.
    pub path: Option<usize>,
    /// A small picture, as markup.
    pub picture: String,
    /// The cell after the name: its sort key and its markup.
    pub outcome: (f64, String),
    /// Description of the row's path.
    pub description: String,
    /// False if no value of this row can be the best.
    pub is_ranked: bool,
}

/// Writes the table. A script makes it sortable by its column heads.
pub fn table(caption: &str, outcome_heading: &str, rows: &[RankedRow], columns: &[RankedColumn]) -> String {
    let is_ranked: Vec<bool> = rows.iter().map(|row| row.is_ranked).collect();
    let best: Vec<Vec<usize>> = columns.iter().map(|column| column.best(&is_ranked)).collect();
    let direction = |better| if better == Better::Less { "ascending" } else { "descending" };
    let mut html = format!(
        "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\"><table class=\"ranking\">\n<thead><tr>\
         <th scope=\"col\" data-first=\"ascending\">planner</th><th scope=\"col\" data-first=\"ascending\">{1}</th>",
        markup(caption),
        markup(outcome_heading)
    );
    for column in columns {
        let (first, hint, heading) = (direction(column.better), markup(column.hint), markup(&column.heading));
        html += &format!("<th scope=\"col\" class=\"r\" data-first=\"{first}\" title=\"{hint}\">{heading}</th>");
    }
    html += "</tr></thead>\n<tbody>\n";
    for (number_of, row) in rows.iter().enumerate() {
        let path = row.path.map_or_else(String::new, |path| format!(" data-path=\"{path}\""));
        html += &format!(
            "<tr{path} data-planner=\"{}\" data-description=\"{}\" style=\"--pen: var(--{})\"><th scope=\"row\" title=\"{}\"><span \
             class=\"who\">{}<span class=\"name\">{}</span>{}</span></th><td data-value=\"{}\">{}</td>",
            markup(&row.name),
            markup(&row.description),
            row.pen.name(),
            markup(&row.name),
            row.picture,
            markup(&row.label),
            line_sample(row.pen),
            row.outcome.0,
            row.outcome.1
        );
        for (column, best) in columns.iter().zip(&best) {
            html += &cell(column, number_of, best.contains(&number_of));
        }
        html += "</tr>\n";
    }
    html + "</tbody>\n</table></div>\n"
        + &format!(
            "<p class=\"sub table-key\">{BEST_SIGN} and bold: best value; bars: share of the column\u{2019}s greatest.</p>\n"
        )
}

fn cell(column: &RankedColumn, row: usize, is_best: bool) -> String {
    let (Some(value), Some(shown)) = (column.values[row], &column.shown[row]) else {
        return "<td class=\"r\">\u{2013}</td>".to_owned();
    };
    let class = if is_best { "r best" } else { "r" };
    let mark = if is_best { BEST_MARK } else { "" };
    let key = if value.is_finite() { value.to_string() } else { f64::MAX.to_string() };
    format!(
        "<td class=\"{class}\" data-value=\"{key}\">{mark}{}<span class=\"bar\"><i style=\"width: {}%\"></i></span></td>",
        markup(shown),
        number(100.0 * column.share(value))
    )
}

/// The sign beside the best value of a column.
const BEST_MARK: &str = "<svg class=\"star\" viewBox=\"0 0 10 10\" role=\"img\" aria-label=\"best\"><path d=\"M5 .4 6.5 3.5 9.8 \
                         3.9 7.4 6.2 8 9.6 5 8 2 9.6 2.6 6.2 .2 3.9 3.5 3.5Z\"/></svg>";

/// The star in the explanation below the table.
const BEST_SIGN: &str = "<svg class=\"star\" viewBox=\"0 0 10 10\" role=\"img\" aria-label=\"Star\"><path d=\"M5 .4 6.5 3.5 9.8 \
                         3.9 7.4 6.2 8 9.6 5 8 2 9.6 2.6 6.2 .2 3.9 3.5 3.5Z\"/></svg>";

/// Draws a piece of a planner's line.
pub fn line_sample(pen: PlannerPen) -> String {
    let dash: Vec<String> = pen.dash.iter().map(|length| number(*length)).collect();
    let dash = if dash.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{}\"", dash.join(" ")) };
    format!(
        "<svg class=\"line\" viewBox=\"0 0 34 8\" aria-hidden=\"true\"><path d=\"M1 4H33\" fill=\"none\" stroke=\"var(--{})\" \
         stroke-width=\"2.6\"{dash}/></svg>",
        pen.name()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_theme::PlannerFamily;

    fn row(name: &str, is_ranked: bool) -> RankedRow {
        RankedRow {
            name: name.to_owned(),
            label: name.to_owned(),
            pen: PlannerPen::new(PlannerFamily::Field, 0),
            path: Some(0),
            picture: String::new(),
            outcome: (0.0, "found".to_owned()),
            description: String::new(),
            is_ranked,
        }
    }

    #[test]
    fn bars_and_the_best_follow_the_values() {
        let values = vec![Some(4.0), Some(2.0), Some(1.0), None];
        let column = RankedColumn::new("time", "", Better::Less, values, |v| format!("{v} s"));
        let rows = [row("<a>", true), row("b", true), row("c", false), row("d", true)];
        let html = table("t", "outcome", &rows, &[column]);
        let html = format!("<div>{html}</div>");
        let document = roxmltree::Document::parse(&html).unwrap();
        let best: Vec<_> = document.descendants().filter(|node| node.attribute("class") == Some("r best")).collect();
        assert_eq!(best.len(), 1);
        assert_eq!(best[0].attribute("data-value"), Some("2"), "a row that is not ranked cannot be the best");
        let bars: Vec<_> =
            document.descendants().filter_map(|node| node.attribute("style")?.strip_prefix("width: ")).collect();
        assert_eq!(bars, ["100%", "50%", "25%"]);
    }

    #[test]
    fn bars_may_begin_at_another_value() {
        let column = RankedColumn::new("x", "", Better::Less, vec![Some(1.0), Some(1.5), Some(f64::INFINITY)], |v| {
            v.to_string()
        });
        let column = column.measured_from(1.0);
        assert_eq!([1.0, 1.25, 1.5, f64::INFINITY].map(|value| column.share(value)), [0.0, 0.5, 1.0, 1.0]);
    }
}
