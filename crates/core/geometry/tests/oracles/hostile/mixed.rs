//! Coordinates of all magnitudes from 1e-12 to 1e12 in one figure, against rational numbers.

use super::exact::{self, Pair};
use super::shapes::Shape;
use cplan_cases::dice;
use cplan_cases::dice::Dice;
use cplan_geometry::{Orientation, Point, orientation, point_on_segment, segments_cross, segments_meet};
use num_rational::BigRational;
use std::cmp::Ordering;

type Exact = Pair<BigRational>;

fn exact(p: Point) -> Exact {
    let number = |x: f64| BigRational::from_float(x).expect("finite");
    (number(p.x), number(p.y))
}

/// Returns zero, or a random number of magnitude 1e-`most` to 1e`most`.
fn coordinate(dice: &mut Dice, most: i32) -> f64 {
    let magnitude = 10_f64.powi(dice.about_zero(most.into()) as i32);
    let digits = match dice.below(4) {
        0 => 0.0,
        1 => 1.0,
        2 => dice.below(10) as f64,
        _ => dice.below(1_u64 << 53) as f64 / (1_u64 << 53) as f64,
    };
    if dice.below(2) == 0 { digits * magnitude } else { -digits * magnitude }
}

/// Returns a number moved by up to two units in the last place. Zero stays zero, because its neighbours do not have
/// these magnitudes.
fn nudged(dice: &mut Dice, x: f64) -> f64 {
    let steps = dice.about_zero(2);
    let step = |x: f64, _| {
        if x == 0.0 {
            x
        } else if steps > 0 {
            x.next_up()
        } else {
            x.next_down()
        }
    };
    (0..steps.abs()).fold(x, step)
}

/// Returns a point almost on the line of two others.
fn point_near_line(dice: &mut Dice, a: Point, b: Point, most: i32) -> Point {
    let t = match dice.below(4) {
        0 => 0.0,
        1 => 1.0,
        2 => dice.about_zero(4) as f64,
        _ => coordinate(dice, 12.min(most)),
    };
    // If the terms cancel, a coordinate can be smaller than all others; it is then replaced by 0.
    let largest = 10_f64.powi(most);
    let least = |x: f64| if x.abs() < 1.0 / largest { 0.0 } else { x.clamp(-largest, largest) };
    let p = a + (b - a) * t;
    Point::new(nudged(dice, least(p.x)), nudged(dice, least(p.y)))
}

/// Returns points; some are almost collinear, or coincide.
fn points<const N: usize>(dice: &mut Dice, most: i32) -> [Point; N] {
    let mut points = [Point::zeros(); N];
    for i in 0..N {
        points[i] = match i {
            0 | 1 => Point::new(coordinate(dice, most), coordinate(dice, most)),
            _ => {
                let (a, b) = (dice.below(i as u64) as usize, dice.below(i as u64) as usize);
                match dice.below(4) {
                    0 => Point::new(coordinate(dice, most), coordinate(dice, most)),
                    _ => point_near_line(dice, points[a], points[b], most),
                }
            }
        };
    }
    points
}

/// Compares the results for `draws` random draws of four points.
fn attack_segments(seed: u64, draws: usize, most: i32) {
    let mut dice = dice(seed);
    let mut counts = [0; 3];
    for _ in 0..draws {
        let points: [Point; 4] = points(&mut dice, most);
        let [a, b, c, d] = points;
        let [p, q, r, s] = &points.map(exact);
        let expected = match exact::side(p, q, r) {
            Ordering::Less => Orientation::Clockwise,
            Ordering::Equal => Orientation::Collinear,
            Ordering::Greater => Orientation::CounterClockwise,
        };
        assert_eq!(orientation(a, b, c), expected, "{points:?}");
        let (meet, cross) = exact::segments([p, q], [r, s]);
        assert_eq!((segments_meet(a, b, c, d), segments_cross(a, b, c, d)), (meet, cross), "{points:?}");
        assert_eq!(point_on_segment(d, a, b), exact::segments([p, q], [s, s]).0, "{points:?}");
        let collinear = expected == Orientation::Collinear;
        counts = [counts[0] + usize::from(collinear), counts[1] + usize::from(meet), counts[2] + usize::from(cross)];
    }
    assert!(counts.iter().all(|n| (draws / 50..draws).contains(n)), "{counts:?}");
}

/// Compares the results for `draws` random pairs of polygons.
fn attack_shapes(seed: u64, draws: usize, most: i32) {
    let mut dice = dice(seed);
    let mut met = 0;
    for _ in 0..draws {
        // Two polygons from one cloud, so that corners and sides are shared.
        let cloud: [Point; 6] = points(&mut dice, most);
        let pick = |dice: &mut Dice| {
            let count = 1 + dice.below(4);
            let corners: Vec<Point> = (0..count).map(|_| cloud[dice.below(6) as usize]).collect();
            let exact: Vec<Exact> = corners.iter().map(|&p| exact(p)).collect();
            Shape::hull(&corners, &exact)
        };
        let (a, b) = (pick(&mut dice), pick(&mut dice));
        met += usize::from(a.check(&b));
    }
    assert!((draws / 8..draws).contains(&met), "{met}");
}

#[test]
fn segments_of_sizes_1e_12_to_1e12_are_decided_exactly() {
    attack_segments(5, 20_000, 12);
}

#[test]
fn shapes_of_sizes_1e_12_to_1e12_are_decided_exactly() {
    attack_shapes(6, 400, 12);
}

/// Tests the full range for which the predicates are guaranteed: products of differences neither overflow nor
/// underflow.
#[test]
fn predicates_are_exact_in_their_full_range() {
    attack_segments(7, 2_000, 140);
    attack_shapes(8, 40, 90);
}
