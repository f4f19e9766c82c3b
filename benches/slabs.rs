//! Answers by slabs of joint 1 on the benchmark problems, and configuration spaces as bitmaps: library calls, one core.

use cplan::Outcome;
use cplan::cspace::bitmap;
use cplan::engine::decide;
use cplan::proofs::slab_connectivity;
use cplan::{Options, Problem, plan};
use cplan_testkit::problems::{Benchmark, benchmark, problem};
use cplan_testkit::scenes::w20;
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

const PROBLEMS: [Benchmark; 4] = [Benchmark::A, Benchmark::B, Benchmark::Inf, Benchmark::T];

/// Measures the time until there is a certified path, or a proof that has passed the independent check.
fn answers(c: &mut Criterion) {
    let mut group = c.benchmark_group("slabs");
    for which in PROBLEMS {
        let problem = problem(which);
        assert!(!matches!(decide(&problem, 10_000), Outcome::Unknown(_)), "{which:?}");
        group.bench_function(format!("{which:?}: certified or proven"), |b| {
            b.iter(|| decide(black_box(&problem), 10_000))
        });
        let (scene, start, goals) = (problem.scene(), problem.start(), problem.goals());
        group.bench_function(format!("{which:?}: the search alone"), |b| {
            b.iter(|| slab_connectivity(black_box(scene), start, goals, 0.0, 10_000, 10_000));
        });
    }
    group.finish();
}

/// Measures the time until there is a certified shortest path with a proven gap, on the problems that have one.
fn optima(c: &mut Criterion) {
    let mut group = c.benchmark_group("shortest");
    for which in [Benchmark::A, Benchmark::B] {
        let problem = Problem::from(problem(which));
        let shortest = || plan(black_box(&problem), &Options::default()).expect("the defaults make sense");
        let gap = shortest().bound().expect("both have a path").gap();
        group.bench_function(format!("{which:?}: timed, proven within {gap:.1e}"), |b| b.iter(shortest));
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
