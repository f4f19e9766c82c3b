//! The wave on grids of several kinds, beside a plain queue in the same run.

use super::boxes;
use cplan::cspace::{Grid, Proves};
use cplan::field::{FreeCells, Neighborhood, StepLabels, UNREACHED};
use cplan::space::{JointRange, Topology};
use criterion::{Criterion, Throughput};
use std::collections::VecDeque;
use std::hint::black_box;

/// A simple generator of pseudorandom numbers (xorshift, Marsaglia 2003), so that scenes are the same in every run.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n as u64) as usize
    }
}

fn square(n: usize, blocked: Vec<bool>) -> Grid {
    let topology = Topology::new([JointRange::Interval { lower: 0.0, upper: 1.0 }; 2]);
    Grid { topology, proves: Proves::Sampled, cells: [n, n], blocked }
}

/// Returns a grid of rooms of `room x room` cells. Of four walls, three have a door.
fn rooms(n: usize, room: usize, door: usize) -> Grid {
    let mut numbers = Numbers(987_654_321_987);
    let is_wall = |c: usize| (c / n).is_multiple_of(room) || (c % n).is_multiple_of(room);
    let mut blocked: Vec<bool> = (0..n * n).map(is_wall).collect();
    for (i, j) in (0..n / room).flat_map(|i| (0..n / room).map(move |j| (i * room, j * room))) {
        for is_row in [true, false] {
            let at = 1 + numbers.below(room - door - 1);
            if numbers.below(4) > 0 {
                for k in at..at + door {
                    blocked[if is_row { i * n + j + k } else { (i + k) * n + j }] = false;
                }
            }
        }
    }
    square(n, blocked)
}

/// Returns a grid with boxes of 8 to 32 cells, which cover a fifth of the area.
fn clutter(n: usize) -> Grid {
    let mut numbers = Numbers(88_172_645_463_325_252);
    let mut blocked = vec![false; n * n];
    for _ in 0..n * n / 1600 {
        let [height, width] = [(); 2].map(|()| 8 + numbers.below(24));
        let [i, j] = [height, width].map(|size| numbers.below(n - size));
        (i..i + height).for_each(|i| blocked[i * n + j..i * n + j + width].fill(true));
    }
    square(n, blocked)
}

/// Returns a grid with a share of blocked cells at random places.
fn noise(n: usize, percent: usize) -> Grid {
    let mut numbers = Numbers(12_345_678_912_345);
    square(n, (0..n * n).map(|_| numbers.below(100) < percent).collect())
}

/// Returns a maze in which any two cells are connected by exactly one way. It is made by a random depth-first walk.
/// Corridors have this width, and walls are one cell thick.
fn maze(n: usize, width: usize) -> Grid {
    let (size, pitch) = (n / (width + 1), width + 1);
    let mut numbers = Numbers(5_555_555);
    let mut blocked = vec![true; n * n];
    let mut is_new = vec![true; size * size];
    let mut way = vec![0_usize];
    while let Some(&cell) = way.last() {
        is_new[cell] = false;
        let (i, j) = (cell / size, cell % size);
        let around = [(i > 0, -1, 0), (i + 1 < size, 1, 0), (j > 0, 0, -1), (j + 1 < size, 0, 1)];
        let to = |di: isize, dj: isize| i.wrapping_add_signed(di) * size + j.wrapping_add_signed(dj);
        let open: Vec<usize> = around.iter().filter(|a| a.0).map(|a| to(a.1, a.2)).filter(|&c| is_new[c]).collect();
        if open.is_empty() {
            way.pop();
            continue;
        }
        let next = open[numbers.below(open.len())];
        let [top, left] = [i.min(next / size), j.min(next % size)].map(|k| k * pitch);
        let [bottom, right] = [i.max(next / size), j.max(next % size)].map(|k| k * pitch + width);
        (top..bottom).for_each(|i| blocked[i * n + left..i * n + right].fill(false));
        way.push(next);
    }
    square(n, blocked)
}

/// The labels that a plain queue computes, on a grid with a frame so that no step needs a test for a limit. The labels
/// are prepared beforehand, like the bits of the library's wave: 0 if blocked, [`UNREACHED`] if free.
struct Plain {
    stride: usize,
    columns: usize,
    framed: Vec<u32>,
    is_torus: bool,
}

/// Label of blocked cells and of copies. The labels of the plain queue begin above it.
const WALL: u32 = 0;
const TWIN: u32 = 1;

impl Plain {
    fn new(grid: &Grid) -> Self {
        let [rows, columns] = grid.cells;
        let stride = columns + 2;
        let is_torus = grid.topology.ranges[0].is_circle();
        let mut framed = vec![if is_torus { TWIN } else { WALL }; (rows + 2) * stride];
        for (cell, &blocked) in grid.blocked.iter().enumerate() {
            framed[(cell / columns + 1) * stride + cell % columns + 1] = if blocked { WALL } else { UNREACHED };
        }
        Self { stride, columns, framed, is_torus }
    }

    fn labels(&self, source: usize) -> Vec<u32> {
        let (stride, rows) = (self.stride, self.framed.len() / self.stride - 2);
        let mut labels = self.framed.clone();
        let mut queue = VecDeque::new();
        let source = (source / self.columns + 1) * stride + source % self.columns + 1;
        labels[source] = TWIN + 1;
        queue.push_back(source);
        while let Some(from) = queue.pop_front() {
            let label = labels[from] + 1;
            for mut to in [from - stride, from + stride, from - 1, from + 1] {
                if self.is_torus && labels[to] == TWIN {
                    let wrap = |k: usize, n: usize| {
                        if k == 0 {
                            n
                        } else if k > n {
                            1
                        } else {
                            k
                        }
                    };
                    to = wrap(to / stride, rows) * stride + wrap(to % stride, self.columns);
                }
                if labels[to] == UNREACHED {
                    labels[to] = label;
                    queue.push_back(to);
                }
            }
        }
        labels
    }
}

/// A function that returns a grid with this number of cells along each axis.
type Scene = fn(usize) -> Grid;

/// Measures reached cells per second; 1000 Melem/s are 1 ns per cell.
pub fn wave(c: &mut Criterion) {
    for n in [1024, 4096] {
        let mut group = c.benchmark_group(format!("wave {n}^2"));
        group.sample_size(10);
        let scenes: [(&str, Scene); 9] = [
            ("free", |n| square(n, vec![false; n * n])),
            ("boxes on a torus", boxes),
            ("clutter", clutter),
            ("rooms of 128", |n| rooms(n, 128, 16)),
            ("rooms of 64", |n| rooms(n, 64, 4)),
            ("noise of 5 percent", |n| noise(n, 5)),
            ("noise of 30 percent", |n| noise(n, 30)),
            ("maze of 16", |n| maze(n, 16)),
            ("maze of 1", |n| maze(n, 1)),
        ];
        for (name, scene) in scenes {
            let grid = scene(n);
            let (free, plain) = (FreeCells::new(&grid), Plain::new(&grid));
            let middle = (n / 2) * n + n / 3;
            let source = (middle..n * n).find(|&cell| free.is_free(cell)).unwrap_or(0);
            let reached = StepLabels::new(&free, &[source], Neighborhood::Four).reached();
            group.throughput(Throughput::Elements(reached as u64));
            group.bench_function(format!("{name}, plain queue"), |b| b.iter(|| plain.labels(black_box(source))));
            for (labels, neighborhood) in [("labels", Neighborhood::Four), ("8 neighbours", Neighborhood::Eight)] {
                if neighborhood == Neighborhood::Four || name == "boxes on a torus" {
                    group.bench_function(format!("{name}, {labels}"), |b| {
                        b.iter(|| StepLabels::new(&free, black_box(&[source]), neighborhood));
                    });
                }
            }
        }
        group.bench_function("memory alone", |b| b.iter(|| vec![black_box(UNREACHED); n * n]));
    }
}
