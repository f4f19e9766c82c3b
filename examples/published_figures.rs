//! Published figures of convergence, computed again: figures 39 to 47 of L. E. Deicu (2012) and 6.1 to 6.4 of M.
//! Oliveira da Silva (2011). Their curves are published only as pictures, so the statements of their text are printed
//! beside our numbers.
//!
//! ```text
//! cargo run --release --example published_figures
//! ```
//!
//! Figures 39 to 47 show map 1, which is `workspaces/maps/leon.toml`. The others show a state of play of our own. The
//! program prints numbers, and writes figures 6.1 to 6.4 as `target/figure_6_1.svg`.

use cplan::compare::{Setup, convergence};
use cplan::field::{
    Difference, Direction, Equation, Factor, Lines, Measure, Order, Precision, Relaxation, Scan, Stopping, trace,
};
use cplan_testkit::published::silva::Kind;
use cplan_testkit::published::{deicu, silva};
use std::error::Error;

/// Numbers of sweeps for which the error is printed: those with which the figures of the first source begin, and later
/// ones.
const SHOWN: [usize; 8] = [1, 20, 40, 100, 200, 500, 1000, 1400];

fn main() -> Result<(), Box<dyn Error>> {
    errors()?;
    factors()
}

/// Prints figures 39 to 47: the error after each number of sweeps, on map 1 with 100 x 100 cells.
fn errors() -> Result<(), Box<dyn Error>> {
    let scene = deicu::scene(&deicu::TABLES[0])?;
    let domain = scene.domain(100);
    println!("Figures 39 to 47: squared changes of a sweep on map 1, 100 x 100 cells, after so many sweeps;");
    println!("where preferences begin the error leaps, from the first of the two numbers to the second");
    print!("{:<24}", "");
    SHOWN.iter().for_each(|sweep| print!("{sweep:>9}"));
    println!("  preferences at");
    let [rows, corners] = [Order::Lines(Scan::ROWS), Order::Corners(Lines::Rows)];
    let relaxations = [
        Relaxation::gauss_seidel(rows).with_precision(Precision::Single),
        Relaxation::gauss_seidel(corners).with_precision(Precision::Single),
        Relaxation::sor(Factor::Formula, rows).clamped([0.0, 1.0]),
        Relaxation::sor(Factor::Formula, corners).clamped([0.0, 1.0]),
    ];
    for altered in [false, true] {
        for (of, relaxation) in relaxations.iter().enumerate() {
            let sign = if altered { -1.0 } else { 1.0 };
            let epsilon = scene.epsilon(100).into_iter().map(|epsilon| sign * epsilon).collect();
            let equation = match altered {
                true => Equation::AlteredPreference { epsilon },
                false => Equation::Preference { epsilon, difference: Difference::Central },
            };
            let stopping = Stopping { measure: Measure::SumOfChange, below: 0.01, max_sweeps: 30_000 };
            let run = trace(&domain, &equation, relaxation, &stopping, domain.start(), None)?;
            print!("{:<24}", format!("{} {}", ["BVP", "BVP 2"][usize::from(altered)], deicu::RELAXATIONS[of]));
            for shown in SHOWN {
                // The scan has a point every hundredth.
                let sample = run.samples.iter().find(|s| s.sweep >= shown);
                print!("{:>9}", sample.map_or_else(|| "-".into(), |sample| format!("{:.1e}", sample.squares)));
            }
            let leap = run.leap().ok_or("preferences begin")?;
            println!("  {}: {:.1e} to {:.1e}, {} in all", leap.sweep, leap.before, leap.after, run.sweeps);
        }
    }
    println!();
    Ok(())
}

/// Prints figures 6.1 to 6.4: the number of sweeps for factors of SOR, and for values of epsilon.
fn factors() -> Result<(), Box<dyn Error>> {
    let domain = silva::state(0.0);
    let kinds = [
        ("CPH", Kind::Harmonic, [1.9, 1.9]),
        ("CPO central", Kind::Oriented(Difference::Central), [1.9, 1.9]),
        ("CPO upwind", Kind::Oriented(Difference::Upwind), [1.5, 1.5]),
        ("CPLO central", Kind::LocallyOriented(Difference::Central), [1.8, 1.8]),
        ("CPLO upwind", Kind::LocallyOriented(Difference::Upwind), [1.7, 1.9]),
    ];
    let mut equations = Vec::new();
    for (name, kind, _) in kinds {
        equations.push((name.to_owned(), kind.equation(&domain, 0.0).ok_or("a direction")?));
    }
    for (k, order) in [Order::Lines(Scan::ROWS), Order::RedBlack].into_iter().enumerate() {
        let setup = Setup {
            title: "Robot soccer, a state of play of ours".into(),
            domain: &domain,
            equations: equations.clone(),
            direction: Direction::of([1.0, 0.0]).ok_or("a direction")?,
            order,
            stopping: silva::STOPPING,
        };
        let measured = convergence(&setup, &mut |_| {})?;
        println!("Figures 6.1 to 6.3, SOR {order}: best factor, published and ours from a standing start");
        for (scan, (name, _, published)) in measured.factors.iter().zip(kinds) {
            let best = scan.best().map_or_else(|| "-".into(), |p| format!("{:.2}, {} sweeps", p.at, p.sweeps));
            let theirs = scan.points.iter().find(|p| (p.at - published[k]).abs() < 1e-9);
            let theirs = theirs.and_then(|p| p.converged()).map_or_else(|| "-".into(), |sweeps| sweeps.to_string());
            println!("  {name:<13} {:.1} (takes {theirs:>4} here)   {best}", published[k]);
        }
        if k == 0 {
            println!(
                "Figures 6.1 to 6.3, weighted Jacobi (WJR): published 1.8 for all; ours, and the first that is lost"
            );
            for scan in &measured.weights {
                let shown = |point: Option<cplan::compare::Point>| {
                    point.map_or_else(|| "-".into(), |p| format!("{:.2} ({} sweeps)", p.at, p.sweeps))
                };
                println!("  {:<13} {}, lost at {}", scan.equation, shown(scan.best()), shown(scan.divergence_start()));
            }
        }
        println!(
            "Figure 6.4, Gauss-Seidel {order}: published: central differences diverge above 3.4, upwind ones do not"
        );
        for (difference, scan) in &measured.strengths {
            match scan.divergence_start() {
                Some(p) => println!("  {difference}: lost from {:.1} on ({:?})", p.at, p.ending),
                None => println!("  {difference}: converge up to 6"),
            }
        }
        if k == 0 {
            std::fs::create_dir_all("target")?;
            std::fs::write("target/figure_6_1.svg", measured.figure().svg())?;
        }
    }
    Ok(())
}
