//! Polygonal free space of an arm with two continuous joints, and of one with limits.

#[path = "../tests/scenes/mod.rs"]
mod scenes;

use cplan::cspace::regions;
use cplan::space::{Axis, Configuration};
use criterion::{Criterion, criterion_group, criterion_main};
use scenes::{bars, narrow_passage, scene, spiral, w20};
use std::hint::black_box;

fn build(c: &mut Criterion) {
    let limited = Axis::Interval { lower: -2.8, upper: 2.8 };
    let scenes = [
        ("torus, 4 obstacles", scene(bars(Axis::Circle), narrow_passage())),
        ("limits, 5 obstacles", scene(bars(limited), spiral(5))),
        ("torus, 20 obstacles", w20()),
    ];
    let mut group = c.benchmark_group("regions");
    for (name, scene) in &scenes {
        group.bench_function(*name, |b| {
            b.iter(|| regions(black_box(scene), 1e-3, Configuration::new(-0.7, 0.0), 1));
        });
    }
    group.finish();
}

criterion_group!(benches, build);
criterion_main!(benches);
