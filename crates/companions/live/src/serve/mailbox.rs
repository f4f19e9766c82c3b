//! Requests of a page that wait for its worker. Only the latest plan counts.

use crate::Request;
use cplan_interrupt::Interrupt;
use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Largest number of waiting requests. At most one of them is a plan.
const MAX_WAITING: usize = 8;

/// A mailbox for requests. A connection adds them, and a worker takes them.
#[derive(Default)]
pub struct Mailbox {
    inside: Mutex<MailboxState>,
    bell: Condvar,
}

#[derive(Default)]
struct MailboxState {
    waiting: VecDeque<Request>,
    /// Interrupt of the request in progress.
    running: Option<Interrupt>,
    closed: bool,
}

impl Mailbox {
    fn lock_state(&self) -> MutexGuard<'_, MailboxState> {
        // The state remains consistent after a panic of a thread that holds the lock.
        self.inside.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a request, and interrupts the one in progress. A newer plan replaces a waiting one. Returns false if the
    /// mailbox is full.
    pub fn post(&self, request: Request) -> bool {
        let mut inside = self.lock_state();
        if matches!(request, Request::Plan(_)) {
            inside.waiting.retain(|waiting| !matches!(waiting, Request::Plan(_)));
        }
        if inside.waiting.len() >= MAX_WAITING {
            return false;
        }
        inside.waiting.push_back(request);
        if let Some(running) = &inside.running {
            running.set();
        }
        self.bell.notify_one();
        true
    }

    /// Waits for the next request, and returns it with its interrupt. `None` when the mailbox is closed.
    pub fn next_request(&self) -> Option<(Request, Interrupt)> {
        let mut inside = self.lock_state();
        inside.running = None;
        loop {
            if inside.closed {
                return None;
            }
            if let Some(request) = inside.waiting.pop_front() {
                let interrupt = Interrupt::new();
                // If a newer request is waiting, interrupt this one immediately.
                if !inside.waiting.is_empty() {
                    interrupt.set();
                }
                inside.running = Some(interrupt.clone());
                return Some((request, interrupt));
            }
            inside = self.bell.wait(inside).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Closes the mailbox: interrupts the request in progress and drops the waiting ones.
    pub fn close(&self) {
        let mut inside = self.lock_state();
        inside.closed = true;
        if let Some(running) = &inside.running {
            running.set();
        }
        self.bell.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PlanRequest;

    fn plan_request(id: u64) -> PlanRequest {
        PlanRequest { id, base: 1, is_final: false, state: None, options: "visibility".into(), think: false }
    }

    fn load(id: u64) -> Request {
        Request::Load { id, text: String::new(), options: "visibility".into() }
    }

    #[test]
    fn only_the_latest_waiting_plan_is_kept() {
        let mailbox = Mailbox::default();
        for id in 1..=100 {
            assert!(mailbox.post(Request::Plan(plan_request(id))));
        }
        let (request, interrupt) = mailbox.next_request().unwrap();
        assert_eq!((request.id(), interrupt.stop_reason()), (100, None));
    }

    #[test]
    fn a_newer_request_stops_the_running_one() {
        let mailbox = Mailbox::default();
        mailbox.post(Request::Plan(plan_request(1)));
        let (_, running) = mailbox.next_request().unwrap();
        assert!(running.stop_reason().is_none());
        mailbox.post(Request::Plan(plan_request(2)));
        assert!(running.stop_reason().is_some());
        assert!(mailbox.next_request().unwrap().1.stop_reason().is_none());
    }

    #[test]
    fn only_plans_are_dropped_and_the_queue_is_bounded() {
        let mailbox = Mailbox::default();
        mailbox.post(Request::Plan(plan_request(1)));
        mailbox.post(load(2));
        mailbox.post(Request::Plan(plan_request(3)));
        let (request, interrupt) = mailbox.next_request().unwrap();
        assert_eq!(request, load(2));
        assert!(interrupt.stop_reason().is_some(), "its plan will not be seen");
        assert_eq!(mailbox.next_request().unwrap().0.id(), 3);
        assert!((0..8).all(|id| mailbox.post(load(id))));
        assert!(!mailbox.post(load(9)));
    }

    #[test]
    fn closing_the_mailbox_stops_the_running_request() {
        let mailbox = Mailbox::default();
        mailbox.post(Request::Plan(plan_request(1)));
        let (_, running) = mailbox.next_request().unwrap();
        mailbox.post(load(2));
        mailbox.close();
        assert!(running.stop_reason().is_some());
        assert!(mailbox.next_request().is_none());
    }
}
