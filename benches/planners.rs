//! Every planner on the benchmark problem A (a narrow passage on the torus) and on a shipped workspace: the
//! configuration space it works on, what it prepares, and one query.

#[path = "../tests/scenes/mod.rs"]
mod scenes;

use cplan::cspace::{Grid, Regions, outer_grid, regions};
use cplan::input::{self, Overrides};
use cplan::model::Problem;
use cplan::plan::{Harmonic, Outcome, Planner, Query, Trapezoid, Visibility, Wavefront};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::path::Path;

/// As the program begins: obstacles grown by a thousandth of the reach, one turn to either side of the start.
fn polygons(problem: &Problem) -> Regions {
    regions(&problem.scene, 1e-3 * problem.scene.arm.reach(), problem.start, 1)
}

/// As the program begins.
fn cells(problem: &Problem) -> Grid {
    outer_grid(&problem.scene, [256, 256], problem.scene.workspace.clearance)
}

fn shelf() -> Problem {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = ["robots/planar_2r.urdf", "workspaces/shelf.toml"].map(|file| root.join(file));
    input::load(&files[0], &files[1], &Overrides::default()).expect("a shipped workspace").problem
}

fn measure<P: Planner>(c: &mut Criterion, name: &str, problem: &Problem, planner: &P, space: &P::Space) {
    let mut group = c.benchmark_group(format!("{name}/{}", P::NAME));
    group.sample_size(10);
    let query = Query { start: problem.start, goals: problem.goals.clone() };
    let map = planner.build(space);
    assert!(matches!(planner.query(space, &map, &query).outcome, Outcome::Found(_)), "{name}: {} fails", P::NAME);
    group.bench_function("build", |b| b.iter(|| planner.build(black_box(space))));
    group.bench_function("query", |b| b.iter(|| planner.query(space, &map, black_box(&query))));
    group.finish();
}

fn planners(c: &mut Criterion) {
    for (name, problem) in [("problem A", scenes::problem_a()), ("shelf", shelf())] {
        let mut group = c.benchmark_group(format!("{name}/space"));
        group.bench_function("polygons", |b| b.iter(|| polygons(black_box(&problem))));
        group.bench_function("256 x 256 cells", |b| b.iter(|| cells(black_box(&problem))));
        group.finish();
        let (regions, grid) = (polygons(&problem), cells(&problem));
        measure(c, name, &problem, &Visibility, &regions);
        measure(c, name, &problem, &Trapezoid::default(), &regions);
        measure(c, name, &problem, &Wavefront::default(), &grid);
        measure(c, name, &problem, &Harmonic::default(), &grid);
    }
}

criterion_group!(benches, planners);
criterion_main!(benches);
