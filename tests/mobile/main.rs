//! Mobile robots from the literature (`examples/mobile`), compared with geometry and formulas of the tests.

#[path = "../../examples/published_tables/alves.rs"]
#[allow(dead_code, reason = "notes are for readers of the tables")]
mod alves;
mod drive;
mod follower;
mod grid;
mod mission;
#[path = "../../examples/mobile/mod.rs"]
mod mobile;
mod plain;
mod tracking;
#[path = "../../examples/published_tables/row.rs"]
#[allow(dead_code, reason = "nothing is claimed of these counts")]
mod row;
