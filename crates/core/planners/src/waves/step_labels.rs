//! The number of moves to the nearest source, for every free cell.

use super::queue_wave::queue_wave_of_eight;
use super::run_wave::run_wave;
use super::tile_wave::tile_wave;
use super::{FreeCells, Neighborhood, UNREACHED};

/// Mean length of runs of free cells above which the wave proceeds by runs. In narrower mazes and in noise, tiles are faster.
const MIN_MEAN_RUN: usize = 40;

/// The least number of moves from each cell to a source. Its level sets are the fronts of a wave; Latombe (1991)
/// calls it a navigation function.
#[derive(Debug, Clone, PartialEq)]
pub struct StepLabels {
    neighborhood: Neighborhood,
    labels: Vec<u32>,
}

impl StepLabels {
    /// Labels all cells that are connected with a free cell among `sources`; the sources have label 0. Every move
    /// counts as one step. With four neighbours labels are distances in the `L1` metric, with eight in the maximum
    /// metric.
    ///
    /// Linear in the number of cells. With four neighbours and long runs of free cells, it takes about 2 to 6 ns per
    /// cell, mostly to allocate the memory. Otherwise it takes about as long as a plain queue.
    pub fn new(free: &FreeCells, sources: &[usize], neighborhood: Neighborhood) -> Self {
        let sources: Vec<usize> = sources.iter().copied().filter(|&source| free.is_free(source)).collect();
        let labels = match neighborhood {
            Neighborhood::Eight => queue_wave_of_eight(free, &sources),
            Neighborhood::Four if free.count() < MIN_MEAN_RUN * free.runs() => tile_wave(free, &sources),
            Neighborhood::Four => run_wave(free, &sources).unwrap_or_else(|| tile_wave(free, &sources)),
        };
        Self { neighborhood, labels }
    }

    /// Returns the label of each cell of the grid, or [`UNREACHED`] for cells that are blocked or not connected.
    pub fn labels(&self) -> &[u32] {
        &self.labels
    }

    /// Converts the labels to a vector.
    pub fn into_labels(self) -> Vec<u32> {
        self.labels
    }

    /// Returns the number of labelled cells. Linear in the number of cells.
    pub fn reached(&self) -> usize {
        self.labels.iter().filter(|&&label| label != UNREACHED).count()
    }

    /// Returns the number of levels: the greatest label plus one, or 0 without labels. Linear in the number of
    /// cells.
    pub fn levels(&self) -> usize {
        let labels = self.labels.iter().filter(|&&label| label != UNREACHED);
        labels.max().map_or(0, |&label| label as usize + 1)
    }

    /// Returns the cells of a path with the fewest moves from `index` to a source. It always continues to the neighbour
    /// with the least label, and of equal ones to the first, so straight moves precede diagonal ones. `None` if the
    /// wave did not reach `index`.
    pub fn descend(&self, free: &FreeCells, index: usize) -> Option<Vec<usize>> {
        let mut label = self.labels[index];
        if label == UNREACHED {
            return None;
        }
        let mut cells = vec![index];
        let mut at = index;
        while label > 0 {
            at = free.moves(at, self.neighborhood).map(|next| next.to).min_by_key(|&next| self.labels[next])?;
            label = self.labels[at];
            cells.push(at);
        }
        Some(cells)
    }
}
