//! Checks that the pictures of the documentation equal those that the program draws.

use crate::rounding;
use cplan_testkit::course::FIGURES;
use cplan_testkit::pictures::{MOVING, PICTURES};
use std::fs;
use std::path::Path;

#[test]
fn pictures_are_up_to_date() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures");
    for (name, subject) in PICTURES {
        let kept = fs::read_to_string(folder.join(name).with_extension("svg")).unwrap();
        let drawn = subject.svg().unwrap();
        assert!(rounding::same(&kept, &drawn), "{name}.svg is out of date: cargo run --release --example pictures");
    }
    let files = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    assert_eq!(files.filter(|f| f.extension().is_some_and(|e| e == "svg")).count(), PICTURES.len());
    assert!(PICTURES.iter().any(|(name, _)| *name == MOVING.1), "a moving picture has a still one");
}

/// Greatest size of a figure of the course, in bytes.
const MAX_FIGURE_SIZE: usize = 12_000;

#[test]
fn figures_of_the_course_are_up_to_date_and_shown() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let chapters = ["c_obstacles", "roadmaps", "cells", "waves", "fields", "proofs", "tasks"];
    let texts = chapters.map(|chapter| fs::read_to_string(docs.join(chapter).with_extension("md")).unwrap());
    for (name, draw) in FIGURES {
        let kept = fs::read_to_string(docs.join("pictures/course").join(name).with_extension("svg")).unwrap();
        assert!(rounding::same(&kept, &draw().svg()), "{name}.svg is out of date: cargo run --example pictures");
        assert!(kept.len() <= MAX_FIGURE_SIZE, "{name}.svg has {} bytes", kept.len());
        let link = format!("(pictures/course/{name}.svg)");
        assert_eq!(texts.iter().filter(|text| text.contains(&link)).count(), 1, "{name}");
    }
    assert!(texts.iter().all(|text| text.contains("(pictures/course/")), "each chapter has a figure");
}

/// Checks that the animated picture ends with the still one. Drawing all frames takes seconds, so the other frames are
/// not compared.
#[cfg(feature = "png")]
#[test]
fn the_picture_that_moves_is_up_to_date() {
    use cplan::PlanOutput as _;
    let (name, of) = MOVING;
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures").join(name).with_extension("gif");
    let bytes = fs::read(file).unwrap();
    let (count, kept) = crate::draw::moving::last_picture(&bytes, 960);
    let (_, subject) = PICTURES.iter().find(|(name, _)| *name == of).unwrap();
    let drawn = cplan::view::figure(&subject.plan().unwrap().view()).png(960.0 / 1400.0).unwrap();
    let drawn = tiny_skia::Pixmap::decode_png(&drawn).unwrap();
    let near = |(a, b): (&tiny_skia::PremultipliedColorU8, &[u8; 3])| {
        [(a.red(), b[0]), (a.green(), b[1]), (a.blue(), b[2])].iter().all(|(a, b)| a.abs_diff(*b) <= 24)
    };
    let same = drawn.pixels().iter().zip(&kept).filter(|&pair| near(pair)).count();
    assert!(count > 80 && drawn.pixels().len() == kept.len());
    assert!(same > kept.len() / 1000 * 995, "{name}.gif is out of date: cargo run --release --example pictures");
}
