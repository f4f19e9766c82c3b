//! The page.

use crate::draw::{drawing, shell};

/// What moves things in the page, in the order in which one part needs the other.
const CODE: [&str; 7] = [
    include_str!("assets/link.js"),
    include_str!("assets/keep.js"),
    include_str!("assets/notices.js"),
    include_str!("assets/scene.js"),
    include_str!("assets/edit.js"),
    include_str!("assets/controls.js"),
    include_str!("assets/live.js"),
];

/// The page with its scripts and styles in one document, for a browser that has been led to a server.
#[must_use]
pub fn page() -> String {
    shell("cplan", "", include_str!("assets/live.css"), "", &(drawing() + &CODE.concat()))
}
