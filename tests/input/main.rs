//! Reading robots, worlds, tasks and maps, and the diagnostics of invalid ones.

mod arms;
mod errors;
mod hints;
mod inspect;
mod mutations;
mod maps;
mod packages;
mod pairs;
mod places;
mod real_urdfs;
mod tasks;
mod tool_values;
mod world_schema;
