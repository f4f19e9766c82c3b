//! The HTTP server. It serves the page, its parts and its WebSocket, and refuses requests from other pages.

use super::request::{Request, RequestError};
use super::{Permit, Server, socket};
use std::io::{self, Read, Write};
use std::net::{IpAddr, Shutdown, SocketAddr, TcpStream};
use std::time::{Duration, Instant};
use tungstenite::handshake::derive_accept_key;

/// Time limit of a connection that is not a WebSocket. Without it, clients that send requests but never read responses
/// would block all others. After it, a browser simply opens another connection.
const CONNECTION_TIME: Duration = Duration::from_secs(10);

/// Time limit for a client to close a connection after the response. If the server closed it immediately, bytes from
/// the client that are not read yet could destroy the response.
const CLOSING_TIME: Duration = Duration::from_millis(500);

/// Size of the pieces in which a response is sent, in bytes. The time limit is checked before each piece.
const PIECE_BYTES: usize = 64 << 10;

/// Headers of every response. Inline scripts and styles are safe, because the page is the same file for every world,
/// its data comes through the WebSocket and is never treated as HTML, and nothing is loaded from elsewhere.
const HEADERS: &str = "\
content-security-policy: default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src blob: data:; \
font-src data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r
x-content-type-options: nosniff\r
referrer-policy: no-referrer\r
cache-control: no-store\r
cross-origin-opener-policy: same-origin\r
cross-origin-resource-policy: same-origin\r
";

/// Response to requests from other pages.
const FOREIGN: Response = Response("403 Forbidden", "text/plain", "this server answers only its own page\n");

/// A response: status, type and text.
#[derive(Clone, Copy)]
struct Response<'a>(&'static str, &'static str, &'a str);

impl Response<'_> {
    /// Sends the response. For the method HEAD, omits the text.
    fn send(self, stream: &mut TcpStream, is_head: bool, until: Instant) -> io::Result<()> {
        let Self(status, kind, body) = self;
        let length = body.len();
        let allowed = if status.starts_with("405") { "allow: GET, HEAD\r\n" } else { "" };
        let mut response = format!(
            "HTTP/1.1 {status}\r\n{HEADERS}{allowed}content-type: {kind}; charset=utf-8\r\ncontent-length: {length}\r\n\
             connection: close\r\n\r\n"
        );
        if !is_head {
            response.push_str(body);
        }
        for piece in response.as_bytes().chunks(PIECE_BYTES) {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Err(io::ErrorKind::TimedOut.into());
            }
            stream.set_write_timeout(Some(left))?;
            stream.write_all(piece)?;
        }
        stream.shutdown(Shutdown::Write)?;
        stream.set_read_timeout(Some(CLOSING_TIME))?;
        io::copy(&mut stream.take(PIECE_BYTES as u64), &mut io::sink()).map(drop)
    }
}

/// Answers one request: with the page, with a refusal, or by opening the WebSocket. Errors of the client have no effect.
pub fn answer(mut stream: TcpStream, server: &Server, permit: Permit) {
    // Messages are small and go in both directions, so buffering gains nothing.
    let _ = stream.set_nodelay(true);
    let until = Instant::now() + CONNECTION_TIME;
    let (response, is_head) = match Request::read(&mut stream, until) {
        Ok(request) => match respond(&request, server) {
            Err(Upgrade { key, page }) => {
                drop(permit);
                return upgrade(stream, server, &key, page);
            }
            Ok(response) => (response, request.method == "HEAD"),
        },
        Err(RequestError::Closed) => return,
        Err(RequestError::TooLong) => (Response("431 Request Header Fields Too Large", "text/plain", ""), false),
        Err(RequestError::Malformed) => (Response("400 Bad Request", "text/plain", ""), false),
    };
    let _ = response.send(&mut stream, is_head, until);
}

/// A request that opens the WebSocket.
struct Upgrade {
    /// The client's key.
    key: String,
    /// The permit of the page.
    page: Permit,
}

/// Returns the response to a request. If the request opens the WebSocket, this is the error.
fn respond<'a>(request: &Request, server: &'a Server) -> Result<Response<'a>, Upgrade> {
    let path = request.path.split('?').next().unwrap_or_default();
    let is_read = ["GET", "HEAD"].contains(&request.method.as_str());
    Ok(match path {
        _ if let Some(refusal) = refusal(server, request) => refusal,
        "/" | "/live" if !is_read => Response("405 Method Not Allowed", "text/plain", ""),
        "/" => Response("200 OK", "text/html", &server.page),
        "/live" => return open(request, server),
        _ => Response("404 Not Found", "text/plain", ""),
    })
}

/// Returns the reason why a request is refused. `None` if it is accepted.
fn refusal(server: &Server, request: &Request) -> Option<Response<'static>> {
    let named = request.header("host");
    if !named.is_some_and(|named| names_this_server(named, server.address)) {
        let why = "this server answers only at its address, not at other host names\n";
        return Some(Response("421 Misdirected Request", "text/plain", why));
    }
    // Only WebSockets and other pages send the header `Origin`.
    if let Some(origin) = request.header("origin")
        && origin.strip_prefix("http://") != named
    {
        return Some(FOREIGN);
    }
    let has_body = request.header("content-length").is_some_and(|length| length != "0")
        || request.header("transfer-encoding").is_some();
    let why = "this server accepts no request with a body\n";
    has_body.then_some(Response("413 Payload Too Large", "text/plain", why))
}

/// Returns true if a `Host` header names this server by its address or as `localhost`. Another name may come from a
/// foreign DNS server that resolves it to this machine (DNS rebinding).
fn names_this_server(named: &str, here: SocketAddr) -> bool {
    let (name, port) = match named.rsplit_once(':') {
        Some((name, port)) if !port.ends_with(']') => (name, port.parse().ok()),
        _ => (named, Some(80)),
    };
    let bare = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(name);
    let address = bare.parse::<IpAddr>().ok();
    let known = match address {
        Some(address) => !here.ip().is_loopback() || address.is_loopback(),
        None => name.eq_ignore_ascii_case("localhost"),
    };
    known && port == Some(here.port())
}

/// Checks a request to open the WebSocket. Returns the upgrade as an error, or else a refusal. Browsers always send
/// their origin, so a client without one is refused.
fn open(request: &Request, server: &Server) -> Result<Response<'static>, Upgrade> {
    let is_upgrade = request.method == "GET"
        && request.lists("connection", "upgrade")
        && request.lists("upgrade", "websocket")
        && request.header("sec-websocket-version") == Some("13");
    let Some(key) = request.header("sec-websocket-key").filter(|_| is_upgrade) else {
        return Ok(Response("400 Bad Request", "text/plain", "this address is for WebSockets\n"));
    };
    if request.header("origin").is_none() {
        return Ok(FOREIGN);
    }
    match server.pages.take() {
        Some(page) => Err(Upgrade { key: key.to_owned(), page }),
        None => Ok(Response("503 Service Unavailable", "text/plain", "too many pages are open\n")),
    }
}

/// Opens the WebSocket, and serves its page until it is closed.
fn upgrade(mut stream: TcpStream, server: &Server, key: &str, page: Permit) {
    let accept = derive_accept_key(key.as_bytes());
    let response = format!(
        "HTTP/1.1 101 Switching Protocols\r\n{HEADERS}connection: upgrade\r\nupgrade: websocket\r\n\
         sec-websocket-accept: {accept}\r\n\r\n"
    );
    if stream.write_all(response.as_bytes()).is_ok() {
        socket::serve(stream, &server.host, page);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_addresses_name_the_server() {
        let local: SocketAddr = "127.0.0.1:7878".parse().unwrap();
        for name in ["127.0.0.1:7878", "localhost:7878", "LOCALHOST:7878", "[::1]:7878"] {
            assert!(names_this_server(name, local), "{name}");
        }
        for name in
            ["evil.example:7878", "127.0.0.1", "127.0.0.1:80", "192.168.0.7:7878", "localhost.evil.example:7878", ""]
        {
            assert!(!names_this_server(name, local), "{name}");
        }
        let open: SocketAddr = "0.0.0.0:80".parse().unwrap();
        assert!(
            names_this_server("192.168.0.7", open)
                && names_this_server("[fe80::1]", open)
                && !names_this_server("evil.example", open)
        );
    }
}
