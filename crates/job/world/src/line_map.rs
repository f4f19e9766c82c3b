//! Line maps, as MobileSim draws them: a `2D-Map` file of straight walls.
//!
//! ```text
//! 2D-Map
//! LineMinPos: -1000 -1000
//! LineMaxPos: 1000 1000
//! NumLines: 2
//! LINES
//! -500 -500 500 -500
//! 500 -500 500 500
//! DATA
//! ```

use super::map_text::MapText;
use cplan_geometry::Point;
use cplan_robot::InputError;
use std::collections::VecDeque;
use std::path::Path;

/// A line map in its own unit, which is usually the millimetre.
#[derive(Debug, Clone, PartialEq)]
pub struct LineMap {
    /// `LineMinPos` and `LineMaxPos`: lower left and upper right corner. All lines lie between them.
    pub bounds: [Point; 2],
    /// The ends of every line, in the order of the file. Both ends are the same for a line without length.
    pub lines: Vec<[Point; 2]>,
}

/// Consecutive lines of a map whose ends meet, as one polyline.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    /// Corners, of which no two neighbours are the same. A single corner is a line without length.
    pub points: Vec<Point>,
    /// Indices in [`LineMap::lines`] of the chain's first and last line.
    pub lines: [usize; 2],
}

impl LineMap {
    /// Reads a map. Ignores blank lines, lines that begin with `#`, tabs and carriage returns.
    ///
    /// # Errors
    /// A file of another kind; lines in the wrong order, missing, or after the end; numbers that are not finite or outside the
    /// bounds; a `NumLines` that differs from the number of lines. Each error has line and column.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let mut text = MapText::read(path)?;
        let bounds = text.bounds()?;
        let announced = text.count("NumLines")?;
        text.word("LINES")?;
        let list = text.list::<4>(announced, "NumLines", "a line", "DATA")?;
        text.end()?;
        let lines = list.iter().map(|line| text.corners(&line.values, &line.at, &bounds)).collect::<Result<_, _>>()?;
        Ok(Self { bounds, lines })
    }

    /// Joins the lines to as few polylines as possible. A line extends the current polyline if they share an end.
    /// Linear in the number of lines.
    pub fn chains(&self) -> Vec<Chain> {
        let mut chains: Vec<Chain> = Vec::new();
        let mut open: VecDeque<Point> = VecDeque::new();
        let mut first = 0;
        let mut close = |open: &mut VecDeque<Point>, lines| {
            if !open.is_empty() {
                chains.push(Chain { points: std::mem::take(open).into(), lines });
            }
        };
        for (i, &[a, b]) in self.lines.iter().enumerate() {
            let ends = [open.front().copied(), open.back().copied()];
            match ends {
                [_, Some(back)] if back == a || back == b => {
                    let other = if back == a { b } else { a };
                    if other != back {
                        open.push_back(other);
                    }
                }
                [Some(front), _] if front == a || front == b => {
                    let other = if front == a { b } else { a };
                    if other != front {
                        open.push_front(other);
                    }
                }
                _ => {
                    close(&mut open, [first, i.saturating_sub(1)]);
                    first = i;
                    open.extend(if a == b { vec![a] } else { vec![a, b] });
                }
            }
        }
        close(&mut open, [first, self.lines.len().saturating_sub(1)]);
        chains
    }
}
