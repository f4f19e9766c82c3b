//! One open page: its WebSocket, and the worker that plans for it.

use super::mailbox::Mailbox;
use crate::{Host, LiveSession, Reply, Request, TimeSpent};
use axum::body::Bytes;
use axum::extract::ws::{Message, Utf8Bytes, WebSocket};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::thread;
use std::time::Duration;
use tokio::sync::{OwnedSemaphorePermit, mpsc};
use tokio::time::{Instant, MissedTickBehavior, interval, timeout};

/// Bytes of the largest message that a page may send: a world of a megabyte.
pub const MAX_MESSAGE_BYTES: usize = 1 << 20;

/// Messages to the page that may wait before the worker does.
const MAX_QUEUED_MESSAGES: usize = 4;

/// Time that the page has to take a message.
const SEND_TIME: Duration = Duration::from_secs(20);

/// Interval of checks whether a page is still connected.
const PING_INTERVAL: Duration = Duration::from_secs(20);

/// Time without any message after which a page counts as gone.
const MAX_SILENCE: Duration = Duration::from_secs(70);

/// Stack of a worker: as much as the main thread has.
const WORKER_STACK_BYTES: usize = 8 << 20;

/// Serves one page until it is closed. The permit counts it among the open pages.
pub async fn session(mut socket: WebSocket, host: Arc<Host>, permit: OwnedSemaphorePermit) {
    let mailbox = Arc::new(Mailbox::default());
    let (send, mut replies) = mpsc::channel(MAX_QUEUED_MESSAGES);
    let worker = {
        let mailbox = Arc::clone(&mailbox);
        thread::Builder::new().name("planner".into()).stack_size(WORKER_STACK_BYTES).spawn(move || {
            work(&mailbox, host, &send);
            // A new page may open when the work is finished, not when the connection is closed.
            drop(permit);
        })
    };
    if worker.is_err() {
        return;
    }
    let mut ping = interval(PING_INTERVAL);
    ping.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let mut heard = Instant::now();
    loop {
        tokio::select! {
            message = socket.recv() => {
                heard = Instant::now();
                let request = match message {
                    Some(Ok(Message::Text(text))) => serde_json::from_str::<Request>(&text),
                    Some(Ok(Message::Ping(_) | Message::Pong(_))) => continue,
                    _ => break,
                };
                let wrong = match request {
                    Ok(request) => (!mailbox.post(request)).then(|| "too many requests wait".to_owned()),
                    Err(error) => Some(format!("no request: {error}")),
                };
                if let Some(error) = wrong && !send_message(&mut socket, failed(0, error)).await {
                    break;
                }
            }
            reply = replies.recv() => {
                let Some(message) = reply else { break };
                if !send_message(&mut socket, message).await {
                    break;
                }
            }
            _ = ping.tick() => {
                if heard.elapsed() > MAX_SILENCE || !send_message(&mut socket, Message::Ping(Bytes::new())).await {
                    break;
                }
            }
        }
    }
    mailbox.close();
}

/// Sends a message. Returns true if the page received it.
async fn send_message(socket: &mut WebSocket, message: Message) -> bool {
    matches!(timeout(SEND_TIME, socket.send(message)).await, Ok(Ok(())))
}

/// Converts a message for the socket.
fn carried(message: crate::Message) -> Message {
    match message {
        crate::Message::Text(text) => Message::Text(Utf8Bytes::from(text)),
        crate::Message::Binary(bytes) => Message::Binary(bytes.into()),
    }
}

fn failed(id: u64, error: String) -> Message {
    carried(crate::Message::from(&Reply::Failed { id, error }))
}

/// Handles the page's requests in sequence until its mailbox is closed.
fn work(mailbox: &Mailbox, host: Arc<Host>, send: &mpsc::Sender<Message>) {
    // The mailbox is also closed when the page is gone.
    let send_message = |message: Message| drop(send.blocking_send(message));
    let mut desk = LiveSession::new(host);
    while let Some((request, interrupt)) = mailbox.take() {
        let work =
            || desk.take(&request, &interrupt, TimeSpent::Nothing, &mut |message| send_message(carried(message)));
        if let Some(message) = guarded(request.id(), work) {
            send_message(message);
        }
    }
}

/// Runs work and returns an error message if it panics. A desk changes its state only after everything that can fail,
/// so it continues with its previous state.
fn guarded(id: u64, work: impl FnOnce()) -> Option<Message> {
    let error = || "the planner failed on this world, which is a defect of cplan; the page still works".to_owned();
    catch_unwind(AssertUnwindSafe(work)).is_err().then(|| failed(id, error()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_reported_and_the_session_continues() {
        let reply = guarded(7, || std::panic::resume_unwind(Box::new("as a panic does")));
        assert!(matches!(reply, Some(Message::Text(text)) if text.starts_with(r#"{"kind":"failed","id":7,"#)));
        assert!(guarded(8, || ()).is_none());
    }
}
