//! The cell of a site: on each of the site's rays, the first point that is equally near to another site.

use super::bisector::Bisector;
use super::site::Site;
use cplan_interrupt::checkpoint;

/// Parameters closer than this count as equal. It covers the rounding of points where bisectors meet.
const PARAMETER_TOLERANCE: f64 = 1e-11;

/// Values count as equal, when a bisector is chosen, if their relative difference is smaller.
const VALUE_TOLERANCE: f64 = 1e-10;

/// Number of halvings of a range of parameters. It reaches the last bits.
const PARAMETER_HALVINGS: usize = 60;

/// A piece of a cell's border, on one bisector.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    pub bisector: Bisector,
    /// Parameters of the ends.
    pub from: f64,
    pub to: f64,
}

impl Arc {
    /// Returns the greatest height on the arc. It is at an end, because no bisector has a maximum in between.
    pub fn greatest(&self) -> f64 {
        self.bisector.height(self.from).max(self.bisector.height(self.to))
    }
}

/// Returns the lower envelope of a site's bisectors, in order, with gaps where there is no bisector. `O(k m)` for `k` arcs and
/// `m` bisectors.
pub(super) fn border(site: &Site, others: &[Site], bisectors: &[Bisector]) -> Vec<Arc> {
    checkpoint();
    let [first, last] = site.range;
    let slack = PARAMETER_TOLERANCE * (last - first).min(1.0);
    let envelope = Envelope { others, bisectors, slack };
    let mut arcs = Vec::new();
    let mut at = first;
    let mut current = envelope.lowest(at);
    // A bisector falls below another one at most twice.
    for _ in 0..8 * bisectors.len() + 8 {
        let Some(now) = current else {
            at = envelope.next_start(at);
            if at >= last {
                break;
            }
            current = envelope.lowest(at);
            continue;
        };
        let now = envelope.side_of(now, at);
        let (end, next) = envelope.end(now, at);
        if end > at {
            arcs.push(Arc { bisector: *now, from: at, to: end });
        }
        if end >= last - slack {
            break;
        }
        at = end;
        current = next.or_else(|| envelope.lowest(at));
    }
    arcs
}

/// The bisectors of a site, and their lower envelope.
struct Envelope<'a> {
    others: &'a [Site],
    bisectors: &'a [Bisector],
    /// Parameters closer than this count as equal.
    slack: f64,
}

impl<'a> Envelope<'a> {
    /// Returns the bisector of least value right after a parameter; among equal ones, that of least slope. `None` if there is no
    /// bisector.
    fn lowest(&self, at: f64) -> Option<&'a Bisector> {
        let here = || self.bisectors.iter().filter(|b| self.is_after(b, at));
        let least = here().map(|b| b.value(at)).fold(f64::INFINITY, f64::min);
        let even = here().filter(|b| b.value(at) <= least + VALUE_TOLERANCE * (1.0 + least.abs()));
        even.min_by(|a, b| a.slope(at).total_cmp(&b.slope(at)))
    }

    /// Returns true if a bisector exists right after a parameter.
    fn is_after(&self, b: &Bisector, at: f64) -> bool {
        b.from <= at + self.slack && b.to > at + self.slack
    }

    /// Returns the parameter after a gap at which the next bisector begins. Infinite if there is none.
    fn next_start(&self, at: f64) -> f64 {
        self.bisectors.iter().map(|b| b.from).filter(|from| *from > at + self.slack).fold(f64::INFINITY, f64::min)
    }

    fn is_of_side(&self, b: &Bisector) -> bool {
        self.others[b.other].is_side
    }

    /// Returns true if one bisector belongs to a side and the other to an end of that side.
    fn touching(&self, a: &Bisector, b: &Bisector) -> bool {
        let (a, b) = (&self.others[a.other], &self.others[b.other]);
        a.is_side != b.is_side && [(a, b), (b, a)].iter().any(|(x, y)| x.is_side && (x.at == y.at || x.to == y.at))
    }

    /// If `now` is the bisector with an end of a side, returns that with the side, otherwise `now`. Where a side has a bisector,
    /// the side is nearer than its ends.
    fn side_of(&self, now: &'a Bisector, at: f64) -> &'a Bisector {
        if self.is_of_side(now) {
            return now;
        }
        let is_seen = |b: &&Bisector| self.is_of_side(b) && self.is_after(b, at) && self.touching(b, now);
        self.bisectors.iter().find(is_seen).unwrap_or(now)
    }

    /// Returns the parameter at which the envelope leaves a bisector that it follows from `at` on, and the next bisector if it is
    /// known.
    fn end(&self, now: &Bisector, at: f64) -> (f64, Option<&'a Bisector>) {
        let (mut end, mut next) = (now.to, None);
        for b in self.bisectors {
            if b.to <= at + self.slack || std::ptr::eq(b, now) {
                continue;
            }
            if let Some(t) = self.crossing(b, now, [at, end]) {
                (end, next) = (t, Some(b));
            }
        }
        self.takeover_hidden_by_rounding(now, at, end).unwrap_or((end, next))
    }

    /// Returns the parameter in a range at which another bisector becomes the lowest. `None` if it does not.
    fn crossing(&self, b: &Bisector, now: &Bisector, [at, end]: [f64; 2]) -> Option<f64> {
        let event = if self.touching(b, now) {
            (self.is_of_side(b) && b.from > at).then_some(b.from)
        } else if b.from > at && b.from < end && b.value(b.from) < now.value(b.from) {
            Some(b.from)
        } else {
            let falls = b.falls_below(now).filter(|t| *t >= b.from.max(at - self.slack) && *t <= b.to);
            falls.filter(|t| *t > at + self.slack || b.slope(*t) < now.slope(*t) - VALUE_TOLERANCE).map(|t| t.max(at))
        };
        event.filter(|t| *t < end)
    }

    /// Returns a change of the lowest bisector that rounding has hidden: the parameter, and the bisector that is lower in the
    /// middle of the range.
    fn takeover_hidden_by_rounding(&self, now: &Bisector, at: f64, end: f64) -> Option<(f64, Option<&'a Bisector>)> {
        let is_below = |b: &Bisector, t: f64| {
            b.from <= t
                && b.to >= t
                && !self.touching(b, now)
                && b.value(t) < now.value(t) - VALUE_TOLERANCE * (1.0 + now.value(t).abs())
        };
        if end - at <= 4.0 * self.slack {
            return None;
        }
        let (mut low, mut high) = (at, 0.5 * (at + end));
        let hidden = self.bisectors.iter().find(|b| is_below(b, high))?;
        for _ in 0..PARAMETER_HALVINGS {
            let half = 0.5 * (low + high);
            (low, high) = if is_below(hidden, half) { (low, half) } else { (half, high) };
        }
        Some((high, Some(hidden)))
    }
}
