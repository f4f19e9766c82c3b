//! SVG to PNG.

use super::DrawError;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};
use std::sync::Arc;

/// Greatest side of a picture, pixels: what a 16-bit format can take, and 1 GB at most.
const LARGEST: f64 = 16_384.0;

/// Rasterises an SVG document, `scale` pixels a unit. Text is set in Ubuntu Light, which is part of the program: no
/// font of the machine is asked for, so that pictures look alike everywhere.
pub fn write(svg: &str, scale: f64) -> Result<Vec<u8>, DrawError> {
    let mut options = Options { font_family: "Ubuntu".to_owned(), ..Options::default() };
    let fonts = Arc::make_mut(&mut options.fontdb);
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    for set_family in [
        resvg::usvg::fontdb::Database::set_serif_family,
        resvg::usvg::fontdb::Database::set_sans_serif_family,
        resvg::usvg::fontdb::Database::set_monospace_family,
    ] {
        set_family(fonts, "Ubuntu");
    }
    let tree = Tree::from_str(svg, &options).map_err(|e| DrawError::Svg(e.to_string()))?;
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| f64::from(side) * scale);
    let fits = |side: f64| side.is_finite() && (1.0..=LARGEST).contains(&side);
    let size = (fits(width) && fits(height)).then(|| Pixmap::new(width.round() as u32, height.round() as u32));
    let mut pixels = size.flatten().ok_or(DrawError::Scale(scale))?;
    resvg::render(&tree, Transform::from_scale(scale as f32, scale as f32), &mut pixels.as_mut());
    pixels.encode_png().map_err(|e| DrawError::Png(e.to_string()))
}
