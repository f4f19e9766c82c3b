//! Mobile robots from the literature (`crates/testkit/src/mobile`), compared with geometry and formulas of the tests.

mod drive;
mod follower;
mod grid;
mod mission;
mod plain;
mod tracking;
