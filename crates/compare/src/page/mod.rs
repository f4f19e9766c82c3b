//! A study as one page of HTML: charts, paths, tables and the summary in words. The file needs no other file, no
//! network and no scripts. It is light or dark, as the reader's system is.

mod axis;
mod boxes;
mod convergence;
mod frame;
mod markup;
mod outcomes;
mod overlay;

pub use axis::Axis;
pub use frame::{Frame, frame};
pub use markup::{image_source, number, table};
pub use overlay::Overlay;

use super::measure::Measure;
use super::study::Study;
use super::words::words;
use cplan_text::{counted, markup};

/// A picture that the page includes.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Title of the picture.
    pub title: String,
    /// The picture as an SVG document.
    pub svg: String,
}

/// The contents of the page.
#[derive(Debug, Clone, PartialEq)]
pub struct Page<'a> {
    /// The study that the page shows.
    pub study: &'a Study,
    /// All paths in a configuration space, by planner and world.
    pub overlays: &'a [Overlay],
    /// Workspace and configuration space of each problem.
    pub pictures: &'a [Picture],
}

impl Page<'_> {
    /// Returns the page. The same data give the same bytes.
    #[must_use]
    pub fn html(&self) -> String {
        let study = self.study;
        let mut html = head(&study.title, &self.subtitle());
        for alarm in study.alarms() {
            html +=
                &format!("<p class=\"alarm\" role=\"alert\"><strong>Contradiction.</strong> {}</p>\n", markup(&alarm));
        }
        if let [only] = &study.comparisons[..] {
            html += &format!("<p class=\"verdict\">{}</p>\n", markup(&only.outcome()));
        }
        html += &section("Outcomes", &self.outcomes());
        html += &self.charts();
        html += &self.overlay_section();
        let sentences: String = words(study).iter().map(|w| paragraph(w)).collect();
        html += &section("In words", &sentences);
        html += &self.tables();
        html + &foot(METHOD_NOTE)
    }

    fn subtitle(&self) -> String {
        let planners = self.study.planners();
        let problems = counted(self.study.comparisons.len(), "problem");
        let refused = match self.study.refused.len() {
            0 => String::new(),
            n => format!(" ({n} more not run)"),
        };
        format!("{problems}{refused}, {} planners: {}", planners.len(), planners.join(", "))
    }

    fn outcomes(&self) -> String {
        let mut html = outcomes::key();
        if self.study.comparisons.len() > 1 {
            html += &format!("<div class=\"card narrow\">{}</div>\n", outcomes::bars(self.study));
        }
        let matrix = outcomes::matrix(self.study);
        if self.study.comparisons.len() > MAX_UNFOLDED_PROBLEMS {
            html += &collapsible_section("Problem by problem", &matrix);
        } else {
            html += &matrix;
        }
        html
    }

    fn charts(&self) -> String {
        let chart = |measure: Measure| {
            let chart = boxes::chart(self.study, measure)?;
            Some(format!(
                "<figure class=\"card\"><figcaption>{}</figcaption>\n{chart}</figure>\n",
                markup(measure.heading())
            ))
        };
        let charts: String = Measure::ALL.into_iter().filter_map(chart).collect();
        if charts.is_empty() {
            return charts;
        }
        let note = "Box: the middle half of the runs; bar across it: the median; whiskers: the least and the greatest; each \
                    dot is a run. Axes are logarithmic where values differ much.";
        section("Distributions", &format!("<div class=\"charts\">\n{charts}</div>\n<p class=\"sub\">{note}</p>\n"))
    }

    fn overlay_section(&self) -> String {
        let overlay = |(id, overlay): (usize, &Overlay)| {
            let note =
                overlay.note.as_deref().map_or_else(String::new, |n| format!("<p class=\"sub\">{}</p>\n", markup(n)));
            format!("<h3>{}</h3>\n{note}{}", markup(&overlay.title), overlay::panels(overlay, id))
        };
        let overlays: String = self.overlays.iter().enumerate().map(overlay).collect();
        let picture = |picture: &Picture| {
            let title = markup(&picture.title);
            format!(
                "<figure class=\"picture\" tabindex=\"0\"><img alt=\"{title}: workspace and configuration space\" src=\"{}\"/></figure>\n",
                image_source(&picture.svg)
            )
        };
        let pictures = self.pictures.iter().enumerate().map(|(i, p)| {
            // The first picture is unfolded: a page of folded parts looks empty.
            if i == 0 {
                format!("<h3>{}</h3>\n{}", markup(&p.title), picture(p))
            } else {
                collapsible_section(&p.title, &picture(p))
            }
        });
        let pictures: String = pictures.collect();
        let all = overlays + &pictures;
        if all.is_empty() { all } else { section("Paths and proofs", &all) }
    }

    fn tables(&self) -> String {
        // A single problem has no distributions.
        let mut html = match &self.study.comparisons[..] {
            [only] => table(&only.table()),
            _ => self
                .study
                .tables()
                .into_iter()
                .map(|(heading, rows)| collapsible_section(&heading, &table(&rows)))
                .collect(),
        };
        let notes: String = self.study.footnotes().map(|note| format!("<li>{}</li>\n", markup(&note))).collect();
        if !notes.is_empty() {
            html += &format!("<h3>Notes</h3>\n<ul class=\"notes\">\n{notes}</ul>\n");
        }
        section("Tables", &html)
    }
}

/// Returns the head of a page.
pub fn head(title: &str, subtitle: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <meta name=\"color-scheme\" content=\"light dark\"/>\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; font-src data:; style-src 'unsafe-inline'\"/>\n\
         <title>{0}</title>\n<style>\n{2}{STYLE}</style>\n</head>\n<body>\n<main>\n<header><h1>{0}</h1>\n<p class=\"sub\">{1}</p></header>\n",
        markup(title),
        markup(subtitle),
        cplan_theme::css()
    )
}

/// Returns the foot of a page. `how` is an HTML text about how the numbers were obtained.
pub fn foot(how: &str) -> String {
    format!("<footer>{how}</footer>\n</main>\n</body>\n</html>\n")
}

/// Number of problems above which their list is folded.
const MAX_UNFOLDED_PROBLEMS: usize = 40;

/// The page's own style sheet, after the one of all pages.
const STYLE: &str = include_str!("style.css");

const METHOD_NOTE: &str = "Every run covers the whole work from the problem to a certificate or a proof. \
                           <em>Found</em>: the whole continuous motion is certified free of collision. \
                           <em>Infeasible</em>: proven. Lengths are Euclidean in joint space; no motion is shorter \
                           than the proven lower bound on the optimum. Clearance is the proven distance from obstacles \
                           along the motion. The motion keeps the joints' limits. Memory is the greatest amount that a \
                           run has allocated at any one time. Times and memory depend on the machine; all other \
                           numbers are the same everywhere, up to the rounding of sines and cosines.";

/// Formats a paragraph whose first sentence, the conclusion, is emphasised.
fn paragraph(text: &str) -> String {
    match text.split_once(". ") {
        Some((claim, figures)) => format!("<p><strong>{}.</strong> {}</p>\n", markup(claim), markup(figures)),
        None => format!("<p>{}</p>\n", markup(text)),
    }
}

/// Formats a section of a page, with its heading.
#[must_use]
pub fn section(heading: &str, content: &str) -> String {
    format!("<section>\n<h2>{}</h2>\n{content}</section>\n", markup(heading))
}

/// Formats a part of a page that is hidden until its heading is clicked.
#[must_use]
pub fn collapsible_section(heading: &str, content: &str) -> String {
    format!("<details><summary>{}</summary>\n{content}</details>\n", markup(heading))
}
