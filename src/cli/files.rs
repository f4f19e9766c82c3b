//! The input files of most subcommands.

use crate::input::{self, RobotFile};
use clap::{Args, ValueHint};
use std::path::{Path, PathBuf};

/// The two files.
#[derive(Debug, Args)]
pub struct Files {
    /// Robot: a URDF or xacro file.
    #[arg(value_name = "URDF", value_hint = ValueHint::FilePath)]
    pub urdf: PathBuf,
    /// World file (TOML).
    #[arg(value_name = "WORLD", value_hint = ValueHint::FilePath)]
    pub world: PathBuf,
    // As in `XacroArgs`, which an optional group cannot hold.
    /// Argument of a xacro robot, instead of its default. Can be repeated.
    #[arg(long = "xacro-arg", value_name = "NAME=VALUE", value_parser = xacro_argument)]
    pub xacro_args: Vec<(String, String)>,
}

impl Files {
    /// Returns the robot's file, with its arguments.
    pub fn robot(&self) -> RobotFile {
        RobotFile { arguments: self.xacro_args.clone(), ..input::robot(&self.urdf) }
    }

    /// Returns files and arguments as words of a command line.
    pub fn words(&self) -> Vec<String> {
        let files = [&self.urdf, &self.world].map(|path| path.display().to_string());
        let xacro = self.xacro_args.iter().map(|(name, value)| format!("--xacro-arg={name}={value}"));
        files.into_iter().chain(xacro).collect()
    }
}

/// Arguments of xacro robots.
#[derive(Debug, Default, Args)]
pub struct XacroArgs {
    /// Argument of a xacro robot, instead of its default. Can be repeated.
    #[arg(long = "xacro-arg", value_name = "NAME=VALUE", value_parser = xacro_argument)]
    pub xacro_args: Vec<(String, String)>,
}

impl XacroArgs {
    /// Returns a robot's file with these arguments.
    pub fn robot(&self, path: &Path) -> RobotFile {
        RobotFile { arguments: self.xacro_args.clone(), ..input::robot(path) }
    }
}

/// Parses `NAME=VALUE`, or `NAME:=VALUE` as ROS writes it.
fn xacro_argument(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("an argument of xacro is written NAME=VALUE")?;
    Ok((name.strip_suffix(':').unwrap_or(name).to_owned(), value.to_owned()))
}
