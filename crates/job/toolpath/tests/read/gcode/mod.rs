//! Tests of reading G-code: values, placements, words, and errors by the name and the place of a word.

mod arcs;
mod moves;
mod oracle;
mod programs;
mod words;

use cplan_toolpath::{Error, Format, Placement, Toolpath, read};

fn program(text: &str) -> Toolpath {
    read(text.as_bytes(), Format::GCode, &Placement::default()).expect("a line")
}

fn refused(text: &str) -> Error {
    read(text.as_bytes(), Format::GCode, &Placement::default()).expect_err("an error")
}

fn near(a: [f64; 2], b: [f64; 2]) -> bool {
    (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-12
}

/// Returns the ends of the pieces, millimetres.
fn ends(text: &str) -> Vec<[f64; 2]> {
    let millimetres = |x: f64| (x * 1e12).round() / 1e9;
    program(text).pieces().iter().map(|piece| piece.curve.end().map(millimetres)).collect()
}
