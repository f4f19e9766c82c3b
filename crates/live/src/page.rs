//! The page.

use super::Files;
use super::gallery::Gallery;
use cplan_text::base64;
use cplan_view::{drawing, shell};
use std::time::Duration;

/// What moves things in the page, in the order in which one part needs the other.
const CODE: [&str; 9] = [
    include_str!("assets/alone.js"),
    include_str!("assets/link.js"),
    include_str!("assets/keep.js"),
    include_str!("assets/notices.js"),
    include_str!("assets/scene.js"),
    include_str!("assets/gallery.js"),
    include_str!("assets/edit.js"),
    include_str!("assets/controls.js"),
    include_str!("assets/live.js"),
];

/// What a page that has the program within it may: run that in a worker, and load nothing.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval'; worker-src blob:; style-src 'unsafe-inline'; \
                      img-src blob: data:; base-uri 'none'; form-action 'none'";

/// The page with its scripts and styles in one document, for a browser that has been led to a server.
#[must_use]
pub fn page() -> String {
    live("", &data(&Gallery::new(None)))
}

/// The page with the program within it, WebAssembly packed by gzip: one file, which needs no server and loads nothing. A plan may
/// take that much time.
#[must_use]
pub fn page_alone(files: Files, time: Duration, program: &[u8]) -> String {
    let policy = format!("<meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n");
    let worker = element("worker", "text/plain", include_str!("assets/worker.js"));
    let program = element("program", "text/plain", &base64(program));
    live(&policy, &(data(&Gallery::new(Some((files, time)))) + &worker + &program))
}

/// What the page reads. Texts and numbers: there is nothing that JSON cannot say. Within a script only the less-than sign could end it.
fn data(gallery: &Gallery) -> String {
    let json = serde_json::to_string(gallery).unwrap_or_default().replace('<', "\\u003c");
    element("gallery", "application/json", &json)
}

fn element(id: &str, kind: &str, text: &str) -> String {
    format!("<script id=\"{id}\" type=\"{kind}\">{text}</script>\n")
}

fn live(head: &str, before: &str) -> String {
    shell("cplan", head, include_str!("assets/live.css"), before, &(drawing() + &CODE.concat()))
}
