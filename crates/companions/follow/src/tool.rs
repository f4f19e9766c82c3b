//! The samples at which the tool is on.

use crate::Found;
use cplan_deviation::{Deviation, Foot, Kinematics, Line};
use cplan_model::Arm;
use cplan_toolpath::Toolpath;

impl Found {
    /// Returns for each sample whether the tool is on. It is off from the arrival at the beginning of a travel to the
    /// arrival at the end of the travel. `tolerance` is the distance within which the motion follows the line, metres.
    pub fn tool(&self, arm: &Arm, path: &Toolpath, tolerance: f64) -> Vec<bool> {
        let trajectory = &self.timed.trajectory;
        let (kinematics, line) = (Kinematics::new(arm), Line::new(path));
        let deviation = Deviation::of_line(&kinematics, &line, tolerance);
        let mut pairs = deviation.pairing(&trajectory.pieces()).pairs.into_iter().peekable();
        let mut tool = vec![true; trajectory.time.len()];
        let mut begin = 0;
        for (index, piece) in line.pieces.iter().enumerate() {
            let is_before = |foot: &Foot| foot.piece < index || (foot.piece == index && foot.u < 1.0);
            while pairs.next_if(|(_, foot)| is_before(foot)).is_some() {}
            let end = pairs.peek().map_or(tool.len() - 1, |(moment, _)| self.arrival(*moment));
            if piece.is_travel {
                tool[begin..end.max(begin)].fill(false);
            }
            begin = end;
        }
        tool
    }

    /// Returns the first sample of the rest at a moment. Moments count samples.
    fn arrival(&self, moment: f64) -> usize {
        let positions = &self.timed.trajectory.position;
        let near = (moment.round() as usize).min(positions.len() - 1);
        near - positions[..near].iter().rev().take_while(|position| **position == positions[near]).count()
    }
}
