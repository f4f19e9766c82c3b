//! A study as one page of HTML: the conclusion, the recommended planners, pictures and a sortable table, then charts and all
//! figures. The page needs no other file and no network. Without scripts, its content is the same, but nothing lights up. It is
//! light or dark, like the reader's system.

mod axis;
mod boxes;
mod cards;
mod convergence;
mod frame;
mod markup;
mod outcomes;
mod overlay;
mod paths;
mod planners;
mod quantities;
mod ranking;

pub use axis::Axis;
pub use frame::{Frame, frame};
pub use markup::{chart, image_source, number, table, text};
pub use overlay::Overlay;
pub use paths::PathPictures;

use super::comparison::Comparison;
use super::measure::Measure;
use super::study::Study;
use super::table::Table;
use super::words::words;
use cplan_model::Status;
use cplan_text::{counted, markup};

/// A picture that a page includes.
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
    /// Drawings of some problems, in the order of the page.
    pub pictures: &'a [PathPictures],
}

impl Page<'_> {
    /// Returns the page. The same data give the same bytes.
    pub fn html(&self) -> String {
        let study = self.study;
        let style = format!("{COMPARISON_STYLE}{}", paths::colors(self.pictures));
        let mut html = head(&study.headline(), &format!("{} \u{b7} {}", study.title, self.subtitle()), &style, true);
        for alarm in study.alarms() {
            html +=
                &format!("<p class=\"alarm\" role=\"alert\"><strong>Contradiction.</strong> {}</p>\n", markup(&alarm));
        }
        html += &format!("<p class=\"conclusion\">{}{}</p>\n", self.verdict_sign(), with_names(&study.conclusion()));
        html += &cards::cards(study, self.pictures);
        html += &match &study.comparisons[..] {
            [only] => section("Paths and planners", &planners::of_problem(only, self.pictures.first())),
            _ => section("Planners", &planners::of_study(study)) + &self.charts() + &self.problems(),
        };
        html += &self.details();
        html + &foot(METHOD_NOTE).replacen("</main>", &format!("</main>\n{}", script()), 1)
    }

    fn subtitle(&self) -> String {
        let refused = match self.study.refused.len() {
            0 => String::new(),
            n => format!(" ({n} more not run)"),
        };
        if let [only] = &self.study.comparisons[..] {
            return format!("{}{refused}", only.outcome());
        }
        let planners = counted(self.study.planners().len(), "planner");
        let problems = counted(self.study.comparisons.len(), "problem");
        format!("{problems}{refused}, {planners}. {}", words(self.study).first().map_or("", String::as_str))
    }

    /// Returns the sign of the best outcome of a single problem.
    fn verdict_sign(&self) -> String {
        let best = |only: &Comparison| {
            Status::ALL.into_iter().find(|status| only.rows.iter().any(|row| row.outcome == *status))
        };
        let outcome = if let [only] = &self.study.comparisons[..] { best(only) } else { None };
        outcome.map_or_else(String::new, |outcome| {
            format!("<span class=\"o-{outcome} sign\">{}</span> ", outcomes::sign(outcome))
        })
    }

    /// Draws box plots if there are enough runs of each planner.
    fn charts(&self) -> String {
        if self.study.comparisons.len() < boxes::MIN_RUNS {
            return String::new();
        }
        let chart = |measure: Measure| {
            let chart = boxes::chart(self.study, measure)?;
            Some(figure(measure.heading(), &chart))
        };
        let charts: String = Measure::ALL.into_iter().filter_map(chart).collect();
        if charts.is_empty() {
            return charts;
        }
        let note = "Box: the middle half of the runs; bar in the box: the median; whiskers: the least and the greatest value; dots: single runs. Axes are logarithmic where values differ much.";
        section("Distributions", &format!("<div class=\"charts\">\n{charts}</div>\n<p class=\"sub\">{note}</p>\n"))
    }

    /// Shows many problems: their outcomes, for a world all paths of each planner, and a part for each drawn problem.
    fn problems(&self) -> String {
        let matrix = outcomes::key() + &outcomes::matrix(self.study);
        let many = self.study.comparisons.len() > MAX_UNFOLDED_PROBLEMS;
        let mut html = if many { collapsible_section("Problem by problem", &matrix) } else { matrix };
        for (id, overlay) in self.overlays.iter().enumerate() {
            let note =
                overlay.note.as_deref().map_or_else(String::new, |n| format!("<p class=\"sub\">{}</p>\n", markup(n)));
            html += &format!("<h3>{}</h3>\n{note}{}", markup(&overlay.title), overlay::panels(overlay, id));
        }
        for (index, picture) in self.pictures.iter().enumerate() {
            let Some(comparison) = self.study.comparisons.get(picture.problem) else { continue };
            let heading = format!("{}: {}", comparison.problem, comparison.outcome());
            let conclusion = format!("<p>{}</p>\n", with_names(&comparison.conclusion()));
            let part = collapsible_section(&heading, &(conclusion + &planners::of_problem(comparison, Some(picture))));
            // Without other pictures, the first part is unfolded, because a page of only folded parts looks empty.
            let is_unfolded = self.overlays.is_empty() && index == 0;
            html += &if is_unfolded { part.replacen("<details", "<details open=\"\"", 1) } else { part };
        }
        section("Problems", &html)
    }

    /// Returns the summary in words, all tables and the notes, folded.
    fn details(&self) -> String {
        let sentences: String = words(self.study).iter().map(|w| paragraph(w)).collect();
        let mut html = collapsible_section("In words", &sentences);
        html += &match &self.study.comparisons[..] {
            // A single problem has no distributions.
            [only] => collapsible_section("All figures", &table(&only.table())),
            _ => {
                let part =
                    |(heading, rows): (String, Table)| format!("<h3>{}</h3>\n{}", markup(&heading), table(&rows));
                collapsible_section("All figures", &self.study.tables().into_iter().map(part).collect::<String>())
            }
        };
        let notes: String = self.study.footnotes().map(|note| format!("<li>{}</li>\n", markup(&note))).collect();
        if !notes.is_empty() {
            html += &format!("<h3>Notes</h3>\n<ul class=\"notes\">\n{notes}</ul>\n");
        }
        section("Details", &html)
    }
}

/// Formats a sentence in which names are between backticks. Names are shown as code.
fn with_names(text: &str) -> String {
    let part = |(index, part): (usize, &str)| {
        if index % 2 == 1 { format!("<code class=\"planner\">{}</code>", markup(part)) } else { markup(part) }
    };
    text.split('`').enumerate().map(part).collect()
}

/// Returns the element with the page's script. Marked as character data, the script means the same in HTML and in XML.
fn script() -> String {
    format!("<script>\n//<![CDATA[\n{SCRIPT}//]]>\n</script>")
}

/// Returns the beginning of a page, up to its title. Names between backticks in the title become code. `style` is added to the
/// style sheet. `has_script` is true if the page has scripts.
pub fn head(title: &str, subtitle: &str, style: &str, has_script: bool) -> String {
    let scripts = if has_script { "; script-src 'unsafe-inline'" } else { "" };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <meta name=\"color-scheme\" content=\"light dark\"/>\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; font-src data:; style-src 'unsafe-inline'{3}\"/>\n\
         <title>{0}</title>\n<style>\n{2}{STYLE}{4}</style>\n</head>\n<body>\n<main>\n<header><h1>{5}</h1>\n<p class=\"sub\">{1}</p></header>\n",
        markup(&title.replace('`', "")),
        markup(subtitle),
        cplan_theme::css(),
        scripts,
        style,
        with_names(title)
    )
}

/// Returns the foot of a page. `how` is an HTML text about how the numbers were obtained.
pub fn foot(how: &str) -> String {
    format!("<footer>{how}</footer>\n</main>\n</body>\n</html>\n")
}

/// Number of problems above which their list is folded.
const MAX_UNFOLDED_PROBLEMS: usize = 40;

/// The style sheet of reports, after the one of all pages.
const STYLE: &str = include_str!("style.css");

/// The style sheet of comparisons.
const COMPARISON_STYLE: &str = include_str!("compare.css");

/// The code that sorts tables and lights paths up.
const SCRIPT: &str = include_str!("compare.js");

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
pub fn section(heading: &str, content: &str) -> String {
    format!("<section>\n<h2>{}</h2>\n{content}</section>\n", markup(heading))
}

/// Formats a part of a page that is hidden until its heading is clicked.
pub fn collapsible_section(heading: &str, content: &str) -> String {
    format!("<details><summary>{}</summary>\n{content}</details>\n", markup(heading))
}

/// Returns a chart with its title.
pub fn figure(title: &str, chart: &str) -> String {
    format!("<figure class=\"card\"><figcaption>{}</figcaption>\n{chart}</figure>\n", markup(title))
}
