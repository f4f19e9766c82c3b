//! Paints SVG documents with the elements that this program writes: groups with clips and transforms, paths, circles,
//! rectangles and lines of text. It refuses all other elements, so that no part of a picture is lost unnoticed.

use super::DrawError;
use super::figure::Anchor;
use super::letters::Fonts;
use super::svg_writer::BOLD_WEIGHT;
use roxmltree::Node;
use std::str::FromStr;
use svgtypes::{SimplePathSegment, SimplifyingPathParser};
use tiny_skia::{
    Color, FillRule, IntRect, LineJoin, Mask, Paint, Path, PathBuilder, Pixmap, PixmapPaint, Rect, Stroke, StrokeDash,
    Transform,
};

/// Paints an element and those within it.
pub fn paint(fonts: &Fonts, element: Node, transform: Transform, pixels: &mut Pixmap) -> Result<(), DrawError> {
    let own: svgtypes::Transform = optional(element, "transform")?.unwrap_or_default();
    let [a, b, c, d, e, f] = [own.a, own.b, own.c, own.d, own.e, own.f].map(|value| value as f32);
    let transform = transform.pre_concat(Transform::from_row(a, b, c, d, e, f));
    let path = match element.tag_name().name() {
        "svg" | "g" => return group(fonts, element, transform, pixels),
        "defs" | "title" => return Ok(()),
        "path" => outline(element)?,
        "circle" => PathBuilder::from_circle(number(element, "cx")?, number(element, "cy")?, number(element, "r")?),
        "rect" => rectangle(element)?.map(PathBuilder::from_rect),
        "text" => text(fonts, element)?,
        other => return Err(DrawError::Svg(format!("cplan draws no pictures with an element <{other}>"))),
    };
    // A path without length has no outline, so nothing is drawn.
    if let Some(path) = path {
        Shape::new(element, path)?.paint(transform, pixels);
    }
    Ok(())
}

fn group(fonts: &Fonts, element: Node, transform: Transform, pixels: &mut Pixmap) -> Result<(), DrawError> {
    let children = |transform, pixels: &mut Pixmap| {
        element.children().filter(Node::is_element).try_for_each(|child| paint(fonts, child, transform, pixels))
    };
    let Some(clip) = clip(element)? else { return children(transform, pixels) };
    let mut painted = Ok(());
    on_layer(clip, transform, 1.0, pixels, |transform, layer| {
        painted = children(transform, layer);
        if let Some(mut mask) = Mask::new(layer.width(), layer.height()) {
            mask.fill_path(&PathBuilder::from_rect(clip), FillRule::Winding, true, transform);
            layer.apply_mask(&mask);
        }
    });
    painted
}

/// Returns the rectangle that a group is cut to. `None` if the group is not cut.
fn clip(group: Node) -> Result<Option<Rect>, DrawError> {
    let Some(value) = group.attribute("clip-path") else { return Ok(None) };
    let id = value.strip_prefix("url(#").and_then(|rest| rest.strip_suffix(')'));
    let named = |node: &Node| {
        node.has_tag_name((node.tag_name().namespace().unwrap_or_default(), "clipPath")) && node.attribute("id") == id
    };
    let path = group.document().descendants().find(named);
    path.and_then(|path| path.first_element_child()).ok_or_else(|| unreadable(group, "clip-path")).and_then(rectangle)
}

/// Draws on a separate layer, which is then laid over the page. The layer covers only the area within `bounds`.
fn on_layer(
    bounds: Rect,
    transform: Transform,
    opacity: f32,
    pixels: &mut Pixmap,
    draw: impl FnOnce(Transform, &mut Pixmap),
) {
    // Smoothing extends edges by up to a pixel.
    let reach = bounds.transform(transform).and_then(|bounds| bounds.outset(2.0, 2.0)?.round_out());
    let page = IntRect::from_xywh(0, 0, pixels.width(), pixels.height());
    let Some(place) = reach.zip(page).and_then(|(reach, page)| reach.intersect(&page)) else { return };
    let Some(mut layer) = Pixmap::new(place.width(), place.height()) else { return };
    draw(transform.post_translate(-(place.x() as f32), -(place.y() as f32)), &mut layer);
    let paint = PixmapPaint { opacity, ..PixmapPaint::default() };
    pixels.draw_pixmap(place.x(), place.y(), layer.as_ref(), &paint, Transform::identity(), None);
}

/// A path with its style.
struct Shape {
    path: Path,
    fill: Option<Color>,
    stroke: Option<(Color, Stroke)>,
    /// True if the fill is drawn over the line.
    is_stroked_first: bool,
    opacity: f32,
    is_smooth: bool,
}

impl Shape {
    fn new(element: Node, path: Path) -> Result<Self, DrawError> {
        let stroke = match color(element, "stroke")? {
            Some(color) => Some((color, stroke(element)?)),
            None => None,
        };
        Ok(Self {
            path,
            fill: color(element, "fill")?,
            stroke,
            is_stroked_first: inherited_property(element, "paint-order") == Some("stroke"),
            opacity: optional(element, "opacity")?.unwrap_or(1.0),
            is_smooth: inherited_property(element, "shape-rendering") != Some("crispEdges"),
        })
    }

    fn paint(&self, transform: Transform, pixels: &mut Pixmap) {
        if self.opacity >= 1.0 {
            return self.paint_opaque(transform, pixels);
        }
        let half = self.stroke.as_ref().map_or(0.0, |(_, stroke)| stroke.width / 2.0);
        if let Some(bounds) = self.path.bounds().outset(half, half) {
            on_layer(bounds, transform, self.opacity, pixels, |transform, layer| self.paint_opaque(transform, layer));
        }
    }

    fn paint_opaque(&self, transform: Transform, pixels: &mut Pixmap) {
        let paint_of = |color| {
            let mut paint = Paint { anti_alias: self.is_smooth, ..Paint::default() };
            paint.set_color(color);
            paint
        };
        let fill = |pixels: &mut Pixmap| {
            if let Some(color) = self.fill {
                pixels.fill_path(&self.path, &paint_of(color), FillRule::Winding, transform, None);
            }
        };
        if !self.is_stroked_first {
            fill(pixels);
        }
        if let Some((color, stroke)) = &self.stroke {
            pixels.stroke_path(&self.path, &paint_of(*color), stroke, transform, None);
        }
        if self.is_stroked_first {
            fill(pixels);
        }
    }
}

fn stroke(element: Node) -> Result<Stroke, DrawError> {
    let width = inherited_property(element, "stroke-width").map_or(Ok(1.0), str::parse);
    let dashes = inherited_property(element, "stroke-dasharray").unwrap_or_default().split_whitespace().map(str::parse);
    let dashes: Vec<f32> = dashes.collect::<Result<_, _>>().map_err(|_| unreadable(element, "stroke-dasharray"))?;
    let is_round = inherited_property(element, "stroke-linejoin") == Some("round");
    Ok(Stroke {
        width: width.map_err(|_| unreadable(element, "stroke-width"))?,
        line_join: if is_round { LineJoin::Round } else { LineJoin::Miter },
        dash: StrokeDash::new(dashes, 0.0),
        ..Stroke::default()
    })
}

fn outline(element: Node) -> Result<Option<Path>, DrawError> {
    let mut path = PathBuilder::new();
    for segment in SimplifyingPathParser::from(element.attribute("d").unwrap_or_default()) {
        let number = |value: f64| value as f32;
        match segment.map_err(|_| unreadable(element, "d"))? {
            SimplePathSegment::MoveTo { x, y } => path.move_to(number(x), number(y)),
            SimplePathSegment::LineTo { x, y } => path.line_to(number(x), number(y)),
            SimplePathSegment::Quadratic { x1, y1, x, y } => {
                path.quad_to(number(x1), number(y1), number(x), number(y));
            }
            SimplePathSegment::CurveTo { x1, y1, x2, y2, x, y } => {
                path.cubic_to(number(x1), number(y1), number(x2), number(y2), number(x), number(y));
            }
            SimplePathSegment::ClosePath => path.close(),
        }
    }
    Ok(path.finish())
}

fn rectangle(element: Node) -> Result<Option<Rect>, DrawError> {
    let [x, y] = ["x", "y"].map(|name| optional(element, name).map(Option::unwrap_or_default));
    Ok(Rect::from_xywh(x?, y?, number(element, "width")?, number(element, "height")?))
}

fn text(fonts: &Fonts, element: Node) -> Result<Option<Path>, DrawError> {
    let anchor = match inherited_property(element, "text-anchor") {
        Some("middle") => Anchor::Middle,
        Some("end") => Anchor::End,
        _ => Anchor::Start,
    };
    let size = inherited_property(element, "font-size").and_then(|size| size.parse().ok());
    let size: f32 = size.ok_or_else(|| unreadable(element, "font-size"))?;
    // SVG does not show spaces at the ends, and shows several spaces in a row as one.
    let words: Vec<&str> =
        element.text().unwrap_or_default().split([' ', '\n']).filter(|word| !word.is_empty()).collect();
    let is_bold = inherited_property(element, "font-weight") == Some(BOLD_WEIGHT);
    Ok(fonts.of(is_bold).outline(&words.join(" "), size, anchor, [number(element, "x")?, number(element, "y")?]))
}

/// Returns a property of an element or of the nearest group around it that has it.
fn inherited_property<'a>(element: Node<'a, '_>, name: &str) -> Option<&'a str> {
    element.ancestors().find_map(|node| node.attribute(name))
}

fn color(element: Node, name: &str) -> Result<Option<Color>, DrawError> {
    match inherited_property(element, name) {
        None | Some("none") => Ok(None),
        Some(value) => {
            let color = svgtypes::Color::from_str(value).map_err(|_| unreadable(element, name))?;
            Ok(Some(Color::from_rgba8(color.red, color.green, color.blue, color.alpha)))
        }
    }
}

/// Returns a number that an element must have.
pub fn number(element: Node, name: &str) -> Result<f32, DrawError> {
    optional(element, name)?.ok_or_else(|| unreadable(element, name))
}

fn optional<T: FromStr>(element: Node, name: &str) -> Result<Option<T>, DrawError> {
    element.attribute(name).map(str::parse).transpose().map_err(|_| unreadable(element, name))
}

fn unreadable(element: Node, name: &str) -> DrawError {
    let value = inherited_property(element, name).unwrap_or_default();
    DrawError::Svg(format!("{name}=\"{value}\" of <{}> cannot be read", element.tag_name().name()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Paints a page of 20 by 20 units, each of them one pixel.
    fn painted(content: &str) -> Result<Pixmap, DrawError> {
        let svg =
            format!("<svg xmlns=\"http://www.w3.org/2000/svg\" fill=\"#ff0000\" font-size=\"10\">{content}</svg>");
        let document = roxmltree::Document::parse(&svg).unwrap();
        let mut pixels = Pixmap::new(20, 20).unwrap();
        paint(&Fonts::built_in(), document.root_element(), Transform::identity(), &mut pixels).map(|()| pixels)
    }

    /// Returns red, green, blue and alpha of a pixel.
    fn at(pixels: &Pixmap, x: u32, y: u32) -> [u8; 4] {
        let color = pixels.pixel(x, y).unwrap();
        [color.red(), color.green(), color.blue(), color.alpha()]
    }

    const RED: [u8; 4] = [255, 0, 0, 255];
    const BLUE: [u8; 4] = [0, 0, 255, 255];
    const NOTHING: [u8; 4] = [0; 4];

    #[test]
    fn clips_cut_what_is_in_their_group() {
        let pixels = painted(
            "<defs><clipPath id=\"clip0\"><rect x=\"5\" y=\"5\" width=\"5\" height=\"5\"/></clipPath></defs>\
             <g clip-path=\"url(#clip0)\"><rect width=\"20\" height=\"20\"/></g>",
        );
        let pixels = pixels.unwrap();
        assert_eq!([at(&pixels, 7, 7), at(&pixels, 9, 9)], [RED; 2]);
        assert_eq!([at(&pixels, 4, 7), at(&pixels, 10, 7), at(&pixels, 7, 12)], [NOTHING; 3]);
        assert!(painted("<g clip-path=\"url(#clip1)\"/>").is_err());
    }

    /// Checks that, where line and fill overlap, only the upper of the two is visible, at any opacity of the shape.
    #[test]
    fn opacity_is_that_of_the_whole() {
        let disc = |order| {
            let style = format!("stroke=\"#0000ff\" stroke-width=\"8\" opacity=\"0.5\" {order}");
            painted(&format!("<circle cx=\"10\" cy=\"10\" r=\"6\" {style}/>")).unwrap()
        };
        // The middle of the fill, the inner half of the line, its outer half.
        let [above, below] =
            [disc(""), disc("paint-order=\"stroke\"")].map(|pixels| [10, 5, 2].map(|x| at(&pixels, x, 10)));
        assert_eq!(above, [[128, 0, 0, 128], [0, 0, 128, 128], [0, 0, 128, 128]]);
        assert_eq!(below, [[128, 0, 0, 128], [128, 0, 0, 128], [0, 0, 128, 128]]);
    }

    #[test]
    fn transforms_dashes_and_colours_are_those_of_the_document() {
        let line = "<path d=\"M0 10H20\" stroke=\"#0000ff\" stroke-width=\"4\" stroke-dasharray=\"4 4\"/>";
        let pixels =
            painted(&format!("<g transform=\"translate(2 0)\">{line}</g><path fill=\"none\" d=\"M0 0h2v2h-2z\"/>"))
                .unwrap();
        assert_eq!([3, 7, 11].map(|x| at(&pixels, x, 10)), [BLUE, NOTHING, BLUE]);
        assert_eq!(at(&pixels, 1, 1), NOTHING);
    }

    /// Tests that a text turns about its anchor. It reads upwards from the middle of the lower edge.
    #[test]
    fn texts_turn_about_their_anchor() {
        let pixels = painted("<text x=\"10\" y=\"20\" transform=\"rotate(-90 10 20)\">\nll\n</text>").unwrap();
        let inked = (0..400).filter(|k| at(&pixels, k % 20, k / 20) != NOTHING);
        let (columns, rows): (Vec<u32>, Vec<u32>) = inked.map(|k| (k % 20, k / 20)).unzip();
        assert!(
            !columns.is_empty() && columns.iter().all(|&x| x <= 10) && rows.iter().all(|&y| y >= 13),
            "{columns:?} {rows:?}"
        );
    }

    #[test]
    fn unsupported_svg_elements_are_refused() {
        for content in
            ["<image/>", "<circle r=\"1\"/>", "<path d=\"M0 0 X\"/>", "<path d=\"M0 0L9 9\" opacity=\"half\"/>"]
        {
            assert!(matches!(painted(content), Err(DrawError::Svg(_))), "{content}");
        }
        assert!(painted("<title>a word</title><path d=\"\"/><circle cx=\"1\" cy=\"1\" r=\"0\"/>").is_ok());
    }
}
