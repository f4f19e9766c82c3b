//! The server of the live page, for this machine's browser.
//!
//! ```text
//! browser <-- http: the page --> socket <-> mailbox (the latest counts) -> LiveSession
//! ```
//!
//! - Each connection has one thread. Each page has two more: a worker (`socket`) takes the latest request, and another
//!   thread sends the replies. A newer request interrupts the plan under way.
//! - Refused are hosts that are no address or `localhost` (DNS rebinding), other pages' origins and requests with bodies
//!   (`http`). Sizes, pages, connections and times are bounded; a panic in a plan becomes a message.

mod http;
mod mailbox;
mod request;
mod socket;

use crate::Host;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::thread;
use std::time::Duration;

/// Largest number of open pages. Each has a thread that plans.
const MAX_PAGES: usize = 8;

/// Largest number of simultaneous connections that ask for the page. A browser opens some six.
const MAX_CONNECTIONS: usize = 32;

/// Waiting time until a connection ends, or after an error of the system.
const RETRY_TIME: Duration = Duration::from_millis(50);

/// A limit on how many holders of a permit there are at a time.
struct Permits {
    shared: Arc<()>,
    most: usize,
}

/// The right to be one of a limited number. It ends when dropped.
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
    /// Address of the server.
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
        // Accepts no connection until there is a permit for it.
        let accepted = connections.take().map(|permit| (permit, listener.accept()));
        let Some((permit, Ok((stream, _)))) = accepted else {
            // There are too many connections, the process has too many open files, or the client is gone already.
            thread::sleep(RETRY_TIME);
            continue;
        };
        let server = Arc::clone(&server);
        // If the system has no thread left, the connection is closed.
        let _ = thread::Builder::new().name("connection".into()).spawn(move || http::answer(stream, &server, permit));
    }
}
