//! The README and the book: their commands run, the shown output is correct, and their links have targets.

mod commands;
mod links;
mod live;
mod options;
mod page;
mod shown;

use page::Page;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns all pages in a folder of the repository, in order.
fn pages_in(folder: &str) -> Vec<Page> {
    let entries = std::fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = entries.filter(|file| file.extension().is_some_and(|e| e == "md")).collect();
    files.sort();
    files.iter().map(|file| Page::read(file)).collect()
}

/// Returns the README and the pages of the book.
fn pages() -> Vec<Page> {
    let mut pages = vec![Page::read(&root().join("README.md"))];
    pages.extend(pages_in("docs"));
    assert!(pages.len() > 12, "{}", pages.len());
    pages
}

#[test]
fn the_readme_is_a_page() {
    let size = std::fs::read(root().join("README.md")).unwrap().len();
    assert!(size <= 8 * 1024, "the README has {size} bytes: move the rest into docs");
}

/// Checks that the summary lists every page once. mdBook builds a book from exactly the pages in the summary.
#[test]
fn the_summary_lists_every_page_once() {
    let summary = Page::read(&root().join("docs/SUMMARY.md"));
    let mut listed: Vec<String> = summary.links().into_iter().map(|link| link.target).collect();
    listed.sort();
    let names =
        pages_in("docs").iter().map(|page| page.name.rsplit('/').next().unwrap().to_owned()).collect::<Vec<_>>();
    let mut names: Vec<String> = names.into_iter().filter(|name| name != "SUMMARY.md").collect();
    names.sort();
    assert_eq!(listed, names);
}
