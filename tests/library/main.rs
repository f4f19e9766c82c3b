//! Configuration-space obstacles, potential fields, mobile robots, and motions among moving obstacles, against methods that
//! share no code with them.

mod cspace;
mod fields;
mod mobile;
mod moving;
