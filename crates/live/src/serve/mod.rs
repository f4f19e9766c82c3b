//! The server of the live page, for this machine's browser.
//!
//! ```text
//! browser <-- http: the page --> socket <-> mailbox (the latest counts) -> LiveSession
//! ```
//!
//! - Each page has one worker thread (`socket`), which takes the latest request; a newer one interrupts the plan under
//!   way.
//! - Refused are hosts that are no address or `localhost` (DNS rebinding), other pages' origins and requests with bodies
//!   (`http`). Sizes, pages, connections and times are bounded; a panic in a plan becomes a message.

mod http;
mod mailbox;
mod socket;

use crate::Host;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use tokio::sync::Semaphore;

/// Largest number of open pages. Each has a thread that plans.
const MAX_PAGES: usize = 8;

/// The state that all connections share.
struct Server {
    /// Address of the server.
    address: SocketAddr,
    /// One permit for each page that may be opened.
    sessions: Arc<Semaphore>,
    host: Arc<Host>,
}

/// Serves until it is interrupted. Plans in progress end with the process.
///
/// # Errors
/// The system cannot wait for connections.
pub fn run(listener: TcpListener, host: Host) -> std::io::Result<()> {
    let address = listener.local_addr()?;
    let server = Server { address, sessions: Arc::new(Semaphore::new(MAX_PAGES)), host: Arc::new(host) };
    listener.set_nonblocking(true)?;
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let served = runtime.block_on(async {
        let listener = tokio::net::TcpListener::from_std(listener)?;
        tokio::select! {
            () = http::serve(listener, Arc::new(server)) => Ok(()),
            stopped = wait_for_stop_signal() => stopped,
        }
    });
    runtime.shutdown_background();
    served
}

/// Waits for Ctrl-C, or for a termination signal.
async fn wait_for_stop_signal() -> std::io::Result<()> {
    #[cfg(unix)]
    {
        let mut ended = tokio::signal::unix::signal(tokio::signal::unix::SignalKind::terminate())?;
        tokio::select! {
            pressed = tokio::signal::ctrl_c() => pressed,
            _ = ended.recv() => Ok(()),
        }
    }
    #[cfg(not(unix))]
    tokio::signal::ctrl_c().await
}
