//! Reads the head of an HTTP request.

use std::io::{ErrorKind, Read};
use std::net::TcpStream;
use std::time::Instant;

/// Largest size of the head of a request, in bytes.
const MAX_HEAD_BYTES: usize = 16 << 10;

/// Largest number of headers of a request. Browsers send about fifteen.
const MAX_HEADERS: usize = 64;

/// The head of a request.
pub struct Request {
    pub method: String,
    pub path: String,
    headers: Vec<(String, String)>,
}

/// Reason why there is no request.
pub enum RequestError {
    /// The connection was closed, or the time is up.
    Closed,
    /// The head is too long.
    TooLong,
    /// The head is not HTTP.
    Malformed,
}

impl Request {
    /// Reads a request until a point in time.
    ///
    /// # Errors
    /// A closed connection, a late or long head, and a head that is not HTTP.
    pub fn read(stream: &mut TcpStream, until: Instant) -> Result<Self, RequestError> {
        let (mut head, mut count) = (vec![0; MAX_HEAD_BYTES], 0);
        while count < MAX_HEAD_BYTES {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() || stream.set_read_timeout(Some(left)).is_err() {
                return Err(RequestError::Closed);
            }
            match stream.read(&mut head[count..]) {
                Ok(0) => return Err(RequestError::Closed),
                Ok(more) => count += more,
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(_) => return Err(RequestError::Closed),
            }
            if let Some(request) = Self::parse(&head[..count])? {
                return Ok(request);
            }
        }
        Err(RequestError::TooLong)
    }

    /// Parses a head. `None` if it is incomplete.
    fn parse(head: &[u8]) -> Result<Option<Self>, RequestError> {
        let mut headers = [httparse::EMPTY_HEADER; MAX_HEADERS];
        let mut request = httparse::Request::new(&mut headers);
        match request.parse(head) {
            Ok(status) if status.is_partial() => return Ok(None),
            Ok(_) => {}
            Err(httparse::Error::TooManyHeaders) => return Err(RequestError::TooLong),
            Err(_) => return Err(RequestError::Malformed),
        }
        let text = |part: Option<&str>| part.unwrap_or_default().to_owned();
        // A value that is not text equals nothing that the server compares it with.
        let value = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let headers = request.headers.iter().map(|header| (header.name.to_owned(), value(header.value))).collect();
        Ok(Some(Self { method: text(request.method), path: text(request.path), headers }))
    }

    /// Returns the value of a header. `None` if the request does not have it.
    pub fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, value)| value.as_str())
    }

    /// Returns true if a header lists a word.
    pub fn lists(&self, name: &str, word: &str) -> bool {
        self.header(name).is_some_and(|value| value.split(',').any(|listed| listed.trim().eq_ignore_ascii_case(word)))
    }
}
