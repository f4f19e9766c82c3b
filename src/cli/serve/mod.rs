//! `cplan serve`: a page on this machine in which obstacles, start and goal are moved, and the plan follows.
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

use super::failure::Failure;
use super::{DONE, demo, sinks};
use crate::input::{LoadedScene, Source, scene_from};
use clap::Args;
use document::Document;
use options::Options;
use std::collections::BTreeSet;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Semaphore;

/// Pages that may be open at a time: each has a thread that plans.
const MOST_PAGES: usize = 8;

/// Arguments of `serve`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  cplan serve
  cplan serve robots/planar_2r.urdf workspaces/shelf.toml
  cplan serve robots/planar_2r.urdf workspaces/shelf.toml --with \"harmonic --cells 128\" --port 0

The address is printed on stdout; Ctrl-C ends it. Nothing is written to disk: save the world from the page.

Exit codes: 0 it was told to end, 1 bad input, or an address that is not to be had, 2 wrong command line.")]
pub struct ServeArgs {
    /// The arm; without files a built-in SCARA cell.
    #[arg(value_name = "URDF", requires = "world")]
    pub urdf: Option<PathBuf>,
    /// The workspace, TOML.
    #[arg(value_name = "WORLD")]
    pub world: Option<PathBuf>,
    /// Planner and options to begin with, such as "harmonic --field oriented --epsilon 0.5 --direction 0,-1".
    #[arg(long, value_name = "PLANNER OPTIONS", default_value = "shortest")]
    pub with: String,
    /// Port of the page; 0 takes any that is free.
    #[arg(long, value_name = "N", default_value_t = 7878)]
    pub port: u16,
    /// Address of this machine to listen at. Any other than the default lets other machines use the page.
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    pub bind: IpAddr,
    /// Time after which a plan is given up, seconds.
    #[arg(long, value_name = "SECONDS", default_value = "20", value_parser = time_limit, allow_hyphen_values = true)]
    pub time_limit: Duration,
}

fn time_limit(text: &str) -> Result<Duration, String> {
    let seconds = super::args::number_in(text, |x| (0.01..=3600.0).contains(&x), "of seconds, from 0.01 to 3600")?;
    Ok(Duration::from_secs_f64(seconds))
}

/// What all pages share.
struct Host {
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

/// Serves until it is told to stop.
///
/// # Errors
/// Bad input, and an address that is not to be had.
pub fn run(args: &ServeArgs) -> Result<u8, Failure> {
    Options::parse(&args.with).map_err(|error| Failure::Usage(format!("--with: {error}")))?;
    let (urdf, world) = match (&args.urdf, &args.world) {
        (Some(urdf), Some(world)) => (Source::read(urdf)?, Source::read(world)?),
        _ => (
            Source::in_memory("built-in scara.urdf", demo::ROBOT),
            Source::in_memory("built-in scara_cell.toml", demo::WORLD),
        ),
    };
    let scene = scene_from(urdf.clone(), world.clone())?;
    let document = Document::parse(world.text()).ok_or_else(|| Failure::Option("the world is no TOML".into()))?;
    let listener = TcpListener::bind((args.bind, args.port)).and_then(|listener| {
        listener.set_nonblocking(true)?;
        Ok((listener.local_addr()?, listener))
    });
    let (address, listener) = listener.map_err(|error| {
        let wanted = SocketAddr::new(args.bind, args.port);
        Failure::Option(format!("cannot listen at {wanted}: {error}\n  cure: --port 0 takes any port that is free"))
    })?;
    for warning in &scene.robot.warnings {
        sinks::say(&format!("warning: {warning}"));
    }
    if !args.bind.is_loopback() {
        sinks::say("warning: other machines can open this page, and have this one plan for them: there is no password");
    }
    let host = Host {
        address,
        sessions: Arc::new(Semaphore::new(MOST_PAGES)),
        files: document.files(),
        urdf,
        world,
        document,
        scene,
        options: args.with.clone(),
        time: args.time_limit,
    };
    sinks::print(&format!("http://{address}/\n"))?;
    sinks::say("open it in a browser; Ctrl-C ends");
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let runtime = runtime.map_err(|error| Failure::Option(format!("cannot wait for connections: {error}")))?;
    let served = runtime.block_on(async {
        let listener = tokio::net::TcpListener::from_std(listener)?;
        tokio::select! {
            () = http::serve(listener, Arc::new(host)) => Ok(()),
            stopped = told_to_stop() => stopped,
        }
    });
    // Plans that are under way end with the process.
    runtime.shutdown_background();
    served.map_err(|error| Failure::Option(format!("cannot serve: {error}")))?;
    Ok(DONE)
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
