//! Measures motions along a line of one metre with a thousand corners: `cargo run --release -p cplan-follow --example
//! corners`.

use cplan_follow::{Settings, follow};
use cplan_model::{Arm, Joint, Link, Obstacle, Outcome, Scene, Workspace};
use cplan_toolpath::{Curve, Piece, Source, Toolpath};
use std::time::Instant;

/// Number of runs. The fastest one counts, because other programs share the machine.
const RUNS: usize = 30;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let joint = |name: &str| Joint::turning(name, -3.0, 3.0).at_most(2.0, 10.0);
    let links = [Link::bar("upper arm", 1.0, 0.06)?, Link::bar("forearm", 0.8, 0.06)?];
    let arm = Arm::new([joint("shoulder"), joint("elbow")], links, [1.0, 0.8]);
    let post = Obstacle::circle("post", [0.6, -0.9], 0.1)?;
    let scene = Scene::new(arm, Workspace::new([post]))?;
    // A zigzag: each piece is a millimetre long and turns by a right angle.
    let step = 1e-3 / 2.0_f64.sqrt();
    let at = |k: u32| [0.9 + f64::from(k % 2) * step, -0.35 + f64::from(k) * step];
    let source = Source::of_line(1);
    let piece = |k: u32| Piece {
        curve: Curve::Line { from: at(k), to: at(k + 1) },
        speed: None,
        is_travel: false,
        dwell: None,
        source,
    };
    let line = Toolpath::new((0..1001).map(piece).collect())?;
    let mut fastest = f64::INFINITY;
    let mut answer = None;
    for _ in 0..RUNS {
        let begin = Instant::now();
        answer = Some(follow(&scene, &line, &Settings::default())?);
        fastest = fastest.min(begin.elapsed().as_secs_f64());
    }
    let Some(Outcome::Found(found)) = answer else { return Err("no motion".into()) };
    println!(
        "{:.3} m with {} corners: {:.1} ms; {} samples, {:.2} s, at most {:.4} mm from the line",
        line.length(),
        line.pieces().len() - 1,
        fastest * 1e3,
        found.timed.trajectory.time.len(),
        found.timed.trajectory.duration(),
        found.deviation * 1e3
    );
    Ok(())
}
