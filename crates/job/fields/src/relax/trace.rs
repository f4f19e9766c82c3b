//! Measures the convergence of a relaxation, sweep by sweep.

use super::{Domain, Equation, RelaxError, Relaxation, Stopping, SweepSnapshot, relax_watched};

/// Reason why a relaxation ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Ending {
    /// The stopping rule's measure fell below its bound, in all stages.
    Converged,
    /// The largest number of sweeps was reached without convergence or divergence.
    Unconverged,
    /// Values grew without bound, or became NaN.
    Diverged,
}

/// Measurements after a sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Number of the stage, from 0. With preferences, stage 0 relaxes the harmonic field.
    pub stage: usize,
    /// Number of sweeps so far in all stages, from 1.
    pub sweep: usize,
    /// Sum of `change^2` over all cells.
    pub squares: f64,
    /// Greatest `|change| / |value after|` of a cell whose value changed; infinite if a value became 0.
    pub relative: f64,
    /// Greatest `|value - exact value|` of a cell, divided by the greatest such error before the first sweep. `None` if
    /// the solution is unknown, or if the initial values were the solution.
    pub error: Option<f64>,
}

/// Measurements of a whole relaxation.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Samples after each of the first hundred sweeps, and then less often: the number of sweeps grows by one percent from one
    /// sample to the next. The first and the last sweep of each stage also have samples. Sweeps whose squares or error are not
    /// finite are omitted.
    pub samples: Vec<Sample>,
    /// Number of sweeps of all stages together.
    pub sweeps: usize,
    /// Reason why the relaxation ended.
    pub ending: Ending,
}

/// The jump of the changes when, at the beginning of the second stage, preferences are added to the harmonic field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leap {
    /// Number of sweeps of the first stage.
    pub sweep: usize,
    /// Sum of squared changes in the last sweep of the first stage.
    pub before: f64,
    /// Sum of squared changes in the first sweep of the second stage.
    pub after: f64,
    /// Number of sweeps of the second stage.
    pub more: usize,
}

/// Number of sweeps between two samples, as a share of the number of sweeps so far.
const SAMPLE_SPACING: f64 = 0.01;

/// [`Trace::rate`] is measured over this last fraction of the sweeps.
const RATE_WINDOW: f64 = 0.5;

/// Smaller errors are only rounding errors, from which no rate can be measured.
const ERROR_FLOOR: f64 = 1e-13;

/// Relaxes from `start` and measures after each sweep. `exact` is the solution ([`eliminated`](super::eliminated)), with which
/// errors are measured. An equation with preferences has two stages and no known error. Measuring takes about as long as the
/// relaxation.
///
/// ```
/// use cplan_fields::*;
///
/// // A square without obstacles: Jacobi's error falls by cos(pi / 9) a sweep.
/// let square = Domain::new([8, 8], vec![Cell::Free; 64], [Boundary::High; 2], Levels::PROBABILITY);
/// let stopping = Stopping { measure: Measure::SumOfSquares, below: 1e-20, max_sweeps: 1_000 };
/// let exact = eliminated(&square, &Equation::Harmonic);
/// let trace = trace(&square, &Equation::Harmonic, &Relaxation::JACOBI, &stopping, vec![1.0; 64], exact.as_deref())?;
/// assert_eq!(trace.ending, Ending::Converged);
/// assert!((trace.rate().unwrap() - (std::f64::consts::PI / 9.0).cos()).abs() < 1e-3);
/// # Ok::<(), RelaxError>(())
/// ```
///
/// # Errors
/// Only [`RelaxError::Refused`]. Divergence is no error, because it may be the subject of the measurement.
pub fn trace(
    domain: &Domain,
    equation: &Equation,
    relaxation: &Relaxation,
    stopping: &Stopping,
    start: Vec<f64>,
    exact: Option<&[f64]>,
) -> Result<Trace, RelaxError> {
    let exact = exact.filter(|exact| exact.len() == domain.kinds().len());
    let mut observer = Observer { exact, ..Observer::default() };
    let relaxed = relax_watched(domain, equation, relaxation, stopping, start, &mut |seen| observer.observe(&seen));
    let (sweeps, ending) = match relaxed {
        Ok(field) if field.converged() => (field.sweeps(), Ending::Converged),
        Ok(field) => (field.sweeps(), Ending::Unconverged),
        Err(RelaxError::Diverged { .. }) => (observer.sweeps, Ending::Diverged),
        Err(refused) => return Err(refused),
    };
    observer.keep_last_sample();
    Ok(Trace { samples: observer.samples, sweeps, ending })
}

impl Trace {
    /// Returns the factor by which a sweep asymptotically multiplies the error: the geometric mean over the second half of the
    /// sweeps, as far as errors exceed rounding. `None` if the error is unknown, or if there are too few sweeps.
    pub fn rate(&self) -> Option<f64> {
        let errors: Vec<(usize, f64)> = self
            .samples
            .iter()
            .filter_map(|sample| Some((sample.sweep, sample.error.filter(|&error| error > ERROR_FLOOR)?)))
            .collect();
        let &(end, last) = errors.last()?;
        let from = (RATE_WINDOW * end as f64) as usize;
        let &(begin, first) = errors.iter().find(|(sweep, _)| *sweep >= from)?;
        // A few sweeps are not enough for a rate.
        (end > begin + 1).then(|| (last / first).powf(1.0 / (end - begin) as f64))
    }

    /// Returns the jump of the changes at the beginning of the second stage. `None` if there is no second stage.
    pub fn leap(&self) -> Option<Leap> {
        let [last, first] = self.samples.windows(2).find_map(|pair| match pair {
            [a, b] if a.stage < b.stage => Some([a, b]),
            _ => None,
        })?;
        let (before, after) = (last.squares, first.squares);
        Some(Leap { sweep: last.sweep, before, after, more: self.sweeps - last.sweep })
    }

    /// Returns the last measured error.
    pub fn error(&self) -> Option<f64> {
        self.samples.last()?.error
    }
}

/// Measures from the values before and after each sweep, independently of the stopping rules.
#[derive(Default)]
struct Observer<'a> {
    exact: Option<&'a [f64]>,
    before: Vec<f64>,
    /// The greatest error before the first sweep.
    first: f64,
    /// Number of sweeps in the stages that have ended.
    earlier: usize,
    sweeps: usize,
    /// Number of the sweep that is sampled next.
    next: usize,
    samples: Vec<Sample>,
    /// The last sweep, if it was not sampled.
    last: Option<Sample>,
}

impl Observer<'_> {
    fn observe(&mut self, seen: &SweepSnapshot) {
        if seen.sweep == 0 {
            // A new stage begins, so the last sweep of the previous one is kept.
            self.keep_last_sample();
            (self.earlier, self.before) = (self.sweeps, seen.values.to_vec());
            if seen.stage == 0 {
                self.first = self.exact.map_or(0.0, |exact| greatest_error(exact, seen.values));
            }
            self.next = self.sweeps + 1;
            return;
        }
        self.sweeps = self.earlier + seen.sweep;
        let sample = self.measure_sweep(seen);
        self.before.copy_from_slice(seen.values);
        if self.sweeps < self.next {
            self.last = sample;
            return;
        }
        self.samples.extend(sample);
        self.last = None;
        self.next = self.sweeps + 1 + (SAMPLE_SPACING * self.sweeps as f64) as usize;
    }

    fn keep_last_sample(&mut self) {
        self.samples.extend(self.last.take());
    }

    /// Measures a sweep. `None` if a number is not finite.
    fn measure_sweep(&self, seen: &SweepSnapshot) -> Option<Sample> {
        let (mut squares, mut relative) = (0.0, 0.0_f64);
        for (old, new) in self.before.iter().zip(seen.values) {
            let change = (new - old).abs();
            if change != 0.0 {
                squares += change * change;
                relative = relative.max(change / new.abs());
            }
        }
        let error = self.exact.filter(|_| self.first > 0.0);
        let error = error.map(|exact| greatest_error(exact, seen.values) / self.first);
        let finite = f64::is_finite(squares) && error.is_none_or(f64::is_finite);
        finite.then_some(Sample { stage: seen.stage, sweep: self.sweeps, squares, relative, error })
    }
}

/// Returns the greatest error, or infinity if a value is NaN.
fn greatest_error(exact: &[f64], values: &[f64]) -> f64 {
    let error = |(exact, value): (&f64, &f64)| (value - exact).abs();
    let errors = exact.iter().zip(values).map(error);
    errors.fold(0.0, |greatest: f64, error| if error.is_nan() { f64::INFINITY } else { greatest.max(error) })
}
