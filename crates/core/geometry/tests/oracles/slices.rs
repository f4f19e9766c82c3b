//! Arcs, stretches, slices and grids against distances of sampled configurations.

use cplan_geometry::{
    Convex, Features, Hits, Point, Pose, ROUNDING, Vector, separation, sliding, turning, turning_from,
};
use cplan_testkit::shapes::convex;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// Returns the convex hull by the monotone chain, without collinear points.
fn hull(mut points: Vec<(f64, f64)>) -> Vec<Point> {
    points.sort_by(|a, b| a.partial_cmp(b).unwrap());
    points.dedup();
    let cross = |o: (f64, f64), a: (f64, f64), b: (f64, f64)| (a.0 - o.0) * (b.1 - o.1) - (a.1 - o.1) * (b.0 - o.0);
    let half = |points: &mut dyn Iterator<Item = (f64, f64)>| {
        let mut chain: Vec<(f64, f64)> = Vec::new();
        for p in points {
            while chain.len() > 1 && cross(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 1e-12 {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut all = half(&mut points.iter().copied());
    all.extend(half(&mut points.iter().rev().copied()));
    if all.is_empty() {
        all.push(points[0]);
    }
    all.into_iter().map(|(x, y)| Point::new(x, y)).collect()
}

/// Generates shapes of every kind. Half of them have corners on a coarse lattice, for parallel sides and shared
/// distances.
fn shape(spread: f64) -> impl Strategy<Value = Convex> {
    let free = prop::collection::vec((-spread..spread, -spread..spread), 1..7);
    let lattice = prop::collection::vec((-2i32..=2, -2i32..=2), 1..7).prop_map(move |v| {
        v.iter().map(|&(x, y)| (f64::from(x) * spread / 2.0, f64::from(y) * spread / 2.0)).collect()
    });
    let radius = prop_oneof![Just(0.0), Just(0.25), 0.0..0.5f64];
    (prop_oneof![free, lattice], radius).prop_map(|(points, radius)| convex(hull(points), radius))
}

fn pivot() -> impl Strategy<Value = Point> {
    let lattice = (-2i32..=2, -2i32..=2).prop_map(|(x, y)| Point::new(f64::from(x) * 0.5, f64::from(y) * 0.5));
    prop_oneof![(-3.0..3.0, -3.0..3.0).prop_map(|(x, y)| Point::new(x, y)), lattice]
}

fn distance_at(part: &Convex, pivot: Point, angle: f64, piece: &Convex) -> f64 {
    separation(&part.at(&Pose::new(pivot, angle)), piece).distance
}

fn contains_angle(arcs: &[[f64; 2]], angle: f64) -> bool {
    arcs.iter().any(|a| [-TAU, 0.0, TAU].iter().any(|turn| a[0] <= angle + turn && angle + turn <= a[1]))
}

/// Compares arcs with the distance at sampled angles, between them and about their ends.
fn check_turning(part: &Convex, pivot: Point, piece: &Convex, grow: f64) -> Result<(), TestCaseError> {
    let mut arcs = Vec::new();
    let hits = turning(part, pivot, piece, grow, &mut arcs);
    prop_assert_eq!(hits == Hits::Within, !arcs.is_empty());
    for a in &arcs {
        prop_assert!((-PI..PI).contains(&a[0]) && a[0] <= a[1] && a[1] < a[0] + TAU, "{:?}", a);
    }
    for w in arcs.windows(2) {
        prop_assert!(w[0][1] < w[1][0], "{:?}", arcs);
    }
    let mut angles: Vec<f64> = (0..360).map(|i| -PI + (f64::from(i) + 0.37) * TAU / 360.0).collect();
    for a in &arcs {
        for end in a {
            for step in [1e-4, 1e-6, 1e-8] {
                angles.extend([end - step, end + step]);
            }
        }
        angles.push((a[0] + a[1]) / 2.0);
    }
    for angle in angles {
        let distance = distance_at(part, pivot, angle, piece) - grow;
        let inside = match hits {
            Hits::Never => false,
            Hits::Always => true,
            Hits::Within => contains_angle(&arcs, angle),
        };
        if inside {
            prop_assert!(distance <= ROUNDING, "named, but {} apart at {}: {:?}", distance, angle, arcs);
        } else {
            prop_assert!(distance >= -ROUNDING, "left out, but {} deep at {}: {:?}", distance, angle, arcs);
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(cplan_cases::cases(2000))]

    #[test]
    fn arcs_agree_with_sampled_distances(
        part in shape(1.0), pivot in pivot(), piece in shape(1.0), grow in prop_oneof![Just(0.0), 0.0..0.3f64, Just(1e-6)],
    ) {
        check_turning(&part, pivot, &piece, grow)?;
    }

    #[test]
    fn arcs_count_from_the_given_direction(part in shape(1.0), pivot in pivot(), piece in shape(1.0), zero in -4.0..4.0f64) {
        let (mut plain, mut counted) = (Vec::new(), Vec::new());
        let (part, piece) = (Features::new(&part), Features::new(&piece));
        let hits = turning_from(&part, pivot, Vector::x(), &piece, 0.1, &mut plain);
        let same = turning_from(&part, pivot, Vector::new(zero.cos(), zero.sin()), &piece, 0.1, &mut counted);
        prop_assert_eq!(hits, same);
        prop_assert_eq!(plain.len(), counted.len());
        for a in &counted {
            prop_assert!(plain.iter().any(|b| {
                let off = a[0] + zero - b[0];
                (off - (off / TAU).round() * TAU).abs() < 1e-6 && (a[1] - a[0] - b[1] + b[0]).abs() < 1e-6
            }), "{:?} {:?}", plain, counted);
        }
    }

    #[test]
    fn the_stretch_agrees_with_sampled_distances(
        part in shape(1.0), piece in shape(1.0), angle in prop_oneof![Just(0.0), -PI..PI], grow in prop_oneof![Just(0.0), 0.0..0.3f64],
    ) {
        let direction = Vector::new(angle.cos(), angle.sin());
        let interval = sliding(&part, direction, &piece, grow);
        let mut values: Vec<f64> = (-200..=200).map(|i| f64::from(i) * 0.0251).collect();
        if let Some([low, high]) = interval {
            prop_assert!(low <= high);
            values.extend([low, high].iter().flat_map(|s| [s - 1e-6, *s, s + 1e-6]));
        }
        for s in values {
            let distance = separation(&part.at(&Pose::new(direction * s, 0.0)), &piece).distance - grow;
            if interval.is_some_and(|[low, high]| low <= s && s <= high) {
                prop_assert!(distance <= ROUNDING, "named, but {} apart at {}", distance, s);
            } else {
                prop_assert!(distance >= -ROUNDING, "left out, but {} deep at {}", distance, s);
            }
        }
    }
}
