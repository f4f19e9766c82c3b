//! Time, and the end of work that is stopped, where the platform has neither: WebAssembly without a system.

use std::ops::{Add, Sub};
use std::sync::OnceLock;
use std::time::Duration;

/// What the host of the program does in place of the platform.
#[derive(Debug)]
pub struct Host {
    /// The time since some moment that stays the same.
    pub elapsed: fn() -> Duration,
    /// Ends the work that is stopped, and with it this instance of the program: nothing can be unwound there.
    pub stop: fn() -> !,
}

static HOST: OnceLock<Host> = OnceLock::new();

impl Host {
    /// Puts it in place, once and for all. Without one time stands still, and work that is stopped aborts.
    pub fn serve(self) {
        // A second host would only say the same.
        let _ = HOST.set(self);
    }

    /// Has the one in place end this instance; returns where there is none.
    pub(crate) fn end() {
        if let Some(host) = HOST.get() {
            (host.stop)();
        }
    }
}

/// A moment, by the host's clock; used like that of [`std::time`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Instant(Duration);

impl Instant {
    /// This moment.
    #[must_use]
    pub fn now() -> Self {
        Self(HOST.get().map_or(Duration::ZERO, |host| (host.elapsed)()))
    }

    /// The time since then.
    #[must_use]
    pub fn elapsed(self) -> Duration {
        Self::now() - self
    }
}

impl Add<Duration> for Instant {
    type Output = Self;

    fn add(self, time: Duration) -> Self {
        Self(self.0 + time)
    }
}

impl Sub for Instant {
    type Output = Duration;

    fn sub(self, before: Self) -> Duration {
        self.0.saturating_sub(before.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_is_the_hosts() {
        let begun = Instant::now();
        Host::end();
        assert_eq!(begun.elapsed(), Duration::ZERO, "without a host time stands still");
        Host { elapsed: || Duration::from_millis(250), stop: || std::panic::resume_unwind(Box::new("stopped")) }
            .serve();
        assert_eq!(begun.elapsed(), Duration::from_millis(250));
        assert!(begun + Duration::from_secs(1) > Instant::now());
        assert_eq!(begun - Instant::now(), Duration::ZERO, "as with std, time never runs backwards");
        assert!(std::panic::catch_unwind(Host::end).is_err(), "nothing returns from where work is stopped");
    }
}
