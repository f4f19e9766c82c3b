//! Figures as pixels.

use super::DrawError;
use super::figure::{Figure, Item, Label, Pen, Raster, Step, Style};
use super::letters::Fonts;
use super::svg_writer::{HALO_WIDTH, MAX_COORDINATE};
use cplan_theme::{Rgb, WHITE};
use std::f64::consts::FRAC_PI_2;
use tiny_skia::{
    Color, FillRule, IntRect, LineJoin, Mask, Paint, Path, PathBuilder, Pixmap, PixmapPaint, Rect, Stroke, StrokeDash,
    Transform,
};

/// Greatest side of a picture, in pixels. It fits into 16 bits, and such a picture needs at most 1 GB.
const MAX_SIDE: f64 = 16_384.0;

/// A renderer of figures with the built-in font.
pub struct Rasterizer(Fonts);

impl Rasterizer {
    pub fn new() -> Self {
        Self(Fonts::built_in())
    }

    /// Returns the pixels of a figure on its background: `scale` times `scale` for each pixel of the page.
    pub fn picture(&self, figure: &Figure, scale: f64) -> Result<Pixmap, DrawError> {
        let mut pixels = blank(figure, scale)?;
        pixels.fill(shown(WHITE, figure));
        self.paint(&figure.items, figure, Transform::from_scale(scale as f32, scale as f32), &mut pixels);
        Ok(pixels)
    }

    fn paint(&self, items: &[Item], figure: &Figure, transform: Transform, pixels: &mut Pixmap) {
        for item in items {
            match item {
                Item::Outline(steps, style) => paint_shape(outline(steps), style, figure, transform, pixels),
                Item::Disc(center, radius, style) => {
                    let [x, y] = center.map(single);
                    paint_shape(PathBuilder::from_circle(x, y, *radius as f32), style, figure, transform, pixels);
                }
                Item::Text(label) => self.paint_text(label, figure, transform, pixels),
                Item::Raster(raster) => paint_cells(raster, figure, transform, pixels),
                Item::OfPath(_, items) | Item::Titled(_, items) => self.paint(items, figure, transform, pixels),
                Item::Clip(rect, items) => {
                    let [x, y, width, height] = [rect.x, rect.y, rect.width, rect.height].map(single);
                    let Some(clip) = Rect::from_xywh(x, y, width, height) else { continue };
                    on_layer(clip, transform, 1.0, pixels, |transform, layer| {
                        self.paint(items, figure, transform, layer);
                        if let Some(mut mask) = Mask::new(layer.width(), layer.height()) {
                            mask.fill_path(&PathBuilder::from_rect(clip), FillRule::Winding, true, transform);
                            layer.apply_mask(&mask);
                        }
                    });
                }
            }
        }
    }

    fn paint_text(&self, label: &Label, figure: &Figure, transform: Transform, pixels: &mut Pixmap) {
        // As in SVG, spaces at the ends are omitted, and several spaces in a row become one.
        let words: Vec<&str> = label.text.split([' ', '\n']).filter(|word| !word.is_empty()).collect();
        let [x, y] = label.at.map(single);
        let path = self.0.of(label.is_bold).outline(&words.join(" "), label.size as f32, label.anchor, [x, y]);
        let halo = Pen { color: WHITE, width: HALO_WIDTH, dash: &[] };
        let style = Style { pen: label.has_halo.then_some(halo), pen_below: true, ..Style::fill(label.color) };
        let turn = if label.upwards { Transform::from_rotate_at(-90.0, x, y) } else { Transform::identity() };
        paint_shape(path, &style, figure, transform.pre_concat(turn), pixels);
    }
}

/// Creates empty pixels for a figure.
fn blank(figure: &Figure, scale: f64) -> Result<Pixmap, DrawError> {
    let [width, height] = [figure.width, figure.height].map(|side| side * scale);
    let fits = |side: f64| side.is_finite() && (1.0..=MAX_SIDE).contains(&side);
    let size = (fits(width) && fits(height)).then(|| Pixmap::new(width.round() as u32, height.round() as u32));
    size.flatten().ok_or(DrawError::Scale(scale))
}

/// Returns the colour that stands for `color` on the background of a figure.
fn shown(color: Rgb, figure: &Figure) -> Color {
    let Rgb(red, green, blue) = figure.shown(color);
    Color::from_rgba8(red, green, blue, 255)
}

fn single(value: f64) -> f32 {
    value.clamp(-MAX_COORDINATE, MAX_COORDINATE) as f32
}

/// Returns an outline as a path; `None` if it has no length and is therefore invisible.
fn outline(steps: &[Step]) -> Option<Path> {
    let mut path = PathBuilder::new();
    let mut at = [0.0; 2];
    for step in steps {
        match *step {
            Step::Move(to) => path.move_to(single(to[0]), single(to[1])),
            Step::Line(to) => path.line_to(single(to[0]), single(to[1])),
            Step::Arc(radius, to) => add_arc(&mut path, at, radius, to),
            Step::Close => path.close(),
        }
        if let Step::Move(to) | Step::Line(to) | Step::Arc(_, to) = *step {
            at = to;
        }
    }
    path.finish()
}

/// Adds an arc as cubic curves of at most a quarter of a turn.
fn add_arc(path: &mut PathBuilder, from: [f64; 2], radius: f64, to: [f64; 2]) {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let half = dx.hypot(dy) / 2.0;
    if half == 0.0 {
        return;
    }
    // Rounding may make the radius of half a turn slightly too small.
    let radius = radius.max(half);
    let height = (radius * radius - half * half).sqrt() / (2.0 * half);
    let center = [(from[0] + to[0]) / 2.0 + height * dy, (from[1] + to[1]) / 2.0 - height * dx];
    let begin = (from[1] - center[1]).atan2(from[0] - center[0]);
    let turn = -2.0 * (half / radius).asin();
    let count = (turn.abs() / FRAC_PI_2).ceil().max(1.0);
    let handle = 4.0 / 3.0 * (turn / count / 4.0).tan();
    // The point at an angle, moved by `by` along the tangent there.
    let point = |angle: f64, by: f64| {
        let (sin, cos) = angle.sin_cos();
        [center[0] + radius * (cos - by * sin), center[1] + radius * (sin + by * cos)].map(single)
    };
    for k in 0..count as usize {
        let [a, b] = [k, k + 1].map(|k| begin + turn * k as f64 / count);
        let ([x1, y1], [x2, y2], [x, y]) = (point(a, handle), point(b, -handle), point(b, 0.0));
        path.cubic_to(x1, y1, x2, y2, x, y);
    }
}

/// Draws on a separate layer, which is then laid over the page. The layer is only as large as `bounds`.
fn on_layer(
    bounds: Rect,
    transform: Transform,
    opacity: f32,
    pixels: &mut Pixmap,
    draw: impl FnOnce(Transform, &mut Pixmap),
) {
    // Anti-aliasing extends edges by up to a pixel.
    let reach = bounds.transform(transform).and_then(|bounds| bounds.outset(2.0, 2.0)?.round_out());
    let page = IntRect::from_xywh(0, 0, pixels.width(), pixels.height());
    let Some(place) = reach.zip(page).and_then(|(reach, page)| reach.intersect(&page)) else { return };
    let Some(mut layer) = Pixmap::new(place.width(), place.height()) else { return };
    draw(transform.post_translate(-(place.x() as f32), -(place.y() as f32)), &mut layer);
    let paint = PixmapPaint { opacity, ..PixmapPaint::default() };
    pixels.draw_pixmap(place.x(), place.y(), layer.as_ref(), &paint, Transform::identity(), None);
}

fn paint_shape(path: Option<Path>, style: &Style, figure: &Figure, transform: Transform, pixels: &mut Pixmap) {
    let Some(path) = path else { return };
    if style.opacity >= 1.0 {
        return paint_opaque(&path, style, figure, transform, pixels);
    }
    let half = style.pen.map_or(0.0, |pen| pen.width / 2.0) as f32;
    if let Some(bounds) = path.bounds().outset(half, half) {
        on_layer(bounds, transform, style.opacity as f32, pixels, |transform, layer| {
            paint_opaque(&path, style, figure, transform, layer);
        });
    }
}

fn paint_opaque(path: &Path, style: &Style, figure: &Figure, transform: Transform, pixels: &mut Pixmap) {
    let stroke = |pixels: &mut Pixmap| {
        let Some(pen) = style.pen else { return };
        let stroke = Stroke {
            width: pen.width as f32,
            line_join: LineJoin::Round,
            dash: StrokeDash::new(pen.dash.iter().map(|&length| length as f32).collect(), 0.0),
            ..Stroke::default()
        };
        pixels.stroke_path(path, &paint_of(pen.color, figure), &stroke, transform, None);
    };
    if style.pen_below {
        stroke(pixels);
    }
    if let Some(color) = style.fill {
        pixels.fill_path(path, &paint_of(color, figure), FillRule::Winding, transform, None);
    }
    if !style.pen_below {
        stroke(pixels);
    }
}

fn paint_of(color: Rgb, figure: &Figure) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(shown(color, figure));
    paint
}

/// Paints cells without anti-aliasing, which would show seams between rectangles.
fn paint_cells(raster: &Raster, figure: &Figure, transform: Transform, pixels: &mut Pixmap) {
    let [columns, rows] = raster.cells.map(|count| count.max(1) as f32);
    let [x, y, width, height] = [raster.rect.x, raster.rect.y, raster.rect.width, raster.rect.height].map(single);
    let transform = transform.pre_translate(x, y).pre_scale(width / columns, height / rows);
    for (rectangles, color) in raster.rectangles().iter().zip(&raster.palette) {
        let mut path = PathBuilder::new();
        for rectangle in rectangles {
            let [i, j, w, h] = rectangle.map(|count| count as f32);
            Rect::from_xywh(i, rows - j - h, w, h).into_iter().for_each(|rect| path.push_rect(rect));
        }
        let paint = Paint { anti_alias: false, ..paint_of(*color, figure) };
        if let Some(path) = path.finish() {
            pixels.fill_path(&path, &paint, FillRule::Winding, transform, None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::{Anchor, Rect as PageRect, rectangle, upwards};

    const RED: Rgb = Rgb(255, 0, 0);
    const BLUE: Rgb = Rgb(0, 0, 255);
    const NOTHING: [u8; 4] = [0; 4];

    /// Paints a page of 20 by 20 pixels without a background.
    fn painted(items: Vec<Item>) -> Pixmap {
        let figure = Figure { width: 20.0, height: 20.0, items, is_dark: false };
        let mut pixels = blank(&figure, 1.0).unwrap();
        Rasterizer::new().paint(&figure.items, &figure, Transform::identity(), &mut pixels);
        pixels
    }

    /// Returns red, green, blue and alpha of a pixel.
    fn at(pixels: &Pixmap, x: u32, y: u32) -> [u8; 4] {
        let color = pixels.pixel(x, y).unwrap();
        [color.red(), color.green(), color.blue(), color.alpha()]
    }

    #[test]
    fn clips_cut_their_items() {
        let whole = PageRect { x: 0.0, y: 0.0, width: 20.0, height: 20.0 };
        let clip = PageRect { x: 5.0, y: 5.0, width: 5.0, height: 5.0 };
        let pixels = painted(vec![Item::Clip(clip, vec![Item::Outline(rectangle(whole), Style::fill(RED))])]);
        assert_eq!([at(&pixels, 7, 7), at(&pixels, 9, 9)], [[255, 0, 0, 255]; 2]);
        assert_eq!([at(&pixels, 4, 7), at(&pixels, 10, 7), at(&pixels, 7, 12)], [NOTHING; 3]);
    }

    /// Checks that, where line and fill overlap, only the upper one is visible, whatever the opacity.
    #[test]
    fn opacity_is_that_of_the_whole() {
        let style = Style::line(BLUE, 8.0).filled(RED).faded(0.5);
        let disc = |pen_below| painted(vec![Item::Disc([10.0, 10.0], 6.0, Style { pen_below, ..style })]);
        // The middle of the fill, the inner half of the line, its outer half.
        let [above, below] = [disc(false), disc(true)].map(|pixels| [10, 5, 2].map(|x| at(&pixels, x, 10)));
        assert_eq!(above, [[128, 0, 0, 128], [0, 0, 128, 128], [0, 0, 128, 128]]);
        assert_eq!(below, [[128, 0, 0, 128], [128, 0, 0, 128], [0, 0, 128, 128]]);
    }

    #[test]
    fn lines_are_dashed() {
        let line = vec![Step::Move([2.0, 10.0]), Step::Line([20.0, 10.0])];
        let pixels = painted(vec![Item::Outline(line, Style::line(BLUE, 4.0).dashed(&[4.0, 4.0]))]);
        assert_eq!([3, 7, 11].map(|x| at(&pixels, x, 10)), [[0, 0, 255, 255], NOTHING, [0, 0, 255, 255]]);
    }

    /// Compares two half turns with a disc of the same radius, and a quarter turn with its middle.
    #[test]
    fn arcs_turn_counter_clockwise() {
        let ring =
            vec![Step::Move([16.0, 10.0]), Step::Arc(6.0, [4.0, 10.0]), Step::Arc(6.0, [16.0, 10.0]), Step::Close];
        let [arcs, disc] = [Item::Outline(ring, Style::fill(RED)), Item::Disc([10.0; 2], 6.0, Style::fill(RED))]
            .map(|item| painted(vec![item]));
        let apart = arcs.data().iter().zip(disc.data()).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
        // A pixel has 16 samples.
        assert!(apart <= 16, "{apart}");
        let quarter = vec![Step::Move([18.0, 10.0]), Step::Arc(8.0, [10.0, 2.0])];
        let pixels = painted(vec![Item::Outline(quarter, Style::line(RED, 2.0))]);
        assert_eq!(at(&pixels, 15, 4)[3], 255, "the arc bulges to the upper right");
        assert_eq!(at(&pixels, 12, 7), NOTHING);
    }

    /// Checks that a text turns about its anchor. It reads upwards, centred at the middle of the right side.
    #[test]
    fn texts_turn_about_their_anchor() {
        let Item::Text(label) = upwards([10.0, 20.0], "ll", 10.0, RED) else { panic!("a text") };
        let pixels = painted(vec![Item::Text(Label { anchor: Anchor::Start, ..label })]);
        let inked = (0..400).filter(|k| at(&pixels, k % 20, k / 20) != NOTHING);
        let (columns, rows): (Vec<u32>, Vec<u32>) = inked.map(|k| (k % 20, k / 20)).unzip();
        assert!(
            !columns.is_empty() && columns.iter().all(|&x| x <= 10) && rows.iter().all(|&y| y >= 13),
            "{columns:?} {rows:?}"
        );
    }
}
