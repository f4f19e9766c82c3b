//! Simulated mobile robots from the literature, for the examples `mission`, `wall_follower` and `differential_drive` and their
//! tests.

pub mod fields;
pub mod floor;
pub mod follower;
pub mod forces;
pub mod mission;
pub mod occupancy;
pub mod robot;
pub mod tanh;
pub mod tracking;

use cplan::Point;

/// Start of the mission of Alves.
pub const START: [f64; 2] = [-19.0, -8.0];

/// The targets of the mission, in order: object 1, the bin, object 2, the bin.
pub const TARGETS: [(&str, [f64; 2]); 4] =
    [("object 1", [2.0, 4.0]), ("bin", [-19.0, 2.0]), ("object 2", [9.0, -7.0]), ("bin", [-19.0, 2.0])];

/// Returns the targets that are obstacles on the leg with this number: the bin, and those of later legs.
pub fn in_the_way(leg: usize) -> Vec<(&'static str, Point)> {
    let (bin, second) = (TARGETS[1], TARGETS[2]);
    let marked: &[_] = match leg {
        0 => &[bin, second],
        1 => &[second],
        2 => &[bin],
        _ => &[],
    };
    marked.iter().map(|&(name, at)| (name, Point::from(at))).collect()
}
