#[path = "../tests/common/mod.rs"]
mod common;
use common::*;
use cplan::certify::*;
use std::time::Instant;
fn main() {
    for which in [Benchmark::A, Benchmark::B, Benchmark::Inf, Benchmark::T] {
        let (scene, start, goal) = benchmark(which);
        let mut best = f64::INFINITY;
        for _ in 0..200 {
            let t = Instant::now();
            let r = slab_connectivity(&scene, start, &[goal], 0.0, 100_000);
            best = best.min(t.elapsed().as_secs_f64());
            std::hint::black_box(&r);
        }
        let r = slab_connectivity(&scene, start, &[goal], 0.0, 100_000);
        match r {
            Connectivity::Connected(c) => {
                let p = c.path();
                let t = Instant::now();
                let cert = certify(&scene, p.clone(), 0.0);
                let dt = t.elapsed().as_secs_f64();
                println!("{which:?} connected {} doors, {:.1} us; certify middles {:.1} us {:?}", c.doors().len(), best * 1e6, dt * 1e6, cert.map(|c| c.clearance()).map_err(|e| format!("{e:?}")));
                use cplan::plan::*; use cplan::geometry::Point;
                let pass: Vec<Passage> = c.doors().iter().map(|d| Passage { left: Point::from(d[0]), right: Point::from(d[1]) }).collect();
                let t = Instant::now();
                let s = taut_string(Point::from(c.start()), Point::from(c.goal()), &pass);
                let dt = t.elapsed().as_secs_f64();
                let path = cplan::space::Path::new(s.iter().map(|p| p.coords).collect());
                let t = Instant::now();
                let cert = certify(&scene, path.clone(), 0.0);
                let dt2 = t.elapsed().as_secs_f64();
                println!("  taut {:.1} us, {} corners, length {}, certify {:.1} us {:?}", dt * 1e6, s.len(), path.length(), dt2 * 1e6, cert.map(|c| c.clearance()).map_err(|e| format!("{e:?}")));
            }
            Connectivity::Disconnected(d) => {
                println!("{which:?} disconnected {} boxes, {:.1} us, recheck {:?}", d.stuck().len(), best * 1e6, d.recheck(&scene, start, &[goal], 0.0));
            }
            other => println!("{which:?} {other:?} {:.1} us", best * 1e6),
        }
    }
}
