//! Building a configuration space: cplan's exact rows beside parry2d's collision tests, cell by cell, on one core.

use crate::rounds::Rounds;
use crate::torus::Checker;
use crate::{Result, brute_force, scenes};
use cplan::cspace::{bitmap, grid_from_slices, outer_grid, regions};
use cplan::space::Configuration;
use serde_json::{Value, json};

/// The initial margin of the planners' polygons, metres.
const MARGIN: f64 = 1e-3;

/// Number of runs of cplan's contenders for each run of parry2d's, which take hundreds of times as long.
const REPEATS: usize = 5;

pub fn run(urdf: &str, world: &str, cells: usize, rounds: usize) -> Result<Value> {
    let scene = scenes::scene(urdf, world)?;
    let arm = brute_force::Arm::new(&scenes::bars(&scene)?, &scenes::obstacles(&scene));
    let shape = [cells; 2];
    let grid = grid_from_slices(&scene, shape, 0.0);
    let first: Vec<f64> = (0..cells).map(|i| grid.center(i * cells)[0]).collect();
    let second: Vec<f64> = (0..cells).map(|j| grid.center(j)[1]).collect();
    let mut times = Rounds::default();
    let mut tested = Vec::new();
    for _ in 0..rounds {
        tested = times.time("parry2d", || arm.cells(&first, &second));
        for _ in 0..REPEATS {
            times.time("bitmap", || bitmap(&scene, shape, 0.0));
            times.time("rows", || grid_from_slices(&scene, shape, 0.0));
            times.time("outer", || outer_grid(&scene, shape, 0.0));
            times.time("regions", || regions(&scene, MARGIN, Configuration::new(0.0, 0.0), 1));
        }
    }
    let bits = bitmap(&scene, shape, 0.0);
    let blocked = |at: usize| bits.blocked(at / cells, at % cells);
    let differ: Vec<usize> = (0..cells * cells).filter(|&at| tested[at] != blocked(at)).collect();
    // If single precision disagrees, double precision decides.
    let checker = Checker::new(&scenes::bars(&scene)?, &scenes::obstacles(&scene));
    let in_double = |at: usize| checker.collides([first[at / cells], second[at % cells]]);
    let differ_double = differ.iter().filter(|&&at| in_double(at) != blocked(at)).count();
    let polygons = regions(&scene, MARGIN, Configuration::new(0.0, 0.0), 1);
    let corners: usize =
        polygons.free.iter().map(|p| p.outer.len() + p.holes.iter().map(Vec::len).sum::<usize>()).sum();
    Ok(json!({
        "times": times.into_json(),
        "cells": cells * cells,
        "blocked": bits.count(),
        "differ": differ.len(),
        "differ_double": differ_double,
        "corners": corners,
    }))
}
