//! Pictures of some layouts.

use super::Study;
use super::row::{Ending, Row};
use super::summary::Summary;
use cplan_compare::Picture;
use cplan_view::output::PlanOutput as _;

/// Draws the best and the worst layout, the first infeasible one and the first unknown one, if they exist.
#[must_use]
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
        let unit = |unit: &Option<String>| unit.as_ref().map_or_else(String::new, |unit| format!(" {unit}"));
        let values: Vec<String> = values.map(|(p, value)| format!("{} {value:.4}{}", p.name, unit(&p.unit))).collect();
        let title = format!("{word}: layout {} ({})", row.layout, values.join(", "));
        Some(Picture { title, svg: study.plan(&row.values).ok()?.svg() })
    };
    shown.into_iter().filter_map(|(word, row)| picture((word, row?))).collect()
}
