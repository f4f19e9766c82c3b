//! cplan in a browser: what answers the live page where there is no server, as WebAssembly.
//!
//! ```text
//! page -> worker: room(bytes), UTF-8 into the memory, take() -> live::Alone -> tell(at, bytes, is_text) -> worker -> page
//! ```
//!
//! Orders and replies are the live page's JSON; the other side is `worker.js` of `crates/companions/live/src/assets`. Work that takes too long ends
//! the instance (`stop` throws), and the worker begins another. Built for `wasm32-unknown-unknown` alone, by `.ci/page`; for all
//! else this crate is empty.
#![cfg(all(target_family = "wasm", target_os = "unknown"))]

use cplan::interrupt::Host;
use cplan::live::{Message, StandalonePage};
use std::cell::RefCell;
use std::panic;
use std::time::Duration;

// What the worker does for the program. Numbers and places in the memory go over, nothing else; to call it is safe, since it only
// reads the memory, and before it returns.
#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// Returns the milliseconds since a fixed moment.
    safe fn elapsed() -> f64;
    /// Throws an exception in JavaScript, which ends everything that runs in this instance.
    safe fn stop() -> !;
    /// Sends a message to the page: a text or a file.
    safe fn post_message(at: *const u8, bytes: usize, is_text: bool);
    /// Reports the message of a panic.
    safe fn panicked(at: *const u8, bytes: usize);
}

thread_local! {
    static PAGE_PROGRAM: RefCell<Option<StandalonePage>> = const { RefCell::new(None) };
    /// The buffer into which the worker writes an order.
    static ORDER_BUFFER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Returns the place where an order of so many bytes is to be written.
// The name is used once: there is no other library in the instance.
#[unsafe(no_mangle)]
pub extern "C" fn room(bytes: usize) -> *mut u8 {
    ORDER_BUFFER.with_borrow_mut(|order| {
        *order = vec![0; bytes];
        order.as_mut_ptr()
    })
}

/// Executes the order in the buffer.
// As above.
#[unsafe(no_mangle)]
pub extern "C" fn take() {
    let order = String::from_utf8_lossy(&ORDER_BUFFER.take()).into_owned();
    PAGE_PROGRAM.with_borrow_mut(|alone| alone.get_or_insert_with(start_program).execute(&order, &mut send));
}

/// Returns the program. The worker provides its clock, and the function that ends it.
fn start_program() -> StandalonePage {
    Host { elapsed: || Duration::from_secs_f64(elapsed() / 1e3), stop: || stop() }.serve();
    panic::set_hook(Box::new(|panic| {
        let text = panic.to_string();
        panicked(text.as_ptr(), text.len());
    }));
    StandalonePage::default()
}

fn send(message: Message) {
    match message {
        Message::Text(text) => post_message(text.as_ptr(), text.len(), true),
        Message::Binary(bytes) => post_message(bytes.as_ptr(), bytes.len(), false),
    }
}
