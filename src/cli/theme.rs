//! The option for the background of pictures.

use crate::view::View;
use clap::{Args, ValueEnum};

/// Backgrounds of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Theme {
    /// Dark on light.
    Light,
    /// Light on dark.
    Dark,
}

/// The background of pictures.
#[derive(Debug, PartialEq, Args)]
pub struct ThemeArgs {
    /// Background of pictures (.svg, .png, .gif). Pages follow the reader's system.
    #[arg(long, value_enum, value_name = "THEME", default_value_t = Theme::Light)]
    theme: Theme,
}

impl ThemeArgs {
    /// Returns true for a dark background.
    pub fn is_dark(&self) -> bool {
        self.theme == Theme::Dark
    }

    /// Returns the view for pictures on this background.
    pub fn apply(&self, view: View) -> View {
        view.on_background(self.is_dark())
    }
}
