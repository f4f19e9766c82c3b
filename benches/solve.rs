//! The fast solver beside plain relaxation, in one run: time from walls to a field whose greatest error is 1e-6.
//!
//! The yardstick is over-relaxation row by row in doubles, with the best constant factor that a search finds for the
//! scene, stopped where its true error is 1e-6; a pass goes along runs of free cells, so that it has no branch and no
//! index but its own. `cargo bench --bench solve`; the greatest size only with `CPLAN_BENCH_LARGE=1` (minutes).

use cplan::field::multigrid::{Ends, Multigrid};
use criterion::Criterion;
use std::hint::black_box;
use std::time::Instant;

/// What both are held to.
const ERROR: f64 = 1e-6;

struct Scene {
    name: &'static str,
    cells: [usize; 2],
    free: Vec<bool>,
    goal: usize,
}

impl Scene {
    /// An open place with boxes scattered by the golden ratio, `size` (in percent) and less.
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

    /// Rooms with walls one cell thick and doors three cells wide.
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

/// The yardstick: values with a frame of zeros, and the runs of cells that are relaxed.
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

    fn sweep(&mut self, factor: f64) {
        let quarter = 0.25 * factor;
        let keep = 1.0 - factor;
        for &(from, to) in &self.runs {
            let len = to - from;
            let (above, rest) = self.values.split_at_mut(from - 1);
            let (row, below) = rest.split_at_mut(self.stride - 1 + 1);
            let above = &above[from - self.stride..][..len];
            let below = &below[..len];
            let mut west = row[0];
            for k in 0..len {
                // The sum without the value just made is ready before that is: the chain from cell to cell is short.
                let others = above[k] + below[k] + row[k + 2];
                west = (keep * row[k + 1] + quarter * others) + quarter * west;
                row[k + 1] = west;
            }
        }
    }

    fn error(&self, scene: &Scene, exact: &[f64]) -> f64 {
        let columns = scene.cells[1];
        let at = |cell: usize| (cell / columns + 1) * self.stride + cell % columns + 1;
        exact.iter().enumerate().map(|(cell, exact)| (self.values[at(cell)] - exact).abs()).fold(0.0, f64::max)
    }

    /// Sweeps until the error is met, looked at every so often; `most` if it is not before.
    fn sweeps(scene: &Scene, exact: &[f64], factor: f64, most: usize) -> usize {
        let every = (most / 500).max(1);
        let mut relaxation = Self::new(scene);
        for sweep in 1..most {
            relaxation.sweep(factor);
            if sweep % every == 0 && relaxation.error(scene, exact) <= ERROR {
                return sweep;
            }
        }
        most
    }

    /// Seconds for so many sweeps.
    fn seconds(scene: &Scene, factor: f64, sweeps: usize) -> f64 {
        let start = Instant::now();
        let mut relaxation = Self::new(scene);
        for _ in 0..sweeps {
            relaxation.sweep(factor);
        }
        black_box(&relaxation.values);
        start.elapsed().as_secs_f64()
    }
}

/// The best factor, by golden-section search of `log (2 - factor)`, and its sweeps.
fn best_factor(scene: &Scene, exact: &[f64]) -> (f64, usize) {
    let most = 40 * scene.cells[0].max(scene.cells[1]);
    let sweeps = |log: f64| Relaxation::sweeps(scene, exact, 2.0 - log.exp(), most);
    let n = scene.cells[0].max(scene.cells[1]) as f64;
    let (mut low, mut high) = ((2.0 / n).ln(), (30.0 / n).min(0.9).ln());
    let golden = 0.618_034;
    let mut inner = [high - golden * (high - low), low + golden * (high - low)].map(|log| (log, sweeps(log)));
    for _ in 0..8 {
        if inner[0].1 <= inner[1].1 {
            high = inner[1].0;
            inner[1] = inner[0];
            let log = high - golden * (high - low);
            inner[0] = (log, sweeps(log));
        } else {
            low = inner[0].0;
            inner[0] = inner[1];
            let log = low + golden * (high - low);
            inner[1] = (log, sweeps(log));
        }
    }
    let best = if inner[0].1 <= inner[1].1 { inner[0] } else { inner[1] };
    (2.0 - best.0.exp(), best.1)
}

/// Least seconds of some runs.
fn least<T>(runs: usize, mut run: impl FnMut() -> T) -> f64 {
    (0..runs)
        .map(|_| {
            let start = Instant::now();
            black_box(run());
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}

fn compare(scene: &Scene, runs: usize, yardstick: bool) {
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
    print!(
        "{:>8} {rows}x{columns}: {:9.3} ms = setup {:.3} + solve {:.3} ({iterations} iterations, error {error:.1e}, {:.0} ns/cell)",
        scene.name,
        whole * 1e3,
        setup * 1e3,
        solve * 1e3,
        whole * 1e9 / (rows * columns) as f64
    );
    if yardstick {
        let (factor, sweeps) = best_factor(scene, &exact);
        let seconds =
            (0..runs.min(5)).map(|_| Relaxation::seconds(scene, factor, sweeps)).fold(f64::INFINITY, f64::min);
        print!("; SOR {factor:.4}: {sweeps} sweeps, {:.3} ms; ratio {:.1}", seconds * 1e3, seconds / whole);
        if rows < 100 {
            let sweeps = Relaxation::sweeps(scene, &exact, 1.0, 100_000);
            let seconds = (0..3).map(|_| Relaxation::seconds(scene, 1.0, sweeps)).fold(f64::INFINITY, f64::min);
            print!("; Gauss-Seidel: {sweeps} sweeps, {:.3} ms", seconds * 1e3);
        }
    }
    println!();
}

fn main() {
    let only = std::env::args().skip(1).find(|arg| !arg.starts_with('-'));
    let wanted = |name: &str| only.as_ref().is_none_or(|only| name.contains(only.as_str()));
    let large = std::env::var_os("CPLAN_BENCH_LARGE").is_some();
    let fast = std::env::var_os("CPLAN_BENCH_FAST").is_some();
    for (cells, runs, yardstick) in [
        ([65, 85], 200, true),
        ([128, 128], 50, true),
        ([512, 512], 10, true),
        ([1024, 1024], 5, false),
        ([2048, 2048], 3, large),
    ] {
        if wanted("compare") {
            compare(&Scene::boxes("boxes", cells, 10, 16), runs, yardstick && !fast);
            compare(&Scene::rooms("rooms", cells, cells[0] / 4 - 3), runs, false);
        }
    }
    let mut criterion = Criterion::default().configure_from_args();
    let scene = Scene::boxes("boxes", [65, 85], 10, 16);
    let mut group = criterion.benchmark_group("solve");
    group.bench_function("walls to field 65x85", |b| b.iter(|| black_box(&scene).field(ERROR)));
    group.finish();
    criterion.final_summary();
}
