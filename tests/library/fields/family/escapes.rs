//! Escapes from the local minima of attraction and repulsion.

use super::khatib::u_trap;
use super::planner::{drawn, found, grid, is_free, reason, run, scene};
use cplan::cspace::{Grid, ZonedGrid};
use cplan::field::{Attraction, Escape, FreeCells, Khatib, Limits, Neighborhood, Repulsion, StepLabels, UNREACHED};
use cplan::planner::{FieldChoice, FieldPlanner, Note, PathKind, Run};
use proptest::prelude::*;

fn field_planner(escape: Option<Escape>) -> FieldPlanner {
    let laws = Khatib {
        attraction: Attraction::Linear(0.7),
        repulsion: Repulsion::Ranged { gain: 2.0, range: 3.0 },
        saturated: false,
    };
    FieldPlanner { field: FieldChoice::Khatib(laws), limits: Limits::Reflecting, escape, path: PathKind::Own }
}

fn escape_counts(run: &Run) -> (&'static str, usize, usize) {
    match run.note {
        Some(Note::Escaped { how, minima, moves }) => (how, minima, moves),
        note => panic!("{note:?}"),
    }
}

/// Samples a path densely, and checks that every point is in a free cell.
fn check_path_is_free(grid: &Grid, run: &Run) {
    for (a, b) in found(run).segments() {
        for k in 0..=40 {
            let q = a + (b - a) * (f64::from(k) / 40.0);
            assert!(is_free(grid, q), "{q:?}");
        }
    }
}

#[test]
fn escapes_from_the_u_are_reported() {
    let (grid, start, goal) = u_trap();
    let zoned = ZonedGrid::new(grid, &scene(Vec::new()));
    assert!(reason(&run(field_planner(None), &zoned, start, goal)).contains("local minimum of "));
    for escape in [Escape::Wave, Escape::Walk { seed: 1 }, Escape::Walk { seed: 2 }] {
        let out = run(field_planner(Some(escape)), &zoned, start, goal);
        check_path_is_free(&zoned.grid, &out);
        assert_eq!(found(&out).goal(), zoned.grid.center(goal));
        let (how, minima, moves) = escape_counts(&out);
        // The path leaves the trap over at least seven cells, and returns along its side.
        assert!(
            how == escape.description() && minima >= 1 && moves >= 10,
            "{escape:?}: {minima} minima, {moves} moves"
        );
        assert_eq!(run(field_planner(Some(escape)), &zoned, start, goal), out, "{escape:?} is the same each time");
        let text = out.note.unwrap().to_string();
        let method = if escape == Escape::Wave { "by a wave through the minimum's basin" } else { "by random walks" };
        assert!(text.starts_with("escaped from ") && text.contains(method), "{text}");
    }
    let [one, two] =
        [1, 2].map(|seed| found(&run(field_planner(Some(Escape::Walk { seed })), &zoned, start, goal)).clone());
    assert!(one != two, "another seed walks another way");
}

#[test]
fn paths_without_minima_are_unchanged() {
    let zoned = ZonedGrid::new(
        drawn("..............\n......##......\n......###.....\n..............\n.............."),
        &scene(Vec::new()),
    );
    let (start, goal) = (4 * 14, 13);
    let plain = run(field_planner(None), &zoned, start, goal);
    for escape in [Escape::Wave, Escape::Walk { seed: 5 }] {
        let same = run(field_planner(Some(escape)), &zoned, start, goal);
        assert_eq!((found(&same), same.note), (found(&plain), None));
    }
}

proptest! {
    #![proptest_config(cplan_cases::cases(150))]

    /// Checks that with a wave, the planner finds a path exactly if free cells connect start and goal, also on circles.
    #[test]
    fn with_a_wave_the_goal_is_found_wherever_it_is_connected(
        rows in 2..14_usize, columns in 2..14_usize, circles in any::<[bool; 2]>(), density in 0.0..0.5_f64,
        cells in proptest::collection::vec(0.0..1.0_f64, 196), ends in any::<[proptest::sample::Index; 2]>(),
    ) {
        let n = rows * columns;
        let blocked: Vec<bool> = cells[..n].iter().map(|&draw| draw < density).collect();
        let [start, goal] = ends.map(|end| end.index(n));
        prop_assume!(!blocked[start] && !blocked[goal]);
        let zoned = ZonedGrid::new(grid([rows, columns], circles, blocked), &scene(Vec::new()));
        let labels = StepLabels::new(&FreeCells::new(&zoned.grid), &[goal], Neighborhood::Four).into_labels();
        let out = run(field_planner(Some(Escape::Wave)), &zoned, start, goal);
        let is_found = matches!(out.outcome, cplan::planner::Proposal::Found(_));
        prop_assert_eq!(is_found, labels[start] != UNREACHED, "{:?}", out.outcome);
        if is_found {
            check_path_is_free(&zoned.grid, &out);
        }
    }
}
