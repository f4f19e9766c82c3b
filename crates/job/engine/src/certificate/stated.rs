//! Certificates of the claims in a result, computed anew for its files.

use super::contacts::Contacts;
use super::lower_bound::LowerBound;
use super::{blocked_solutions, members, robot_members, written};
use cplan_judge::CollisionBox;
use cplan_model::MotionProblem;
use cplan_solver::Bound;
use cplan_world::Overrides;

/// Fraction of a bound that its certificate may lose. If more is lost, the certificate is computed with more points.
const MAX_STATED_BOUND_LOSS: f64 = 1e-6;

/// A certificate that no motion is shorter than a length.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundCertificate {
    /// The proven length. It may differ from the stated bound, because the evidence is computed anew.
    pub length: f64,
    /// The number of walls that bar shorter motions.
    pub walls: usize,
    /// The text of the certificate.
    pub text: String,
}

/// Returns a certificate with the claim, which is not checked, that boxes separate the start from all goals. It includes the
/// values in `asked`, which override the world file.
///
/// # Errors
/// The first box whose shapes are not part of the problem, or never meet.
pub fn certificate_of_boxes(
    problem: &MotionProblem,
    stuck: &[CollisionBox],
    asked: &Overrides,
) -> Result<String, usize> {
    let scene = problem.scene();
    if let Some(odd) = stuck.iter().position(|stuck| scene.pairs().binary_search(&stuck.pair).is_err()) {
        return Err(odd);
    }
    let mut contacts = Contacts::new(scene);
    let boxes = contacts.boxes(&[stuck, &blocked_solutions(problem).0].concat());
    let members = [robot_members(None, scene.arm()), members(problem, asked), contacts.named(), vec![boxes]];
    Ok(written("infeasible", members.concat()))
}

/// Returns the certificate of a bound. `None` if the goals are a curve, or if a checker could not separate them from neighbouring
/// configurations.
pub fn certificate_of_bound(problem: &MotionProblem, stated: &Bound, asked: &Overrides) -> Option<BoundCertificate> {
    let bound = LowerBound::of(problem, stated, asked, MAX_STATED_BOUND_LOSS)?;
    let mut contacts = Contacts::new(problem.scene());
    let evidence = bound.evidence(&mut contacts);
    let members = [robot_members(None, problem.scene().arm()), members(problem, asked), contacts.named(), evidence];
    let text = written("no_shorter", members.concat());
    Some(BoundCertificate { length: bound.length(), walls: bound.walls(), text })
}
