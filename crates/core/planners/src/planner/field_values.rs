//! The values of a field on a grid, for pictures.

use std::ops::Deref;
use std::sync::{Arc, LazyLock};

/// The meaning of a field's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldQuantity {
    /// Natural logarithm of a potential that paths ascend. It is 0 at the goal, and decreases with the distance.
    Logarithm,
    /// Estimate of the logarithm of a potential. Only for pictures.
    EstimatedLogarithm,
    /// A potential that paths descend.
    Height,
}

type Computation = Box<dyn FnOnce() -> Vec<f64> + Send>;

/// One value per cell of a grid. The values are computed when they are first read, because paths do not need them.
#[derive(Debug, Clone)]
pub struct FieldValues(Arc<LazyLock<Vec<f64>, Computation>>);

impl FieldValues {
    /// Stores the computation of the values.
    pub fn computed_by(values: impl FnOnce() -> Vec<f64> + Send + 'static) -> Self {
        Self(Arc::new(LazyLock::new(Box::new(values))))
    }
}

impl From<Vec<f64>> for FieldValues {
    fn from(values: Vec<f64>) -> Self {
        Self::computed_by(|| values)
    }
}

impl Deref for FieldValues {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.0
    }
}

impl PartialEq for FieldValues {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}
