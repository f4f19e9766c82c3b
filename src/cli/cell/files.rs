//! The motions of both arms as files.

use crate::motion::{Format, JointMotion, Trajectory, csv_of_joints, ros_yaml};
use crate::space::{Derivative, Piece};
use cplan_cell::{Cell, Coordination};
use std::path::Path;

/// Returns a motion as CSV or YAML. A file whose name ends in the name of an arm has only the motion of this arm.
pub fn motion(cell: &Cell, found: &Coordination, path: &Path, format: Format) -> String {
    match (format, named_arm(cell, path)) {
        (Format::Yaml, Some(arm)) => ros_yaml(&alone(cell, found, arm)),
        (Format::Yaml, None) => ros_yaml(&both(cell, found)),
        (_, Some(arm)) => csv_of_joints(&alone(cell, found, arm), &[], None),
        (_, None) => {
            let both = both(cell, found);
            with_steps(cell, found, &both.time, &csv_of_joints(&both, &[], None))
        }
    }
}

/// Returns the arm whose name ends that of a file.
pub fn named_arm(cell: &Cell, path: &Path) -> Option<usize> {
    let stem = path.file_stem()?.to_string_lossy();
    let named = (0..2).filter(|arm| stem.ends_with(&cell.arms[*arm].name));
    // The name of one arm may end with that of the other.
    named.max_by_key(|arm| cell.arms[*arm].name.len())
}

/// Returns the table with a column for each arm that has steps: the number of its step at each time.
fn with_steps(cell: &Cell, found: &Coordination, times: &[f64], table: &str) -> String {
    let mut lines: Vec<String> = table.lines().map(str::to_owned).collect();
    for (arm, steps) in cell.arms.iter().zip(&found.steps).filter(|(_, steps)| !steps.is_empty()) {
        lines[0] += &format!(",{}/step", arm.name);
        for (line, time) in lines[1..].iter_mut().zip(times) {
            let number = steps.partition_point(|step| step.begin <= *time).max(1);
            *line += &format!(",{number}");
        }
    }
    lines.join("\n") + "\n"
}

fn alone(cell: &Cell, found: &Coordination, arm: usize) -> JointMotion {
    JointMotion::new(&cell.joints(arm), &found.motions[arm].trajectory, false)
}

/// Returns the motion of both arms on one clock, with the samples of both motions. Additional samples do not change a motion.
fn both(cell: &Cell, found: &Coordination) -> JointMotion {
    let motions = found.motions.each_ref().map(|motion| &motion.trajectory);
    let mut time: Vec<f64> = motions.iter().flat_map(|motion| motion.time.iter().copied()).collect();
    time.sort_by(f64::total_cmp);
    time.dedup();
    let name = |arm: usize, joint: &str| match cell.is_one_robot {
        true => joint.to_owned(),
        false => format!("{}/{joint}", cell.arms[arm].name),
    };
    let of_arm =
        |arm: usize| cell.arms[arm].problem.scene().arm().joints.iter().map(move |joint| name(arm, &joint.name));
    let states = motions.map(|motion| states(motion, &time));
    let rows = |of: usize| {
        (0..time.len()).map(|k| states.iter().flat_map(|states| states[k][of]).collect::<Vec<f64>>()).collect()
    };
    let (position, velocity) = (rows(0), rows(1));
    JointMotion { joints: of_arm(0).chain(of_arm(1)).collect(), time, position, velocity, acceleration: None }
}

/// Returns positions and velocities of a motion at these times. After its end, the arm rests.
fn states(motion: &Trajectory, times: &[f64]) -> Vec<[[f64; 2]; 2]> {
    let pieces = motion.pieces();
    let state = |time: &f64| {
        let known = motion.time.partition_point(|other| other < time);
        if motion.time.get(known) == Some(time) || known == motion.time.len() {
            let known = known.min(motion.time.len() - 1);
            return [motion.position[known], motion.velocity[known]];
        }
        let piece: &Piece = &pieces[known - 1];
        let share = (time - piece.from) / (piece.to - piece.from);
        [Derivative::Position, Derivative::Velocity].map(|of| piece.derivative(of, share).into())
    };
    times.iter().map(state).collect()
}
