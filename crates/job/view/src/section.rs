//! Sections: parts of pictures and pages that companion crates contribute.

use super::axes::Frame;
use super::chart::Chart;
use super::figure::{Item, Raster, Rect, Style};
use super::key::{Key, Layered, Sign};
use cplan_geometry::Point;
use cplan_model::space::Configuration;
use cplan_theme::Rgb;
use serde::Serialize;
use serde::ser::{Error, SerializeMap, Serializer};
use serde_json::value::RawValue;

/// Radius of a dot, in pixels.
const DOT_RADIUS: f64 = 1.1;

/// A part of a picture or page that a companion crate contributes. Pages get data and a script that shows them; pictures get
/// cells and dots.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Section {
    /// Key under which the page finds the data.
    pub name: &'static str,
    /// Data, as JSON.
    pub data: String,
    /// Script of pages with this section.
    pub script: &'static str,
    /// Name of the start configuration. `None` for the usual one.
    pub start: Option<&'static str>,
    /// Cells of the workspace, drawn below everything else.
    pub cells: Option<CellLayer>,
    /// Dots in the configuration space, each with its colour.
    pub dots: Vec<(Configuration, Rgb)>,
    /// Legend: colours, with their meanings.
    pub legend: Vec<(Rgb, String)>,
    /// Names of the page's layers that the legend explains.
    pub layers: &'static [&'static str],
}

/// Square cells of the workspace in some colours.
#[derive(Debug, Clone, PartialEq)]
pub struct CellLayer {
    /// Corner of the first cell with the least coordinates.
    pub corner: Point,
    /// Side of the cells, in metres.
    pub side: f64,
    /// Number of cells along x and along y.
    pub size: [usize; 2],
    /// Colours.
    pub palette: Vec<Rgb>,
    /// Index of the colour of each cell, column by column from the left, each from the bottom up. `None` for a cell that is not drawn.
    pub colors: Vec<Option<usize>>,
}

impl Section {
    /// Creates a section with this name and data.
    ///
    /// # Panics
    /// If the data have keys that are no strings.
    pub fn of_data(name: &'static str, data: &impl Serialize) -> Self {
        Self { name, data: serde_json::to_string(data).expect("the keys are strings"), ..Self::default() }
    }

    pub(crate) fn in_workspace(&self, frame: &Frame) -> Option<Item> {
        let CellLayer { corner, side, size, palette, colors } = self.cells.as_ref()?;
        let [left, bottom] = frame.at(corner.x, corner.y);
        let [right, top] = frame.at(corner.x + side * size[0] as f64, corner.y + side * size[1] as f64);
        let rect = Rect { x: left, y: top, width: right - left, height: bottom - top };
        Some(Item::Raster(Raster { rect, cells: *size, palette: palette.clone(), levels: colors.clone() }))
    }

    pub(crate) fn in_cspace(&self, chart: &Chart) -> impl Iterator<Item = Item> {
        self.dots.iter().map(|&(q, color)| Item::Disc(chart.place(q), DOT_RADIUS, Style::fill(color)))
    }

    pub(crate) fn keys(&self) -> impl Iterator<Item = Layered> {
        let key = |(color, meaning): &(Rgb, String)| -> Key { (Sign::Swatch(*color), meaning.clone()) };
        self.legend.iter().map(move |entry| (key(entry), self.layers))
    }
}

/// Serialises sections as a map from their names to their data.
pub fn by_name<S: Serializer>(sections: &[Section], serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(sections.len()))?;
    for section in sections {
        map.serialize_entry(section.name, &RawValue::from_string(section.data.clone()).map_err(S::Error::custom)?)?;
    }
    map.end()
}
