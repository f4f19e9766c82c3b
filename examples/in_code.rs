//! An arm and a world in code: both predicates, a C-obstacle, two planners compared. `cargo run --example in_code`

use cplan::engine::Method;
use cplan::geometry::{Convex, penetration_depth, polygon_test};
use cplan::{Arm, Obstacle, Options, Outcome, Planner, Point, Problem, Workspace, plan};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let shelf = [[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3]];
    let table = [[1.0, -0.5], [1.8, -0.5], [1.8, -0.4], [1.0, -0.4]];

    // Predicates and Minkowski difference on the shapes themselves.
    let [a, b] = [shelf, table].map(|corners| Convex::new(corners.map(Point::from).to_vec(), 0.0));
    let (a, b) = (a?, b?);
    println!("shelf and table meet: {}, {:.2} m apart", polygon_test(&a, &b).meet, -penetration_depth(&a, &b));
    println!("their difference has {} corners", a.minkowski_difference(&b).core().len());

    // Two bars of 1.0 and 0.8 m, 6 cm wide, with continuous joints.
    let arm = Arm::rr([1.0, 0.8], 0.06)?;
    let workspace = Workspace::new([
        Obstacle::polygon("shelf", shelf)?,
        Obstacle::polygon("table", table)?,
        Obstacle::circle("post", [0.3, -0.6], 0.08)?,
    ]);
    let problem = Problem::new(arm, workspace, [-0.9, 0.4], [1.55, -0.35])?;

    for method in [Method::Shortest, Method::Harmonic] {
        let plan = plan(&problem, &Options { planner: Planner::named(method), ..Options::default() })?;
        match plan.outcome() {
            Outcome::Found(motion) => {
                let length = plan.length().unwrap_or_default();
                println!("{method}: length {length:.3}, {:.3} s, certified", motion.duration());
            }
            Outcome::Infeasible(_) => println!("{method}: there is no path, proven"),
            Outcome::Unknown(why) => println!("{method}: unknown, {why}"),
        }
    }
    Ok(())
}
