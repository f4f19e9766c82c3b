//! Checks that no output overwrites an input or another output, however their paths are written.

use super::*;

/// Returns a folder with a robot and a world in which one can plan.
fn place() -> Place {
    let place = Place::new()
        .with("arm.urdf", std::fs::read(shipped("robots/planar_2r.urdf")).unwrap())
        .with("world.json", FREE);
    std::fs::create_dir(place.path("sub")).unwrap();
    place
}

#[track_caller]
fn refused(place: &Place, arguments: &[&str], names: &[&str]) {
    let files = ["arm.urdf", "world.json"];
    let before = files.map(|file| place.read(file));
    place.run(arguments, "").exits(1).warns(&[names, &["nothing was written", "hint:"]].concat());
    assert_eq!(files.map(|file| place.read(file)), before, "{arguments:?}");
}

/// Checks that a symbolic link stays a link when its target is written, whether the target exists or not.
#[cfg(unix)]
#[test]
fn outputs_are_written_behind_links() {
    let place = place();
    std::fs::create_dir(place.path("behind")).unwrap();
    std::os::unix::fs::symlink("behind/plan.json", place.path("link.json")).unwrap();
    for _ in 0..2 {
        place.run(&["arm.urdf", "world.json", "--quiet", "--output", "link.json"], "").exits(0);
        assert!(place.path("link.json").is_symlink() && place.read("behind/plan.json").contains("\"found\""));
    }
    std::os::unix::fs::symlink("none/plan.json", place.path("dangling.json")).unwrap();
    place
        .run(&["arm.urdf", "world.json", "--output", "dangling.json"], "")
        .refused(1, &["the folder none does not exist"]);
    // One of two outputs may be the target of the other.
    std::os::unix::fs::symlink("late.json", place.path("late.svg")).unwrap();
    let both = ["arm.urdf", "world.json", "--output", "late.json", "--picture", "late.svg"];
    place.run(&both, "").refused(1, &["late.json and late.svg are the same file", "nothing was written"]);
    assert!(!place.path("late.json").exists());
}

#[test]
fn an_input_is_not_overwritten_by_any_path_to_it() {
    let place = place();
    let absolute = place.path("world.json").display().to_string();
    let mut spellings = vec!["world.json", "./world.json", "sub/../world.json", &absolute];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("world.json", place.path("soft.json")).unwrap();
        std::fs::hard_link(place.path("world.json"), place.path("hard.json")).unwrap();
        spellings.extend(["soft.json", "hard.json"]);
    }
    for output in &spellings {
        refused(&place, &["arm.urdf", "world.json", "--output", output], &["the input file world.json", output]);
    }
    // The world has another name, too.
    refused(&place, &["arm.urdf", spellings[spellings.len() - 1], "--output", "world.json"], &["world.json"]);
    refused(&place, &["compare", "arm.urdf", "world.json", "--output", "sub/../world.json"], &["the input"]);
    place.run(&["arm.urdf", "world.json", "--output", "new.json"], "").exits(0);
}

#[test]
fn pictures_do_not_overwrite_their_inputs() {
    let place = place();
    for name in ["arm.svg", "world.svg"] {
        let from = if name == "arm.svg" { "arm.urdf" } else { "world.json" };
        std::fs::copy(place.path(from), place.path(name)).unwrap();
    }
    let before = ["arm.svg", "world.svg"].map(|file| place.read(file));
    place.write("motion.csv", "shoulder,elbow\n-0.9,0.4\n1.55,-0.35\n");
    for arguments in [
        vec!["inspect", "arm.svg", "--picture", "./arm.svg"],
        vec!["check", "arm.svg", "world.json", "--at", "0,1", "--picture", "arm.svg"],
        vec!["verify", "arm.urdf", "world.svg", "motion.csv", "--picture", "world.svg"],
        vec!["arm.svg", "world.json", "--picture", "arm.svg"],
    ] {
        refused(&place, &arguments, &["the input"]);
        assert_eq!(["arm.svg", "world.svg"].map(|file| place.read(file)), before, "{arguments:?}");
    }
}

#[test]
fn files_named_by_an_input_are_inputs_too() {
    let place = Place::new();
    for file in ["den.toml", "den.yaml", "den.pgm"] {
        std::fs::copy(shipped(&format!("workspaces/{file}")), place.path(file)).unwrap();
    }
    let world = place.read("den.toml");
    let robot = world.lines().find_map(|line| line.strip_prefix("# robot: ")).unwrap().trim();
    let urdf = shipped(&format!("robots/{robot}.urdf"));
    let before = place.read("den.yaml");
    place.run(&[&urdf, "den.toml", "--output", "den.yaml"], "").exits(1).warns(&["the input file den.yaml"]);
    assert_eq!(place.read("den.yaml"), before);
}

#[test]
fn two_outputs_are_two_files() {
    let place = place();
    for outputs in [
        vec!["--output", "a.json", "--output", "./a.json"],
        vec!["--output", "a.json", "--output", "a.json"],
        vec!["--picture", "a.svg", "--picture", "sub/../a.svg"],
    ] {
        refused(&place, &[&["arm.urdf", "world.json"], &outputs[..]].concat(), &["are the same file"]);
        assert!(!place.path("a.json").exists() && !place.path("a.svg").exists());
    }
    refused(
        &place,
        &["compare", "arm.urdf", "world.json", "--output", "a.html", "--picture", "./a.html"],
        &["are the same file"],
    );
    refused(&place, &["demo", "--output", "./plan.json"], &["are the same file"]);
}
