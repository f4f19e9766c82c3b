//! The course as pages in a folder.

use super::*;
use std::collections::BTreeSet;
use std::path::PathBuf;

fn values<'a>(page: &'a str, attribute: &str) -> Vec<&'a str> {
    let opening = format!(" {attribute}=\"");
    page.split(opening.as_str()).skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
}

/// Returns the files of a folder, without those of its folders.
fn files(place: &Place) -> BTreeSet<PathBuf> {
    let entries = std::fs::read_dir(place.path(".")).unwrap().map(|entry| entry.unwrap().path());
    entries.filter(|path| path.is_file()).collect()
}

#[test]
fn the_pages_of_the_course_need_nothing_else() {
    let place = Place::new();
    place.run(&["course", "lessons"], "").exits(0).says(&["lessons", "index.html", "answers"]);
    let pages = [
        "index.html",
        "exercises.html",
        "c_obstacles.html",
        "roadmaps.html",
        "cells.html",
        "waves.html",
        "fields.html",
        "proofs.html",
        "tasks.html",
    ];
    let mut figures = 0;
    for name in pages.iter().chain(&["answers/index.html"]) {
        let page = place.read(&format!("lessons/{name}"));
        let folder = if name.starts_with("answers") { "lessons/answers/" } else { "lessons/" };
        let mut targets = 0;
        for target in values(&page, "href").into_iter().chain(values(&page, "src")) {
            if let Some(anchor) = target.strip_prefix('#') {
                assert!(page.contains(&format!("id=\"{anchor}\"")), "{name}: {target}");
                continue;
            }
            let network = target.starts_with("https://");
            let file = target.split('#').next().unwrap();
            assert!(network || place.path(&format!("{folder}{file}")).is_file(), "{name}: {target}");
            targets += 1;
            figures += usize::from(target.starts_with("live/"));
        }
        assert!(targets > 1, "{name}");
        // Answers are in their own folder alone, to which no page leads.
        assert_eq!(page.contains("<details"), name.starts_with("answers"), "{name}");
        assert!(!page.contains("answers/"), "{name}");
    }
    assert_eq!(figures, 7);
    let index = place.read("lessons/index.html");
    assert!(pages[2..].iter().all(|page| index.contains(&format!("href=\"{page}\""))), "{index}");
    // Every exercise is on the sheet and has an answer.
    let [sheet, answers] = ["exercises", "answers/index"].map(|page| place.read(&format!("lessons/{page}.html")));
    let count = |page: &str, what: &str| page.matches(what).count();
    assert_eq!(count(&answers, "<details"), count(&sheet, "<li>"));
    assert!(count(&sheet, "<li>") >= 21, "{sheet}");
    // Each can be done alone: it has a command with its robot and its world.
    for exercise in sheet.split("<li>").skip(1) {
        let text = exercise.split("</li>").next().unwrap();
        assert!(text.contains("<code>cplan ") && text.contains("robots/") && text.contains("workspaces/"), "{text}");
    }
    assert_eq!([count(&index, "<img "), count(&index, "</a><p>")], [7, 7], "{index}");
}

#[test]
fn live_figures_are_the_pages_of_the_chapters_commands() {
    let place = Place::new();
    place.run(&["course", "lessons"], "").exits(0);
    let commands = [
        ("waves", ["planar_2r", "workbench"], "--planner wavefront"),
        ("fields", ["planar_2r", "u_trap"], "--planner harmonic --cells 64"),
        ("tasks", ["rrbot_vertical", "tasks/tower"], ""),
    ];
    for (name, [robot, world], options) in commands {
        let files = [shipped(&format!("robots/{robot}.urdf")), shipped(&format!("workspaces/{world}.toml"))];
        place.run(&files, &format!("{options} --quiet --picture {name}.html"));
        let [figure, page] =
            [format!("lessons/live/{name}.html"), format!("{name}.html")].map(|page| place.read(&page));
        assert!(figure == page, "{name}: the page is another one");
    }
    // The page of a proof says what blocks the arm.
    assert!(place.read("lessons/live/proofs.html").contains("opens a path"));
}

#[test]
fn existing_files_are_kept() {
    let place = Place::new();
    place.run(&["course", "."], "").exits(0);
    let written = files(&place);
    place.write("waves.html", "my own");
    let refusal = ["already has ", " files of a course, such as ", "index.html", "another folder", "--force"];
    let answer = place.run(&["course", "."], "");
    answer.refused(1, &refusal);
    assert!(!answer.stderr.contains("waves.html"), "one file stands for all: {}", answer.stderr);
    assert_eq!(place.read("waves.html"), "my own");
    place.run(&["course", "."], "--force").exits(0);
    assert_ne!(place.read("waves.html"), "my own");
    assert_eq!(files(&place), written);
    place.write("file", "");
    place.run(&["course", "file"], "").refused(1, &["file"]);
    place.write("engine", "not packed");
    place.run(&["course", "other"], "--engine engine").refused(1, &["engine", "gzip"]);
    assert!(!place.path("other").exists());
}
