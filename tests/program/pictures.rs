//! The pictures of the documentation are what the program draws today.

#[path = "../../examples/pictures/drawn.rs"]
mod drawn;

use crate::rounding;
use std::fs;
use std::path::Path;

#[test]
fn pictures_are_up_to_date() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures");
    for (name, subject) in drawn::PICTURES {
        let kept = fs::read_to_string(folder.join(name).with_extension("svg")).unwrap();
        let drawn = subject.svg().unwrap();
        assert!(rounding::same(&kept, &drawn), "{name}.svg is out of date: cargo run --release --example pictures");
    }
    let files = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    assert_eq!(files.filter(|f| f.extension().is_some_and(|e| e == "svg")).count(), drawn::PICTURES.len());
}
