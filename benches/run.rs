//! The whole run in one process: from the files of an arm with five obstacles to the file of a certified trajectory.

use cplan::check::blend;
use cplan::engine::{Effort, Method, Verdict, solve};
use cplan::input::{self, Overrides};
use cplan::motion::{Limits, Report, Timed, time, write_whole};
use criterion::{Criterion, criterion_group, criterion_main};
use std::path::Path;

/// What `cplan URDF WORLD --output FILE` does.
fn run(urdf: &Path, world: &Path, output: &Path, method: Method) -> usize {
    let problem = input::load(urdf, world, &Overrides::default()).expect("a shipped workspace").problem;
    let joints = &problem.scene().arm().joints;
    let answer = solve(&problem, method, &Effort::default(), &mut |_| {});
    let Verdict::Found(certified) = &answer.verdict else { panic!("{method} found no path") };
    let curve = blend(problem.scene(), certified, f64::INFINITY, problem.scene().workspace().clearance);
    let Timed { curve, trajectory } = time(curve, &Limits::from(joints), 0.01).expect("limits that allow motion");
    let json = Report::found(method.name(), joints, &curve, trajectory).json();
    write_whole(output, json.as_bytes()).expect("a folder to write into");
    json.len()
}

fn whole_run(c: &mut Criterion) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (urdf, world) = (root.join("robots/planar_2r.urdf"), root.join("workspaces/workbench.toml"));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let output = folder.path().join("plan.json");
    let mut group = c.benchmark_group("files to certified trajectory, five obstacles");
    group.sample_size(20);
    for method in Method::ALL {
        group.bench_function(method.name(), |b| b.iter(|| run(&urdf, &world, &output, method)));
    }
    group.finish();
}

criterion_group!(benches, whole_run);
criterion_main!(benches);
