//! Benchmarks of every planner on the benchmark problem A (a narrow passage on the torus) and on a shipped workspace:
//! the configuration space, the preparation, and one query.

use cplan::cspace::{Grid, Regions, outer_grid, regions};
use cplan::model::MotionProblem;
use cplan::planner::{Harmonic, Planner, Proposal, Query, Trapezoid, Visibility, Wavefront};
use cplan_testkit::{problems, shipped};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

/// Returns the polygons with which the program begins. Obstacles are grown by a thousandth of the reach, and the window
/// extends one turn to either side of the start.
fn polygons(problem: &MotionProblem) -> Regions {
    regions(problem.scene(), 1e-3 * problem.scene().arm().reach(), problem.start(), 1)
}

fn cells(problem: &MotionProblem, n: usize) -> Grid {
    outer_grid(problem.scene(), [n, n], problem.scene().workspace().clearance)
}

/// Returns the number of cells along each axis with which the program finds a path. It begins with 256, and doubles
/// until there is a path.
fn sufficient(problem: &MotionProblem) -> usize {
    let query = Query { start: problem.start(), goals: problem.goals().clone() };
    let planner = Wavefront::default();
    let finds = |&n: &usize| {
        let space = cells(problem, n);
        matches!(planner.query(&space, &planner.build(&space), &query).outcome, Proposal::Found(_))
    };
    [256, 512, 1024, 2048].into_iter().find(finds).expect("a path at the finest resolution")
}

fn measure<P: Planner>(c: &mut Criterion, name: &str, problem: &MotionProblem, planner: &P, space: &P::Space) {
    let mut group = c.benchmark_group(format!("{name}/{}", P::NAME));
    group.sample_size(10);
    let query = Query { start: problem.start(), goals: problem.goals().clone() };
    let map = planner.build(space);
    assert!(matches!(planner.query(space, &map, &query).outcome, Proposal::Found(_)), "{name}: {} fails", P::NAME);
    group.bench_function("build", |b| b.iter(|| planner.build(black_box(space))));
    group.bench_function("query", |b| b.iter(|| planner.query(space, &map, black_box(&query))));
    group.finish();
}

fn planners(c: &mut Criterion) {
    for (name, problem) in
        [("problem A", problems::problem(problems::Benchmark::A)), ("shelf", shipped::world("shelf").motion())]
    {
        let n = sufficient(&problem);
        let mut group = c.benchmark_group(format!("{name}/space"));
        group.bench_function("polygons", |b| b.iter(|| polygons(black_box(&problem))));
        group.bench_function(format!("{n} x {n} cells"), |b| b.iter(|| cells(black_box(&problem), n)));
        group.finish();
        let (regions, grid) = (polygons(&problem), cells(&problem, n));
        measure(c, name, &problem, &Visibility::default(), &regions);
        measure(c, name, &problem, &Trapezoid::default(), &regions);
        measure(c, name, &problem, &Wavefront::default(), &grid);
        measure(c, name, &problem, &Harmonic::default(), &grid);
    }
}

criterion_group!(benches, planners);
criterion_main!(benches);
