//! `cplan import`: converts a drawing to a world.

mod advice;
mod args;
mod layers;
mod obstacles;
mod world_file;

pub use args::ImportArgs;

use super::exit::DONE;
use super::failure::Failure;
use super::fresh::word;
use super::outputs::{Outputs, refuse_to_overwrite_inputs};
use super::sinks;
use crate::input::{self, Diagnostic, Position, Source, World};
use crate::output::format_columns;
use crate::text::{counted, plain_line};
use crate::view::{self, Figure};
use cplan_drawing::{Drawing, Format, Note, Settings};
use layers::Layers;
use obstacles::{ImportedObstacle, Placement};
use serde::Serialize;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// The result of an import, as JSON.
#[derive(Serialize)]
struct Json<'a> {
    /// Always `imported`.
    status: &'static str,
    drawing: String,
    output: Option<String>,
    obstacles: Vec<Entry<'a>>,
    /// Parts of the drawing that were left out or changed.
    notes: &'a [String],
    /// The text of the world. `None` if the world is written to a file.
    #[serde(skip_serializing_if = "Option::is_none")]
    world: Option<&'a str>,
}

/// An obstacle, and the part of the drawing from which it was made.
#[derive(Serialize)]
struct Entry<'a> {
    name: &'a str,
    layer: Option<&'a str>,
    kind: &'a str,
    line: Option<usize>,
    height: Option<[f64; 2]>,
}

impl<'a> From<&'a ImportedObstacle> for Entry<'a> {
    fn from(ImportedObstacle { name, shape }: &'a ImportedObstacle) -> Self {
        let layer = shape.layer.as_deref();
        Self { name, layer, kind: &shape.kind, line: shape.line, height: shape.height }
    }
}

/// Reads the drawing and writes the world.
///
/// # Errors
/// A drawing that cannot be read, or without any obstacle; I/O.
pub fn run(args: &ImportArgs) -> Result<u8, Failure> {
    let format = Format::from_path(&args.drawing).ok_or_else(|| {
        let file = args.drawing.display();
        Failure::Usage(format!("{file}: a drawing's name must end in .dxf, .svg, .geojson or .json"))
    })?;
    if let (Some(least), Some(most)) = (args.min_size, args.max_size)
        && least > most
    {
        return Err(Failure::Usage(format!("--min-size {least} is larger than --max-size {most}")));
    }
    let outputs = outputs(args)?;
    let bytes = input::read_bytes(&args.drawing)?;
    refuse_to_overwrite_inputs(outputs.paths(), std::slice::from_ref(&args.drawing))?;
    let settings = Settings { tolerance: args.tolerance, unit: args.unit, scale: args.scale };
    let drawing = cplan_drawing::read(&bytes, format, &settings).map_err(|error| {
        let position = error.line.map(|line| Position { line, column: 1 });
        refused(args, Diagnostic { position, ..Diagnostic::new("", error.message).help(error.cure) })
    })?;
    let Drawing { shapes, mut notes } = drawing;
    let shift = args.shift.unwrap_or_default();
    let placement = Placement { turn: args.turn, shift };
    let found = obstacles::obstacles_of_drawing(shapes, &placement, &mut notes);
    let layers = Layers {
        only: &args.layer,
        without: &args.without,
        heights: &args.height,
        walls: &args.walls,
        sizes: [args.min_size, args.max_size],
        tolerance: args.tolerance,
    };
    layers.check(&found)?;
    let taken = layers.chosen(found, &mut notes);
    obstacles::within_reach(&taken, placement.shift).map_err(|diagnostic| refused(args, diagnostic))?;
    advice::note(&taken, &mut notes);
    let known: HashSet<Vec<String>> = taken.iter().map(|taken| taken.shape.called()).collect();
    let is_told = |names: &[String]| layers.selects(names) || known.contains(names);
    let notes: Vec<String> = notes.of(is_told).iter().map(Note::to_string).collect();
    if taken.is_empty() {
        let cure = match (args.without.is_empty(), args.min_size.or(args.max_size)) {
            (_, Some(_)) => "choose another --min-size or --max-size",
            (true, None) => "draw outlines as closed polylines, lines, arcs or circles, or choose layers with --layer",
            (false, None) => "use fewer --without options",
        };
        let why: Vec<String> = notes.iter().map(|note| format!("; {note}")).collect();
        let message = format!("this drawing contains no obstacle{}", why.concat());
        return Err(refused(args, Diagnostic::new("", message).help(cure)));
    }
    let text = world_file::text(args, &taken, &notes);
    let name = args.output.clone().unwrap_or_else(|| "the imported world".into());
    // Read the text back, so that the written world is valid, and the picture shows it as it will be read.
    let world = input::world_from(Source::in_memory(name, text.as_str()))?;
    let figure = || picture(args, &world, &taken);
    let page = || view::still_page(&args.title(), &figure());
    let file = args.output.iter().map(|path| (path.clone(), text.clone().into_bytes())).collect();
    let drawn = || figure().on_background(args.theme.is_dark());
    outputs.write_pictures(file, |format| Ok(format.bytes_of(drawn, page)?))?;
    report(args, &taken, &notes, &world, &text)?;
    Ok(DONE)
}

/// Checks the names of the outputs.
fn outputs(args: &ImportArgs) -> Result<Outputs, Failure> {
    let is_world = |path: &PathBuf| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
    if let Some(path) = args.output.as_ref().filter(|path| !is_world(path)) {
        return Err(Failure::Usage(format!("{}: a world's name must end in .toml", path.display())));
    }
    Outputs::of_pictures(&args.picture, args.output.clone())
}

/// Returns the failure for a diagnostic about the drawing, with the drawing's file name.
fn refused(args: &ImportArgs, diagnostic: Diagnostic) -> Failure {
    Failure::Input(Diagnostic { origin: args.drawing.display().to_string(), ..diagnostic }.into())
}

fn picture(args: &ImportArgs, world: &World, taken: &[ImportedObstacle]) -> Figure {
    let obstacles = &world.workspace.fixed.obstacles;
    let below = format!("{}: {}", args.drawing.display(), counted(obstacles.len(), "obstacle"));
    let layers: Vec<&str> = taken.iter().map(|taken| taken.shape.layer.as_deref().unwrap_or(&taken.name)).collect();
    view::obstacles(&[args.title(), below], obstacles, &layers)
}

/// Prints the result on stdout, or on stderr if the world goes to stdout.
fn report(
    args: &ImportArgs,
    taken: &[ImportedObstacle],
    notes: &[String],
    world: &World,
    text: &str,
) -> Result<(), Failure> {
    let json = || {
        sinks::pretty(&Json {
            status: "imported",
            drawing: args.drawing.display().to_string(),
            output: args.output.as_ref().map(|path| path.display().to_string()),
            obstacles: taken.iter().map(Entry::from).collect(),
            notes,
            world: args.output.is_none().then_some(text),
        })
    };
    if args.output.is_some() || args.print.json {
        return args.print.report(DONE, json, || summary(args, taken, notes, world));
    }
    args.print.print_status(summary(args, taken, notes, world).trim_end());
    sinks::print(text)
}

/// Describes how many obstacles were imported and left out, and the next command.
fn summary(args: &ImportArgs, taken: &[ImportedObstacle], notes: &[String], world: &World) -> String {
    let [x, y] = view::extent(&world.workspace.fixed.obstacles);
    let size = |(low, high): (f64, f64)| format!("{low:.3} to {high:.3}");
    let mut lines = vec![
        ("drawing", format!("{}: {}", args.drawing.display(), counted(taken.len(), "obstacle"))),
        ("extent", format!("x {} m, y {} m", size(x), size(y))),
    ];
    lines.extend(layers::lines(taken).into_iter().map(|line| ("layer", line)));
    lines.extend(notes.iter().map(|note| ("note", plain_line(note).into_owned())));
    let outputs = args.output.iter().chain(&args.picture);
    lines.extend(outputs.map(|path| ("file", path.display().to_string())));
    if let Some(path) = &args.output {
        lines.push(("next", next(args, path)));
    }
    format_columns(&lines)
}

/// Returns the command that plans in the imported world. Values that the user must fill in are in capitals.
fn next(args: &ImportArgs, path: &Path) -> String {
    let query = &args.query;
    let start = if query.start.is_none() { " --start Q1,Q2" } else { "" };
    let goal = if query.goal.is_none() && query.goal_tip.is_none() { " --goal-tip X,Y" } else { "" };
    format!("cplan ROBOT.urdf {}{start}{goal}", word(path))
}
