//! Benchmarks of the wave over a 1024 x 1024 lattice, and of harmonic fields of rooms, mazes and a spiral.

use cplan_cases::mazes;
use cplan_harmonic::{Component, Lattice, harmonic};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;

/// Returns the blocked cells of a torus of `n x n` cells with 25 boxes, distributed by the golden ratio.
fn boxes(n: usize) -> Vec<bool> {
    let corner = |k: usize, by: f64| (k as f64 * by).fract() * n as f64;
    let mut blocked = vec![false; n * n];
    for k in 0..25 {
        let (top, left) = (corner(k, 0.618_034) as usize, corner(k, 0.754_878) as usize);
        let (height, width) = (n * (3 + k % 7) / 100, n * (3 + k % 5) / 100);
        for i in top..(top + height).min(n) {
            blocked[i * n + left..i * n + (left + width).min(n)].fill(true);
        }
    }
    blocked
}

/// Returns the free cell in the middle of the list of free cells.
fn middle(blocked: &[bool]) -> usize {
    let free: Vec<usize> = (0..blocked.len()).filter(|&cell| !blocked[cell]).collect();
    free[free.len() / 2]
}

fn fields(c: &mut Criterion) {
    let (n, blocked) = (1024, boxes(1024));
    let (lattice, goal) = (Lattice::new([n; 2], [true; 2], &blocked), middle(&blocked));
    c.bench_function("lattice/build 1024^2", |b| b.iter(|| Lattice::new([n; 2], [true; 2], black_box(&blocked))));
    c.bench_function("lattice/wave with its order 1024^2", |b| b.iter(|| lattice.wave(black_box(&[goal]))));

    let mut group = c.benchmark_group("harmonic");
    group.sample_size(10);
    let n = 1001;
    for (name, n, circle, blocked) in [
        ("boxes 256^2", 256, true, boxes(256)),
        ("boxes 1024^2", 1024, true, boxes(1024)),
        ("maze 1001^2", n, false, mazes::maze(n, 0)),
        ("maze with loops 1001^2", n, false, mazes::maze(n, 100)),
        ("spiral 451^2", 451, false, mazes::spiral(451).0),
    ] {
        let lattice = Lattice::new([n; 2], [circle; 2], &blocked);
        let component = Component::new(&lattice, lattice.wave(&[middle(&blocked)]));
        group.throughput(Throughput::Elements(component.len() as u64));
        group.bench_function(name, |b| b.iter(|| harmonic(black_box(&component))));
    }
}

criterion_group!(benches, fields);
criterion_main!(benches);
