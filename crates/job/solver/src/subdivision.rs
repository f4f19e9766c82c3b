//! Planning by subdivision of the configuration space.

use super::decision::accepted_smaller_proof;
use super::ladder::{Request, explain};
use super::{Answer, Method, Space, Stages, Unknown};
use cplan_interrupt::Instant;
use cplan_judge::{CertifiedPath, Rejection, certify};
use cplan_model::space::{Configuration, Path, Portal, funnel_path, nearest_end};
use cplan_model::{MotionProblem, Outcome};
use cplan_planners::planner::{PathKind, Proposal, Run, Size, Trace};
use cplan_proofs::{Channel, Connectivity, Exploration, Occupancy, explore};

/// Answers a request by [`explore`]: with a path or a proof, or with neither if [`Options::boxes`](super::Options::boxes) boxes
/// do not suffice. The path leads through free boxes. It is pulled taut, unless the path through the middles of portals is
/// requested. There is a single attempt, because the search itself refines boxes.
pub(super) fn solve(Request { problem, options, progress }: Request) -> Answer {
    let scene = problem.scene();
    let clearance = scene.workspace().clearance;
    let mut stages = Stages::default();
    let clock = Instant::now();
    let exploration = explore(scene, problem.start(), problem.goals(), clearance, options.boxes);
    let size = Size::Graph { nodes: exploration.boxes.len(), edges: exploration.adjacencies };
    let trace = trace(&exploration);
    stages.query = clock.elapsed();
    let clock = Instant::now();
    let (proposal, outcome) = match exploration.answer {
        Connectivity::Connected(channel) => {
            let certified = match options.planner.path_kind() {
                PathKind::Own | PathKind::Middles => certify(scene, channel.path()),
                PathKind::Taut => certify_shortest_in_channel(problem, &channel),
            };
            stages.certify = clock.elapsed();
            match certified {
                Ok(path) => (Proposal::Found(path.path().clone()), Outcome::Found(path.into())),
                Err(rejection) => {
                    let reason = format!("the path of the planner is not certified: {}", explain(scene, rejection));
                    (Proposal::Found(channel.path()), Outcome::Unknown(reason.into()))
                }
            }
        }
        Connectivity::Disconnected(proof) => {
            let proof = accepted_smaller_proof(problem, proof);
            stages.prove = clock.elapsed();
            let refused = || Outcome::Unknown("the proof of the planner does not hold".to_owned().into());
            (Proposal::NoPath, proof.map_or_else(refused, Outcome::Infeasible))
        }
        Connectivity::Undecided { boxes, .. } => {
            let reason = format!("{boxes} boxes were not enough to decide whether a path exists");
            (Proposal::GaveUp(reason.clone()), Outcome::Unknown(reason.into()))
        }
    };
    if let Outcome::Unknown(Unknown { reason, .. }) = &outcome {
        progress(&format!("{}: {reason}", Method::Subdivision));
    }
    let run = Run::new(proposal, trace, size);
    Answer {
        method: Method::Subdivision,
        outcome,
        path_kind: options.planner.path_kind(),
        history: Vec::new(),
        run,
        space: Space::Scene,
        stages,
    }
}

/// Certifies the shortest path through the channel. It touches the sides of boxes, so rounding may prevent this. Then certifies
/// the path through the middles of the portals.
pub(super) fn certify_shortest_in_channel(
    problem: &MotionProblem,
    channel: &Channel,
) -> Result<CertifiedPath, Rejection> {
    certify(problem.scene(), taut(channel)).or_else(|_| certify(problem.scene(), channel.path()))
}

pub(super) fn taut(channel: &Channel) -> Path {
    let portal = |&[left, right]: &[Configuration; 2]| Portal { left, right };
    let portals: Vec<Portal> = channel.portals().iter().map(portal).collect();
    let start = channel.start();
    let path = funnel_path(start, nearest_end(start, channel.goals(), &portals), &portals);
    Path::new(path)
}

fn trace(exploration: &Exploration) -> Trace {
    let of = |kind: Occupancy| {
        let boxes = exploration.boxes.iter().filter(|(_, occupancy)| *occupancy == kind);
        boxes.map(|(cell, _)| [cell.lower.into(), cell.upper.into()]).collect()
    };
    Trace::Boxes { free: of(Occupancy::Free), stuck: of(Occupancy::Colliding), mixed: of(Occupancy::Undecided) }
}
