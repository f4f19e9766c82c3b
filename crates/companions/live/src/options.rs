//! Parses planner and options of the page with the grammar of the command line.

use clap::{Command, CommandFactory, Parser};
use cplan_model::Scene;
use cplan_options::{MotionArgs, PlannerArgs, planners, word};
use cplan_solver::Method;

/// Shortest time between samples that a page may request, in seconds. It limits the number of samples that are drawn
/// and sent to the browser.
const MIN_PERIOD: f64 = 1e-3;

/// A planner and its options.
#[derive(Debug)]
pub struct Options {
    options: cplan_solver::Options,
}

#[derive(Debug, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct Grammar {
    #[arg(value_parser = word(planners()))]
    planner: Method,
    #[command(flatten)]
    motion: MotionArgs,
    #[command(flatten)]
    options: PlannerArgs,
}

impl Options {
    /// Returns the grammar of the options, from which the menus are made.
    pub fn grammar() -> Command {
        Grammar::command()
    }

    /// Parses `PLANNER OPTIONS`.
    ///
    /// # Errors
    /// The reason, in one line.
    pub fn parse(text: &str) -> Result<Self, String> {
        let grammar = Grammar::try_parse_from(text.split_whitespace()).map_err(|error| {
            let text = error.to_string();
            // Remove the usage from the error, because it describes a command line.
            let lines: Vec<&str> = text.lines().map(str::trim).take_while(|line| !line.is_empty()).collect();
            let line = lines.join(" ");
            line.strip_prefix("error: ").unwrap_or(&line).to_owned()
        })?;
        if grammar.motion.period < MIN_PERIOD {
            return Err(format!("--period: the live page takes at least {MIN_PERIOD} s"));
        }
        let planner = grammar.options.planner(grammar.planner)?;
        grammar.options.field.missing().map_or(Ok(()), Err)?;
        let options = cplan_solver::Options {
            levels: grammar.options.effort.levels(&planner),
            planner,
            drive: grammar.motion.drive(),
            jerk: grammar.motion.jerk,
            ..cplan_solver::Options::default()
        };
        Ok(Self { options })
    }

    /// Returns the options for planning in a scene.
    ///
    /// # Errors
    /// A field that needs preferences, in a world that has none.
    pub fn for_scene(&self, scene: &Scene) -> Result<&cplan_solver::Options, String> {
        self.options.planner.missing_preference(&scene.workspace().preferences).map_or(Ok(&self.options), Err)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_solver::Planner;

    #[test]
    fn options_are_those_of_the_command_line() {
        let options = Options::parse("visibility --gap 0.01 --margin 1e-4").unwrap();
        let expected = Planner::named(Method::Visibility).with_gap(0.01).with_margin(1e-4);
        assert_eq!(options.options.planner, expected);
    }

    #[test]
    fn errors_fit_one_line() {
        for (text, part) in [
            ("", "<PLANNER>"),
            ("fastest", "[possible values: shortest"),
            ("harmonic --gap 0.1", "--gap needs --planner shortest or visibility"),
            ("visibility --search wave", "--search wave needs a planner with a grid"),
            ("first --backward", "--backward needs --planner visibility"),
            ("trapezoid --seed 2", "--seed needs --planner prm"),
            ("visibility --search dfs --gap 0.1", "--gap needs a search for the shortest path"),
            ("visibility --path own", "--path own does not apply to planner visibility"),
            ("visibility --output plan.json", "unexpected argument"),
            ("visibility --help", "unexpected argument"),
            ("visibility --period 1e-6", "at least 0.001 s"),
            ("wavefront --cells 100000", "100000"),
        ] {
            let error = Options::parse(text).unwrap_err();
            assert!(error.contains(part) && !error.contains('\n'), "{text}: {error}");
        }
    }
}
