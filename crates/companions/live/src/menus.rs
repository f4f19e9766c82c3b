//! The page's menus: the options of each planner, and their values.
//!
//! Names, values and defaults come from the command line's grammar. The page does not send defaults, so it cannot
//! contradict those of the program.

use super::options::Options;
use clap::{Arg, Command};
use cplan_planners::planner::GridSearch;
use cplan_planners::waves::Neighborhood;
use cplan_roadmaps::Prm;
use cplan_solver::{DEFAULT_CELLS, GridSpace, Method, Planner, Setting};
use serde_json::{Value, json};

/// An option with a menu of its own. All other options are typed.
struct Choice {
    name: &'static str,
    label: &'static str,
    /// Values and labels of the menu for a numeric option. If empty, the menu has the values that the grammar lists.
    numbers: &'static [(&'static str, &'static str)],
    /// Returns the default of the option for a planner. `None` if the grammar states it.
    standard: fn(Method) -> Option<String>,
    /// Returns true if the planner uses the option. Planners may accept options that they ignore.
    is_for: fn(Method) -> bool,
}

/// An option with the values that the grammar lists, for all planners.
const fn listed(name: &'static str, label: &'static str, standard: fn(Method) -> Option<String>) -> Choice {
    Choice { name, label, numbers: &[], standard, is_for: |_| true }
}

const CHOICES: [Choice; 8] = [
    Choice {
        numbers: &[("0.01", "1 %"), ("0.001", "0.1 %"), ("0.0001", "0.01 %")],
        ..listed("gap", "gap at most", |_| Some("default".into()))
    },
    listed("metric", "length", |_| None),
    Choice {
        numbers: &[("64", "64"), ("128", "128"), ("256", "256"), ("512", "512"), ("1024", "1024")],
        is_for: |planner| planner.reads(Setting::Cells),
        ..listed("cells", "cells", cells)
    },
    Choice { is_for: Method::has_own_path, ..listed("path", "path", |planner| Some(planner.path_kind().to_string())) },
    listed("search", "search", |planner| {
        let search = if planner.reads(Setting::Search) { GridSearch::AStar } else { GridSearch::default() };
        Some(search.name().to_owned())
    }),
    Choice {
        numbers: &[("100", "100"), ("500", "500"), ("2000", "2000"), ("10000", "10000")],
        ..listed("samples", "samples", |_| Some(Prm::default().samples.to_string()))
    },
    listed("neighbors", "neighbours", |_| {
        Some(if Neighborhood::default() == Neighborhood::Eight { "8" } else { "4" }.into())
    }),
    listed("space", "cells by", |_| Some(GridSpace::default().name().to_owned())),
];

/// Returns the default of `--cells`. The cells of fields are square in joint space by default.
fn cells(planner: Method) -> Option<String> {
    Some(match Planner::named(planner).cells() {
        Some(cells) => cells.to_string(),
        None => format!("{DEFAULT_CELLS}, square"),
    })
}

/// Returns all planners with their menus.
pub fn planners() -> Vec<Value> {
    let grammar = Options::grammar();
    let menus =
        |planner: Method| CHOICES.iter().filter_map(|choice| menu(&grammar, planner, choice)).collect::<Vec<_>>();
    Method::ALL.into_iter().map(|planner| json!({ "name": planner.name(), "options": menus(planner) })).collect()
}

/// Returns the menu of an option with the values that the planner accepts. `None` if it accepts none.
fn menu(grammar: &Command, planner: Method, choice: &Choice) -> Option<Value> {
    let argument = grammar.get_arguments().find(|argument| argument.get_long() == Some(choice.name))?;
    let name = format!("--{}", choice.name);
    let standard = (choice.standard)(planner).or_else(|| default_of(argument)).unwrap_or_default();
    let listed = argument.get_possible_values().into_iter().map(|value| [value.get_name().to_owned(), String::new()]);
    let numbers = choice.numbers.iter().map(|&(value, text)| [value.to_owned(), text.to_owned()]);
    let all: Vec<[String; 2]> = if choice.numbers.is_empty() { listed.collect() } else { numbers.collect() };
    let takes = |value: &str| Options::parse(&format!("{planner} {name} {value}")).is_ok();
    let values: Vec<[String; 2]> = all
        .into_iter()
        .filter(|[value, _]| *value != standard && takes(value))
        .map(|[value, text]| if text.is_empty() { [value.clone(), value] } else { [value, text] })
        .collect();
    let is_shown = (choice.is_for)(planner) && !values.is_empty();
    is_shown.then(|| json!({ "name": name, "label": choice.label, "standard": standard, "values": values }))
}

fn default_of(argument: &Arg) -> Option<String> {
    Some(argument.get_default_values().first()?.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_planner_has_the_options_that_it_takes() {
        let of = |name: &str| {
            let planner = planners().into_iter().find(|planner| planner["name"] == name).unwrap();
            let text = |value: &Value| value.as_str().unwrap().to_owned();
            let options = planner["options"].as_array().unwrap().iter();
            options.map(|option| (text(&option["name"]), text(&option["standard"]))).collect::<Vec<_>>()
        };
        let pairs = |list: &[(&str, &str)]| list.iter().map(|&(a, b)| (a.into(), b.into())).collect::<Vec<_>>();
        let optimum = pairs(&[("--gap", "default"), ("--metric", "euclidean")]);
        let roadmap = [("--path", "taut"), ("--search", "astar")];
        let visibility = [optimum.clone(), pairs(&roadmap[1..])].concat();
        assert_eq!((of("shortest"), of("visibility"), of("first")), (optimum, visibility, Vec::new()));
        assert_eq!([of("trapezoid"), of("triangles")], [pairs(&roadmap), pairs(&roadmap)]);
        let diagram = pairs(&[("--path", "own"), ("--search", "astar")]);
        assert_eq!(of("voronoi"), diagram);
        assert_eq!(of("prm"), pairs(&[&roadmap[..], &[("--samples", "500")]].concat()));
        let search = [("--search", "wave"), ("--neighbors", "4"), ("--space", "rows")];
        assert_eq!(of("wavefront"), pairs(&[&[("--cells", "256"), ("--path", "taut")][..], &search[..]].concat()));
        assert_eq!(of("harmonic"), pairs(&[("--cells", "256, square"), ("--path", "own"), ("--space", "rows")]));
        assert_eq!(of("subdivision"), pairs(&[("--path", "taut")]));
    }

    #[test]
    fn the_default_is_not_among_the_other_values() {
        let planners = planners();
        for option in planners.iter().flat_map(|planner| planner["options"].as_array().unwrap()) {
            let values = option["values"].as_array().unwrap();
            assert!(!values.is_empty() && values.iter().all(|value| value[0] != option["standard"]), "{option}");
        }
    }
}
