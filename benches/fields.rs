//! Grid planners: waves at 1024 x 1024 and 4096 x 4096, and the shortening of a path; fields among robots that move.

mod moving;
mod wave;

use cplan::cspace::{Grid, Proves};
use cplan::field::FreeCells;
use cplan::planner::{PathKind, Planner, Query, Wavefront};
use cplan::space::{JointRange, Topology};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

/// Returns a torus of `n x n` cells with 25 boxes, distributed by the golden ratio.
fn boxes(n: usize) -> Grid {
    let corner = |k: usize, by: f64| (k as f64 * by).fract() * n as f64;
    let mut blocked = vec![false; n * n];
    for k in 0..25 {
        let (top, left) = (corner(k, 0.618_034) as usize, corner(k, 0.754_878) as usize);
        let (height, width) = (n * (3 + k % 7) / 100, n * (3 + k % 5) / 100);
        for i in top..(top + height).min(n) {
            blocked[i * n + left..i * n + (left + width).min(n)].fill(true);
        }
    }
    Grid { topology: Topology::new([JointRange::Circle; 2]), proves: Proves::Sampled, cells: [n, n], blocked }
}

/// Returns the first and the middle free cell.
fn ends(grid: &Grid) -> (usize, usize) {
    let free: Vec<usize> = (0..grid.blocked.len()).filter(|&cell| !grid.blocked[cell]).collect();
    (free[0], free[free.len() / 2])
}

fn fields(c: &mut Criterion) {
    let grid = boxes(1024);
    let (start, goal) = ends(&grid);
    let query = Query { start: grid.center(start), goals: grid.center(goal).into() };
    let free = FreeCells::new(&grid);
    c.bench_function("wavefront/build 1024^2", |b| b.iter(|| FreeCells::new(black_box(&grid))));
    for path in PathKind::ALL {
        let planner = Wavefront { path, ..Wavefront::default() };
        let name = format!("wavefront/query 1024^2, {path} path");
        c.bench_function(&name, |b| b.iter(|| planner.query(&grid, &free, black_box(&query))));
    }
}

criterion_group!(benches, wave::wave, fields, moving::moving);
criterion_main!(benches);
