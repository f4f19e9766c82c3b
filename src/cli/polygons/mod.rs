//! `cplan polygons`: reports whether two polygons meet, how deep, and their Minkowski difference.

mod findings;
mod reader;
mod report;

use super::exit::DONE;
use super::failure::Failure;
use super::headings::OUTPUT;
use super::outputs::{Outputs, refuse_to_overwrite_inputs};
use super::print_args::PrintArgs;
use super::sinks;
use super::theme::ThemeArgs;
use super::values::turn;
use crate::view::{self, PolygonPair};
use clap::{Args, ValueHint};
use findings::Findings;
use std::path::PathBuf;

/// Report if two polygons meet, how deep, and their difference.
///
/// The report states the three conditions of the penetration test: a corner of A in B, a corner of B in A, and sides
/// that cross. It also states the Minkowski difference B - A, the area in which A's origin is if A meets B.
#[derive(Debug, Args)]
#[command(after_help = "\
A polygon is the name of a file, or a list of corners. A file has one corner per
line (x,y or x y; # begins a comment), or is TOML with the key
polygon = [[x, y], ...]. Corners are listed in order, in either direction.
Comparisons are exact, and touching counts as contact.

Examples:
  cplan polygons \"0,0 1,0 1,1\" \"0.5,0.5 2,0.5 2,2\"
  cplan polygons \"-3,-1 3,-1 3,1 -3,1\" \"-1,-3 1,-3 1,3 -1,3\" \\
    --picture bars.svg
  cplan polygons \"0,0 2,0 2,1 0,1\" \"5,0 6,0 6,3 5,3\" --turn 30deg --json

Exit codes: 0 the polygons were compared, whether they meet or not, 1 bad input
or I/O, 2 wrong command line.")]
pub struct PolygonsArgs {
    /// The polygon that moves: a file, or corners such as "0,0 1,0 1,1".
    #[arg(value_name = "A", allow_hyphen_values = true, value_hint = ValueHint::FilePath)]
    a: String,
    /// The obstacle: a file, or corners.
    #[arg(value_name = "B", allow_hyphen_values = true, value_hint = ValueHint::FilePath)]
    b: String,
    /// First turn A about the origin by this angle, radians or degrees (30deg).
    #[arg(long, value_name = "ANGLE", value_parser = turn, allow_hyphen_values = true)]
    turn: Option<f64>,
    /// Draw both polygons, and their difference with the origin: .svg, .png or .html. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    picture: Vec<PathBuf>,
    #[command(flatten)]
    theme: ThemeArgs,
    #[command(flatten)]
    print: PrintArgs,
}

/// Compares two polygons, and prints the report.
///
/// # Errors
/// Bad input and I/O. Polygons that are apart are no error.
pub fn run(args: &PolygonsArgs) -> Result<u8, Failure> {
    let outputs = Outputs::of_pictures(&args.picture, [])?;
    let a = reader::read(&args.a, "A")?;
    let b = reader::read(&args.b, "B")?;
    let inputs: Vec<PathBuf> = [&a, &b].into_iter().filter_map(|given| given.file.clone()).collect();
    refuse_to_overwrite_inputs(outputs.paths(), &inputs)?;
    let a = match args.turn {
        Some(angle) => a.turned(angle)?,
        None => a,
    };
    let findings = Findings::new(&a, &b);
    let pair = PolygonPair {
        title: vec!["Two polygons and their Minkowski difference".to_owned(), report::verdict(&findings)],
        a: a.polygon.corners(),
        b: b.polygon.corners(),
        difference: &findings.parts,
    };
    let page = || view::still_page(&pair.title[0], &view::polygon_pair(&pair));
    let figure = || view::polygon_pair(&pair).on_background(args.theme.is_dark());
    outputs.write_pictures(vec![], |format| Ok(format.bytes_of(figure, page)?))?;
    args.print.report(DONE, || sinks::pretty(&findings), || report::text(&findings))?;
    Ok(DONE)
}
