//! Passages of a few cells, and walls for which strips of joint 1 are rarely fine enough.

use super::*;
/// Checks benchmark problem A, which has a passage of 0.070 rad, on cells of 0.025 rad. A grid of cells that are free
/// as a whole would need 1024 x 1024 cells to contain the passage.
#[test]
fn fields_find_a_passage_of_three_cells_without_a_finer_grid() {
    let problem = ["arm.urdf", "a.toml"].map(|file| shipped(&format!("benches/peers/problems/{file}")));
    for planner in ["harmonic", "wavefront"] {
        let result = Place::new().run(&problem, &format!("--planner {planner} --json")).exits(0).json();
        assert_eq!(result["certified"], true, "{planner}");
        let cells = result["size"]["cells"].as_u64().unwrap();
        assert!((10_000..=256 * 256).contains(&cells), "{planner}: {cells} cells");
    }
}

/// Checks a slide of hundreds of metres beside a star. However fine the strips are, a taut path leads through a side of
/// the star. The planner must search again, and must not build a visibility graph after millions of strips.
#[test]
fn paths_that_lead_through_walls_are_searched_again() {
    let place = Place::new();
    let shape = |at: &str, size: &str| {
        format!("<collision><origin xyz=\"{at} 0 0\"/><geometry><box size=\"{size} 100 100\"/></geometry></collision>")
    };
    let joint = |name: &str, kind: &str, [parent, child]: [&str; 2], axis: &str, rest: &str| {
        format!(
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/><axis xyz=\"{axis}\"/>{rest}</joint>"
        )
    };
    let slide = "<origin xyz=\"101 0 0\"/><limit lower=\"-1000\" upper=\"308\" effort=\"1\" velocity=\"3000\"/>";
    let links =
        format!("<link name=\"l1\">{}</link><link name=\"l2\">{}</link>", shape("-93", "388"), shape("456", "1439"));
    let joints = joint("turn", "continuous", ["base", "l1"], "0 0 1", "")
        + &joint("slide", "prismatic", ["l1", "l2"], "1 0 0", slide);
    place.write("crane.urdf", format!("<robot name=\"crane\"><link name=\"base\"/>{links}{joints}</robot>"));
    place.write(
        "world.toml",
        "clearance = 1.0\nrobot.own_body = false\n[start]\njoints = [-0.836678, -785.563]\n[goal]\njoints = [0.983404, -590.242]\n[[obstacle]]\n\
         polyline = [[513, -13], [987, 889], [-18, 717], [-729, 1447], [-876, 438], [-1790, -13], [-876, -464], [-729, -1473], \
         [-18, -743], [987, -916], [513, -13]]\n",
    );
    let done = place.run(&["crane.urdf", "world.toml"], "--verbose --output plan.json").exits(0);
    let plan: serde_json::Value = place.json("plan.json");
    assert!(plan["optimum"]["gap"].as_f64().unwrap() <= 1e-4, "{}", done.stdout);
    done.says(&[" slices"]);
}
