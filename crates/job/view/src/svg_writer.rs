//! Figures as SVG.

use super::figure::{Anchor, Figure, Item, Label, Raster, Rect, Step, Style};
use super::letter_widths::letter_width;
use ::svg::Document;
use ::svg::node::element::{Circle, ClipPath, Definitions, Group, Path, Rectangle, Text, Title};
use cplan_theme::{PICTURE_FONTS, Rgb, WHITE};
use std::fmt::Write;

/// Weight of bold texts.
const BOLD_WEIGHT: &str = "600";

/// Greatest absolute value of coordinates, in pixels; places beyond it are invisible. Below it, viewers with single precision are
/// accurate to a tenth of a pixel.
pub const MAX_COORDINATE: f64 = 1e6;

/// Width of the pale line around letters, in pixels. Half of it is visible.
pub const HALO_WIDTH: f64 = 3.5;

/// Writes the figure as an SVG document without a size: it fills the width that its reader provides. In every font, texts have
/// the widths of the built-in font. The result is the same byte for byte; coordinates have two decimals.
pub fn write(figure: &Figure) -> String {
    let ground = Rectangle::new().set("width", number(figure.width)).set("height", number(figure.height));
    document(figure, Group::new().add(ground.set("fill", figure.shown(WHITE).to_string())))
}

/// Writes the figure without a background, as an element of a page. Its colours are variables of the page's style sheet, so it is
/// light or dark like the page. `id` distinguishes its names from those of other drawings in the page. Colours without a name in
/// the style sheet are added to `colors`: the variable of `#rrggbb` is `--xrrggbb`.
pub fn write_for_page(figure: &Figure, id: &str, colors: &mut Vec<Rgb>) -> String {
    let svg = document(figure, Group::new());
    let svg = svg.replace("<clipPath id=\"", &format!("<clipPath id=\"{id}-"));
    let svg = svg.replace("clip-path=\"url(#", &format!("clip-path=\"url(#{id}-"));
    with_variables(&svg, colors)
}

/// Writes items without a document around them, with colours as in [`write_for_page`]. Clipped items are not allowed.
pub fn elements(items: &[Item], colors: &mut Vec<Rgb>) -> String {
    let figure = Figure { width: 0.0, height: 0.0, items: Vec::new(), is_dark: false };
    let group = add_all(Group::new(), items, &figure, &mut Vec::new()).set("stroke-linejoin", "round");
    with_variables(&group.to_string(), colors)
}

/// Replaces the colours in attributes by variables of the page's style sheet.
fn with_variables(svg: &str, colors: &mut Vec<Rgb>) -> String {
    cplan_theme::recolored(svg, |color| {
        let name = cplan_theme::variable(color).unwrap_or_else(|| {
            if !colors.contains(&color) {
                colors.push(color);
            }
            format!("x{}", &color.to_string()[1..])
        });
        format!("var(--{name})")
    })
}

fn document(figure: &Figure, ground: Group) -> String {
    let mut clips = Vec::new();
    let page = ground.set("font-family", PICTURE_FONTS).set("stroke-linejoin", "round");
    let page = add_all(page, &figure.items, figure, &mut clips);
    let mut definitions = Definitions::new();
    for (i, rect) in clips.iter().enumerate() {
        definitions = definitions.add(ClipPath::new().set("id", clip_id(i)).add(rectangle(rect)));
    }
    Document::new()
        .set("viewBox", format!("0 0 {} {}", number(figure.width), number(figure.height)))
        .add(definitions)
        .add(page)
        .to_string()
}

/// Adds an item, with its colours on the figure's background.
fn add(group: Group, item: &Item, figure: &Figure, clips: &mut Vec<Rect>) -> Group {
    match item {
        Item::Outline(steps, _) if steps.is_empty() => group,
        Item::Outline(steps, style) => {
            let path = Path::new().set("d", commands(steps));
            group.add(attributes(style, figure).into_iter().fold(path, |p, (key, value)| p.set(key, value)))
        }
        Item::Disc([x, y], radius, style) => {
            let disc = Circle::new().set("cx", number(*x)).set("cy", number(*y)).set("r", number(*radius));
            group.add(attributes(style, figure).into_iter().fold(disc, |d, (key, value)| d.set(key, value)))
        }
        Item::Text(label) => group.add(text(label, figure)),
        Item::Clip(rect, items) => {
            let id = clip_id(clips.len());
            clips.push(*rect);
            group.add(add_all(Group::new().set("clip-path", format!("url(#{id})")), items, figure, clips))
        }
        Item::Raster(raster) => group.add(cells(raster, figure)),
        Item::OfPath(index, items) => {
            group.add(add_all(Group::new().set("data-path", index.to_string()), items, figure, clips))
        }
        Item::Titled(title, items) => {
            group.add(add_all(Group::new().add(Title::new(title.as_str())), items, figure, clips))
        }
    }
}

fn add_all(group: Group, items: &[Item], figure: &Figure, clips: &mut Vec<Rect>) -> Group {
    items.iter().fold(group, |group, item| add(group, item, figure, clips))
}

fn clip_id(index: usize) -> String {
    format!("clip{index}")
}

fn rectangle(rect: &Rect) -> Rectangle {
    Rectangle::new()
        .set("x", number(rect.x))
        .set("y", number(rect.y))
        .set("width", number(rect.width))
        .set("height", number(rect.height))
}

/// Formats a number: at most two decimals, no trailing zeros, no negative zero.
fn number(value: f64) -> String {
    let cut = value.clamp(-MAX_COORDINATE, MAX_COORDINATE);
    let text = format!("{cut:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Returns the data of a path.
pub fn commands(steps: &[Step]) -> String {
    let mut d = String::new();
    for step in steps {
        match step {
            Step::Move([x, y]) => d.extend(["M", &number(*x), " ", &number(*y)]),
            Step::Line([x, y]) => d.extend(["L", &number(*x), " ", &number(*y)]),
            Step::Arc(radius, [x, y]) => {
                let r = number(*radius);
                d.extend(["A", &r, " ", &r, " 0 0 0 ", &number(*x), " ", &number(*y)]);
            }
            Step::Close => d.push('Z'),
        }
    }
    d
}

fn attributes(style: &Style, figure: &Figure) -> Vec<(&'static str, String)> {
    let mut all = vec![("fill", style.fill.map_or("none".to_owned(), |color| figure.shown(color).to_string()))];
    if let Some(pen) = style.pen {
        all.push(("stroke", figure.shown(pen.color).to_string()));
        all.push(("stroke-width", number(pen.width)));
        if !pen.dash.is_empty() {
            all.push(("stroke-dasharray", pen.dash.iter().map(|&d| number(d)).collect::<Vec<_>>().join(" ")));
        }
        if style.pen_below {
            all.push(("paint-order", "stroke".to_owned()));
        }
    }
    if style.opacity < 1.0 {
        all.push(("opacity", number(style.opacity)));
    }
    all
}

fn text(label: &Label, figure: &Figure) -> Text {
    // XML 1.0 forbids some characters even when escaped.
    let clean: String = label.text.chars().map(|c| if is_xml(c) { c } else { '\u{fffd}' }).collect();
    let [x, y] = label.at.map(number);
    let mut text =
        Text::new(clean).set("font-size", number(label.size)).set("fill", figure.shown(label.color).to_string()).set(
            "text-anchor",
            match label.anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            },
        );
    if label.is_bold {
        text = text.set("font-weight", BOLD_WEIGHT);
    }
    // The font would make the document much larger. A reader without it fits its own letters into the same width.
    if label.text.chars().all(|letter| letter_width(letter, label.is_bold).is_some()) && !label.text.is_empty() {
        text = text.set("textLength", number(label.width())).set("lengthAdjust", "spacingAndGlyphs");
    }
    if label.has_halo {
        let halo = text.set("stroke", figure.shown(WHITE).to_string()).set("stroke-width", number(HALO_WIDTH));
        text = halo.set("paint-order", "stroke");
    }
    if label.upwards {
        text = text.set("transform", format!("rotate(-90 {x} {y})"));
    }
    text.set("x", x).set("y", y)
}

fn is_xml(c: char) -> bool {
    !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}')
}

/// Writes the cells as one path of rectangles per colour, in units of cells, without anti-aliasing, which would show seams
/// between rectangles.
fn cells(raster: &Raster, figure: &Figure) -> Group {
    let [columns, rows] = raster.cells;
    let Rect { x, y, width, height } = raster.rect;
    let (sx, sy) = (width / columns.max(1) as f64, height / rows.max(1) as f64);
    let place = format!("translate({} {}) scale({sx:.5} {sy:.5})", number(x), number(y));
    let mut group = Group::new().set("transform", place).set("shape-rendering", "crispEdges");
    for (rectangles, color) in raster.rectangles().iter().zip(&raster.palette).filter(|(all, _)| !all.is_empty()) {
        let mut d = String::new();
        for [i, j, w, h] in rectangles {
            // Cells count upwards and y points down: row j begins at rows - j from the top.
            let _ = write!(d, "M{i} {}h{w}v-{h}h-{w}z", rows - j);
        }
        group = group.add(Path::new().set("fill", figure.shown(*color).to_string()).set("d", d));
    }
    group
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [(0.0, "0"), (-0.001, "0"), (1.0, "1"), (1.204, "1.2"), (-2.346, "-2.35"), (100.0, "100")]
        {
            assert_eq!(number(value), text);
        }
        assert_eq!(number(f64::INFINITY), "1000000");
    }

    #[test]
    fn text_is_escaped_and_stripped_of_what_xml_forbids() {
        let label = Label {
            at: [1.0, 2.0],
            text: "<a & \"b\">\u{1}".to_owned(),
            size: 10.0,
            anchor: Anchor::Start,
            upwards: true,
            color: Rgb(0, 0, 0),
            has_halo: false,
            is_bold: false,
        };
        let figure = Figure { width: 10.0, height: 10.0, items: vec![Item::Text(label)], is_dark: false };
        let xml = write(&figure);
        let tree = roxmltree::Document::parse(&xml).unwrap();
        let text = tree.descendants().find(|n| n.has_tag_name("text")).unwrap();
        assert_eq!(text.text().map(str::trim), Some("<a & \"b\">\u{fffd}"));
    }

    #[test]
    fn dark_pictures_have_the_dark_colors_of_roles() {
        let disc = Item::Disc([5.0, 5.0], 2.0, Style::fill(cplan_theme::INK));
        let figure = |is_dark| Figure { width: 10.0, height: 10.0, items: vec![disc.clone()], is_dark };
        let [light, dark] = [false, true].map(|is_dark| write(&figure(is_dark)));
        for (role, name) in [(cplan_theme::INK, "ink"), (WHITE, "paper")] {
            let role = cplan_theme::ROLES.iter().find(|other| other.name == name && other.light == role).unwrap();
            assert!(light.contains(&role.light.to_string()) && dark.contains(&role.dark.to_string()), "{name}");
        }
    }

    #[test]
    fn drawings_within_pages_have_the_colors_of_the_page() {
        let rect = Rect { x: 0.0, y: 0.0, width: 5.0, height: 5.0 };
        let disc = |color| Item::Disc([5.0, 5.0], 2.0, Style::fill(color));
        let items = vec![Item::Clip(rect, vec![disc(cplan_theme::INK), Item::OfPath(3, vec![disc(Rgb(1, 2, 3)); 2])])];
        let mut colors = Vec::new();
        let svg = write_for_page(&Figure { width: 10.0, height: 10.0, items, is_dark: false }, "a", &mut colors);
        assert_eq!(colors, [Rgb(1, 2, 3)]);
        for part in
            ["fill=\"var(--ink)\"", "fill=\"var(--x010203)\"", "id=\"a-clip0\"", "url(#a-clip0)", "data-path=\"3\""]
        {
            assert!(svg.contains(part), "no {part} in {svg}");
        }
        assert!(!svg.contains("\"#"), "{svg}");
    }

    /// Paints the rectangles, and compares the result with the cells.
    #[test]
    fn raster_rectangles_cover_each_cell_once() {
        let [columns, rows] = [7_usize, 5];
        let levels: Vec<Option<usize>> =
            (0..columns * rows).map(|k| (!k.is_multiple_of(4)).then_some((k / 3 + k % 2) % 3)).collect();
        let raster = Raster {
            rect: Rect { x: 0.0, y: 0.0, width: 70.0, height: 50.0 },
            cells: [columns, rows],
            palette: vec![Rgb(0, 0, 0), Rgb(1, 0, 0), Rgb(2, 0, 0)],
            levels: levels.clone(),
        };
        let xml = write(&Figure { width: 70.0, height: 50.0, items: vec![Item::Raster(raster)], is_dark: false });
        let tree = roxmltree::Document::parse(&xml).unwrap();
        let mut painted = vec![None; columns * rows];
        for path in tree.descendants().filter(|n| n.has_tag_name("path")) {
            let level = usize::from_str_radix(&path.attribute("fill").unwrap()[1..3], 16).unwrap();
            for rect in path.attribute("d").unwrap().split_terminator('z') {
                let n: Vec<usize> = rect[1..].split([' ', 'h', 'v', '-']).filter_map(|s| s.parse().ok()).collect();
                let [i, bottom, w, h, back] = n[..] else { panic!("odd rectangle {rect}") };
                assert_eq!(w, back);
                for i in i..i + w {
                    for j in rows - bottom..rows - bottom + h {
                        assert_eq!(painted[i * rows + j].replace(level), None, "cell ({i}, {j}) painted twice");
                    }
                }
            }
        }
        assert_eq!(painted, levels);
    }
}
