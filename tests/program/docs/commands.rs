//! Runs every command that the pages show, in a separate folder for each page, with the shipped robots and workspaces
//! beside it.
//!
//! Comments above a block hold instructions for the test:
//! - `<!-- not run: why -->`: the block is not run.
//! - `<!-- exit: 3 -->`: the exit code is not 0.
//! - `<!-- file: world.toml -->`: the block is written to a file.
//! - `<!-- edit: world.toml: this -> that -->`: the text describes a change of a file.
//! - `<!-- part of: plan.yaml -->`: the block shows a part of a file.
//! - `<!-- run: the commands of the table -->`, above a table: the code in its cells is run. `(exit 4)` behind a
//!   command is its exit code. Examples that the table names must exist.

use super::page::{Block, Page};
use super::{pages, root, shown::difference};
use crate::cli::Place;
use crate::cli::help::{copy, words};
use std::sync::Mutex;

/// A command, and its output on the page.
struct Shown<'a> {
    line: usize,
    command: &'a str,
    says: Option<String>,
}

fn commands(block: &Block) -> Vec<Shown<'_>> {
    let mut commands: Vec<Shown> = Vec::new();
    for (line, text) in (block.line..).zip(block.text.lines()) {
        match (block.language.as_str(), text.strip_prefix("$ "), commands.last_mut()) {
            ("sh", ..) => commands.push(Shown { line, command: text, says: None }),
            (_, Some(command), _) => commands.push(Shown { line, command, says: Some(String::new()) }),
            (_, None, Some(Shown { says: Some(says), .. })) => says.push_str(&format!("{text}\n")),
            _ => panic!("line {line}: {text:?} is neither a command nor the text that one prints"),
        }
    }
    commands
}

/// Returns `None` if the output of a command matches the page. Otherwise returns the difference.
fn run(place: &Place, shown: &Shown, code: i32) -> Option<String> {
    let command = shown.command;
    let arguments = ["cplan ", "cargo run --release -- "].iter().find_map(|program| command.strip_prefix(program));
    let Some(arguments) = arguments else { return Some("no command of cplan: mark it as not run, and why".into()) };
    let done = place.run(&words(arguments), "");
    if done.code != code {
        return Some(format!("exit code {} instead of {code}\n{}{}", done.code, done.stdout, done.stderr));
    }
    let report = if done.stdout.is_empty() { &done.stderr } else { &done.stdout };
    difference(shown.says.as_ref()?, report)
}

/// The mark of tables of commands.
const OF_TABLE: &str = "<!-- run: the commands of the table -->";

/// Runs the commands of the tables of a page. Returns how many ran, and the failures.
fn run_tables(page: &Page) -> (usize, Vec<String>) {
    let place = Place::new();
    for folder in ["robots", "workspaces"] {
        copy(&root().join(folder), &place.path(folder));
    }
    let (mut ran, mut wrong, mut is_in_table) = (0, Vec::new(), false);
    for (line, text) in page.prose() {
        is_in_table = text == OF_TABLE || is_in_table && text.starts_with('|');
        // Code is between every other pair of backquotes.
        let parts: Vec<&str> = if is_in_table { text.split('`').collect() } else { Vec::new() };
        for (code, after) in parts.iter().zip(&parts[parts.len().min(1)..]).skip(1).step_by(2) {
            let example = code.strip_prefix("cargo run ").and_then(|options| options.split_once("--example "));
            let fault = if let Some((package, name)) = example {
                let package = package.trim().strip_prefix("-p cplan-").map(|name| format!("crates/companions/{name}"));
                let examples = root().join(package.unwrap_or_default()).join("examples");
                let is_there = |file: String| examples.join(file).exists();
                let is_example = is_there(format!("{name}.rs")) || is_there(format!("{name}/main.rs"));
                (!is_example).then(|| "there is no such example".to_owned())
            } else {
                let exit = after.strip_prefix(" (exit ").and_then(|rest| rest.split(')').next());
                let exit = exit.map_or(0, |code| code.parse().expect("an exit code"));
                run(&place, &Shown { line, command: code, says: None }, exit)
            };
            ran += 1;
            wrong.extend(fault.map(|what| format!("{}:{line}: {code}: {what}", page.name)));
        }
    }
    (ran, wrong)
}

#[cfg_attr(not(all(feature = "png", feature = "mcap", feature = "serve")), ignore = "pages use every feature")]
#[test]
fn every_command_of_a_table_does_something() {
    let (mut ran, mut wrong) = (0, Vec::new());
    for page in pages() {
        let (commands, faults) = run_tables(&page);
        ran += commands;
        wrong.extend(faults);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    assert!(ran >= 60, "only {ran} commands");
}

/// Follows the blocks of a page from the first to the last. Returns how many commands ran, and the failures.
fn follow(page: &Page) -> (usize, Vec<String>) {
    let place = Place::new();
    for folder in ["robots", "workspaces"] {
        copy(&root().join(folder), &place.path(folder));
    }
    let (mut ran, mut wrong) = (0, Vec::new());
    for block in page.blocks() {
        let at = format!("{}:{}", page.name, block.line);
        for mark in &block.marks {
            let known =
                ["not run: ", "exit: ", "file: ", "edit: ", "part of: "].iter().any(|key| mark.starts_with(key));
            assert!(known, "{at}: nobody reads the mark {mark:?}");
        }
        if let Some(edit) = block.mark("edit") {
            let (file, change) = edit.split_once(": ").unwrap_or_else(|| panic!("{at}: FILE: this -> that"));
            let (this, that) = change.split_once(" -> ").unwrap_or_else(|| panic!("{at}: FILE: this -> that"));
            let text = place.read(file);
            assert!(text.contains(this), "{at}: {file} has no {this:?}");
            place.write(file, text.replace(this, that));
        }
        if let Some(file) = block.mark("file") {
            place.write(file, &block.text);
        }
        if let Some(file) = block.mark("part of")
            && !place.read(file).contains(&block.text)
        {
            wrong.push(format!("{at}: {file} does not hold that"));
        }
        if !["sh", "console"].contains(&block.language.as_str()) || block.mark("not run").is_some() {
            continue;
        }
        let code = block.mark("exit").map_or(0, |code| code.parse().expect("an exit code"));
        for shown in commands(&block) {
            ran += 1;
            wrong.extend(
                run(&place, &shown, code)
                    .map(|what| format!("{}:{}: {}: {what}", page.name, shown.line, shown.command)),
            );
        }
    }
    (ran, wrong)
}

#[cfg_attr(not(all(feature = "png", feature = "mcap", feature = "serve")), ignore = "pages use every feature")]
#[test]
fn every_command_prints_the_shown_output() {
    let (ran, wrong) = (Mutex::new(0), Mutex::new(Vec::new()));
    let pages = pages();
    std::thread::scope(|scope| {
        for page in &pages {
            let (ran, wrong) = (&ran, &wrong);
            scope.spawn(move || {
                let (commands, faults) = follow(page);
                *ran.lock().unwrap() += commands;
                wrong.lock().unwrap().extend(faults);
            });
        }
    });
    let (ran, mut wrong) = (ran.into_inner().unwrap(), wrong.into_inner().unwrap());
    wrong.sort();
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    assert!(ran >= 30, "only {ran} commands");
}
