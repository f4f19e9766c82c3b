//! Passages of a few cells.

use super::{Place, shipped};

/// Problem A: a passage of 0.070 rad among cells of 0.025 rad. Grids of wholly free cells show it at 1024 x 1024 only.
#[test]
fn fields_find_a_passage_of_three_cells_without_a_finer_grid() {
    let problem = ["arm.urdf", "a.toml"].map(|file| shipped(&format!("benches/peers/problems/{file}")));
    for planner in ["harmonic", "wavefront"] {
        let done = Place::new().run(&problem, &format!("--planner {planner} --json"));
        assert_eq!(done.code, 0, "{planner}: {}", done.stderr);
        let result = done.json();
        assert_eq!(result["certified"], true, "{planner}");
        let cells = result["size"]["cells"].as_u64().unwrap();
        assert!((10_000..=256 * 256).contains(&cells), "{planner}: {cells} cells");
    }
}
