//! The shortest way past walls and barriers.
//!
//! What is closed consists of straight segments, so the shortest way turns at ends of walls alone, and goes straight between
//! them where it crosses none. Wherever rounding may decide, a way counts as open.

use super::cover::{Cell, Cover, CoverSlice, on};
use cplan_core::space::{Configuration, Measure, Segment};
use cplan_geometry::{OpenList, Point};
use cplan_interrupt::checkpoint;

/// By how much sight goes past what cuts it off, as a share of the coordinates: more than rounding amounts to.
const HAIR: f64 = 1e-12;

/// Places that are looked from at most, after which the bound is what is known by then.
const MOST_PLACES: usize = 300_000;

/// What waits: an end of a gap, by its number, or a goal.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Stop {
    Goal,
    Place(usize),
}

/// A lower bound on the length of the ways from `start` to any of the goals: that of the shortest, or `limit`, if that is less.
pub(super) fn shortest(cover: &Cover, measure: Measure, start: Configuration, limit: f64) -> f64 {
    let places: usize = cover.slices.last().map_or(0, |slice| 2 * (slice.first + slice.gaps.len()));
    let mut costs = vec![f64::INFINITY; places];
    let mut open = OpenList::default();
    let rest = |p: Point| cover.goals.iter().map(|goal| goal.distance(measure, p.coords)).fold(f64::INFINITY, f64::min);
    let start = Point::from(start);
    let begin = cover.slices.partition_point(|slice| slice.q1 < start.x);
    let is_on_slice = cover.slices.get(begin).is_some_and(|slice| slice.q1 == start.x);
    let mut next = Some((start, 0.0, begin, is_on_slice));
    let mut looked = 0;
    loop {
        if let Some((at, cost, slice, is_on_slice)) = next {
            let mut see = |seen: Seen| match seen {
                Seen::Goal(part) => open.push(cost + part.distance(measure, at.coords), Stop::Goal),
                Seen::End(slice, gap, end) => {
                    let to = cover.slices[slice].at(gap, end);
                    let number = 2 * (cover.slices[slice].first + gap) + end;
                    let longer = cost + measure.norm(to - at);
                    if longer < costs[number] {
                        costs[number] = longer;
                        open.push(longer + rest(to), Stop::Place(number));
                    }
                }
            };
            let reach = (limit - cost) / measure.norm(Point::new(1.0, 0.0).coords);
            [true, false].iter().for_each(|&ahead| look(cover, at, slice, is_on_slice, ahead, reach, &mut see));
        }
        let Some((bound, stop)) = open.pop() else { return limit };
        looked += 1;
        checkpoint();
        let Stop::Place(number) = stop else { return bound.min(limit) };
        if bound >= limit || looked > MOST_PLACES {
            return bound.min(limit);
        }
        let slice = cover.slices.partition_point(|slice| 2 * (slice.first + slice.gaps.len()) <= number);
        let (gap, end) = (number / 2 - cover.slices[slice].first, number % 2);
        let at = cover.slices[slice].at(gap, end);
        // It may have been reached by a shorter way since.
        let is_stale = bound > costs[number] + rest(at);
        next = (!is_stale).then_some((at, costs[number], slice, true));
    }
}

/// What is seen.
enum Seen {
    /// Some of the goals.
    Goal(Segment),
    /// A slice, a gap of it, and which end of that.
    End(usize, usize, usize),
}

/// All that is seen from a place on the way to one side, up to a distance along joint 1; `slice` is its slice or else the next one.
fn look(
    cover: &Cover,
    from: Point,
    slice: usize,
    is_on_slice: bool,
    ahead: bool,
    reach: f64,
    see: &mut impl FnMut(Seen),
) {
    let mut strip = if ahead && is_on_slice { slice + 1 } else { slice };
    let far_of =
        |strip: usize| if ahead { Some(strip).filter(|k| *k < cover.slices.len()) } else { strip.checked_sub(1) };
    // All slices together are as wide as ways may go, or the domain is.
    if !cover.slices.is_empty() && (strip == 0 || strip == cover.slices.len()) {
        return;
    }
    let [near, beyond] = if ahead { [0, 1] } else { [1, 0] };
    let hair = |y: f64| HAIR * (1.0 + from.y.abs() + if y.is_finite() { y.abs() } else { 0.0 });
    // Slopes of the lines of sight, per distance along joint 1, that are open.
    let mut sight: Vec<[f64; 2]> = Vec::new();
    for cell in cover.cells(strip) {
        let [lower, upper] = [cell.lower, cell.upper].map(|line| on(line, cover.ends(strip), from.x));
        if from.y < lower - hair(lower) || upper + hair(upper) < from.y {
            continue;
        }
        // A cell is convex: all of it is seen.
        cover.goals.iter().filter_map(|goal| cover.within(goal, strip, &cell)).for_each(|part| see(Seen::Goal(part)));
        if is_on_slice {
            ends_within(cover, slice, [lower, upper], see);
        }
        if let Some(far) = far_of(strip) {
            sight.push(slopes(from, cover.slices[far].q1, [cell.lower[beyond], cell.upper[beyond]], hair));
        }
    }
    while let Some(slice) = far_of(strip).filter(|_| !sight.is_empty()) {
        let q1 = cover.slices[slice].q1;
        if (q1 - from.x).abs() >= reach {
            return;
        }
        sight = through(cover, from, slice, &sight, hair, see);
        strip = if ahead { slice + 1 } else { slice };
        let far = far_of(strip);
        let mut after = Vec::new();
        for cell in cover.cells(strip) {
            let entered = slopes(from, q1, [cell.lower[near], cell.upper[near]], hair);
            for part in sight.iter().filter_map(|part| common(*part, entered)) {
                goals_between(cover, from, strip, &cell, part, see);
                let left = far.and_then(|far| {
                    let ends = [cell.lower[beyond], cell.upper[beyond]];
                    common(part, slopes(from, cover.slices[far].q1, ends, hair))
                });
                after.extend(left);
            }
        }
        sight = after;
    }
}

/// The ends of gaps of a slice at which ways turn, between two values of joint 2.
fn ends_within(cover: &Cover, slice: usize, [lower, upper]: [f64; 2], see: &mut impl FnMut(Seen)) {
    let gaps = &cover.slices[slice].gaps;
    let first = gaps.partition_point(|gap| gap.ends[1] < lower);
    for (number, gap) in gaps.iter().enumerate().skip(first).take_while(|(_, gap)| gap.ends[0] <= upper) {
        for end in (0..2).filter(|&end| gap.turns[end] && lower <= gap.ends[end] && gap.ends[end] <= upper) {
            see(Seen::End(slice, number, end));
        }
    }
}

/// What of some lines of sight passes the gaps of a slice.
fn through(
    cover: &Cover,
    from: Point,
    slice: usize,
    sight: &[[f64; 2]],
    hair: impl Fn(f64) -> f64 + Copy,
    see: &mut impl FnMut(Seen),
) -> Vec<[f64; 2]> {
    let CoverSlice { q1, gaps, .. } = &cover.slices[slice];
    let mut left = Vec::new();
    for part in sight {
        let least = from.y + part[0] * (q1 - from.x).abs();
        let first = gaps.partition_point(|gap| gap.ends[1] + hair(gap.ends[1]) < least);
        for (number, gap) in gaps.iter().enumerate().skip(first) {
            let open = slopes(from, *q1, gap.ends, hair);
            if open[0] > part[1] {
                break;
            }
            let Some(both) = common(*part, open) else { continue };
            left.push(both);
            for end in (0..2).filter(|&end| gap.turns[end]) {
                let slope = (gap.ends[end] - from.y) / (q1 - from.x).abs();
                if part[0] <= slope && slope <= part[1] {
                    see(Seen::End(slice, number, end));
                }
            }
        }
    }
    left
}

/// The goals in a cell of a strip between two lines of sight.
fn goals_between(
    cover: &Cover,
    from: Point,
    strip: usize,
    cell: &Cell,
    [low, high]: [f64; 2],
    see: &mut impl FnMut(Seen),
) {
    let above = |slope: f64, part: &Segment| {
        part.ends().map(|q| if slope.is_finite() { q[1] - from.y - slope * (q[0] - from.x).abs() } else { -slope })
    };
    for goal in &cover.goals {
        let part = cover.within(goal, strip, cell).and_then(|part| {
            let [a, b] = above(low, &part);
            let part = part.where_positive(a, b)?;
            let [a, b] = above(high, &part);
            part.where_positive(-a, -b)
        });
        if let Some(part) = part {
            see(Seen::Goal(part));
        }
    }
}

/// The slopes of the lines from a place to values of joint 2 at a slice, and a hair beyond.
fn slopes(from: Point, q1: f64, [lower, upper]: [f64; 2], hair: impl Fn(f64) -> f64) -> [f64; 2] {
    let across = (q1 - from.x).abs();
    [(lower - hair(lower) - from.y) / across, (upper + hair(upper) - from.y) / across]
}

/// What two intervals have in common.
fn common(a: [f64; 2], b: [f64; 2]) -> Option<[f64; 2]> {
    let both = [a[0].max(b[0]), a[1].min(b[1])];
    (both[0] <= both[1]).then_some(both)
}
