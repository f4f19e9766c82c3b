//! The program as its users see it: commands, pictures, pages and the server.

mod cli;
mod docs;
mod draw;
mod library_api;
mod own_planner;
mod pictures;
mod rounding;
mod searches;
#[cfg(feature = "serve")]
mod serve;
mod streamlines;
mod verify;
