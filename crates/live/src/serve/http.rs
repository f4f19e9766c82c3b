//! The HTTP server. It serves one page with its parts and its WebSocket, and refuses requests that come from other
//! pages.

use super::{Server, socket};
use axum::Router;
use axum::extract::{Request, State, WebSocketUpgrade};
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{Html, IntoResponse, Response};
use axum::routing::get;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;

/// Largest number of simultaneous connections. A browser opens some six.
const MAX_CONNECTIONS: usize = 32;

/// Time limit for a client to send the head of a request.
const HEAD_TIME: Duration = Duration::from_secs(10);

/// Time limit of a connection, except for WebSockets, which have their own. After it, a browser simply opens another
/// connection. Without the limit, clients that send requests but never read responses would block all others.
const CONNECTION_TIME: Duration = Duration::from_secs(10);

/// Largest size of the head of a request, in bytes.
const MAX_HEAD_BYTES: usize = 16 << 10;

/// Headers of every response. The page is one file that is the same for every world. Data comes over the WebSocket and
/// is never treated as HTML. So it is safe that scripts and styles are inline, and nothing is loaded from elsewhere.
const HEADERS: [(HeaderName, &str); 6] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src blob: data:; font-src data:; \
         connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    (header::CACHE_CONTROL, "no-store"),
    (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
];

/// Serves until the process ends.
pub async fn serve(listener: TcpListener, server: Arc<Server>) {
    let page = Arc::<str>::from(crate::page());
    let router = Router::new()
        .route("/", get(async move || Html(page.to_string())))
        .route("/live", get(upgrade))
        .layer(middleware::from_fn_with_state(Arc::clone(&server), refuse_foreign_requests))
        .with_state(server);
    let room = Arc::new(Semaphore::new(MAX_CONNECTIONS));
    loop {
        // This cannot fail, because the semaphore is never closed.
        let Ok(permit) = Arc::clone(&room).acquire_owned().await else { return };
        let stream = match listener.accept().await {
            Ok((stream, _)) => stream,
            Err(_) => {
                // The process has too many open files, or the client has disconnected already.
                tokio::time::sleep(Duration::from_millis(50)).await;
                continue;
            }
        };
        // Messages are small and go in both directions, so collecting data before sending it gains nothing.
        let _ = stream.set_nodelay(true);
        let service = TowerToHyperService::new(router.clone());
        tokio::spawn(async move {
            let mut http = hyper::server::conn::http1::Builder::new();
            http.timer(TokioTimer::new()).header_read_timeout(HEAD_TIME).max_buf_size(MAX_HEAD_BYTES);
            // Errors of the client are ignored.
            let _ = tokio::time::timeout(
                CONNECTION_TIME,
                http.serve_connection(TokioIo::new(stream), service).with_upgrades(),
            )
            .await;
            drop(permit);
        });
    }
}

/// Refuses requests that the page never makes. Adds [`HEADERS`] to all responses.
async fn refuse_foreign_requests(State(server): State<Arc<Server>>, request: Request, next: Next) -> Response {
    let mut response = match refusal(&server, request.headers()) {
        Some((status, why)) => (status, why).into_response(),
        None => next.run(request).await,
    };
    for (name, value) in HEADERS {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    response
}

/// Returns the reason why a request is refused. `None` if it is accepted.
fn refusal(server: &Server, headers: &HeaderMap) -> Option<(StatusCode, &'static str)> {
    let named = headers.get(header::HOST).and_then(|value| value.to_str().ok());
    if !named.is_some_and(|named| names_this_server(named, server.address)) {
        return Some((
            StatusCode::MISDIRECTED_REQUEST,
            "this server answers only at its address, not at other host names\n",
        ));
    }
    // Only WebSockets and requests of other pages have the header `Origin`.
    if let Some(origin) = headers.get(header::ORIGIN)
        && origin.to_str().ok().and_then(|origin| origin.strip_prefix("http://")) != named
    {
        return Some((StatusCode::FORBIDDEN, "this server answers only its own page\n"));
    }
    let has_body = headers.get(header::CONTENT_LENGTH).is_some_and(|length| length != "0")
        || headers.contains_key(header::TRANSFER_ENCODING);
    has_body.then_some((StatusCode::PAYLOAD_TOO_LARGE, "this server accepts no request with a body\n"))
}

/// Returns true if a `Host` header names this server by its address or as `localhost`. Another name may be one that a
/// foreign DNS server resolves to this machine (DNS rebinding).
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

/// Opens the WebSocket. Browsers always send their origin, so a client that does not is refused.
async fn upgrade(State(server): State<Arc<Server>>, headers: HeaderMap, upgrade: WebSocketUpgrade) -> Response {
    if !headers.contains_key(header::ORIGIN) {
        return (StatusCode::FORBIDDEN, "this server answers only its own page\n").into_response();
    }
    let Ok(permit) = Arc::clone(&server.sessions).try_acquire_owned() else {
        return (StatusCode::SERVICE_UNAVAILABLE, "too many pages are open\n").into_response();
    };
    upgrade
        .max_message_size(socket::MAX_MESSAGE_BYTES)
        .max_frame_size(socket::MAX_MESSAGE_BYTES)
        .on_upgrade(move |socket| socket::session(socket, Arc::clone(&server.host), permit))
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
