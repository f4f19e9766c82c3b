//! Time and interruption on platforms that have neither a clock nor unwinding, such as WebAssembly without a system.

use std::ops::{Add, Sub};
use std::sync::OnceLock;
use std::time::Duration;

/// Functions that the host of the program provides instead of the operating system.
#[derive(Debug)]
pub struct Host {
    /// Returns the time since a fixed moment.
    pub elapsed: fn() -> Duration,
    /// Ends the interrupted work together with this instance of the program, because its stack cannot be unwound.
    pub stop: fn() -> !,
}

static HOST: OnceLock<Host> = OnceLock::new();

impl Host {
    /// Installs the host permanently. Without a host, time stands still, and interrupted work aborts.
    pub fn serve(self) {
        // A second call has no effect.
        let _ = HOST.set(self);
    }

    /// Lets the installed host end this instance of the program. Returns if there is no host.
    pub(crate) fn end() {
        if let Some(host) = HOST.get() {
            (host.stop)();
        }
    }
}

/// A time of the host's clock, with the interface of [`std::time::Instant`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Instant(Duration);

impl Instant {
    /// Returns the current time.
    pub fn now() -> Self {
        Self(HOST.get().map_or(Duration::ZERO, |host| (host.elapsed)()))
    }

    /// Returns the time since this moment.
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
    fn the_clock_shows_the_time_of_the_host() {
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
