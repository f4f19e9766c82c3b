//! `cplan serve`: the live page.

use super::failure::Failure;
use super::{DONE, demo, sinks};
use crate::grammar::number_in;
use crate::input::{Source, scene_from};
use crate::live::{Host, Options};
use crate::serve;
use clap::Args;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener};
use std::path::PathBuf;
use std::time::Duration;

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
    let seconds = number_in(text, |x| (0.01..=3600.0).contains(&x), "of seconds, from 0.01 to 3600")?;
    Ok(Duration::from_secs_f64(seconds))
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
    let wanted = SocketAddr::new(args.bind, args.port);
    let bound = TcpListener::bind(wanted).and_then(|listener| Ok((listener.local_addr()?, listener)));
    let (address, listener) = bound.map_err(|error| {
        Failure::Option(format!("cannot listen at {wanted}: {error}\n  cure: --port 0 takes any port that is free"))
    })?;
    scene.robot.warnings.iter().for_each(|warning| sinks::say(&format!("warning: {warning}")));
    if !args.bind.is_loopback() {
        sinks::say("warning: other machines can open this page, and have this one plan for them: there is no password");
    }
    let host = Host::new(urdf, world, scene, args.with.clone(), args.time_limit)
        .ok_or_else(|| Failure::Option("the world is no TOML".into()))?;
    sinks::print(&format!("http://{address}/\n"))?;
    sinks::say("open it in a browser; Ctrl-C ends");
    serve::run(listener, host).map_err(|error| Failure::Option(format!("cannot serve: {error}")))?;
    Ok(DONE)
}
