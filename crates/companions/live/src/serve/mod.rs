//! The server of the live page, for this machine's browser.
//!
//! ```text
//! browser <-- http: the page --> socket <-> mailbox (the latest counts) -> LiveSession
//! ```
//!
//! - Each connection has one thread. Each page has two more: a worker (`socket`) that takes the latest request, and a
//!   thread that sends the replies. A newer request interrupts the plan in progress.
//! - The server refuses host names other than its address or `localhost` (DNS rebinding), origins of other pages, and requests
//!   with bodies (`http`). Sizes, pages, connections and times are bounded. A panic in a plan becomes a message.

mod http;
mod mailbox;
mod request;
mod socket;

use crate::Host;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::thread;
use std::time::Duration;

/// Largest number of open pages. Each has a planning thread.
const MAX_PAGES: usize = 8;

/// Largest number of simultaneous connections without WebSocket. A browser opens about six.
const MAX_CONNECTIONS: usize = 32;

/// Waiting time before another attempt to take a permit, or after an error of the system.
const RETRY_TIME: Duration = Duration::from_millis(50);

/// A limited number of permits.
struct Permits {
    shared: Arc<()>,
    most: usize,
}

/// One of a limited number of permits. It is returned when dropped.
struct Permit(#[expect(dead_code, reason = "its count matters")] Arc<()>);

impl Permits {
    fn new(most: usize) -> Self {
        Self { shared: Arc::default(), most }
    }

    /// Returns a permit. `None` if all are taken.
    fn take(&self) -> Option<Permit> {
        let permit = Arc::clone(&self.shared);
        // The count includes `self.shared`.
        (Arc::strong_count(&permit) <= self.most + 1).then_some(Permit(permit))
    }
}

/// The state that all connections share.
struct Server {
    address: SocketAddr,
    pages: Permits,
    host: Arc<Host>,
    /// The page's HTML.
    page: String,
}

/// Serves until the process ends.
///
/// # Errors
/// The listener has no address.
pub fn run(listener: &TcpListener, host: Host) -> std::io::Result<()> {
    let address = listener.local_addr()?;
    let server = Server { address, pages: Permits::new(MAX_PAGES), host: Arc::new(host), page: crate::page() };
    let (server, connections) = (Arc::new(server), Permits::new(MAX_CONNECTIONS));
    loop {
        // Accept a connection only with a permit.
        let accepted = connections.take().map(|permit| (permit, listener.accept()));
        let Some((permit, Ok((stream, _)))) = accepted else {
            // No permit is free, the process has too many open files, or the client is already gone.
            thread::sleep(RETRY_TIME);
            continue;
        };
        let server = Arc::clone(&server);
        // If the system has no thread left, the connection closes.
        let _ = thread::Builder::new().name("connection".into()).spawn(move || http::answer(stream, &server, permit));
    }
}
