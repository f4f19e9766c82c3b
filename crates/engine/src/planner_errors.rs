//! Errors of a planner's options, in words.

use super::planner_options::{MOST_MARGIN, NEAREST, SAMPLES};
use super::{Criterion, Method, Planner};
use cplan_core::model::Preference;
use cplan_core::planner::{GridSearch, PathKind};
use cplan_fields::{EquationChoice, FieldChoice};
use std::ops::RangeInclusive;

impl Planner {
    /// Reports preferences that its field needs and the world lacks, with a hint.
    #[must_use]
    pub fn lack(&self, preferences: &[Preference]) -> Option<String> {
        let FieldChoice::Relaxed { equation, .. } = self.field()?.field else { return None };
        let name = match equation {
            EquationChoice::LocallyOriented { direction, .. } => {
                if preferences.is_empty() {
                    return Some("--field local needs [[preference]] regions in the world file".into());
                }
                let lost = preferences.iter().find(|region| region.direction.is_none() && direction.is_none())?;
                let name = &lost.name;
                return Some(format!(
                    "--field local: the preference \"{name}\" has no direction; give it one, or --direction"
                ));
            }
            EquationChoice::Preference { elsewhere: 0.0, .. } => "bvp",
            EquationChoice::AlteredPreference { elsewhere: 0.0 } => "bvp2",
            _ => return None,
        };
        let needs = || format!("--field {name} needs [[preference]] regions in the world file, or --epsilon");
        preferences.is_empty().then(needs)
    }

    /// Reports the first option without sense, by name.
    pub(super) fn error(&self) -> Option<String> {
        if self.path_kind() == PathKind::Middles && self.method() != Method::Trapezoid {
            return Some(format!("path: middles is for trapezoid, not for {}", self.method()));
        }
        let positive = |name: &str, value: f64| {
            (!value.is_finite() || value <= 0.0).then(|| format!("{name}: {value} is not finite and positive"))
        };
        match *self {
            Planner::Shortest { criterion, gap, margin } | Planner::Visibility { criterion, gap, margin, .. } => {
                let weights = if let Criterion::Weighted(weights) = criterion { weights } else { [1.0; 2] };
                let wrong = weights.into_iter().find_map(|weight| positive("weights", weight));
                let blind = || "gap: a search that is not after the shortest path closes none".to_owned();
                let blind = (gap.is_some() && !self.optimises()).then(blind);
                wrong.or_else(|| positive("gap", gap?)).or(blind).or_else(|| wrong_margin(margin))
            }
            Planner::Trapezoid { margin, .. } | Planner::Triangles { margin, .. } | Planner::Voronoi { margin, .. } => {
                wrong_margin(margin)
            }
            Planner::Prm { samples, nearest, margin, .. } => wrong_number("samples", samples, &SAMPLES)
                .or_else(|| wrong_number("nearest", nearest, &NEAREST))
                .or_else(|| wrong_margin(margin)),
            Planner::Wavefront { search: GridSearch::Wave, forward: true, .. } => {
                Some("forward: the wave begins at the goals, so that its labels are steps to them".into())
            }
            Planner::Wavefront { cells, .. } | Planner::Harmonic { cells: Some(cells), .. } => cells.error(),
            Planner::Harmonic { cells: None, .. } | Planner::First | Planner::Subdivision { .. } => None,
        }
    }
}

/// Reports a number that lies outside its range.
pub(super) fn wrong_number(name: &str, n: usize, range: &RangeInclusive<usize>) -> Option<String> {
    (!range.contains(&n)).then(|| format!("{name}: {n} is not from {} to {}", range.start(), range.end()))
}

fn wrong_margin(margin: f64) -> Option<String> {
    (!(0.0..=MOST_MARGIN).contains(&margin))
        .then(|| format!("margin: {margin} is not from 0 to {MOST_MARGIN} (of the arm's reach)"))
}
