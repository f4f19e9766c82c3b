//! The arguments of `cplan import`.

use super::layers::LayerHeight;
use crate::cli::headings::OUTPUT;
use crate::cli::print_args::PrintArgs;
use crate::cli::query_args::QueryArgs;
use crate::cli::theme::ThemeArgs;
use crate::cli::values::{displacement, turn};
use crate::options::{number_in, positive};
use clap::{Args, ValueHint};
use cplan_drawing::{MIN_TOLERANCE, Settings, Unit};
use std::path::PathBuf;

/// Make a world file from a drawing: DXF, SVG or GeoJSON.
#[derive(Debug, Args)]
#[command(after_help = "\
Closed outlines become solid obstacles, open lines become thin walls, and cplan
reports all parts of the drawing that it leaves out. NAME is a layer, the name
of a part (a block in DXF, an element or a group in SVG, a feature in GeoJSON),
or a name in the new world, such as \"feeder 2\". The drawing is scaled, then
turned, then moved.

Examples:
  cplan import workspaces/drawings/cell.dxf --output cell.toml \\
    --picture cell.svg
  cplan import workspaces/drawings/cell.dxf --layer fence --layer conveyor \\
    --height conveyor=0:0.2 --start 0.4,0.5 --goal 2,-0.5
  cplan import workspaces/drawings/cell.dxf --min-size 0.1 --output large.toml
  cplan import workspaces/drawings/bench.svg --output bench.toml \\
    --move 0.1,-0.3 --turn 90deg
  cplan import workspaces/drawings/hall.geojson --output hall.toml \\
    --walls hall --json

Exit codes: 0 the world is written, 1 bad input or I/O, 2 wrong command line.")]
pub struct ImportArgs {
    /// Drawing: .dxf (as text), .svg, .geojson or .json.
    #[arg(value_name = "DRAWING", value_hint = ValueHint::FilePath)]
    pub drawing: PathBuf,
    /// Write the world file (.toml) instead of printing it.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub output: Option<PathBuf>,
    /// Draw the imported world: .svg, .png, .gif or .html. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub picture: Vec<PathBuf>,
    /// Import only this layer or part, even from a layer that is switched off. Can be repeated.
    #[arg(long, value_name = "NAME")]
    pub layer: Vec<String>,
    /// Ignore this layer or part, such as the arm's own base. Can be repeated.
    #[arg(long, value_name = "NAME")]
    pub without: Vec<String>,
    /// Ignore parts smaller than this, such as screws, metres. The size of a part is the longer side of its box along x
    /// and y.
    #[arg(long, value_name = "METRES", value_parser = positive)]
    pub min_size: Option<f64>,
    /// Ignore parts larger than this, such as the frame of the page, metres.
    #[arg(long, value_name = "METRES", value_parser = positive)]
    pub max_size: Option<f64>,
    /// Extent of a layer or part along the plane's normal, metres, such as conveyor=0:0.2. Can be repeated.
    #[arg(long, value_name = "NAME=LOW:HIGH")]
    pub height: Vec<LayerHeight>,
    /// Import closed outlines of this layer or part as thin walls, such as the border of a room. Can be repeated.
    #[arg(long, value_name = "NAME")]
    pub walls: Vec<String>,
    /// Unit of the drawing's numbers, instead of the unit that the file states: mm, cm, dm, m, km, um, mil, in, ft, yd
    /// or px.
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<Unit>,
    /// Greatest distance of a curve from its chords, and between line ends that are joined, metres.
    #[arg(long, value_name = "METRES", value_parser = tolerance, default_value_t = Settings::default().tolerance)]
    pub tolerance: f64,
    /// Factor by which the drawing is scaled about its origin.
    #[arg(long, value_name = "FACTOR", value_parser = positive, default_value_t = 1.0)]
    pub scale: f64,
    /// Angle by which the drawing is turned about its origin: radians, or degrees such as 90deg.
    #[arg(long, value_name = "ANGLE", value_parser = turn, allow_hyphen_values = true, default_value_t = 0.0)]
    pub turn: f64,
    /// New position of the drawing's origin, metres.
    #[arg(long = "move", value_name = "x,y", value_parser = displacement, allow_hyphen_values = true)]
    pub shift: Option<[f64; 2]>,
    #[command(flatten)]
    pub query: QueryArgs,
    #[command(flatten)]
    pub theme: ThemeArgs,
    #[command(flatten)]
    pub print: PrintArgs,
}

impl ImportArgs {
    /// Returns the file name of the drawing without extension.
    pub(super) fn title(&self) -> String {
        self.drawing.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    number_in(text, |x| x.is_finite() && x >= MIN_TOLERANCE, &format!("of metres, finite and at least {MIN_TOLERANCE}"))
}
