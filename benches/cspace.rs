//! Configuration space from slices, compared with parry2d's collision tests.

use cplan::cspace::{Slice, grid_from_slices, outer_grid, sampled_grid};
use cplan::model::Contacts;
use cplan_testkit::scenes;
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

const CELLS: [usize; 2] = [1024, 1024];

fn slices(c: &mut Criterion) {
    let scene = scenes::w20();
    let slices = Contacts::new(&scene);
    let mut slice = Slice::default();
    let mut step = 0_u32;
    c.bench_function("one row of intervals, 20 obstacles", |b| {
        b.iter(|| {
            step = (step + 37) % 1024;
            slice.compute(&slices, black_box(f64::from(step) * 0.006 - 3.0), 0.0);
            slice.merged.len()
        });
    });
}

fn grids(c: &mut Criterion) {
    let scene = scenes::w20();
    let mut group = c.benchmark_group("W20, 1024 x 1024 cells");
    group.bench_function("from slices", |b| b.iter(|| grid_from_slices(black_box(&scene), CELLS, 0.0)));
    group.bench_function("from slices, outer", |b| b.iter(|| outer_grid(black_box(&scene), CELLS, 0.0)));
    group.sample_size(10);
    group.bench_function("by parry2d", |b| b.iter(|| sampled_grid(black_box(&scene), CELLS, 0.0)));
    group.finish();
}

criterion_group!(benches, slices, grids);
criterion_main!(benches);
