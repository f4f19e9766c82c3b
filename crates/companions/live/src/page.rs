//! Assembles the page from its scripts and styles.

use super::Files;
use super::gallery::Gallery;
use cplan_text::base64;
use cplan_view::{drawing, shell};
use std::time::Duration;

/// The scripts of the page, in the order of their dependencies.
const SCRIPTS: [&str; 14] = [
    include_str!("assets/alone.js"),
    include_str!("assets/link.js"),
    include_str!("assets/keep.js"),
    include_str!("assets/frames.js"),
    include_str!("assets/icons.js"),
    include_str!("assets/notices.js"),
    include_str!("assets/scene.js"),
    include_str!("assets/nearest.js"),
    include_str!("assets/gallery.js"),
    include_str!("assets/edit.js"),
    include_str!("assets/inspector.js"),
    include_str!("assets/controls.js"),
    include_str!("assets/why.js"),
    include_str!("assets/live.js"),
];

/// Content security policy of a page with the program inside. The page may run the program in a worker, but must load nothing.
const CONTENT_POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval'; worker-src blob:; style-src 'unsafe-inline'; \
                      img-src blob: data:; font-src data:; base-uri 'none'; form-action 'none'";

/// Returns the page with its scripts and styles as one document. In the browser, it connects to a server.
pub fn page() -> String {
    live("", &data(&Gallery::new(None)))
}

/// Returns the page with the program inside, as WebAssembly packed by gzip. The page is one file that needs no server
/// and loads nothing. `time` limits a plan.
pub fn standalone_page(files: Files, time: Duration, program: &[u8]) -> String {
    let policy = format!("<meta http-equiv=\"Content-Security-Policy\" content=\"{CONTENT_POLICY}\">\n");
    let worker = element("worker", "text/plain", include_str!("assets/worker.js"));
    let program = element("program", "text/plain", &base64(program));
    live(&policy, &(data(&Gallery::new(Some((files, time)))) + &worker + &program))
}

/// Returns the page's data as JSON. The sign `<` is escaped, because only it could end the script.
fn data(gallery: &Gallery) -> String {
    let json = serde_json::to_string(gallery).unwrap_or_default().replace('<', "\\u003c");
    element("gallery", "application/json", &json)
}

fn element(id: &str, kind: &str, text: &str) -> String {
    format!("<script id=\"{id}\" type=\"{kind}\">{text}</script>\n")
}

fn live(head: &str, before: &str) -> String {
    shell("cplan", head, include_str!("assets/live.css"), before, &(drawing() + &SCRIPTS.concat()))
}
