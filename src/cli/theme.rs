//! The option for the background of pictures.

use crate::options::{Word, word};
use crate::view::View;
use clap::{ArgAction, Args};

/// The background of pictures.
#[derive(Debug, PartialEq, Args)]
pub struct ThemeArgs {
    /// Background of pictures (.svg, .png, .gif). Pages follow the reader's system.
    #[arg(long = "theme", action = ArgAction::Set, value_parser = word(THEMES), value_name = "THEME", default_value = "light")]
    is_dark: bool,
}

const THEMES: [Word<bool>; 2] = [(false, "light", "Dark on light"), (true, "dark", "Light on dark")];

impl ThemeArgs {
    /// Returns true for a dark background.
    pub fn is_dark(&self) -> bool {
        self.is_dark
    }

    /// Returns the view for pictures on this background.
    pub fn apply(&self, view: View) -> View {
        view.on_background(self.is_dark())
    }
}
