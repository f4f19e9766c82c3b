//! The live figures of the course, which `.ci/book` puts into the book: a command of the chapter writes the page.

use super::pages_in;

#[test]
fn live_figures_stand_behind_a_picture_and_are_written_by_their_chapter() {
    let mut chapters = 0;
    for page in pages_in("docs") {
        let mut picture = false;
        for (line, text) in page.prose() {
            if let Some(live) = text.strip_prefix("<!-- live: ").and_then(|rest| rest.strip_suffix(" -->")) {
                let place = format!("{}:{line}", page.name);
                let (file, opened) =
                    live.split_once('#').unwrap_or_else(|| panic!("{place}: the page's first view is missing"));
                assert!(picture, "{place}: no picture for who reads the file");
                let chapter = file.strip_suffix(".html").expect("a page");
                assert_eq!(opened, format!("learn={chapter}"), "{place}: the chapter of the page's course");
                let writes =
                    |command: &str| command.starts_with("cplan ") && command.ends_with(&format!("--picture {file}"));
                let commands = page
                    .blocks()
                    .iter()
                    .map(|block| block.text.lines().filter(|line| writes(line)).count())
                    .sum::<usize>();
                assert_eq!(commands, 1, "{place}: a command that writes it");
                chapters += 1;
            }
            picture = text.starts_with("![");
        }
    }
    assert_eq!(chapters, 7);
}
