//! Reads the line.

use super::FollowArgs;
use crate::cli::failure::Failure;
use crate::input::{self, Diagnostic, Position};
use cplan_toolpath::{Format, Toolpath};

/// Reads the line that the arguments name, and places it.
///
/// # Errors
/// A file that cannot be read, or that has something that the tip cannot follow: with line, column and a hint.
pub fn line(args: &FollowArgs) -> Result<Toolpath, Failure> {
    let file = args.path.display();
    let format = Format::from_path(&args.path).ok_or_else(|| {
        Failure::Usage(format!("{file}: the name of a line must end in .gcode, .nc, .ngc, .tap or .svg"))
    })?;
    let bytes = input::read_bytes(&args.path)?;
    cplan_toolpath::read(&bytes, format, &args.placement()).map_err(|error| {
        let position = error.line.map(|line| Position { line, column: error.column.unwrap_or(1) });
        let diagnostic = Diagnostic::new(file.to_string(), error.message).help(error.hint);
        Failure::Input(Diagnostic { position, ..diagnostic }.into())
    })
}
