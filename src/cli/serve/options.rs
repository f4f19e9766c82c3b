//! Planner and options of the page, in the grammar of the command line.

use crate::cli::args::{EffortArgs, OptimumArgs};
use crate::cli::field_args::FieldArgs;
use crate::cli::motion::MotionArgs;
use crate::cli::path_args::PathArgs;
use crate::cli::search_args::SearchArgs;
use crate::engine::{Effort, Method};
use crate::model::{Joint, Scene};
use crate::motion::Drive;
use crate::planner::FieldPlanner;
use clap::{Command, CommandFactory, Parser};

/// The finest trajectory that a page asks for, seconds: it is drawn, and sent to a browser.
const SHORTEST_PERIOD: f64 = 1e-3;

/// A planner and what is asked of it.
#[derive(Debug)]
pub struct Options {
    grammar: Grammar,
    field: Option<FieldPlanner>,
}

#[derive(Debug, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct Grammar {
    planner: Method,
    #[command(flatten)]
    effort: EffortArgs,
    #[command(flatten)]
    optimum: OptimumArgs,
    #[command(flatten)]
    motion: MotionArgs,
    #[command(flatten)]
    path: PathArgs,
    #[command(flatten)]
    search: SearchArgs,
    #[command(flatten)]
    field: FieldArgs,
}

impl Options {
    /// The grammar, for menus.
    pub fn grammar() -> Command {
        Grammar::command()
    }

    /// Reads `PLANNER OPTIONS`.
    ///
    /// # Errors
    /// What is wrong with it, in one line.
    pub fn parse(text: &str) -> Result<Self, String> {
        let grammar = Grammar::try_parse_from(text.split_whitespace()).map_err(|error| {
            let text = error.to_string();
            // Up to the usage, which is that of a command line.
            let lines: Vec<&str> = text.lines().map(str::trim).take_while(|line| !line.is_empty()).collect();
            let line = lines.join(" ");
            line.strip_prefix("error: ").unwrap_or(&line).to_owned()
        })?;
        let planner = grammar.planner;
        let conflict = grammar.optimum.conflict(planner).or_else(|| grammar.search.conflict(planner));
        if let Some(conflict) = conflict.or_else(|| grammar.path.conflict(planner)) {
            return Err(conflict);
        }
        if grammar.motion.period < SHORTEST_PERIOD {
            return Err(format!("--period: the live page takes at least {SHORTEST_PERIOD} s"));
        }
        let field = grammar.field.planner(planner)?;
        Ok(Self { grammar, field })
    }

    /// The planner.
    pub fn method(&self) -> Method {
        self.grammar.planner
    }

    /// The field that is asked for, if one is.
    pub fn field(&self) -> Option<&FieldPlanner> {
        self.field.as_ref()
    }

    /// How to drive along the path.
    pub fn motion(&self) -> &MotionArgs {
        &self.grammar.motion
    }

    /// The same for tasks.
    pub fn drive(&self) -> Drive {
        self.grammar.motion.drive()
    }

    /// Puts the limits that the options give in place of the joints' own.
    pub fn override_limits(&self, joints: &mut [Joint; 2]) {
        self.grammar.motion.override_limits(joints);
    }

    /// How hard to try in a scene, and what for.
    ///
    /// # Errors
    /// A field that follows preferences of the world, which has none.
    pub fn effort(&self, scene: &Scene) -> Result<Effort, String> {
        let Grammar { effort, optimum, path, search, field, .. } = &self.grammar;
        if let Some(lack) = field.lack(&scene.workspace().preferences) {
            return Err(lack);
        }
        let metric = optimum.metric(scene.arm().joints.each_ref().map(|joint| joint.velocity));
        let (field, wavefront) = (self.field, search.wavefront());
        Ok(Effort { metric, gap: optimum.gap, field, path: path.path, wavefront, ..effort.effort() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_those_of_the_command_line() {
        let options = Options::parse("visibility --gap 0.01 --margin 1e-4").unwrap();
        assert_eq!(options.method(), Method::Visibility);
        assert_eq!((options.grammar.optimum.gap, options.grammar.effort.margin), (Some(0.01), 1e-4));
    }

    #[test]
    fn what_is_wrong_is_said_in_a_line() {
        for (text, part) in [
            ("", "<PLANNER>"),
            ("fastest", "[possible values: shortest"),
            ("harmonic --gap 0.1", "--gap needs --planner shortest or visibility"),
            ("visibility --search astar", "--search needs --planner wavefront"),
            ("visibility --path own", "--path own is not for visibility"),
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
