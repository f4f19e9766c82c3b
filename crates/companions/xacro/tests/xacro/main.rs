//! Tests of complete expansions: results and refused files.

mod common;
mod expands;
mod refused;
