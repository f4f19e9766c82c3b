//! Wavefronts, coarse enough for drawings and short enough for pages.

use serde::{Serialize, Serializer};

/// Largest number of blocks of cells along an axis. At this number, a block is almost one and a half pixels wide.
const MAX_BLOCKS: usize = 192;
/// Letters for the levels. `NO_LEVEL` is the letter of a block without a level.
const LEVEL_LETTERS: &[u8; LEVELS] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
const NO_LEVEL: char = '.';

/// Largest number of cells along either axis for which each cell shows its number.
const MAX_NUMBERED_CELLS: usize = 32;

/// Number of levels. Each stands for an interval of distances to the goal.
pub const LEVELS: usize = 64;

/// Distances to the goal, one per block of cells: column by column along joint 1, and upwards along joint 2 in each column.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Waves {
    /// Number of blocks of cells along each axis.
    pub blocks: [usize; 2],
    /// Share of each axis that the blocks cover. It exceeds 1 if the last blocks extend beyond the last cell.
    pub extent: [f64; 2],
    /// A letter per block for its level: the least label in the block, as a fraction of the greatest label of all. `NO_LEVEL` if
    /// the wave did not reach the block.
    levels: String,
    /// A letter per block: the position of its first cell in the order of expansion. Empty without an order.
    #[serde(skip_serializing_if = "String::is_empty")]
    order: String,
    /// Greatest label of a cell.
    pub farthest: u32,
    /// True if distances are measured from the start.
    #[serde(skip)]
    pub from_start: bool,
    /// Label of each cell; `None` (-1 in JSON) if the wave did not reach it. Empty if the grid is too fine for legible labels.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "labels_or_minus_one")]
    pub numbers: Vec<Option<u32>>,
}

fn labels_or_minus_one<S: Serializer>(numbers: &[Option<u32>], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(numbers.iter().map(|number| number.map_or(-1, i64::from)))
}

impl Waves {
    /// Returns the wavefront with these labels, and with cells in the order of expansion. `None` without labels.
    pub fn new(cells: [usize; 2], labels: &[u32], expanded: &[u32]) -> Option<Self> {
        if labels.is_empty() || labels.len() != cells[0] * cells[1] {
            return None;
        }
        let farthest = labels.iter().copied().filter(|&l| l != u32::MAX).max().unwrap_or(0);
        let block = cells.map(|n| n.div_ceil(MAX_BLOCKS).max(1));
        let blocks = [0, 1].map(|k| cells[k].div_ceil(block[k]));
        let block_of = |cell: usize| cell / cells[1] / block[0] * blocks[1] + cell % cells[1] / block[1];
        let coarse = |values: &mut dyn Iterator<Item = (usize, u32)>, greatest: u32| -> String {
            let mut least = vec![u32::MAX; blocks[0] * blocks[1]];
            for (cell, value) in values {
                let at = block_of(cell);
                least[at] = least[at].min(value);
            }
            least
                .into_iter()
                .map(|value| letter((value < u32::MAX).then(|| f64::from(value) / f64::from(greatest.max(1)))))
                .collect()
        };
        let numbers = labels.iter().map(|&label| (label != u32::MAX).then_some(label)).collect();
        let places = expanded.iter().zip(0..).map(|(&cell, place)| (cell as usize, place));
        Some(Self {
            blocks,
            extent: [0, 1].map(|k| super::numbers::number((blocks[k] * block[k]) as f64 / cells[k] as f64)),
            levels: coarse(&mut labels.iter().copied().enumerate(), farthest),
            order: if expanded.is_empty() { String::new() } else { coarse(&mut { places }, expanded.len() as u32 - 1) },
            farthest,
            from_start: false,
            numbers: if cells.iter().all(|&n| n <= MAX_NUMBERED_CELLS) { numbers } else { Vec::new() },
        })
    }

    /// Returns blocks with these levels, written as letters, which cover both axes exactly.
    pub fn of_levels(blocks: [usize; 2], levels: String) -> Self {
        Self { blocks, extent: [1.0; 2], levels, ..Self::default() }
    }

    /// Returns the wavefront after the expansion of the fraction `part` of the cells. Without an order of expansion, returns the
    /// blocks up to that fraction of the levels.
    pub fn up_to(&self, part: f64) -> Self {
        let last = (part * LEVELS as f64).floor() as usize;
        let order = if self.order.is_empty() { &self.levels } else { &self.order };
        let there = |letter: u8| LEVEL_LETTERS.iter().position(|&l| l == letter).is_some_and(|level| level < last);
        let levels =
            self.levels.chars().zip(order.bytes()).map(|(level, place)| if there(place) { level } else { NO_LEVEL });
        let numbers = self.numbers.iter().zip(order.bytes()).map(|(number, place)| number.filter(|_| there(place)));
        Self { levels: levels.collect(), numbers: numbers.collect(), ..self.clone() }
    }

    /// Iterates over the levels of the blocks, all below [`LEVELS`]; `None` if the wave did not reach the block.
    pub fn levels(&self) -> impl Iterator<Item = Option<usize>> + '_ {
        self.levels.bytes().map(|letter| LEVEL_LETTERS.iter().position(|&l| l == letter))
    }
}

/// Returns the letter of the level for a value from 0 to 1; `NO_LEVEL` for `None`.
pub fn letter(part: Option<f64>) -> char {
    part.map_or(NO_LEVEL, |part| char::from(LEVEL_LETTERS[(part * (LEVELS - 1) as f64).round() as usize]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fine_wavefront_is_coarsened_and_keeps_narrow_passages() {
        let cells = [401, 390];
        // Only one row of cells has been reached.
        let labels: Vec<u32> = (0..cells[0] * cells[1])
            .map(|k| if k % cells[1] == 200 { (k / cells[1]) as u32 } else { u32::MAX })
            .collect();
        let waves = Waves::new(cells, &labels, &[]).unwrap();
        let levels: Vec<_> = waves.levels().collect();
        assert_eq!(waves.blocks, [134, 130]);
        assert_eq!(levels.iter().flatten().count(), 134);
        assert_eq!(levels[200 / 3], Some(0));
        assert_eq!(levels[133 * 130 + 200 / 3], Some(LEVELS - 1));
    }
}
