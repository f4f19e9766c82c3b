//! Texts as outlines. The font Inter is part of the program, so that pictures look alike on all machines.

use super::figure::Anchor;
use tiny_skia::{Path, PathBuilder};
use ttf_parser::gpos::{PairAdjustment, PositioningSubtable};
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// The font in both weights, ready for use.
pub struct Fonts {
    regular: Font,
    bold: Font,
}

impl Fonts {
    /// Returns the fonts that are part of the program.
    pub fn built_in() -> Self {
        let font = |bytes| Font(Face::parse(bytes, 0).expect("the built-in font can be read"));
        Self { regular: font(cplan_theme::PICTURE_FONT), bold: font(cplan_theme::BOLD_PICTURE_FONT) }
    }

    /// Returns the font of a weight.
    pub fn of(&self, is_bold: bool) -> &Font {
        if is_bold { &self.bold } else { &self.regular }
    }
}

/// The font in one weight.
pub struct Font(Face<'static>);

impl Font {
    /// Returns the outline of a line of text of this size, with its anchor at the place `[left, bottom]` of the page. `None` if
    /// no letter has an outline.
    pub fn outline(&self, text: &str, size: f32, anchor: Anchor, [left, bottom]: [f32; 2]) -> Option<Path> {
        let scale = size / f32::from(self.0.units_per_em());
        let glyphs = self.glyphs(text);
        let places = self.places(&glyphs);
        let width = places.last().copied().unwrap_or_default();
        let shift = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => width / 2.0,
            Anchor::End => width,
        };
        let mut pen = Pen { path: PathBuilder::new(), scale, origin: [0.0, bottom] };
        for (glyph, place) in glyphs.into_iter().zip(places) {
            pen.origin[0] = left + (place - shift) * scale;
            // Spaces have no outline.
            let _ = self.0.outline_glyph(glyph, &mut pen);
        }
        pen.path.finish()
    }

    /// Returns the width of a letter as a fraction of the font's height. `None` if the font lacks the letter.
    #[cfg(test)]
    pub fn letter_width(&self, letter: char) -> Option<f64> {
        let glyph = self.0.glyph_index(letter)?;
        Some(f64::from(self.0.glyph_hor_advance(glyph)?) / f64::from(self.0.units_per_em()))
    }

    /// Returns the glyphs of a text. Letters that the font lacks become boxes.
    fn glyphs(&self, text: &str) -> Vec<GlyphId> {
        text.chars().map(|letter| self.0.glyph_index(letter).unwrap_or_default()).collect()
    }

    /// Returns the position of each glyph, and the end of the last one, in units of the font.
    fn places(&self, glyphs: &[GlyphId]) -> Vec<f32> {
        let mut places = vec![0.0];
        let mut end = 0.0;
        for (k, &glyph) in glyphs.iter().enumerate() {
            end += f32::from(self.0.glyph_hor_advance(glyph).unwrap_or_default());
            end += glyphs.get(k + 1).map_or(0.0, |&next| f32::from(self.kern(glyph, next)));
            places.push(end);
        }
        places
    }

    /// Returns the kerning of a pair: the additional distance of the second glyph from the first, in units of the font. In each
    /// lookup, the first table that lists the pair counts.
    fn kern(&self, first: GlyphId, second: GlyphId) -> i16 {
        let lookups = self.0.tables().gpos.into_iter().flat_map(|table| table.lookups);
        let known = lookups.filter_map(|lookup| {
            lookup.subtables.into_iter::<PositioningSubtable>().find_map(|table| advance(&table, first, second))
        });
        known.sum()
    }
}

/// Returns a table's value for a pair of glyphs, or `None` if it does not list the pair.
fn advance(table: &PositioningSubtable, first: GlyphId, second: GlyphId) -> Option<i16> {
    let PositioningSubtable::Pair(pairs) = table else { return None };
    let index = pairs.coverage().get(first)?;
    let (of_first, _) = match pairs {
        PairAdjustment::Format1 { sets, .. } => sets.get(index)?.get(second)?,
        PairAdjustment::Format2 { classes, matrix, .. } => matrix.get((classes.0.get(first), classes.1.get(second)))?,
    };
    Some(of_first.x_advance)
}

/// A pen that converts outlines of glyphs to the page. The y axis points up in fonts, and down on pages.
struct Pen {
    path: PathBuilder,
    /// Pixels per unit of the font.
    scale: f32,
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

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.x(x), self.y(y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.x(x), self.y(y));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.path.quad_to(self.x(x1), self.y(y1), self.x(x), self.y(y));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.path.cubic_to(self.x(x1), self.y(y1), self.x(x2), self.y(y2), self.x(x), self.y(y));
    }

    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sides(text: &str, anchor: Anchor) -> [f32; 2] {
        let bounds = Fonts::built_in().regular.outline(text, 100.0, anchor, [500.0, 300.0]).unwrap().bounds();
        [bounds.left(), bounds.right()]
    }

    #[test]
    fn anchors_shift_texts() {
        let [start, middle, end] = [Anchor::Start, Anchor::Middle, Anchor::End].map(|anchor| sides("HH", anchor));
        assert!((500.0..520.0).contains(&start[0]) && (480.0..500.0).contains(&end[1]), "{start:?} {end:?}");
        assert!((middle[0] + middle[1] - 1000.0).abs() < 2.0, "{middle:?}");
    }

    /// Compares the position with HarfBuzz's result for this font, in which the second letter of "AV" overlaps the first.
    #[test]
    fn pairs_of_letters_are_kerned() {
        let Fonts { regular: font, .. } = Fonts::built_in();
        let width = |text: &str| *font.places(&font.glyphs(text)).last().unwrap();
        assert!(width("AV") < width("A") + width("V") - 20.0);
        assert_eq!(width("HH"), 2.0 * width("H"));
    }

    #[test]
    fn letters_that_the_font_lacks_are_boxes() {
        let Fonts { regular: font, .. } = Fonts::built_in();
        assert!(font.outline("\u{4e00}", 10.0, Anchor::Start, [0.0; 2]).is_some());
        assert!(font.outline(" ", 10.0, Anchor::Start, [0.0; 2]).is_none());
        assert!(font.outline("", 10.0, Anchor::Start, [0.0; 2]).is_none());
    }
}
