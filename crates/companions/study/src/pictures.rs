//! Pictures of some layouts.

use super::Study;
use super::answer::with_unit;
use super::row::{Ending, Row};
use super::summary::Summary;
use cplan_compare::Picture;
use cplan_view::output::PlanOutput as _;

/// Draws the workspace of the best layout, and whole pictures of four layouts, if they exist: the best, the worst, the
/// first infeasible and the first unknown one.
pub fn pictures(study: &Study, rows: &[Row]) -> Vec<Picture> {
    let summary = Summary::new(study, rows);
    let first = |ending: Ending| rows.iter().find(|row| row.ending == ending);
    let shown = [
        ("best", summary.best()),
        ("worst", summary.worst()),
        ("infeasible", first(Ending::Infeasible)),
        ("unknown", first(Ending::Unknown)),
    ];
    let picture = |(word, row): (&str, &Row)| {
        let values = study.parameters.iter().zip(&row.values);
        let values: Vec<String> =
            values.map(|(p, value)| format!("{} {}", p.name, with_unit(*value, p.unit.as_deref()))).collect();
        let title = format!("{word}: layout {} ({})", row.layout, values.join(", "));
        let plan = study.plan(&row.values).ok()?;
        let whole = Picture { title: title.clone(), svg: plan.svg() };
        // The answer shows only the workspace of the best layout, which is legible beside text and on a phone.
        let small = (word == "best").then(|| Picture { title, svg: cplan_view::workspace_svg(&plan.view()) });
        Some(small.into_iter().chain([whole]))
    };
    shown.into_iter().filter_map(|(word, row)| picture((word, row?))).flatten().collect()
}

/// Returns a picture as an element of a page, with the page's typeface. `id` makes the names inside the picture unique.
/// `label` describes the picture, as markup.
pub fn inline(svg: &str, id: &str, label: &str) -> String {
    let svg = svg.replace("<clipPath id=\"", &format!("<clipPath id=\"{id}-"));
    let svg = svg.replace("clip-path=\"url(#", &format!("clip-path=\"url(#{id}-"));
    svg.replacen("<svg ", &format!("<svg role=\"img\" aria-label=\"{label}\" "), 1)
}
