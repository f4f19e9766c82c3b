//! Whole tasks, from the loaded world to certified trajectories of all motions.

use cplan::{Options, Status, plan};
use cplan_testkit::shipped;
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

fn tasks(c: &mut Criterion) {
    let mut group = c.benchmark_group("task");
    group.sample_size(10);
    for world in ["kitting_cell", "feeder", "table_mission", "sorting", "tower", "room_mission"] {
        let problem = shipped::world(&format!("tasks/{world}")).problem();
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
