//! `cplan serve`: the live page.

use super::exit::DONE;
use super::failure::Failure;
use super::files::XacroArgs;
use super::{demo, signals, sinks};
use crate::input::{Source, scene_from};
use crate::live::{Files, Host, Options, serve, standalone_page};
use crate::motion::write_whole;
use crate::options::number_in;
use clap::{Args, ValueHint};
use std::io::ErrorKind;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, TcpListener, UdpSocket};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Serve a live page: move obstacles, start and goal, and replan.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  cplan serve
  cplan serve robots/planar_2r.urdf workspaces/shelf.toml
  cplan serve robots/planar_2r.urdf workspaces/shelf.toml \\
    --with \"harmonic --cells 128\" --port 0
  cplan serve robots/planar_2r.urdf workspaces/shelf.toml \\
    --export page.html --engine target/page/cplan.wasm.gz

The address is printed on stdout; Ctrl-C ends the server. The server writes no
files; save the world from the page. With --export, no server starts: cplan
writes a page that contains the program, and that any web host can serve.

Exit codes: 0 stopped by the user, or the page is written, 1 bad input or
unavailable address, 2 wrong command line.")]
pub struct ServeArgs {
    /// Robot: a URDF or xacro file [default: a built-in SCARA cell].
    #[arg(value_name = "URDF", requires = "world")]
    pub urdf: Option<PathBuf>,
    /// World file (TOML).
    #[arg(value_name = "WORLD")]
    pub world: Option<PathBuf>,
    #[command(flatten)]
    pub xacro: XacroArgs,
    /// Initial planner and its options, such as "harmonic --field oriented --epsilon 0.5 --direction 0,-1".
    #[arg(long, value_name = "PLANNER OPTIONS", default_value = "shortest")]
    pub with: String,
    /// Port of the page; 0 takes any free port.
    #[arg(long, value_name = "N", default_value_t = 7878)]
    pub port: u16,
    /// Address of this machine to listen on. With any address except the default, other machines can use the page.
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    pub bind: IpAddr,
    /// Time limit for each plan, seconds.
    #[arg(long, value_name = "SECONDS", default_value = "20", value_parser = time_limit, allow_hyphen_values = true)]
    pub time_limit: Duration,
    /// Instead of serving the page, write it with the program as one file that needs no server.
    #[arg(long, value_name = "FILE", requires = "engine", conflicts_with_all = ["port", "bind"], value_hint = ValueHint::FilePath)]
    pub export: Option<PathBuf>,
    /// Program for the exported page: WebAssembly packed by gzip, as `.ci/page` builds it.
    #[arg(long, value_name = "FILE", requires = "export", value_hint = ValueHint::FilePath)]
    pub engine: Option<PathBuf>,
}

/// Time limit for each plan of a page.
pub const DEFAULT_TIME_LIMIT: Duration = Duration::from_secs(20);

fn time_limit(text: &str) -> Result<Duration, String> {
    let seconds = number_in(text, |x| (0.01..=3600.0).contains(&x), "of seconds, from 0.01 to 3600")?;
    Ok(Duration::from_secs_f64(seconds))
}

/// Serves the page until the process is stopped, or writes it to a file.
///
/// # Errors
/// Bad input, and an address that is not available.
pub fn run(args: &ServeArgs) -> Result<u8, Failure> {
    Options::parse(&args.with).map_err(|error| Failure::Usage(format!("--with: {error}")))?;
    let (urdf, world) = match (&args.urdf, &args.world) {
        (Some(urdf), Some(world)) => (args.xacro.robot(urdf).read()?, Source::read(world)?),
        _ => (
            Source::in_memory("built-in scara.urdf", demo::DEMO_ROBOT),
            Source::in_memory("built-in scara_cell.toml", demo::DEMO_WORLD),
        ),
    };
    let scene = scene_from(urdf.clone(), world.clone())?;
    if let (Some(page), Some(engine)) = (&args.export, &args.engine) {
        scene.robot.warnings.iter().for_each(|warning| sinks::print_status(&format!("warning: {warning}")));
        return export(args, [urdf, world], page, engine);
    }
    let wanted = SocketAddr::new(args.bind, args.port);
    let bound = TcpListener::bind(wanted).and_then(|listener| Ok((listener.local_addr()?, listener)));
    let (address, listener) = bound.map_err(|error| {
        let cure = match error.kind() {
            ErrorKind::AddrNotAvailable => "give --bind an address of this machine, or 0.0.0.0 for all its addresses",
            _ => "--port 0 takes any free port",
        };
        Failure::Io(format!("cannot listen at {wanted}: {error}\n  hint: {cure}"))
    })?;
    scene.robot.warnings.iter().for_each(|warning| sinks::print_status(&format!("warning: {warning}")));
    if !args.bind.is_loopback() {
        sinks::print_status(
            "warning: there is no password, so other machines can open this page and plan on this machine",
        );
    }
    let host = Host::new(urdf, world, scene, args.with.clone(), args.time_limit)
        .ok_or_else(|| Failure::Refused("the world is not valid TOML".into()))?;
    sinks::print(&format!("http://{}/\n", reachable(address)))?;
    sinks::print_status("open this address in a browser; Ctrl-C ends the server");
    signals::run_before_exit(&[signals::SIGTERM], || DONE.into());
    serve::run(&listener, host).map_err(|error| Failure::Io(format!("cannot serve: {error}")))?;
    Ok(DONE)
}

/// Returns an address that a browser can open. If the server listens at all addresses of the machine, this is the
/// address by which the machine reaches others.
fn reachable(address: SocketAddr) -> SocketAddr {
    if !address.ip().is_unspecified() {
        return address;
    }
    // A UDP connection sends nothing. The other address is reserved for documentation (RFC 5737, 3849).
    let (here, other) = match address {
        SocketAddr::V4(_) => ("0.0.0.0:0", "192.0.2.1:9"),
        SocketAddr::V6(_) => ("[::]:0", "[2001:db8::1]:9"),
    };
    let socket = UdpSocket::bind(here).and_then(|socket| socket.connect(other).and_then(|()| socket.local_addr()));
    let own = if address.is_ipv4() { IpAddr::V4(Ipv4Addr::LOCALHOST) } else { IpAddr::V6(Ipv6Addr::LOCALHOST) };
    let ip = socket.map_or(own, |local| local.ip());
    SocketAddr::new(if ip.is_unspecified() { own } else { ip }, address.port())
}

/// The first bytes of a file packed by gzip.
const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];

/// Writes the page with the program inside it.
fn export(args: &ServeArgs, [urdf, world]: [Source; 2], page: &Path, engine: &Path) -> Result<u8, Failure> {
    let texts = [urdf, world].map(|source| source.text().to_owned());
    let text = page_with_engine(texts, &args.with, args.time_limit, engine)?;
    write_whole(page, text.as_bytes())?;
    sinks::print_status(&format!("{} written", page.display()));
    Ok(DONE)
}

/// Returns the page with the program inside it. `files` are the texts of the robot and the world.
///
/// # Errors
/// A program that cannot be read.
pub fn page_with_engine(
    files: [String; 2],
    with: &str,
    time_limit: Duration,
    engine: &Path,
) -> Result<String, Failure> {
    let cure = "\n  hint: build it with .ci/page in cplan's sources";
    let wrong = |what: String| Failure::Io(format!("{}: {what}{cure}", engine.display()));
    let program = std::fs::read(engine).map_err(|error| wrong(format!("cannot be read: {error}")))?;
    if !program.starts_with(&GZIP_MAGIC) {
        return Err(wrong("is not packed by gzip".into()));
    }
    let [urdf, world] = files;
    let files = Files { urdf, world, options: with.to_owned() };
    Ok(standalone_page(files, time_limit, &program))
}
