//! Polygonal free space of an arm with two continuous joints, and of one with limits.

use cplan::cspace::regions;
use cplan::space::{Configuration, JointRange};
use cplan_testkit::arms::rr;
use cplan_testkit::problems::{Benchmark, benchmark};
use cplan_testkit::scenes::{scene, spiral, w20};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

fn build(c: &mut Criterion) {
    let limited = JointRange::Interval { lower: -2.8, upper: 2.8 };
    let scenes = [
        ("torus, 4 obstacles", benchmark(Benchmark::A).0),
        ("limits, 5 obstacles", scene(rr([limited, limited]), spiral(5))),
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
