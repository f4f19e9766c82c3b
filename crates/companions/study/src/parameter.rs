//! Parameters of a study, and their values.

use cplan_model::space::SplitMix64;

/// A number that differs from layout to layout.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name of the parameter, and of its column in the table.
    pub name: String,
    /// The unit of its values, for tables and pictures.
    pub unit: Option<String>,
    /// The values that it takes.
    pub values: Values,
}

impl Parameter {
    /// Returns the name, with the unit if there is one.
    pub fn titled(&self) -> String {
        self.unit.as_ref().map_or_else(|| self.name.clone(), |unit| format!("{}, {unit}", self.name))
    }
}

/// The values of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Listed values, combined with all values of every other parameter.
    Listed(Vec<f64>),
    /// Values in equal steps, combined like listed ones.
    Stepped {
        /// The first and least value.
        from: f64,
        /// The last and greatest value.
        to: f64,
        /// Number of values.
        count: usize,
    },
    /// One random value per layout.
    Drawn {
        /// The least value.
        from: f64,
        /// The greatest value.
        to: f64,
        /// True for a Latin hypercube: of `n` draws, there is one in each of `n` equal intervals. False for independent draws.
        latin: bool,
    },
}

impl Values {
    /// Returns the least and the greatest value.
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Listed(values) => [
                values.iter().copied().fold(f64::INFINITY, f64::min),
                values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ],
            Self::Stepped { from, to, .. } | Self::Drawn { from, to, .. } => [*from, *to],
        }
    }

    /// Returns the values in order. `None` if they are drawn.
    pub fn listed(&self) -> Option<Vec<f64>> {
        match self {
            Self::Listed(values) => Some(values.clone()),
            Self::Stepped { from, to, count } => {
                let last = (count - 1).max(1);
                // The ends are not rounded.
                let value = |i: usize| if i == last { *to } else { from + (to - from) * i as f64 / last as f64 };
                Some((0..*count).map(value).collect())
            }
            Self::Drawn { .. } => None,
        }
    }

    /// Returns the least and greatest argument of [`Values::at`], between which the search moves.
    pub(super) fn room(&self) -> [f64; 2] {
        match self {
            Self::Listed(values) => [0.0, values.len() as f64],
            Self::Stepped { .. } | Self::Drawn { .. } => self.range(),
        }
    }

    /// Returns the value at a place of the search range. For listed values, the integer part of the place is the index.
    /// Otherwise the place is the value.
    pub(super) fn at(&self, place: f64) -> f64 {
        match self {
            Self::Listed(values) => values[(place.max(0.0) as usize).min(values.len() - 1)],
            Self::Stepped { from, to, .. } | Self::Drawn { from, to, .. } => place.clamp(*from, *to),
        }
    }

    /// Returns a place of the search range with this value.
    pub(super) fn place(&self, value: f64) -> f64 {
        match self {
            Self::Listed(values) => values.iter().position(|v| *v == value).map_or(0.0, |i| i as f64 + 0.5),
            Self::Stepped { .. } | Self::Drawn { .. } => value,
        }
    }
}

/// All layouts of a study: each combination of listed values, with each draw.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Design {
    /// The columns in the order of the parameters.
    columns: Vec<Column>,
    /// Number of layouts for each combination of listed values.
    draws: usize,
    count: usize,
}

#[derive(Debug, Clone, PartialEq)]
enum Column {
    /// Listed values. Each one holds for `stays` consecutive layouts.
    Listed { values: Vec<f64>, stays: usize },
    /// A value for each draw.
    Drawn(Vec<f64>),
}

impl Design {
    /// Creates the design. The draw changes with every layout. After all draws, the listed value of the last parameter
    /// changes, then that of the parameter before it, and so on. Returns `None` if the number of layouts overflows.
    pub fn new(parameters: &[Parameter], draws: usize, seed: u64) -> Option<Self> {
        let mut stays = draws;
        let mut columns = Vec::new();
        for (number, parameter) in parameters.iter().enumerate().rev() {
            columns.push(match &parameter.values {
                listed @ (Values::Listed(_) | Values::Stepped { .. }) => {
                    let values = listed.listed()?;
                    let next = stays.checked_mul(values.len())?;
                    Column::Listed { values, stays: std::mem::replace(&mut stays, next) }
                }
                Values::Drawn { from, to, latin } => {
                    // Each parameter has its own sequence of random numbers: adding a parameter changes no other draws.
                    let mut numbers = SplitMix64::nth(seed, number as u64);
                    let shares = if *latin {
                        stratified(draws, &mut numbers)
                    } else {
                        (0..draws).map(|_| numbers.unit()).collect()
                    };
                    Column::Drawn(
                        shares.into_iter().map(|share| (from + (to - from) * share).clamp(*from, *to)).collect(),
                    )
                }
            });
        }
        columns.reverse();
        Some(Self { columns, draws, count: stays })
    }

    /// Returns the number of layouts.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the values of a layout, one per parameter.
    pub fn values(&self, layout: usize) -> Vec<f64> {
        let value = |column: &Column| match column {
            Column::Listed { values, stays } => values[layout / stays % values.len()],
            Column::Drawn(values) => values[layout % self.draws],
        };
        self.columns.iter().map(value).collect()
    }
}

/// Returns one number in each of `count` equal parts of `[0, 1)`, in random order.
fn stratified(count: usize, numbers: &mut SplitMix64) -> Vec<f64> {
    let mut shares: Vec<f64> = (0..count).map(|part| (part as f64 + numbers.unit()) / count as f64).collect();
    // The shuffle of Fisher and Yates.
    for i in (1..count).rev() {
        shares.swap(i, ((numbers.unit() * (i + 1) as f64) as usize).min(i));
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameter(values: Values) -> Parameter {
        Parameter { name: "p".into(), unit: None, values }
    }

    #[test]
    fn listed_values_meet_each_other_once_for_each_draw() {
        let drawn = Values::Drawn { from: -1.0, to: 3.0, latin: true };
        let stepped = Values::Stepped { from: 5.0, to: 7.0, count: 3 };
        let parameters = [Values::Listed(vec![1.0, 2.0]), drawn, stepped].map(parameter);
        let design = Design::new(&parameters, 4, 9).unwrap();
        assert_eq!(design.count(), 24);
        let all: Vec<Vec<f64>> = (0..24).map(|i| design.values(i)).collect();
        for (a, c) in [(1.0, 5.0), (2.0, 5.0), (1.0, 7.0)] {
            let drawn: Vec<f64> = all.iter().filter(|v| (v[0], v[2]) == (a, c)).map(|v| v[1]).collect();
            let mut parts: Vec<usize> = drawn.iter().map(|x| (x + 1.0) as usize).collect();
            parts.sort_unstable();
            assert_eq!(parts, [0, 1, 2, 3], "{drawn:?}");
        }
        assert_eq!(all[4][2], 6.0);
        assert_eq!(all[12][0], 2.0);
    }

    #[test]
    fn draws_follow_from_the_seed_and_from_nothing_else() {
        let drawn = |latin| parameter(Values::Drawn { from: 0.0, to: 1.0, latin });
        let column = |parameters: &[Parameter], seed, k: usize| -> Vec<f64> {
            let design = Design::new(parameters, 100, seed).unwrap();
            (0..100).map(|i| design.values(i)[k]).collect()
        };
        let alone = column(&[drawn(false)], 3, 0);
        assert_eq!(alone, column(&[drawn(false), drawn(true)], 3, 0));
        assert_ne!(alone, column(&[drawn(false)], 4, 0));
        assert_ne!(alone, column(&[drawn(false), drawn(false)], 3, 1));
        let mean: f64 = alone.iter().sum::<f64>() / 100.0;
        assert!((mean - 0.5).abs() < 0.15, "{mean}");
    }

    #[test]
    fn too_many_layouts_are_refused() {
        let many = parameter(Values::Listed(vec![0.0; 1 << 20]));
        assert_eq!(Design::new(&[many.clone(), many.clone(), many.clone(), many], 1, 0), None);
    }
}
