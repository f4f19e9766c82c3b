//! Do two convex polygons meet, and how deep? `cargo run --example predicates`

use cplan::geometry::{Convex, ConvexError, Point, penetration_depth, point_penetration, polygon_test};

/// Returns an axis-parallel rectangle.
fn rectangle(x: [f64; 2], y: [f64; 2]) -> Result<Convex, ConvexError> {
    let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, k)| Point::new(x[i], y[k]));
    Convex::new(corners.to_vec(), 0.0)
}

fn main() -> Result<(), ConvexError> {
    let bar = rectangle([-3.0, 3.0], [-0.5, 0.5])?;
    let wall = Convex::segment(Point::new(0.0, -2.0), Point::new(0.0, 2.0))?;
    let cases = [
        ("crossing bars", rectangle([-0.5, 0.5], [-3.0, 3.0])?),
        ("a corner inside", rectangle([2.0, 4.0], [0.25, 2.0])?),
        ("touching along a side", rectangle([3.0, 4.0], [-0.5, 0.5])?),
        ("touching in a corner", rectangle([3.0, 4.0], [0.5, 2.0])?),
        ("apart by one rounding step", rectangle([3f64.next_up(), 4.0], [-0.5, 0.5])?),
        ("a wall without thickness", wall),
    ];

    println!("A bar, 6 m by 1 m, against:");
    println!(
        "{:28}{:>6}{:>16}{:>16}{:>11}{:>10}",
        "", "meet", "its corners in", "corners in it", "crossings", "depth/m"
    );
    for (name, other) in cases {
        let test = polygon_test(&bar, &other);
        let depth = penetration_depth(&bar, &other);
        println!(
            "{name:28}{:>6}{:>16}{:>16}{:>11}{depth:>10.1e}",
            if test.meet { "yes" } else { "no" },
            test.b_inside.len(),
            test.a_inside.len(),
            test.crossings.len(),
        );
    }

    println!("\nPoints in the bar:");
    for point in [Point::new(2.75, 0.0), Point::new(0.0, 0.5), Point::new(0.0, 2.0)] {
        let found = point_penetration(point, &bar);
        println!("({}, {}): {:?}, depth {} m", point.x, point.y, found.location, found.depth);
    }
    Ok(())
}
