//! Threats to the server's availability: worlds that take long to read, and clients that ask and never read.

use super::server::Server;
use super::shelf_page;
use std::f64::consts::TAU;
use std::io::Write;
use std::net::TcpStream;
use std::time::Duration;

/// Number of connections, which is more than the server keeps at a time.
const MANY: usize = 40;

#[test]
fn a_world_of_19_999_corners_is_answered() {
    let (_server, mut page) = shelf_page();
    let corner = |k: usize| {
        let angle = k as f64 / 19_999.0 * TAU;
        let radius = 0.15 + 0.03 * (9.0 * angle).sin();
        format!("[{:.9}, {:.9}]", 1.2 + radius * angle.cos(), 0.5 + radius * angle.sin())
    };
    let corners: Vec<String> = (0..19_999).map(corner).collect();
    let ends = "[start]\njoints = [-0.9, 0.4]\n[goal]\njoints = [1.55, -0.35]\n";
    let answer = page.load(&format!("{ends}[[obstacle]]\npolygon = [{}]\n", corners.join(", ")));
    assert!(answer["done"] == true && answer["verdict"].is_string(), "{answer}");
}

/// Sends requests until the connection accepts no more.
fn fill_connection(server: &Server) -> TcpStream {
    let mut stream = server.connect();
    stream.set_write_timeout(Some(Duration::from_millis(100))).unwrap();
    let request = format!("GET / HTTP/1.1\r\nHost: {}\r\n\r\n", server.address).repeat(64);
    while stream.write_all(request.as_bytes()).is_ok() {}
    stream
}

#[test]
fn clients_that_never_read_keep_nobody_out_for_long() {
    let server = Server::planar("workspaces/shelf.toml", &[]);
    let deaf: Vec<TcpStream> = (0..MANY).map(|_| fill_connection(&server)).collect();
    // The server may end the first connection together with those that never read.
    let is_answered = (0..3).any(|_| server.get("/").0.starts_with("HTTP/1.1 200"));
    assert!(is_answered, "no request is answered");
    drop(deaf);
}
