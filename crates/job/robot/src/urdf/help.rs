//! Entries for the world file that make a robot usable.

use super::limits::{Limits, key};
use super::reduction::Reduction;
use cplan_model::Plane;

/// Returns the entries of `[robot]` that make these two joints usable, one per line: the names of the joints, and placeholders
/// for missing or invalid ranges and unusable geometry. `None` if no entry is needed.
pub(super) fn entries(reduction: &Reduction, plane: &Plane) -> Option<String> {
    let &Reduction { document, settings, chain, .. } = reduction;
    let joints = &document.robot.joints;
    let limits = Limits { document, settings };
    let [first, second] = chain.joints.map(|j| joints[j].name.as_str());
    let mut lines = Vec::new();
    let chosen = super::chain::joints(document, reduction.tree, settings);
    if chosen != Some(chain.joints) {
        lines.push(format!("joints = [{first:?}, {second:?}]"));
    }
    let table = |what: &str, missing: &dyn Fn(usize) -> bool, placeholder: &dyn Fn(usize) -> String| {
        let entry = |j: usize| format!("{} = {}", key(&joints[j].name), placeholder(j));
        let entries: Vec<String> = chain.joints.into_iter().filter(|j| missing(*j)).map(entry).collect();
        (!entries.is_empty()).then(|| format!("{what} = {{ {} }}", entries.join(", ")))
    };
    lines.extend(table("limits", &|j| limits.planned_range(j).is_err(), &|j| limits.example(j)));
    if reduction.outlines(plane).is_err() {
        lines.push("bar = 0.05".into());
    }
    (!lines.is_empty()).then(|| lines.join("\n"))
}
