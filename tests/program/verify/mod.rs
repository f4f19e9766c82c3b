//! `cplan verify`: recorded motions against closed forms, dense sampling and tampering.

mod bad_input;
mod command;
mod controller;
mod dialects;
mod files;
mod limits;
mod motion;
mod tasks;
