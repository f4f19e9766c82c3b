//! The live page: one on this machine in which obstacles, start and goal are moved, and the plan follows.
//!
//! ```text
//! page (assets) <-- http --> browser
//!                  socket <-> mailbox (the latest counts) -> desk: text of the world -> input -> solve -> view
//! ```
//!
//! The page sends the whole of what it shows each time, as a change of the text that it was given; so any message may be
//! dropped for a newer one, and the world that is planned in is always read from text by the same code as any file.
//!
//! - Undo is the page's own affair. `document` changes the TOML and keeps comments and what it does not know.
//! - Each page has one worker thread (`socket`), which takes the latest request; a newer one interrupts the plan under
//!   way. While something is dragged it answers without bound and motion (`result::quick`), if that takes no more than 60
//!   ms, else with the C-space alone (`Pace`); at the end with everything. Contours of obstacles that stay where they
//!   are, are kept (`contours`).
//! - Menus come from the command line's grammar (`menus`); what nobody has chosen is not sent, so the page has no
//!   defaults of its own.
//! - Errors say what they are about; of a start or goal that is not free the IK solutions and what is in their way
//!   (`blocked`), in words that need no file.
//! - Each change gives the page's world a new number (`edition`), and an answer belongs to the number it was asked with.
//!   The badge says certified only of the final answer to the present number, on a line that is up. Edits are kept in the
//!   browser (`keep`), under the text that the program began with.
//! - Refused are hosts that are no address or `localhost` (DNS rebinding), other pages' origins, requests with bodies,
//!   and worlds that name files which the server was not started with (`http`, `Host::read`). Sizes, pages, connections
//!   and times are bounded; a panic in a plan becomes a message.
//! - The page's code (`assets`) adds to that of `draw::shell`: `link` (one request under way, the latest next), `keep`,
//!   `notices` (what is wrong, where one looks), `scene` (state and history), `edit` (pointer and keys), `controls`,
//!   `live`.

mod blocked;
mod contours;
mod desk;
mod document;
mod files;
mod http;
mod mailbox;
mod menus;
mod options;
mod protocol;
mod result;
mod socket;

pub use options::Options;

use crate::input::{LoadedScene, Source};
use document::Document;
use std::collections::BTreeSet;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Semaphore;

/// Pages that may be open at a time: each has a thread that plans.
const MOST_PAGES: usize = 8;

/// What all pages share.
pub struct Host {
    /// Where it listens.
    address: SocketAddr,
    /// Room for pages.
    sessions: Arc<Semaphore>,
    urdf: Source,
    /// The world that pages begin with.
    world: Source,
    document: Document,
    scene: LoadedScene,
    /// Files that it names: the only ones that a world from a page may name.
    files: BTreeSet<String>,
    /// Planner and options that pages begin with.
    options: String,
    /// Time that a plan may take.
    time: Duration,
}

impl Host {
    /// A world to begin with, planned in as `options` say, for at most `time` a plan. None if it is no TOML.
    pub fn new(
        address: SocketAddr,
        urdf: Source,
        world: Source,
        scene: LoadedScene,
        options: String,
        time: Duration,
    ) -> Option<Self> {
        let document = Document::parse(world.text())?;
        Some(Self {
            address,
            sessions: Arc::new(Semaphore::new(MOST_PAGES)),
            files: document.files(),
            urdf,
            world,
            document,
            scene,
            options,
            time,
        })
    }

    /// Reads a world from a page.
    ///
    /// # Errors
    /// In words, with the place.
    fn read(&self, text: &str) -> Result<(Document, LoadedScene), String> {
        let document = Document::parse(text);
        let named = document.iter().flat_map(Document::files).find(|file| !self.files.contains(file));
        if let Some(file) = named {
            return Err(format!(
                "the world names a file, \"{file}\", that the one the server was started with does not\n  cure: start the \
                 server with this world"
            ));
        }
        let scene = self.scene.edited(&self.urdf, self.world.with_text(text)).map_err(|error| error.to_string())?;
        // Whatever the input layer can read is TOML.
        Ok((document.ok_or("this is no TOML")?, scene))
    }
}

/// Serves until it is told to stop. Plans that are under way end with the process.
///
/// # Errors
/// A machine without what it takes to wait for connections.
pub fn run(listener: TcpListener, host: Host) -> std::io::Result<()> {
    listener.set_nonblocking(true)?;
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let served = runtime.block_on(async {
        let listener = tokio::net::TcpListener::from_std(listener)?;
        tokio::select! {
            () = http::serve(listener, Arc::new(host)) => Ok(()),
            stopped = told_to_stop() => stopped,
        }
    });
    runtime.shutdown_background();
    served
}

/// Waits for Ctrl-C, or to be asked to end.
async fn told_to_stop() -> std::io::Result<()> {
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
