//! Motions among moving obstacles, compared with methods of the tests: kinematics, distances and trajectories by brute
//! force.

mod belts;
mod drawn;
mod found;
mod judged;
#[path = "../planning/random_worlds/oracle.rs"]
#[allow(dead_code, reason = "other test programs use more of it")]
mod oracle;
mod refuted;
mod shipped;
mod tasks;
#[path = "../planning/random_worlds/solid.rs"]
mod solid;
#[path = "../planning/random_worlds/world.rs"]
mod world;
