//! SVG documents as pixels, and as PNG.

use super::DrawError;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::Database;
use resvg::usvg::{Options, Tree};
use std::sync::Arc;

/// Greatest side of a picture, in pixels: this fits a 16-bit format, and needs at most 1 GB.
const LARGEST: f64 = 16_384.0;

/// A converter of SVG documents to pixels. It uses the font Ubuntu Light, which is part of the program. It ignores the
/// fonts of the machine, so that pictures look alike everywhere.
pub struct Rasteriser(Options<'static>);

impl Rasteriser {
    /// Creates a rasteriser with its font.
    pub fn new() -> Self {
        let mut options = Options { font_family: "Ubuntu".to_owned(), ..Options::default() };
        let fonts = Arc::make_mut(&mut options.fontdb);
        fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
        for set_family in [Database::set_serif_family, Database::set_sans_serif_family, Database::set_monospace_family]
        {
            set_family(fonts, "Ubuntu");
        }
        Self(options)
    }

    /// Returns the pixels of a document, `scale` pixels per unit.
    pub fn pixels(&self, svg: &str, scale: f64) -> Result<Pixmap, DrawError> {
        drawn(&self.tree(svg)?, scale)
    }

    /// Returns the pixels of a document, `width` pixels wide.
    pub fn wide(&self, svg: &str, width: f64) -> Result<Pixmap, DrawError> {
        let tree = self.tree(svg)?;
        drawn(&tree, width / f64::from(tree.size().width()))
    }

    fn tree(&self, svg: &str) -> Result<Tree, DrawError> {
        Tree::from_str(svg, &self.0).map_err(|e| DrawError::Svg(e.to_string()))
    }
}

fn drawn(tree: &Tree, scale: f64) -> Result<Pixmap, DrawError> {
    let mut pixels = blank([tree.size().width(), tree.size().height()].map(f64::from), scale)?;
    resvg::render(tree, Transform::from_scale(scale as f32, scale as f32), &mut pixels.as_mut());
    Ok(pixels)
}

/// Returns an empty picture of this size in units, `scale` pixels per unit.
pub fn blank(units: [f64; 2], scale: f64) -> Result<Pixmap, DrawError> {
    let [width, height] = units.map(|side| side * scale);
    let fits = |side: f64| side.is_finite() && (1.0..=LARGEST).contains(&side);
    let size = (fits(width) && fits(height)).then(|| Pixmap::new(width.round() as u32, height.round() as u32));
    size.flatten().ok_or(DrawError::Scale(scale))
}

/// Rasterises an SVG document, `scale` pixels per unit.
pub fn write(svg: &str, scale: f64) -> Result<Vec<u8>, DrawError> {
    Rasteriser::new().pixels(svg, scale)?.encode_png().map_err(|e| DrawError::Png(e.to_string()))
}
