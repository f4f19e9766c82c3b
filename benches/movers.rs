//! Benchmarks of motions among moving obstacles, from the loaded world to a certified motion in time, or the proof that
//! no timing helps. The first is the median over random worlds with ten moving obstacles each.

use cplan::{Options, Outcome, Problem, plan};
use cplan_testkit::moving::Moving;
use cplan_testkit::world;
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

/// Number of random worlds (`WORLDS`), and number of moving obstacles in each.
const WORLDS: usize = 100;
const MOVERS: u64 = 10;

fn drawn_worlds(_: &mut Criterion) {
    let options = Options { bounded: false, ..Options::default() };
    let (mut times, mut found, mut proven): (Vec<Duration>, _, _) = (Vec::new(), 0, 0);
    let kinds = |seed| world::KINDS.into_iter().filter_map(move |kind| Moving::drawn(kind, seed, Some(MOVERS)));
    for world in (0..).flat_map(kinds) {
        let problem = world.problem();
        let clock = Instant::now();
        let plan = plan(black_box(&problem), &options).expect("the defaults make sense");
        let took = clock.elapsed();
        match plan.outcome() {
            Outcome::Found(_) => found += 1,
            Outcome::Unknown(reason) if reason.contains("move") => {
                proven += usize::from(reason.contains("proven: along"))
            }
            // Among the static obstacles no path exists or is known.
            _ => continue,
        }
        times.push(took);
        if times.len() == WORLDS {
            break;
        }
    }
    times.sort_unstable();
    let [median, most] = [WORLDS / 2, WORLDS * 9 / 10].map(|k| times[k].as_secs_f64() * 1e3);
    println!(
        "{WORLDS} worlds of {MOVERS} movers: median {median:.1} ms, nine in ten {most:.1} ms; {found} found, {proven} proven impossible along the ways tried"
    );
}

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

criterion_group!(benches, drawn_worlds, moving);
criterion_main!(benches);
