//! The HTML file around a view.

use super::content::View;
use cplan_text::markup;

const STYLE: &str = include_str!("assets/view.css");

/// Code that draws a view. A script needs only the scripts before it.
const SCRIPTS: [&str; 40] = [
    include_str!("assets/element.js"),
    include_str!("assets/icons.js"),
    include_str!("assets/settings.js"),
    include_str!("assets/numbers.js"),
    include_str!("assets/geometry.js"),
    include_str!("assets/panel.js"),
    include_str!("assets/zoom.js"),
    include_str!("assets/labels.js"),
    include_str!("assets/legend.js"),
    include_str!("assets/layers.js"),
    include_str!("assets/tabs.js"),
    include_str!("assets/think.js"),
    include_str!("assets/workspace.js"),
    include_str!("assets/cspace.js"),
    include_str!("assets/plots.js"),
    include_str!("assets/timeline.js"),
    include_str!("assets/strip.js"),
    include_str!("assets/closing.js"),
    include_str!("assets/height.js"),
    include_str!("assets/contact.js"),
    include_str!("assets/lessons/question.js"),
    include_str!("assets/lessons/slice.js"),
    include_str!("assets/lessons/polygons.js"),
    include_str!("assets/lessons/c_obstacles.js"),
    include_str!("assets/lessons/roadmaps.js"),
    include_str!("assets/lessons/cells.js"),
    include_str!("assets/lessons/waves.js"),
    include_str!("assets/lessons/fields.js"),
    include_str!("assets/lessons/proofs.js"),
    include_str!("assets/lessons/tasks.js"),
    include_str!("assets/learn.js"),
    include_str!("assets/steps.js"),
    include_str!("assets/sideview.js"),
    include_str!("assets/tour.js"),
    include_str!("assets/explain.js"),
    include_str!("assets/budget.js"),
    include_str!("assets/pointer.js"),
    include_str!("assets/keys.js"),
    include_str!("assets/layout.js"),
    include_str!("assets/view.js"),
];

/// Code for a line that the tip follows, for pages with one.
const LINE_SCRIPTS: [&str; 2] = [include_str!("assets/lens.js"), include_str!("assets/follow.js")];

/// Code that shows the view in the page.
const PLAN_SCRIPT: &str = include_str!("assets/plan.js");

/// Returns the view as one self-contained HTML file.
pub fn page(view: &View) -> String {
    let title = view.title.first().map_or("cplan", String::as_str);
    let sections: String = view.still.sections.iter().map(|section| section.script).collect();
    let line = if view.still.line.is_some() { LINE_SCRIPTS.concat() } else { String::new() };
    sealed(title, "", "view", &view.json(), &(drawing() + &sections + &line + PLAN_SCRIPT))
}

/// Code of the page of an inspection.
const INSPECTION_SCRIPT: &str = include_str!("assets/inspection.js");

/// Returns the page of a robot's inspection. `report` is a JSON object. `view` shows the arm; `None` if the robot has
/// none.
pub fn inspection_page(title: &str, view: Option<&View>, report: &str) -> String {
    let view = view.map_or_else(|| "null".into(), View::json);
    let data = format!("{{\"view\":{view},\"report\":{report}}}");
    sealed(title, "", "view", &data, &(drawing() + INSPECTION_SCRIPT))
}

/// Returns the scripts that draw a view, for pages that add their own code after them.
pub fn drawing() -> String {
    let roles: Vec<String> = cplan_theme::names().collect();
    let stops = cplan_theme::SCALE_STOPS.map(|color| color.to_string());
    format!(
        "/** Names of the colours in the style sheet. */\nconst ROLES = {roles:?};\n\
         /** Colours of the scale of values, from light to dark. */\nconst SCALE_STOPS = {stops:?};\n{}",
        SCRIPTS.concat()
    )
}

/// Returns a self-contained page. It loads nothing, and forbids the browser to load anything. The element `id` contains `json`,
/// which `code` reads.
pub fn sealed(title: &str, style: &str, id: &str, json: &str, code: &str) -> String {
    let policy =
        "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; font-src data:";
    let policy = format!("<meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n");
    // Without a less-than sign, nothing in the data can end the script.
    let data = json.replace('<', "\\u003c");
    shell(title, &policy, style, &format!("<script id=\"{id}\" type=\"application/json\">{data}</script>\n"), code)
}

/// Returns a page whose code draws within the element `main`. `head` has further elements of the page's head, `style` its styles,
/// and `before` the elements before the code.
pub fn shell(title: &str, head: &str, style: &str, before: &str, code: &str) -> String {
    let title = markup(title);
    let tokens = cplan_theme::css();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n{head}\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>\n{tokens}{STYLE}{style}</style>\n</head>\n<body>\n<main><noscript>This page draws with JavaScript, which is switched \
         off here.</noscript></main>\n{before}<script>\n{code}</script>\n</body>\n</html>\n"
    )
}
