//! Access to the server: which files it provides, to whom, and how it ends.

use super::client::Page;
use super::server::{Server, shipped};
use crate::cli::Place;
use std::net::TcpStream;
use std::process::Command;

#[test]
fn the_page_is_served_and_nothing_else() {
    let server = Server::start(&[]);
    let page = server.get("/");
    assert_eq!(page.status(), 200);
    assert!(page.body().contains("<!DOCTYPE html>"));
    assert!(page.header("content-type").starts_with("text/html"));
    // The page loads nothing from elsewhere: it contains no address.
    for remote in ["src=\"http", "href=\"http", "url(http", "import("] {
        assert!(!page.body().contains(remote), "{remote}");
    }
    for path in [
        "/live.js",
        "/robots/scara.urdf",
        "/../Cargo.toml",
        "/%2e%2e/Cargo.toml",
        "//etc/passwd",
        "/live/",
        "/favicon.ico",
    ] {
        let other = server.get(path);
        assert_eq!((other.status(), other.body()), (404, ""), "{path}");
    }
    let post = server.raw("POST / HTTP/1.1\r\nHost: HOST\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    assert_eq!(post.status(), 405);
}

#[test]
fn every_answer_has_the_security_headers() {
    let server = Server::start(&[]);
    for path in ["/", "/elsewhere", "/live"] {
        let answer = server.get(path);
        let policy = answer.header("content-security-policy");
        assert!(policy.starts_with("default-src 'none';") && policy.contains("frame-ancestors 'none'"), "{policy}");
        assert!(!policy.contains("http") && !policy.contains('*'), "{policy}");
        assert_eq!(answer.header("x-content-type-options"), "nosniff");
        assert_eq!(answer.header("referrer-policy"), "no-referrer");
        assert_eq!(answer.header("cache-control"), "no-store");
    }
}

/// Checks that an address of another machine is refused. No machine has the address in the test, because it is reserved
/// for documentation (RFC 5737).
#[test]
fn an_address_of_another_machine_is_refused_with_a_hint() {
    let words = ["serve", "--port", "0", "--bind", "203.0.113.9"];
    let parts = ["cannot listen at 203.0.113.9:0", "hint: give --bind an address of this machine"];
    Place::new().run(&words, "").refused(1, &parts);
}

/// Checks that a server for other machines prints an address that they can open: not the one of all addresses, and one that
/// the server accepts.
#[test]
fn a_server_for_other_machines_prints_an_address_to_open() {
    let server = Server::start(&["--bind", "0.0.0.0"]);
    assert!(!server.address.ip().is_unspecified(), "{}", server.address);
    assert_eq!(server.get("/").status(), 200);
    // It listens at all addresses of this machine.
    let local = format!("127.0.0.1:{}", server.address.port());
    assert!(std::net::TcpStream::connect(&local).is_ok());
    Page::open(&server);
}

#[test]
fn other_names_and_other_pages_are_refused() {
    let server = Server::start(&[]);
    let port = server.address.port();
    let status = |host: &str, more: &str| {
        let request = format!("GET / HTTP/1.1\r\nHost: {host}\r\n{more}Connection: close\r\n\r\n");
        server.raw(&request).status()
    };
    assert_eq!(status("HOST", ""), 200);
    assert_eq!(status(&format!("localhost:{port}"), ""), 200);
    // A foreign host name that leads to this machine (DNS rebinding).
    assert_eq!(status(&format!("evil.example:{port}"), ""), 421);
    assert_eq!(status("127.0.0.1:1", ""), 421);
    assert_eq!(status("HOST", "Origin: http://evil.example\r\n"), 403);
    assert_eq!(status("HOST", "Origin: null\r\n"), 403);
    let none = server.raw("GET / HTTP/1.0\r\n\r\n");
    assert_eq!(none.status(), 421);
}

#[test]
fn the_socket_is_for_the_page_alone() {
    let server = Server::start(&[]);
    let status = |origin: &str| {
        let request = format!(
            "GET /live HTTP/1.1\r\nHost: HOST\r\n{origin}Connection: Upgrade\r\nUpgrade: websocket\r\n\
             Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
        );
        server.raw(&request).status()
    };
    assert_eq!(status("Origin: http://evil.example\r\n"), 403);
    assert_eq!(status(&format!("Origin: https://{}\r\n", server.address)), 403);
    assert_eq!(status(""), 403);
    Page::open(&server);
}

#[test]
fn too_many_pages_are_refused() {
    let server = Server::start(&[]);
    let pages: Vec<Page> = (0..8).map(|_| Page::open(&server)).collect();
    assert_eq!(Page::try_open(&server).err(), Some(503));
    assert_eq!(server.get("/").status(), 200);
    drop(pages);
    // There is room as soon as the server has noticed.
    while Page::try_open(&server).is_err() {
        std::thread::yield_now();
    }
}

#[test]
fn wrong_command_lines_are_reported() {
    let taken = Server::start(&[]);
    let [robot, other] = ["robots/planar_2r.urdf", "robots/scara.urdf"].map(shipped);
    for (words, code, parts) in [
        ("--with fastest", 2, &["--with: ", "[possible values: shortest"][..]),
        ("--time-limit 0", 2, &["from 0.01 to 3600"]),
        ("arm.urdf", 2, &["WORLD"]),
        (&format!("{robot} missing.toml"), 1, &["missing.toml: cannot be read"]),
        ("--export page.html", 2, &["--engine"]),
        ("--export page.html --engine missing.wasm.gz", 1, &["missing.wasm.gz: cannot be read", ".ci/page"]),
        (&format!("--export page.html --engine {other}"), 1, &["is not packed by gzip"]),
        (&format!("--port {}", taken.address.port()), 1, &["cannot listen", "--port 0"]),
    ] {
        Place::new().run(&["serve"], words).refused(code, parts);
    }
}

#[cfg(unix)]
#[test]
fn control_c_ends_the_server_without_an_error() {
    for signal in ["-INT", "-TERM"] {
        let mut server = Server::start(&[]);
        // An open page, and a silent connection, do not keep the server alive.
        let _page = Page::open(&server);
        let _silent = TcpStream::connect(server.address).unwrap();
        let sent = Command::new("kill").args([signal, &server.child.id().to_string()]).status().unwrap();
        assert!(sent.success());
        assert_eq!(server.child.wait().unwrap().code(), Some(0), "{signal}");
    }
}
