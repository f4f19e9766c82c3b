//! The whole run in one process: from the files of an arm with five obstacles to the file of a certified trajectory.

use cplan::PlanOutput as _;
use cplan::engine::Method;
use cplan::{Options, Problem, Status, plan};
use criterion::{Criterion, criterion_group, criterion_main};
use std::path::Path;

/// Runs the same steps as `cplan URDF WORLD --output FILE`.
fn run(urdf: &Path, world: &Path, output: &Path, options: &Options) {
    let problem = Problem::load(urdf, world).expect("a shipped workspace");
    let plan = plan(&problem, options).expect("options that make sense");
    assert_eq!(plan.status(), Status::Found);
    plan.save(output).expect("a folder to write into");
}

fn whole_run(c: &mut Criterion) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (urdf, world) = (root.join("robots/planar_2r.urdf"), root.join("workspaces/workbench.toml"));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let output = folder.path().join("plan.json");
    let mut group = c.benchmark_group("files to certified trajectory, five obstacles");
    group.sample_size(20);
    for method in Method::ALL {
        group.bench_function(method.name(), |b| b.iter(|| run(&urdf, &world, &output, &method.into())));
    }
    group.finish();
}

criterion_group!(benches, whole_run);
criterion_main!(benches);
