//! Benchmarks of the solver and of plain relaxation, in one run: the time from walls to a field with an error of at most 1e-6.
//!
//! The solver is compared with over-relaxation row by row in doubles, with the best constant factor for the scene (found by a
//! search), which stops when its true error is 1e-6. The true error is measured against this solver at 1e-13, which the tests
//! compare with other methods.
//!
//! A pass runs along stretches of free cells without branches. It keeps the last value in a register and adds it last, so the
//! dependency chain per cell has five operations. (As `(1 - w) u + w/4 others + w/4 west`, the chain has two operations, and a
//! pass is three times faster; both times are printed.)
//!
//! Run `cargo bench --bench solve`. At 2048 x 2048, relaxation takes minutes and runs only with `CPLAN_BENCH_LARGE=1`. Its factor
//! is then extrapolated from 512 x 512: `2 - factor` is inversely proportional to the size.

use cplan_multigrid::{Ends, Multigrid};
use criterion::Criterion;
use std::hint::black_box;
use std::time::Instant;

/// The error that both methods must reach.
const ERROR: f64 = 1e-6;

struct Scene {
    name: &'static str,
    cells: [usize; 2],
    free: Vec<bool>,
    goal: usize,
}

impl Scene {
    /// Returns an open area with this many boxes, distributed by the golden ratio. A box takes at most `size` percent
    /// of each side of the area.
    fn boxes(name: &'static str, cells: [usize; 2], boxes: usize, size: usize) -> Self {
        let mut free = vec![true; cells[0] * cells[1]];
        for k in 0..boxes {
            let corner = [0.618_034, 0.754_878].map(|by| (k as f64 * by + 0.2).fract());
            let [top, left] = [0, 1].map(|a| (corner[a] * cells[a] as f64) as usize);
            let [height, width] = [k % 5, k % 3].map(|k| size * (5 + 2 * k) / 13);
            for i in top..(top + (height * cells[0]).div_ceil(100)).min(cells[0]) {
                let right = (left + (width * cells[1]).div_ceil(100)).min(cells[1]);
                free[i * cells[1] + left..i * cells[1] + right].fill(false);
            }
        }
        Self::with_goal(name, cells, free)
    }

    /// Returns an area of rooms. Walls are one cell thick, and doors three cells wide.
    fn rooms(name: &'static str, cells: [usize; 2], room: usize) -> Self {
        let mut free = vec![true; cells[0] * cells[1]];
        for (at, free) in free.iter_mut().enumerate() {
            let [i, j] = [at / cells[1] % room, at % cells[1] % room];
            *free = (i > 0 || j.abs_diff(room / 2) <= 1) && (j > 0 || i.abs_diff(room / 3) <= 1);
        }
        Self::with_goal(name, cells, free)
    }

    fn with_goal(name: &'static str, cells: [usize; 2], free: Vec<bool>) -> Self {
        let wanted = cells[0] * 2 / 5 * cells[1] + cells[1] * 3 / 5;
        let goal = (wanted..free.len()).find(|&cell| free[cell]).expect("a free cell");
        Self { name, cells, free, goal }
    }

    fn solver(&self) -> Multigrid {
        Multigrid::new(self.cells, [Ends::High; 2], &self.free, 0.0)
    }

    fn field(&self, tolerance: f64) -> (Vec<f64>, usize) {
        let solver = self.solver();
        let mut values = vec![0.0; self.free.len()];
        let convergence = solver.goal(self.goal, &mut values, tolerance, &mut solver.workspace());
        (values, convergence.iterations)
    }
}

/// The method that the solver is compared with: relaxation of one cell after another. The values have a frame of zeros.
/// `runs` are the ranges of free cells that are relaxed.
struct Relaxation {
    stride: usize,
    values: Vec<f64>,
    runs: Vec<(usize, usize)>,
}

impl Relaxation {
    fn new(scene: &Scene) -> Self {
        let [rows, columns] = scene.cells;
        let stride = columns + 2;
        let mut values = vec![0.0; (rows + 2) * stride];
        let mut runs: Vec<(usize, usize)> = Vec::new();
        for cell in 0..scene.free.len() {
            let at = (cell / columns + 1) * stride + cell % columns + 1;
            if cell == scene.goal {
                values[at] = 1.0;
            } else if scene.free[cell] {
                match runs.last_mut() {
                    Some(run) if run.1 == at => run.1 += 1,
                    _ => runs.push((at, at + 1)),
                }
            }
        }
        Self { stride, values, runs }
    }

    /// Relaxes all cells once. With `SHORT`, a cell waits less for its western neighbour.
    fn sweep<const SHORT: bool>(&mut self, factor: f64) {
        let (keep, quarter) = (1.0 - factor, 0.25 * factor);
        for &(from, to) in &self.runs {
            let len = to - from;
            let (above, rest) = self.values.split_at_mut(from - 1);
            let (row, below) = rest.split_at_mut(self.stride);
            let (above, below) = (&above[from - self.stride..][..len], &below[1..][..len]);
            let row = &mut row[..len + 2];
            let mut west = row[0];
            for k in 0..len {
                let others = above[k] + below[k] + row[k + 2];
                let old = row[k + 1];
                west = if SHORT {
                    (keep * old + quarter * others) + quarter * west
                } else {
                    old + factor * (0.25 * (others + west) - old)
                };
                row[k + 1] = west;
            }
        }
    }

    fn error(&self, scene: &Scene, exact: &[f64]) -> f64 {
        let columns = scene.cells[1];
        let at = |cell: usize| (cell / columns + 1) * self.stride + cell % columns + 1;
        exact.iter().enumerate().map(|(cell, exact)| (self.values[at(cell)] - exact).abs()).fold(0.0, f64::max)
    }

    /// Returns the number of sweeps after which the error is small enough. Returns `most` if more sweeps would be
    /// needed.
    fn sweeps(scene: &Scene, exact: &[f64], factor: f64, most: usize) -> usize {
        let every = (most / 500).max(1);
        let mut relaxation = Self::new(scene);
        for sweep in 1..most {
            relaxation.sweep::<true>(factor);
            if sweep % every == 0 && relaxation.error(scene, exact) <= ERROR {
                return sweep;
            }
        }
        most
    }

    /// Returns the time in seconds for this many sweeps, the least of several runs.
    fn seconds<const SHORT: bool>(scene: &Scene, factor: f64, sweeps: usize, runs: usize) -> f64 {
        least(runs, || {
            let mut relaxation = Self::new(scene);
            for _ in 0..sweeps {
                relaxation.sweep::<SHORT>(factor);
            }
            relaxation.values
        })
    }
}

/// Returns the best factor, by golden-section search of `log (2 - factor)`.
fn best_factor(scene: &Scene, exact: &[f64]) -> f64 {
    let n = scene.cells[0].max(scene.cells[1]) as f64;
    let sweeps = |log: f64| Relaxation::sweeps(scene, exact, 2.0 - log.exp(), 20 * n as usize);
    let (mut low, mut high) = ((3.0 / n).ln(), (30.0 / n).min(0.9).ln());
    let golden = 0.618_034;
    let mut inner = [high - golden * (high - low), low + golden * (high - low)].map(|log| (log, sweeps(log)));
    for _ in 0..7 {
        if inner[0].1 <= inner[1].1 {
            high = inner[1].0;
            let log = high - golden * (high - low);
            inner = [(log, sweeps(log)), inner[0]];
        } else {
            low = inner[0].0;
            let log = low + golden * (high - low);
            inner = [inner[1], (log, sweeps(log))];
        }
    }
    2.0 - if inner[0].1 <= inner[1].1 { inner[0].0 } else { inner[1].0 }.exp()
}

/// Returns the time in seconds of the fastest of several runs.
fn least<T>(runs: usize, mut run: impl FnMut() -> T) -> f64 {
    (0..runs)
        .map(|_| {
            let start = Instant::now();
            black_box(run());
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}

/// Prints the times of the solver in one line: with new memory and with a reused workspace. If `factor` is given, also
/// prints the times of relaxation.
fn compare(scene: &Scene, runs: usize, factor: Option<f64>) {
    let exact = scene.field(1e-13).0;
    let solver = scene.solver();
    let mut workspace = solver.workspace();
    let (field, iterations) = scene.field(ERROR);
    let error = field.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(error <= ERROR, "the error is {error}");
    let whole = least(runs, || scene.field(ERROR));
    let setup = least(runs, || scene.solver());
    let mut values = vec![0.0; scene.free.len()];
    let solve = least(runs, || {
        values.fill(0.0);
        solver.goal(scene.goal, &mut values, ERROR, &mut workspace)
    });
    let [rows, columns] = scene.cells;
    let cells = (rows * columns) as f64;
    let again = least(runs, || {
        values.fill(0.0);
        scene.solver().goal(scene.goal, &mut values, ERROR, &mut workspace)
    });
    println!(
        "{} {rows} x {columns}: {:.3} ms from walls to field ({:.0} ns a cell), {:.3} with a workspace kept ({:.0}); setup {:.3}, a goal more {:.3} ms; {iterations} iterations, error {error:.1e}",
        scene.name,
        whole * 1e3,
        whole * 1e9 / cells,
        again * 1e3,
        again * 1e9 / cells,
        setup * 1e3,
        solve * 1e3,
    );
    let Some(factor) = factor else { return };
    // On the largest grid, each takes minutes, so it runs once.
    let sweep_runs = if rows > 1000 { 1 } else { runs.min(5) };
    let report = |name: &str, factor: f64, sweeps: usize| {
        let (plain, short) = (
            Relaxation::seconds::<false>(scene, factor, sweeps, sweep_runs),
            Relaxation::seconds::<true>(scene, factor, sweeps, sweep_runs),
        );
        println!(
            "    {name} {factor:.4}: {sweeps} sweeps, {:.2} ms (short chain {:.2}); ratio {:.1} ({:.1}), with a workspace kept {:.1} ({:.1})",
            plain * 1e3,
            short * 1e3,
            plain / whole,
            short / whole,
            plain / again,
            short / again
        );
    };
    report("over-relaxation", factor, Relaxation::sweeps(scene, &exact, factor, 20 * rows.max(columns)));
    if rows < 100 {
        report("Gauss-Seidel", 1.0, Relaxation::sweeps(scene, &exact, 1.0, 20_000));
    }
}

/// Measures the number of updates per second. In each update, an obstacle moves by one cell, the walls are rebuilt, and the last
/// field is the initial guess.
fn updates(scene: &Scene) {
    let [rows, columns] = scene.cells;
    let steps = columns - 20;
    let mut seconds = f64::INFINITY;
    let mut worst = 0.0_f64;
    let mut iterations = 0;
    for _ in 0..5 {
        let mut values = vec![0.0; scene.free.len()];
        let mut workspace = scene.solver().workspace();
        let mut spent = 0.0;
        iterations = 0;
        for at in 5..5 + steps {
            let mut free = scene.free.clone();
            for i in rows * 3 / 4..rows * 3 / 4 + 4 {
                free[i * columns + at..i * columns + at + 4].fill(false);
            }
            let start = Instant::now();
            let solver = Multigrid::new(scene.cells, [Ends::High; 2], &free, 0.0);
            let convergence = solver.goal(scene.goal, &mut values, ERROR, &mut workspace);
            spent += start.elapsed().as_secs_f64();
            iterations += convergence.iterations;
            let mut exact = vec![0.0; values.len()];
            solver.goal(scene.goal, &mut exact, 1e-13, &mut workspace);
            worst = values.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(worst, f64::max);
        }
        seconds = seconds.min(spent / steps as f64);
    }
    println!(
        "updates {rows} x {columns}: {:.0} a second, {:.1} iterations each, error at most {worst:.1e}",
        1.0 / seconds,
        iterations as f64 / steps as f64
    );
}

fn main() {
    let only = std::env::args().skip(1).find(|arg| !arg.starts_with('-'));
    if only.is_none_or(|only| "compare".contains(&only)) {
        let boxes = |n: usize| Scene::boxes("boxes", [n, n], 10, 6);
        let small = Scene::boxes("boxes", [65, 85], 10, 6);
        compare(&small, 200, Some(best_factor(&small, &small.field(1e-13).0)));
        updates(&small);
        compare(&Scene::rooms("rooms", [65, 85], 16), 200, None);
        let middle = boxes(512);
        let factor = best_factor(&middle, &middle.field(1e-13).0);
        compare(&middle, 10, Some(factor));
        compare(&Scene::rooms("rooms", [512, 512], 125), 10, None);
        compare(&boxes(1024), 5, None);
        let large = std::env::var_os("CPLAN_BENCH_LARGE").is_some();
        compare(&boxes(2048), 3, large.then_some(2.0 - (2.0 - factor) / 4.0));
        compare(&Scene::rooms("rooms", [2048, 2048], 509), 3, None);
        compare(&boxes(4096), 2, None);
    }
    let mut criterion = Criterion::default().configure_from_args();
    let scene = Scene::boxes("boxes", [65, 85], 10, 6);
    let solver = scene.solver();
    let mut workspace = solver.workspace();
    let mut values = vec![0.0; scene.free.len()];
    let mut group = criterion.benchmark_group("solve");
    group.bench_function("walls to field 65x85", |b| b.iter(|| black_box(&scene).field(ERROR)));
    group.bench_function("another goal 65x85", |b| {
        b.iter(|| {
            values.fill(0.0);
            solver.goal(black_box(scene.goal), &mut values, ERROR, &mut workspace)
        });
    });
    group.finish();
    criterion.final_summary();
}
