//! Distances and harmonic fields on a grid by cplan's solvers. The cells and the results are written to files, for
//! peers in other languages and for the comparison.

use crate::rounds::Rounds;
use crate::{Result, scenes};
use cplan::cspace::{Grid, Proves, grid_from_slices};
use cplan::field::multigrid::{Ends, Multigrid};
use cplan::field::search::{Order, Search};
use cplan::field::{Component, FreeCells, Lattice, Neighborhood, StepLabels, harmonic};
use cplan::space::{JointRange, Configuration, Topology};
use cplan_cases::mazes;
use serde_json::{Value, json};
use std::path::Path;

/// Greatest error to which the multigrid method solves.
const ERROR: f64 = 1e-6;

/// Returns a rectangle with ten boxes distributed by the golden ratio.
pub fn boxes(cells: usize) -> Grid {
    let mut blocked = vec![false; cells * cells];
    for k in 0..10_usize {
        let [top, left] = [0.618_034, 0.754_878].map(|by| ((k as f64 * by + 0.2).fract() * cells as f64) as usize);
        let [height, width] = [k % 5, k % 3].map(|k| (6 * (5 + 2 * k) * cells).div_ceil(1300));
        for i in top..(top + height).min(cells) {
            blocked[i * cells + left..i * cells + (left + width).min(cells)].fill(true);
        }
    }
    rectangle(cells, blocked)
}

/// Returns a maze without loops, whose corridors are one cell wide.
pub fn maze(cells: usize) -> Grid {
    rectangle(cells, mazes::maze(cells, 0))
}

/// Returns the arm's configuration space, cut open at half a turn, because the peers here do not support a torus.
pub fn of_arm(urdf: &str, world: &str, cells: usize) -> Result<Grid> {
    Ok(rectangle(cells, grid_from_slices(&scenes::scene(urdf, world)?, [cells; 2], 0.0).blocked))
}

fn rectangle(cells: usize, blocked: Vec<bool>) -> Grid {
    let topology = Topology::new([JointRange::Interval { lower: 0.0, upper: 1.0 }; 2]);
    Grid { topology, proves: Proves::Sampled, cells: [cells; 2], blocked }
}

pub fn run(grid: Grid, rounds: usize, directory: &str) -> Result<Value> {
    let free: Vec<bool> = grid.blocked.iter().map(|blocked| !blocked).collect();
    let wanted = grid.locate(Configuration::new(0.4, 0.6));
    let goal = (wanted..free.len()).chain(0..wanted).find(|&cell| free[cell]).ok_or("there is no free cell")?;
    let ends = [Ends::High; 2];
    let mut times = Rounds::default();
    let mut values = vec![0.0; free.len()];
    let mut results = None;
    for _ in 0..rounds {
        let packed = times.time("pack", || FreeCells::new(&grid));
        let steps = times.time("wave", || StepLabels::new(&packed, &[goal], Neighborhood::Four));
        let all = usize::MAX;
        let ways = times.time("dijkstra", || Search::new(&packed, Neighborhood::Eight, Order::Dijkstra, &[goal], all));
        let solver = times.time("multigrid setup", || Multigrid::new(grid.cells, ends, &free, 0.0));
        let mut workspace = solver.workspace();
        // The first solve touches the workspace's fresh memory, as any first solve does. The second has one more goal.
        for stage in ["multigrid solve", "multigrid again"] {
            values.fill(0.0);
            times.time(stage, || solver.goal(goal, &mut values, ERROR, &mut workspace));
        }
        let field = times.time("harmonic", || {
            let lattice = Lattice::from(&grid);
            let component = Component::new(&lattice, lattice.wave(&[goal]));
            let field = harmonic(&component);
            (component, field)
        });
        results = Some((steps, ways, field));
    }
    let (steps, ways, (component, field)) = results.ok_or("no rounds")?;
    let write = |name: &str, bytes: Vec<u8>| std::fs::write(Path::new(directory).join(name), bytes);
    write("free.u8", free.iter().map(|&free| u8::from(free)).collect())?;
    write("multigrid.f64", values.iter().flat_map(|value| value.to_le_bytes()).collect())?;
    write("steps.u32", steps.labels().iter().flat_map(|label| label.to_le_bytes()).collect())?;
    // Values of the harmonic planner's field are below the range of doubles: take natural logarithms.
    let ln = |cell: usize| component.position_of(cell).map_or(f64::NEG_INFINITY, |at| field.potential.ln(at));
    write("harmonic.f64", (0..free.len()).flat_map(|cell| ln(cell).to_le_bytes()).collect())?;
    let costs = (0..free.len()).map(|cell| ways.cost(cell).map_or(f64::INFINITY, |cost| cost.value()));
    write("dijkstra.f64", costs.flat_map(f64::to_le_bytes).collect())?;
    Ok(json!({
        "times": times.into_json(),
        "cells": grid.cells,
        "goal": goal,
        "error": ERROR,
        "free": free.iter().filter(|&&free| free).count(),
    }))
}
