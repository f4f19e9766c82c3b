//! The figure: items at places on the page, for any file format.

#[cfg(feature = "png")]
use super::DrawError;
use super::letter_widths::letter_width;
use cplan_theme::{Rgb, WHITE, on_dark};

/// A rectangle of the page, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// Distance of the left side from the left edge of the page.
    pub x: f64,
    /// Distance of the upper side from the top of the page.
    pub y: f64,
    /// Distance between the left and the right side.
    pub width: f64,
    /// Distance between the upper and the lower side.
    pub height: f64,
}

impl Rect {
    /// Returns the distance of the right side from the left edge of the page.
    pub fn right(&self) -> f64 {
        self.x + self.width
    }

    /// Returns the distance of the lower side from the top of the page.
    pub fn bottom(&self) -> f64 {
        self.y + self.height
    }
}

/// One step of an outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// Begins a new piece.
    Move([f64; 2]),
    /// A straight line to a place.
    Line([f64; 2]),
    /// An arc of this radius to a place: at most half a turn, counter-clockwise as seen on the page.
    Arc(f64, [f64; 2]),
    /// A line back to the beginning of the piece.
    Close,
}

/// Colour, width and dashes of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pen {
    /// Colour of the line.
    pub color: Rgb,
    /// Width of the line, in pixels.
    pub width: f64,
    /// Lengths of dashes and gaps in turn; empty for a solid line.
    pub dash: &'static [f64],
}

/// Style of an outline. It is filled by the non-zero rule and stroked; then opacity applies to the result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// Colour of the inside.
    pub fill: Option<Rgb>,
    /// Pen of the outline.
    pub pen: Option<Pen>,
    /// True to draw the fill over the pen. If pieces overlap, only their common outline is then visible.
    pub pen_below: bool,
    /// Opacity: 0 is invisible, 1 is opaque.
    pub opacity: f64,
}

impl Style {
    /// Returns the style of an opaque line.
    pub fn line(color: Rgb, width: f64) -> Self {
        Self { fill: None, pen: Some(Pen { color, width, dash: &[] }), pen_below: false, opacity: 1.0 }
    }

    /// Returns the style of an opaque surface without outline.
    pub fn fill(color: Rgb) -> Self {
        Self { fill: Some(color), pen: None, pen_below: false, opacity: 1.0 }
    }

    /// Returns this style with dashes.
    #[must_use]
    pub fn dashed(mut self, dash: &'static [f64]) -> Self {
        if let Some(pen) = &mut self.pen {
            pen.dash = dash;
        }
        self
    }

    /// Returns this style with another fill.
    #[must_use]
    pub fn filled(mut self, color: Rgb) -> Self {
        self.fill = Some(color);
        self
    }

    /// Returns this style with another opacity.
    #[must_use]
    pub fn faded(mut self, opacity: f64) -> Self {
        self.opacity = opacity;
        self
    }
}

/// Point of a text that lies at the text's place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Left end of the baseline.
    Start,
    /// Middle of the baseline.
    Middle,
    /// Right end of the baseline.
    End,
}

/// A line of text.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// Place of the anchor on the page.
    pub at: [f64; 2],
    /// The text; any characters are allowed.
    pub text: String,
    /// Height of the font, in pixels.
    pub size: f64,
    /// Point of the text that lies at `at`.
    pub anchor: Anchor,
    /// True if the text reads upwards, as beside a vertical axis.
    pub upwards: bool,
    /// Colour of the letters.
    pub color: Rgb,
    /// True if a pale line around the letters keeps them legible on any ground.
    pub has_halo: bool,
    /// True for bold letters.
    pub is_bold: bool,
}

impl Label {
    /// Returns the width of the text in the built-in font, in pixels.
    pub fn width(&self) -> f64 {
        if self.is_bold { bold_text_width(&self.text, self.size) } else { text_width(&self.text, self.size) }
    }
}

/// An item of a figure.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// Lines and surfaces.
    Outline(Vec<Step>, Style),
    /// A disc: centre, radius and style.
    Disc([f64; 2], f64, Style),
    /// A line of text.
    Text(Label),
    /// Items that are cut to the rectangle.
    Clip(Rect, Vec<Item>),
    /// A rectangle of coloured cells.
    Raster(Raster),
    /// Items of the path with this index, which a page can light up.
    OfPath(usize, Vec<Item>),
    /// Items with a name, which viewers show when the pointer is on them.
    Titled(String, Vec<Item>),
}

/// Cells in columns from left to right, each from the bottom up.
#[derive(Debug, Clone, PartialEq)]
pub struct Raster {
    /// Rectangle that the cells fill.
    pub rect: Rect,
    /// Number of columns, and number of cells in each.
    pub cells: [usize; 2],
    /// Colours in use.
    pub palette: Vec<Rgb>,
    /// Index into the palette for each cell, or `None` for no colour.
    pub levels: Vec<Option<usize>>,
}

impl Raster {
    /// Divides the cells into rectangles for each colour. A rectangle has its first column, the number of rows between its lower
    /// side and the bottom of the raster, its width and its height, in cells. Consecutive cells of one colour in a column form a
    /// rectangle, which equal rectangles in the next columns extend.
    pub(crate) fn rectangles(&self) -> Vec<Vec<[usize; 4]>> {
        let [columns, rows] = self.cells;
        let mut rectangles = vec![Vec::new(); self.palette.len()];
        let mut taken = vec![false; self.levels.len()];
        for i in 0..columns {
            let mut j = 0;
            while j < rows {
                let level = self.levels[i * rows + j];
                let begin = j;
                j += 1;
                let Some(level) = level.filter(|_| !taken[i * rows + begin]) else { continue };
                let free = |i: usize, j: usize| self.levels[i * rows + j] == Some(level) && !taken[i * rows + j];
                while j < rows && free(i, j) {
                    j += 1;
                }
                let mut end = i + 1;
                while end < columns && (begin..j).all(|j| free(end, j)) {
                    end += 1;
                }
                for i in i..end {
                    taken[i * rows + begin..i * rows + j].fill(true);
                }
                rectangles[level].push([i, begin, end - i, j - begin]);
            }
        }
        rectangles
    }
}

/// A page. Items that are added later cover earlier ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Width of the page, in pixels.
    pub width: f64,
    /// Height of the page, in pixels.
    pub height: f64,
    /// Items in drawing order.
    pub items: Vec<Item>,
    /// True for a dark background. The colours of items are those on a light background; writers replace them.
    pub is_dark: bool,
}

impl Figure {
    /// Returns the figure for a dark background, or for a light one.
    #[must_use]
    pub fn on_background(self, is_dark: bool) -> Self {
        Self { is_dark, ..self }
    }

    /// Returns the figure as an SVG document.
    pub fn svg(&self) -> String {
        super::svg_writer::write(self)
    }

    /// Returns the figure as a PNG file with `scale` pixels for each of its own.
    ///
    /// # Errors
    /// [`DrawError::Scale`] if the scale is not a positive number of a sensible size.
    #[cfg(feature = "png")]
    pub fn png(&self, scale: f64) -> Result<Vec<u8>, DrawError> {
        let pixels = super::rasterizer::Rasterizer::new().picture(self, scale)?;
        pixels.encode_png().map_err(|error| DrawError::Png(error.to_string()))
    }

    /// Returns the figure as a GIF with a single picture of this width.
    ///
    /// # Errors
    /// The errors of [`Figure::png`].
    #[cfg(feature = "png")]
    pub fn gif(&self, width: f64) -> Result<Vec<u8>, DrawError> {
        super::gif_writer::still(self, width)
    }

    /// Returns the colour that stands for `color` on the background of this figure.
    pub fn shown(&self, color: Rgb) -> Rgb {
        if self.is_dark { on_dark(color) } else { color }
    }
}

/// Returns the outline of a chain of places, which may be closed. Skips places nearer than a quarter of a pixel to the one
/// before: the difference is invisible, and files stay small.
pub fn chain(spots: impl IntoIterator<Item = [f64; 2]>, closed: bool) -> Vec<Step> {
    const MIN_VISIBLE_SIZE: f64 = 0.25;
    let mut steps = Vec::new();
    let mut kept: Option<[f64; 2]> = None;
    let mut skipped = None;
    for spot in spots {
        match kept {
            Some(last) if (spot[0] - last[0]).abs().max((spot[1] - last[1]).abs()) < MIN_VISIBLE_SIZE => {
                skipped = Some(spot);
            }
            _ => {
                steps.push(if steps.is_empty() { Step::Move(spot) } else { Step::Line(spot) });
                (kept, skipped) = (Some(spot), None);
            }
        }
    }
    if closed {
        if !steps.is_empty() {
            steps.push(Step::Close);
        }
    } else {
        steps.extend(skipped.map(Step::Line));
    }
    steps
}

/// Draws lines that are visible on any ground: each lies on a broader pale line. All pale lines come first, so that none of them
/// hides another line.
pub fn lines(outlines: impl IntoIterator<Item = (Vec<Step>, Pen)>) -> Vec<Item> {
    let (mut halos, mut lines) = (Vec::new(), Vec::new());
    for (steps, pen) in outlines {
        halos.push(Item::Outline(steps.clone(), Style::line(WHITE, pen.width + 2.6).faded(0.85)));
        lines.push(Item::Outline(steps, Style { pen: Some(pen), ..Style::line(pen.color, pen.width) }));
    }
    halos.extend(lines);
    halos
}

/// Draws the same as [`lines`], in groups by path. The paths with the indices `top` lie above the others, the first of them
/// topmost. Each path also has a broad invisible line, which makes it easy to point at.
pub fn lines_by_path(outlines: impl IntoIterator<Item = (Vec<Step>, Pen)>, top: &[usize]) -> Vec<Item> {
    const POINTER_WIDTH: f64 = 14.0;
    let (mut halos, mut drawn) = (Vec::new(), Vec::new());
    for (index, (steps, pen)) in outlines.into_iter().enumerate() {
        let pointed = Item::Outline(steps.clone(), Style::line(pen.color, POINTER_WIDTH).faded(0.0));
        let mut both = lines([(steps, pen)]).into_iter();
        halos.extend(both.next().map(|halo| Item::OfPath(index, vec![halo])));
        drawn.push((index, Item::OfPath(index, both.chain([pointed]).collect())));
    }
    drawn.sort_by_key(|(index, _)| top.iter().rev().position(|other| other == index).map_or(0, |place| place + 1));
    halos.extend(drawn.into_iter().map(|(_, item)| item));
    halos
}

/// Returns a text that reads to the right.
pub fn label(at: [f64; 2], text: impl Into<String>, size: f64, anchor: Anchor, color: Rgb) -> Item {
    Item::Text(Label { at, text: text.into(), size, anchor, upwards: false, color, has_halo: false, is_bold: false })
}

/// Returns a bold text that reads to the right.
pub fn bold(at: [f64; 2], text: impl Into<String>, size: f64, anchor: Anchor, color: Rgb) -> Item {
    Item::Text(Label { at, text: text.into(), size, anchor, upwards: false, color, has_halo: false, is_bold: true })
}

/// Creates a text that reads upwards, centred at its place.
pub fn upwards(at: [f64; 2], text: impl Into<String>, size: f64, color: Rgb) -> Item {
    let (text, anchor) = (text.into(), Anchor::Middle);
    Item::Text(Label { at, text, size, anchor, upwards: true, color, has_halo: false, is_bold: false })
}

/// Returns the outline of a rectangle.
pub fn rectangle(rect: Rect) -> Vec<Step> {
    vec![
        Step::Move([rect.x, rect.y]),
        Step::Line([rect.right(), rect.y]),
        Step::Line([rect.right(), rect.bottom()]),
        Step::Line([rect.x, rect.bottom()]),
        Step::Close,
    ]
}

/// Returns the width of a text of this size in the built-in font, in pixels. For letters that are not Latin, it is an estimate.
pub fn text_width(text: &str, size: f64) -> f64 {
    width(text, size, false)
}

/// Does the same as [`text_width`] for bold letters.
pub fn bold_text_width(text: &str, size: f64) -> f64 {
    width(text, size, true)
}

fn width(text: &str, size: f64, is_bold: bool) -> f64 {
    let advance = |c: char| match (letter_width(c, is_bold), c) {
        (Some(width), _) => width,
        // East Asian characters fill a square.
        (None, '\u{2e80}'..) => 1.0,
        (None, _) => 0.6,
    };
    text.chars().map(advance).sum::<f64>() * size
}

/// Returns the text, or its beginning and an ellipsis if it is wider than `width` pixels.
pub fn shortened(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let mut kept = String::new();
    for c in text.chars() {
        kept.push(c);
        if text_width(&kept, size) + size > width {
            break;
        }
    }
    kept.push('\u{2026}');
    kept
}
