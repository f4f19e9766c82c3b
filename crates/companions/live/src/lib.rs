//! The live page, in which users move obstacles, start and goal while the plan is updated, and the session that answers
//! the page.
//!
//! ```text
//! page (assets) <-- messages (protocol) --> session: text of the world -> input -> plan -> view
//! ```
//!
//! With each request, the page sends its whole state, as a change of the text that it received. So a message may be
//! dropped if a newer one exists. The reader of world files reads the changed text. Messages travel over a socket
//! (`serve`), or within a page that contains the program (`StandalonePage`).
//!
//! - The page handles undo. `document` changes the TOML, and keeps comments and unknown keys.
//! - During a drag, a session answers with a path but without a bound or a motion (`result::quick_answer`). If that
//!   takes more than 60 ms, it answers with the configuration space only (`Pace`). When the drag ends, the answer is
//!   complete. Contours of unmoved obstacles are cached (`contours`).
//! - Menus come from the command line's grammar (`menus`). Unchosen options are not sent, so the page has no defaults
//!   of its own.
//! - Errors state their subject. For a blocked start or goal, they list the IK solutions and the obstacles in contact
//!   (`blocked`), without references to files.
//! - Each change gives the page's world a new number (`edition`). A request contains this number, and its answer
//!   belongs to it. The badge says *certified* only for the final answer to the current number, and while the
//!   connection works. Edits are kept in the browser (`keep`), under the program's initial text.
//! - `explain` answers why there is no path. The page shows a card for each change that opens one (`why`), and applies it
//!   on request.
//! - The page sends the first message. It opens the program's initial world, or sends the arm, the world and the
//!   options of its address (`gallery`) as text (`Host::from_texts`). Worlds that name files with which the program was
//!   not started are refused (`Host::read`).
//! - The page's code (`assets`) extends that of `draw::shell`: `alone` (the program inside the page, without a server),
//!   `link` (one request under way, the latest next), `gallery` (worlds to open, and links), `keep`, `notices`
//!   (problems, shown in place), `scene` (state and history), `edit` (pointer and keys), `controls`, `live`.

mod standalone;
mod answer;
mod blocked;
mod contours;
mod live_session;
mod document;
mod explain;
mod files;
mod gallery;
mod menus;
mod options;
mod pace;
mod page;
mod protocol;
mod result;
#[cfg(feature = "serve")]
pub mod serve;

pub use answer::TimeSpent;
pub use live_session::LiveSession;
pub use options::Options;
pub use page::{page, standalone_page};
pub use protocol::{Files, Message, PlanRequest, Reply, Request};
pub use standalone::StandalonePage;

use cplan_robot::Source;
use cplan_world::{LoadedScene, scene_from};
use document::Document;
use std::collections::BTreeSet;
use std::time::Duration;

/// The state that all pages share.
pub struct Host {
    urdf: Source,
    /// The world that pages begin with.
    world: Source,
    document: Document,
    scene: LoadedScene,
    /// Files that the initial world names. A world from a page may name only these.
    files: BTreeSet<String>,
    /// Planner and options that pages begin with.
    options: String,
    /// Time that a plan may take.
    time: Duration,
    /// True if arm and world name no other files, so that a link can contain them completely.
    is_whole: bool,
}

impl Host {
    /// Creates a host with an initial world. Plans use `options` and take at most `time`. Returns `None` if the world
    /// is not TOML.
    pub fn new(urdf: Source, world: Source, scene: LoadedScene, options: String, time: Duration) -> Option<Self> {
        let document = Document::parse(world.text())?;
        let in_memory = |source: &Source| Source::in_memory(source.name(), source.text());
        let is_whole = scene_from(in_memory(&urdf), in_memory(&world)).is_ok();
        Some(Self { files: document.files(), urdf, world, document, scene, options, time, is_whole })
    }

    /// Creates a host with texts that a page sends. These texts cannot name other files.
    ///
    /// # Errors
    /// The reason, with the position in the text.
    fn from_texts(Files { urdf, world, options }: Files, time: Duration) -> Result<Self, String> {
        let [urdf, world] =
            [("robot.urdf", urdf), ("world.toml", world)].map(|(name, text)| Source::in_memory(name, text));
        let scene = scene_from(urdf.clone(), world.clone()).map_err(|error| error.to_string())?;
        Self::new(urdf, world, scene, options, time).ok_or_else(|| "the world is not valid TOML".into())
    }

    /// Reads a world from a page.
    ///
    /// # Errors
    /// The reason in words, with the position in the text.
    fn read(&self, text: &str) -> Result<(Document, LoadedScene), String> {
        let document = Document::parse(text);
        let named = document.iter().flat_map(Document::files).find(|file| !self.files.contains(file));
        if let Some(file) = named {
            return Err(format!(
                "the server may not read \"{file}\": the world at its start did not name this file\n  hint: start cplan serve with this world"
            ));
        }
        let scene =
            self.scene.with_world_text(&self.urdf, self.world.with_text(text)).map_err(|error| error.to_string())?;
        // A text that can be read as a world is always TOML.
        Ok((document.ok_or("this is no TOML")?, scene))
    }
}
