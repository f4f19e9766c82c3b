//! The wave over four neighbours that proceeds by tiles of cells. Each tile fits in a word.

use super::{FreeCells, UNREACHED};
use std::collections::VecDeque;

/// Number of rows and of columns of a tile. Cell `(i, j)` of a tile is bit `TILE_SIDE i + j`.
const TILE_SIDE: usize = 8;

/// The bits of a tile's first row.
const FIRST_ROW: u64 = 0xff;

/// The bits of a tile's first column.
const FIRST_COLUMN: u64 = 0x0101_0101_0101_0101;

/// Labels every cell that a wave from `sources` (free cells) reaches over shared sides with the number of moves to
/// it, and all others with [`UNREACHED`].
///
/// Each cell that is not reached yet is one bit, so a step within a tile takes a few shifts of words. Labels take much
/// more memory, but each is written once and never read.
pub(super) fn tile_wave(free: &FreeCells, sources: &[usize]) -> Vec<u32> {
    let [rows, columns] = free.cells();
    let mut labels = vec![UNREACHED; rows * columns];
    let mut wave = TileWave::new(free);
    for &source in sources {
        let (i, j) = (source / columns, source % columns);
        wave.enter(0, i / TILE_SIDE * wave.across + j / TILE_SIDE, 1 << (i % TILE_SIDE * TILE_SIDE + j % TILE_SIDE));
    }
    while let Some([tile, level]) = wave.queue.pop_front() {
        let at = &mut wave.tiles[tile as usize];
        let front = std::mem::take(&mut at.front[level as usize % 2]);
        let mut left = front;
        while left != 0 {
            let bit = left.trailing_zeros() as usize;
            labels[at.corner as usize + bit / TILE_SIDE * columns + bit % TILE_SIDE] = level;
            left &= left - 1;
        }
        wave.advance(tile as usize, front, level + 1);
    }
    labels
}

#[derive(Debug, Clone, Copy, Default)]
struct Tile {
    /// Free cells that the wave has not reached.
    waiting: u64,
    /// Cells that the wave has reached but not left. One list has the cells of even levels, the other one those of odd levels.
    front: [u64; 2],
    /// Index of the tile's first cell in the grid.
    corner: u32,
    /// Number of the tile in its row of tiles.
    column: u32,
}

struct TileWave {
    tiles: Vec<Tile>,
    /// Number of tiles per row.
    across: usize,
    /// Tiles with cells in the front, and the level of these cells. Levels are in order, and there are at most two
    /// different ones.
    queue: VecDeque<[u32; 2]>,
    /// True for each axis whose last row or column is next to the first.
    circles: [bool; 2],
    /// Position of the grid's last row and column within its tile.
    last: [usize; 2],
}

impl TileWave {
    fn new(free: &FreeCells) -> Self {
        let [rows, columns] = free.cells();
        let across = columns.div_ceil(TILE_SIDE);
        let mut tiles = vec![Tile::default(); rows.div_ceil(TILE_SIDE) * across];
        for (k, tile) in tiles.iter_mut().enumerate() {
            let (i, j) = (k / across, k % across);
            (tile.corner, tile.column) = ((i * TILE_SIDE * columns + j * TILE_SIDE) as u32, j as u32);
        }
        for (i, words) in free.bits().chunks_exact(free.words().max(1)).enumerate() {
            let line = &mut tiles[i / TILE_SIDE * across..(i / TILE_SIDE + 1) * across];
            for (tile, byte) in line.iter_mut().zip(words.iter().flat_map(|word| word.to_le_bytes())) {
                tile.waiting |= u64::from(byte) << (i % TILE_SIDE * TILE_SIDE);
            }
        }
        let last = free.cells().map(|n| n.wrapping_sub(1) % TILE_SIDE);
        Self { tiles, across, queue: VecDeque::new(), circles: free.circles(), last }
    }

    /// Adds those of `cells` that are not reached yet to the tile's front.
    #[inline(always)]
    fn enter(&mut self, level: u32, tile: usize, cells: u64) {
        let at = &mut self.tiles[tile];
        let new = cells & at.waiting;
        if new != 0 {
            at.waiting ^= new;
            let front = &mut at.front[level as usize % 2];
            if *front == 0 {
                self.queue.push_back([tile as u32, level]);
            }
            *front |= new;
        }
    }

    /// Adds the neighbours of a tile's front to the fronts of the next level.
    #[inline(always)]
    fn advance(&mut self, tile: usize, front: u64, level: u32) {
        let (size, across) = (self.tiles.len(), self.across);
        let column = self.tiles[tile].column as usize;
        let (first_column, last_column) = (front & FIRST_COLUMN, front >> (TILE_SIDE - 1) & FIRST_COLUMN);
        let sideways = (front & !(FIRST_COLUMN << (TILE_SIDE - 1))) << 1 | (front & !FIRST_COLUMN) >> 1;
        self.enter(level, tile, front << TILE_SIDE | front >> TILE_SIDE | sideways);
        if tile >= across {
            if front & FIRST_ROW != 0 {
                self.enter(level, tile - across, front << (TILE_SIDE * (TILE_SIDE - 1)));
            }
        } else if self.circles[0] {
            self.enter(level, tile + size - across, (front & FIRST_ROW) << (TILE_SIDE * self.last[0]));
        }
        if tile + across < size {
            if front >> (TILE_SIDE * (TILE_SIDE - 1)) != 0 {
                self.enter(level, tile + across, front >> (TILE_SIDE * (TILE_SIDE - 1)));
            }
        } else if self.circles[0] {
            self.enter(level, column, front >> (TILE_SIDE * self.last[0]) & FIRST_ROW);
        }
        if column > 0 {
            if first_column != 0 {
                self.enter(level, tile - 1, first_column << (TILE_SIDE - 1));
            }
        } else if self.circles[1] {
            self.enter(level, tile + across - 1, first_column << self.last[1]);
        }
        if column + 1 < across {
            if last_column != 0 {
                self.enter(level, tile + 1, last_column);
            }
        } else if self.circles[1] {
            self.enter(level, tile - column, front >> self.last[1] & FIRST_COLUMN);
        }
    }
}
