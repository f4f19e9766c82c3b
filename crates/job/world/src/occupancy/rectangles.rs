//! Divides pixels into few rectangles.

/// A rectangle of pixels. `columns` and `rows` are half-open ranges of indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct PixelRectangle {
    /// Columns, from left to right.
    pub columns: [usize; 2],
    /// Rows, from top to bottom.
    pub rows: [usize; 2],
}

/// Divides the solid pixels of a picture of `[width, height]` into rectangles with disjoint interiors. Linear in the number of
/// pixels. Returns `None` if there are more than `most` rectangles.
///
/// Rows are cut into runs of solid pixels, and equal runs in successive rows form one rectangle. The same is done with columns,
/// and the smaller result is returned.
///
/// Each of the two results has one cut through every concave corner of the outline, while a minimal partition has at least one
/// cut per two concave corners. So the result has at most twice the minimal number of rectangles if the outline has no holes, and
/// at most three times with holes. A minimal partition would require a matching of the lines that join two concave corners
/// (Lipski et al. 1979, Ohtsuki 1982).
pub fn rectangles(size: [usize; 2], solid: impl Fn(usize, usize) -> bool, most: usize) -> Option<Vec<PixelRectangle>> {
    let [width, height] = size;
    let by_rows = merged_runs([height, width], |y, x| solid(x, y), most)
        .map(|found| found.into_iter().map(|[rows, columns]| PixelRectangle { columns, rows }).collect::<Vec<_>>());
    let enough = by_rows.as_ref().map_or(most, |found| found.len().saturating_sub(1));
    let by_columns = merged_runs([width, height], &solid, enough);
    match by_columns {
        None => by_rows,
        Some(found) => Some(found.into_iter().map(|[columns, rows]| PixelRectangle { columns, rows }).collect()),
    }
}

/// A run of solid pixels that began in an earlier line and may continue.
struct Open {
    run: [usize; 2],
    since: usize,
}

/// Returns rectangles in the order in which they end: each as a range of lines and a range of positions within a line. `None` if
/// there are more than `most`.
fn merged_runs(
    [lines, length]: [usize; 2],
    solid: impl Fn(usize, usize) -> bool,
    most: usize,
) -> Option<Vec<[[usize; 2]; 2]>> {
    let mut done = Vec::new();
    // Both lists are in ascending order.
    let (mut open, mut next): (Vec<Open>, Vec<Open>) = (Vec::new(), Vec::new());
    for line in 0..=lines {
        let mut before = open.drain(..).peekable();
        let mut at = 0;
        while line < lines && at < length {
            if !solid(line, at) {
                at += 1;
                continue;
            }
            let start = at;
            while at < length && solid(line, at) {
                at += 1;
            }
            let run = [start, at];
            while let Some(ended) = before.next_if(|o| o.run < run) {
                done.push([[ended.since, line], ended.run]);
            }
            let since = before.next_if(|o| o.run == run).map_or(line, |o| o.since);
            next.push(Open { run, since });
        }
        done.extend(before.map(|ended| [[ended.since, line], ended.run]));
        std::mem::swap(&mut open, &mut next);
        if done.len() + open.len() > most {
            return None;
        }
    }
    Some(done)
}
