//! Reads SVG. Filled shapes become solid, and open shapes with only a stroke become walls.

mod path;
mod strokes;
mod style;

pub(crate) use strokes::read as read_strokes;

use crate::Stroke;
use crate::curve::Ellipse;
use crate::map::Map;
use crate::sheet::{Origin, Sheet};
use crate::{Drawing, Error, Point, Settings, Unit};
use path::{Outline, Stretch, outlines};
use roxmltree::{Document, Node, ParsingOptions};
use simplecss::StyleSheet;
use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;
use std::str::FromStr;
use style::Style;
use svgtypes::{Align, AspectRatio, Length, LengthUnit, PointsParser, Transform, ViewBox};

/// Greatest depth of nested elements.
const MAX_ELEMENT_DEPTH: usize = 128;
/// Greatest number of elements. Elements that a `use` draws count each time.
const MAX_ELEMENTS: usize = 1 << 20;
const SVG_NAMESPACE: &str = "http://www.w3.org/2000/svg";
const XLINK_NAMESPACE: &str = "http://www.w3.org/1999/xlink";
const INKSCAPE_NAMESPACE: &str = "http://www.inkscape.org/namespaces/inkscape";

/// Reads an SVG. The origin is the lower left corner of the page.
///
/// # Errors
/// If the text is not XML (with its line) or not SVG.
pub(crate) fn read(text: &str, settings: &Settings) -> Result<Drawing, Error> {
    Ok(sheet_and_strokes(text, settings, None)?.0.finish())
}

/// Reads an SVG: the shapes, or the exact outlines if `strokes` has a list for them.
fn sheet_and_strokes(
    text: &str,
    settings: &Settings,
    strokes: Option<Vec<Stroke>>,
) -> Result<(Sheet, Vec<Stroke>), Error> {
    const SAVE_HINT: &str = "save the drawing again, as a plain SVG";
    if text.trim().is_empty() {
        return Err(Error::new(None, "the file is empty", SAVE_HINT));
    }
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|error| {
        let (line, message) = (error.pos().row as usize, error.to_string());
        let message = message.split(" at ").next().unwrap_or_default();
        Error::new(line, format!("this is not well-formed XML: {message}"), SAVE_HINT)
    })?;
    let root = document.root_element();
    if !is_svg(root) || root.tag_name().name() != "svg" {
        let message = format!("this is not an SVG file: the root element is <{}>", root.tag_name().name());
        return Err(Error::new(1, message, "give an .svg file"));
    }
    let mut styles = StyleSheet::new();
    let sheets = document.descendants().filter(|node| node.has_tag_name((SVG_NAMESPACE, "style")));
    sheets.filter_map(|node| node.text()).for_each(|text| styles.parse_more(text));
    let ends = text.bytes().zip(0..).filter(|(byte, _)| *byte == b'\n').map(|(_, at)| at).collect();
    let ids = document.descendants().filter_map(|node| Some((node.attribute("id")?, node))).collect();
    let mut reader = Reader { ends, ids, styles, sheet: Sheet::new(settings), strokes, elements: 0, groups: 0 };
    let inside = reader.page(root, settings)?;
    reader.children(root, &inside, 0)?;
    Ok((reader.sheet, reader.strokes.unwrap_or_default()))
}

fn is_svg(node: Node) -> bool {
    node.is_element() && node.tag_name().namespace().is_none_or(|space| space == SVG_NAMESPACE)
}

/// Properties that an element inherits from the elements around it.
#[derive(Debug, Clone)]
struct InheritedProperties {
    map: Map,
    style: Style,
    /// Name for elements without a name: that of the enclosing group, or of the `use` element that shows them.
    name: Option<String>,
    is_used: bool,
    layer: Option<String>,
    /// Size of the page in the units of its coordinates, for percentages.
    page: [f64; 2],
}

struct Reader<'a, 'i> {
    /// Byte positions of line ends.
    ends: Vec<usize>,
    ids: HashMap<&'a str, Node<'a, 'i>>,
    styles: StyleSheet<'a>,
    sheet: Sheet,
    /// The strokes so far. `None` if shapes are read.
    strokes: Option<Vec<Stroke>>,
    elements: usize,
    groups: usize,
}

impl<'a, 'i> Reader<'a, 'i> {
    fn line(&self, node: Node) -> usize {
        self.ends.partition_point(|&end| end < node.range().start) + 1
    }

    /// Sets up the page: coordinates are in metres from its lower left corner, with y upwards.
    fn page(&mut self, root: Node<'a, 'i>, settings: &Settings) -> Result<InheritedProperties, Error> {
        let unit = settings.unit;
        let view: Option<ViewBox> = self.parsed(root, "viewBox")?;
        // A page without a view box and a size counts as 100 units wide and high.
        let view_size = view.map_or([100.0, 100.0], |view| [view.w, view.h]);
        let lengths = ["width", "height"]
            .map(|name| root.attribute(name).filter(|value| !value.contains('%') && *value != "auto"));
        let mut size = [None; 2];
        for k in 0..2 {
            size[k] = match lengths[k] {
                Some(_) => self.length(root, ["width", "height"][k], view_size[k])?,
                None => None,
            };
        }
        let (size, unit_of_page) = match (unit, view) {
            (Some(unit), _) => (view.map(|view| [view.w, view.h]), unit),
            (None, Some(view)) => {
                // One side determines the other.
                let ratio = view.h / view.w;
                let size = match size {
                    [Some(width), height] => [width, height.unwrap_or(width * ratio)],
                    [None, Some(height)] => [height / ratio, height],
                    [None, None] => [view.w, view.h],
                };
                (Some(size), Unit::PIXEL)
            }
            (None, None) => (size[1].map(|height| [size[0].unwrap_or(height), height]), Unit::PIXEL),
        };
        let scale = unit_of_page.metres() * settings.scale;
        let says_unit = lengths.iter().flatten().any(|text| text.trim_end().ends_with(char::is_alphabetic));
        if unit.is_none() && !says_unit {
            self.sheet.notes.add("the drawing does not state its size: read as px, 96 to an inch", None);
        }
        let up = Map { u: [scale, 0.0], v: [0.0, -scale], o: [0.0, size.map_or(0.0, |[_, height]| height * scale)] };
        let map = match (view, size) {
            (Some(view), Some(size)) => up.compose(&self.view_box_map(root, view, size)?),
            _ => up,
        };
        self.regular(&map, root)?;
        let page = view.map_or(size.unwrap_or(view_size), |view| [view.w, view.h]);
        Ok(InheritedProperties {
            map,
            style: Style::default().of(root, &self.styles),
            name: None,
            is_used: false,
            layer: None,
            page,
        })
    }

    /// Returns the map that fits a view box into a space of this size.
    fn view_box_map(&self, node: Node, view: ViewBox, size: [f64; 2]) -> Result<Map, Error> {
        let ratio = self.parsed(node, "preserveAspectRatio")?;
        let ratio = ratio.unwrap_or(AspectRatio { defer: false, align: Align::XMidYMid, slice: false });
        let [x, y] = [size[0] / view.w, size[1] / view.h];
        let [sx, sy] = match (ratio.align, ratio.slice) {
            (Align::None, _) => [x, y],
            (_, false) => [x.min(y); 2],
            (_, true) => [x.max(y); 2],
        };
        use Align::{XMaxYMax, XMaxYMid, XMaxYMin, XMidYMax, XMidYMid, XMidYMin, XMinYMax, XMinYMid};
        let right = match ratio.align {
            XMidYMin | XMidYMid | XMidYMax => 0.5,
            XMaxYMin | XMaxYMid | XMaxYMax => 1.0,
            _ => 0.0,
        };
        let down = match ratio.align {
            XMinYMid | XMidYMid | XMaxYMid => 0.5,
            XMinYMax | XMidYMax | XMaxYMax => 1.0,
            _ => 0.0,
        };
        let o = [right * (size[0] - sx * view.w) - sx * view.x, down * (size[1] - sy * view.h) - sy * view.y];
        Ok(Map { o, ..Map::scaling(sx, sy) })
    }

    /// Parses an attribute with a grammar, if it is present.
    fn parsed<T: FromStr>(&self, node: Node, name: &str) -> Result<Option<T>, Error> {
        let Some(text) = node.attribute(name) else { return Ok(None) };
        text.trim().parse().map(Some).map_err(|_| self.wrong(node, name, text))
    }

    fn wrong(&self, node: Node, name: &str, text: &str) -> Error {
        let shown: String = text.chars().take(40).collect();
        let message = format!("<{}> has {name}=\"{shown}\", which is not a valid value", node.tag_name().name());
        Error::new(self.line(node), message, "save the drawing again, as a plain SVG")
    }

    /// Returns a length in units of the element's coordinates. Percentages refer to `whole`.
    fn length(&self, node: Node, name: &str, whole: f64) -> Result<Option<f64>, Error> {
        const PIXELS_PER_INCH: f64 = 96.0;
        let Some(Length { number, unit }) = self.parsed(node, name)? else { return Ok(None) };
        let factor = match unit {
            LengthUnit::None | LengthUnit::Px => 1.0,
            LengthUnit::In => PIXELS_PER_INCH,
            LengthUnit::Cm => PIXELS_PER_INCH / 2.54,
            LengthUnit::Mm => PIXELS_PER_INCH / 25.4,
            LengthUnit::Pt => PIXELS_PER_INCH / 72.0,
            LengthUnit::Pc => PIXELS_PER_INCH / 6.0,
            LengthUnit::Percent => whole / 100.0,
            LengthUnit::Em | LengthUnit::Ex => {
                return Err(self.wrong(node, name, node.attribute(name).unwrap_or_default()));
            }
        };
        Ok(Some(number * factor).filter(|length| length.is_finite()))
    }

    /// Does the same as [`Self::length`], but returns 0 for a missing attribute.
    fn length_or_0(&self, node: Node, name: &str, whole: f64) -> Result<f64, Error> {
        Ok(self.length(node, name, whole)?.unwrap_or(0.0))
    }

    fn regular(&self, map: &Map, node: Node) -> Result<(), Error> {
        if map.is_regular() {
            return Ok(());
        }
        let message = format!("<{}> has a scale that is 0 or too large", node.tag_name().name());
        Err(Error::new(self.line(node), message, "correct the transform or the viewBox"))
    }

    fn children(&mut self, node: Node<'a, 'i>, inside: &InheritedProperties, depth: usize) -> Result<(), Error> {
        node.children().filter(|child| is_svg(*child)).try_for_each(|child| self.element(child, inside, depth + 1))
    }

    fn element(&mut self, node: Node<'a, 'i>, around: &InheritedProperties, depth: usize) -> Result<(), Error> {
        let (kind, line) = (node.tag_name().name(), self.line(node));
        self.elements += 1;
        if depth > MAX_ELEMENT_DEPTH {
            let message =
                format!("<{kind}> is nested more than {MAX_ELEMENT_DEPTH} deep, or contains itself through <use>");
            return Err(Error::new(line, message, "ungroup elements, or remove the <use> that closes the loop"));
        }
        if self.elements > MAX_ELEMENTS {
            let message =
                format!("the drawing has more than {MAX_ELEMENTS} elements, with the copies that <use> makes");
            return Err(Error::new(line, message, "remove parts that the arm cannot reach"));
        }
        let style = around.style.of(node, &self.styles);
        let own_name = node.attribute((INKSCAPE_NAMESPACE, "label")).or(node.attribute("id")).map(str::to_owned);
        let own_name = own_name.filter(|_| !around.is_used);
        let name = own_name.clone().or_else(|| around.name.clone());
        if !style.is_displayed {
            let hidden = Origin {
                hidden_by: around.name.clone(),
                ..origin(kind, line, &InheritedProperties { name, ..around.clone() })
            };
            self.sheet.leave_out("elements not displayed", &hidden);
            return Ok(());
        }
        if node.has_attribute("clip-path") || node.has_attribute("mask") {
            self.sheet.notes.add("clip-path and mask: ignored", Some(line));
        }
        let transform: Option<Transform> = self.parsed(node, "transform")?;
        let Transform { a, b, c, d, e, f } = transform.unwrap_or_default();
        let map = around.map.compose(&Map { u: [a, b], v: [c, d], o: [e, f] });
        self.regular(&map, node)?;
        let mut inside = InheritedProperties { map, style, name, ..around.clone() };
        match kind {
            "g" | "a" | "switch" => {
                let is_layer = node.attribute((INKSCAPE_NAMESPACE, "groupmode")) == Some("layer");
                if is_layer || inside.layer.is_none() && kind == "g" {
                    inside.layer = own_name.clone();
                }
                // The name of a layer is no name for its elements.
                inside.name = if is_layer { None } else { inside.name };
                self.children(node, &inside, depth)
            }
            "svg" => {
                let inside = self.viewport(node, node, inside)?;
                self.children(node, &inside, depth)
            }
            "use" => self.draw_referenced_element(node, inside, own_name.is_some(), depth),
            "path" | "polygon" | "polyline" | "line" | "rect" | "circle" | "ellipse" if !style.is_visible => {
                self.sheet.leave_out("elements not visible", &origin(kind, line, &inside));
                Ok(())
            }
            "path" | "polygon" | "polyline" | "line" | "rect" | "circle" | "ellipse" if self.strokes.is_some() => {
                self.add_strokes(node, &inside)
            }
            "path" => {
                let origin = origin(kind, line, &inside);
                let stretches = self.outlines_of_path(node, &inside)?;
                let stretches = stretches.iter().map(|outline| outline.stretch(self.sheet.tolerance)).collect();
                let stretches: Result<Vec<Stretch>, _> = stretches;
                self.stretches(stretches.map_err(|_| self.sheet.too_fine(&origin))?, style, &origin)
            }
            "polygon" | "polyline" => {
                let points = PointsParser::from(node.attribute("points").unwrap_or_default());
                let points = points.map(|(x, y)| inside.map.point([x, y])).collect();
                let stretch = Stretch { points, is_closed: kind == "polygon" };
                self.stretches(vec![stretch], style, &origin(kind, line, &inside))
            }
            "line" => {
                let ends = self.line_ends(node, &inside)?;
                self.sheet.wall(ends.to_vec(), &origin(kind, line, &inside))
            }
            "rect" => self.rect(node, &inside, &origin(kind, line, &inside)),
            "circle" | "ellipse" => self.read_ellipse(node, &inside, &origin(kind, line, &inside)),
            "text" | "image" | "foreignObject" | "video" | "canvas" | "iframe" | "flowRoot" => {
                self.sheet.leave_out(&format!("<{kind}>"), &origin(kind, line, &inside));
                Ok(())
            }
            // These elements are not drawn: definitions, titles, animations.
            _ => Ok(()),
        }
    }

    fn outlines_of_path(&self, node: Node, inside: &InheritedProperties) -> Result<Vec<Outline>, Error> {
        outlines(node.attribute("d").unwrap_or_default(), &inside.map).map_err(|why| {
            Error::new(self.line(node), format!("path data: {why}"), "save the drawing again, as a plain SVG")
        })
    }

    /// Returns the properties within an `svg` or a `symbol` element. `sized` states its size.
    fn viewport(
        &self,
        node: Node<'a, 'i>,
        sized: Node<'a, 'i>,
        mut inside: InheritedProperties,
    ) -> Result<InheritedProperties, Error> {
        let corner = [0, 1].map(|k| self.length_or_0(node, ["x", "y"][k], inside.page[k]));
        let [x, y] = corner;
        inside.map = inside.map.compose(&Map::moving([x?, y?]));
        let mut size = inside.page;
        for (k, name) in ["width", "height"].into_iter().enumerate() {
            let own = self.length(node, name, inside.page[k])?;
            size[k] = self.length(sized, name, inside.page[k])?.or(own).unwrap_or(size[k]);
        }
        inside.page = size;
        if let Some(view) = self.parsed::<ViewBox>(node, "viewBox")? {
            inside.map = inside.map.compose(&self.view_box_map(node, view, size)?);
            inside.page = [view.w, view.h];
        }
        self.regular(&inside.map, node)?;
        Ok(inside)
    }

    /// Draws the element to which a `use` element refers.
    fn draw_referenced_element(
        &mut self,
        node: Node<'a, 'i>,
        mut inside: InheritedProperties,
        is_named: bool,
        depth: usize,
    ) -> Result<(), Error> {
        let line = self.line(node);
        let reference = node.attribute("href").or(node.attribute((XLINK_NAMESPACE, "href"))).unwrap_or_default();
        let Some(&target) = reference.strip_prefix('#').and_then(|id| self.ids.get(id)) else {
            self.sheet
                .notes
                .add(format!("<use> of \"{reference}\", which the file does not contain: left out"), Some(line));
            return Ok(());
        };
        let [x, y] = [0, 1].map(|k| self.length_or_0(node, ["x", "y"][k], inside.page[k]));
        inside.map = inside.map.compose(&Map::moving([x?, y?]));
        inside.is_used |= is_named;
        if target.tag_name().name() != "symbol" {
            return self.element(target, &inside, depth + 1);
        }
        if depth > MAX_ELEMENT_DEPTH {
            return Err(Error::new(line, "<use> uses itself", "remove the loop"));
        }
        let inside = self.viewport(target, node, inside)?;
        self.children(target, &inside, depth + 1)
    }

    /// Returns the ends of a `line` element, mapped.
    fn line_ends(&self, node: Node, inside: &InheritedProperties) -> Result<[Point; 2], Error> {
        let mut ends = [[0.0; 2]; 2];
        for (end, names) in ends.iter_mut().zip([["x1", "y1"], ["x2", "y2"]]) {
            for k in 0..2 {
                end[k] = self.length_or_0(node, names[k], inside.page[k])?;
            }
        }
        Ok(ends.map(|p| inside.map.point(p)))
    }

    /// Returns corner, size and radii of a `rect` element; `None` if it has no extent.
    fn rect_extents(&self, node: Node, inside: &InheritedProperties) -> Result<Option<[Point; 3]>, Error> {
        let page = inside.page;
        let [x, y] = [self.length_or_0(node, "x", page[0])?, self.length_or_0(node, "y", page[1])?];
        let [w, h] = [self.length_or_0(node, "width", page[0])?, self.length_or_0(node, "height", page[1])?];
        let radius = |name: &str, whole: f64| match node.attribute(name) {
            Some("auto") => Ok(None),
            _ => self.length(node, name, whole),
        };
        let (rx, ry) = match (radius("rx", page[0])?, radius("ry", page[1])?) {
            (None, None) => (0.0, 0.0),
            (rx, ry) => (rx.or(ry).unwrap_or(0.0).min(w / 2.0), ry.or(rx).unwrap_or(0.0).min(h / 2.0)),
        };
        Ok((w > 0.0 && h > 0.0).then_some([[x, y], [w, h], [rx, ry]]))
    }

    fn rect(&mut self, node: Node, inside: &InheritedProperties, origin: &Origin) -> Result<(), Error> {
        let Some([[x, y], [w, h], [rx, ry]]) = self.rect_extents(node, inside)? else {
            self.sheet.leave_out("<rect> without extent", origin);
            return Ok(());
        };
        let mut ring: Vec<Point> = Vec::new();
        // The corners in order, each with its quarter of an ellipse.
        let corners = [[x + rx, y + ry], [x + w - rx, y + ry], [x + w - rx, y + h - ry], [x + rx, y + h - ry]];
        for (center, quarter) in corners.into_iter().zip([2.0, 3.0, 0.0, 1.0]) {
            if rx <= 0.0 || ry <= 0.0 {
                ring.push(inside.map.point(center));
                continue;
            }
            let ellipse = Ellipse { center, u: [rx, 0.0], v: [0.0, ry] }.mapped(&inside.map);
            let from = quarter * FRAC_PI_2;
            ring.push(ellipse.at(from));
            ring.extend(self.sheet.chords(ellipse.arc(from, FRAC_PI_2, self.sheet.tolerance), origin)?);
        }
        self.sheet.closed(ring, origin)
    }

    /// Returns centre and half axes of a `circle` or an `ellipse` element; `None` if it has no extent.
    fn ellipse_extents(&self, node: Node, inside: &InheritedProperties) -> Result<Option<[Point; 2]>, Error> {
        let page = inside.page;
        let center = [self.length_or_0(node, "cx", page[0])?, self.length_or_0(node, "cy", page[1])?];
        let [rx, ry] = match node.has_tag_name("circle") || node.has_tag_name((SVG_NAMESPACE, "circle")) {
            true => [self.length_or_0(node, "r", (page[0].hypot(page[1])) / 2.0_f64.sqrt())?; 2],
            false => [self.length_or_0(node, "rx", page[0])?, self.length_or_0(node, "ry", page[1])?],
        };
        Ok((rx > 0.0 && ry > 0.0).then_some([center, [rx, ry]]))
    }

    fn read_ellipse(&mut self, node: Node, inside: &InheritedProperties, origin: &Origin) -> Result<(), Error> {
        let Some([center, [rx, ry]]) = self.ellipse_extents(node, inside)? else {
            self.sheet.leave_out(&format!("{} without extent", origin.kind), origin);
            return Ok(());
        };
        if rx == ry {
            return self.sheet.circle(center, rx, &inside.map, origin);
        }
        self.sheet.ellipse(&Ellipse { center, u: [rx, 0.0], v: [0.0, ry] }.mapped(&inside.map), origin)
    }

    /// Adds the connected parts of an element. Those that are closed or filled form one solid shape.
    fn stretches(&mut self, stretches: Vec<Stretch>, style: Style, origin: &Origin) -> Result<(), Error> {
        let mut rings = Vec::new();
        for Stretch { points, is_closed } in stretches {
            let comes_back = points.len() > 3 && points.first() == points.last();
            if is_closed || comes_back {
                rings.push(points);
            } else if style.is_filled && points.len() > 2 {
                self.sheet.note("open outlines with a fill: closed, as in SVG", origin);
                rings.push(points);
            } else {
                // Elements are not joined with each other, so each has a group of its own.
                self.groups += 1;
                self.sheet.open(points, self.groups, origin)?;
            }
        }
        if rings.is_empty() { Ok(()) } else { self.sheet.region(rings, style.rule, origin) }
    }
}

fn origin(kind: &str, line: usize, inside: &InheritedProperties) -> Origin {
    Origin {
        name: inside.name.clone(),
        layer: inside.layer.clone(),
        height: None,
        hidden_by: None,
        kind: format!("<{kind}>"),
        line: Some(line),
        frame: None,
    }
}
