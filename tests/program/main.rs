//! The program from outside: its commands, pictures, pages and server.

mod cli;
#[path = "../common/mod.rs"]
mod common;
mod docs;
mod draw;
mod front_door;
mod pictures;
mod rounding;
mod roadmaps;
mod search;
#[cfg(feature = "serve")]
mod serve;
mod streamlines;
mod verify;
