//! The file around a view.

use super::content::View;
use crate::color::TINTS;
use cplan_text::markup;

const STYLE: &str = include_str!("assets/view.css");

/// What draws a view, in the order in which one part needs the other.
const CODE: [&str; 11] = [
    include_str!("assets/geometry.js"),
    include_str!("assets/panel.js"),
    include_str!("assets/labels.js"),
    include_str!("assets/legend.js"),
    include_str!("assets/think.js"),
    include_str!("assets/workspace.js"),
    include_str!("assets/cspace.js"),
    include_str!("assets/plots.js"),
    include_str!("assets/contact.js"),
    include_str!("assets/learn.js"),
    include_str!("assets/view.js"),
];

/// What shows the view that lies in the page.
const PLAN: &str = include_str!("assets/plan.js");

/// The colours of pictures, as the style's variables; it has others for the dark.
fn colors() -> String {
    let variables: String = TINTS.iter().map(|(name, color)| format!(" --{name}: {color};")).collect();
    format!(":root {{{variables} }}\n")
}

/// The view as one self-contained file of HTML.
#[must_use]
pub fn page(view: &View) -> String {
    let title = view.title.first().map_or("cplan", String::as_str);
    sealed(title, "", "view", &view.json(), &(drawing() + PLAN))
}

/// What draws a view: code that a page's own may follow.
#[must_use]
pub fn drawing() -> String {
    CODE.concat()
}

/// A self-contained page, which loads nothing, and may not: `json` stands in the element `id`, where `code` finds it.
#[must_use]
pub fn sealed(title: &str, style: &str, id: &str, json: &str, code: &str) -> String {
    let policy = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";
    let policy = format!("<meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n");
    // Within a script only the less-than sign could end it.
    let data = json.replace('<', "\\u003c");
    shell(title, &policy, style, &format!("<script id=\"{id}\" type=\"application/json\">{data}</script>\n"), code)
}

/// A page that its code draws within `main`: its title, what else stands in its head, styles of its own, what stands before the
/// code, and the code.
#[must_use]
pub fn shell(title: &str, head: &str, style: &str, before: &str, code: &str) -> String {
    let title = markup(title);
    let colors = colors();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n{head}\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>\n{colors}{STYLE}{style}</style>\n</head>\n<body>\n<main><noscript>This page draws with JavaScript, which is switched \
         off here.</noscript></main>\n{before}<script>\n{code}</script>\n</body>\n</html>\n"
    )
}
