//! Text and numbers in HTML and SVG.

use crate::{Align, Table};
use cplan_text::{markup, wrapped};

/// Largest number of characters in one line of a planner's name before a chart.
const MAX_NAME_CHARACTERS: usize = 24;

/// Distance between two lines of a name, in pixels.
const NAME_LINE_HEIGHT: f64 = 13.0;

/// Writes a name before a line of a chart, right-aligned at `right` and centred about the height `middle`. A long name takes two
/// lines. If it is too long for these, the second line shows its end.
pub fn name_before(name: &str, right: f64, middle: f64) -> String {
    let lines = name_lines(name);
    let first = middle - NAME_LINE_HEIGHT * 0.5 * (lines.len() - 1) as f64;
    let line = |(k, line): (usize, &String)| text("name", [right, first + NAME_LINE_HEIGHT * k as f64], line);
    lines.iter().enumerate().map(line).collect()
}

/// Splits a name into at most two lines of [`MAX_NAME_CHARACTERS`] characters.
fn name_lines(name: &str) -> Vec<String> {
    let end = |text: &str| match text.chars().count() {
        n if n > MAX_NAME_CHARACTERS => {
            ['\u{2026}'].into_iter().chain(text.chars().skip(n - MAX_NAME_CHARACTERS + 1)).collect()
        }
        _ => text.to_owned(),
    };
    match wrapped(name, MAX_NAME_CHARACTERS, 0).split_once('\n') {
        Some((first, rest)) => vec![end(first), end(&rest.replace('\n', " "))],
        None => vec![end(name)],
    }
}

/// Returns the width in pixels that the longest of these names takes before the lines of a chart.
pub fn margin(names: &[&str]) -> f64 {
    let lines = names.iter().flat_map(|name| name_lines(name));
    let longest = lines.map(|line| line.chars().count()).fold(8, usize::max);
    18.0 + 7.4 * longest as f64
}

/// Writes the beginning of a chart of this size. `label` is for screen readers.
pub fn chart(size: [f64; 2], label: &str) -> String {
    let ([width, height], label) = (size.map(number), markup(label));
    format!("<svg class=\"chart\" viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{label}\">\n")
}

/// Writes the title of a chart's upright axis, with its middle at `y`.
pub fn upright_text(y: f64, text: &str) -> String {
    let (y, text) = (number(y), markup(text));
    format!("<text class=\"tick\" transform=\"translate(13 {y}) rotate(-90)\">{text}</text>\n")
}

/// Writes a text of a chart, with a class of the style sheet.
pub fn text(class: &str, [x, y]: [f64; 2], text: &str) -> String {
    format!("<text class=\"{class}\" x=\"{}\" y=\"{}\">{}</text>\n", number(x), number(y), markup(text))
}

/// Formats a coordinate with at most two decimals.
pub fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Encodes an SVG picture as the source of an image. As an image, its names and styles do not mix with those of the page, and it
/// cannot run scripts.
pub fn image_source(svg: &str) -> String {
    let mut source = String::from("data:image/svg+xml,");
    for byte in svg.bytes() {
        match byte {
            // Characters that are allowed in a URI in double quotes. Blanks and slashes are allowed in data URIs.
            _ if byte.is_ascii_alphanumeric() || b"-_.~ /:=,;()".contains(&byte) => source.push(char::from(byte)),
            _ => source.push_str(&format!("%{byte:02X}")),
        }
    }
    source
}

/// Writes a table whose first column has the headings of the rows. A table that is too wide scrolls within itself, also by
/// keyboard.
pub fn table(table: &Table) -> String {
    let class = |align| if align == Align::Right { " class=\"r\"" } else { "" };
    let head = table.columns.iter().map(|c| format!("<th scope=\"col\"{}>{}</th>", class(c.align()), markup(c.name())));
    let row = |cells: &Vec<Option<String>>| {
        let cell = |(k, cell): (usize, &Option<String>)| {
            let text = markup(cell.as_deref().unwrap_or("\u{2013}"));
            match k {
                0 => format!("<th scope=\"row\">{text}</th>"),
                _ => format!("<td{}>{text}</td>", class(table.columns[k].align())),
            }
        };
        format!("<tr>{}</tr>\n", cells.iter().enumerate().map(cell).collect::<String>())
    };
    format!(
        "<div class=\"wide\" tabindex=\"0\"><table>\n<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody>\n</table></div>\n",
        head.collect::<String>(),
        table.rows.iter().map(row).collect::<String>()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_is_escaped() {
        assert!(!image_source("<svg a=\"b\" c='#'>%\n\u{e9}</svg>").contains(['<', '>', '"', '\'', '#', '\n']));
    }

    #[test]
    fn long_names_have_two_lines_and_keep_their_end() {
        assert_eq!(name_lines("subdivision"), ["subdivision"]);
        assert_eq!(
            name_lines("harmonic --epsilon 0.5 --direction 0,-1"),
            ["harmonic --epsilon 0.5", "--direction 0,-1"]
        );
        let long = name_lines("harmonic --field oriented --epsilon 0.5 --direction 0,-1");
        assert_eq!(long, ["harmonic --field", "\u{2026}on 0.5 --direction 0,-1"]);
        assert!(long[1].chars().count() > 8 && margin(&["wavefront"]) < margin(&["a wavefront"]));
        let text = name_before("harmonic --epsilon 0.5 --direction 0,-1", 90.0, 20.0);
        assert!(text.contains("y=\"13.5\"") && text.contains("y=\"26.5\""), "{text}");
    }

    #[test]
    fn images_can_be_read_back() {
        let svg = "<svg a=\"b\">100 % é</svg>";
        let source = image_source(svg);
        let mut bytes = Vec::new();
        let mut rest = source.strip_prefix("data:image/svg+xml,").unwrap().bytes();
        while let Some(byte) = rest.next() {
            bytes.push(match byte {
                b'%' => {
                    let digits = [rest.next().unwrap(), rest.next().unwrap()];
                    u8::from_str_radix(std::str::from_utf8(&digits).unwrap(), 16).unwrap()
                }
                plain => plain,
            });
        }
        assert_eq!(String::from_utf8(bytes).unwrap(), svg);
    }

    #[test]
    fn coordinates_are_short() {
        assert_eq!([1.0, -0.001, 2.5, 1.0 / 3.0].map(number), ["1", "0", "2.5", "0.33"]);
    }
}
