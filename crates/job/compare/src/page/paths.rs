//! Drawings of the paths of one problem.

use super::markup::number;
use cplan_text::markup;
use cplan_theme::{PlannerPen, Rgb, on_dark};
use cplan_view::ComparedPaths;
use cplan_view::output::names::capitalized;

/// Drawings of all paths of one problem.
#[derive(Debug, Clone, PartialEq)]
pub struct PathPictures {
    /// Index of the problem in the study.
    pub problem: usize,
    /// The drawings. Their paths are numbered among the rows that have a path.
    pub drawn: ComparedPaths,
}

/// Names of the two drawings, for screen readers.
const PANEL_NAMES: [&str; 2] = ["workspace", "configuration space"];

impl PathPictures {
    /// Returns the parts that all small pictures of this problem share. The page must contain them once.
    pub fn shared_parts(&self) -> String {
        let mut html = String::from("<svg class=\"shared\" width=\"0\" height=\"0\" aria-hidden=\"true\">\n");
        for (panel, small) in self.drawn.small.iter().enumerate() {
            let [width, height] = small.size.map(number);
            for (part, content) in [("ground", &small.ground), ("markers", &small.markers)] {
                html += &format!(
                    "<symbol id=\"{part}{}-{panel}\" viewBox=\"0 0 {width} {height}\">{content}</symbol>\n",
                    self.problem
                );
            }
        }
        html + "</svg>\n"
    }

    /// Draws a path in small, in the workspace (0) or in the configuration space (1).
    pub fn small(&self, panel: usize, path: usize, pen: PlannerPen, label: &str) -> String {
        let small = &self.drawn.small[panel];
        let Some(data) = small.paths.get(path) else { return String::new() };
        let [width, height] = small.size.map(number);
        let name = if label.is_empty() {
            "aria-hidden=\"true\"".to_owned()
        } else {
            format!("role=\"img\" aria-label=\"Path of {} in the {}\"", markup(label), PANEL_NAMES[panel])
        };
        format!(
            "<svg class=\"small\" viewBox=\"0 0 {width} {height}\" {name}><use href=\"#ground{0}-{panel}\"/><path class=\"halo\" \
             d=\"{data}\"/><path class=\"way\" d=\"{data}\" style=\"stroke: var(--{1})\"/><use href=\"#markers{0}-{panel}\"/></svg>",
            self.problem,
            pen.name()
        )
    }

    /// Draws all paths in both spaces, side by side.
    pub fn large(&self, title: &str) -> String {
        let figure = |(svg, name): (&String, &str)| {
            let label = format!("{title}: all paths in the {name}");
            let svg = svg.replacen(
                "<svg ",
                &format!("<svg class=\"large\" role=\"img\" aria-label=\"{}\" ", markup(&label)),
                1,
            );
            format!("<figure class=\"space\"><figcaption>{}</figcaption>\n{svg}</figure>\n", capitalized(name))
        };
        format!(
            "<div class=\"spaces\">\n{}</div>\n",
            self.drawn.large.iter().zip(PANEL_NAMES).map(figure).collect::<String>()
        )
    }
}

/// Returns the style sheet with the colours of drawings, which are light or dark like the page.
pub fn colors(pictures: &[PathPictures]) -> String {
    let mut all: Vec<Rgb> = Vec::new();
    for &color in pictures.iter().flat_map(|picture| &picture.drawn.colors) {
        if !all.contains(&color) {
            all.push(color);
        }
    }
    let variables = |shown: fn(Rgb) -> Rgb| -> String {
        all.iter().map(|&color| format!(" --x{}: {};", &color.to_string()[1..], shown(color))).collect()
    };
    if all.is_empty() {
        return String::new();
    }
    format!(
        ":root {{{} }}\n@media (prefers-color-scheme: dark) {{ :root {{{} }} }}\n",
        variables(|color| color),
        variables(on_dark)
    )
}
