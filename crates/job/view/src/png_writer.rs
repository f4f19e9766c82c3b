//! SVG documents as pixels, and as PNG.

use super::DrawError;
use super::letters::Fonts;
use super::svg_painter::paint;
use tiny_skia::{Pixmap, Transform};

/// Greatest side of a picture, in pixels. It fits into 16 bits, and a picture of this size needs at most 1 GB.
const MAX_SIDE: f64 = 16_384.0;

/// A renderer of SVG documents to pixels. It uses the font that is part of the program.
pub struct Rasterizer(Fonts);

impl Rasterizer {
    /// Creates a rasteriser with its font.
    pub fn new() -> Self {
        Self(Fonts::built_in())
    }

    /// Returns the pixels of a document, `scale` pixels per unit.
    pub fn pixels(&self, svg: &str, scale: f64) -> Result<Pixmap, DrawError> {
        self.drawn(svg, |_| scale)
    }

    /// Returns the pixels of a document, scaled to `width` pixels.
    pub fn rasterize(&self, svg: &str, width: f64) -> Result<Pixmap, DrawError> {
        self.drawn(svg, |units| width / units)
    }

    /// Returns the pixels of a document at a scale that depends on the document's width.
    fn drawn(&self, svg: &str, scale: impl FnOnce(f64) -> f64) -> Result<Pixmap, DrawError> {
        let document = roxmltree::Document::parse(svg).map_err(|e| DrawError::Svg(e.to_string()))?;
        let root = document.root_element();
        let units = view_size(root)?;
        let scale = scale(units[0]);
        let mut pixels = blank(units, scale)?;
        paint(&self.0, root, Transform::from_scale(scale as f32, scale as f32), &mut pixels)?;
        Ok(pixels)
    }
}

/// Returns the width and the height of a document in its own units.
fn view_size(root: roxmltree::Node) -> Result<[f64; 2], DrawError> {
    let sides = root.attribute("viewBox").map(|text| text.split_whitespace().map(str::parse).collect());
    match sides.and_then(|sides: Result<Vec<f64>, _>| sides.ok()).as_deref() {
        Some(&[0.0, 0.0, width, height]) => Ok([width, height]),
        _ => Err(DrawError::Svg("a picture needs a viewBox that begins at 0 0".into())),
    }
}

/// Creates empty pixels for a size in units.
pub fn blank(units: [f64; 2], scale: f64) -> Result<Pixmap, DrawError> {
    let [width, height] = units.map(|side| side * scale);
    let fits = |side: f64| side.is_finite() && (1.0..=MAX_SIDE).contains(&side);
    let size = (fits(width) && fits(height)).then(|| Pixmap::new(width.round() as u32, height.round() as u32));
    size.flatten().ok_or(DrawError::Scale(scale))
}

/// Rasterises an SVG document, `scale` pixels per unit.
pub fn write(svg: &str, scale: f64) -> Result<Vec<u8>, DrawError> {
    Rasterizer::new().pixels(svg, scale)?.encode_png().map_err(|e| DrawError::Png(e.to_string()))
}
