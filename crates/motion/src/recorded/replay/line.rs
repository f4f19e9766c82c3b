//! Recorded motions along a line.

use super::Fault;
use cplan_deviation::{Deviation, Foot, Kinematics, Line};
use cplan_handling::{FollowedLine, Recording, Task};

/// Returns a fault if a motion is not proven to stay within the tolerance of a line, in the order of the line. It begins
/// and ends where the line does.
pub(super) fn fault(task: &Task, motion: &Recording, followed: &FollowedLine) -> Option<Fault> {
    let (kinematics, line) = (Kinematics::new(&task.arm), Line::new(&followed.path));
    let last = followed.path.pieces().len() - 1;
    let ends = [Foot { piece: 0, u: 0.0 }, Foot { piece: last, u: 1.0 }];
    let tolerance = followed.tolerance;
    let bounds = Deviation { kinematics: &kinematics, line: &line, tolerance, ends }.of_pieces(&motion.pieces());
    let (piece, off) = bounds.into_iter().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    (off > tolerance).then_some(Fault::Line { off, tolerance, piece })
}
