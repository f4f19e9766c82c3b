//! Published sweep counts.

#[path = "../../examples/published_tables/alves.rs"]
#[allow(dead_code, reason = "notes are for readers of the tables")]
mod alves;
#[path = "../../examples/published_tables/deicu.rs"]
#[allow(dead_code, reason = "notes are for readers of the tables")]
mod deicu;
#[path = "../../examples/published_tables/line_maps.rs"]
mod line_maps;
#[path = "../../examples/published_tables/row.rs"]
mod row;

use crate::common::reference::published;
use row::Claim;

#[test]
#[ignore = "needs the published data that CPLAN_REFERENCE names"]
fn line_maps_of_100_x_100_cells_take_the_published_sweeps() {
    let data = published("data");
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
fn the_unfurnished_room_takes_the_same_multiple_of_the_published_sweeps_for_every_goal() {
    let ratios: Vec<f64> = alves::rows().iter().map(|(_, count)| count.measured.unwrap() / count.published).collect();
    assert!(ratios[..3].iter().all(|ratio| (2.15..2.24).contains(ratio)), "{ratios:?}");
    assert!(ratios[3..].iter().all(|ratio| (1.21..1.24).contains(ratio)), "{ratios:?}");
}
