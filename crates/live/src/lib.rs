//! The live page: one in which obstacles, start and goal are moved, and the plan follows; and what answers it, wherever that runs.
//!
//! ```text
//! page (assets) <-- messages (protocol) --> desk: text of the world -> input -> plan -> view
//! ```
//!
//! The page sends the whole of what it shows each time, as a change of the text that it was given; so any message may be
//! dropped for a newer one, and the world that is planned in is always read from text by the same code as any file. Who carries
//! the messages is none of this module's business: `serve` does, over a socket; `Alone` is for a page that has the program within it.
//!
//! - Undo is the page's own affair. `document` changes the TOML and keeps comments and what it does not know.
//! - While something is dragged a desk answers without bound and motion (`result::quick`), if that takes no more than 60
//!   ms, else with the C-space alone (`Pace`); at the end with everything. Contours of obstacles that stay where they
//!   are, are kept (`contours`).
//! - Menus come from the command line's grammar (`menus`); what nobody has chosen is not sent, so the page has no
//!   defaults of its own.
//! - Errors say what they are about; of a start or goal that is not free the IK solutions and what is in their way
//!   (`blocked`), in words that need no file.
//! - Each change gives the page's world a new number (`edition`), and an answer belongs to the number it was asked with.
//!   The badge says certified only of the final answer to the present number, on a line that is up. Edits are kept in the
//!   browser (`keep`), under the text that the program began with.
//! - The page speaks first: it opens what the program began with, or what its address names (`gallery`): arm, world and options,
//!   which it brings along as text (`Host::brought`). Worlds that name files which the program was not started with are refused
//!   (`Host::read`).
//! - The page's code (`assets`) adds to that of `draw::shell`: `alone` (the program within the page, where there is no server),
//!   `link` (one request under way, the latest next), `gallery` (what can be opened, and links), `keep`,
//!   `notices` (what is wrong, where one looks), `scene` (state and history), `edit` (pointer and keys), `controls`,
//!   `live`.

mod alone;
mod answer;
mod blocked;
mod contours;
mod desk;
mod document;
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

pub use alone::Alone;
pub use answer::Spent;
pub use desk::Desk;
pub use options::Options;
pub use page::{page, page_alone};
pub use protocol::{Ask, Files, Message, Reply, Request};

use cplan_robot::Source;
use cplan_world::{LoadedScene, scene_from};
use document::Document;
use std::collections::BTreeSet;
use std::time::Duration;

/// What all pages share.
pub struct Host {
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
    /// Whether arm and world name no files beside them, so that a link can hold them.
    is_whole: bool,
}

impl Host {
    /// A world to begin with, planned in as `options` say, for at most `time` a plan. None if it is no TOML.
    pub fn new(urdf: Source, world: Source, scene: LoadedScene, options: String, time: Duration) -> Option<Self> {
        let document = Document::parse(world.text())?;
        let in_memory = |source: &Source| Source::in_memory(source.name(), source.text());
        let is_whole = scene_from(in_memory(&urdf), in_memory(&world)).is_ok();
        Some(Self { files: document.files(), urdf, world, document, scene, options, time, is_whole })
    }

    /// What a page brings along, which can name no other files.
    ///
    /// # Errors
    /// In words, with the place.
    fn brought(Files { urdf, world, options }: Files, time: Duration) -> Result<Self, String> {
        let [urdf, world] =
            [("robot.urdf", urdf), ("world.toml", world)].map(|(name, text)| Source::in_memory(name, text));
        let scene = scene_from(urdf.clone(), world.clone()).map_err(|error| error.to_string())?;
        Self::new(urdf, world, scene, options, time).ok_or_else(|| "the world is no TOML".into())
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
                "the world names a file, \"{file}\", that the one to begin with does not\n  cure: cplan serve with this world"
            ));
        }
        let scene = self.scene.edited(&self.urdf, self.world.with_text(text)).map_err(|error| error.to_string())?;
        // Whatever the input layer can read is TOML.
        Ok((document.ok_or("this is no TOML")?, scene))
    }
}
