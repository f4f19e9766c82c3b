//! The wave over four neighbours, which proceeds by runs of cells in a row.

use super::{FreeCells, UNREACHED};
use cplan_geometry::farthest;
use std::ops::Range;

/// Number of levels per bucket of waiting stretches. The last stretch of a bucket is taken first, while its row of origin is
/// still in the cache. With more levels per bucket, more labels are too great initially and must be written again.
const LEVELS_PER_BUCKET: usize = 16;

/// Cost of handling a stretch in addition to copying its cells, in cells (about 100 ns, measured).
const STRETCH_COST: usize = 64;

/// Greatest work, in cells, per cell of the grid. A wave that proceeds cell by cell would be finished by then, so the
/// method gives up.
const MAX_WORK_PER_CELL: usize = 5;

/// Labels every cell that a wave from `sources` (free cells) reaches over shared sides with the number of moves to
/// it, and all others with [`UNREACHED`]. Returns `None` if the method turns out to be slow.
///
/// In each row, labels of neighbouring free cells differ by at most one. Passing on a stretch of a row means that its
/// labels plus one are written to the next row wherever that is less. In the next row, labels of neighbours then also
/// differ by at most one, except at the ends of the stretch. From these ends, labels that increase by one per cell are
/// written until they meet smaller ones, or a wall. Both steps are loops without branches over plain arrays.
///
/// The changed stretch of a row is passed on in turn, least labels first. A stretch also has greater labels than its
/// least one, so a shorter path corrects some of them later. When no stretch waits, no label exceeds a neighbour's by
/// more than one. Then the labels are the distances, whatever the order was.
pub(super) fn run_wave(free: &FreeCells, sources: &[usize]) -> Option<Vec<u32>> {
    let [rows, columns] = free.cells();
    let mut labels = vec![UNREACHED; rows * columns];
    let most = MAX_WORK_PER_CELL.saturating_mul(labels.len().max(STRETCH_COST));
    let mut wave = RunWave { free, labels: &mut labels, queue: Queue::new(columns), work: 0 };
    // The sources are added one by one, so that labels of neighbours in a row always differ by at most one.
    for &source in sources {
        wave.labels[source] = 0;
        let (row, column) = (source / columns, source % columns);
        wave.queue.push(0, Stretch { row, columns: column..column + 1, rows: AffectedRows::BOTH });
        wave.spread(row, column, Side::Before, 1, AffectedRows::BOTH);
        wave.spread(row, column + 1, Side::After, 1, AffectedRows::BOTH);
    }
    while let Some(stretch) = wave.queue.pop() {
        let [before, after] = free.adjacent_lines(0, stretch.row);
        if let Some(to) = before.filter(|_| stretch.rows.before) {
            wave.pass_on(&stretch, to, AffectedRows { before: true, after: false });
        }
        if let Some(to) = after.filter(|_| stretch.rows.after) {
            wave.pass_on(&stretch, to, AffectedRows { before: false, after: true });
        }
        if wave.work > most {
            return None;
        }
    }
    Some(labels)
}

/// The neighbouring rows to which a stretch is passed on.
#[derive(Debug, Clone, Copy)]
struct AffectedRows {
    before: bool,
    after: bool,
}

impl AffectedRows {
    const BOTH: AffectedRows = AffectedRows { before: true, after: true };

    fn opposite(self) -> Self {
        Self { before: self.after, after: self.before }
    }
}

/// Neighbouring free cells of a row, whose labels are to be passed on.
#[derive(Debug, Clone)]
struct Stretch {
    row: usize,
    columns: Range<usize>,
    rows: AffectedRows,
}

/// A direction along a row.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Before,
    After,
}

struct RunWave<'a> {
    free: &'a FreeCells,
    labels: &'a mut [u32],
    queue: Queue,
    /// Work done so far, in cells; see [`STRETCH_COST`].
    work: usize,
}

impl RunWave<'_> {
    /// Passes a stretch on to the neighbouring row `to`, and queues the changes there.
    fn pass_on(&mut self, stretch: &Stretch, to: usize, rows: AffectedRows) {
        let (from, columns) = (stretch.row, self.free.cells()[1]);
        self.work += STRETCH_COST;
        // A circle with only one row.
        if from == to {
            return;
        }
        let mut end = stretch.columns.start;
        loop {
            let start = self.free.next(to, end, stretch.columns.end, true);
            if start == stretch.columns.end {
                break;
            }
            end = self.free.next(to, start, stretch.columns.end, false);
            self.work += end - start;
            let (source, target) = two_rows(self.labels, [from * columns, to * columns], &(start..end));
            let Some((improved, least)) = improve(source, target) else { continue };
            let (first, last) = (start + improved.start, start + improved.end);
            let mut changed = first..last;
            // The changed run may extend behind blocked cells of the row of origin, so it is passed back, too.
            if first == start {
                let value = self.labels[to * columns + first] + 1;
                changed.start = self.spread(to, first, Side::Before, value, rows.opposite());
            }
            if last == end {
                let value = self.labels[to * columns + last - 1] + 1;
                changed.end = self.spread(to, last, Side::After, value, rows.opposite());
            }
            self.queue.push(least, Stretch { row: to, columns: changed, rows });
        }
    }

    /// Writes `value`, `value + 1`, ... to a row from `edge` towards one side, while that lowers the labels. Queues the changes
    /// for `rows`, and those beyond a seam for both neighbouring rows. Returns the end of the change before the seam.
    fn spread(&mut self, row: usize, edge: usize, side: Side, value: u32, rows: AffectedRows) -> usize {
        let columns = self.free.cells()[1];
        let limit = if side == Side::Before { 0 } else { columns };
        let (here, next) = self.rise(row, edge, side, value, rows);
        if here == limit && self.free.circles()[1] {
            self.rise(row, columns - limit, side, next, AffectedRows::BOTH);
        }
        here
    }

    /// Like [`Self::spread`], but stops at a limit or at the seam. Returns the end of the change, and the next value.
    fn rise(&mut self, row: usize, edge: usize, side: Side, value: u32, rows: AffectedRows) -> (usize, u32) {
        let columns = self.free.cells()[1];
        let run = match side {
            Side::Before => self.free.run_start(row, edge)..edge,
            Side::After => edge..self.free.next(row, edge, columns, false),
        };
        let line = &mut self.labels[row * columns + run.start..row * columns + run.end];
        let label = |k: usize| value + k as u32;
        let changed = match side {
            Side::Before => {
                let rising = prefix(line.len(), |k| line[line.len() - 1 - k] > label(k));
                line.iter_mut().rev().take(rising).zip(value..).for_each(|(cell, label)| *cell = label);
                run.end - rising..run.end
            }
            Side::After => {
                let rising = prefix(line.len(), |k| line[k] > label(k));
                line[..rising].iter_mut().zip(value..).for_each(|(cell, label)| *cell = label);
                run.start..run.start + rising
            }
        };
        self.work += changed.len();
        let (next, here) = (label(changed.len()), if side == Side::Before { changed.start } else { changed.end });
        if !changed.is_empty() {
            self.queue.push(value, Stretch { row, columns: changed, rows });
        }
        (here, next)
    }
}

/// Returns the same columns of two different rows that start at `at`: the first for reading, the second for writing.
fn two_rows<'a>(labels: &'a mut [u32], at: [usize; 2], columns: &Range<usize>) -> (&'a [u32], &'a mut [u32]) {
    let (low, high) = labels.split_at_mut(at[0].max(at[1]));
    let low_line = |at: usize| at + columns.start..at + columns.end;
    if at[0] < at[1] {
        (&low[low_line(at[0])], &mut high[columns.clone()])
    } else {
        (&high[columns.clone()], &mut low[low_line(at[1])])
    }
}

/// Writes `source + 1` wherever that is less than `target`. Returns the range from the first to the last changed
/// cell, and the least label in it; `None` if nothing changed.
fn improve(source: &[u32], target: &mut [u32]) -> Option<(Range<usize>, u32)> {
    let better = |(source, target): (&u32, &u32)| *target > *source + 1;
    let first = source.iter().zip(&*target).position(better)?;
    let last = source.iter().zip(&*target).rposition(better)?;
    let mut least = UNREACHED;
    for (source, target) in source[first..=last].iter().zip(&mut target[first..=last]) {
        *target = (source + 1).min(*target);
        least = least.min(*target);
    }
    Some((first..last + 1, least))
}

/// Returns how many of the first `length` numbers satisfy a condition. No number after one that does not satisfy it may
/// satisfy it.
fn prefix(length: usize, condition: impl Fn(usize) -> bool) -> usize {
    if length == 0 || condition(length - 1) {
        return length;
    }
    farthest(0, length - 1, |count| condition(count - 1))
}

/// The waiting stretches, in a ring of buckets by their least label.
struct Queue {
    buckets: Vec<Vec<Stretch>>,
    /// Number of the current bucket. It increases without limit. The position in the ring is its remainder.
    current: usize,
    waiting: usize,
}

impl Queue {
    /// Creates the queue for rows of `columns` cells. A stretch is at most as long as a row, and its labels increase by
    /// at most one per cell. This limits how far labels can be ahead of the current ones.
    fn new(columns: usize) -> Self {
        Self { buckets: vec![Vec::new(); columns / LEVELS_PER_BUCKET + 3], current: 0, waiting: 0 }
    }

    /// Queues a stretch by its least label. Labels below the current ones, or too far ahead, are queued out of order,
    /// which costs only time.
    fn push(&mut self, label: u32, stretch: Stretch) {
        let ring = self.buckets.len();
        let bucket = (label as usize / LEVELS_PER_BUCKET).clamp(self.current, self.current + ring - 1);
        self.buckets[bucket % ring].push(stretch);
        self.waiting += 1;
    }

    fn pop(&mut self) -> Option<Stretch> {
        if self.waiting == 0 {
            return None;
        }
        let ring = self.buckets.len();
        loop {
            if let Some(stretch) = self.buckets[self.current % ring].pop() {
                self.waiting -= 1;
                return Some(stretch);
            }
            self.current += 1;
        }
    }
}
