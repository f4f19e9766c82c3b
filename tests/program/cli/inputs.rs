//! Every kind of invalid input once through the program; `input_errors` has the details.

use super::*;
#[test]
fn bad_worlds_are_refused_with_their_place() {
    let place = Place::new();
    let obstacle = |shape: &str| format!("{FREE}[[obstacle]]\n{shape}\n").into_bytes();
    let with = |text: &str| format!("{FREE}{text}\n").into_bytes();
    let cases: &[(Vec<u8>, &str)] = &[
        (vec![], "there is no start"),
        ((0..=255).collect(), "UTF-8"),
        (b"name = \"Stra\xdfe\"\n".to_vec(), "UTF-8"),
        (b"[start\n".to_vec(), "line 1, column 7"),
        (b"colour = 1\n".to_vec(), "unknown key `colour`"),
        (with("[robot]\ncolour = 1"), "line 6, column 1"),
        (with("tip = [1, 1]"), "but has both"),
        (obstacle("radius = 1"), "unknown key `radius`"),
        (obstacle("name = \"x\""), "exactly one shape"),
        (obstacle("polyline = [[1, 1]]"), "at least two points"),
        (obstacle("circle = { center = [5, 5], radius = 0 }"), "must be positive"),
        (obstacle("circle = { center = [5, nan], radius = 1 }"), "line 6, column 25"),
        (obstacle("polygon = [[5, 5], [6, 6], [6, 5], [5, 6]]"), "sides 1 and 3 cross"),
        (obstacle("polygon = [[5, 5], [6, 5], [5, 5]]"), "at least three corners"),
        (obstacle("circle = { center = [5, 5], radius = 1 }\nheight = [1, 0]"), "is empty"),
        (FREE.replace("0.4", "inf").into_bytes(), "line 2, column 17"),
        (FREE.replace("-0.9", "\"10dog\"").into_bytes(), "expected a number"),
        (with("[robot]\nlimits = { elbow = [1, -1] }"), "lower (1)"),
        (with("[robot]\nvelocity = { wrist = 1 }"), "\"shoulder\", \"elbow\""),
    ];
    place.write("out.json", "kept");
    for (world, part) in cases {
        place.plan(world, "--output out.json --picture out.svg").refused(1, &["world.toml", part]);
    }
    assert_eq!(place.read("out.json"), "kept");
    assert!(!place.path("out.svg").exists());
}

#[test]
fn harmless_oddities_are_read() {
    let place = Place::new();
    for world in [format!("\u{feff}{FREE}"), FREE.replace('\n', "\r\n"), FREE.replace("-0.9", "-1")] {
        let done = place.plan(&world, "--quiet");
        assert_eq!((done.code, done.stdout.as_str(), done.stderr.as_str()), (0, "", ""), "{world:?}");
    }
}

#[test]
fn starts_and_goals_that_collide_name_link_obstacle_and_depth() {
    let place = Place::new();
    let world = format!("{FREE}[[obstacle]]\nname = \"post\"\ncircle = {{ center = [0.5, -0.6], radius = 0.1 }}\n");
    place.plan(&world, "").refused(1, &["world.toml: line 2", "link \"upper_arm\" hits obstacle \"post\"", " mm deep"]);
    place.plan(FREE, "--start 9,0").refused(1, &["--start", "exceeds its limits", "hint"]);
    place.plan(FREE, "--goal-tip 9,9").refused(1, &["--goal-tip", "out of reach", "hint"]);
    let far = format!("{FREE}[[obstacle]]\nname = \"far\"\ncircle = {{ center = [3, 0], radius = 0.1 }}\n");
    place.plan(format!("clearance = 3\n{far}"), "").refused(1, &["nearer than the clearance of 3 m", "hint"]);
    // A warning that the world may be in another unit comes first, because it may be the cause.
    let done = place.plan(&far, "--clearance 3");
    let is_said = |words: &str| done.stderr.contains(words);
    assert!(
        is_said("warning: no obstacle is within") && is_said("error: ") && is_said("clearance of 3 m"),
        "{}",
        done.stderr
    );
}

#[test]
fn files_other_than_urdf_are_refused() {
    let place = Place::new()
        .with("world.toml", FREE)
        .with("text.urdf", "hello")
        .with("cut.urdf", "<robot name=\"r\">\n  <link name=\"a\"");
    std::fs::create_dir(place.path("folder.urdf")).unwrap();
    for (file, part) in [("missing.urdf", "cannot be read"), ("folder.urdf", "cannot be read"), ("text.urdf", "XML")] {
        place.run(&[file, "world.toml"], "").refused(1, &[file, part, "hint"]);
    }
    place.run(&["cut.urdf", "world.toml"], "").refused(1, &["cut.urdf: line 1", "never closed", "hint"]);
    place.run(&["world.toml", &shipped("robots/planar_2r.urdf")], "").refused(1, &["URDF first"]);
}

#[cfg(target_os = "linux")]
#[test]
fn files_without_end_are_refused() {
    Place::new()
        .with("world.toml", FREE)
        .run(&["/dev/zero", "world.toml"], "")
        .refused(1, &["/dev/zero", "larger than"]);
}
