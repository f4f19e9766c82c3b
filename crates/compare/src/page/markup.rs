//! Text and numbers in HTML and SVG.

use crate::{Align, Table};
use cplan_text::markup;

/// Characters of a planner's name that a chart has room for, at the most.
const NAME: usize = 24;

/// A name that fits in front of a chart's line: of a long one its end, in which planners with options differ.
pub fn shortened(name: &str) -> String {
    match name.chars().count() {
        n if n > NAME => ['\u{2026}'].into_iter().chain(name.chars().skip(n - NAME + 1)).collect(),
        _ => name.to_owned(),
    }
}

/// Pixels that the longest of these names takes in front of a chart's lines.
pub fn margin(names: &[&str]) -> f64 {
    let longest = names.iter().map(|name| name.chars().count().min(NAME)).fold(8, usize::max);
    18.0 + 7.4 * longest as f64
}

/// A coordinate: two decimals at the most.
pub fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// An SVG picture as the source of an image. It keeps its own names and styles there, and runs no scripts.
pub fn image_source(svg: &str) -> String {
    let mut source = String::from("data:image/svg+xml,");
    for byte in svg.bytes() {
        match byte {
            // What a URI in double quotes may hold as it is; blanks and slashes are fine in data.
            b'A'..=b'Z'
            | b'a'..=b'z'
            | b'0'..=b'9'
            | b'-'
            | b'_'
            | b'.'
            | b'~'
            | b' '
            | b'/'
            | b':'
            | b'='
            | b','
            | b';'
            | b'('
            | b')' => source.push(char::from(byte)),
            _ => source.push_str(&format!("%{byte:02X}")),
        }
    }
    source
}

/// A table with its first column as headings of the rows. It scrolls where it is, by keys, too.
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
    fn nothing_escapes() {
        assert!(!image_source("<svg a=\"b\" c='#'>%\n\u{e9}</svg>").contains(['<', '>', '"', '\'', '#', '\n']));
    }

    #[test]
    fn long_names_keep_their_end() {
        assert_eq!(shortened("subdivision"), "subdivision");
        let long = shortened("harmonic --field oriented --epsilon 0.5");
        assert_eq!(long, "\u{2026} oriented --epsilon 0.5");
        assert_eq!(long.chars().count(), NAME);
        assert_eq!(margin(&["harmonic --field oriented --epsilon 0.5"]), margin(&[long.as_str()]));
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
