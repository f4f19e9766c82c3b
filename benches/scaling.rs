//! Benchmarks of the time against the number of corners of an obstacle: a thousand, ten thousand, a hundred thousand.

use cplan::cspace::regions;
use cplan::geometry::{Point, SimplePolygon};
use cplan::model::{Growth, Heights, Obstacle, Shape, Workspace};
use cplan::space::JointRange;
use cplan_testkit::{arms, scenes, shapes};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::f64::consts::TAU;
use std::hint::black_box;

const SIZES: [usize; 3] = [1_000, 10_000, 100_000];

/// Returns a ring of corners around a place within reach. The corners are alternately at these two distances.
fn ring(count: usize, [inner, outer]: [f64; 2]) -> Vec<Point> {
    let corner = |k: usize| {
        let (angle, radius) = (k as f64 / count as f64 * TAU, if k.is_multiple_of(2) { outer } else { inner });
        Point::new(1.2 + radius * angle.cos(), 0.3 + radius * angle.sin())
    };
    (0..count).map(corner).collect()
}

const SHAPES: [(&str, [f64; 2]); 2] = [("disc", [0.15, 0.15]), ("star", [0.1, 0.2])];

/// Returns a polyline around the same place: a noisy zigzag that crosses itself.
fn zigzag(count: usize) -> Vec<Point> {
    let noise = |k: usize| (k as f64 * 0.618_033_988_749 + (k as f64 * 0.013).sin() * 17.0).rem_euclid(1.0) - 0.5;
    let point =
        |k: usize| Point::new(1.0 + 0.3 * k as f64 / count as f64, 0.25 + 0.05 * (k % 2) as f64 + 0.04 * noise(k));
    (0..count).map(point).collect()
}

/// Measures how long it takes to check a polygon and to decompose it.
fn reading(c: &mut Criterion) {
    let mut group = c.benchmark_group("a polygon is read");
    group.sample_size(10);
    for (name, radii) in SHAPES {
        for count in SIZES {
            let corners = ring(count, radii);
            group.throughput(Throughput::Elements(count as u64));
            group.bench_function(BenchmarkId::new(name, count), |b| {
                b.iter(|| SimplePolygon::new(black_box(&corners).clone()).unwrap().convex_pieces().len());
            });
        }
    }
    group.finish();
}

/// Measures how long it takes to compute the configuration space with a margin of a thousandth of the reach.
fn spaces(c: &mut Criterion) {
    let mut group = c.benchmark_group("its configuration space");
    group.sample_size(10);
    let polygon = |corners: Vec<Point>| {
        let polygon = SimplePolygon::new(corners).unwrap();
        (Shape::Polygon(polygon.corners().to_vec()), polygon.convex_pieces())
    };
    let wall = |points: Vec<Point>| {
        let pieces = points.windows(2).map(|w| shapes::wall(w[0], w[1])).collect();
        (Shape::Polyline(points), pieces)
    };
    for count in SIZES {
        let [disc, star] = SHAPES.map(|(name, radii)| (name, polygon(ring(count, radii))));
        for (name, (shape, pieces)) in [disc, star, ("zigzag", wall(zigzag(count)))] {
            let obstacle =
                Obstacle { name: name.into(), shape, pieces, heights: Heights::ALL, growth: Growth::default() };
            let workspace =
                Workspace { name: name.into(), obstacles: vec![obstacle], clearance: 0.0, preferences: Vec::new() };
            let range = JointRange::Interval { lower: -2.8, upper: 2.8 };
            let scene = scenes::placed(arms::rr([range; 2]), workspace);
            group.throughput(Throughput::Elements(count as u64));
            group.bench_function(BenchmarkId::new(name, count), |b| {
                b.iter(|| regions(black_box(&scene), 1.8e-3, scenes::q(0.0, 0.0), 1).free.len());
            });
        }
    }
    group.finish();
}

criterion_group!(benches, reading, spaces);
criterion_main!(benches);
