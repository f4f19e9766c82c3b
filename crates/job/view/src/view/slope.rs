//! Fields whose values increase along paths, and the values of their equipotentials.

use super::isolines::Samples;
use cplan_model::space::Topology;
use cplan_planners::planner::{FieldQuantity, Trace};
use std::borrow::Cow;

/// Number of equipotentials that are drawn.
const EQUIPOTENTIALS: usize = 20;
/// Fraction of the cells that may have values below the lowest equipotential. In dead ends, values are far lower than elsewhere;
/// equipotentials down to them would leave few lines for the rest of the field.
const IGNORED_SHARE: f64 = 0.02;
/// Replaces [`IGNORED_SHARE`] for potentials that are unbounded near obstacles.
const IGNORED_SHARE_OF_UNBOUNDED: f64 = 0.15;

/// A field whose values increase along paths, in a coarse grid for drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Slope {
    /// Values at the points of a coarse grid.
    pub samples: Samples,
    /// Least and greatest value of the equipotentials.
    pub span: (f64, f64),
}

impl Slope {
    /// Returns the field that a field planner followed. `None` for other planners, and if the field has no values.
    pub fn new(trace: &Trace, topology: &Topology) -> Option<Self> {
        let Trace::Field { cells, quantity, values } = trace else { return None };
        let (values, tail): (Cow<[f64]>, f64) = match quantity {
            // Heights decrease towards the goal, so their negatives increase.
            FieldQuantity::Height => (values.iter().map(|height| -height).collect(), IGNORED_SHARE_OF_UNBOUNDED),
            FieldQuantity::Logarithm | FieldQuantity::EstimatedLogarithm => (Cow::Borrowed(values), IGNORED_SHARE),
        };
        if values.len() != cells[0] * cells[1] {
            return None;
        }
        Some(Self { span: span(&values, tail)?, samples: samples(*cells, &values, topology) })
    }

    /// Iterates over equipotentials at equal steps of the value. Each has its position between the value at the goal (0) and that
    /// at the far end (1).
    pub fn equipotentials(&self) -> impl Iterator<Item = (f64, Vec<Vec<[f64; 2]>>)> + '_ {
        let (low, high) = self.span;
        let part = |k: usize| (k as f64 + 0.5) / EQUIPOTENTIALS as f64;
        (0..EQUIPOTENTIALS).map(part).map(move |part| (part, self.samples.isolines(high + (low - high) * part)))
    }
}

/// Returns the least and greatest value of the equipotentials; `tail` is the fraction of the cells below them.
fn span(potential: &[f64], tail: f64) -> Option<(f64, f64)> {
    let mut known: Vec<f64> = potential.iter().copied().filter(|v| v.is_finite()).collect();
    known.sort_by(f64::total_cmp);
    let low = *known.get((known.len() as f64 * tail) as usize)?;
    Some((low, *known.last()?))
}

/// Returns the potential at the centres of all cells, or of some if the grid is fine. On a circle, each seam has another sample
/// beyond it, so that lines continue across it.
fn samples(cells: [usize; 2], potential: &[f64], topology: &Topology) -> Samples {
    const MAX_SAMPLES: usize = 256;
    let [x, y] = [0, 1].map(|k| {
        let axis = topology.ranges[k];
        let (n, extent) = (cells[k], axis.extent());
        let place = |i: usize| axis.domain().0 + (i as f64 + 0.5) / n as f64 * extent;
        let mut all: Vec<(usize, f64)> =
            (0..n).step_by(n.div_ceil(MAX_SAMPLES).max(1)).map(|i| (i, place(i))).collect();
        if let (true, Some(&first), Some(&last)) = (axis.is_circle(), all.first(), all.last()) {
            all.insert(0, (last.0, last.1 - extent));
            all.push((first.0, first.1 + extent));
        }
        all
    });
    Samples {
        values: x.iter().flat_map(|a| y.iter().map(move |b| potential[a.0 * cells[1] + b.0])).collect(),
        x: x.into_iter().map(|a| a.1).collect(),
        y: y.into_iter().map(|b| b.1).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_model::space::JointRange;

    #[test]
    fn lines_cross_the_seam_of_a_circle() {
        let topology = Topology::new([JointRange::Circle, JointRange::Interval { lower: 0.0, upper: 1.0 }]);
        let cells = [8, 4];
        let potential: Vec<f64> = (0..32).map(|k| f64::from(k % 4)).collect();
        let all = samples(cells, &potential, &topology);
        assert_eq!((all.x.len(), all.y.len()), (10, 4));
        let lines = all.isolines(1.5);
        assert_eq!(lines.len(), 1);
        let [from, to] = [lines[0][0][0], lines[0][lines[0].len() - 1][0]];
        assert!(from.min(to) < -std::f64::consts::PI && from.max(to) > std::f64::consts::PI);
    }

    #[test]
    fn a_field_without_values_has_no_lines() {
        let topology = Topology::new([JointRange::Circle; 2]);
        let trace = Trace::field([4, 4], FieldQuantity::Logarithm, vec![f64::NEG_INFINITY; 16]);
        assert_eq!(Slope::new(&trace, &topology), None);
        assert_eq!(span(&[f64::NEG_INFINITY, -3.0, 0.0], IGNORED_SHARE), Some((-3.0, 0.0)));
    }
}
