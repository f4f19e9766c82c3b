//! Paths, proofs, bounds and tasks, compared with brute force, closed forms and published figures.

mod bound;
mod certificates;
mod certify;
mod checked_bounds;
mod contract;
mod decide;
mod explaining;
mod fastest;
mod followed_lines;
mod free_orders;
mod full_graph;
mod goal_seams;
mod goal_sets;
mod interrupt;
#[path = "../program/verify/judged.rs"]
#[allow(dead_code, reason = "other test programs ask more")]
mod judged;
mod optimum;
mod own_bodies;
mod published;
mod random_tasks;
mod random_worlds;
mod replay;
mod roadmap;
mod search;
mod shortest;
mod slabs;
mod solve;
mod stored;
mod task_optimum;
mod tasks;
mod touching_heights;
mod twins;
mod validity;
mod voronoi;
mod workspaces;
