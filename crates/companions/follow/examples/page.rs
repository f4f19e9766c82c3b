//! Measures the motion along a page of text in a stroke font: `cargo run --profile dist -p cplan-follow --example page`.
//! An argument sets the number of pieces.

use cplan_follow::{Settings, follow};
use cplan_model::{Arm, Joint, Link, Outcome, Scene, Workspace};
use cplan_toolpath::{Curve, Piece, Point, Source, Toolpath};
use std::time::Instant;

/// Default number of pieces.
const PIECES: usize = 10_000;

/// Height of a letter, metres.
const HEIGHT: f64 = 3e-3;

/// Number of letters per row.
const LETTERS: usize = 50;

/// The strokes of letters, on a grid of 4 x 6.
const FONT: [&[&[[i32; 2]]]; 6] = [
    &[&[[0, 0], [2, 6], [4, 0]], &[[1, 2], [3, 2]]],
    &[&[[0, 0], [0, 6], [3, 6], [4, 5], [4, 4], [3, 3], [0, 3]], &[[3, 3], [4, 2], [4, 1], [3, 0], [0, 0]]],
    &[&[[4, 5], [3, 6], [1, 6], [0, 5], [0, 1], [1, 0], [3, 0], [4, 1]]],
    &[&[[0, 6], [0, 0], [4, 0]], &[[0, 3], [3, 3]], &[[0, 6], [4, 6]]],
    &[&[[2, 3], [1, 2], [1, 1], [2, 0], [3, 1], [3, 2], [2, 3]]],
    &[&[[4, 5], [3, 6], [1, 6], [0, 5], [0, 4], [1, 3], [3, 3], [4, 2], [4, 1], [3, 0], [1, 0], [0, 1]]],
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let count = std::env::args().nth(1).map_or(Ok(PIECES), |text| text.parse())?;
    let joint = |name: &str| Joint::turning(name, -3.0, 3.0).at_most(2.0, 10.0);
    let links = [Link::bar("upper arm", 1.0, 0.06)?, Link::bar("forearm", 0.8, 0.06)?];
    let scene = Scene::new(Arm::new([joint("shoulder"), joint("elbow")], links, [1.0, 0.8]), Workspace::new([]))?;
    let line = Toolpath::new(page(count))?;
    let begin = Instant::now();
    let Outcome::Found(found) = follow(&scene, &line, &Settings::default())? else { return Err("no motion".into()) };
    println!(
        "{:.3} m in {} pieces, {} of them travels: {:.2} s; {} samples, {:.1} s, at most {:.4} mm from the line",
        line.length(),
        line.pieces().len(),
        line.pieces().iter().filter(|piece| piece.is_travel).count(),
        begin.elapsed().as_secs_f64(),
        found.timed.trajectory.time.len(),
        found.timed.trajectory.duration(),
        found.deviation * 1e3
    );
    Ok(())
}

/// Returns the pieces of a page of letters. A travel leads to each stroke. Strokes end in hooks of nanometres, as
/// drawing programs write them.
fn page(count: usize) -> Vec<Piece> {
    let unit = HEIGHT / 6.0;
    let mut pieces: Vec<Piece> = Vec::new();
    let mut push = |from: Point, to: Point, is_travel: bool| {
        let source = Source::of_line(pieces.len() + 1);
        pieces.push(Piece {
            curve: Curve::Line { from, to },
            speed: (!is_travel).then_some(0.1),
            is_travel,
            dwell: None,
            source,
        });
        pieces.len()
    };
    let mut at: Option<Point> = None;
    for letter in 0.. {
        let origin = [0.85 + 6.0 * unit * (letter % LETTERS) as f64, 0.3 - 9.0 * unit * (letter / LETTERS) as f64];
        let point = |[x, y]: [i32; 2]| [origin[0] + unit * f64::from(x), origin[1] + unit * f64::from(y)];
        for stroke in FONT[(letter * 7) % 11 % FONT.len()] {
            let start = point(stroke[0]);
            if let Some(end) = at {
                push(end, start, true);
            }
            for pair in stroke.windows(2) {
                push(point(pair[0]), point(pair[1]), false);
            }
            let (end, hook) = (point(stroke[stroke.len() - 1]), 1e-8);
            let hooked = [end[0] - hook, end[1] + hook];
            at = Some(hooked);
            if push(end, hooked, false) >= count {
                return pieces;
            }
        }
    }
    unreachable!("the letters never end")
}
