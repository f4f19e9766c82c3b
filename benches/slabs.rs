//! Answers by slabs of joint 1 on the benchmark problems, and configuration spaces as bitmaps: library calls, one core.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Benchmark, benchmark, problem, w20};
use cplan::certify::slab_connectivity;
use cplan::cspace::bitmap;
use cplan::solve::{Verdict, bound, decide, shorten};
use cplan::space::Metric;
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

const PROBLEMS: [Benchmark; 4] = [Benchmark::A, Benchmark::B, Benchmark::Inf, Benchmark::T];

/// A certified path, or a proof that has passed the independent check.
fn answers(c: &mut Criterion) {
    let mut group = c.benchmark_group("slabs");
    for which in PROBLEMS {
        let problem = problem(which);
        assert!(!matches!(decide(&problem, 10_000), Verdict::Unknown(_)), "{which:?}");
        group.bench_function(format!("{which:?}: certified or proven"), |b| {
            b.iter(|| decide(black_box(&problem), 10_000))
        });
        let (scene, start, goals) = (problem.scene(), problem.start(), problem.goals());
        group.bench_function(format!("{which:?}: the search alone"), |b| {
            b.iter(|| slab_connectivity(black_box(scene), start, goals, 0.0, 10_000));
        });
    }
    group.finish();
}

/// The shortest path, certified, on the problems that have one, and how near to the optimum it is proven to be.
fn optima(c: &mut Criterion) {
    let mut group = c.benchmark_group("shortest");
    for (which, optimum) in [(Benchmark::A, 6.4229), (Benchmark::B, 6.4281)] {
        let problem = problem(which);
        let Verdict::Found(certified) = shorten(&problem, 1e-4, 10_000) else { panic!("{which:?}") };
        let excess = certified.path().length() / optimum - 1.0;
        group.bench_function(format!("{which:?}: {excess:.1e} above the optimum"), |b| {
            b.iter(|| shorten(black_box(&problem), 1e-4, 10_000));
        });
        let proven = || bound(black_box(&problem), certified.path(), Metric::Euclidean, 1e-4);
        group.bench_function(format!("{which:?}: the proof that it is within {:.1e}", proven().gap()), |b| {
            b.iter(proven);
        });
    }
    group.finish();
}

fn bitmaps(c: &mut Criterion) {
    let mut group = c.benchmark_group("bitmap, 2048 x 2048");
    for (name, scene) in [("A", benchmark(Benchmark::A).0), ("W20", w20())] {
        group.bench_function(name, |b| b.iter(|| bitmap(black_box(&scene), [2048, 2048], 0.0)));
    }
    group.finish();
}

criterion_group!(benches, answers, optima, bitmaps);
criterion_main!(benches);
