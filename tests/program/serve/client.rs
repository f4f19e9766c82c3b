//! A page's side of the WebSocket.

use super::server::Server;
use serde_json::{Value, json};
use std::net::TcpStream;
use tungstenite::client::IntoClientRequest;
use tungstenite::http::HeaderValue;
use tungstenite::{Error, Message, WebSocket};

pub struct Page {
    socket: WebSocket<TcpStream>,
    /// Number of the last request.
    id: u64,
    /// Number of the text on which states are based: a state consists of changes to it.
    pub base: u64,
    /// The server's message about the world.
    pub world: Value,
}

impl Page {
    /// Opens a page, and receives its world.
    pub fn open(server: &Server) -> Self {
        Self::try_open(server).unwrap()
    }

    /// Opens a page. If the server refuses, returns the HTTP status as an error.
    pub fn try_open(server: &Server) -> Result<Self, u16> {
        let mut request = format!("ws://{}/live", server.address).into_client_request().unwrap();
        let origin = HeaderValue::from_str(&format!("http://{}", server.address)).unwrap();
        request.headers_mut().insert("Origin", origin);
        let (socket, _) = tungstenite::client(request, server.connect()).map_err(|error| match error {
            tungstenite::HandshakeError::Failure(Error::Http(response)) => response.status().as_u16(),
            other => panic!("{other}"),
        })?;
        let mut page = Self { socket, id: 0, base: 0, world: Value::Null };
        let world = page.begin(&Value::Null);
        assert_eq!(world["kind"], "world", "{world}");
        Ok(page)
    }

    /// Begins a session with files that the page provides, or with the server's own. Returns the server's answer.
    pub fn begin(&mut self, files: &Value) -> Value {
        self.id += 1;
        self.send(&json!({ "do": "open", "id": self.id, "files": files }).to_string());
        let output = self.next();
        assert_eq!(output["id"], self.id, "{output}");
        if output["kind"] == "world" {
            self.base = output["base"].as_u64().unwrap();
            self.world = output.clone();
        }
        output
    }

    pub fn send(&mut self, message: &str) {
        self.socket.send(Message::text(message)).unwrap();
    }

    /// Returns the next message.
    pub fn next(&mut self) -> Value {
        loop {
            let message = match self.socket.read() {
                // A signal is no answer.
                Err(Error::Io(error)) if error.kind() == std::io::ErrorKind::Interrupted => continue,
                read => read.unwrap(),
            };
            match message {
                Message::Text(text) => return serde_json::from_str(&text).unwrap(),
                Message::Binary(_) => panic!("a file that nobody asked for"),
                Message::Close(_) => panic!("closed"),
                _ => {}
            }
        }
    }

    fn plan_request(&mut self, state: Option<Value>, is_final: bool, options: &str) -> Value {
        self.id += 1;
        json!({ "id": self.id, "base": self.base, "final": is_final, "state": state, "options": options })
    }

    /// Requests a plan without waiting for it. Returns the request's number.
    pub fn post(&mut self, state: Option<Value>, is_final: bool, options: &str) -> u64 {
        let mut ask = self.plan_request(state, is_final, options);
        ask["do"] = "plan".into();
        self.send(&ask.to_string());
        self.id
    }

    /// Returns the last answer to the request of this number. Skips answers to other requests.
    pub fn answer(&mut self, id: u64) -> Value {
        loop {
            let message = self.next();
            let is_last = message["kind"] == "failed" || message["done"] == true;
            if message["id"] == id && is_last {
                return message;
            }
        }
    }

    /// Requests a plan for a final state, and waits for it.
    pub fn plan(&mut self, state: Option<Value>, options: &str) -> Value {
        let id = self.post(state, true, options);
        self.answer(id)
    }

    /// Loads another text, and waits for its plan.
    pub fn load(&mut self, text: &str) -> Value {
        self.id += 1;
        self.send(&json!({ "do": "load", "id": self.id, "text": text, "options": "visibility" }).to_string());
        loop {
            let message = self.next();
            if message["id"] != self.id {
                continue;
            }
            if message["kind"] == "world" {
                self.base = message["base"].as_u64().unwrap();
                self.world = message;
            } else if message["kind"] == "failed" || message["done"] == true {
                return message;
            }
        }
    }

    /// Downloads a file: its name and content, or the error.
    pub fn download(&mut self, state: Option<Value>, options: &str, format: &str) -> Result<(String, Vec<u8>), String> {
        let ask = self.plan_request(state, true, options);
        self.send(&json!({ "do": "download", "ask": ask, "format": format }).to_string());
        loop {
            match self.socket.read().unwrap() {
                Message::Binary(bytes) => {
                    let (length, rest) = bytes.split_at(4);
                    let length = u32::from_be_bytes(length.try_into().unwrap()) as usize;
                    let head: Value = serde_json::from_slice(&rest[..length]).unwrap();
                    assert_eq!(head["id"], self.id);
                    return Ok((head["name"].as_str().unwrap().to_owned(), rest[length..].to_vec()));
                }
                Message::Text(text) => {
                    let message: Value = serde_json::from_str(&text).unwrap();
                    if message["id"] == self.id {
                        assert_eq!(message["kind"], "failed", "{message}");
                        return Err(message["error"].as_str().unwrap().to_owned());
                    }
                }
                _ => {}
            }
        }
    }

    /// Returns true if the server reacts to this message by closing the connection. The server may close it before it
    /// has read everything, so the rest of the message may fail to be sent.
    pub fn is_refused(&mut self, message: &str) -> bool {
        if self.socket.send(Message::text(message)).is_err() {
            return true;
        }
        loop {
            match self.socket.read() {
                Ok(Message::Close(_)) | Err(_) => return true,
                Ok(Message::Text(_) | Message::Binary(_)) => return false,
                Ok(_) => {}
            }
        }
    }
}
