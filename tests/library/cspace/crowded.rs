//! Regions among obstacles that have more pieces than are traced one by one: noisy walls, walks and spikes. Free places
//! are compared with distances between the arm's rectangles and every single piece, which brute force finds.

use cplan::cspace::{Regions, regions, traced_pairs};
use cplan::geometry::{Point, Pose, SimplePolygon, Vector, cross};
use cplan::model::{Arm, Heights, Obstacle, Scene, Shape, Workspace};
use cplan::space::{Configuration, JointRange};
use cplan_testkit::arms::rr;
use cplan_testkit::scenes::{placed, q};
use cplan_testkit::shapes::wall;
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
    Obstacle { name: "wall".into(), shape: Shape::Polyline(points), pieces, heights: Heights::ALL }
}

/// Returns a polygon with a corner in each of `count` directions, at different distances.
fn spiky(choice: u64, count: usize) -> Obstacle {
    let corner = |k: usize| {
        let (sin, cos) = (k as f64 / count as f64 * TAU).sin_cos();
        CENTER + Vector::new(cos, sin) * (0.1 + 0.1 * dice(choice, k))
    };
    let polygon = SimplePolygon::new((0..count).map(corner).collect()).expect("corners go round the centre");
    let pieces = polygon.convex_pieces();
    Obstacle { name: "spikes".into(), shape: Shape::Polygon(polygon.corners().to_vec()), pieces, heights: Heights::ALL }
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

fn to_segment(p: Point, [a, b]: [Point; 2]) -> f64 {
    let along = b - a;
    let share = (along.dot(&(p - a)) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (p - a - along * share).norm()
}

fn sides(ring: &[Point]) -> impl Iterator<Item = [Point; 2]> + Clone + '_ {
    (0..ring.len()).map(move |i| [ring[i], ring[(i + 1) % ring.len()]])
}

/// Returns the distance between two convex outlines from their corners and sides; 0 if they meet.
fn outline_distance(a: &[Point], b: &[Point]) -> f64 {
    let holds = |ring: &[Point], p: Point| ring.len() > 2 && sides(ring).all(|[u, v]| cross(v - u, p - u) >= 0.0);
    // Sides that touch or overlap have an end at distance 0 from the other.
    let beside = |[u, v]: [Point; 2], [p, q]: [Point; 2]| cross(v - u, p - u) * cross(v - u, q - u) < 0.0;
    let crossing = sides(a).any(|s| sides(b).any(|t| beside(s, t) && beside(t, s)));
    if crossing || holds(a, b[0]) || holds(b, a[0]) {
        return 0.0;
    }
    let one_way = |a: &[Point], b: &[Point]| {
        let to = |p: &Point| sides(b).map(|t| to_segment(*p, t)).fold(f64::INFINITY, f64::min);
        a.iter().map(to).fold(f64::INFINITY, f64::min)
    };
    one_way(a, b).min(one_way(b, a))
}

/// Returns the least distance of the two bars from all pieces.
fn clearance(scene: &Scene, at: Configuration) -> f64 {
    let bar = |length: f64| [(0.0, -0.05), (length, -0.05), (length, 0.05), (0.0, 0.05)];
    let turned = |from: Point, angle: f64, length: f64| {
        let (sin, cos) = angle.sin_cos();
        bar(length).map(|(x, y)| from + Vector::new(x * cos - y * sin, x * sin + y * cos))
    };
    let elbow = Point::new(at[0].cos(), at[0].sin());
    let links = [turned(Point::zeros(), at[0], 1.0), turned(elbow, at[0] + at[1], 0.8)];
    let pieces = scene.workspace().obstacles.iter().flat_map(|o| &o.pieces);
    pieces.flat_map(|piece| links.iter().map(|link| outline_distance(link, piece.core()))).fold(f64::INFINITY, f64::min)
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
