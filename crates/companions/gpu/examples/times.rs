//! Compares times on this machine's GPU with those of Silva 2011 (chapter 6: 85 x 65 cells, until the sum of squared
//! changes of a sweep is below 1e-6). Also prints nanoseconds per cell on large open squares: `cargo run --release -p
//! cplan-gpu --example times -- 2048 8192`.
//!
//! The source does not publish the positions of its robots. Here the field is empty, with a goal in the middle of one
//! end, and ten robots where drifts are local. So the numbers of sweeps differ from the source.

use cplan_fields::{Boundary, CellEquations, Factor, Measure, Order, Relaxation, Stopping};
use cplan_gpu::{Gpu, GpuError, GridEquations, Multigrid};
use std::time::Instant;

/// Rows and columns of the field in the source.
const FIELD_SIZE: [usize; 2] = [65, 85];

/// Number of runs of each benchmark. The fastest run counts.
const RUNS_PER_ROW: usize = 10;

/// The drift of a cell, by its row and column.
type Drift = fn(usize, usize) -> [f64; 2];

fn none(_: usize, _: usize) -> [f64; 2] {
    [0.0; 2]
}

fn along(_: usize, _: usize) -> [f64; 2] {
    [0.0, 0.5]
}

/// Returns a drift that acts only within six cells of ten robots.
fn local(i: usize, j: usize) -> [f64; 2] {
    let near = (0..10).any(|k| i.abs_diff(6 + 13 * (k % 5)).pow(2) + j.abs_diff(20 + 40 * (k / 5)).pow(2) < 36);
    if near { [0.0, 0.8] } else { [0.0; 2] }
}

/// Returns a problem with walls of value 1 around it and a goal of value 0.
fn problem([rows, columns]: [usize; 2], drift: Drift, is_upwind: bool) -> Result<GridEquations, GpuError> {
    let side = |b: f64| if is_upwind { 1.0 + b.max(0.0) } else { 1.0 + 0.5 * b };
    let weights = |cell: usize| {
        let b = drift(cell / columns, cell % columns);
        let weights = [side(-b[0]), side(b[0]), side(-b[1]), side(b[1])];
        let sum: f64 = weights.iter().sum();
        weights.map(|weight| weight / sum)
    };
    let is_plain = std::ptr::fn_addr_eq(drift, none as Drift);
    let equations =
        if is_plain { CellEquations::Mean } else { CellEquations::Weights((0..rows * columns).map(weights).collect()) };
    let mut unknown = vec![true; rows * columns];
    unknown[rows / 2 * columns + columns - 1] = false;
    GridEquations::new([rows, columns], [Boundary::High; 2], 1.0, vec![0.0; rows * columns], unknown, equations)
}

/// Returns the shortest time of several runs, in milliseconds, with the result.
fn timed<T>(runs: usize, mut work: impl FnMut() -> Result<T, GpuError>) -> Result<(f64, T), GpuError> {
    let mut best: Option<(f64, T)> = None;
    for _ in 0..runs.max(1) {
        let begun = Instant::now();
        let done = work()?;
        let time = begun.elapsed().as_secs_f64() * 1e3;
        if best.as_ref().is_none_or(|best| time < best.0) {
            best = Some((time, done));
        }
    }
    best.ok_or_else(|| GpuError::Refused("no run".into()))
}

/// A benchmark: name, drift, upwind differences or not, relaxation, and the published times on a CPU and on a GPU.
type Row = (&'static str, Drift, bool, Relaxation, &'static str, &'static str);

fn main() -> Result<(), GpuError> {
    let gpu = Gpu::open()?;
    let kind = if gpu.is_software() { "all in software, on the CPU: no times of a GPU" } else { "hardware" };
    println!("{} ({kind})\n", gpu.adapter());
    println!("{} x {} cells, milliseconds with the way there and back", FIELD_SIZE[1], FIELD_SIZE[0]);
    println!("{:<28} {:>8} {:>8} {:>10} {:>7}", "", "CPU 2011", "GPU 2011", "here", "sweeps");
    let stopping = Stopping { measure: Measure::SumOfSquares, below: 1e-6, max_sweeps: 10_000 };
    let gs = Relaxation::gauss_seidel(Order::RedBlack);
    let sor = Relaxation::sor(Factor::Formula, Order::RedBlack);
    let (jacobi, weighted) = (Relaxation::JACOBI, Relaxation::weighted_jacobi(0.8));
    let rows: [Row; 12] = [
        ("harmonic, GS", none, false, gs, "5.38", "0.62"),
        ("harmonic, SOR", none, false, sor, "5.20", "0.49"),
        ("harmonic, Jacobi", none, false, jacobi, "-", "0.60"),
        ("harmonic, weighted Jacobi", none, false, weighted, "-", "0.39"),
        ("oriented, central, GS", along, false, gs, "8.04", "0.69"),
        ("oriented, central, SOR", along, false, sor, "8.20", "0.55"),
        ("oriented, upwind, GS", along, true, gs, "11.01", "0.75"),
        ("oriented, upwind, SOR", along, true, sor, "7.91", "0.48"),
        ("local, central, GS", local, false, gs, "29.18", "1.16"),
        ("local, central, SOR", local, false, sor, "21.30", "0.70"),
        ("local, upwind, GS", local, true, gs, "28.41", "1.07"),
        ("local, upwind, SOR", local, true, sor, "16.92", "0.85"),
    ];
    for (name, drift, is_upwind, relaxation, cpu, published) in rows {
        let problem = problem(FIELD_SIZE, drift, is_upwind)?;
        let (time, relaxed) = timed(RUNS_PER_ROW, || gpu.relax(&problem, &relaxation, &stopping))?;
        println!("{name:<28} {cpu:>8} {published:>8} {time:>10.2} {:>7}", relaxed.sweeps);
    }
    println!("\nopen squares, nanoseconds a cell: of a red-black sweep, and of multigrid until 1e-10");
    let sizes: Vec<usize> = std::env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    let sizes = if sizes.is_empty() { vec![256, 512] } else { sizes };
    for n in sizes {
        let problem = problem([n; 2], none, false)?;
        let sweeps = |max_sweeps| Stopping { below: 0.0, max_sweeps, ..stopping };
        // Subtract the transfers to and from the GPU, which both runs contain.
        let (few, _) = timed(3, || gpu.relax(&problem, &gs, &sweeps(64)))?;
        let (many, _) = timed(3, || gpu.relax(&problem, &gs, &sweeps(192)))?;
        let cells = (n * n) as f64;
        let (solved, solution) = timed(1, || gpu.solve(&problem, &Multigrid { below: 1e-10, ..Multigrid::default() }))?;
        let how = if solution.converged { "" } else { ", not converged" };
        let sweep = (many - few) * 1e6 / (128.0 * cells);
        println!("{n} x {n}: {sweep:.2}; {:.0} in {} cycles{how}", solved * 1e6 / cells, solution.cycles);
    }
    Ok(())
}
