//! The pictures of the documentation are what the program draws today, and the README shows no others.

#[path = "../../examples/pictures/drawn.rs"]
mod drawn;

use std::fs;
use std::path::Path;

/// Greatest difference of two numbers that are the same: the last of two decimals, which may round otherwise where another
/// machine's sine differs in its last bit.
const ROUNDING: f64 = 0.0101;

/// A text as what stands between its numbers, and the numbers.
fn taken_apart(text: &str) -> (Vec<&str>, Vec<f64>) {
    let is_number = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
    let (mut between, mut numbers) = (Vec::new(), Vec::new());
    let mut rest = text;
    while let Some(at) = rest.find(is_number) {
        let (before, from) = rest.split_at(at);
        let (number, after) = from.split_at(from.find(|c| !is_number(c)).unwrap_or(from.len()));
        match number.parse() {
            Ok(value) => {
                between.push(before);
                numbers.push(value);
            }
            // Dots and hyphens in words.
            Err(_) => between.extend([before, number]),
        }
        rest = after;
    }
    between.push(rest);
    (between, numbers)
}

#[test]
fn pictures_are_up_to_date() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures");
    for (name, subject) in drawn::PICTURES {
        let kept = fs::read_to_string(folder.join(name).with_extension("svg")).unwrap();
        let drawn = subject.svg().unwrap();
        let (words, numbers) = taken_apart(&drawn);
        let (kept_words, kept_numbers) = taken_apart(&kept);
        let same = words == kept_words && numbers.iter().zip(&kept_numbers).all(|(a, b)| (a - b).abs() <= ROUNDING);
        assert!(same, "{name}.svg is out of date: cargo run --release --example pictures");
    }
    let files = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    assert_eq!(files.filter(|f| f.extension().is_some_and(|e| e == "svg")).count(), drawn::PICTURES.len());
}

#[test]
fn the_readme_shows_only_pictures_that_are_drawn() {
    let readme = include_str!("../../README.md");
    let shown: Vec<&str> = readme
        .match_indices("docs/pictures/")
        .filter_map(|(at, prefix)| readme[at + prefix.len()..].split(')').next())
        .collect();
    assert!(shown.len() >= 3, "{shown:?}");
    for file in shown {
        let name = file.strip_suffix(".svg").unwrap_or_else(|| panic!("{file} is no SVG"));
        assert!(drawn::PICTURES.iter().any(|(known, _)| *known == name), "{file} is not drawn by the example");
    }
}

#[test]
fn texts_are_taken_apart_into_words_and_numbers() {
    let (words, numbers) = taken_apart("x=\"-1.5\" a-b.c 20");
    assert_eq!((words, numbers), (vec!["x=\"", "\" a", "-", "b", ".", "c ", ""], vec![-1.5, 20.0]));
}
