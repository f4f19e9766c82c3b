//! The settings of a field, as in the result.

use cplan_fields::{
    Difference, EquationChoice, Factor, FieldChoice, FieldPlanner, Khatib, Limits, Measure, Relaxation, Scheme,
};
use cplan_motion::FieldReport;
use cplan_planners::planner::{Note, Size};
use cplan_solver::{Answer, Space};

/// Reports the settings of the field, and how its computation ended.
pub(super) fn field_report<F>(planner: &FieldPlanner, answer: &Answer<F>) -> FieldReport {
    let limits = if planner.limits == Limits::High { "high" } else { "reflecting" };
    let base = match planner.field {
        FieldChoice::Khatib(Khatib { attraction, repulsion, saturated }) => FieldReport {
            equation: "khatib",
            attraction: Some(attraction.to_string()),
            repulsion: Some(repulsion.to_string()),
            saturated: Some(saturated),
            escape: planner.escape.map(|escape| escape.to_string()),
            escaped: planner.escape.map(|_| match answer.run.note {
                Some(Note::Escaped { minima, .. }) => minima,
                _ => 0,
            }),
            ..FieldReport::default()
        },
        FieldChoice::Relaxed { equation, relaxation, measure, tolerance, max_sweeps, on, stencil, initial } => {
            let sweeps = if let Size::Grid { sweeps, .. } = answer.run.size { sweeps } else { 0 };
            FieldReport {
                relaxes_preferences: relaxation.relaxes_preferences.then_some(true),
                initial: (!initial.is_high()).then_some("low"),
                stencil: (!stencil.is_square()).then_some("anisotropic"),
                measure: (!measure.is_relative()).then(|| measure_name(measure)),
                tolerance: Some(tolerance),
                max_sweeps: Some(max_sweeps),
                on: on.adapter().ok().flatten(),
                converged: (sweeps > 0).then_some(matches!(answer.run.note, None | Some(Note::Continued { .. }))),
                ..relaxed(equation_report(equation), &relaxation, answer)
            }
        }
    };
    FieldReport { limits, ..base }
}

fn measure_name(measure: Measure) -> &'static str {
    match measure {
        Measure::SumOfChange => "absolute",
        Measure::SumOfSquares => "squares",
        Measure::DifferenceOfSums => "sums",
        Measure::GreatestChange => "greatest",
        Measure::GreatestRelativeChange => "relative",
    }
}

fn equation_report(equation: EquationChoice) -> FieldReport {
    let named = |equation: &'static str| FieldReport { equation, ..FieldReport::default() };
    let name = |difference: Difference| match difference {
        Difference::Central => Some("central"),
        Difference::Upwind => Some("upwind"),
    };
    match equation {
        EquationChoice::Harmonic => named("harmonic"),
        EquationChoice::Oriented { direction, epsilon, difference } => FieldReport {
            epsilon: Some(epsilon),
            direction: Some(direction.components()),
            difference: name(difference),
            ..named("oriented")
        },
        EquationChoice::LocallyOriented { direction, difference } => FieldReport {
            direction: direction.map(|direction| direction.components()),
            difference: name(difference),
            ..named("local")
        },
        EquationChoice::Preference { elsewhere, difference } => {
            FieldReport { epsilon: Some(elsewhere), difference: name(difference), ..named("bvp") }
        }
        EquationChoice::AlteredPreference { elsewhere } => FieldReport { epsilon: Some(elsewhere), ..named("bvp2") },
    }
}

fn relaxed<F>(report: FieldReport, relaxation: &Relaxation, answer: &Answer<F>) -> FieldReport {
    let factor = if let Space::Grid(grid) = &answer.space { Some(relaxation.factor(grid.cells)) } else { None };
    let (name, order, factor) = match relaxation.scheme {
        Scheme::Simultaneous { factor: 1.0 } => ("jacobi", None, None),
        Scheme::Simultaneous { .. } => ("weighted-jacobi", None, factor),
        Scheme::Successive { factor: Factor::Given(1.0), order } => ("gauss-seidel", Some(order), None),
        Scheme::Successive { order, .. } => ("sor", Some(order), factor),
    };
    FieldReport { relaxation: Some(name), order: order.map(|order| order.to_string()), factor, ..report }
}
