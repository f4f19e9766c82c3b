//! Polygonal free space of an arm with two continuous joints, and of one with limits.

use cplan::cspace::regions;
use cplan::geometry::{Convex, Point, Vector};
use cplan::model::{Arm, Heights, Joint, Link, Motion, Obstacle, OutlineSource, Part, Plane, Scene, Shape, Workspace};
use cplan::space::{Axis, Configuration};
use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Vector3;
use std::hint::black_box;

fn polygon(corners: &[(f64, f64)]) -> Convex {
    Convex::new(corners.iter().map(|&(x, y)| Point::new(x, y)).collect(), 0.0)
}

/// Bars of 1.0 and 0.8 m by 0.1 m among the given obstacles.
fn planar(axis: Axis, pieces: Vec<Convex>) -> Scene {
    let joint = |name: &str| Joint {
        name: name.into(),
        motion: Motion::Revolute { sign: 1.0 },
        axis,
        velocity: 1.0,
        acceleration: 1.0,
    };
    let link = |name: &str, length: f64| Link {
        name: name.into(),
        parts: vec![Part {
            shape: polygon(&[(0.0, -0.05), (length, -0.05), (length, 0.05), (0.0, 0.05)]),
            heights: Heights::ALL,
            body: name.into(),
        }],
        source: OutlineSource::Collision,
    };
    let arm = Arm {
        name: "planar".into(),
        joints: [joint("shoulder"), joint("elbow")],
        links: [link("upper", 1.0), link("fore", 0.8)],
        base: Point::origin(),
        offset: Vector::new(1.0, 0.0),
        tip: Point::new(0.8, 0.0),
        tip_name: "tip".into(),
        plane: Plane { u: Vector3::x(), v: Vector3::y(), normal: Vector3::z() },
    };
    let obstacles = pieces
        .into_iter()
        .map(|piece| Obstacle {
            name: String::new(),
            shape: Shape::Polygon(piece.core().to_vec()),
            pieces: vec![piece],
            heights: Heights::ALL,
        })
        .collect();
    Scene::new(arm, Workspace { name: String::new(), obstacles, clearance: 0.0 })
}

/// Four obstacles that leave a passage 0.070 rad wide.
fn narrow_passage() -> Vec<Convex> {
    vec![
        polygon(&[(-0.21, -0.85), (-0.03, -1.20), (0.22, -1.21), (0.44, -0.93), (0.27, -0.62), (-0.09, -0.65)]),
        polygon(&[(0.99, -0.17), (1.14, -0.35), (1.38, -0.27), (1.42, -0.16), (1.28, 0.07), (1.04, 0.0)]),
        polygon(&[(0.11, 1.33), (0.27, 1.12), (0.53, 1.19), (0.51, 1.51), (0.20, 1.53)]),
        polygon(&[(-1.02, 0.33), (-0.89, 0.12), (-0.63, 0.32), (-0.85, 0.51)]),
    ]
}

/// Regular polygons with 4 to 7 corners on a spiral.
fn spiral(count: usize) -> Vec<Convex> {
    (0..count)
        .map(|i| {
            let t = i as f64;
            let distance = 0.55 + 1.15 * ((t + 0.5) / count as f64).sqrt();
            let center = Vector::new((2.399963 * t).cos(), (2.399963 * t).sin()) * distance;
            let n = 4 + i % 4;
            let corner = |k: usize| {
                let angle = 0.7 * t + std::f64::consts::TAU * k as f64 / n as f64;
                Point::from(center + 0.08 * Vector::new(angle.cos(), angle.sin()))
            };
            Convex::new((0..n).map(corner).collect(), 0.0)
        })
        .collect()
}

fn build(c: &mut Criterion) {
    let limited = Axis::Interval { lower: -2.8, upper: 2.8 };
    let scenes = [
        ("torus, 4 obstacles", planar(Axis::Circle, narrow_passage())),
        ("limits, 5 obstacles", planar(limited, spiral(5))),
        ("torus, 20 obstacles", planar(Axis::Circle, spiral(20))),
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
