//! Steps to the nearest source, for every free cell.

use super::queue_wave::queue_wave_of_eight;
use super::run_wave::run_wave;
use super::tile_wave::tile_wave;
use super::{FreeCells, Neighborhood, UNREACHED};

/// Mean length of runs of free cells above which the wave works run by run. In narrower mazes and in noise, tile by
/// tile is faster.
const MIN_MEAN_RUN: usize = 40;

/// The least number of moves from each cell to a source: the navigation function whose level sets a wave passes through
/// (Latombe 1991).
#[derive(Debug, Clone, PartialEq)]
pub struct StepLabels {
    neighborhood: Neighborhood,
    labels: Vec<u32>,
}

impl StepLabels {
    /// Labels all cells that are connected with a free cell among `sources` (which get 0). Every move counts as one
    /// step: over four neighbours the distance in the `L1` metric, over eight that in the maximum metric.
    ///
    /// Linear in the number of cells. Over four neighbours some 2 to 6 ns per cell where free cells form long runs,
    /// most of it for allocating the memory; otherwise about the time of a plain queue.
    #[must_use]
    pub fn new(free: &FreeCells, sources: &[usize], neighborhood: Neighborhood) -> Self {
        let sources: Vec<usize> = sources.iter().copied().filter(|&source| free.is_free(source)).collect();
        let labels = match neighborhood {
            Neighborhood::Eight => queue_wave_of_eight(free, &sources),
            Neighborhood::Four if free.count() < MIN_MEAN_RUN * free.runs() => tile_wave(free, &sources),
            Neighborhood::Four => run_wave(free, &sources).unwrap_or_else(|| tile_wave(free, &sources)),
        };
        Self { neighborhood, labels }
    }

    /// Returns the label of each cell of the grid; [`UNREACHED`] for cells that are not free or not connected.
    #[must_use]
    pub fn labels(&self) -> &[u32] {
        &self.labels
    }

    /// Returns the labels as a vector.
    #[must_use]
    pub fn into_labels(self) -> Vec<u32> {
        self.labels
    }

    /// Returns the number of labelled cells. Linear.
    #[must_use]
    pub fn reached(&self) -> usize {
        self.labels.iter().filter(|&&label| label != UNREACHED).count()
    }

    /// Returns the number of distinct labels. Linear.
    #[must_use]
    pub fn levels(&self) -> usize {
        let labels = self.labels.iter().filter(|&&label| label != UNREACHED);
        labels.max().map_or(0, |&label| label as usize + 1)
    }

    /// Returns the cells from `index` to a source, always to the smallest neighbour (the first of equals, so straight
    /// before diagonal): a path of fewest moves. Returns `None` if the wave did not reach `index`.
    #[must_use]
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
