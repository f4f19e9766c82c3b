//! An open page: its WebSocket, and the worker that plans for it.

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

/// Largest size of a message from a page, in bytes. It suffices for a world of a megabyte.
pub const MAX_MESSAGE_BYTES: usize = 1 << 20;

/// Largest number of messages that wait to be sent to the page. If there are more, the worker waits.
const MAX_QUEUED_MESSAGES: usize = 4;

/// Time limit for the page to receive a message.
const SEND_TIME: Duration = Duration::from_secs(20);

/// Interval at which the server checks whether a page is still connected.
const PING_INTERVAL: Duration = Duration::from_secs(20);

/// Time without any message from a page after which the page counts as gone.
const MAX_SILENCE: Duration = Duration::from_secs(70);

/// Size of a worker's stack, in bytes. It is that of the main thread.
const WORKER_STACK_BYTES: usize = 8 << 20;

/// Serves one page until it is closed. `permit` is the page's permit, one for each open page.
pub async fn session(mut socket: WebSocket, host: Arc<Host>, permit: OwnedSemaphorePermit) {
    let mailbox = Arc::new(Mailbox::default());
    let (send, mut replies) = mpsc::channel(MAX_QUEUED_MESSAGES);
    let worker = {
        let mailbox = Arc::clone(&mailbox);
        thread::Builder::new().name("planner".into()).stack_size(WORKER_STACK_BYTES).spawn(move || {
            work(&mailbox, host, &send);
            // The permit is released when the work has finished, which may be later than the end of the connection.
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
                    Err(error) => Some(format!("not a valid request: {error}")),
                };
                if let Some(error) = wrong && !send_message(&mut socket, error_message(0, error)).await {
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

/// Sends a message. Returns false if the page does not receive it.
async fn send_message(socket: &mut WebSocket, message: Message) -> bool {
    matches!(timeout(SEND_TIME, socket.send(message)).await, Ok(Ok(())))
}

/// Converts a message for the socket.
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
fn work(mailbox: &Mailbox, host: Arc<Host>, send: &mpsc::Sender<Message>) {
    // If the page is gone, the message is lost; the mailbox is then closed, too.
    let send_message = |message: Message| drop(send.blocking_send(message));
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

/// Runs `work`. If it panics, returns an error message for the page. A session changes its state only after everything
/// that can fail, so it continues with its previous state.
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
