//! The number of boxes of a proof in random worlds, from the program's own result.

use super::*;
use cplan_cases::dice::Dice;
use cplan_cases::seeds;
use std::fmt::Write;

/// Largest number of boxes of a proof.
const MOST: usize = 10_000;

/// Returns a world of discs, triangles and thin walls around the arm, with start and goal far apart. Walls and slim
/// triangles need the most boxes in proofs by slabs.
fn world(seed: u64) -> String {
    let mut dice = Dice::new(seed);
    let goal = dice.within(1.2, 2.6);
    let mut world = format!("[start]\njoints = [{:?}, 0.2]\n[goal]\njoints = [{goal:?}, -0.3]\n", -goal);
    for _ in 0..dice.within(3.0, 14.0) as usize {
        let (angle, distance) = (dice.within(-3.0, 3.0), dice.within(1.05, 1.9));
        let [x, y] = [distance * angle.cos(), distance * angle.sin()];
        let mut near = |by: f64| [x + dice.within(-by, by), y + dice.within(-by, by)];
        let (a, b, c) = (near(0.4), near(0.4), near(0.1));
        let _ = match dice.within(0.0, 3.0) as u32 {
            0 => writeln!(
                world,
                "[[obstacle]]\ncircle = {{ center = [{x:?}, {y:?}], radius = {:?} }}",
                dice.within(0.01, 0.15)
            ),
            1 => writeln!(world, "[[obstacle]]\npolygon = [{a:?}, {b:?}, {c:?}]"),
            _ => writeln!(world, "[[obstacle]]\npolyline = [{a:?}, {b:?}]"),
        };
    }
    world
}

/// Tries random worlds (more of them with `CPLAN_TIMES`), and checks that all proofs hold and have at most [`MOST`]
/// boxes.
#[test]
fn proofs_in_random_worlds_are_small() {
    let place = Place::new();
    let mut sizes = Vec::new();
    for seed in seeds(60) {
        let done = place.plan(world(seed), "--planner wavefront --output result.json --quiet");
        // A world whose start or goal collides is not a problem.
        if done.code == 1 {
            continue;
        }
        let result = place.json("result.json");
        assert_eq!(done.code == 3, result["status"] == "infeasible", "seed {seed}");
        if done.code == 3 {
            sizes.push((result["proof"].as_array().unwrap().len(), seed));
            let files = [shipped("robots/planar_2r.urdf"), "world.toml".into()];
            place.run(&[&["recheck".to_owned()], &files[..]].concat(), "--proof result.json").exits(0);
        }
    }
    sizes.sort_unstable();
    let count = sizes.len();
    assert!(count >= 5, "{count} proofs");
    println!("{count} proofs: median {:?}, largest {:?} (boxes, seed)", sizes[count / 2], sizes[count - 1]);
    // One in a thousand may have more.
    let large = sizes.iter().filter(|size| size.0 > MOST).count();
    assert!(large * 1000 <= count, "{:?}", &sizes[count - large..]);
}

/// Checks the world that, among 20 000 random ones, needs the most boxes in a proof by slabs, 130 596: obstacles that
/// overlap slightly close the space along a slanted line. A proof by halved boxes needs some hundreds.
#[test]
fn the_world_whose_slabs_take_the_most_boxes_has_a_small_proof() {
    let place = Place::new();
    place.plan(world(4605), "--planner wavefront --output result.json --quiet").exits(3);
    let result = place.json("result.json");
    let boxes = result["proof"].as_array().unwrap().len();
    assert!(boxes <= MOST, "{boxes} boxes");
    let files = [shipped("robots/planar_2r.urdf"), "world.toml".into()];
    place.run(&[&["recheck".to_owned()], &files[..]].concat(), "--proof result.json").exits(0);
}
