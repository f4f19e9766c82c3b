//! Interpretations of a source to try, and the number of published counts that each explains.

use super::deicu::{self, SCALES, TABLES, Table};
use super::line_maps::Scene;
use super::plain::{Beyond, Choice, Plain, Rule};
use std::error::Error;
use std::fmt;

/// Published counts of sweeps, each paired with the count by an interpretation of the source. The latter is `None` if the
/// relaxation does not converge.
#[derive(Debug, Clone, Default)]
pub struct Tally(pub Vec<(usize, Option<usize>)>);

impl Tally {
    fn count(&self, near: impl Fn(f64, f64) -> bool) -> usize {
        self.0.iter().filter(|(printed, found)| found.is_some_and(|f| near(*printed as f64, f as f64))).count()
    }

    /// Returns the number of counts that equal the published ones.
    pub fn exact(&self) -> usize {
        self.count(|printed, found| found == printed)
    }

    /// Returns the number of counts that differ from the published ones by at most 2 sweeps.
    pub fn within_2(&self) -> usize {
        self.count(|printed, found| (found - printed).abs() <= 2.0)
    }

    /// Returns the number of counts that differ from the published ones by at most five per cent.
    pub fn within_5_per_cent(&self) -> usize {
        self.count(|printed, found| (found / printed - 1.0).abs() <= 0.05)
    }

    /// Returns a rank for comparing tallies: first by exact matches, then by close ones.
    fn rank(&self) -> [usize; 3] {
        [self.exact(), self.within_2(), self.within_5_per_cent()]
    }

    fn add(&mut self, other: Self) {
        self.0.extend(other.0);
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [exact, near, close] = self.rank();
        write!(f, "of {:>2} cases: {exact:>2} exact, {near:>2} within 2, {close:>2} within 5 %", self.0.len())
    }
}

/// The published tables with their maps.
pub struct Maps(Vec<(&'static Table, Scene)>);

impl Maps {
    /// Reads the tables.
    ///
    /// # Errors
    /// Defects of the files.
    pub fn read() -> Result<Self, Box<dyn Error>> {
        TABLES.iter().map(|table| Ok((table, deicu::scene(table)?))).collect::<Result<_, _>>().map(Self)
    }

    /// Counts the sweeps of the harmonic stage, at one scale, for each table and for these relaxations.
    pub fn harmonic(&self, relaxations: [usize; 2], choice: &Choice, scale: usize) -> Vec<Tally> {
        let of_table = |(table, scene): &(&Table, Scene)| {
            let domain = scene.domain(SCALES[scale]);
            let count = |of| (table.published(of, 0, scale), Plain::new(&domain).relax(of, choice, |_, _| 0.0));
            Tally(relaxations.map(count).into())
        };
        self.0.iter().map(of_table).collect()
    }

    /// Counts the sweeps of all stages, at one scale, for each table and for these relaxations. The order is that of
    /// the source.
    pub fn all(&self, relaxations: [usize; 2], choice: &Choice, scale: usize) -> Vec<Tally> {
        let n = SCALES[scale];
        let of_table = |(table, scene): &(&Table, Scene)| {
            let (domain, epsilon) = (scene.domain(n), scene.epsilon(n));
            let mut tally = Tally::default();
            for of in relaxations {
                let mut field = Plain::new(&domain);
                let first = field.relax(of, choice, |_, _| 0.0);
                let v = field.directions();
                let climb = |cell: usize, [w, e, s, n]: [f64; 4]| {
                    epsilon[cell] / 8.0 * ((e - w) * v[cell][0] + (n - s) * v[cell][1])
                };
                let altered = |cell: usize, [w, e, s, n]: [f64; 4]| {
                    -epsilon[cell] / 4.0 * (0.5 * (e - w).abs() + 0.5 * (n - s).abs())
                };
                let second = field.clone().relax(of, choice, climb);
                let third = field.relax(of, choice, altered);
                let both = |stage: Option<usize>| Some(first? + stage?);
                let counts = [first, both(second), both(third)];
                tally.0.extend((0..3).map(|stage| (table.published(of, stage, scale), counts[stage])));
            }
            tally
        };
        self.0.iter().map(of_table).collect()
    }
}

/// Returns the interpretations of the source to try for Gauss-Seidel relaxation. Its values never leave 0..1, so only the
/// stopping rule and the precision are unknown.
pub fn gauss_seidel() -> Vec<Choice> {
    let mut choices = Vec::new();
    for single in [true, false] {
        for tolerance in [1e-2, 1e-3, 1e-4] {
            for rule in [Rule::SumOfChanges, Rule::ChangeOfSum, Rule::DifferenceOfSums] {
                choices.push(Choice { single, beyond: Beyond::Kept, rule, tolerance });
            }
        }
        choices.extend([1e-6, 1e-8].map(|tolerance| Choice {
            single,
            beyond: Beyond::Kept,
            rule: Rule::SumOfSquares,
            tolerance,
        }));
        choices.extend([1e-5, 1e-6].map(|tolerance| Choice {
            single,
            beyond: Beyond::Kept,
            rule: Rule::GreatestChange,
            tolerance,
        }));
    }
    choices
}

/// Returns the interpretations of the source to try for over-relaxation, with the stopping rule found for Gauss-Seidel
/// relaxation, or one of the two nearest to it.
pub fn over_relaxation() -> Vec<Choice> {
    let mut choices = Vec::new();
    for single in [true, false] {
        for rule in [Rule::SumOfChanges, Rule::ChangeOfSum, Rule::DifferenceOfSums] {
            let resets = [0.999, 0.999_99, 0.999_998, 0.999_999, 0.999_999_9].map(Beyond::Reset);
            for beyond in [Beyond::Kept, Beyond::Clamped].into_iter().chain(resets) {
                choices.push(Choice { single, beyond, rule, tolerance: 0.01 });
            }
        }
    }
    choices
}

/// The interpretation that explains most counts of Gauss-Seidel relaxation.
pub const OF_GAUSS_SEIDEL: Choice =
    Choice { single: true, beyond: Beyond::Kept, rule: Rule::SumOfChanges, tolerance: 0.01 };

/// The interpretation that explains most counts of over-relaxation.
pub const OF_SOR: Choice = Choice { beyond: Beyond::Reset(0.999_999), ..OF_GAUSS_SEIDEL };

/// Joins the tallies of all tables.
pub fn together(tallies: Vec<Tally>) -> Tally {
    tallies.into_iter().fold(Tally::default(), |mut all, tally| {
        all.add(tally);
        all
    })
}

/// Returns the interpretation that explains most counts, the first of equals.
pub fn best(tried: &[(Choice, Tally)]) -> Option<&Choice> {
    let mut best: Option<&(Choice, Tally)> = None;
    for candidate in tried {
        if best.is_none_or(|best| candidate.1.rank() > best.1.rank()) {
            best = Some(candidate);
        }
    }
    best.map(|best| &best.0)
}
