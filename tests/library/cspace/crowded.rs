//! Regions among obstacles that have more pieces than are traced one by one: noisy walls, walks and spikes. Free places
//! are compared with distances between the arm's rectangles and every single piece, which brute force finds.

use cplan::cspace::{Regions, regions, traced_pairs};
use cplan::geometry::{Point, Pose, SimplePolygon, Vector};
use cplan::model::{Arm, Growth, Heights, Obstacle, Scene, Shape, Workspace};
use cplan::space::{Configuration, JointRange};
use cplan_testkit::arms::rr;
use cplan_testkit::scenes::{placed, q};
use cplan_testkit::shapes::{convex, rectangle, wall};
use cplan_testkit::solid::Solid;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Largest number of pieces of an obstacle that are traced one by one. More pieces are replaced by larger shapes that
/// cover them.
const PLAIN: usize = 512;

/// Returns the `k`-th random number of the seed `choice`, in `[0, 1)` (SplitMix64).
fn dice(choice: u64, k: usize) -> f64 {
    let z = choice.wrapping_add((k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

const CENTER: Point = Point::new(1.2, 0.3);

/// Returns a polyline of `count` points: a random walk, or a noisy zigzag.
fn polyline(choice: u64, count: usize, walks: bool) -> Obstacle {
    let mut at = CENTER;
    let step = |k: usize| Vector::new(dice(choice, 2 * k) - 0.5, dice(choice, 2 * k + 1) - 0.5);
    let points: Vec<Point> = (0..count)
        .map(|k| {
            if walks {
                // The walk stays within a square, so that it crosses itself many times.
                at += step(k) * 0.03;
                at = at.sup(&(CENTER - Vector::repeat(0.2))).inf(&(CENTER + Vector::repeat(0.2)));
                at
            } else {
                let noise = step(k) * 0.02;
                Point::new(0.9 + 0.6 * k as f64 / count as f64, 0.2 + 0.1 * (k % 2) as f64) + noise
            }
        })
        .collect();
    let pieces = points.windows(2).filter(|w| w[0] != w[1]).map(|w| wall(w[0], w[1])).collect();
    Obstacle {
        name: "wall".into(),
        shape: Shape::Polyline(points),
        pieces,
        heights: Heights::ALL,
        growth: Growth::default(),
    }
}

/// Returns a polygon with a corner in each of `count` directions, at different distances.
fn spiky(choice: u64, count: usize) -> Obstacle {
    let corner = |k: usize| {
        let (sin, cos) = (k as f64 / count as f64 * TAU).sin_cos();
        CENTER + Vector::new(cos, sin) * (0.1 + 0.1 * dice(choice, k))
    };
    let polygon = SimplePolygon::new((0..count).map(corner).collect()).expect("corners surround the centre");
    let pieces = polygon.convex_pieces();
    Obstacle {
        name: "spikes".into(),
        shape: Shape::Polygon(polygon.corners().to_vec()),
        pieces,
        heights: Heights::ALL,
        growth: Growth::default(),
    }
}

fn obstacle(kind: usize, choice: u64, count: usize) -> Obstacle {
    match kind {
        0 => polyline(choice, count, true),
        1 => polyline(choice, count, false),
        _ => spiky(choice, count),
    }
}

fn arm() -> Arm {
    rr([JointRange::Interval { lower: -2.8, upper: 2.8 }; 2])
}

fn scene(obstacle: Obstacle) -> Scene {
    let obstacles = vec![obstacle];
    placed(arm(), Workspace { name: "crowded".into(), obstacles, clearance: 0.0, preferences: Vec::new() })
}

/// Returns the least distance of the two bars from all pieces, or the negative depth.
fn clearance(scene: &Scene, at: Configuration) -> f64 {
    let bar = |length: f64| Solid::new(&rectangle(0.0, length, -0.05, 0.05));
    let (sin, cos) = at[0].sin_cos();
    let both = (at[0] + at[1]).sin_cos();
    let links = [bar(1.0).placed([cos, sin], [0.0; 2]), bar(0.8).placed([both.1, both.0], [cos, sin])];
    // Pieces may have more corners than a solid, but their triangles do not.
    let triangles = |core: &[Point]| match core {
        [first, rest @ ..] if rest.len() > 1 => rest.windows(2).map(|side| vec![*first, side[0], side[1]]).collect(),
        _ => vec![core.to_vec()],
    };
    let pieces = scene.workspace().obstacles.iter().flat_map(|o| &o.pieces);
    let solids = pieces.flat_map(|piece| triangles(piece.core())).map(|core| Solid::new(&convex(core, 0.0)));
    solids.flat_map(|solid| links.map(|link| link.distance(&solid))).fold(f64::INFINITY, f64::min)
}

fn is_free(regions: &Regions, at: Configuration) -> bool {
    regions.free.iter().any(|polygon| polygon.contains(at))
}

proptest! {
    #![proptest_config(cplan_cases::cases(4))]

    /// Checks how tight the displayed free space is. Free places in it keep a quarter of the margin, and places that
    /// keep three margins are free in it.
    #[test]
    fn displayed_free_space_is_tight(
        kind in 0..3_usize, choice in any::<u64>(), margin in prop_oneof![Just(2e-3), 2e-3..0.05f64],
    ) {
        let scene = scene(obstacle(kind, choice, 1100));
        prop_assert!(scene.pairs().len() > 2 * PLAIN);
        let shown = regions(&scene, margin, q(0.0, 0.0), 1);
        let (mut free, mut blocked) = (0, 0);
        for k in 0..160 {
            // Half of the configurations reach towards the obstacle.
            let range = if k % 2 == 0 { 2.8 } else { 0.9 };
            let at = q((dice(choice, 7919 + 2 * k) * 2.0 - 1.0) * range, (dice(choice, 7920 + 2 * k) * 2.0 - 1.0) * range);
            let distance = clearance(&scene, at);
            if is_free(&shown, at) {
                free += 1;
                prop_assert!(distance >= 0.25 * margin - 1e-9, "{distance} at {at:?}");
            } else {
                blocked += 1;
                prop_assert!(distance <= 3.0 * margin, "{distance} at {at:?}");
            }
        }
        prop_assert!(!cplan_cases::uses_default_cases() || free > 10 && blocked > 5, "{free} {blocked}");
    }
}

/// Checks that the number of traced shapes depends on the margin and the room, but not on the number of corners. In a
/// filled room, more corners leave fewer gaps between them.
#[test]
fn ten_times_the_corners_in_the_same_room_are_no_more_to_trace() {
    for kind in 0..3 {
        let traced = |count: usize| traced_pairs(&scene(obstacle(kind, 1, count)), 8e-3);
        let (some, many) = (traced(8_000), traced(80_000));
        assert!(many <= some && many < 2_000, "{kind}: {some} of 8000, {many} of 80000");
    }
}

/// Checks that pieces which the arm cannot come near to are not traced at all.
#[test]
fn obstacles_out_of_reach_are_not_traced() {
    let mut far = polyline(3, 5_000, true);
    far.pieces = far.pieces.iter().map(|piece| piece.at(&Pose::translation(Vector::new(9.0, 0.0)))).collect();
    far.shape = far.shape.at(&Pose::translation(Vector::new(9.0, 0.0)));
    assert_eq!(traced_pairs(&scene(far), 2e-3), 0);
}
