//! Motions among moving obstacles, compared with methods of the tests: kinematics, distances and trajectories by brute
//! force.

mod belts;
mod found;
mod judged;
mod refuted;
mod shipped;
mod tasks;
