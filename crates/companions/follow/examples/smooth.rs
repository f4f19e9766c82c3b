//! Measures motions with limits on jerks along splines through many points: `cargo run --profile dist -p cplan-follow
//! --example smooth`.

use cplan_follow::{Settings, follow};
use cplan_model::{Arm, Joint, Link, Obstacle, Outcome, Scene, Workspace};
use cplan_toolpath::{Curve, Piece, Point, Source, Toolpath, polyline, spline};
use std::f64::consts::TAU;
use std::time::Instant;

/// Number of runs. The fastest one counts, because other programs share the machine.
const RUNS: usize = 3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let joint = |name: &str| Joint { jerk: Some(200.0), ..Joint::turning(name, -3.0, 3.0).at_most(2.0, 10.0) };
    let links = [Link::bar("upper arm", 1.0, 0.06)?, Link::bar("forearm", 0.8, 0.06)?];
    let arm = Arm::new([joint("shoulder"), joint("elbow")], links, [1.0, 0.8]);
    let post = Obstacle::circle("post", [0.6, -0.9], 0.1)?;
    let scene = Scene::new(arm, Workspace::new([post]))?;
    // Points on a wave that turns three times.
    let wave = |count: u32| -> Vec<Point> {
        let at = |k: u32| f64::from(k) / f64::from(count - 1);
        let jitter = |k: u32| 0.01 * (f64::from(k) * 2.4).sin();
        (0..count).map(|k| [1.0 + 0.25 * (3.0 * TAU * at(k)).sin() + jitter(k), at(k) - 0.5]).collect()
    };
    let circle = |count: u32| -> Vec<Point> {
        let angle = |k: u32| TAU * f64::from(k) / f64::from(count);
        (0..=count).map(|k| [1.1 + 0.25 * angle(k).cos(), 0.25 * angle(k).sin()]).collect()
    };
    let zigzag: Vec<Point> = (0..1002).map(|k| [0.9 + 0.1 * f64::from(k % 2), 7e-4 * f64::from(k) - 0.35]).collect();
    for count in [20, 60, 200] {
        measure(&scene, &format!("spline through {count} points"), spline(&wave(count))?)?;
    }
    measure(&scene, "circle of 1000 straight lines", polyline(&circle(1000), 0.0)?)?;
    measure(&scene, "zigzag with 1000 sharp corners", polyline(&zigzag, 0.0)?)
}

fn measure(scene: &Scene, name: &str, legs: Vec<(Curve, usize)>) -> Result<(), Box<dyn std::error::Error>> {
    let source = Source::of_line(1);
    let piece = |(curve, _): (Curve, usize)| Piece { curve, speed: None, is_travel: false, dwell: None, source };
    let line = Toolpath::new(legs.into_iter().map(piece).collect())?;
    let mut fastest = f64::INFINITY;
    let mut answer = None;
    for _ in 0..RUNS {
        let begin = Instant::now();
        answer = Some(follow(scene, &line, &Settings::default())?);
        fastest = fastest.min(begin.elapsed().as_secs_f64());
    }
    let Some(Outcome::Found(found)) = answer else { return Err("no motion".into()) };
    let trajectory = &found.timed.trajectory;
    let stops = trajectory.velocity.iter().filter(|v| **v == [0.0; 2]).count();
    println!(
        "{name}, {:.3} m: {:.1} ms; {} samples, {:.3} s with {} stops, at most {:.4} mm from the line",
        line.length(),
        fastest * 1e3,
        trajectory.time.len(),
        trajectory.duration(),
        stops.saturating_sub(2),
        found.deviation * 1e3
    );
    Ok(())
}
