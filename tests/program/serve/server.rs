//! The server as a process.

pub use crate::cli::shipped;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// Time after which a test fails. It is far longer than any request takes.
pub const TIME_LIMIT: Duration = Duration::from_secs(120);

/// A server that is killed when it is dropped.
pub struct Server {
    pub child: Child,
    pub address: SocketAddr,
}

impl Server {
    /// Starts a server on a free port.
    pub fn start(arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_cplan"))
            .args(["serve", "--port", "0"])
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let address = line.trim_end().strip_prefix("http://").and_then(|rest| rest.strip_suffix('/'));
        let address = address.unwrap_or_else(|| panic!("no address: {line:?}")).parse().unwrap();
        Self { child, address }
    }

    /// Starts a server with `planar_2r` in a shipped world.
    pub fn planar(world: &str, more: &[&str]) -> Self {
        let files = [shipped("robots/planar_2r.urdf"), shipped(world)];
        let mut arguments: Vec<&str> = files.iter().map(String::as_str).collect();
        arguments.extend(more);
        // Plans must finish, however busy the machine is.
        if !more.contains(&"--time-limit") {
            arguments.extend(["--time-limit", "3600"]);
        }
        Self::start(&arguments)
    }

    pub fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(TIME_LIMIT)).unwrap();
        stream
    }

    /// Returns the answer to a request, which is sent as it is, except that `HOST` is replaced by the address.
    pub fn raw(&self, request: &str) -> Response {
        let mut stream = self.connect();
        // A server that refuses may answer and close before it has read everything. Its answer can be read
        // nevertheless.
        let _ = stream.write_all(request.replace("HOST", &self.address.to_string()).as_bytes());
        // Does not read to the end: a server that keeps the connection would block the test.
        let mut bytes = Vec::new();
        let mut chunk = [0; 4096];
        while !is_whole(&bytes) {
            match stream.read(&mut chunk) {
                Ok(0) | Err(_) => break,
                Ok(count) => bytes.extend_from_slice(&chunk[..count]),
            }
        }
        Response(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// Returns the answer to a GET request.
    pub fn get(&self, path: &str) -> Response {
        self.raw(&format!("GET {path} HTTP/1.1\r\nHost: HOST\r\nConnection: close\r\n\r\n"))
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Returns true if an answer is complete, with a body of the stated length.
fn is_whole(bytes: &[u8]) -> bool {
    let Some(end) = bytes.windows(4).position(|four| four == b"\r\n\r\n") else { return false };
    let head = String::from_utf8_lossy(&bytes[..end]).to_ascii_lowercase();
    let length = head.lines().find_map(|line| line.strip_prefix("content-length:")?.trim().parse::<usize>().ok());
    length.is_some_and(|length| bytes.len() >= end + 4 + length)
}

/// A server's answer.
pub struct Response(pub String);

impl Response {
    pub fn status(&self) -> u16 {
        self.0
            .split(' ')
            .nth(1)
            .and_then(|status| status.parse().ok())
            .unwrap_or_else(|| panic!("no status: {:?}", self.0))
    }

    pub fn header(&self, name: &str) -> &str {
        let head = self.0.split("\r\n\r\n").next().unwrap();
        let value = |line: &'_ str| -> bool { line.to_ascii_lowercase().starts_with(&format!("{name}: ")) };
        head.lines().find(|line| value(line)).map_or("", |line| &line[name.len() + 2..])
    }

    pub fn body(&self) -> &str {
        self.0.split_once("\r\n\r\n").map_or("", |(_, body)| body)
    }
}
