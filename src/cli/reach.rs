//! `cplan reach`: the places that the tip can reach.

use super::exit::DONE;
use super::failure::Failure;
use super::files::Files;
use super::headings::OUTPUT;
use super::outputs::{Outputs, by_extension, drawn, refuse_to_overwrite_inputs};
use super::print_args::PrintArgs;
use super::sinks;
use super::theme::ThemeArgs;
use super::values::clearance;
use crate::engine::{Access, MAX_PLACES, Reach, reach, reach_section};
use crate::input::{self, JointValues, LoadedProblem, Overrides, Rules};
use crate::model::Status;
use crate::options::positive;
use crate::output::{contours, format_columns, title_of};
use crate::text::{counted, fixed, length, percent};
use crate::view::{Picture, View};
use clap::{Args, ValueHint};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Default number of cells over the length of the arm's reach.
const DEFAULT_CELLS: f64 = 60.0;

/// Report where the tip can go, and with which IK solutions.
#[derive(Debug, Args)]
#[command(after_help = "\
The workspace is divided into square cells. For the centre of each cell, the
report lists the IK solutions that put the tip there and classifies each:
reached by a certified motion from the home configuration, free but proven
unreachable, or not free.

Examples:
  cplan reach robots/planar_2r.urdf workspaces/shelf.toml
  cplan reach robots/planar_2r.urdf workspaces/shelf.toml --cell 0.1 \\
    --output reach.csv --picture reach.svg
  cplan reach robots/scara.urdf workspaces/scara_cell.toml --home 0,1.2 --json

Exit codes: 0 every cell is classified or reported as unknown, 1 bad input or
I/O, 2 wrong command line.")]
pub struct ReachArgs {
    #[command(flatten)]
    pub files: Files,
    /// Configuration in which motions begin, instead of the world's start.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true)]
    pub home: Option<JointValues>,
    /// Side of the cells, metres [default: a 60th of the arm's reach].
    #[arg(long, value_name = "METRES", value_parser = positive)]
    pub cell: Option<f64>,
    /// Least distance to keep from every obstacle, metres or as in 20mm, instead of the world's.
    #[arg(long, value_name = "METRES", value_parser = clearance)]
    pub clearance: Option<f64>,
    /// Write the cells and their IK solutions: .json, or .csv with one line per solution. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub output: Vec<PathBuf>,
    /// Draw the cells in the workspace and the IK solutions in the configuration space: .svg, .png or .html. Can be
    /// repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub picture: Vec<PathBuf>,
    #[command(flatten)]
    pub theme: ThemeArgs,
    #[command(flatten)]
    pub print: PrintArgs,
}

/// Computes the places that the tip can reach, and prints and writes them.
///
/// # Errors
/// Bad input and I/O.
pub fn run(args: &ReachArgs) -> Result<u8, Failure> {
    let content = by_extension(&[("json", true), ("csv", false)], "the name of a reach file must end in .json or .csv");
    let outputs = Outputs::new(&args.output, content, &args.picture, [])?.without_animation("a reach")?;
    let overrides = Overrides { start: args.home, clearance: args.clearance, ..Overrides::default() };
    let loaded = input::load_scene(args.files.robot(), &args.files.world)?;
    refuse_to_overwrite_inputs(outputs.paths(), &loaded.files())?;
    let world = loaded.resolve(&overrides, Rules::Exploration);
    let world = world.map_err(|error| error.with_option("--start", "--home"))?;
    world.robot.warnings.iter().for_each(|warning| sinks::print_status(&format!("warning: {warning}")));
    let cell = args.cell.unwrap_or(world.problem.scene().arm().reach() / DEFAULT_CELLS);
    let reach = reach(world.problem.scene(), world.problem.start(), cell).ok_or_else(|| {
        Failure::Refused(format!("--cell {cell} gives more than {MAX_PLACES} cells; choose larger cells"))
    })?;
    let json = || sinks::pretty(&object(&world, &reach));
    let table = |_: &Path, is_json| Ok(Some(if is_json { json()? } else { csv(&world, &reach) }.into_bytes()));
    outputs.write(vec![], table, drawn(|| args.theme.apply(view(&world, &reach))))?;
    args.print.report(DONE, json, || summary(&world, &reach))?;
    Ok(DONE)
}

fn names(world: &LoadedProblem) -> [&str; 2] {
    world.problem.scene().arm().joints.each_ref().map(|joint| joint.name.as_str())
}

fn object(world: &LoadedProblem, reach: &Reach) -> Value {
    let area = reach.cell * reach.cell;
    let tally: Value =
        Access::ALL.iter().zip(reach.tally()).map(|(access, n)| (access.name().to_owned(), json!(n))).collect();
    let area_reachable = area * reach.tally()[0] as f64;
    json!({ "joints": names(world), "cells": tally, "reachable_area": area_reachable, "reach": reach })
}

/// Returns CSV with one line per solution: centre of the cell, joint values, and reachability.
fn csv(world: &LoadedProblem, reach: &Reach) -> String {
    let [a, b] = names(world).map(crate::compare::quoted);
    let mut text = format!("x,y,{a},{b},access\n");
    for (place, solutions) in reach.places.iter().enumerate() {
        let at = reach.center(place);
        for solution in solutions {
            text += &format!(
                "{},{},{},{},{}\n",
                at.x,
                at.y,
                solution.joints[0],
                solution.joints[1],
                solution.access.name()
            );
        }
    }
    text
}

/// Returns names and descriptions of the facts about the places.
fn facts(world: &LoadedProblem, reach: &Reach) -> Vec<(&'static str, String)> {
    let [joints, units] = [names(world), world.problem.scene().arm().joints.each_ref().map(|joint| joint.unit())];
    let several = reach.best().filter(|(_, access, count)| *access == Access::Reachable && *count > 1).count();
    let [reachable, unknown, unreachable, blocked] = reach.tally();
    let area = reach.cell * reach.cell;
    let home = [0, 1].map(|k| format!("{} {:.4} {}", joints[k], reach.home[k], units[k])).join(", ");
    let mut facts = vec![
        ("home", home),
        ("cells", format!("side {:.4} m; only the centre of each cell is judged", reach.cell)),
        (
            "reachable",
            format!(
                "{}, {several} of them with several IK solutions ({:.4} m2)",
                counted(reachable, "cell"),
                area * reachable as f64
            ),
        ),
        (
            "out of reach",
            format!(
                "{} where the arm would be free, but which it cannot reach (proven; {:.4} m2)",
                counted(unreachable, "cell"),
                area * unreachable as f64
            ),
        ),
        ("not free", counted(blocked, "cell")),
    ];
    if unknown > 0 {
        facts.push(("unknown", counted(unknown, "cell")));
    }
    facts
}

fn summary(world: &LoadedProblem, reach: &Reach) -> String {
    let mut lines = facts(world, reach);
    lines.extend(world.notes.iter().map(|note| ("note", note.clone())));
    format!("{}\n{}", title_of(world.problem.scene()), format_columns(&lines))
}

/// Returns the headline: the fraction of the cells with an IK solution that the tip reaches.
fn headline(reach: &Reach) -> String {
    let [reachable, unknown, unreachable, blocked] = reach.tally();
    let all = reachable + unknown + unreachable + blocked;
    if all == 0 {
        return "The tip reaches no cell: there is no IK solution for any centre of a cell".into();
    }
    let at_least = if unknown > 0 { "at least " } else { "" };
    format!("The tip reaches {at_least}{} of the arm's workspace", percent(reachable as f64 / all as f64))
}

fn view(world: &LoadedProblem, reach: &Reach) -> View {
    let [_, unknown, ..] = reach.tally();
    let joints = &world.problem.scene().arm().joints;
    let minus = |text: &str| text.replace('-', "\u{2212}");
    let value = |k: usize| match joints[k].joint_type.is_revolute() {
        true => format!("{} {}\u{b0}", joints[k].name, minus(&fixed(reach.home[k].to_degrees(), 1))),
        false => format!("{} {}", joints[k].name, minus(&length(reach.home[k]))),
    };
    let facts = [
        ("home", [0, 1].map(value).join(", ")),
        ("cells", format!("squares of {}; only the centre of each is judged", length(reach.cell))),
    ];
    let notes = world.notes.iter().map(|note| ["note".to_owned(), note.clone()]);
    let picture = Picture {
        title: vec![headline(reach), title_of(world.problem.scene())],
        status: if unknown == 0 { "every cell decided".into() } else { counted(unknown, "cell") + " unknown" },
        ending: Some(if unknown == 0 { Status::Found } else { Status::Unknown }),
        facts: facts.map(|(name, value)| [name.to_owned(), value]).into_iter().chain(notes).collect(),
        c_obstacles: &contours(world.problem.scene()),
        ..Picture::new(world.problem.scene(), world.problem.start())
    };
    View::of_picture(&picture).with_section(reach_section(reach, world.problem.scene().arm()))
}
