//! Whole tasks, from the loaded world to certified trajectories of all motions.

use cplan::engine::task::{Manner, TaskVerdict, plan};
use cplan::engine::{Effort, Method};
use cplan::input::{self, Overrides};
use cplan::model::Task;
use cplan::motion::Drive;
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::path::Path;

fn task(robot: &str, world: &str) -> Task {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let urdf = root.join("robots").join(robot);
    let scene = input::load_scene(&urdf, &root.join("workspaces/tasks").join(world)).expect("a shipped world");
    scene.task(&Overrides::default()).expect("a shipped task").task
}

fn tasks(c: &mut Criterion) {
    let manner = Manner { method: Method::Visibility, effort: Effort::default(), drive: Drive::default() };
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
        let task = task(robot, world);
        group.bench_function(world, |b| {
            b.iter(|| {
                let answer = plan(black_box(&task), &manner, &mut |_| {});
                assert_eq!(answer.verdict, TaskVerdict::Found(()));
                answer.motions
            });
        });
    }
    group.finish();
}

criterion_group!(benches, tasks);
criterion_main!(benches);
