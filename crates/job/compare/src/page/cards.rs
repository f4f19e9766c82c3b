//! The recommendations of a page, one card each.

use super::paths::PathPictures;
use super::quantities::{clearance, computing_time, duration, excess, path_length};
use super::ranking::line_sample;
use crate::{Comparison, Measure, Purpose, Row, Study, labels};
use cplan_text::markup;
use cplan_theme::PlannerPen;

/// The purposes that have cards.
const CARD_PURPOSES: [Purpose; 3] = [Purpose::Shortest, Purpose::Safest, Purpose::Quickest];

/// The content of a card.
struct Card {
    purpose: Purpose,
    label: String,
    name: String,
    pen: PlannerPen,
    /// The value for which the planner is recommended.
    value: String,
    /// The value in full precision, if it is a number.
    exact: Option<f64>,
    meaning: String,
    /// Other values of the planner.
    cost: String,
    /// Further sentences and pictures, as markup.
    more: String,
    /// Index of the path in the pictures.
    path: Option<usize>,
}

impl Card {
    fn html(&self) -> String {
        let [key, title] = purpose_names(self.purpose);
        let path = self.path.map_or_else(String::new, |path| format!(" data-path=\"{path}\""));
        let exact = self
            .exact
            .filter(|value| value.is_finite())
            .map_or_else(String::new, |value| format!(" data-value=\"{value}\""));
        format!(
            "<article class=\"card pick\" data-purpose=\"{}\" data-planner=\"{}\"{path} style=\"--pen: var(--{})\">\n<h2>{}</h2>\n\
             <p class=\"planner\">{} {}</p>\n<p class=\"value\"{exact}>{}</p>\n<p class=\"meaning\">{}</p>\n<p class=\"sub\">{}</p>\n{}\
             </article>\n",
            key,
            markup(&self.name),
            self.pen.name(),
            title,
            line_sample(self.pen),
            markup(&self.label),
            markup(&self.value),
            markup(&self.meaning),
            markup(&self.cost),
            self.more
        )
    }
}

/// Returns the name of a purpose in attributes, and its title.
fn purpose_names(purpose: Purpose) -> [&'static str; 2] {
    match purpose {
        Purpose::Shortest => ["shortest", "Shortest"],
        Purpose::Safest => ["safest", "Safest"],
        Purpose::Quickest => ["quickest", "Quickest answer"],
        Purpose::FastestMotion => ["motion", "Quickest motion"],
    }
}

/// Returns the cards of a study, or an empty text if no planner found a path.
pub fn cards(study: &Study, pictures: &[PathPictures]) -> String {
    let cards: Vec<Card> = match &study.comparisons[..] {
        [only] => CARD_PURPOSES.into_iter().filter_map(|purpose| of_problem(only, purpose, pictures.first())).collect(),
        _ => CARD_PURPOSES.into_iter().filter_map(|purpose| of_study(study, purpose)).collect(),
    };
    if cards.is_empty() {
        return String::new();
    }
    format!("<div class=\"cards\">\n{}</div>\n", cards.iter().map(Card::html).collect::<String>())
}

fn of_problem(comparison: &Comparison, purpose: Purpose, picture: Option<&PathPictures>) -> Option<Card> {
    let index = comparison.recommended(purpose)?;
    let row = &comparison.rows[index];
    let exact = purpose.value(row);
    let names = short_names(comparison);
    let (label, pen) = (names[index].clone(), comparison.pens()[index]);
    let path = comparison.path_index(index);
    let small =
        |panel| picture.zip(path).map(|(picture, path)| picture.small(panel, path, pen, &label)).unwrap_or_default();
    let meaning = match purpose {
        Purpose::Shortest => {
            comparison.over_optimum(row).map(|ratio| format!("at most {} longer than the optimum", excess(ratio)))
        }
        Purpose::Safest => Some("from all obstacles, along the whole motion".to_owned()),
        Purpose::Quickest | Purpose::FastestMotion => Some("time from the problem to the certified path".to_owned()),
    };
    let mut more = format!("<div class=\"smalls\">{}{}</div>\n", small(0), small(1));
    if purpose == Purpose::Quickest {
        more = fastest_motion(comparison, &names) + &more;
    }
    Some(Card {
        purpose,
        value: shown(purpose, exact?, comparison),
        exact,
        meaning: meaning.unwrap_or_default(),
        cost: other_values(comparison, row, purpose),
        name: row.planner.clone(),
        label,
        pen,
        more,
        path,
    })
}

/// Names the planner of the fastest motion, to distinguish it from the quickest planner.
fn fastest_motion(comparison: &Comparison, names: &[String]) -> String {
    let fastest = comparison.recommended(Purpose::FastestMotion);
    let of = |index: usize| {
        let row = &comparison.rows[index];
        let value = row.duration?;
        Some(format!(
            "<p class=\"also\" data-purpose=\"{}\" data-planner=\"{}\" data-value=\"{value}\">Quickest motion: <strong>{}</strong>, {}</p>\n",
            purpose_names(Purpose::FastestMotion)[0],
            markup(&row.planner),
            markup(&names[index]),
            duration(value)
        ))
    };
    fastest.and_then(of).unwrap_or_default()
}

/// Formats the value for which a row is recommended.
fn shown(purpose: Purpose, value: f64, comparison: &Comparison) -> String {
    match purpose {
        Purpose::Shortest => path_length(value, &comparison.length_unit),
        Purpose::Safest => clearance(value),
        Purpose::Quickest => computing_time(value),
        Purpose::FastestMotion => duration(value),
    }
}

/// Lists the other values of a recommended row.
fn other_values(comparison: &Comparison, row: &Row, purpose: Purpose) -> String {
    let longer = || Some(format!("at most {} longer than the optimum", excess(comparison.over_optimum(row)?)));
    let room = || row.clearance.map(|metres| format!("keeps {}", clearance(metres)));
    let motion = || row.duration.map(|seconds| format!("moves {}", duration(seconds)));
    let time = || row.total.map(|seconds| format!("computed in {}", computing_time(seconds)));
    let values = match purpose {
        Purpose::Shortest => [room(), motion(), time()],
        Purpose::Safest => [longer(), motion(), time()],
        Purpose::Quickest | Purpose::FastestMotion => [longer(), room(), motion()],
    };
    values.into_iter().flatten().collect::<Vec<_>>().join(" \u{b7} ")
}

fn of_study(study: &Study, purpose: Purpose) -> Option<Card> {
    let (planner, wins) = study.most_recommended(purpose)?;
    let first = study.comparisons.first()?;
    let [found, ..] = study.outcome_counts();
    let (measure, show): (Measure, fn(f64) -> String) = match purpose {
        Purpose::Shortest => (Measure::OverOptimum, |ratio| format!("{} over the optimum", excess(ratio))),
        Purpose::Safest => (Measure::Clearance, |metres| format!("{} of clearance", clearance(metres))),
        Purpose::Quickest | Purpose::FastestMotion => (Measure::Total, computing_time),
    };
    let meaning = match purpose {
        Purpose::Shortest => "its path is the shortest",
        Purpose::Safest => "its path keeps the greatest clearance",
        Purpose::Quickest | Purpose::FastestMotion => "it finds a path in the least time",
    };
    let median = study.spread(planner, measure).map(|spread| format!("Median: {}", show(spread.median)));
    Some(Card {
        purpose,
        label: short_names(first)[planner].clone(),
        name: first.rows[planner].planner.clone(),
        pen: first.pens()[planner],
        value: format!("{wins} of {found}"),
        exact: Some(wins as f64),
        meaning: format!("number of problems with a path in which {meaning}"),
        cost: median.unwrap_or_default(),
        more: String::new(),
        path: None,
    })
}

/// Returns the planners' names without options that all rows of a planner share.
pub fn short_names(comparison: &Comparison) -> Vec<String> {
    labels(&comparison.rows.iter().map(|row| row.planner.as_str()).collect::<Vec<_>>())
}
