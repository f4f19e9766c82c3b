//! The neutral figure: what is drawn where, without a file format.

use super::color::{Rgb, WHITE};

/// A rectangle of the page, pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// The left side's distance from the left edge of the page.
    pub x: f64,
    /// The upper side's distance from the top of the page.
    pub y: f64,
    /// From the left side to the right one.
    pub width: f64,
    /// From the upper side to the lower one.
    pub height: f64,
}

impl Rect {
    /// The right side's distance from the left edge of the page.
    #[must_use]
    pub fn right(&self) -> f64 {
        self.x + self.width
    }

    /// The lower side's distance from the top of the page.
    #[must_use]
    pub fn bottom(&self) -> f64 {
        self.y + self.height
    }
}

/// One step of an outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// Begins a new piece.
    Move([f64; 2]),
    /// Straight on to a place.
    Line([f64; 2]),
    /// On a circle of this radius, by half a turn at most, counter-clockwise as seen on the page.
    Arc(f64, [f64; 2]),
    /// Back to the beginning of the piece.
    Close,
}

/// How a line is drawn: colour, width and dashes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pen {
    /// The colour of the line.
    pub color: Rgb,
    /// The width of the line, pixels.
    pub width: f64,
    /// Lengths of dashes and gaps in turn; empty for a solid line.
    pub dash: &'static [f64],
}

/// How an outline is drawn: filled by the non-zero rule, then stroked, and the whole made transparent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// Colour of the inside.
    pub fill: Option<Rgb>,
    /// Pen of the outline.
    pub pen: Option<Pen>,
    /// Stroke first and fill over it, so that of overlapping pieces only the common outline shows.
    pub pen_below: bool,
    /// 0 is invisible, 1 opaque.
    pub opacity: f64,
}

impl Style {
    /// An opaque line.
    #[must_use]
    pub fn line(color: Rgb, width: f64) -> Self {
        Self { fill: None, pen: Some(Pen { color, width, dash: &[] }), pen_below: false, opacity: 1.0 }
    }

    /// An opaque surface without outline.
    #[must_use]
    pub fn fill(color: Rgb) -> Self {
        Self { fill: Some(color), pen: None, pen_below: false, opacity: 1.0 }
    }

    /// The same with dashes.
    #[must_use]
    pub fn dashed(mut self, dash: &'static [f64]) -> Self {
        if let Some(pen) = &mut self.pen {
            pen.dash = dash;
        }
        self
    }

    /// The same with another inside.
    #[must_use]
    pub fn filled(mut self, color: Rgb) -> Self {
        self.fill = Some(color);
        self
    }

    /// The same with another opacity.
    #[must_use]
    pub fn faded(mut self, opacity: f64) -> Self {
        self.opacity = opacity;
        self
    }
}

/// Which point of a text its place names.
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
    /// The place at which the text is anchored.
    pub at: [f64; 2],
    /// What, any characters.
    pub text: String,
    /// Height of the font, pixels.
    pub size: f64,
    /// Which point of the text is `at`.
    pub anchor: Anchor,
    /// Whether it reads upwards, as beside a vertical axis.
    pub upwards: bool,
    /// The colour of the letters.
    pub color: Rgb,
}

/// Something that is drawn on the page.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// Lines and surfaces.
    Outline(Vec<Step>, Style),
    /// A disc: centre, radius and style.
    Disc([f64; 2], f64, Style),
    /// A line of text.
    Text(Label),
    /// Items of which only the part within the rectangle shows.
    Clip(Rect, Vec<Item>),
    /// A rectangle of coloured cells.
    Raster(Raster),
}

/// Cells in columns from left to right, each from the bottom up.
#[derive(Debug, Clone, PartialEq)]
pub struct Raster {
    /// Where the cells are.
    pub rect: Rect,
    /// Number of columns, number of cells in each.
    pub cells: [usize; 2],
    /// The colours in use.
    pub palette: Vec<Rgb>,
    /// For every cell an index into the palette, or nothing.
    pub levels: Vec<Option<usize>>,
}

/// A page; later items cover earlier ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// The page's width, pixels.
    pub width: f64,
    /// The page's height, pixels.
    pub height: f64,
    /// In drawing order.
    pub items: Vec<Item>,
}

/// The outline of an open (or closed) chain of spots; spots nearer than a quarter of a pixel to the one before are
/// left out, which no one can see and which keeps files small.
#[must_use]
pub fn chain(spots: impl IntoIterator<Item = [f64; 2]>, closed: bool) -> Vec<Step> {
    const INVISIBLE: f64 = 0.25;
    let mut steps = Vec::new();
    let mut kept: Option<[f64; 2]> = None;
    let mut skipped = None;
    for spot in spots {
        match kept {
            Some(last) if (spot[0] - last[0]).abs().max((spot[1] - last[1]).abs()) < INVISIBLE => {
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

/// Lines, visible on any ground by the broad pale one under each. Those come first, so that no line hides in the gaps of
/// another's dashes.
#[must_use]
pub fn lines(outlines: impl IntoIterator<Item = (Vec<Step>, Pen)>) -> Vec<Item> {
    let (mut halos, mut lines) = (Vec::new(), Vec::new());
    for (steps, pen) in outlines {
        halos.push(Item::Outline(steps.clone(), Style::line(WHITE, pen.width + 2.6).faded(0.85)));
        lines.push(Item::Outline(steps, Style { pen: Some(pen), ..Style::line(pen.color, pen.width) }));
    }
    halos.extend(lines);
    halos
}

/// A text that reads to the right.
#[must_use]
pub fn label(at: [f64; 2], text: impl Into<String>, size: f64, anchor: Anchor, color: Rgb) -> Item {
    Item::Text(Label { at, text: text.into(), size, anchor, upwards: false, color })
}

/// A text that reads upwards, about its middle.
#[must_use]
pub fn upwards(at: [f64; 2], text: impl Into<String>, size: f64, color: Rgb) -> Item {
    Item::Text(Label { at, text: text.into(), size, anchor: Anchor::Middle, upwards: true, color })
}

/// The outline of a rectangle.
#[must_use]
pub fn rectangle(rect: Rect) -> Vec<Step> {
    vec![
        Step::Move([rect.x, rect.y]),
        Step::Line([rect.right(), rect.y]),
        Step::Line([rect.right(), rect.bottom()]),
        Step::Line([rect.x, rect.bottom()]),
        Step::Close,
    ]
}

/// About how wide a text is, pixels: viewers choose their fonts, so typical advances (in units of the font's height)
/// must do.
#[must_use]
pub fn text_width(text: &str, size: f64) -> f64 {
    let advance = |c: char| match c {
        'i' | 'j' | 'l' | 'f' | 't' | 'r' | 'I' | ' ' | '.' | ',' | ':' | ';' | '\'' | '|' | '(' | ')' => 0.3,
        'm' | 'w' | 'M' | 'W' | '@' => 0.82,
        // East Asian characters fill a square.
        '\u{2e80}'.. => 1.0,
        c if c.is_uppercase() => 0.64,
        _ => 0.53,
    };
    text.chars().map(advance).sum::<f64>() * size
}

/// The text, or its beginning and an ellipsis if it is wider than `width` pixels.
#[must_use]
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
