//! Published sweep counts.

use cplan_testkit::published::plain::{Beyond, Choice, Plain, Rule};
use cplan_testkit::published::row::{self, Claim};
use cplan_testkit::published::search::{self, Maps, OF_GAUSS_SEIDEL, OF_SOR, Tally};
use cplan_testkit::published::{alves, deicu};

#[test]
fn line_maps_of_100_x_100_cells_take_the_published_sweeps() {
    // The printed map 3 is not the measured one.
    for table in &deicu::TABLES[..2] {
        let scene = deicu::scene(table).unwrap_or_else(|e| panic!("{e}"));
        let lines = deicu::lines(table, &scene, &[0]);
        assert_eq!(lines.len(), 12);
        for line in &lines {
            assert!(line.counts().all(row::Count::holds), "{}: {line}", table.title);
        }
        let exact = |count: &&row::Count| count.claim == Claim::Match;
        assert!(lines.iter().flat_map(deicu::Line::counts).filter(exact).count() >= 7, "{}", table.title);
    }
}

#[test]
fn the_unfurnished_room_takes_the_same_multiple_of_the_published_sweeps_for_every_goal() {
    let ratios: Vec<f64> = alves::rows().iter().map(|(_, count)| count.measured.unwrap() / count.published).collect();
    assert!(ratios[..3].iter().all(|ratio| (2.15..2.24).contains(ratio)), "{ratios:?}");
    assert!(ratios[3..].iter().all(|ratio| (1.21..1.24).contains(ratio)), "{ratios:?}");
}

/// Checks the statistics that docs/convergence.md states for 100 x 100 cells.
#[test]
fn the_tally_of_the_published_counts_holds() {
    let maps = Maps::read().unwrap_or_else(|e| panic!("{e}"));
    let counts = |relaxations, choice: &Choice| -> Vec<[usize; 3]> {
        let numbers = |tally: &Tally| [tally.exact(), tally.within_2(), tally.within_5_per_cent()];
        maps.all(relaxations, choice, 0).iter().map(numbers).collect()
    };
    assert_eq!(counts([0, 1], &OF_GAUSS_SEIDEL), [[3, 4, 6], [4, 4, 4], [0, 1, 2]]);
    assert_eq!(counts([2, 3], &OF_SOR), [[2, 2, 3], [4, 4, 4], [0, 0, 4]]);
    // The value 0.999999 is special: values near it explain fewer counts.
    for beyond in [Beyond::Kept, Beyond::Clamped, Beyond::Reset(0.999_998), Beyond::Reset(0.999_999_9)] {
        let other = search::together(maps.harmonic([2, 3], &Choice { beyond, ..OF_SOR }, 0));
        assert!(other.exact() <= 1, "{beyond:?}: {other}");
    }
}

/// Checks that two relaxations without common code, that of the example and that of the library, report the same
/// counts.
#[test]
fn the_plain_relaxation_counts_what_the_library_counts() {
    use cplan::field::{
        Boundary, Cell, Domain, Equation, Factor, Levels, Lines, Measure, Order, Precision, Relaxation, Scan, Stopping,
        relax,
    };
    let n = 24;
    let inside = |cell: usize| [cell / n, cell % n].iter().all(|k| (1..n - 1).contains(k));
    let kinds = (0..n * n).map(|cell| match cell {
        cell if !inside(cell) || (cell % n == 9 && cell / n > 5) => Cell::Obstacle,
        cell if cell == 4 * n + 17 => Cell::Goal,
        _ => Cell::Free,
    });
    let domain = Domain::new([n, n], kinds.collect(), [Boundary::High; 2], Levels::PUBLISHED);
    let (rows, corners) = (Order::Lines(Scan::ROWS), Order::Corners(Lines::Rows));
    let relaxations = [
        Relaxation::gauss_seidel(rows),
        Relaxation::gauss_seidel(corners),
        Relaxation::sor(Factor::Formula, rows),
        Relaxation::sor(Factor::Formula, corners),
    ];
    for (rule, measure) in [
        (Rule::SumOfChanges, Measure::SumOfChange),
        (Rule::DifferenceOfSums, Measure::DifferenceOfSums),
        (Rule::SumOfSquares, Measure::SumOfSquares),
        (Rule::GreatestChange, Measure::GreatestChange),
    ] {
        for (of, relaxation) in relaxations.iter().enumerate() {
            for single in [false, true] {
                let choice = Choice { single, beyond: Beyond::Clamped, rule, tolerance: 1e-4 };
                let precision = if single { Precision::Single } else { Precision::Double };
                let relaxation = relaxation.clamped([0.0, 1.0]).with_precision(precision);
                let stopping = Stopping { measure, below: 1e-4, max_sweeps: 1_500 };
                let field = relax(&domain, &Equation::Harmonic, &relaxation, &stopping).unwrap();
                let sweeps = field.converged().then(|| field.sweeps());
                assert_eq!(Plain::new(&domain).relax(of, &choice, |_, _| 0.0), sweeps, "{choice}, {relaxation}");
            }
        }
    }
}
