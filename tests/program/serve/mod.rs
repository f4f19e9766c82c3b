//! The live page's server from outside: plain HTTP, and its WebSocket as the page uses it.

mod client;
mod endurance;
mod opening;
mod pace;
mod pages;
mod plans;
mod refusals;
mod server;

use client::Page;
use serde_json::{Value, json};
use server::Server;

/// Returns an obstacle of `shelf.toml`, moved by `by`: the one around which the path leads.
fn shelf_moved(by: [f64; 2]) -> Value {
    let corners = [[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3]];
    let moved: Vec<_> = corners.iter().map(|[x, y]| [x + by[0], y + by[1]]).collect();
    json!({ "from": 0, "polygon": moved })
}

/// Returns the state of `shelf.toml` in which its obstacle is replaced by `shelf`.
fn shelf_state(shelf: Value) -> Value {
    json!({
        "obstacles": [shelf, { "from": 1 }],
        "start": { "joints": [-0.9, 0.4] },
        "goal": { "joints": [1.55, -0.35] },
        "clearance": 0.0,
    })
}

/// Starts a server with `planar_2r` in `shelf.toml`, and opens a page.
fn shelf_page() -> (Server, Page) {
    let server = Server::planar("workspaces/shelf.toml", &[]);
    let page = Page::open(&server);
    (server, page)
}
