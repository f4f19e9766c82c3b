//! Expansions as a whole: what they make of files, and what they refuse.

mod common;
mod expands;
mod refused;
