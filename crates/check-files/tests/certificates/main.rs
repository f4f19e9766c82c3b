//! The checker of certificates: true ones, falsified ones, and readers of files, against oracles of their own.

mod common;

mod arches;
mod areas;
mod attack_found;
mod attack_tasks;
mod bound;
mod by_hand;
mod files;
mod found;
mod infeasible;
mod layers;
mod lines;
mod moving;
mod own_body;
mod reading;
mod robots;
mod task_lines;
mod tasks;
mod tool_values;
mod turns;
