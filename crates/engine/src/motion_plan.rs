//! What became of a single motion.

use super::fastest::fastest;
use super::field_report::field_report;
use super::moving::{Demand, InTime, Timing, in_time};
use super::options::Options;
use super::{Answer, Bound, Report, Verdict};
use cplan_core::model::MotionProblem;
use cplan_motion::CertifiedCurve;
use cplan_motion::{Fastest, Objective, Optimum, Timed, TimingError};

/// A verdict, and the motion that follows from it.
#[derive(Debug, Clone)]
pub struct MotionPlan {
    /// The problem, with the limits asked for.
    pub problem: MotionProblem,
    /// The verdict and how it came about.
    pub answer: Answer,
    /// What the motion follows, if there is one.
    pub curve: Option<CertifiedCurve>,
    /// How it gets by what moves, if anything does.
    pub timing: Option<Timing>,
}

impl MotionPlan {
    /// Times what was found, and says of it all that is special to a single motion.
    ///
    /// # Errors
    /// A motion that lasts too long, or has too many samples.
    pub(super) fn timed(
        problem: MotionProblem,
        mut answer: Answer,
        options: &Options,
    ) -> Result<(Self, Report), TimingError> {
        let joints = &problem.scene().arm().joints;
        let planner = answer.method.name();
        let (mut followed, mut timing) = (None, None);
        let mut driven = match &answer.verdict {
            Verdict::Found(certified) => Some(match options.drive.optimize {
                Objective::Length => (options.drive.along(problem.scene(), certified, 1.0)?, None),
                Objective::Time => fastest(&problem, &answer, certified, options)?,
            }),
            Verdict::Infeasible(_) | Verdict::Unknown(_) => None,
        };
        if !problem.scene().workspace().movers.is_empty()
            && let Some((timed, fastest)) = driven.take()
        {
            // The fastest motion may take another path than the shortest, to another goal.
            let path = timed.curve.straight().clone();
            match in_time(&problem, &path, timed, options, &Demand::ALONE)? {
                Ok(InTime { timed, figures }) => {
                    // The bound stays; the duration has its waits now.
                    let duration = timed.trajectory.duration();
                    let fastest = fastest.map(|fastest| Fastest::new(duration, fastest.lower_bound));
                    (driven, timing) = (Some((timed, fastest)), Some(figures));
                }
                Err(reason) => answer.verdict = Verdict::Unknown(reason),
            }
        }
        let mut report = match (&answer.verdict, driven) {
            (Verdict::Found(certified), Some((Timed { curve, trajectory }, fastest))) => {
                let mut report = Report::found(planner, joints, &curve, trajectory);
                // What is told of the path is told of the one that the motion takes.
                if curve.curve().path() != certified.path() {
                    let upper = |bound: Bound| bound.metric.length(curve.curve().path());
                    answer.bound = answer.bound.map(|bound| Bound { upper: upper(bound), ..bound });
                    answer.verdict = Verdict::Found(curve.straight().clone());
                }
                report.optimum = answer.bound.map(Optimum::from);
                report.fastest = fastest;
                report.moving.clone_from(&timing);
                report.closest = curve.nearest().map(|n| problem.scene().describe(n.contact.pair));
                followed = Some(curve);
                report
            }
            (Verdict::Infeasible(proof), _) => {
                let reason = answer.verdict.reason().unwrap_or_default();
                let mut report = Report::infeasible(planner, joints, reason);
                report.proof = Some(proof.clone());
                report
            }
            (Verdict::Found(_), None) => unreachable!("what is found is driven"),
            (Verdict::Unknown(reason), _) => {
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
        Ok((Self { problem, answer, curve: followed, timing }, report))
    }
}

/// The names of the joints that the goal leaves free.
fn free_joints(problem: &MotionProblem) -> Vec<String> {
    let goals = problem.goals().pieces();
    let is_free = |k: &usize| goals.iter().any(|goals| goals.ends()[0][*k] != goals.ends()[1][*k]);
    (0..2).filter(is_free).map(|k| problem.scene().arm().joints[k].name.clone()).collect()
}
