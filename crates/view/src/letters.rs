//! Texts as outlines, in Ubuntu Light. The font is part of the program: no font of the machine is asked for, so that pictures
//! look alike everywhere.

use super::figure::Anchor;
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::prelude::{FontRef, GlyphId, LocationRef, MetadataProvider, Size};
use skrifa::raw::tables::gpos::{PairPos, PositionSubtables};
use skrifa::raw::{ReadError, TableProvider};
use tiny_skia::{Path, PathBuilder};

/// The font, ready to set texts.
pub struct Font {
    font: FontRef<'static>,
    /// Tables of pairs of letters that stand closer together or further apart, by lookups. Of each lookup the first table
    /// that knows a pair counts.
    kerning: Vec<Vec<PairPos<'static>>>,
}

impl Font {
    /// The font that is part of the program.
    pub fn built_in() -> Self {
        let font = FontRef::new(epaint_default_fonts::UBUNTU_LIGHT).expect("the built-in font can be read");
        Self { kerning: kerning(&font).unwrap_or_default(), font }
    }

    /// The outline of a line of text of this size, which is anchored at this place of the page; nothing if no letter shows.
    pub fn outline(&self, text: &str, size: f32, anchor: Anchor, [left, bottom]: [f32; 2]) -> Option<Path> {
        let (metrics, letters) = (self.font.metrics(Size::unscaled(), LocationRef::default()), self.font.charmap());
        let glyphs: Vec<GlyphId> = text.chars().map(|letter| letters.map(letter).unwrap_or_default()).collect();
        let scale = size / f32::from(metrics.units_per_em);
        let places = self.places(&glyphs);
        let width = places.last().copied().unwrap_or_default();
        let shift = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => width / 2.0,
            Anchor::End => width,
        };
        let mut pen = Pen { path: PathBuilder::new(), scale, origin: [0.0, bottom] };
        let outlines = self.font.outline_glyphs();
        let settings = || DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
        for (glyph, place) in glyphs.into_iter().zip(places) {
            pen.origin[0] = left + (place - shift) * scale;
            // A letter that cannot be drawn is left out.
            let _ = outlines.get(glyph).map(|outline| outline.draw(settings(), &mut pen));
        }
        pen.path.finish()
    }

    /// Where each glyph begins, and where the last one ends, in units of the font.
    fn places(&self, glyphs: &[GlyphId]) -> Vec<f32> {
        let metrics = self.font.glyph_metrics(Size::unscaled(), LocationRef::default());
        let mut places = vec![0.0];
        let mut end = 0.0;
        for (k, &glyph) in glyphs.iter().enumerate() {
            end += metrics.advance_width(glyph).unwrap_or_default();
            end += glyphs.get(k + 1).map_or(0.0, |&next| f32::from(self.kern(glyph, next)));
            places.push(end);
        }
        places
    }

    /// How much further than usual the second glyph is from the first.
    fn kern(&self, first: GlyphId, second: GlyphId) -> i16 {
        self.kerning.iter().filter_map(|tables| tables.iter().find_map(|table| advance(table, first, second))).sum()
    }
}

/// All tables for pairs of letters.
fn kerning(font: &FontRef<'static>) -> Result<Vec<Vec<PairPos<'static>>>, ReadError> {
    let lookups = font.gpos()?.lookup_list()?.lookups();
    let tables = lookups.iter().map(|lookup| match lookup?.subtables()? {
        PositionSubtables::Pair(pairs) => pairs.iter().collect(),
        _ => Ok(Vec::new()),
    });
    tables.collect()
}

/// What a table says of a pair; nothing if it does not know the pair.
fn advance(table: &PairPos, first: GlyphId, second: GlyphId) -> Option<i16> {
    match table {
        PairPos::Format1(pairs) => {
            let set = pairs.pair_sets().get(usize::from(pairs.coverage().ok()?.get(first)?)).ok()?;
            let mut records = set.pair_value_records().iter().filter_map(Result::ok);
            records.find(|pair| GlyphId::from(pair.second_glyph()) == second)?.value_record1().x_advance()
        }
        PairPos::Format2(classes) => {
            classes.coverage().ok()?.get(first)?;
            let [row, column] = [classes.class_def1().ok()?.get(first), classes.class_def2().ok()?.get(second)];
            let row = classes.class1_records().get(usize::from(row)).ok()?;
            row.class2_records().get(usize::from(column)).ok()?.value_record1().x_advance()
        }
    }
}

/// Puts outlines of glyphs on the page: fonts count upwards, pages downwards.
struct Pen {
    path: PathBuilder,
    /// Pixels per unit of the font.
    scale: f32,
    /// Where the glyph's own origin is.
    origin: [f32; 2],
}

impl Pen {
    fn x(&self, x: f32) -> f32 {
        self.origin[0] + x * self.scale
    }

    fn y(&self, y: f32) -> f32 {
        self.origin[1] - y * self.scale
    }
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.x(x), self.y(y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.x(x), self.y(y));
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.path.quad_to(self.x(cx), self.y(cy), self.x(x), self.y(y));
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        self.path.cubic_to(self.x(cx0), self.y(cy0), self.x(cx1), self.y(cy1), self.x(x), self.y(y));
    }

    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sides(text: &str, anchor: Anchor) -> [f32; 2] {
        let bounds = Font::built_in().outline(text, 100.0, anchor, [500.0, 300.0]).unwrap().bounds();
        [bounds.left(), bounds.right()]
    }

    #[test]
    fn anchors_shift_texts() {
        let [start, middle, end] = [Anchor::Start, Anchor::Middle, Anchor::End].map(|anchor| sides("HH", anchor));
        assert!((500.0..520.0).contains(&start[0]) && (480.0..500.0).contains(&end[1]), "{start:?} {end:?}");
        assert!((middle[0] + middle[1] - 1000.0).abs() < 2.0, "{middle:?}");
    }

    /// As HarfBuzz does with this font: of the letters "AV" the second one overlaps the first.
    #[test]
    fn pairs_of_letters_are_kerned() {
        let font = Font::built_in();
        let width = |text: &str| {
            let glyphs: Vec<_> = text.chars().map(|letter| font.font.charmap().map(letter).unwrap()).collect();
            *font.places(&glyphs).last().unwrap()
        };
        assert!(width("AV") < width("A") + width("V") - 20.0);
        assert_eq!(width("HH"), 2.0 * width("H"));
    }

    #[test]
    fn letters_that_the_font_lacks_are_boxes() {
        let font = Font::built_in();
        assert!(font.outline("\u{4e00}", 10.0, Anchor::Start, [0.0; 2]).is_some());
        assert!(font.outline(" ", 10.0, Anchor::Start, [0.0; 2]).is_none());
        assert!(font.outline("", 10.0, Anchor::Start, [0.0; 2]).is_none());
    }
}
