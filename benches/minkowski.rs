//! Minkowski differences of regular polygons: the angular sweep beside the hull of all differences. The throughput is
//! in corners of the result.

use std::hint::black_box;

use cplan::geometry::{Convex, Point, hull};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// Returns a regular polygon, turned by `phase` so that the sides of two polygons are not parallel.
fn regular(corners: usize, phase: f64) -> Convex {
    let angle = |k: usize| phase + k as f64 / corners as f64 * std::f64::consts::TAU;
    let core = (0..corners).map(|k| Point::new(angle(k).cos(), angle(k).sin())).collect();
    Convex::new(core, 0.0).expect("a regular polygon is convex")
}

fn hull_of_all_differences(b: &[Point], a: &[Point]) -> Vec<Point> {
    hull(&b.iter().flat_map(|q| a.iter().map(move |p| q - p)).collect::<Vec<_>>())
}

fn minkowski(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("minkowski");
    for corners in [4, 8, 64, 512] {
        let (a, b) = (regular(corners, 0.001), regular(corners, 0.002));
        group.throughput(Throughput::Elements(b.minkowski_difference(&a).core().len() as u64));
        group.bench_function(BenchmarkId::new("sweep", corners), |bench| {
            bench.iter(|| black_box(&b).minkowski_difference(black_box(&a)));
        });
        // 262 144 differences for 512 corners: enough to see the quadratic growth without them.
        if corners <= 64 {
            group.bench_function(BenchmarkId::new("hull of all differences", corners), |bench| {
                bench.iter(|| hull_of_all_differences(black_box(b.core()), black_box(a.core())));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, minkowski);
criterion_main!(benches);
