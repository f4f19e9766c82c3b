//! Compares motions that are reported as closed with distances by brute force.

use super::*;
use crate::tests::scene;
use cplan_geometry::hull;
use cplan_model::space::JointRange;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Number of samples along a line at which the distance of the shapes is computed.
const SAMPLES: usize = 96;

/// A test case: a link, an obstacle, and two slices.
#[derive(Debug, Clone)]
struct Case {
    scene: Scene,
    clearance: f64,
    rows: [f64; 2],
    /// Two values of joint 2, as shares of its range.
    others: [f64; 2],
}

/// Generates a thin segment, a capsule, a disc or a polygon. Segments begin at the origin.
fn shape(spread: f64) -> impl Strategy<Value = Convex> {
    let at = move || (-spread..spread, -spread..spread).prop_map(|(x, y)| Point::new(x, y));
    let thin = at().prop_map(|end| Convex::trusted(vec![Point::zeros(), end], 0.0));
    let capsule = (at(), 0.01..0.2_f64).prop_map(|(end, radius)| Convex::trusted(vec![Point::zeros(), end], radius));
    let disc = (at(), 0.05..0.3_f64).prop_map(|(center, radius)| Convex::trusted(vec![center], radius));
    let polygon = (prop::collection::vec(at(), 3..7), prop_oneof![Just(0.0), 0.0..0.1_f64])
        .prop_map(|(points, radius)| Convex::trusted(hull(&points), radius));
    prop_oneof![thin, capsule, disc, polygon]
}

/// Generates cases with all kinds of arms, including those with joint 2 on the axis of joint 1.
fn case() -> impl Strategy<Value = Case> {
    let far = JointRange::Interval { lower: -4.0, upper: 5.0 };
    let arm = ([any::<bool>(); 2], any::<bool>(), prop_oneof![Just((0.0, 0.0)), (-0.7..0.7_f64, -0.7..0.7_f64)]);
    let at = (-1.0..1.0_f64, -1.0..1.0_f64);
    let rows = (-3.0..3.0_f64, prop_oneof![0.001..0.02_f64, 0.02..0.3_f64]);
    let others = (0.0..=1.0_f64, 0.0..=1.0_f64);
    let clearance = prop_oneof![3 => Just(0.0), 1 => 0.0..0.1_f64];
    (arm, shape(0.8), shape(0.6), at, rows, others, clearance).prop_map(
        move |((turns, round, offset), part, piece, at, (middle, half), others, clearance)| {
            let moved = piece.core().iter().map(|p| p + Vector::new(at.0, at.1)).collect();
            let second = if turns[1] && round { JointRange::Circle } else { far };
            let piece = Convex::trusted(moved, piece.radius());
            let scene = scene(turns, [far, second], Vector::new(offset.0, offset.1), part, piece);
            Case { scene, clearance, rows: [middle - half, middle + half], others: [others.0, others.1] }
        },
    )
}

/// Returns the least distance of two convex cores; 0 if they intersect.
fn core_distance(a: &[Point], b: &[Point]) -> f64 {
    let cross = |u: Vector, v: Vector| u.x * v.y - u.y * v.x;
    let sides = |core: &[Point]| -> Vec<[Point; 2]> {
        (0..core.len()).map(|i| [core[i], core[(i + 1) % core.len()]]).collect()
    };
    let holds = |core: &[Point], p: Point| {
        core.len() > 2 && sides(core).iter().all(|[from, to]| cross(to - from, p - from) >= 0.0)
    };
    let to_side = |p: Point, [from, to]: [Point; 2]| {
        let (along, length2) = (to - from, (to - from).norm_squared());
        let share = if length2 > 0.0 { ((p - from).dot(&along) / length2).clamp(0.0, 1.0) } else { 0.0 };
        (p - (from + along * share)).norm()
    };
    if b.iter().any(|p| holds(a, *p)) || a.iter().any(|p| holds(b, *p)) {
        return 0.0;
    }
    let mut least = f64::INFINITY;
    for one in sides(a) {
        for other in sides(b) {
            let parts = |[from, to]: [Point; 2], [p, q]: [Point; 2]| {
                cross(to - from, p - from) * cross(to - from, q - from) < 0.0
            };
            if parts(one, other) && parts(other, one) {
                return 0.0;
            }
            let ends = one.map(|p| to_side(p, other)).into_iter().chain(other.map(|p| to_side(p, one)));
            least = ends.fold(least, f64::min);
        }
    }
    least
}

impl Case {
    /// Returns lines between all walls of the slices, and to their copies a turn away, and one line between arbitrary
    /// values.
    fn lines(&self, closed: &mut SecondLinkWalls) -> Vec<[Configuration; 2]> {
        let [before, after] = self.rows.map(|q1| closed.walls(q1));
        let mut ends = Vec::new();
        for (left, right) in before.iter().flat_map(|left| after.iter().map(move |right| (left, right))) {
            let [from, to] = [left, right].map(|wall| f64::midpoint(wall.lower, wall.upper));
            ends.extend([-TAU, 0.0, TAU].map(|turn| [from, to + turn]));
            ends.push([f64::midpoint(left.lower.max(right.lower), left.upper.min(right.upper)); 2]);
        }
        let (lower, upper) = self.scene.arm().joints[1].range.domain();
        ends.push(self.others.map(|share| lower + share * (upper - lower)));
        ends.into_iter().map(|ends| [0, 1].map(|side| Configuration::new(self.rows[side], ends[side]))).collect()
    }

    /// Returns the greatest sampled distance of the shapes along a line.
    fn farthest(&self, [from, to]: [Configuration; 2]) -> f64 {
        let pair = self.scene.pairs()[0];
        let (part, piece) = (self.scene.part(pair), self.scene.piece(pair));
        let at = |k: usize| {
            let pose = self.scene.arm().pose(1, from + (to - from) * (k as f64 / SAMPLES as f64));
            let placed: Vec<Point> = part.core().iter().map(|&a| pose.point(a)).collect();
            core_distance(&placed, piece.core())
        };
        (0..=SAMPLES).map(at).fold(0.0, f64::max) - part.radius() - piece.radius()
    }
}

proptest! {
    #![proptest_config(cplan_cases::cases(10))]

    /// Tests that motions reported as closed collide everywhere, and that a good part of the lines is reported as
    /// closed.
    #[test]
    fn reported_closed_motions_collide_everywhere(cases in prop::collection::vec(case(), 60)) {
        let (mut lines, mut closed_lines) = (0, 0);
        for case in &cases {
            let mut closed = SecondLinkWalls::new(&case.scene, case.clearance);
            for line in case.lines(&mut closed) {
                if closed.pairs.is_empty() {
                    continue;
                }
                lines += 1;
                if closed.all_along(0, line[0], line[1]) {
                    closed_lines += 1;
                    let farthest = case.farthest(line);
                    prop_assert!(farthest <= case.clearance, "{} apart: {:?} in {:?}", farthest, line, case);
                }
            }
        }
        prop_assert!(closed_lines >= 15 && closed_lines * 8 >= lines, "{closed_lines} of {lines}");
    }
}
