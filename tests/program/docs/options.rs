//! The program has every option that the text names.

use super::pages;
use crate::cli::Place;
use crate::cli::help::commands;
use std::collections::BTreeSet;

/// Options of other programs that the text names without a command.
const OTHERS: [&str; 2] = ["--check", "--no-default-features"];

/// Returns the long options in a text.
fn options(text: &str) -> Vec<&str> {
    let starts =
        text.match_indices("--").filter(|(at, _)| !text[..*at].ends_with(|c: char| c == '-' || c.is_alphanumeric()));
    let ends = |c: char| !c.is_ascii_lowercase() && c != '-';
    let found = starts.map(|(at, _)| text[at..].split(ends).next().unwrap_or_default());
    found.filter(|option| option.starts_with('-') && option.trim_start_matches('-').len() > 1).collect()
}

#[test]
fn every_named_option_exists() {
    let place = Place::new();
    let mut known: BTreeSet<String> = OTHERS.iter().map(|&option| option.to_owned()).collect();
    for command in [String::new()].into_iter().chain(commands(&place)) {
        let words: Vec<&str> = [command.as_str(), "--help"].into_iter().filter(|word| !word.is_empty()).collect();
        known.extend(options(&place.run(&words, "").stdout).into_iter().map(str::to_owned));
    }
    assert!(known.contains("--goal-tip") && known.contains("--with"), "{known:?}");
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for page in pages() {
        for (line, text) in page.prose() {
            // This test does not know the command lines of other programs.
            let code = text
                .split('`')
                .skip(1)
                .step_by(2)
                .filter(|code| !["cargo ", "mdbook ", "benches/"].iter().any(|p| code.contains(p)));
            for option in code.flat_map(options) {
                seen += 1;
                if !known.contains(option) {
                    wrong.push(format!("{}:{line}: {option}", page.name));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "options that the program has not:\n{}", wrong.join("\n"));
    assert!(seen > 60, "only {seen} options");
}
