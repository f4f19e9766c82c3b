//! Motions among what moves, from the loaded world to a motion that is certified in time, or the proof that no timing helps.

use cplan::{Options, Problem, plan};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::path::Path;

fn moving(c: &mut Criterion) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut group = c.benchmark_group("movers");
    for world in ["crossing", "gate", "conveyor", "parked", "swing", "traffic"] {
        let file = root.join("workspaces/moving").join(world).with_extension("toml");
        let problem = Problem::load(root.join("robots/planar_2r.urdf"), file).expect("a shipped world");
        group.bench_function(world, |b| {
            b.iter(|| plan(black_box(&problem), &Options::default()).expect("the defaults make sense"));
        });
    }
    group.finish();
}

criterion_group!(benches, moving);
criterion_main!(benches);
