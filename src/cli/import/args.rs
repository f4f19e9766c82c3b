//! The arguments of `cplan import`.

use super::layers::LayerHeight;
use crate::cli::print_args::PrintArgs;
use crate::cli::query_args::QueryArgs;
use crate::grammar::{finite, number_in, positive};
use clap::{Args, ValueHint};
use cplan_drawing::{FINEST, Settings, Unit};
use std::path::PathBuf;

/// Make a world of a drawing: DXF, SVG or GeoJSON.
#[derive(Debug, Args)]
#[command(after_help = "\
What is closed is solid, what is open is a thin wall, and what cannot be taken is told. NAME is a layer, or the name of something drawn:
in DXF of a block, in SVG of an element or a group, in GeoJSON of a feature; or one that the world gives, such as \"feeder 2\".
The drawing is scaled, then turned, then moved.

Examples:
  cplan import workspaces/drawings/cell.dxf --output cell.toml --picture cell.svg
  cplan import workspaces/drawings/cell.dxf --layer fence --layer conveyor --height conveyor=0:0.2 --start 0.4,0.5 --goal 2,-0.5
  cplan import workspaces/drawings/bench.svg --output bench.toml --move 0.1,-0.3 --turn 90deg
  cplan import workspaces/drawings/hall.geojson --output hall.toml --walls hall --json

Exit codes: 0 the world is written, 1 bad input or I/O, 2 wrong command line.")]
pub struct ImportArgs {
    /// The drawing: .dxf (as text), .svg, .geojson or .json.
    #[arg(value_name = "DRAWING", value_hint = ValueHint::FilePath)]
    pub drawing: PathBuf,
    /// Write the world: .toml; by default it is printed.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Draw what was read: .svg, .png, .gif or .html. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub picture: Vec<PathBuf>,
    /// Take only this, even if its layer is switched off. Can be repeated.
    #[arg(long, value_name = "NAME")]
    pub layer: Vec<String>,
    /// Leave this out, such as what lies where the arm's base is. Can be repeated.
    #[arg(long, value_name = "NAME")]
    pub without: Vec<String>,
    /// Where it is along the plane's normal, metres, such as conveyor=0:0.2. Can be repeated.
    #[arg(long, value_name = "NAME=LOW:HIGH")]
    pub height: Vec<LayerHeight>,
    /// Its closed outlines are thin walls, too, not solid: the border of a room. Can be repeated.
    #[arg(long, value_name = "NAME")]
    pub walls: Vec<String>,
    /// Unit of the drawing's numbers instead of what it says: mm, cm, dm, m, km, um, mil, in, ft, yd or px.
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<Unit>,
    /// Greatest distance of curves from their chords, and of ends that meet, metres.
    #[arg(long, value_name = "METRES", value_parser = tolerance, default_value_t = Settings::default().tolerance)]
    pub tolerance: f64,
    /// Scale it about its origin.
    #[arg(long, value_name = "FACTOR", value_parser = positive, default_value_t = 1.0)]
    pub scale: f64,
    /// Turn it about its origin, radians or such as 90deg.
    #[arg(long, value_name = "ANGLE", value_parser = angle, allow_hyphen_values = true, default_value_t = 0.0)]
    pub turn: f64,
    /// Move it, metres: where the drawing's origin comes to lie.
    #[arg(long = "move", value_name = "x,y", value_parser = displacement, allow_hyphen_values = true)]
    pub shift: Option<[f64; 2]>,
    #[command(flatten)]
    pub query: QueryArgs,
    #[command(flatten)]
    pub print: PrintArgs,
}

impl ImportArgs {
    /// Returns the drawing's name, without folder and extension.
    pub(super) fn title(&self) -> String {
        self.drawing.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    number_in(text, |x| x.is_finite() && x >= FINEST, &format!("of metres, finite and at least {FINEST}"))
}

/// Longest move, metres: drawings hold coordinates of half of this.
const LONGEST_MOVE: f64 = 2e12;

fn displacement(text: &str) -> Result<[f64; 2], String> {
    let (x, y) = text.split_once(',').ok_or("expected two numbers separated by a comma, such as -0.4,1")?;
    let length = |text: &str| {
        number_in(text.trim(), |x| x.abs() <= LONGEST_MOVE, &format!("of metres, {LONGEST_MOVE:e} at most"))
    };
    Ok([length(x)?, length(y)?])
}

fn angle(text: &str) -> Result<f64, String> {
    match text.strip_suffix("deg") {
        Some(degrees) => Ok(finite(degrees.trim_end())?.to_radians()),
        None => finite(text),
    }
}
