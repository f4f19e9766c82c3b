//! `cplan verify`: recorded motions against closed forms, dense sampling and tampering.

mod all_joints;
mod bad_input;
mod claims;
mod command;
mod controller;
mod corners;
mod dialects;
mod files;
mod held_joints;
mod limits;
mod motion;
mod recordings;
mod plan_distance;
mod tasks;
mod tool_values;
