//! What became of a single motion.

use super::field_report::field_report;
use super::options::{Options, Planner};
use super::{Answer, Bound, GridSpace, Verdict};
use crate::check::CertifiedCurve;
use crate::model::MotionProblem;
use crate::motion::{Optimum, Report, SearchUsed, Timed, TimingError};
use crate::space::Metric;

/// A verdict, the motion that follows from it, and what is to be said of both.
#[derive(Debug, Clone)]
pub struct MotionPlan {
    /// The problem, with the limits asked for.
    pub problem: MotionProblem,
    /// The verdict and how it came about.
    pub answer: Answer,
    /// What the motion follows, if there is one.
    pub curve: Option<CertifiedCurve>,
    /// The result file's content.
    pub report: Report,
}

impl MotionPlan {
    /// Times what was found.
    ///
    /// # Errors
    /// A motion that lasts too long, or has too many samples.
    pub(super) fn timed(problem: MotionProblem, answer: Answer, options: &Options) -> Result<Self, TimingError> {
        let joints = &problem.scene().arm().joints;
        let planner = answer.method.name();
        let mut followed = None;
        let mut report = match &answer.verdict {
            Verdict::Found(certified) => {
                let Timed { curve, trajectory } = options.drive.along(problem.scene(), certified, 1.0)?;
                let mut report = Report::found(planner, joints, &curve, trajectory);
                report.optimum = answer.bound.map(Optimum::from);
                report.closest = curve.nearest().map(|n| problem.scene().describe(n.contact.pair));
                followed = Some(curve);
                report
            }
            Verdict::Infeasible(proof) => {
                let boxes = proof.stuck().len();
                let reason = format!("proven: {boxes} boxes of colliding configurations separate start and goal");
                let mut report = Report::infeasible(planner, joints, reason);
                report.proof = Some(proof.clone());
                report
            }
            Verdict::Unknown(reason) => {
                let mut report = Report::unknown(planner, joints, reason.clone());
                report.path_exists = answer.witness.is_some().then_some(true);
                report
            }
        };
        report.free_joints = free_joints(&problem);
        report.path_kind = matches!(answer.verdict, Verdict::Found(_)).then(|| answer.path.name());
        report.name = Some(problem.scene().workspace().name.clone()).filter(|name| !name.is_empty());
        report.size = answer.run.size.figures().into_iter().collect();
        report.field = options.planner.field().map(|field| field_report(field, &answer));
        report.search = SearchUsed::of(&options.planner);
        report.space = options.planner.space().and_then(GridSpace::told);
        Ok(Self { problem, answer, curve: followed, report })
    }
}

/// The names of the joints that the goal leaves free.
fn free_joints(problem: &MotionProblem) -> Vec<String> {
    let goals = problem.goals().pieces();
    let is_free = |k: &usize| goals.iter().any(|goals| goals.ends()[0][*k] != goals.ends()[1][*k]);
    (0..2).filter(is_free).map(|k| problem.scene().arm().joints[k].name.clone()).collect()
}

impl From<Bound> for Optimum {
    fn from(bound: Bound) -> Self {
        let (metric, weights) = match bound.metric {
            Metric::Euclidean => ("euclidean", None),
            Metric::Weighted { weights } => ("weighted", Some(weights)),
            Metric::Time { .. } => ("time", None),
        };
        let gap = Some(bound.gap()).filter(|gap| gap.is_finite());
        Self { metric, weights, length: bound.upper, lower_bound: bound.lower, gap }
    }
}

impl SearchUsed {
    /// How a planner searches its grid, if it searches one.
    #[must_use]
    pub fn of(planner: &Planner) -> Option<Self> {
        let Planner::Wavefront { search, neighborhood, .. } = planner else { return None };
        Some(Self { search: search.name(), neighbors: neighborhood.count() })
    }
}
