//! Errors of a planner's options, in words.

use super::setting::{ALLOWED_NEIGHBORS, ALLOWED_SAMPLES, MAX_MARGIN};
use super::{Criterion, Planner, Setting};
use cplan_fields::{EquationChoice, FieldChoice};
use cplan_model::Preference;
use cplan_planners::planner::{GridSearch, PathKind};
use std::ops::RangeInclusive;

impl Planner {
    /// Describes the first preference that the planner's field needs and the world file lacks, with a hint. `None` if none is
    /// missing.
    pub fn missing_preference(&self, preferences: &[Preference]) -> Option<String> {
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

    /// Names and describes the first invalid setting. `None` if all are valid.
    pub(super) fn error(&self) -> Option<String> {
        if self.path_kind() == PathKind::Middles && !self.method().descriptor().paths.contains(&PathKind::Middles) {
            return Some(format!("path: middles needs the planner trapezoid, not {}", self.method()));
        }
        self.method().descriptor().settings.iter().find_map(|&setting| self.setting_error(setting))
    }

    fn setting_error(&self, setting: Setting) -> Option<String> {
        let settings = self.settings();
        match setting {
            Setting::Criterion => match settings.criterion {
                Criterion::Weighted(weights) => weights.into_iter().find_map(|weight| not_positive("weights", weight)),
                Criterion::Euclidean | Criterion::Time | Criterion::Motor => None,
            },
            Setting::Gap => {
                let gap = settings.gap?;
                let blind = || "gap: the chosen search does not look for the shortest path".to_owned();
                not_positive("gap", gap).or_else(|| (!self.optimizes()).then(blind))
            }
            Setting::Margin => wrong_margin(settings.margin),
            Setting::Samples => wrong_number("samples", settings.samples, &ALLOWED_SAMPLES),
            Setting::Nearest => wrong_number("nearest", settings.nearest, &ALLOWED_NEIGHBORS),
            Setting::Forward if settings.forward && settings.grid_search == GridSearch::Wave => {
                Some("forward: the search `wave` always begins at the goals".into())
            }
            Setting::Cells => settings.cells?.error(),
            _ => None,
        }
    }
}

fn not_positive(name: &str, value: f64) -> Option<String> {
    (!value.is_finite() || value <= 0.0).then(|| format!("{name}: {value} must be finite and positive"))
}

/// Describes a number outside its range. `None` if it is within.
pub(super) fn wrong_number(name: &str, n: usize, range: &RangeInclusive<usize>) -> Option<String> {
    (!range.contains(&n)).then(|| format!("{name}: {n} must be from {} to {}", range.start(), range.end()))
}

fn wrong_margin(margin: f64) -> Option<String> {
    (!(0.0..=MAX_MARGIN).contains(&margin))
        .then(|| format!("margin: {margin} must be from 0 to {MAX_MARGIN} (of the arm's reach)"))
}
