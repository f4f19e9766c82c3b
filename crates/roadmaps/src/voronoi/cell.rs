//! The cell of a site: which other one is as near, along all its rays.

use super::bisector::Bisector;
use super::site::Site;
use cplan_interrupt::checkpoint;

/// Parameters that differ by less are the same: rounding of where bisectors meet.
const SAME: f64 = 1e-11;

/// Values that differ by less, relative to them, are the same where a bisector is chosen.
const EVEN: f64 = 1e-10;

/// Halvings of a parameter's range, down to the last bits.
const HALVINGS: usize = 60;

/// A piece of a cell's border.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    pub bisector: Bisector,
    /// Parameters of its ends.
    pub from: f64,
    pub to: f64,
}

impl Arc {
    /// The greatest height of its ends, and so of all of it: no bisector has a hump.
    pub fn greatest(&self) -> f64 {
        self.bisector.height(self.from).max(self.bisector.height(self.to))
    }
}

/// The lower envelope of a site's bisectors with others, in order; with gaps where there is none. `O(k m)` for `k` arcs and `m`
/// bisectors.
pub(super) fn border(site: &Site, others: &[Site], bisectors: &[Bisector]) -> Vec<Arc> {
    checkpoint();
    let [first, last] = site.range;
    let slack = SAME * (last - first).min(1.0);
    let mut arcs = Vec::new();
    let touching = |a: &Bisector, b: &Bisector| {
        let (a, b) = (&others[a.other], &others[b.other]);
        a.is_side != b.is_side && [(a, b), (b, a)].iter().any(|(x, y)| x.is_side && (x.at == y.at || x.to == y.at))
    };
    let mut at = first;
    let mut current = lowest(bisectors, at, slack);
    // Each bisector falls below another one twice at the most.
    for _ in 0..8 * bisectors.len() + 8 {
        let Some(mut now) = current else {
            // A gap, to where the next bisector begins.
            let next = bisectors.iter().map(|b| b.from).filter(|from| *from > at + slack).fold(f64::INFINITY, f64::min);
            if next >= last {
                break;
            }
            at = next;
            current = lowest(bisectors, at, slack);
            continue;
        };
        // A side is nearer than its own end wherever it is seen.
        let seen = |b: &&Bisector| b.from <= at + slack && b.to > at + slack && touching(b, now);
        if !others[now.other].is_side {
            now = bisectors.iter().filter(|b| others[b.other].is_side).find(seen).unwrap_or(now);
        }
        let (mut end, mut next) = (now.to, None);
        for b in bisectors {
            if b.to <= at + slack || std::ptr::eq(b, now) {
                continue;
            }
            let event = if touching(b, now) {
                (others[b.other].is_side && b.from > at).then_some(b.from)
            } else if b.from > at && b.from < end && b.value(b.from) < now.value(b.from) {
                Some(b.from)
            } else {
                let falls = b.falls_below(now).filter(|t| *t >= b.from.max(at - slack) && *t <= b.to);
                falls.filter(|t| *t > at + slack || b.slope(*t) < now.slope(*t) - EVEN).map(|t| t.max(at))
            };
            if let Some(t) = event.filter(|t| *t < end) {
                (end, next) = (t, Some(b));
            }
        }
        // What rounding has hidden shows in the middle.
        let middle = 0.5 * (at + end);
        let below = |b: &&Bisector, t: f64| {
            b.from <= t
                && b.to >= t
                && !touching(b, now)
                && b.value(t) < now.value(t) - EVEN * (1.0 + now.value(t).abs())
        };
        if let Some(hidden) = bisectors.iter().find(|b| end - at > 4.0 * slack && below(b, middle)) {
            let (mut low, mut high) = (at, middle);
            for _ in 0..HALVINGS {
                let half = 0.5 * (low + high);
                (low, high) = if below(&hidden, half) { (low, half) } else { (half, high) };
            }
            (end, next) = (high, Some(hidden));
        }
        if end > at {
            arcs.push(Arc { bisector: *now, from: at, to: end });
        }
        if end >= last - slack {
            break;
        }
        at = end;
        current = next.or_else(|| lowest(bisectors, at, slack));
    }
    arcs
}

/// The bisector of least value right after a parameter; of equal ones that which falls most, and sides before corners.
fn lowest(bisectors: &[Bisector], at: f64, slack: f64) -> Option<&Bisector> {
    let here = || bisectors.iter().filter(|b| b.from <= at + slack && b.to > at + slack);
    let least = here().map(|b| b.value(at)).fold(f64::INFINITY, f64::min);
    let even = here().filter(|b| b.value(at) <= least + EVEN * (1.0 + least.abs()));
    even.min_by(|a, b| a.slope(at).total_cmp(&b.slope(at)))
}
