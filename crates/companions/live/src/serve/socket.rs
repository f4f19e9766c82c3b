//! An open page: its WebSocket, and the worker that plans for it.

use super::Permit;
use super::mailbox::Mailbox;
use crate::{Host, LiveSession, Reply, Request, TimeSpent};
use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::Duration;
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Bytes, Message, Utf8Bytes, WebSocket};

/// Largest size of a message from a page, in bytes. A world of a megabyte fits.
const MAX_MESSAGE_BYTES: usize = 1 << 20;

/// Largest number of messages in the queue to the page. If it is full, the worker waits.
const MAX_QUEUED_MESSAGES: usize = 4;

/// Time limit for the page to receive a part of a message.
const SEND_TIME: Duration = Duration::from_secs(20);

/// Interval between pings, which check whether a page is still connected.
const PING_INTERVAL: Duration = Duration::from_secs(20);

/// Time without a message after which a page counts as gone.
const MAX_SILENCE: Duration = Duration::from_secs(70);

/// Size of a worker's stack, in bytes, as for the main thread.
const WORKER_STACK_BYTES: usize = 8 << 20;

/// A part of the stream to the page.
enum Outgoing {
    Message(Message),
    /// Bytes of a whole frame: the reply to a ping, or to the closing of the page.
    Frame(Vec<u8>),
}

/// The receiving side of the connection to the page. Its own frames go through the queue, so that none interrupts another.
struct Incoming {
    stream: TcpStream,
    frame: Vec<u8>,
    queue: SyncSender<Outgoing>,
}

impl Read for Incoming {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.stream.read(buffer)
    }
}

impl Write for Incoming {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.frame.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        let frame = std::mem::take(&mut self.frame);
        if !frame.is_empty() {
            self.queue.send(Outgoing::Frame(frame)).map_err(|_| io::ErrorKind::BrokenPipe)?;
        }
        Ok(())
    }
}

/// Serves one page until it is closed. Each open page holds a `permit`.
pub fn serve(stream: TcpStream, host: &Arc<Host>, permit: Permit) {
    let limits = [stream.set_read_timeout(Some(MAX_SILENCE)), stream.set_write_timeout(Some(SEND_TIME))];
    let Ok(ours) = stream.try_clone() else { return };
    if limits.iter().any(Result::is_err) {
        return;
    }
    let mailbox = Arc::new(Mailbox::default());
    let (queue, outgoing) = sync_channel(MAX_QUEUED_MESSAGES);
    let sender = thread::Builder::new().name("sender".into()).spawn(move || send_all(ours, &outgoing));
    let worker = {
        let (mailbox, host, queue) = (Arc::clone(&mailbox), Arc::clone(host), queue.clone());
        thread::Builder::new().name("planner".into()).stack_size(WORKER_STACK_BYTES).spawn(move || {
            work(&mailbox, host, &queue);
            // Release the permit when the work has finished, which may be after the connection has ended.
            drop(permit);
        })
    };
    if sender.is_ok() && worker.is_ok() {
        receive_all(Incoming { stream, frame: Vec::new(), queue }, &mailbox);
    }
    // This ends the worker, and then the sender, which closes the connection.
    mailbox.close();
}

/// Passes the page's requests to the mailbox, until the page is closed or silent for too long.
fn receive_all(page: Incoming, mailbox: &Mailbox) {
    let queue = page.queue.clone();
    let limits =
        WebSocketConfig::default().max_message_size(Some(MAX_MESSAGE_BYTES)).max_frame_size(Some(MAX_MESSAGE_BYTES));
    let mut socket = WebSocket::from_raw_socket(page, Role::Server, Some(limits));
    loop {
        let request = match socket.read() {
            Ok(Message::Text(text)) => serde_json::from_str::<Request>(&text),
            Ok(Message::Ping(_) | Message::Pong(_)) => continue,
            Err(tungstenite::Error::Io(error)) if error.kind() == io::ErrorKind::Interrupted => continue,
            _ => break,
        };
        let wrong = match request {
            Ok(request) => (!mailbox.post(request)).then(|| "too many requests wait".to_owned()),
            Err(error) => Some(format!("not a valid request: {error}")),
        };
        if let Some(error) = wrong
            && queue.send(Outgoing::Message(error_message(0, error))).is_err()
        {
            break;
        }
    }
}

/// Sends messages to the page, with pings in between. Ends when the page receives nothing, or when there are no more senders.
fn send_all(stream: TcpStream, outgoing: &Receiver<Outgoing>) {
    let mut socket = WebSocket::from_raw_socket(stream, Role::Server, None);
    loop {
        let sent = match outgoing.recv_timeout(PING_INTERVAL) {
            Ok(Outgoing::Message(message)) => socket.send(message),
            Ok(Outgoing::Frame(frame)) => socket.get_mut().write_all(&frame).map_err(Into::into),
            Err(RecvTimeoutError::Timeout) => socket.send(Message::Ping(Bytes::new())),
            Err(RecvTimeoutError::Disconnected) => break,
        };
        if sent.is_err() {
            break;
        }
    }
    // This also ends the receiving thread.
    let _ = socket.get_mut().shutdown(Shutdown::Both);
}

fn to_socket_message(message: crate::Message) -> Message {
    match message {
        crate::Message::Text(text) => Message::Text(Utf8Bytes::from(text)),
        crate::Message::Binary(bytes) => Message::Binary(bytes.into()),
    }
}

fn error_message(id: u64, error: String) -> Message {
    to_socket_message(crate::Message::from(&Reply::Failed { id, error }))
}

/// Handles the page's requests in sequence, until the mailbox is closed.
fn work(mailbox: &Mailbox, host: Arc<Host>, queue: &SyncSender<Outgoing>) {
    // If the page is gone, the message is lost. The mailbox is then closed, too.
    let send_message = |message: Message| drop(queue.send(Outgoing::Message(message)));
    let mut session = LiveSession::new(host);
    while let Some((request, interrupt)) = mailbox.next_request() {
        let work = || {
            session.handle(&request, &interrupt, TimeSpent::Nothing, &mut |message| {
                send_message(to_socket_message(message))
            })
        };
        if let Some(message) = run_guarded(request.id(), work) {
            send_message(message);
        }
    }
}

/// Runs `work`. A panic becomes an error message for the page. A session changes its state only after everything that
/// can fail, so it continues with its previous state.
fn run_guarded(id: u64, work: impl FnOnce()) -> Option<Message> {
    let error = || "the planner failed on this world, which is a defect of cplan; the page still works".to_owned();
    catch_unwind(AssertUnwindSafe(work)).is_err().then(|| error_message(id, error()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_reported_and_the_session_continues() {
        let reply = run_guarded(7, || std::panic::resume_unwind(Box::new("as a panic does")));
        assert!(matches!(reply, Some(Message::Text(text)) if text.starts_with(r#"{"kind":"failed","id":7,"#)));
        assert!(run_guarded(8, || ()).is_none());
    }
}
