//! Wavefronts, coarse enough to be drawn and short enough to be sent.

use serde::Serialize;

/// Cells along an axis that a wavefront is coarsened to: nearly a pixel and a half each.
const CELLS: usize = 192;
/// Levels are written as letters, one a block of cells: so many of them, and one for none.
const LETTERS: &[u8; LEVELS] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
const NONE: char = '.';

/// How many distances to the goal are told apart.
pub const LEVELS: usize = 64;

/// Distances to the goal in columns of joint 1, each from the least value of joint 2 on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Waves {
    /// Number of blocks of cells along each axis.
    pub blocks: [usize; 2],
    /// How much of the axis they cover: blocks may stick out beyond the last cell.
    pub extent: [f64; 2],
    /// Of each block its least label, as a part of the greatest of all; none where the wave did not come.
    levels: String,
    /// The greatest label.
    pub farthest: u32,
}

impl Waves {
    /// The wavefront with these labels; none where there are no labels.
    pub fn new(cells: [usize; 2], labels: &[u32]) -> Option<Self> {
        if labels.is_empty() || labels.len() != cells[0] * cells[1] {
            return None;
        }
        let farthest = labels.iter().copied().filter(|&l| l != u32::MAX).max().unwrap_or(0);
        let block = cells.map(|n| n.div_ceil(CELLS).max(1));
        let blocks = [0, 1].map(|k| cells[k].div_ceil(block[k]));
        let mut least = vec![u32::MAX; blocks[0] * blocks[1]];
        for (index, &label) in labels.iter().enumerate() {
            let at = index / cells[1] / block[0] * blocks[1] + index % cells[1] / block[1];
            least[at] = least[at].min(label);
        }
        let letter = |label: u32| match label {
            u32::MAX => NONE,
            _ => {
                let part = f64::from(label) / f64::from(farthest.max(1));
                char::from(LETTERS[(part * (LEVELS - 1) as f64).round() as usize])
            }
        };
        Some(Self {
            blocks,
            extent: [0, 1].map(|k| super::numbers::number((blocks[k] * block[k]) as f64 / cells[k] as f64)),
            levels: least.into_iter().map(letter).collect(),
            farthest,
        })
    }

    /// The level of each block, below [`LEVELS`]; none where the wave did not come.
    pub fn levels(&self) -> impl Iterator<Item = Option<usize>> + '_ {
        self.levels.bytes().map(|letter| LETTERS.iter().position(|&l| l == letter))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fine_wavefront_is_coarsened_and_keeps_narrow_passages() {
        let cells = [401, 390];
        // Only one row of cells was reached.
        let labels: Vec<u32> = (0..cells[0] * cells[1])
            .map(|k| if k % cells[1] == 200 { (k / cells[1]) as u32 } else { u32::MAX })
            .collect();
        let waves = Waves::new(cells, &labels).unwrap();
        let levels: Vec<_> = waves.levels().collect();
        assert_eq!(waves.blocks, [134, 130]);
        assert_eq!(levels.iter().flatten().count(), 134);
        assert_eq!(levels[200 / 3], Some(0));
        assert_eq!(levels[133 * 130 + 200 / 3], Some(LEVELS - 1));
    }
}
