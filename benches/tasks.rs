//! Whole tasks, from the loaded world to certified trajectories of all motions.

use cplan::{Options, Problem, Status, plan};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::path::Path;

fn tasks(c: &mut Criterion) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut group = c.benchmark_group("task");
    group.sample_size(10);
    for (robot, world) in [
        ("scara.urdf", "kitting_cell.toml"),
        ("scara.urdf", "feeder.toml"),
        ("scara.urdf", "table_mission.toml"),
        ("rail_arm.urdf", "sorting.toml"),
        ("rrbot_vertical.urdf", "tower.toml"),
        ("room_gantry.urdf", "room_mission.toml"),
    ] {
        let problem = Problem::load(root.join("robots").join(robot), root.join("workspaces/tasks").join(world));
        let problem = problem.expect("a shipped task");
        group.bench_function(world, |b| {
            b.iter(|| {
                let plan = plan(black_box(&problem), &Options::default()).expect("the defaults make sense");
                assert_eq!(plan.status(), Status::Found);
                plan
            });
        });
    }
    group.finish();
}

criterion_group!(benches, tasks);
criterion_main!(benches);
