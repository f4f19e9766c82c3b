//! Fields of a match of robots, each started from that of the previous frame: sixty frames, a second of play.

use cplan::field::{Boundary, Difference, Factor, Moment, MovingField, Order, Relaxation, Scan, Solver};
use cplan_testkit::football::play::{CELLS, Match, walls};
use criterion::{Criterion, Throughput};

const FRAMES: u64 = 60;

pub fn moving(c: &mut Criterion) {
    let mut game = Match::new(1).expect("a match");
    let frames: Vec<_> = (0..FRAMES).map(|_| game.next_frame().expect("a frame")).collect();
    let first = MovingField::new(CELLS, walls(), [Boundary::High; 2], Difference::Upwind).expect("a flag a cell");
    let sor = |factor: f64| Solver::Relaxation(Relaxation::sor(Factor::Given(factor), Order::Lines(Scan::ROWS)));
    let mut group = c.benchmark_group("moving");
    group.throughput(Throughput::Elements(FRAMES)).sample_size(10);
    for (field, k) in [("harmonic", 2), ("own", 2), ("shared", 3)] {
        let moment = |moments: &[Moment]| match field {
            "harmonic" => Moment { robots: Vec::new(), ..moments[k].clone() },
            _ => moments[k].clone(),
        };
        let moments: Vec<Moment> = frames.iter().map(|frame| moment(&frame.moments)).collect();
        for (name, solver) in [("Gauss-Seidel", sor(1.0)), ("SOR 1.7", sor(1.7)), ("multigrid", Solver::Multigrid)] {
            group.bench_function(format!("{field}, {name}"), |b| {
                b.iter(|| {
                    let mut field = first.clone();
                    for moment in &moments {
                        field.next(moment, &solver, 1e-6, 2000).expect("a field");
                    }
                    field
                });
            });
        }
    }
    group.finish();
}
