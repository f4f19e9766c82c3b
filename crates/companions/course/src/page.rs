//! The pages: an index, the chapters, a sheet of all exercises, and a sheet of all answers.

use crate::chapter::Chapter;
use crate::html::Links;
use cplan_text::markup;
use std::fmt::Write as _;

/// A file of the course.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CourseFile {
    /// Path in the folder of the course, with `/`.
    pub path: String,
    /// The content.
    pub text: String,
}

/// Script that gives a live figure the height that it reports, and the full width of the window.
const SCRIPT: &str = include_str!("course.js");

/// Style of the pages, in addition to that of all pages of cplan.
const STYLE: &str = include_str!("course.css");

/// Returns the pages of the course and their style sheet. The live figures and the pictures are not included. `has_lab`
/// states whether there is a page `lab.html` that contains the planner.
pub fn files(chapters: &[Chapter], has_lab: bool) -> Vec<CourseFile> {
    let names: Vec<&str> = chapters.iter().map(|chapter| chapter.name).collect();
    let of = |path: &str, text: String| CourseFile { path: path.to_owned(), text };
    let mut files = vec![
        of("index.html", index(chapters, has_lab)),
        of("exercises.html", exercises(chapters, &names)),
        of("answers/index.html", answers(chapters, &names)),
        of("style.css", cplan_theme::css() + STYLE),
    ];
    files.extend((0..chapters.len()).map(|k| of(&format!("{}.html", names[k]), chapter_page(chapters, &names, k))));
    files
}

fn page(title: &str, root: &str, content: &str) -> String {
    let title = markup(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <link rel=\"stylesheet\" href=\"{root}style.css\">\n<script>\n{SCRIPT}</script>\n</head>\n<body>\n<main>\n{content}</main>\n\
         </body>\n</html>\n"
    )
}

/// Returns the page with the list of chapters.
fn index(chapters: &[Chapter], has_lab: bool) -> String {
    let mut content = String::from(
        "<h1>Configuration spaces: a course</h1>\n<p>Seven chapters explain how a robot arm plans its motions. Each has a figure in \
         which you move the arm, and exercises. The pages need no network and no installation.</p>\n<ol class=\"chapters\">\n",
    );
    for chapter in chapters {
        let (name, title, aim) = (chapter.name, markup(chapter.title()), markup(chapter.aim));
        let picture = chapter.first_picture().map(|path| format!("<img src=\"{}\" alt=\"\">", markup(path)));
        let picture = picture.unwrap_or_default();
        let _ = writeln!(
            content,
            "<li><div>{picture}</div><div><a href=\"{name}.html\">{title}</a><p>{aim}</p></div></li>"
        );
    }
    content += "</ol>\n<p><a href=\"exercises.html\">All exercises on one sheet</a>, to print.</p>\n";
    if has_lab {
        content += "<p><a href=\"lab.html\">The laboratory</a>: a cell with a planner inside the page, for your own experiments.</p>\n";
    }
    page("Configuration spaces: a course", "", &content)
}

/// Returns the links to the previous and the next chapter, and to the index.
fn neighbors(chapters: &[Chapter], at: usize) -> String {
    let to = |chapter: Option<&Chapter>, words: [&str; 2]| {
        let link = |chapter: &Chapter| {
            let (name, title) = (chapter.name, markup(chapter.title()));
            format!("<a href=\"{name}.html\">{}{title}{}</a>", words[0], words[1])
        };
        chapter.map_or_else(|| "<span></span>".to_owned(), link)
    };
    let before = to(at.checked_sub(1).and_then(|k| chapters.get(k)), ["← ", ""]);
    let after = to(chapters.get(at + 1), ["", " →"]);
    format!("<nav>{before}<a href=\"index.html\">All chapters</a>{after}</nav>\n")
}

fn chapter_page(chapters: &[Chapter], names: &[&str], at: usize) -> String {
    let chapter = &chapters[at];
    let figure = chapter.figure();
    let links = |figure| Links { chapters: names, root: "", figure };
    let title = chapter.title();
    let explanation = links(figure.as_ref()).html(chapter.explanation());
    let exercises = links(None).html(&chapter.exercises());
    let around = neighbors(chapters, at);
    let heading = markup(title);
    let content =
        format!("{around}<h1>{heading}</h1>\n{explanation}<h2 id=\"exercises\">Exercises</h2>\n{exercises}{around}");
    page(title, "", &content)
}

/// Returns the sheet of all exercises, with room for answers.
fn exercises(chapters: &[Chapter], names: &[&str]) -> String {
    let links = Links { chapters: names, root: "", figure: None };
    let mut content = String::from(
        "<h1>Exercises</h1>\n<p class=\"person\">Name: </p>\n<p>Run the commands in the folder of cplan, which contains the folders \
         <code>robots</code> and <code>workspaces</code>. Each heading links to the chapter with its live figure.</p>\n",
    );
    for chapter in chapters {
        let (name, title) = (chapter.name, markup(chapter.title()));
        let questions = links.html(&chapter.exercises());
        let heading = format!("<h2><a href=\"{name}.html\">{title}</a></h2>");
        let _ = write!(content, "<section class=\"sheet\">\n{heading}\n{questions}</section>\n");
    }
    page("Exercises", "", &content)
}

/// Returns the sheet of all answers.
fn answers(chapters: &[Chapter], names: &[&str]) -> String {
    let links = Links { chapters: names, root: "../", figure: None };
    let mut content = String::from(
        "<h1>Answers</h1>\n<p>For teachers. Remove this folder from what students get: no other page leads here.</p>\n",
    );
    for chapter in chapters {
        // Show answers unfolded.
        let answers = chapter.answers().replace("<details>", "<details open>");
        let (title, answers) = (markup(chapter.title()), links.html(&answers));
        let _ = write!(content, "<section>\n<h2>{title}</h2>\n{answers}</section>\n");
    }
    page("Answers", "../", &content)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHAPTERS: [Chapter; 2] = [
        Chapter {
            name: "waves",
            aim: "How waves spread",
            text: "# Waves\n\nA *wave*, see [fields](fields.md#exercises) and [planners](planners.md).\n\n![Small](pictures/small.svg)\n\n![A picture](pictures/wave.svg)\n\
                   <!-- live: waves.html#learn=waves -->\n\n```sh\ncplan robots/a.urdf workspaces/b.toml --cells 64 --quiet --picture \
                   waves.html\n```\n\n![Another](pictures/other.svg)\n\n## Exercises\n\n1. Why?\n\n<details><summary>Answer</summary>\n\nBecause \
                   `a < b`.\n\n</details>\n\n2. How?\n\n<details><summary>Answer</summary>\n\nSo.\n\n</details>\n",
        },
        Chapter { name: "fields", aim: "How fields lead", text: "# Fields\n\nNo figure.\n" },
    ];

    fn text_of(path: &str) -> String {
        files(&CHAPTERS, false).into_iter().find(|file| file.path == path).unwrap().text
    }

    #[test]
    fn the_figure_is_live_and_answers_are_apart() {
        let page = text_of("waves.html");
        assert!(page.contains(r#"<iframe src="live/waves.html#learn=waves" title="A picture"></iframe>"#), "{page}");
        let has = |picture: &str| page.contains(&format!("src=\"pictures/{picture}.svg\""));
        assert!(has("small") && has("other") && !page.contains("wave.svg"), "{page}");
        assert!(page.contains(r#"<a href="fields.html#exercises">fields</a> and planners."#), "{page}");
        assert!(page.contains("Why?") && page.contains("How?") && !page.contains("Because"), "{page}");
        assert!(!page.contains("<!--") && !page.contains("answers/"), "{page}");
        let answers = text_of("answers/index.html");
        assert!(answers.contains("<details open>") && answers.contains("<code>a &lt; b</code>"), "{answers}");
        assert!(answers.contains("So.") && answers.contains("../style.css"), "{answers}");
        assert!(!text_of("exercises.html").contains("So."));
        assert!(!text_of("index.html").contains("answers"));
    }

    #[test]
    fn the_index_has_a_picture_and_the_aim_of_each_chapter() {
        let index = text_of("index.html");
        let waves =
            r#"<img src="pictures/small.svg" alt=""></div><div><a href="waves.html">Waves</a><p>How waves spread</p>"#;
        assert!(index.contains(waves), "{index}");
        let fields = r#"<li><div></div><div><a href="fields.html">Fields</a><p>How fields lead</p>"#;
        assert!(index.contains(fields), "{index}");
    }

    #[test]
    fn the_command_of_a_figure_is_read() {
        let figure = CHAPTERS[0].figure().unwrap();
        assert_eq!(
            (figure.page(), figure.robot.as_str(), figure.world.as_str()),
            ("waves.html", "robots/a.urdf", "workspaces/b.toml")
        );
        assert_eq!(figure.options, ["--cells", "64"]);
        assert_eq!(CHAPTERS[1].figure(), None);
    }
}
