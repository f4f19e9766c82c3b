//! Potential fields and the planners that follow them, against solutions that share no code with the solvers.

mod errata;
mod family;
mod football;
mod moving;
mod planners;
