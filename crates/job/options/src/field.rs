//! Options for fields.

use super::names::{DEVICES, DIFFERENCES, INITIALS, LIMITS, MEASURES, ORDERS, STENCILS, word};
use super::number::{finite, positive};
use super::readers::{listed, require};
use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use cplan_fields::{
    Attraction, Device, Difference, Direction, Escape, Factor, Initial, Khatib, Limits, Lines, Measure, Order,
    RELATIVE_TOLERANCE, Relaxation, Repulsion, Stencil,
};
use cplan_fields::{EquationChoice, FieldChoice, FieldPlanner};
use cplan_planners::planner::PathKind;
use cplan_solver::{Method, Setting};

/// Equations of fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FieldName {
    /// Laplace's equation.
    Harmonic,
    /// The same drift everywhere; needs --epsilon and --direction.
    Oriented,
    /// In each [[preference]] region of the world, the region's drift.
    Local,
    /// In each [[preference]] region of the world, a drift along the slope of the harmonic field.
    Bvp,
    /// In each [[preference]] region of the world, a drift along the slope of the field itself.
    Bvp2,
    /// Attraction by the goal, repulsion by the nearest obstacle or by all. The result reports local minima.
    Khatib,
}

/// Methods of relaxation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum RelaxationName {
    /// All cells at once.
    Jacobi,
    /// All cells at once, with a --factor below 1.
    WeightedJacobi,
    /// One cell after the other.
    GaussSeidel,
    /// One cell after the other, with a --factor above 1; by default a formula gives the factor.
    Sor,
}

/// Fields that relaxation computes.
const RELAXED: [FieldName; 5] =
    [FieldName::Harmonic, FieldName::Oriented, FieldName::Local, FieldName::Bvp, FieldName::Bvp2];

/// An option, and the fields to which it applies.
type Stated = (&'static str, &'static [FieldName]);

/// Options for the field of the harmonic planner.
#[derive(Debug, Clone, Default, PartialEq, Args)]
#[command(next_help_heading = "Fields (planner harmonic)")]
pub struct FieldArgs {
    /// Equation of the field, such as --field oriented --epsilon 0.5 --direction 0,-1.
    #[arg(long, value_enum, value_name = "NAME")]
    pub field: Option<FieldName>,
    /// Strength of the drift per grid cell: everywhere (oriented), or outside the world's [[preference]] regions (bvp and
    /// bvp2, default 0).
    #[arg(long, value_name = "E", value_parser = finite, allow_hyphen_values = true)]
    pub epsilon: Option<f64>,
    /// Direction of the drift in joint space, such as 0,-1: everywhere (oriented), or in regions without a direction
    /// (local).
    #[arg(long, value_name = "v1,v2", value_parser = direction, allow_hyphen_values = true)]
    pub direction: Option<Direction>,
    /// Finite differences for the slopes (oriented, local, bvp) [default: central].
    #[arg(long, value_parser = word(DIFFERENCES), value_name = "NAME")]
    pub difference: Option<Difference>,
    /// Relaxation of the equation, such as --relaxation sor --order corners [default: gauss-seidel, except for the plain
    /// harmonic field, which has a faster solver].
    #[arg(long, value_enum, value_name = "NAME")]
    pub relaxation: Option<RelaxationName>,
    /// Order of the cells in a sweep (gauss-seidel, sor) [default: corners; on a GPU red-black].
    #[arg(long, value_parser = word(ORDERS), value_name = "NAME")]
    pub order: Option<Order>,
    /// Relaxation factor (weighted-jacobi, sor) [default of sor: the best factor for Laplace's equation in an empty
    /// rectangle].
    #[arg(long, value_name = "W", value_parser = positive, allow_hyphen_values = true)]
    pub factor: Option<f64>,
    /// Multiply also preferences by the factor of sor (bvp, bvp2). The solution is then that of gauss-seidel, but bvp2
    /// may not converge. Without this option, sor adds preferences without its factor, as published; their epsilon then
    /// acts like epsilon / factor.
    #[arg(long)]
    pub relax_preferences: bool,
    /// Value of free cells before the first sweep [default: high].
    #[arg(long, value_parser = word(INITIALS), value_name = "NAME")]
    pub initial: Option<Initial>,
    /// Weights of a cell's neighbours: as for square cells, or by the cells' real shape [default: square].
    #[arg(long, value_parser = word(STENCILS), value_name = "NAME")]
    pub stencil: Option<Stencil>,
    /// Effect of the joint limits on the field [default: high].
    #[arg(long, value_parser = word(LIMITS), value_name = "NAME")]
    pub limits: Option<Limits>,
    /// Measure of a sweep's changes; sweeps end when it falls below the tolerance. Values far from the goal are small,
    /// and only the relative measure notices them. If a path gets stuck there with another measure, sweeps continue
    /// with the relative one, and the result reports this [default: relative; for sor on a CPU absolute].
    #[arg(long, value_parser = word(MEASURES), value_name = "NAME")]
    pub measure: Option<Measure>,
    /// Relax until the measure is below this [default: 1e-6; of absolute and sums 0.01, of squares 0.0001].
    #[arg(long, value_name = "SIZE", value_parser = positive, allow_hyphen_values = true)]
    pub tolerance: Option<f64>,
    /// Maximum number of sweeps in each stage [default: 30000].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub max_sweeps: Option<u32>,
    /// Device for the relaxation [default: cpu].
    #[arg(long, value_parser = word(DEVICES), value_name = "DEVICE")]
    pub on: Option<Device>,
    /// Attraction by the goal (khatib): constant:C, or linear:K for K times the distance [default: linear:1].
    #[arg(long, value_name = "LAW", value_parser = attraction)]
    pub attraction: Option<Attraction>,
    /// Repulsion at a distance p (khatib). By the nearest obstacle: ranged:K,P0 for the potential K/2 (1/p - 1/P0)^2
    /// within P0, or inverse-square:Q for the force Q/p^2. By all obstacle cells together: sum:Q for the force Q/p^2 of
    /// each, p in cells [default: ranged:0.01,0.5].
    #[arg(long, value_name = "LAW", value_parser = repulsion)]
    pub repulsion: Option<Repulsion>,
    /// Apply tanh to each component of attraction and repulsion (khatib).
    #[arg(long)]
    pub saturated: bool,
    /// Escape from local minima (khatib). wave fills the minimum's basin until the wave overflows into a lower cell.
    /// walk:SEED alternates random walks and descents until one reaches a lower cell; walk means walk:1. The result
    /// reports escapes [default: a local minimum ends the search].
    #[arg(long, value_name = "HOW", value_parser = escape)]
    pub escape: Option<Escape>,
}

/// Default of the largest number of sweeps in each stage. No published result needed more.
const MAX_SWEEPS: u32 = 30_000;
/// Tolerance for sums of changes over all cells, with which published numbers of sweeps were counted (Deicu 2012, Tables 17 to
/// 19).
const SUM_TOLERANCE: f64 = 0.01;

impl FieldArgs {
    /// Returns the planner that follows the field; `None` for the default field.
    ///
    /// # Errors
    /// The reason, if options contradict each other or the planner.
    pub fn planner(&self, method: Method) -> Result<Option<FieldPlanner>, String> {
        let given = self.stated_options();
        let Some((first, _)) = given.first() else { return Ok(None) };
        require(first, &[Setting::Field], method, "does not follow a field")?;
        let name = self.field.unwrap_or(FieldName::Harmonic);
        if let Some((option, fields)) = given.iter().find(|(_, fields)| !fields.contains(&name)) {
            return Err(format!("{option} needs --field {}", names(fields)));
        }
        let is_plain = |(option, _): &Stated| *option == "--field" || (*option == "--on" && self.device().is_cpu());
        if given.iter().all(is_plain) && name == FieldName::Harmonic {
            return Ok(None);
        }
        let field = match name {
            FieldName::Khatib => FieldChoice::Khatib(Khatib {
                attraction: self.attraction.unwrap_or(Attraction::Linear(1.0)),
                repulsion: self.repulsion.unwrap_or(Repulsion::Ranged { gain: 0.01, range: 0.5 }),
                saturated: self.saturated,
            }),
            name => FieldChoice::Relaxed {
                equation: self.equation(name)?,
                relaxation: self.relaxation()?,
                measure: self.measure(),
                tolerance: self.tolerance.unwrap_or_else(|| usual_tolerance(self.measure())),
                max_sweeps: self.max_sweeps.unwrap_or(MAX_SWEEPS) as usize,
                on: self.device(),
                stencil: self.stencil.unwrap_or_default(),
                initial: self.initial.unwrap_or_default(),
            },
        };
        if self.saturated && self.escape.is_some() {
            return Err(
                "--escape needs a potential, but the forces of --saturated have none; leave out one of the two".into(),
            );
        }
        let limits = self.limits.unwrap_or_default();
        Ok(Some(FieldPlanner { field, limits, escape: self.escape, path: PathKind::Own }))
    }

    /// Returns the measure that ends the relaxation. SOR has another default, with which published numbers of sweeps were
    /// counted.
    fn measure(&self) -> Measure {
        let is_sor = self.relaxation == Some(RelaxationName::Sor) && self.device().is_cpu();
        self.measure.unwrap_or(if is_sor { Measure::SumOfChange } else { Measure::GreatestRelativeChange })
    }

    /// Returns the device for the relaxation.
    fn device(&self) -> Device {
        self.on.unwrap_or(Device::Cpu)
    }

    /// Returns the reason why the device is not available, with a hint. `None` if it is available.
    pub fn missing(&self) -> Option<String> {
        self.device().adapter().err().map(|reason| format!("--on gpu: {reason}"))
    }

    /// Returns the stated options in the order of the help, each with its fields.
    fn stated_options(&self) -> Vec<Stated> {
        use FieldName::{Bvp, Bvp2, Khatib, Local, Oriented};
        let options: [(bool, &str, &[FieldName]); 19] = [
            (self.field.is_some(), "--field", FieldName::value_variants()),
            (self.epsilon.is_some(), "--epsilon", &[Oriented, Bvp, Bvp2]),
            (self.direction.is_some(), "--direction", &[Oriented, Local]),
            (self.difference.is_some(), "--difference", &[Oriented, Local, Bvp]),
            (self.relaxation.is_some(), "--relaxation", &RELAXED),
            (self.order.is_some(), "--order", &RELAXED),
            (self.factor.is_some(), "--factor", &RELAXED),
            (self.relax_preferences, "--relax-preferences", &[Bvp, Bvp2]),
            (self.initial.is_some(), "--initial", &RELAXED),
            (self.stencil.is_some(), "--stencil", &RELAXED),
            (self.limits.is_some(), "--limits", FieldName::value_variants()),
            (self.measure.is_some(), "--measure", &RELAXED),
            (self.tolerance.is_some(), "--tolerance", &RELAXED),
            (self.max_sweeps.is_some(), "--max-sweeps", &RELAXED),
            (self.on.is_some(), "--on", &RELAXED),
            (self.attraction.is_some(), "--attraction", &[Khatib]),
            (self.repulsion.is_some(), "--repulsion", &[Khatib]),
            (self.saturated, "--saturated", &[Khatib]),
            (self.escape.is_some(), "--escape", &[Khatib]),
        ];
        options.into_iter().filter(|option| option.0).map(|(_, name, fields)| (name, fields)).collect()
    }

    fn equation(&self, name: FieldName) -> Result<EquationChoice, String> {
        let difference = self.difference.unwrap_or_default();
        let elsewhere = self.epsilon.unwrap_or(0.0);
        Ok(match name {
            FieldName::Local => EquationChoice::LocallyOriented { direction: self.direction, difference },
            FieldName::Bvp => EquationChoice::Preference { elsewhere, difference },
            FieldName::Bvp2 => EquationChoice::AlteredPreference { elsewhere },
            FieldName::Oriented => match (self.direction, self.epsilon) {
                (Some(direction), Some(epsilon)) => EquationChoice::Oriented { direction, epsilon, difference },
                _ => return Err("--field oriented needs --epsilon and --direction, such as 0.5 and 0,-1".into()),
            },
            FieldName::Harmonic | FieldName::Khatib => EquationChoice::Harmonic,
        })
    }

    fn relaxation(&self) -> Result<Relaxation, String> {
        let name = self.relaxation.unwrap_or(RelaxationName::GaussSeidel);
        let usual = if self.device().is_cpu() { Order::Corners(Lines::Rows) } else { Order::RedBlack };
        let order = self.order.unwrap_or(usual);
        if !self.device().is_cpu() && order != Order::RedBlack {
            return Err("--on gpu needs --order red-black: other orders need --on cpu".into());
        }
        let jacobi = matches!(name, RelaxationName::Jacobi | RelaxationName::WeightedJacobi);
        if jacobi && self.order.is_some() {
            return Err(
                "--order needs --relaxation gauss-seidel or sor: Jacobi's relaxations update all cells at once".into(),
            );
        }
        if self.relax_preferences && name != RelaxationName::Sor {
            return Err(
                "--relax-preferences needs --relaxation sor: other relaxations have no factor for preferences".into()
            );
        }
        let sor = |factor: Factor| {
            let sor = Relaxation::sor(factor, order);
            // On a GPU, sweeps have no guard.
            let sor = if self.device().is_cpu() { sor.guarded() } else { sor };
            if self.relax_preferences { sor.relaxing_preferences() } else { sor }
        };
        match (name, self.factor) {
            (RelaxationName::Jacobi, None) => Ok(Relaxation::JACOBI),
            (RelaxationName::Jacobi, Some(_)) => Err("--factor needs --relaxation weighted-jacobi or sor".into()),
            (RelaxationName::WeightedJacobi, Some(factor)) => Ok(Relaxation::weighted_jacobi(factor)),
            (RelaxationName::WeightedJacobi, None) => {
                Err("--relaxation weighted-jacobi needs --factor, such as 0.8".into())
            }
            (RelaxationName::GaussSeidel, None) => Ok(Relaxation::gauss_seidel(order)),
            (RelaxationName::GaussSeidel, Some(_)) => {
                Err("--factor needs --relaxation weighted-jacobi or sor: gauss-seidel is sor with the factor 1".into())
            }
            (RelaxationName::Sor, Some(factor)) => Ok(sor(Factor::Given(factor))),
            (RelaxationName::Sor, None) => Ok(sor(Factor::Formula)),
        }
    }
}

/// Returns the default tolerance of a measure.
fn usual_tolerance(measure: Measure) -> f64 {
    match measure {
        Measure::SumOfChange | Measure::DifferenceOfSums => SUM_TOLERANCE,
        // The squared tolerance of sums. On a grid of a single cell, both measures stop at the same sweep.
        Measure::SumOfSquares => SUM_TOLERANCE * SUM_TOLERANCE,
        Measure::GreatestChange | Measure::GreatestRelativeChange => RELATIVE_TOLERANCE,
    }
}

/// Lists names of fields, such as `oriented, bvp or bvp2`.
fn names(fields: &[FieldName]) -> String {
    let values: Vec<_> = fields.iter().filter_map(ValueEnum::to_possible_value).collect();
    listed(&values.iter().map(PossibleValue::get_name).collect::<Vec<_>>(), " or ")
}

/// Parses numbers separated by commas. A part that is not a number becomes NaN.
pub(super) fn numbers(text: &str) -> Vec<f64> {
    text.split(',').map(|part| part.trim().parse().unwrap_or(f64::NAN)).collect()
}

/// Parses a direction in joint space.
///
/// # Errors
/// A text that is not two numbers, and two zeros.
pub fn direction(text: &str) -> Result<Direction, String> {
    let vector = match numbers(text)[..] {
        [a, b] => Direction::of([a, b]),
        _ => None,
    };
    vector.ok_or_else(|| "must be two numbers that are not both 0, such as 0,-1".into())
}

/// Splits a law such as `ranged:0.01,0.5` into its name and constants. `None` without constants, or if one is not positive.
fn split_law(text: &str) -> Option<(&str, Vec<f64>)> {
    let (name, constants) = text.split_once(':')?;
    let constants = numbers(constants);
    constants.iter().all(|c| c.is_finite() && *c > 0.0).then_some((name, constants))
}

fn attraction(text: &str) -> Result<Attraction, String> {
    match split_law(text).as_ref().map(|(name, constants)| (*name, &constants[..])) {
        Some(("constant", [c])) => Ok(Attraction::Constant(*c)),
        Some(("linear", [k])) => Ok(Attraction::Linear(*k)),
        _ => Err("must be constant:C or linear:K with a positive number, such as linear:1".into()),
    }
}

fn escape(text: &str) -> Result<Escape, String> {
    match text.split_once(':') {
        None if text == "wave" => Some(Escape::Wave),
        None if text == "walk" => Some(Escape::Walk { seed: 1 }),
        Some(("walk", seed)) => seed.parse().ok().map(|seed| Escape::Walk { seed }),
        _ => None,
    }
    .ok_or_else(|| "must be wave, walk or walk:SEED with a whole number, such as walk:7".into())
}

fn repulsion(text: &str) -> Result<Repulsion, String> {
    match split_law(text).as_ref().map(|(name, constants)| (*name, &constants[..])) {
        Some(("ranged", [gain, range])) => Ok(Repulsion::Ranged { gain: *gain, range: *range }),
        Some(("inverse-square", [charge])) => Ok(Repulsion::InverseSquare(*charge)),
        Some(("sum", [charge])) => Ok(Repulsion::Sum(*charge)),
        _ => {
            Err("must be ranged:K,P0, inverse-square:Q or sum:Q with positive numbers, such as ranged:0.01,0.5".into())
        }
    }
}
