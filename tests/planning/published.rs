//! Published sweep counts. Those of the line maps need the folder that the environment variable `CPLAN_REFERENCE` names;
//! without it that test prints a note and checks nothing.

#[path = "../../examples/published_tables/alves.rs"]
mod alves;
#[path = "../../examples/published_tables/deicu.rs"]
mod deicu;
#[path = "../../examples/published_tables/line_maps.rs"]
mod line_maps;
#[path = "../../examples/published_tables/row.rs"]
mod row;

use row::Claim;
use std::path::PathBuf;

#[test]
fn line_maps_of_100_x_100_cells_take_the_published_sweeps() {
    let Some(data) = std::env::var_os("CPLAN_REFERENCE").map(|folder| PathBuf::from(folder).join("data")) else {
        println!("skipped: CPLAN_REFERENCE does not name the folder with data/map1.map");
        return;
    };
    // Map 3 is not printed as it was measured.
    for table in &deicu::TABLES[..2] {
        let scene = deicu::scene(table, &data).unwrap_or_else(|e| panic!("{e}"));
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
fn whatever_does_not_match_has_a_reason() {
    assert!(deicu::TABLES.iter().all(|table| !table.notes.is_empty()));
    assert!(!deicu::METHOD.is_empty() && !alves::NOTES.is_empty());
}

#[test]
fn the_unfurnished_room_takes_the_same_multiple_of_the_published_sweeps_for_every_goal() {
    let ratios: Vec<f64> = alves::rows().iter().map(|(_, count)| count.measured.unwrap() / count.published).collect();
    assert!(ratios[..3].iter().all(|ratio| (2.15..2.24).contains(ratio)), "{ratios:?}");
    assert!(ratios[3..].iter().all(|ratio| (1.21..1.24).contains(ratio)), "{ratios:?}");
}
