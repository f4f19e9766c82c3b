//! Recorded motions along a line.

use super::Fault;
use cplan_deviation::{Deviation, Kinematics, Line};
use cplan_handling::{Derivative, FollowedLine, Piece, Recording, Task};

/// Relative allowance for rounding in comparisons of speeds.
const SPEED_ROUNDING: f64 = 1e-6;

/// Number of intervals in each piece of a motion. The check evaluates the speed of the tip at their ends.
const SPEED_PARTS: u32 = 4;

/// Returns a fault if the tip exceeds the greatest speed of the line. Travels have no such limit, so lines with travels
/// are not checked.
pub(super) fn speed_fault(task: &Task, motion: &Recording, followed: &FollowedLine) -> Option<Fault> {
    let pieces = followed.path.pieces();
    if pieces.iter().any(|piece| piece.is_travel) {
        return None;
    }
    let speeds: Option<Vec<f64>> = pieces.iter().map(|piece| followed.speed.or(piece.speed)).collect();
    let most = speeds?.into_iter().fold(0.0, f64::max);
    let kinematics = Kinematics::new(&task.arm);
    let speed = |piece: &Piece, part: u32| {
        let u = f64::from(part) / f64::from(SPEED_PARTS);
        kinematics.velocity(piece.at(u), piece.derivative(Derivative::Velocity, u)).norm()
    };
    let pieces = motion.pieces();
    let fastest = pieces.iter().flat_map(|piece| (0..=SPEED_PARTS).map(|part| speed(piece, part))).fold(0.0, f64::max);
    (fastest > most * (1.0 + SPEED_ROUNDING)).then_some(Fault::LineSpeed { speed: fastest, most })
}

/// Returns a fault if the motion is not proven to follow the line in its order, from end to end, within its tolerance.
pub(super) fn fault(task: &Task, motion: &Recording, followed: &FollowedLine) -> Option<Fault> {
    let (kinematics, line) = (Kinematics::new(&task.arm), Line::new(&followed.path));
    let tolerance = followed.tolerance;
    let bounds = Deviation::of_line(&kinematics, &line, tolerance).of_pieces(&motion.pieces());
    let (piece, off) = bounds.into_iter().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    (off > tolerance).then_some(Fault::Line { off, tolerance, piece })
}
